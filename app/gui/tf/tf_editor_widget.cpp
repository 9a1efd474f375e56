#include "tf/tf_editor_widget.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <QActionGroup>
#include <QCheckBox>
#include <QLineEdit>
#include <QMenu>
#include <QPainter>
#include <QSettings>
#include <QSignalBlocker>

#include "store/edits.h"
#include "widgets/controls.h"
#include "widgets/fitting_row.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr const char *kScaleKey = "editor/histogramScale", *kFineKey = "editor/fineOpacity"; // as chosen last

constexpr QSize kSwatch{22, 14};

QIcon swatch(const QColor& color) {
    QPixmap pixmap = swatchOf(color, kSwatch.width(), kSwatch.height());
    QPainter painter(&pixmap);
    painter.setPen(QColor(0, 0, 0, 120));
    painter.drawRect(0, 0, kSwatch.width() - 1, kSwatch.height() - 1);
    return pixmap;
}

} // namespace

TfEditorWidget::TfEditorWidget(SessionStore& store, Results& results, Selection& selection, QWidget* parent)
    : QWidget(parent), m_store(store), m_canvas(new TfCanvas(store, results, selection, this)),
      m_which(named(new QLabel(this), "pointLabel")),
      m_value(named(new QDoubleSpinBox(this), "pointValue",
                    tr("Where the points lie, in the units of the data; empty where they differ"))),
      m_opacity(named(new QDoubleSpinBox(this), "pointOpacity",
                      tr("Opacity of a path one voxel long (d0), 0 to 1; empty where the points differ"))),
      m_color(named(new QToolButton(this), "pointColor", tr("Colour of the points (Enter)"))),
      m_fixed(
          named(new QCheckBox(tr("Fixed"), this), "pointFixed", tr("Refinement leaves fixed points alone (Space)"))),
      m_remove(named(toolButton(tr("Remove"), this), "pointRemove", tr("Remove the points (Delete)"))),
      m_plot(named(menuButton(tr("Plot"), this), "plotMenuButton",
                   tr("Height of the histograms, gradients behind the curve, scale of the opacities"))) {
    setObjectName("tfEditor");
    // Of one width whatever the range: a selection must not move what stands beside.
    m_value->setFixedWidth(QFontMetrics(font()).horizontalAdvance("-00000.00") + 34);
    m_value->setKeyboardTracking(false);
    withLook(m_opacity, {.decimals = 4, .step = 0.01});
    m_color->setIconSize(kSwatch);
    fillPlotMenu(*m_plot->menu());
    setLayout(inset(columnOf({m_canvas}), {0, 2, 0, 2}));

    connect(m_canvas, &TfCanvas::selectionChanged, this, [this] {
        ++m_editSession;
        showPoints();
    });
    connect(&store, &SessionStore::changed, this, &TfEditorWidget::showPoints);
    for (QDoubleSpinBox* box : {m_value, m_opacity}) {
        connect(box, &QDoubleSpinBox::valueChanged, this, [this, box] { editPoints(*box); });
        // A number typed into an empty box counts even where the box has kept that number behind it.
        connect(box->findChild<QLineEdit*>(), &QLineEdit::textEdited, this, [this, box] { m_typed = box; });
        connect(box, &QDoubleSpinBox::editingFinished, this, [this, box] {
            if (std::exchange(m_typed, nullptr) == box && !box->text().isEmpty()) editPoints(*box);
        });
    }
    connect(m_color, &QToolButton::clicked, m_canvas, &TfCanvas::chooseColor);
    connect(m_fixed, &QCheckBox::clicked, m_canvas, &TfCanvas::toggleFixed);
    connect(m_remove, &QToolButton::clicked, m_canvas, &TfCanvas::removeSelected);
    showPoints();
}

void TfEditorWidget::fillPlotMenu(QMenu& menu) {
    auto* scales = new QActionGroup(&menu);
    const int kept = QSettings().value(kScaleKey, 0).toInt();
    const std::tuple<HistogramScale, const char*, QString, QString> heights[] = {
        {HistogramScale::Log, "histogramLog", tr("&Logarithm of the number of voxels"),
         tr("Height of the histograms: rare values are seen beside frequent ones")},
        {HistogramScale::Linear, "histogramLinear", tr("&Number of voxels"),
         tr("Height of the histograms: twice as many voxels, twice as high")},
        {HistogramScale::Percentile, "histogramPercentile", tr("Number, most frequent values &cut off"),
         tr("Height of the histograms: the number up to the 99.5th percentile,\n"
            "so that one huge bin does not flatten the rest")}};
    const auto check = [&](const char* id, const QString& text, const QString& tip, bool on) {
        QAction* const action = menu.addAction(text);
        action->setObjectName(id);
        action->setToolTip(tip);
        action->setCheckable(true);
        action->setChecked(on);
        return action;
    };
    for (const auto& [scale, id, text, tip] : heights) {
        QAction* const action = check(id, text, tip, static_cast<int>(scale) == kept);
        scales->addAction(action);
        connect(action, &QAction::triggered, this, [this, scale = scale] {
            m_canvas->setHistogramScale(scale);
            QSettings().setValue(kScaleKey, static_cast<int>(scale));
        });
        if (action->isChecked()) m_canvas->setHistogramScale(scale);
    }
    menu.addSeparator();
    QAction* const gradients = check("jointHistogram", tr("&Gradients behind the curve"),
                                     tr("How often values (to the right) meet gradient magnitudes (up).\n"
                                        "Materials lie at the bottom; arcs are borders between two materials"),
                                     false);
    connect(gradients, &QAction::toggled, m_canvas, &TfCanvas::setJointHistogramShown);
    const bool isFine = QSettings().value(kFineKey, true).toBool();
    QAction* const fine = check("fineOpacityAxis", tr("&Fine scale of low opacities"),
                                tr("Height shows the cube root of the opacity: fine control near zero, where\n"
                                   "most of the effect lies (opacity of a path one voxel long, d0)"),
                                isFine);
    m_canvas->setFineOpacityAxis(isFine);
    connect(fine, &QAction::toggled, m_canvas, &TfCanvas::setFineOpacityAxis);
    connect(fine, &QAction::triggered, this, [](bool on) { QSettings().setValue(kFineKey, on); });
}

