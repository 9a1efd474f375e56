#include "panels/convergence_panel.h"

#include <algorithm>

#include <QCheckBox>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>
#include <QTreeWidget>

#include "controllers/controllers.h"
#include "jobs/rest_timer.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/plot_words.h"
#include "report/convergence.h"
#include "report/csv.h"
#include "store/edits.h"
#include "tf/shown_tf.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/plot_view.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kNumber = Qt::UserRole; ///< of a row's run
enum Column { kTitle, kMoves, kDistance, kSeconds };

bool isCurve(const Run& run) { return run.kind == "optimize" && !run.history.empty(); }

QIcon swatch(const QColor& color) {
    QPixmap pixmap(14, 14);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawRoundedRect(QRectF(1, 4, 12, 6), 2, 2);
    return pixmap;
}

Rgb colorOf(const Run& run) { return curveColor(static_cast<std::size_t>(std::max(0, run.number - 1))); }

QString tipOf(const Run& run) {
    QStringList lines{
        QObject::tr("%1, from %2; %3")
            .arg(terms().offTarget(run.after), terms().distanceText(run.before), QString::fromStdString(run.ended))};
    const auto coarse =
        std::count_if(run.history.begin(), run.history.end(), [](const auto& s) { return s.level > 0; });
    const auto others = static_cast<std::ptrdiff_t>(run.history.size()) - 1 - run.iterations - coarse;
    QStringList moves{QObject::tr("%1 on the volume").arg(run.iterations)};
    if (coarse > 0) moves << QObject::tr("%1 along rays").arg(coarse);
    if (others > 0) moves << QObject::tr("%1 after the search, for the strength of the picture").arg(others);
    lines << QObject::tr("moves: %1").arg(moves.join(", "));
    if (run.evaluations > 0) lines << QObject::tr("%1 evaluations of the features' saliency").arg(run.evaluations);
    if (run.seconds > 0) lines << QObject::tr("%1 s").arg(shortNumber(run.seconds));
    if (!run.started.empty())
        lines << QObject::tr("begun %1").arg(QString::fromStdString(run.started).replace('T', ' '));
    QStringList targets;
    for (std::size_t f = 0; f < run.features.size() && f < run.targets.size(); ++f)
        targets << QStringLiteral("%1 %2").arg(QString::fromStdString(run.features[f]), shortNumber(run.targets[f]));
    lines << QObject::tr("targets: %1").arg(targets.join(", "));
    return lines.join('\n');
}

void changeRuns(Services& services, const QString& text, const std::function<void(std::vector<Run>&)>& change) {
    editPart(services.store(), &Session::runs, text, {}, change);
}

} // namespace

PanelInfo convergencePanel() {
    return {
        .id = "convergence",
        .title = QObject::tr("Convergence"),
        .group = PanelGroup::Shares,
        .area = Qt::BottomDockWidgetArea,
        .visible = false,
        .tabOf = "tf",
        .keys = QKeySequence("Ctrl+Shift+C"),
        .tip = QObject::tr("How optimizations go: distance from the targets, attention and opacities over the moves"),
        .make = [](Services& services, Controllers& controllers, QWidget* parent) {
            services.actions().add(
                QObject::tr("&Transfer function"), "showConvergence", QObject::tr("Con&vergence of the optimization"),
                {}, QObject::tr("Distance from the targets, attention and opacities over the moves"),
                [&services] { services.panels().show("convergence"); },
                [&services] { return services.store().hasVolume(); });
            services.actions().addGestures(
                {{QObject::tr("Convergence"), QObject::tr("Click on a dot"), QObject::tr("show that move")},
                 {QObject::tr("Convergence"), QObject::tr("Double-click"), QObject::tr("export")},
                 {QObject::tr("Convergence"), "F2, Del", QObject::tr("rename, delete the run")}});
            return new ConvergencePanel(services, controllers.optimizing, controllers.saving, parent);
        }};
}

