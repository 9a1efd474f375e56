// The panel of the features: what each shows, what it should show, and the buttons that get it there.
#include <algorithm>
#include <cmath>

#include <QColorDialog>
#include <QGridLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QPushButton>
#include <QScrollArea>
#include <QStyledItemDelegate>
#include <QTableView>

#include "controllers/controllers.h"
#include "panels/density_slider.h"
#include "panels/features_model.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "panels/target_bars.h"
#include "panels/variable_words.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/alike_features.h"
#include "tf/edit.h"
#include "tf/shapes.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/lock_mark.h"
#include "widgets/opacity_editor.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kRowHeight = 26;
constexpr int kSwatch = 26;       // width of the colour in the name's cell
constexpr int kEye = 30;          // width of the eyes' column
constexpr int kOpacity = 108;     // width of the opacities: a slider and four decimals
constexpr int kLeastOpacity = 64; // the decimals and a stub of the slider
constexpr int kLeastName = 90;    // width of a name with its colour, where there are values beside it
constexpr int kCellMargins = 16;
constexpr int kPadlock = 16; // width in the name's cell

/// An eye in each cell of its column: open, closed, or faint where another feature is drawn alone.
class EyeDelegate : public QStyledItemDelegate {
public:
    EyeDelegate(const FeaturesModel& model, QObject* parent) : QStyledItemDelegate(parent), m_model(model) {}

    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        QStyleOptionViewItem plain = option;
        plain.state &= ~QStyle::State_HasFocus;
        QStyledItemDelegate::paint(painter, plain, index);
        const bool open = index.data(Qt::EditRole).toBool();
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        const QPointF c = QRectF(option.rect).center();
        painter->setPen(QPen(m_model.isDrawn(index.row()) ? theme::kText : theme::kFaint, 1.4));
        QPainterPath lid(c - QPointF(7, 0));
        if (open)
            lid.quadTo(c - QPointF(0, 8), c + QPointF(7, 0));
        else
            lid.moveTo(c + QPointF(7, 0));
        lid.quadTo(c + QPointF(0, 8), c - QPointF(7, 0));
        painter->drawPath(lid);
        if (open) {
            painter->setBrush(painter->pen().color());
            painter->drawEllipse(c, 2, 2);
        } else {
            for (const double dx : {-4.0, 0.0, 4.0}) // lashes
                painter->drawLine(c + QPointF(dx, dx == 0 ? 4.2 : 3), c + QPointF(dx * 1.3, dx == 0 ? 7 : 5.6));
        }
        painter->restore();
    }
    QWidget* createEditor(QWidget*, const QStyleOptionViewItem&, const QModelIndex&) const override { return nullptr; }

private:
    const FeaturesModel& m_model;
};

/// The swatch of a feature with an outline: white ones are seen on white, too. A padlock where the opacity is locked,
/// an open one where it has limits.
class NameDelegate : public QStyledItemDelegate {
public:
    using QStyledItemDelegate::QStyledItemDelegate;

    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        const auto lock = static_cast<FeaturesModel::Lock>(index.data(FeaturesModel::LockRole).toInt());
        QStyleOptionViewItem narrower = option;
        if (lock != FeaturesModel::Lock::None) narrower.rect.adjust(0, 0, -kPadlock, 0);
        QStyledItemDelegate::paint(painter, narrower, index);
        if (lock == FeaturesModel::Lock::None) return;
        if (option.state.testFlag(QStyle::State_Selected))
            painter->fillRect(option.rect.adjusted(option.rect.width() - kPadlock, 0, 0, 0),
                              option.palette.highlight());
        paintLock(*painter, QPointF(option.rect.right() - kPadlock / 2.0, option.rect.center().y()),
                  lock == FeaturesModel::Lock::Locked, theme::kText);
    }

