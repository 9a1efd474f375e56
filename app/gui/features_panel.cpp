#include "features_panel.h"

#include <algorithm>
#include <cmath>

#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStyledItemDelegate>
#include <QTableView>
#include <QVBoxLayout>

#include "opacity_editor.h"
#include "theme.h"

namespace pellucid::gui {
namespace {

constexpr int kRowHeight = 26;
constexpr int kSwatch = 26; // width of the colour in the name's cell

/// A slider in each cell of the opacity column.
class OpacityDelegate : public QStyledItemDelegate {
public:
    OpacityDelegate(FeaturesModel& model, QObject* parent) : QStyledItemDelegate(parent), m_model(model) {}

    QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem&, const QModelIndex& index) const override {
        auto* editor = new OpacityEditor(parent);
        const QPersistentModelIndex place(index);
        FeaturesModel& model = m_model;
        connect(editor, &OpacityEditor::dragged, &model, [&model, place](double opacity) {
            if (place.isValid()) model.previewOpacity(place.row(), opacity);
        });
        connect(editor, &OpacityEditor::released, &model, &FeaturesModel::endPreview);
        connect(editor, &OpacityEditor::edited, &model, [&model, place](double opacity) {
            if (place.isValid()) model.setData(place, opacity);
        });
        return editor;
    }
    void setEditorData(QWidget* editor, const QModelIndex& index) const override {
        static_cast<OpacityEditor*>(editor)->setOpacity(index.data(Qt::EditRole).toDouble());
    }
    void setModelData(QWidget*, QAbstractItemModel*, const QModelIndex&) const override {} // the signals have done it
    void paint(QPainter*, const QStyleOptionViewItem&, const QModelIndex&) const override {
    } // the editor is open always

private:
    FeaturesModel& m_model;
};

QPushButton* button(const QString& text, const char* name, const QString& tip, QWidget* parent) {
    auto* b = new QPushButton(text, parent);
    b->setObjectName(name);
    b->setToolTip(tip);
    b->setAutoDefault(false);
    return b;
}

} // namespace

