#include "tf/tf_editor_widget.h"

#include <algorithm>
#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QSettings>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include "store/edits.h"
#include "widgets/named.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr const char *kScaleKey = "editor/histogramScale", *kFineKey = "editor/fineOpacity"; // as chosen last

QIcon swatch(const QColor& color, const QSize& size = {22, 14}) {
    QPixmap pixmap(size);
    pixmap.fill(color);
    QPainter painter(&pixmap);
    painter.setPen(QColor(0, 0, 0, 120));
    painter.drawRect(0, 0, size.width() - 1, size.height() - 1);
    return pixmap;
}

} // namespace

TfEditorWidget::TfEditorWidget(SessionStore& store, Results& results, Selection& selection, QWidget* parent)
    : QWidget(parent), m_store(store), m_canvas(new TfCanvas(store, results, selection, this)),
      m_column(new QVBoxLayout(this)), m_which(new QLabel(this)), m_value(new QDoubleSpinBox(this)),
      m_opacity(new QDoubleSpinBox(this)), m_color(new QToolButton(this)), m_fixed(new QCheckBox(tr("Fixed"), this)),
      m_remove(new QToolButton(this)) {
    setObjectName("tfEditor");

    m_which->setObjectName("pointLabel");
    m_which->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred); // gives way in a narrow window
    m_value->setObjectName("pointValue");
    // Of one width whatever the range: a selection must not change the layout, and with it the picture's size.
    m_value->setFixedWidth(QFontMetrics(font()).horizontalAdvance("-00000.00") + 34);
    m_value->setKeyboardTracking(false);
    m_value->setToolTip(tr("Where the points lie, in the units of the data; empty where they differ"));
    m_opacity->setObjectName("pointOpacity");
    m_opacity->setKeyboardTracking(false);
    m_opacity->setRange(0, 1);
    m_opacity->setDecimals(4);
    m_opacity->setSingleStep(0.01);
    m_opacity->setToolTip(tr("Opacity of a path one voxel long (d0), 0 to 1; empty where the points differ"));
    m_color->setObjectName("pointColor");
    m_color->setIconSize({22, 14});
    m_color->setToolTip(tr("Colour of the points (Enter)"));
    named(m_fixed, "pointFixed", tr("Refinement leaves fixed points alone (Space)"));
    m_remove->setObjectName("pointRemove");
    m_remove->setText(tr("Remove"));
    m_remove->setToolTip(tr("Remove the points (Delete)"));

    m_column->setContentsMargins(0, 2, 0, 6);
    m_column->setSpacing(4);
    m_column->addWidget(m_canvas, 1);
    m_column->addLayout(makeRow());

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

QHBoxLayout* TfEditorWidget::makeRow() {
    auto* scale = new QComboBox(this);
    scale->setObjectName("histogramScale");
    scale->addItems({tr("Log"), tr("Linear"), tr("Percentile")}); // as HistogramScale
    scale->setToolTip(tr("Height of the histograms: logarithm of the number of voxels, the number,\n"
                         "or the number up to the 99.5th percentile, so that one huge bin does not flatten the rest"));
    connect(scale, &QComboBox::currentIndexChanged, m_canvas,
            [this](int index) { m_canvas->setHistogramScale(static_cast<HistogramScale>(index)); });
    connect(scale, &QComboBox::activated, this, [](int index) { QSettings().setValue(kScaleKey, index); });
    scale->setCurrentIndex(std::clamp(QSettings().value(kScaleKey, 0).toInt(), 0, scale->count() - 1));
    auto* gradients = new QCheckBox(tr("Gradients"), this);
    named(gradients, "jointHistogram",
          tr("Behind the curve: how often values (to the right) meet gradient magnitudes (up).\n"
             "Matter lies at the bottom; arcs are borders between two matters"));
    connect(gradients, &QCheckBox::toggled, m_canvas, &TfCanvas::setJointHistogramShown);
    auto* fine = new QCheckBox(tr("Fine opacity"), this);
    named(fine, "fineOpacityAxis",
          tr("Height shows the cube root of the opacity: fine control near zero, where\n"
             "most of the effect lies (opacity of a path one voxel long, d0)"));
    connect(fine, &QCheckBox::toggled, m_canvas, &TfCanvas::setFineOpacityAxis);
    connect(fine, &QCheckBox::clicked, this, [](bool on) { QSettings().setValue(kFineKey, on); });
    m_canvas->setFineOpacityAxis(QSettings().value(kFineKey, true).toBool());
    fine->setChecked(m_canvas->isFineOpacityAxis());

    auto* row = new QHBoxLayout;
    row->setContentsMargins(10, 0, 10, 0);
    row->setSpacing(6);
    row->addWidget(m_which, 1);
    row->addWidget(new QLabel(tr("Value"), this));
    row->addWidget(m_value);
    row->addWidget(new QLabel(tr("Opacity"), this));
    row->addWidget(m_opacity);
    row->addWidget(m_color);
    row->addWidget(m_fixed);
    row->addWidget(m_remove);
    row->addSpacing(6);
    row->addWidget(scale);
    row->addWidget(gradients);
    row->addWidget(fine);
    return row;
}