protected:
    void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
        QStyledItemDelegate::initStyleOption(option, index);
        const auto color = index.data(Qt::DecorationRole).value<QColor>();
        if (!color.isValid()) return;
        QPixmap swatch(option->decorationSize);
        swatch.fill(color);
        QPainter painter(&swatch);
        painter.setPen(contrast(color, theme::kPanel) < kMarkContrast ? seenOn(theme::kPanel, color) : theme::kLine);
        painter.drawRect(swatch.rect().adjusted(0, 0, -1, -1));
        option->icon = QIcon(swatch);
        option->icon.addPixmap(swatch, QIcon::Selected); // as it is: a tinted one is another colour
    }
};

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
    auto* b = named(new QPushButton(text, parent), name, tip);
    b->setAutoDefault(false);
    return b;
}

/// A button that does what an action of a menu does, with a text of its own.
QToolButton* actionButton(QAction& action, const QString& text, const QString& name) {
    action.setIconText(text);
    auto* b = named(new QToolButton, name);
    b->setDefaultAction(&action);
    return b;
}

const QMargins kSides{6, 0, 6, 0}; ///< of rows beside the table, which has none

class FeaturesPanel : public QWidget {
public:
    FeaturesPanel(Services& services, Controllers& controllers, QWidget* parent);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override; ///< the mouse on eyes and colours
    void resizeEvent(QResizeEvent* event) override;

private:
    void shareOutColumns();
    void prepareTable();
    QLayout* makeShapeRow();
    QLayout* makeMethodRow();
    QLayout* makeButtons();
    bool pressTable(const QMouseEvent& mouse);
    void select(int row);
    void followSelection();
    void follow(); ///< the state, and what is computed of it
    void followRun();
    void showMessage();
    void showEmpty();
    void removeEmpty();
    void showAlike();
    void mendColors();
    void adjustTable();

    Services& m_services;
    Controllers& m_controllers;
    FeaturesModel* m_model = new FeaturesModel(m_services.store(), m_services.results(), this);
    QTableView* m_table = named(new QTableView(this), "featuresTable", tr("Features: intervals of values with a name"));
    TargetBars* m_bars = new TargetBars(m_services.store(), m_services.results());
    DensitySlider* m_density = new DensitySlider(m_services, this);
    QToolButton* m_add = named(menuButton(tr("Add"), this), "addShapeButton",
                               tr("A new feature of some shape, in a gap between the others"));
    QToolButton* m_colors =
        named(menuButton(tr("Colours"), this), "colorMapButton", tr("Colours by value from a map; opacities stay"));
    QToolButton* m_targets =
        named(menuButton(tr("Targets"), this), "targetsButton",
              tr("All targets at once: equal, by value, as now, for one feature, inverted; and locks"));
    QPushButton* m_refine =
        button(tr("&Refine"), "refineButton",
               tr("Refine the opacities by entropy: values that are common get less, rare ones more"), this);
    QPushButton* m_optimize = button(tr("&Optimize"), "optimizeButton",
                                     tr("Change the features' opacities until their attention meets the targets,\n"
                                        "as seen from this camera"),
                                     this);
    QPushButton* m_cancel =
        button(tr("&Cancel"), "cancelButton", tr("Stop, and go back to where the optimization began"), this);
    QPushButton* m_undo = button(tr("Undo"), "undoButton", tr("Undo the last change (Ctrl+Z)"), this);
    QPushButton* m_redo = button(tr("Redo"), "redoButton", tr("Redo the change that was undone (Ctrl+Shift+Z)"), this);
    QProgressBar* m_progress = progressBar("optimizeProgress", this, 1000);
    QLabel* m_distance =
        withAnyWidth(named(new QLabel(this), "distanceLabel",
                           tr("How far the features' attention lies from the targets.\n"
                              "F, the root mean square of VWS − target over the features; 1 is 100 %")));
    QLabel* m_message = withAnyWidth(wrappedLabel("panelMessage", this));
    QGridLayout* m_choiceRows = new QGridLayout; ///< below the message: what can be done about it
    std::vector<QToolButton*> m_choices;
    FeatureId m_empty = 0; ///< a feature without voxels; 0: none
    QLabel* m_emptyLabel = withAnyWidth(wrappedLabel("emptyFeatureLabel", this));
    QToolButton* m_removeEmpty =
        named(toolButton(tr("Remove empty feature"), this), "removeEmptyButton",
              tr("Removes the feature from the curve; undo brings it back. Or move its borders to values that occur"));
    TransferFunction m_told; ///< which features look alike has been told of it
    ElidedLabel* m_alikeLabel = named(new ElidedLabel(this), "alikeLabel");
    QToolButton* m_mendColors =
        named(toolButton(tr("Mend colours"), this), "mendColorsButton",
              tr("Other colours for as few features as possible, which all viewers can tell apart; what is lighter\n"
                 "stays lighter. Undo takes it back. View → Colour vision shows the window as others see it"));
};