ConvergencePanel::ConvergencePanel(Services& services, OptimizeController& optimizing, SaveController& saving,
                                   QWidget* parent)
    : QWidget(parent), m_services(services), m_optimizing(optimizing), m_saving(saving),
      m_row(new QBoxLayout(QBoxLayout::LeftToRight)),
      m_list(named(new QTreeWidget(this), "runList", tr("Optimizations, the latest first; a selected one is drawn"))),
      m_log(named(new QCheckBox(tr("Logarithmic"), this), "convergenceLog", tr("F and opacities on logarithmic axes"))),
      m_readOut(withAnyWidth(named(new QLabel(this), "convergenceReadOut"))),
      m_start(named(toolButton(tr("To the start"), this), "showStart",
                    tr("Show the transfer function that the selected run began with:\n"
                       "another method can go on from there, to be compared"))),
      m_export(named(menuButton(tr("Export…"), this), "exportCurves",
                     tr("The curves as a table, the plots as a picture or drawing"))) {
    m_readOut->setTextInteractionFlags(Qt::TextSelectableByMouse);
    for (const auto& [suffix, text] :
         {std::pair{"csv", tr("Table (CSV)…")}, {"png", tr("Picture (PNG)…")}, {"svg", tr("Drawing (SVG)…")}})
        m_export->menu()
            ->addAction(text, this, [this, suffix = QString(suffix)] { chooseFile(suffix); })
            ->setObjectName(QStringLiteral("exportCurves_%1").arg(suffix));
    m_list->setAccessibleName(tr("Optimizations"));
    makePlots();
    makeList();
    m_row->addLayout(columnOf({{m_list, 1}, rowOf({m_log, Cell::rest(), m_start, m_export})}));
    setLayout(inset(columnOf({{m_row, 1}, m_readOut}, 2), {4, 4, 4, 2}));

    connect(m_log, &QCheckBox::toggled, this, &ConvergencePanel::drawPlots);
    connect(m_start, &QToolButton::clicked, this, [this] {
        if (const Run* run = shownRun()) showMove(*run, 0);
    });
    connect(&services, &Services::readOnlyChanged, this, &ConvergencePanel::drawPlots);
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.series != after.series) {
            m_compared.clear();
            m_shown = -1;
            m_latest = 0;
        }
        if (before.series != after.series || !before.session.runs.isSame(after.session.runs)) follow();
    });
    connect(&optimizing, &OptimizeController::moved, this, [this] { drawPlots(); });
    connect(&optimizing, &OptimizeController::runningChanged, this, &ConvergencePanel::follow);
    follow();
}

void ConvergencePanel::makePlots() {
    const std::pair<const char*, QString> plots[] = {
        {"objectivePlot", tr("F: the root mean square distance of the features' VWS from their targets, after each\n"
                             "move; dashed: the tolerance. Dots of moves along rays are hollow.\n"
                             "Click on a dot: show that move. Double-click: export.")},
        {"vwsPlot", tr("VWS, each feature's share of what catches the eye, 0 to 1; dashed: the targets")},
        {"opacityPlot", tr("The peak opacity of each feature, 0 to 1, of a path of one reference length d0")}};
    for (std::size_t i = 0; i < m_plots.size(); ++i) {
        PlotView* const plot = m_plots[i] = named(new PlotView(this), plots[i].first, plots[i].second);
        plot->setContextMenuPolicy(Qt::CustomContextMenu);
        m_row->addWidget(plot, 1);
        connect(plot, &PlotView::readOut, m_readOut, &QLabel::setText);
        connect(plot, &PlotView::exportWanted, this, [this] { chooseFile({}); });
        connect(plot, &QWidget::customContextMenuRequested, this,
                [this, plot](const QPoint& at) { showMenu(plot->mapToGlobal(at), false); });
        connect(plot, &PlotView::dotClicked, this, [this, i](int series, int point) {
            const auto compared = comparedRuns();
            // Dotted series of the first plot are the compared runs, in their order.
            const Run* run = i > 0                                        ? shownRun()
                             : series < static_cast<int>(compared.size()) ? compared[static_cast<std::size_t>(series)]
                                                                          : nullptr;
            if (run != nullptr) showMove(*run, point);
        });
    }
}

void ConvergencePanel::makeList() {
    elideInTheMiddle(*m_list);
    m_list->setRootIsDecorated(false);
    m_list->setHeaderLabels({tr("Run"), tr("Moves"), tr("F"), tr("s")});
    const QString tips[] = {tr("Checked runs are compared in the first plot; the selected one has\n"
                               "the other two. F2 renames, Del deletes."),
                            tr("Moves of the search on the volume itself. The plots also have those along\n"
                               "rays, hollow, and those that follow for the strength of the picture"),
                            tr("Distance from the targets at the end"), tr("Seconds that the search took")};
    m_list->header()->setStretchLastSection(false);
    for (int column = 0; column <= kSeconds; ++column) {
        m_list->headerItem()->setToolTip(column, tips[column]);
        m_list->header()->setSectionResizeMode(column,
                                               column == kTitle ? QHeaderView::Stretch : QHeaderView::ResizeToContents);
    }
    m_list->setContextMenuPolicy(Qt::CustomContextMenu);
    m_list->setMinimumWidth(200);
    m_list->installEventFilter(this);
    m_list->setEditTriggers(QAbstractItemView::NoEditTriggers);
    connect(m_list, &QTreeWidget::itemDoubleClicked, this, &ConvergencePanel::rename);
    connect(m_list, &QTreeWidget::itemChanged, this, &ConvergencePanel::itemChanged);
    connect(m_list, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
        if (item == nullptr) return;
        m_shown = item->data(0, kNumber).toInt();
        drawPlots();
    });
    connect(m_list, &QWidget::customContextMenuRequested, this,
            [this](const QPoint& at) { showMenu(m_list->viewport()->mapToGlobal(at), true); });
}

