#include "tf_editor_widget.h"

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include "ghost_layer.h"
#include "number_box.h"
#include "number_text.h"
#include "palette_bar.h"
#include "panel.h"
#include "store/edits.h"
#include "tf_edit.h"
#include "theme.h"
#include "workbench.h"

namespace pellucid::gui {
namespace {

QIcon swatch(const QColor& color, const QSize& size = {22, 14}) {
    QPixmap pixmap(size);
    pixmap.fill(color);
    QPainter painter(&pixmap);
    painter.setPen(QColor(0, 0, 0, 120));
    painter.drawRect(0, 0, size.width() - 1, size.height() - 1);
    return pixmap;
}

} // namespace

PanelInfo transferFunctionPanel() {
    return {.id = "tf",
            .title = QObject::tr("Transfer function"),
            .area = Qt::BottomDockWidgetArea,
            .visible = true,
            .size = 250,
            .keys = QKeySequence("Ctrl+1"),
            .tip = QObject::tr("The curve of opacity and colour over the histogram"),
            .make = [](Workbench& bench, QWidget* parent) {
                auto* editor = new TfEditorWidget(bench.store(), bench.results(), parent);
                QObject::connect(&bench, &Workbench::readOnlyChanged, editor,
                                 [editor, &bench] { editor->setReadOnly(bench.isReadOnly()); });
                addGhostLayer(bench, editor->canvas());
                editor->addRow(new PaletteBar(bench, editor->canvas(), editor));
                const QString place = QObject::tr("Transfer function");
                bench.actions().addGestures(
                    {{place, QObject::tr("Drag a point (Shift: along one axis)"),
                      QObject::tr("change its value and opacity")},
                     {place, QObject::tr("Double-click"), QObject::tr("add a point; on a point: its colour")},
                     {place, QObject::tr("Enter, Space, Delete"), QObject::tr("colour, fix, remove the point")},
                     {place, QObject::tr("Arrow keys (Shift: finer)"), QObject::tr("move the point")},
                     {place, QObject::tr("Page Up, Page Down"), QObject::tr("choose another point")}});
                return editor;
            }};
}

TfEditorWidget::TfEditorWidget(SessionStore& store, Results& results, QWidget* parent)
    : QWidget(parent), m_store(store), m_canvas(new TfCanvas(store, results, this)), m_which(new QLabel(this)),
      m_value(new QDoubleSpinBox(this)), m_opacity(new QDoubleSpinBox(this)), m_color(new QToolButton(this)),
      m_fixed(new QCheckBox(tr("Fixed"), this)), m_remove(new QToolButton(this)) {
    setObjectName("tfEditor");

    m_which->setObjectName("pointLabel");
    m_which->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred); // gives way in a narrow window
    m_value->setObjectName("pointValue");
    // Of one width whatever the range: a selection must not change the layout, and with it the picture's size.
    m_value->setFixedWidth(QFontMetrics(font()).horizontalAdvance("-00000.00") + 34);
    m_value->setKeyboardTracking(false);
    m_value->setToolTip(tr("Where the point lies, in the units of the data"));
    m_opacity->setObjectName("pointOpacity");
    m_opacity->setKeyboardTracking(false);
    m_opacity->setRange(0, 1);
    m_opacity->setDecimals(4);
    m_opacity->setSingleStep(0.01);
    m_opacity->setToolTip(tr("Opacity of a path one voxel long (d0), 0 to 1"));
    m_color->setObjectName("pointColor");
    m_color->setIconSize({22, 14});
    m_color->setToolTip(tr("Colour of the point (Enter)"));
    m_fixed->setObjectName("pointFixed");
    m_fixed->setToolTip(tr("Refinement leaves a fixed point alone (Space)"));
    m_remove->setObjectName("pointRemove");
    m_remove->setText(tr("Remove"));
    m_remove->setToolTip(tr("Remove the point (Delete)"));