FeaturesPanel::FeaturesPanel(Services& services, Controllers& controllers, QWidget* parent)
    : QWidget(parent), m_services(services), m_controllers(controllers) {
    setObjectName("featuresPanel");
    m_table->setAccessibleName(tr("Features"));
    prepareTable();
    elideInTheMiddle(*m_table);
    m_add->menu()->addActions(m_controllers.features.shapes());
    m_controllers.features.fillColorMenu(*m_colors->menu());
    m_targets->menu()->addActions(m_controllers.targets.entries());
    m_progress->setTextVisible(true);
    m_progress->setMaximumHeight(18);
    makeFaint(*m_message);
    makeFaint(*m_emptyLabel);
    makeFaint(*m_alikeLabel);
    m_choiceRows->setColumnStretch(1, 1);
    connect(m_removeEmpty, &QToolButton::clicked, this, &FeaturesPanel::removeEmpty);
    connect(m_mendColors, &QToolButton::clicked, this, &FeaturesPanel::mendColors);
    auto* scroll = named(new QScrollArea(this), "barsScroll");
    scroll->setWidget(m_bars);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);

    QLayout* const status =
        columnOf({m_emptyLabel, rowOf({m_removeEmpty, Cell::rest()}), rowOf({{m_alikeLabel, 1}, m_mendColors}, 4),
                  m_distance, m_progress, m_message, m_choiceRows},
                 4);
    QLayout* const liveRow =
        rowOf({m_targets, actionButton(*m_controllers.live.action(), tr("Live"), "liveTargetsButton"), m_colors,
               Cell::rest(), actionButton(*m_controllers.saving.barsAction(), tr("Bars…"), "saveBarsButton")},
              4);
    setLayout(inset(columnOf({m_table,
                              inset(makeShapeRow(), kSides),
                              inset(liveRow, kSides),
                              {scroll, 1},
                              // Above what is taken hold of, which must not move when a message comes or goes.
                              inset(status, kSides),
                              inset(rowOf({{m_density, 1}}), kSides),
                              inset(makeMethodRow(), kSides),
                              makeButtons()},
                             8),
                    {0, 0, 0, 8}));

    OptimizeController& optimizing = controllers.optimizing;
    connect(m_refine, &QPushButton::clicked, controllers.refining.actions().refine, &QAction::trigger);
    connect(m_optimize, &QPushButton::clicked, &optimizing, &OptimizeController::start);
    connect(m_undo, &QPushButton::clicked, &services, &Services::undo);
    connect(m_redo, &QPushButton::clicked, &services, &Services::redo);
    connect(m_cancel, &QPushButton::clicked, &optimizing, &OptimizeController::cancel);
    connect(m_bars, &TargetBars::currentChanged, this, &FeaturesPanel::select);
    connect(&optimizing, &OptimizeController::runningChanged, this, &FeaturesPanel::followRun);
    connect(&optimizing, &OptimizeController::moved, this, &FeaturesPanel::followRun);
    connect(&optimizing, &OptimizeController::messageChanged, this, &FeaturesPanel::showMessage);
    connect(&m_services.selection(), &Selection::featureChanged, this, &FeaturesPanel::followSelection);
    connect(&m_services.store(), &SessionStore::changed, this, &FeaturesPanel::follow);
    connect(&m_services.store(), &SessionStore::historyChanged, this, &FeaturesPanel::follow);
    connect(&m_services.results(), &Results::changed, this, &FeaturesPanel::follow);
    connect(&terms(), &Terms::changed, this, [this] {
        follow();
        m_bars->update();
    });
    adjustTable();
    followRun();
    showMessage();
}