const Run* ConvergencePanel::runNumbered(int number) const {
    if (number == kUnderWay) return m_optimizing.underWay();
    for (const Run& run : *m_services.scene().session.runs)
        if (run.number == number && isCurve(run)) return &run;
    return nullptr;
}

const Run* ConvergencePanel::shownRun() const {
    if (const Run* run = m_optimizing.underWay()) return isCurve(*run) ? run : nullptr;
    if (const Run* run = runNumbered(m_shown)) return run;
    const std::vector<Run>& runs = *m_services.scene().session.runs;
    const auto latest = std::find_if(runs.rbegin(), runs.rend(), isCurve);
    return latest == runs.rend() ? nullptr : &*latest;
}

std::vector<const Run*> ConvergencePanel::comparedRuns() const {
    std::vector<const Run*> runs;
    for (const int number : m_compared)
        if (const Run* run = number == kUnderWay ? nullptr : runNumbered(number)) runs.push_back(run);
    const Run* const now = m_optimizing.underWay();
    if (now != nullptr && isCurve(*now)) runs.push_back(now);
    if (runs.empty())
        if (const Run* run = shownRun()) runs.push_back(run);
    return runs;
}

std::vector<Plot> ConvergencePanel::plots() const {
    std::vector<RunCurve> curves;
    for (const Run* run : comparedRuns()) curves.push_back({run, colorOf(*run)});
    static const Run kNone;
    const Run* const shown = shownRun();
    const Run& run = shown != nullptr ? *shown : kNone;
    return {objectivePlot(curves, m_log->isChecked()), vwsPlot(run), opacityPlot(run, m_log->isChecked())};
}

void ConvergencePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    drawPlots(); // while hidden it has drawn nothing
}

void ConvergencePanel::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    // Beside each other where it is wide, below each other where it is a column.
    m_row->setDirection(width() > height() ? QBoxLayout::LeftToRight : QBoxLayout::TopToBottom);
}

void ConvergencePanel::follow() {
    for (const Run& run : *m_services.scene().session.runs)
        if (run.number > m_latest) { // it is what one wants to see now
            m_latest = run.number;
            if (!isCurve(run)) continue;
            m_compared.insert(run.number);
            m_shown = run.number;
        }
    fillList();
    drawPlots();
}

void ConvergencePanel::fillList() {
    const QSignalBlocker quiet(m_list);
    m_list->clear();
    const auto add = [this](const Run& run, bool ended) {
        auto* item = new QTreeWidgetItem;
        item->setData(kTitle, kNumber, ended ? run.number : kUnderWay);
        item->setText(kTitle, ended ? QString::fromStdString(titleOf(run)) : tr("under way"));
        item->setIcon(kTitle, swatch(colorFromRgb(colorOf(run))));
        item->setText(kMoves, QString::number(run.iterations));
        item->setText(kDistance, shortNumber(run.after));
        item->setText(kSeconds, run.seconds > 0 ? shortNumber(run.seconds) : QString());
        for (const int column : {kMoves, kDistance, kSeconds})
            item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
        for (int column = 0; column <= kSeconds; ++column) item->setToolTip(column, tipOf(run));
        if (ended) {
            item->setFlags(item->flags() | Qt::ItemIsUserCheckable | Qt::ItemIsEditable);
            item->setCheckState(kTitle, m_compared.count(run.number) != 0 ? Qt::Checked : Qt::Unchecked);
        }
        m_list->insertTopLevelItem(0, item); // the latest first
        if (shownRun() == &run) m_list->setCurrentItem(item);
    };
    for (const Run& run : *m_services.scene().session.runs)
        if (isCurve(run)) add(run, true);
}

void ConvergencePanel::drawPlots() {
    const bool any = shownRun() != nullptr;
    m_export->setEnabled(any);
    m_start->setEnabled(any && !m_services.isReadOnly());
    m_log->setEnabled(any);
    if (!isVisible()) return;
    std::vector<Plot> all = plots();
    for (std::size_t i = 0; i < m_plots.size(); ++i) m_plots[i]->setPlot(inWords(std::move(all[i])));
    if (!any)
        m_readOut->setText(tr("Optimize, and the moves are drawn here."));
    else if (!m_plots[0]->underMouse() && !m_plots[1]->underMouse() && !m_plots[2]->underMouse())
        m_readOut->setText({});
}