    auto* logHistogram = new QCheckBox(tr("Log counts"), this);
    logHistogram->setObjectName("logHistogram");
    logHistogram->setChecked(true);
    logHistogram->setToolTip(tr("Height of the grey histogram: logarithm of the number of voxels, or the number"));
    auto* rootAxis = new QCheckBox(tr("Fine opacity"), this);
    rootAxis->setObjectName("rootOpacityAxis");
    rootAxis->setToolTip(tr("Height shows the square root of the opacity: fine control near zero, where\n"
                            "most of the effect lies (opacity of a path one voxel long, d0)"));
    connect(logHistogram, &QCheckBox::toggled, m_canvas, &TfCanvas::setLogHistogram);
    connect(rootAxis, &QCheckBox::toggled, m_canvas, &TfCanvas::setRootOpacityAxis);

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
    row->addWidget(logHistogram);
    row->addWidget(rootAxis);
    m_column = new QVBoxLayout(this);
    m_column->setContentsMargins(0, 2, 0, 6);
    m_column->setSpacing(4);
    m_column->addWidget(m_canvas, 1);
    m_column->addLayout(row);

    connect(m_canvas, &TfCanvas::selectionChanged, this, [this] {
        ++m_editSession;
        showPoint();
    });
    connect(&store, &SessionStore::changed, this, &TfEditorWidget::showPoint);
    connect(m_value, &QDoubleSpinBox::valueChanged, this, &TfEditorWidget::editPoint);
    connect(m_opacity, &QDoubleSpinBox::valueChanged, this, &TfEditorWidget::editPoint);
    connect(m_color, &QToolButton::clicked, m_canvas, &TfCanvas::chooseColor);
    connect(m_fixed, &QCheckBox::clicked, m_canvas, &TfCanvas::toggleFixed);
    connect(m_remove, &QToolButton::clicked, m_canvas, &TfCanvas::removeSelected);
    showPoint();
}

void TfEditorWidget::setReadOnly(bool on) {
    m_readOnly = on;
    m_canvas->setReadOnly(on);
    showPoint();
}

void TfEditorWidget::addRow(QWidget* row) { m_column->insertWidget(++m_rows, row); }

void TfEditorWidget::showPoint() {
    const int index = m_canvas->selectedPoint();
    const auto& points = m_store.scene().tf.points;
    const bool any = m_store.hasVolume() && index >= 0 && index < static_cast<int>(points.size());
    m_which->setText(any ? tr("Point %1 of %2").arg(index + 1).arg(points.size()) : tr("No point selected"));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_value, m_opacity, m_color, m_fixed, m_remove}) {
        widget->setEnabled(any && !m_readOnly);
    }
    if (!any) { // nor do numbers of one that was
        m_color->setIcon(swatch(theme::kRaised));
        m_value->clear();
        m_opacity->clear();
        const QSignalBlocker blocker(m_fixed);
        m_fixed->setChecked(false);
        return;
    }
    const ControlPoint& point = points[static_cast<std::size_t>(index)];
    const ValueRange range = m_store.scene().volume->range();
    m_showing = true; // the boxes show, they do not edit
    const double span = range.hi - range.lo;
    m_value->setDecimals(decimalsFor(span));
    m_value->setRange(range.lo, range.hi);
    m_value->setSingleStep(span > 0 ? span / 200 : 1.0);
    showNumber(*m_value, m_store.scene().volume->valueOfIntensity(point.x));
    showNumber(*m_opacity, point.opacity);
    m_fixed->setChecked(point.fixed);
    m_showing = false;
    m_color->setIcon(swatch(colorFromRgb(point.color)));
}

void TfEditorWidget::editPoint() {
    const int index = m_canvas->selectedPoint();
    if (m_showing || index < 0) return;
    const ControlPoint& point = m_store.scene().tf.points[static_cast<std::size_t>(index)];
    const ValueRange range = m_store.scene().volume->range();
    const double span = range.hi - range.lo;
    // Only the box that was edited counts: the other one shows a rounded number.
    const bool movesX = sender() == m_value;
    const double x = movesX && span > 0 ? (m_value->value() - range.lo) / span : point.x;
    const double opacity = movesX ? point.opacity : m_opacity->value();
    editTf(m_store, withPointMoved(m_store.scene().tf, index, x, opacity), tr("Move point"),
           QStringLiteral("spin-%1-%2").arg(movesX).arg(m_editSession));
}

} // namespace pellucid::gui