QLayout* FeaturesPanel::makeButtons() {
    auto* buttons = inset(new QGridLayout, kSides);
    buttons->setSpacing(6);
    buttons->addWidget(m_refine, 0, 0);
    buttons->addWidget(m_optimize, 0, 1);
    buttons->addWidget(m_cancel, 0, 1);
    buttons->addWidget(m_undo, 0, 2);
    buttons->addWidget(m_redo, 0, 3);
    for (int i = 0; i < 4; ++i) buttons->setColumnStretch(i, 1);
    // As narrow as their texts, where the panel is: the style would make each as wide as those of dialogs.
    for (QPushButton* button : {m_refine, m_optimize, m_cancel, m_undo, m_redo})
        button->setMinimumWidth(button->fontMetrics().horizontalAdvance(button->text()) + 12);
    return buttons;
}

void FeaturesPanel::prepareTable() {
    m_table->setModel(m_model);
    m_table->setItemDelegateForColumn(FeaturesModel::Opacity, new OpacityDelegate(*m_model, m_table));
    m_table->setItemDelegateForColumn(FeaturesModel::Name, new NameDelegate(m_table));
    m_table->setItemDelegateForColumn(FeaturesModel::Eye, new EyeDelegate(*m_model, m_table));
    for (const auto column : {FeaturesModel::Visibility, FeaturesModel::Vws, FeaturesModel::Target})
        m_table->setColumnHidden(column, true); // the bars below show them
    m_model->setPictureSaliency(m_controllers.pictureSaliency);
    followParts(
        m_services, this,
        [this] {
            m_table->setColumnHidden(FeaturesModel::PictureShare, !m_services.scene().session.pictureSaliency->on);
            shareOutColumns();
        },
        &Session::pictureSaliency);
    m_table->verticalHeader()->hide();
    m_table->verticalHeader()->setDefaultSectionSize(kRowHeight);
    QHeaderView& header = *m_table->horizontalHeader();
    header.setSectionResizeMode(QHeaderView::Stretch);
    header.setMinimumSectionSize(kEye);
    header.setSectionResizeMode(FeaturesModel::Eye, QHeaderView::Fixed);
    m_table->setColumnWidth(FeaturesModel::Eye, kEye);
    header.setSectionResizeMode(FeaturesModel::Range, QHeaderView::ResizeToContents);
    header.setSectionResizeMode(FeaturesModel::PictureShare, QHeaderView::ResizeToContents);
    header.setSectionResizeMode(FeaturesModel::Opacity, QHeaderView::Fixed);
    m_table->setColumnWidth(FeaturesModel::Opacity, kOpacity);
    header.setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    header.setHighlightSections(false);
    m_table->setShowGrid(false);
    m_table->setSelectionMode(QAbstractItemView::SingleSelection);
    m_table->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_table->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    m_table->setEditTriggers(QAbstractItemView::EditKeyPressed);
    m_table->viewport()->installEventFilter(this);
    m_table->setContextMenuPolicy(Qt::CustomContextMenu);
    connect(m_table, &QTableView::customContextMenuRequested, this, [this](const QPoint& at) {
        select(m_table->rowAt(at.y()));
        QMenu menu(this);
        menu.setObjectName("featureContextMenu");
        m_controllers.features.fillMenu(menu);
        menu.exec(m_table->viewport()->mapToGlobal(at));
    });
    connect(m_table->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
            [this](const QModelIndex& now) { select(now.row()); });
    connect(m_model, &QAbstractItemModel::modelReset, this, &FeaturesPanel::adjustTable);
}

QLayout* FeaturesPanel::makeShapeRow() {
    QHBoxLayout* const row = rowOf({m_add}, 3);
    const QString texts[] = {tr("Split"), tr("Merge"), tr("Copy"), tr("Remove")};
    const QList<QAction*>& actions = m_controllers.features.shaping();
    for (qsizetype i = 0; i < actions.size(); ++i)
        row->addWidget(actionButton(*actions[i], texts[i], actions[i]->objectName() + "Button"));
    row->addStretch(1);
    return row;
}