void ConvergencePanel::showMove(const Run& run, int move) {
    if (m_services.isReadOnly() || move < 0 || move >= static_cast<int>(run.history.size())) return;
    const TransferFunction& base = run.hasStart() ? run.start->tf : m_services.scene().tf;
    const OptimizeState& state = run.history[static_cast<std::size_t>(move)];
    if (base.features.size() != state.opacity.size()) return;
    try {
        editTf(m_services.store(), withShownOpacities(base, state.opacity),
               move == 0 ? tr("Show the start") : tr("Show move %1").arg(move));
    } catch (const Error& error) {
        m_services.showError(tr("The move cannot be shown"), error);
    }
}

void ConvergencePanel::itemChanged(QTreeWidgetItem* item) {
    const int number = item->data(kTitle, kNumber).toInt();
    const Run* const run = runNumbered(number);
    if (run == nullptr) return;
    item->checkState(kTitle) == Qt::Checked ? (void)m_compared.insert(number) : (void)m_compared.erase(number);
    const std::string name = item->text(kTitle).trimmed().toStdString();
    if (name != titleOf(*run) && !m_services.isReadOnly()) {
        // Later: the list is made anew by it, and this is called from inside the list.
        later(this, [this, number, name] {
            changeRuns(m_services, tr("Rename run"), [&](std::vector<Run>& runs) {
                for (Run& r : runs)
                    if (r.number == number) r.name = name;
            });
            fillList();
        });
    }
    drawPlots();
}

void ConvergencePanel::remove() {
    const QTreeWidgetItem* const item = m_list->currentItem();
    if (item == nullptr || m_services.isReadOnly()) return;
    const int number = item->data(kTitle, kNumber).toInt();
    changeRuns(m_services, tr("Delete run"),
               [&](std::vector<Run>& runs) { std::erase_if(runs, [&](const Run& r) { return r.number == number; }); });
}

void ConvergencePanel::clear() {
    if (m_services.isReadOnly()) return;
    changeRuns(m_services, tr("Clear runs"), [](std::vector<Run>& runs) { std::erase_if(runs, isCurve); });
}

bool ConvergencePanel::eventFilter(QObject* watched, QEvent* event) {
    if (watched != m_list || event->type() != QEvent::KeyPress) return QWidget::eventFilter(watched, event);
    switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_F2:
        rename();
        return true;
    case Qt::Key_Delete:
        remove();
        return true;
    default:
        return QWidget::eventFilter(watched, event);
    }
}

void ConvergencePanel::rename() {
    QTreeWidgetItem* const item = m_list->currentItem();
    if (item != nullptr && item->flags().testFlag(Qt::ItemIsEditable) && !m_services.isReadOnly())
        m_list->editItem(item, kTitle); // whatever column the mouse was on
}

void ConvergencePanel::showMenu(const QPoint& global, bool ofList) {
    QMenu menu(this);
    menu.setObjectName("convergenceMenu");
    const QTreeWidgetItem* const item = m_list->currentItem();
    const Run* const run = shownRun();
    if (ofList && item != nullptr) {
        const bool ended = item->flags().testFlag(Qt::ItemIsEditable) && !m_services.isReadOnly();
        menu.addAction(tr("Rename"), this, &ConvergencePanel::rename)->setEnabled(ended);
        menu.addAction(tr("Delete"), this, &ConvergencePanel::remove)->setEnabled(ended);
        menu.addAction(tr("Delete all"), this, &ConvergencePanel::clear)->setEnabled(ended);
        menu.addSeparator();
    }
    if (run != nullptr) {
        const bool mayEdit = !m_services.isReadOnly();
        const auto add = [&, number = run->number](const QString& text, bool enabled, auto does) {
            menu.addAction(text, this,
                           [this, number, does] {
                               if (const Run* r = runNumbered(number)) does(*r); // it may have gone meanwhile
                           })
                ->setEnabled(enabled);
        };
        add(tr("Show the start"), mayEdit, [this](const Run& r) { showMove(r, 0); });
        add(tr("Show the answer"), mayEdit, [this](const Run& r) { showMove(r, static_cast<int>(r.best)); });
        add(tr("Save report…"), mayEdit && run->hasStart(), [this](const Run& r) { m_saving.chooseReport(r); });
        menu.addSeparator();
        menu.addActions(m_export->menu()->actions());
    }
    if (!menu.isEmpty()) menu.exec(global);
}

void ConvergencePanel::chooseFile(const QString& suffix) {
    if (shownRun() == nullptr) return;
    const QString path = askCurveFile(m_services, tr("Export the curves"), "curves", suffix);
    if (!path.isEmpty()) exportTo(path);
}

void ConvergencePanel::exportTo(const QString& path) {
    const auto table = [this] {
        std::vector<const Run*> runs = comparedRuns();
        if (const Run* shown = shownRun(); shown && std::find(runs.begin(), runs.end(), shown) == runs.end())
            runs.push_back(shown);
        return csvOf(runs);
    };
    exportCurves(m_services, path, table, [this] { return plots(); });
}

} // namespace pellucid::gui
