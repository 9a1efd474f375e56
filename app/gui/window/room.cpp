#include "window/room.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <QDockWidget>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QMenuBar>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>

#include "jobs/rest_timer.h"
#include "panels/target_bars.h"
#include "services/services.h"
#include "store/view_edits.h"
#include "view/volume_view.h"
#include "widgets/named.h"
#include "widgets/scrolled.h"

namespace pellucid::gui {
namespace {

constexpr int kBarsWidth = 300;   // logical pixels
constexpr int kLayoutVersion = 3; // of what saveState() writes: another one where docks or tool bars have become others

// What the docks take of the window at first, logical pixels: as little as they can be used with, more of a large one.
constexpr int kLeastBeside = 284, kMostBeside = 360;
constexpr double kBeside = 0.22; // of the width
constexpr int kLeastBelow = 203, kMostBelow = 300;
constexpr double kBelow = 0.25; // of the height
constexpr int kPlayerFrame = 8; // around what it holds
constexpr int kTabs = 26;       // what a row of tabs needs

struct TaskText {
    Task task;
    const char *id, *text, *tip;
    std::initializer_list<const char*> panels; ///< that are open at first; of tabs, those before lie in front
};
const TaskText kTasks[] = {
    {Task::Explore,
     "taskExploreAction",
     QT_TRANSLATE_NOOP("Room", "&Explore"),
     QT_TRANSLATE_NOOP("Room", "Features and presets beside the picture, the curve below it"),
     {"tf", "features", "gallery"}},
    {Task::Targets,
     "taskTargetsAction",
     QT_TRANSLATE_NOOP("Room", "&Targets"),
     QT_TRANSLATE_NOOP("Room", "Features with their targets, and how optimizations go"),
     {"tf", "features", "convergence", "influence"}},
    {Task::Series,
     "taskSeriesAction",
     QT_TRANSLATE_NOOP("Room", "&Series"),
     QT_TRANSLATE_NOOP("Room", "The player, and curves over time"),
     {"tf", "features", "player", "temporal"}},
    {Task::Slices,
     "taskSlicesAction",
     QT_TRANSLATE_NOOP("Room", "S&lices"),
     QT_TRANSLATE_NOOP("Room", "The volume and three slices, with what is shown of them"),
     {"tf", "features", "display"}},
};

const TaskText& textOf(Task task) { return kTasks[static_cast<std::size_t>(task)]; }

QString keyOf(Task task) { return QStringLiteral("layouts/") + name(task); }

} // namespace

Room::Room(QMainWindow& window, Services& services, QHBoxLayout& row)
    : QObject(&window), m_window(window), m_services(services), m_row(row) {}

void Room::addActions() {
    ActionMenu menu(m_services.actions(), tr("&View") + "/" + tr("&Workspace"));
    for (const TaskText& t : kTasks)
        menu.addCheck(
            t.id, tr(t.text), {}, tr(t.tip), [this, task = t.task] { return m_task == task; },
            [this, task = t.task] { choose(task); });
    menu.separate();
    menu.add("resetLayoutAction", tr("&Reset layout"), {}, tr("The panels of this workspace as they were at first"),
             [this] { reset(); });
    menu.addCheck(
        "focusAction", tr("&Focus on the picture"), "F11",
        tr("The picture and the bars of the features, nothing else; Tab in the picture does the same"),
        [this] { return isFocused(); }, [this] { setFocused(!isFocused()); });
    Actions& actions = m_services.actions();
    menu.addCheck(
        "toolBarWordsAction", tr("&Words in the tool bar"), {}, tr("Names below the icons of the tool bar"),
        [&actions] { return actions.hasWords(); }, [&actions] { actions.showWords(!actions.hasWords()); });
    actions.addGestures({{tr("Volume"), tr("Tab"), tr("focus on the picture, and back")}});
}

void Room::panelsAdded() {
    m_first = m_window.saveState(kLayoutVersion);
    if (auto* const view = m_window.findChild<VolumeView*>()) view->installEventFilter(this);
}

void Room::restore() {
    const QSettings settings;
    m_window.restoreGeometry(settings.value("geometry").toByteArray());
    m_arranged = m_window.restoreState(settings.value("windowState").toByteArray(), kLayoutVersion);
    m_task = findNamed<Task>(settings.value("task").toString().toStdString()).value_or(Task::Explore);
}

void Room::shown() {
    if (!std::exchange(m_arranged, true)) shareOut();
}

void Room::save() {
    setFocused(false);
    QSettings settings;
    settings.setValue("geometry", m_window.saveGeometry());
    settings.setValue("windowState", m_window.saveState(kLayoutVersion));
    settings.setValue("task", QString::fromLatin1(name(m_task)));
}

void Room::showFirst(Task task) {
    m_window.restoreState(m_first, kLayoutVersion);
    Panels& panels = m_services.panels();
    for (QDockWidget* dock : m_window.findChildren<QDockWidget*>()) dock->hide();
    const auto wanted = textOf(task).panels;
    for (auto id = std::rbegin(wanted); id != std::rend(wanted); ++id) panels.show(*id); // the first ends up in front
    later(this, [this] { shareOut(); });                                                 // when they have been laid out
}

void Room::shareOut() {
    const auto share = [](double part, int of, int least, int most) {
        return std::clamp(static_cast<int>(part * of), least, most);
    };
    Panels& panels = m_services.panels();
    QDockWidget &curve = *panels.dock("tf"), &player = *panels.dock("player");
    int beside = share(kBeside, m_window.width(), kLeastBeside, kMostBeside);
    for (QDockWidget* dock : m_window.findChildren<QDockWidget*>())
        if (!dock->isHidden() && m_window.dockWidgetArea(dock) == Qt::RightDockWidgetArea)
            beside = std::max(beside, dock->widget()->minimumSizeHint().width());
    m_window.resizeDocks({panels.dock("features")}, {beside}, Qt::Horizontal);
    const QList<QDockWidget*> others = m_window.tabifiedDockWidgets(&curve);
    const bool hasTabs = std::ranges::any_of(others, [](const QDockWidget* dock) { return !dock->isHidden(); });
    m_window.resizeDocks({&curve}, {share(kBelow, m_window.height(), kLeastBelow, kMostBelow) + (hasTabs ? kTabs : 0)},
                         Qt::Vertical);
    if (player.isHidden()) return;
    // The player is no wider than it must be: the curve has the rest.
    const int least = static_cast<DockScroll*>(player.widget())->leastOfContent().width() + kPlayerFrame;
    const int both = curve.width() + player.width();
    m_window.resizeDocks({&curve, &player}, {both - least, least}, Qt::Horizontal);
}

void Room::choose(Task task) {
    setFocused(false);
    QSettings settings;
    settings.setValue(keyOf(m_task), m_window.saveState(kLayoutVersion));
    const Task before = std::exchange(m_task, task);
    const QByteArray left = settings.value(keyOf(task)).toByteArray();
    if (left.isEmpty() || !m_window.restoreState(left, kLayoutVersion)) showFirst(task);
    SessionStore& store = m_services.store();
    if (m_services.isEditable() && before != task && (before == Task::Slices || task == Task::Slices))
        setLayout(store, task == Task::Slices ? SliceViews::Layout::Four : SliceViews::Layout::Volume);
    m_services.actions().refresh();
}

void Room::reset() {
    setFocused(false);
    QSettings().remove(keyOf(m_task));
    showFirst(m_task);
}

void Room::setFocused(bool focused) {
    if (focused == isFocused()) return;
    QList<QWidget*> around{m_window.menuBar(), m_window.statusBar()};
    for (QToolBar* bar : m_window.findChildren<QToolBar*>(QString(), Qt::FindDirectChildrenOnly)) around << bar;
    if (focused) {
        m_unfocused = m_window.saveState(kLayoutVersion);
        for (QDockWidget* dock : m_window.findChildren<QDockWidget*>()) dock->hide();
        m_bars = named(new TargetBars(m_services.store(), m_services.results(), m_window.centralWidget()), "focusBars");
        m_bars->setFixedWidth(kBarsWidth);
        m_bars->setReadOnly(m_services.isReadOnly());
        connect(&m_services, &Services::readOnlyChanged, m_bars,
                [this] { m_bars->setReadOnly(m_services.isReadOnly()); });
        m_row.addWidget(m_bars, 0, Qt::AlignTop);
        m_bars->show();
    } else {
        delete std::exchange(m_bars, nullptr);
        m_window.restoreState(m_unfocused, kLayoutVersion);
    }
    for (QWidget* widget : around) widget->setVisible(!focused);
    m_services.actions().refresh();
}

bool Room::eventFilter(QObject* watched, QEvent* event) {
    const bool isKey = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
    if (!isKey || static_cast<QKeyEvent*>(event)->key() != Qt::Key_Tab ||
        static_cast<QKeyEvent*>(event)->modifiers() != Qt::NoModifier)
        return QObject::eventFilter(watched, event);
    event->accept();
    if (event->type() == QEvent::KeyPress) setFocused(!isFocused());
    return true;
}

} // namespace pellucid::gui