QLayout* FeaturesPanel::makeMethodRow() {
    auto* settings = named(toolButton(tr("Settings…"), this), "settingsButton",
                           tr("Steps, tolerance and limit of optimizations; how saliency is measured"));
    connect(settings, &QToolButton::clicked, this, [this] { m_services.panels().show("settings"); });
    auto* method = new QWidget(this);
    auto* form = inset(new QFormLayout(method), {});
    auto* rows = new SettingRows(m_services, *form, settingPart<OptimizeOptions>(&Session::optimize),
                                 {tr("Optimization settings"), "optimize-settings"});
    rows->add("method", {.id = "methodCombo"});
    rows->follow();
    return rowOf({{method, 1}, settings}, 8);
}

bool FeaturesPanel::eventFilter(QObject* watched, QEvent* event) {
    if (watched == m_table->viewport() &&
        (event->type() == QEvent::MouseButtonPress || event->type() == QEvent::MouseButtonDblClick)) {
        const auto* mouse = static_cast<QMouseEvent*>(event);
        if (pressTable(*mouse)) return true;
    }
    return QWidget::eventFilter(watched, event);
}

bool FeaturesPanel::pressTable(const QMouseEvent& mouse) {
    const QPoint at = mouse.position().toPoint();
    const QModelIndex index = m_table->indexAt(at);
    if (!index.isValid() || mouse.button() != Qt::LeftButton || m_services.isReadOnly()) return false;
    if (index.column() == FeaturesModel::Eye) {
        if (mouse.modifiers() & (Qt::AltModifier | Qt::ControlModifier))
            m_controllers.features.toggleOnly(index.row());
        else
            m_model->setData(index, !index.data(Qt::EditRole).toBool());
        return true;
    }
    if (index.column() != FeaturesModel::Name) return false;
    const bool second = mouse.type() == QEvent::MouseButtonDblClick;
    if (at.x() > m_table->columnViewportPosition(FeaturesModel::Name) + kSwatch) {
        if (second) m_table->edit(index);
        return second;
    }
    if (second) return true;
    select(index.row());
    const QPersistentModelIndex place(index);
    const QColor color =
        QColorDialog::getColor(index.data(Qt::DecorationRole).value<QColor>(), this, tr("Colour of the feature"));
    if (color.isValid() && place.isValid()) m_model->setData(place, color, Qt::DecorationRole);
    return true;
}

void FeaturesPanel::select(int row) {
    const auto& features = m_services.scene().tf.features;
    if (row >= 0 && static_cast<std::size_t>(row) < features.size())
        m_services.selection().setFeature(features[static_cast<std::size_t>(row)].id);
}

void FeaturesPanel::followSelection() {
    const int row = m_services.selectedFeature();
    if (row >= 0 && row < m_model->rowCount()) {
        if (m_table->currentIndex().row() != row) m_table->setCurrentIndex(m_model->index(row, FeaturesModel::Name));
        if (!m_table->selectionModel()->isRowSelected(row)) m_table->selectRow(row);
    } else {
        m_table->clearSelection();
    }
    m_bars->setCurrentFeature(row);
}

void FeaturesPanel::adjustTable() {
    for (int row = 0; row < m_model->rowCount(); ++row) {
        m_table->openPersistentEditor(m_model->index(row, FeaturesModel::Opacity));
    }
    followSelection();
    shareOutColumns();
    const int shown = std::clamp(m_model->rowCount(), 1, 6);
    m_table->setFixedHeight(m_table->horizontalHeader()->sizeHint().height() + shown * kRowHeight + 2);
}

void FeaturesPanel::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    shareOutColumns();
}

/// A narrow panel leaves out the values, which the curve shows, too: names and opacities must be read.
void FeaturesPanel::shareOutColumns() {
    int others = kEye;
    if (!m_table->isColumnHidden(FeaturesModel::PictureShare))
        others += m_table->columnWidth(FeaturesModel::PictureShare);
    // Names go before sliders.
    const int opacity = std::clamp(width() - others - kLeastName, kLeastOpacity, kOpacity);
    m_table->setColumnWidth(FeaturesModel::Opacity, opacity);
    others += opacity;
    int values = m_table->fontMetrics().horizontalAdvance(
        m_table->horizontalHeader()->model()->headerData(FeaturesModel::Range, Qt::Horizontal).toString());
    for (int row = 0; row < m_model->rowCount(); ++row)
        values = std::max(values, m_table->fontMetrics().horizontalAdvance(
                                      m_model->index(row, FeaturesModel::Range).data().toString()));
    m_table->setColumnHidden(FeaturesModel::Range, width() - others - values - kCellMargins < kLeastName);
}