void TfEditorWidget::setReadOnly(bool on) {
    m_readOnly = on;
    m_canvas->setReadOnly(on);
    showPoints();
}

void TfEditorWidget::addRow(QWidget* row) { m_column->insertWidget(++m_rows, row); }

void TfEditorWidget::showPoints() {
    const PointSelection& chosen = m_canvas->selectedPoints();
    const auto& points = m_store.scene().tf.points;
    const bool any =
        m_store.hasVolume() && !chosen.isEmpty() && static_cast<std::size_t>(chosen.indices().back()) < points.size();
    for (QWidget* widget : std::initializer_list<QWidget*>{m_value, m_opacity, m_color, m_fixed, m_remove}) {
        widget->setEnabled(any && !m_readOnly);
    }
    if (!any) { // nor do numbers of one that was
        m_which->setText(tr("No point selected"));
        m_color->setIcon(swatch(theme::kRaised));
        m_value->clear();
        m_opacity->clear();
        const QSignalBlocker blocker(m_fixed);
        m_fixed->setTristate(false);
        m_fixed->setChecked(false);
        return;
    }
    m_which->setText(chosen.size() == 1 ? tr("Point %1 of %2").arg(chosen.current() + 1).arg(points.size())
                                        : tr("%1 of %2 points").arg(chosen.size()).arg(points.size()));
    const ControlPoint& point = points[static_cast<std::size_t>(chosen.current())];
    bool sameX = true, sameOpacity = true, sameFixed = true, sameColor = true;
    for (const int index : chosen.indices()) {
        const ControlPoint& other = points[static_cast<std::size_t>(index)];
        sameX = sameX && other.x == point.x;
        sameOpacity = sameOpacity && other.opacity == point.opacity;
        sameFixed = sameFixed && other.fixed == point.fixed;
        sameColor = sameColor && other.color == point.color;
    }
    const ValueRange range = m_store.scene().volume->range();
    m_showing = true; // the boxes show, they do not edit
    const double span = range.hi - range.lo;
    m_value->setDecimals(decimalsFor(span));
    m_value->setRange(range.lo, range.hi);
    m_value->setSingleStep(span > 0 ? span / 200 : 1.0);
    const auto show = [](QDoubleSpinBox& box, double value, bool same) {
        showNumber(box, value);
        if (!same && !box.hasFocus()) box.clear(); // it keeps the current point's number, from which it steps
    };
    show(*m_value, m_store.scene().volume->valueOfIntensity(point.x), sameX);
    show(*m_opacity, point.opacity, sameOpacity);
    m_fixed->setTristate(!sameFixed);
    m_fixed->setCheckState(!sameFixed ? Qt::PartiallyChecked : point.fixed ? Qt::Checked : Qt::Unchecked);
    m_showing = false;
    m_color->setIcon(swatch(sameColor ? colorFromRgb(point.color) : theme::kRaised));
}

void TfEditorWidget::editPoints(const QDoubleSpinBox& box) {
    const PointSelection& chosen = m_canvas->selectedPoints();
    if (m_showing || chosen.isEmpty()) return;
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