FeaturesPanel::FeaturesPanel(Document& document, QWidget* parent)
    : QWidget(parent), m_document(document), m_model(new FeaturesModel(document, this)), m_table(new QTableView(this)),
      m_bars(new TargetBars(document)), m_method(new QComboBox(this)), m_tolerance(new QDoubleSpinBox(this)),
      m_refine(button(tr("&Refine"), "refineButton",
                      tr("Refine the opacities by entropy: values that are common get less, rare ones more"), this)),
      m_optimize(button(tr("&Optimize"), "optimizeButton",
                        tr("Change the features' opacities until their saliency (VWS) meets the targets,\n"
                           "as seen from this camera"),
                        this)),
      m_cancel(button(tr("&Cancel"), "cancelButton", tr("Stop, and go back to where the optimization began"), this)),
      m_undo(button(tr("Undo"), "undoButton", tr("Undo the last change of the transfer function (Ctrl+Z)"), this)),
      m_redo(button(tr("Redo"), "redoButton", tr("Redo the change that was undone (Ctrl+Shift+Z)"), this)),
      m_progress(new QProgressBar(this)), m_distance(new QLabel(this)), m_message(new QLabel(this)) {
    setObjectName("featuresPanel");

    m_table->setObjectName("featuresTable");
    m_table->setModel(m_model);
    m_table->setItemDelegateForColumn(FeaturesModel::Opacity, new OpacityDelegate(*m_model, m_table));
    for (const auto column : {FeaturesModel::Visibility, FeaturesModel::Vws, FeaturesModel::Target}) {
        m_table->setColumnHidden(column, true); // the bars below show them
    }
    m_table->verticalHeader()->hide();
    m_table->verticalHeader()->setDefaultSectionSize(kRowHeight);
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    m_table->horizontalHeader()->setSectionResizeMode(FeaturesModel::Range, QHeaderView::ResizeToContents);
    m_table->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    m_table->horizontalHeader()->setHighlightSections(false);
    m_table->setShowGrid(false);
    m_table->setSelectionMode(QAbstractItemView::NoSelection);
    m_table->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    m_table->setEditTriggers(QAbstractItemView::EditKeyPressed);
    connect(m_table, &QTableView::doubleClicked, this, [this](const QModelIndex& index) {
        if (index.column() != FeaturesModel::Name || m_optimizing) return;
        // The swatch at the left of the cell, or the name in the rest of it.
        const QPoint mouse = m_table->viewport()->mapFromGlobal(QCursor::pos());
        if (mouse.x() > m_table->columnViewportPosition(FeaturesModel::Name) + kSwatch) return m_table->edit(index);
        const QColor color =
            QColorDialog::getColor(index.data(Qt::DecorationRole).value<QColor>(), this, tr("Colour of the feature"));
        if (color.isValid()) m_model->setData(index, color, Qt::DecorationRole);
    });
    connect(m_model, &QAbstractItemModel::modelReset, this, &FeaturesPanel::adjustTable);

    auto* scroll = new QScrollArea(this);
    scroll->setObjectName("barsScroll");
    scroll->setWidget(m_bars);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);

    m_method->setObjectName("methodCombo");
    m_method->addItem(tr("Parallel line search"), static_cast<int>(SearchMethod::Parallel));
    m_method->addItem(tr("Line search"), static_cast<int>(SearchMethod::Line));
    m_method->addItem(tr("Fixed steps"), static_cast<int>(SearchMethod::Fixed));
    m_method->setToolTip(tr("How far each move goes: the best of eight lengths tried at once,\n"
                            "one length found by doubling or halving, or always the same"));
    m_tolerance->setObjectName("toleranceSpin");
    m_tolerance->setRange(0.0001, 1.0);
    m_tolerance->setDecimals(4);
    m_tolerance->setSingleStep(0.01);
    m_tolerance->setValue(0.03);
    m_tolerance->setToolTip(tr("Optimize stops when the distance F of VWS from the targets is below this"));
    m_progress->setObjectName("optimizeProgress");
    m_progress->setRange(0, 1000);
    m_progress->setTextVisible(true);
    m_progress->setMaximumHeight(18);
    m_distance->setObjectName("distanceLabel");
    m_distance->setToolTip(tr("F: root of the mean squared difference between VWS and targets"));
    // What is said must not change how wide the dock is, else the picture would be drawn anew.
    for (QLabel* label : {m_distance, m_message}) label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    m_message->setObjectName("panelMessage");
    m_message->setWordWrap(true);
    m_message->setStyleSheet(QStringLiteral("color: %1").arg(theme::kFaint.name()));

    auto* choices = new QGridLayout;
    choices->setContentsMargins(10, 0, 10, 0);
    choices->setHorizontalSpacing(8);
    choices->setVerticalSpacing(6);
    auto* methodLabel = new QLabel(tr("&Method"), this);
    methodLabel->setBuddy(m_method);
    auto* toleranceLabel = new QLabel(tr("&Tolerance"), this);
    toleranceLabel->setBuddy(m_tolerance);
    choices->addWidget(methodLabel, 0, 0);
    choices->addWidget(m_method, 0, 1);
    choices->addWidget(toleranceLabel, 0, 2);
    choices->addWidget(m_tolerance, 0, 3);
    choices->setColumnStretch(1, 1);
    auto* buttons = new QGridLayout;
    buttons->setContentsMargins(10, 0, 10, 0);
    buttons->setSpacing(6);
    buttons->addWidget(m_refine, 0, 0);
    buttons->addWidget(m_optimize, 0, 1);
    buttons->addWidget(m_cancel, 0, 1);
    buttons->addWidget(m_undo, 0, 2);
    buttons->addWidget(m_redo, 0, 3);
    for (int i = 0; i < 4; ++i) buttons->setColumnStretch(i, 1);
    auto* status = new QVBoxLayout;
    status->setContentsMargins(10, 0, 10, 0);
    status->setSpacing(4);
    status->addWidget(m_distance);
    status->addWidget(m_progress);
    status->addWidget(m_message);

    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 8);
    column->setSpacing(8);
    column->addWidget(m_table);
    column->addWidget(scroll, 1);
    column->addLayout(status);
    column->addLayout(choices);
    column->addLayout(buttons);

    connect(m_refine, &QPushButton::clicked, this, &FeaturesPanel::refineRequested);
    connect(m_optimize, &QPushButton::clicked, this, &FeaturesPanel::optimizeRequested);
    connect(m_cancel, &QPushButton::clicked, this, &FeaturesPanel::cancelRequested);
    connect(m_undo, &QPushButton::clicked, &document.undoStack(), &QUndoStack::undo);
    connect(m_redo, &QPushButton::clicked, &document.undoStack(), &QUndoStack::redo);
    connect(&document.undoStack(), &QUndoStack::canUndoChanged, this, &FeaturesPanel::updateState);
    connect(&document.undoStack(), &QUndoStack::canRedoChanged, this, &FeaturesPanel::updateState);
    connect(&document, &Document::volumeChanged, this, [this] { setMessage({}); });
    connect(&document, &Document::featuresChanged, this, &FeaturesPanel::updateState);
    connect(&document, &Document::measuresChanged, this, &FeaturesPanel::updateState);
    connect(&document, &Document::targetsChanged, this, &FeaturesPanel::updateState);
    connect(&document, &Document::tfChanged, this, &FeaturesPanel::updateState);
    adjustTable();
    updateState();
}