void FeaturesPanel::followRun() {
    const OptimizeController& run = m_controllers.optimizing;
    const bool on = run.isRunning();
    if (on && !m_cancel->isVisible()) m_cancel->setFocus();
    if (m_cancel->isHidden() == on) {
        m_bars->setReadOnly(on);
        m_model->setReadOnly(on);
    }
    if (!on || run.move() < 0) {
        m_progress->setValue(0);
        m_progress->setFormat(on ? tr("measuring the start…") : QString());
    } else {
        // F falls by about the same factor in each move, so the way is measured in logarithms.
        const double tolerance = m_services.store().session().optimize->tolerance;
        double done = 1;
        if (run.objective() > tolerance && run.firstObjective() > tolerance)
            done = std::log(run.firstObjective() / run.objective()) / std::log(run.firstObjective() / tolerance);
        m_progress->setValue(static_cast<int>(1000 * std::clamp(done, 0.0, 1.0)));
        // Moves are those on the volume, as in the message at the end and in the list of runs.
        const std::vector<OptimizeState>& history = run.underWay()->history;
        const auto whole = std::count_if(history.begin(), history.end(), [](const auto& s) { return s.level == 0; });
        m_progress->setFormat((history.back().level == 0 ? tr("move %1, %2").arg(whole - 1) : tr("coarse, %1"))
                                  .arg(terms().offTarget(run.objective())));
    }
    m_optimize->setVisible(!on);
    m_cancel->setVisible(on);
    m_progress->setVisible(on);
    m_distance->setVisible(!on);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_table, m_density, m_colors, m_add, m_targets})
        widget->setEnabled(!on);
    follow();
}

void FeaturesPanel::showMessage() {
    const OptimizeController& optimizing = m_controllers.optimizing;
    const QString& text = optimizing.message();
    m_message->setText(text);
    m_message->setVisible(!text.isEmpty());
    for (QToolButton* button : m_choices) button->deleteLater(); // it may be the one that was clicked
    m_choices.clear();
    for (std::size_t i = 0; i < optimizing.choices().size(); ++i) {
        auto* const button = named(toolButton(optimizing.choices()[i].text, this),
                                   QStringLiteral("messageChoice%1").arg(i), tr("Do that; undo takes it back"));
        connect(button, &QToolButton::clicked, &m_controllers.optimizing,
                [&run = m_controllers.optimizing, i] { run.take(i); });
        m_choiceRows->addWidget(button, static_cast<int>(i) / 2, static_cast<int>(i) % 2, Qt::AlignLeft);
        m_choices.push_back(button);
    }
}

/// A feature that no voxel has has no share, and no target: it can go.
void FeaturesPanel::showEmpty() {
    const auto& features = m_services.scene().tf.features;
    m_empty = 0;
    QString name;
    for (std::size_t f = features.size(); f-- > 0;)
        if (m_services.scene().isEmpty(f)) {
            m_empty = features[f].id;
            name = QString::fromStdString(features[f].name);
        }
    m_emptyLabel->setText(tr("%1 is empty: no voxel has its values.").arg(name));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_emptyLabel, m_removeEmpty})
        widget->setVisible(m_empty != 0);
    m_removeEmpty->setEnabled(m_services.isEditable());
}

void FeaturesPanel::removeEmpty() {
    const int feature = featureWithId(m_services.scene().tf, m_empty);
    if (feature < 0 || !m_services.isEditable()) return;
    m_services.attempt(tr("Remove empty feature"), [&] {
        m_services.store().commit();
        editTf(m_services.store(), withFeatureRemoved(m_services.scene().tf, feature), tr("Remove empty feature"));
    });
}