void TfEditorWidget::fill(FittingRow& row) {
    const auto word = [this](const QString& text, QWidget* of) {
        auto* label = new QLabel(text, this);
        label->setToolTip(of->toolTip());
        return label;
    };
    enum Rank { Numbers, Color, Plot, Fixed, Remove, Words, Which }; // what a narrow window leaves out last … first
    row.add(m_which, Which);
    row.add(word(tr("Value"), m_value), Words);
    row.add(m_value, Numbers);
    row.add(word(tr("Opacity"), m_opacity), Words);
    row.add(m_opacity, Numbers);
    row.add(m_color, Color);
    row.add(m_fixed, Fixed);
    row.add(m_remove, Remove);
    row.addGap();
    row.add(m_plot, Plot);
}

void TfEditorWidget::setReadOnly(bool on) {
    m_readOnly = on;
    m_canvas->setReadOnly(on);
    showPoints();
}

void TfEditorWidget::showPoints() {
    const PointSelection& chosen = m_canvas->selectedPoints();
    const auto& points = m_store.scene().tf.points;
    const bool any =
        m_store.hasVolume() && !chosen.isEmpty() && static_cast<std::size_t>(chosen.indices().back()) < points.size();
    for (QWidget* widget : std::initializer_list<QWidget*>{m_value, m_opacity, m_color, m_fixed, m_remove})
        widget->setEnabled(any && !m_readOnly);
    const QSignalBlocker value(m_value), opacity(m_opacity), fixed(m_fixed); // they show, they do not edit
    if (!any) {                                                              // nor do numbers of one that was
        m_which->setText(tr("No point selected"));
        m_color->setIcon(swatch(theme::kRaised));
        m_value->clear();
        m_opacity->clear();
        m_fixed->setTristate(false);
        m_fixed->setChecked(false);
        return;
    }
    m_which->setText(chosen.size() == 1 ? tr("Point %1 of %2").arg(chosen.current() + 1).arg(points.size())
                                        : tr("%1 of %2 points").arg(chosen.size()).arg(points.size()));
    const ControlPoint& point = points[static_cast<std::size_t>(chosen.current())];
    const auto same = [&](auto ControlPoint::*part) { // in all chosen points
        return std::all_of(chosen.indices().begin(), chosen.indices().end(),
                           [&](int index) { return points[static_cast<std::size_t>(index)].*part == point.*part; });
    };
    const ValueRange range = m_store.scene().volume->range();
    const double span = range.hi - range.lo;
    m_value->setDecimals(decimalsFor(span));
    m_value->setRange(range.lo, range.hi);
    m_value->setSingleStep(span > 0 ? span / 200 : 1.0);
    const auto show = [](QDoubleSpinBox& box, double number, bool isOfAll) {
        showNumber(box, number);
        if (!isOfAll && !box.hasFocus()) box.clear(); // it keeps the current point's number, from which it steps
    };
    show(*m_value, m_store.scene().volume->valueOfIntensity(point.x), same(&ControlPoint::x));
    show(*m_opacity, point.opacity, same(&ControlPoint::opacity));
    m_fixed->setTristate(!same(&ControlPoint::fixed));
    m_fixed->setCheckState(m_fixed->isTristate() ? Qt::PartiallyChecked : point.fixed ? Qt::Checked : Qt::Unchecked);
    m_color->setIcon(swatch(same(&ControlPoint::color) ? colorFromRgb(point.color) : theme::kRaised));
}

void TfEditorWidget::editPoints(const QDoubleSpinBox& box) {
    const PointSelection& chosen = m_canvas->selectedPoints();
    if (chosen.isEmpty()) return;
    m_typed = nullptr;
    const ValueRange range = m_store.scene().volume->range();
    const double span = range.hi - range.lo;
    // Only the box that was edited counts: the other one shows a rounded number.
    const bool movesX = &box == m_value;
    if (movesX && !(span > 0)) return;
    const auto moved = movesX ? withPointsAt(m_store.scene().tf, chosen, (box.value() - range.lo) / span, {})
                              : withPointsAt(m_store.scene().tf, chosen, {}, box.value());
    editTf(m_store, moved, chosen.size() == 1 ? tr("Move point") : tr("Move points"),
           QStringLiteral("spin-%1-%2").arg(movesX).arg(m_editSession));
}

} // namespace pellucid::gui