OptimizeOptions FeaturesPanel::options() const {
    OptimizeOptions options;
    options.method = static_cast<SearchMethod>(m_method->currentData().toInt());
    options.tolerance = m_tolerance->value();
    return options;
}

void FeaturesPanel::adjustTable() {
    for (int row = 0; row < m_model->rowCount(); ++row) {
        m_table->openPersistentEditor(m_model->index(row, FeaturesModel::Opacity));
    }
    const int shown = std::clamp(m_model->rowCount(), 1, 6);
    m_table->setFixedHeight(m_table->horizontalHeader()->sizeHint().height() + shown * kRowHeight + 2);
}

void FeaturesPanel::setOptimizing(bool on) {
    m_optimizing = on;
    m_firstObjective = 0;
    m_progress->setValue(0);
    m_progress->setFormat(on ? tr("measuring the start…") : QString());
    m_bars->setReadOnly(on);
    m_model->setReadOnly(on);
    updateState();
    if (on) m_cancel->setFocus();
}

void FeaturesPanel::showMove(int move, double objective) {
    if (move == 0) m_firstObjective = objective;
    // F falls by about the same factor in each move, so the way is measured in logarithms.
    const double tolerance = m_tolerance->value();
    double done = 1;
    if (objective > tolerance && m_firstObjective > tolerance) {
        done = std::log(m_firstObjective / objective) / std::log(m_firstObjective / tolerance);
    }
    m_progress->setValue(static_cast<int>(1000 * std::clamp(done, 0.0, 1.0)));
    m_progress->setFormat(tr("move %1, F = %2").arg(move).arg(objective, 0, 'f', 4));
}

void FeaturesPanel::setMessage(const QString& text) {
    m_message->setText(text);
    m_message->setVisible(!text.isEmpty());
}

void FeaturesPanel::updateState() {
    const bool ready = m_document.hasVolume() && !m_optimizing;
    const bool features = !m_document.tf().features.empty();
    m_refine->setEnabled(ready);
    m_optimize->setEnabled(ready && features);
    m_optimize->setVisible(!m_optimizing);
    m_cancel->setVisible(m_optimizing);
    m_progress->setVisible(m_optimizing);
    m_table->setEnabled(!m_optimizing);
    m_method->setEnabled(!m_optimizing);
    m_tolerance->setEnabled(!m_optimizing);
    m_undo->setEnabled(ready && m_document.undoStack().canUndo());
    m_redo->setEnabled(ready && m_document.undoStack().canRedo());
    m_distance->setVisible(!m_optimizing);
    const auto& measures = m_document.measures();
    if (measures && features && measures->features.size() == m_document.targets().size()) {
        std::vector<double> vws;
        for (const FeatureMeasures& m : measures->features) vws.push_back(m.vws);
        m_distance->setText(
            tr("Distance from the targets: F = %1").arg(objectiveOf(vws, m_document.targets()), 0, 'f', 4));
        m_distance->setEnabled(m_document.measuresAreCurrent());
    } else {
        m_distance->setText(features ? tr("Measuring…") : QString());
        m_distance->setEnabled(false);
    }
}

} // namespace pellucid::gui