/// That some viewers, or all, can hardly tell two features apart by their colours.
void FeaturesPanel::showAlike() {
    m_mendColors->setEnabled(m_services.isEditable());
    const Scene& scene = m_services.scene();
    // Colours of several variables are no feature's.
    const TransferFunction tf = scene.volume && !scene.colors ? scene.wantedTf() : TransferFunction();
    if (tf == m_told && !m_alikeLabel->text().isEmpty() == !m_mendColors->isHidden()) return;
    m_told = tf;
    const std::vector<AlikePair> alike = alikeFeatures(tf, featuresToTell(tf));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_alikeLabel, m_mendColors})
        widget->setVisible(!alike.empty());
    if (alike.empty()) return m_alikeLabel->clear();
    constexpr std::size_t kMostLines = 8;
    QStringList lines;
    for (std::size_t i = 0; i < alike.size() && i < kMostLines; ++i)
        lines << QString::fromStdString(alikeText(tf, alike[i]));
    if (alike.size() > kMostLines) lines << tr("and %1 more pairs").arg(alike.size() - kMostLines);
    const auto nameOf = [&](std::size_t feature) { return QString::fromStdString(tf.features[feature].name); };
    m_alikeLabel->setText(tr("⚠ Alike: %1 and %2").arg(nameOf(alike[0].first), nameOf(alike[0].second)) +
                          (alike.size() > 1 ? tr(", and others") : QString()));
    m_alikeLabel->setToolTip(lines.join('\n'));
    m_alikeLabel->setAccessibleName(lines.join(QStringLiteral(". ")));
}

void FeaturesPanel::mendColors() {
    if (!m_services.isEditable()) return;
    m_services.store().commit();
    const Scene& scene = m_services.scene();
    const auto mended = withColorsApart(scene.tf, featuresToTell(scene.wantedTf()));
    if (!mended)
        return Q_EMIT m_services.message(
            tr("No colours were found that tell all these features apart for every viewer"));
    editTf(m_services.store(), *mended, tr("Mend colours"));
}

void FeaturesPanel::follow() {
    const SessionStore& store = m_services.store();
    const bool ready = m_services.isEditable();
    const bool features = !store.scene().tf.features.empty();
    m_refine->setEnabled(ready);
    m_optimize->setEnabled(ready && features);
    m_undo->setEnabled(ready && store.canUndo());
    m_redo->setEnabled(ready && store.canRedo());
    for (QWidget* widget : std::initializer_list<QWidget*>{m_density, m_colors, m_add, m_targets})
        widget->setEnabled(ready);
    followSelection();
    showEmpty();
    showAlike();

    const Results& results = m_services.results();
    m_distance->setEnabled(results.vwsIsCurrent());
    if (results.state() == Results::State::Failed) {
        m_distance->setText(tr("Not measured: %1").arg(QString::fromStdString(results.failure()->problem())));
    } else if (const auto f = results.objective()) {
        QString text = terms().offTarget(*f);
        text[0] = text[0].toUpper();
        m_distance->setText(text);
    } else {
        m_distance->setText(store.hasVolume() && features ? tr("Measuring…") : QString());
    }
}

} // namespace

PanelInfo featuresPanel() {
    return {.id = "features",
            .title = QObject::tr("Features"),
            .group = PanelGroup::Shares,
            .keys = QKeySequence("Ctrl+2"),
            .tip = QObject::tr("What each feature shows and what it should show"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                followTitle(services, parent, featuresTitle);
                const QString place = QObject::tr("Features");
                services.actions().addGestures(
                    {{place, QObject::tr("Click on an eye"), QObject::tr("show or hide the feature")},
                     {place, QObject::tr("Alt or Ctrl+click on an eye"), QObject::tr("draw only this feature, or all")},
                     {place, QObject::tr("Click on a colour"), QObject::tr("change it")},
                     {place, QObject::tr("Double-click on a name, F2"), QObject::tr("rename the feature")},
                     {place, QObject::tr("Double-click on a target, Enter, a digit"), QObject::tr("type the target")},
                     {place, QObject::tr("Click on a target's padlock, L"),
                      QObject::tr("hold the target where others are set")}});
                return new FeaturesPanel(services, controllers, parent);
            }};
}

} // namespace pellucid::gui
