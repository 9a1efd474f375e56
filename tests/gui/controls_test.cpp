// Every control of the window, of its panels and of its dialogs: what it is called, what it tells of itself, its unit,
// its value for those who hear it, and the keyboard's way to it.
#include "gui_support.h"

#include <set>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QColorDialog>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QHeaderView>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QLineEdit>
#include <QMenuBar>
#include <QMessageBox>
#include <QRegularExpression>
#include <QScrollArea>
#include <QScrollBar>
#include <QSpinBox>
#include <QStatusBar>
#include <QTabBar>
#include <QTextEdit>
#include <QTimer>
#include <QToolBar>
#include <QToolButton>

#include "panels/panel.h"
#include "widgets/input_habits.h"
#include "widgets/spoken_value.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

template <class T>
bool is(const QWidget& widget) {
    return qobject_cast<const T*>(&widget) != nullptr;
}

/// Parts that a control of the toolkit is made of: the control speaks for them.
bool isPart(const QWidget& widget) {
    const QWidget* parent = widget.parentWidget();
    if (widget.objectName().startsWith("qt_") || widget.inherits("QTableCornerButton") || is<QScrollBar>(widget) ||
        is<QHeaderView>(widget))
        return true;
    if (parent == nullptr) return false;
    if (is<QLineEdit>(widget))
        return is<QAbstractSpinBox>(*parent) || is<QComboBox>(*parent) || is<QKeySequenceEdit>(*parent);
    if (is<QAbstractItemView>(widget)) return parent->inherits("QComboBoxPrivateContainer");
    // The arrows of tab bars, the button that clears a line, the one behind a tool bar that is too long.
    return (is<QAbstractButton>(widget) && (is<QTabBar>(*parent) || is<QLineEdit>(*parent))) ||
           widget.inherits("QToolBarExtension") || parent->inherits("QComboBoxPrivateContainer");
}

bool isControl(const QWidget& widget) {
    return is<QAbstractButton>(widget) || is<QAbstractSlider>(widget) || is<QAbstractSpinBox>(widget) ||
           is<QComboBox>(widget) || is<QLineEdit>(widget) || is<QAbstractItemView>(widget) || is<QTextEdit>(widget) ||
           is<QKeySequenceEdit>(widget);
}

QString spokenName(QWidget& widget) {
    QAccessibleInterface* const spoken = QAccessible::queryAccessibleInterface(&widget);
    return spoken == nullptr ? QString() : spoken->text(QAccessible::Name);
}

/// Its own, or that of the label that names it.
QString tipOf(const QWidget& widget, const QWidget& root) {
    if (!widget.toolTip().isEmpty()) return widget.toolTip();
    if (!widget.whatsThis().isEmpty()) return widget.whatsThis();
    for (const auto* label : root.findChildren<QLabel*>())
        if (label->buddy() == &widget && !label->toolTip().isEmpty()) return label->toolTip();
    return {};
}

/// Whether people can know what its number counts: by its suffix, its values' range or words of the tip.
bool hasUnit(const QAbstractSpinBox& box, const QString& tip) {
    if (const auto* whole = qobject_cast<const QSpinBox*>(&box); whole != nullptr && !whole->suffix().isEmpty())
        return true;
    if (const auto* number = qobject_cast<const QDoubleSpinBox*>(&box);
        number != nullptr && !number->suffix().isEmpty())
        return true;
    static const QRegularExpression kUnits(
        "\\b(from|above|below|pixels?|voxels?|frames?|degrees|mm|seconds?|dpi|GiB|MB|bytes?|bins?|steps?|views?|"
        "features?|points?|values? of the data|units? of the data|share|times|units|number of|how many|world)\\b");
    return tip.contains(kUnits);
}

/// What is wrong with the controls below a widget, a line each.
class Walk {
public:
    void look(QWidget& root, const QString& place) {
        for (auto* widget : root.findChildren<QWidget*>())
            if (!isPart(*widget) && (isControl(*widget) || takesTab(*widget))) lookAt(*widget, root, place);
        for (auto* widget : root.findChildren<QWidget*>())
            if (dynamic_cast<Spoken*>(widget) != nullptr) hear(*widget, place);
    }
    const QStringList& faults() const { return m_faults; }
    int count() const { return m_count; }
    std::size_t spokenCount() const { return m_heard.size(); }

private:
    /// What paints itself says what it shows, whether it takes Tab or not.
    void hear(QWidget& widget, const QString& place) {
        if (!m_heard.insert(&widget).second) return;
        if (heardValue(widget).trimmed().isEmpty())
            m_faults << QStringLiteral("%1: %2 “%3” says nothing of what it shows")
                            .arg(place, widget.metaObject()->className(), widget.objectName());
    }
    static bool takesTab(const QWidget& widget) { return (widget.focusPolicy() & Qt::TabFocus) != 0; }

    void lookAt(QWidget& widget, const QWidget& root, const QString& place) {
        if (widget.window() != root.window() || !m_seen.insert(&widget).second) return;
        if (is<QScrollArea>(widget)) return; // what it scrolls is looked at
        ++m_count;
        const QString who =
            QStringLiteral("%1: %2 “%3” in %4")
                .arg(place, widget.metaObject()->className(), widget.objectName(),
                     widget.parentWidget() == nullptr ? QString() : widget.parentWidget()->objectName());
        const auto fault = [&](const char* what) { m_faults << who + ": " + what; };
        if (spokenName(widget).trimmed().isEmpty()) fault("has no name");
        // Those of the toolkit speak for themselves.
        const bool isOurs = QLatin1String(widget.metaObject()->className()).startsWith(QLatin1String("pellucid::"));
        if (isOurs && !isControl(widget) && heardValue(widget).trimmed().isEmpty())
            fault("says nothing of what it shows");
        const QString tip = tipOf(widget, root);
        const bool isClosing = is<QDialogButtonBox>(*widget.parentWidget()); // OK and Cancel
        if (tip.isEmpty() && !isClosing && !is<QTabBar>(widget)) fault("has no tip");
        // Actions of tool bars are in the menus, too, and the list of the palette is walked from its line by arrow
        // keys.
        const bool hasOtherWay = is<QToolBar>(root) || widget.objectName() == "paletteList";
        if (!takesTab(widget) && !hasOtherWay) fault("cannot be reached by Tab");
        if (const auto* box = qobject_cast<QAbstractSpinBox*>(&widget); box != nullptr && !hasUnit(*box, tip))
            fault("has no unit");
        if (!is<QAbstractSpinBox>(widget) && !is<QAbstractSlider>(widget)) return;
        QAccessibleInterface* const spoken = QAccessible::queryAccessibleInterface(&widget);
        if (spoken == nullptr || spoken->valueInterface() == nullptr ||
            !spoken->valueInterface()->currentValue().isValid())
            fault("tells no value");
    }

    QStringList m_faults;
    std::set<const QWidget*> m_seen, m_heard;
    int m_count = 0;
};

/// The controls that Tab, or Shift and Tab, come to from the first one on. (In the picture Tab is a command.)
std::set<QWidget*> reachedByTab(QWidget& first) {
    std::set<QWidget*> reached;
    for (const Qt::Key key : {Qt::Key_Tab, Qt::Key_Backtab}) {
        first.setFocus(Qt::TabFocusReason);
        std::set<QWidget*> way;
        for (int i = 0; i < 600; ++i) {
            QWidget* const now = QApplication::focusWidget();
            if (now == nullptr || now->objectName() == "volumeView" || !way.insert(now).second) break;
            QTest::keyClick(now, key);
        }
        reached.merge(way);
    }
    return reached;
}

std::vector<QWidget*> tabControls(QWidget& panel) {
    std::vector<QWidget*> controls;
    for (auto* widget : panel.findChildren<QWidget*>())
        if (widget->isVisible() && widget->isEnabled() && (widget->focusPolicy() & Qt::TabFocus) != 0 &&
            !isPart(*widget) && isControl(*widget))
            controls.push_back(widget);
    return controls;
}

/// Closes what an action has opened, after a look at it.
class DialogVisitor : public QObject {
public:
    DialogVisitor(Walk& walk, std::set<QString>& visited) : m_walk(walk), m_visited(visited) {
        QObject::connect(&m_timer, &QTimer::timeout, this, [this] { visit(); });
        m_timer.start(30);
    }

private:
    void visit() {
        auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (dialog == nullptr) return;
        const bool isOfToolkit = is<QFileDialog>(*dialog) || is<QMessageBox>(*dialog) || is<QColorDialog>(*dialog) ||
                                 dialog->inherits("QInputDialog");
        if (!isOfToolkit) {
            m_visited.insert(dialog->objectName());
            m_walk.look(*dialog, dialog->objectName());
        }
        dialog->reject();
    }

    Walk& m_walk;
    std::set<QString>& m_visited;
    QTimer m_timer;
};

/// The window as the program has it, with its habits.
struct HabitualWindow {
    HabitualWindow() { qApp->installEventFilter(&habits); }
    InputHabits habits;
};

std::string linesOf(const QStringList& lines) { return lines.join("\n").toStdString(); }

} // namespace

TEST_CASE("every control of the window and its panels has a name, a tip, a unit and a value", "[controls]") {
    HabitualWindow habits;
    OpenWindow w;
    Walk walk;
    for (const PanelInfo& panel : panelRegistry()) {
        w.services().panels().show(panel.id);
        QCoreApplication::processEvents();
        QDockWidget& dock = *w.services().panels().dock(panel.id);
        walk.look(dock, panel.id);
    }
    walk.look(*w.window.centralWidget(), "middle");
    walk.look(*w.window.statusBar(), "status line");
    for (auto* bar : w.window.findChildren<QToolBar*>()) walk.look(*bar, "tool bar");
    CHECK(walk.count() > 200); // so that nothing has been left out by mistake
    // Bars of targets, comparison and edges, curve, palette, strips of time and keys, globe, space, both of the probe,
    // border, slices, both views; plots come with their panels.
    CHECK(walk.spokenCount() >= 17);
    INFO(linesOf(walk.faults()));
    CHECK(walk.faults().isEmpty());
}

TEST_CASE("every control of every dialog has a name, a tip, a unit and a value", "[controls]") {
    HabitualWindow habits;
    OpenWindow w;
    QAction& live = w.child<QAction>("optimizeAction");
    REQUIRE(live.isEnabled());
    Walk walk;
    std::set<QString> visited;
    {
        DialogVisitor visitor(walk, visited);
        for (const ActionRow& row : w.services().actions().rows()) {
            const QString text = row.action->text();
            const bool opens = text.contains(QChar(0x2026)) || row.action->objectName() == "keysAction";
            if (!opens || !row.action->isEnabled()) continue;
            INFO(row.action->objectName().toStdString());
            row.action->trigger();
        }
    }
    std::string names;
    for (const QString& name : visited) names += name.toStdString() + " ";
    INFO("visited: " << names);
    for (const char* dialog : {"keysBox", "keysDialog", "preferencesDialog"}) CHECK(visited.count(dialog) == 1);
    CHECK(visited.size() >= 10);
    INFO(linesOf(walk.faults()));
    CHECK(walk.faults().isEmpty());
    w.services().store().setClean();
}

TEST_CASE("the keyboard comes to every control of every panel", "[controls][keyboard]") {
    HabitualWindow habits;
    OpenWindow w;
    w.window.resize(1500, 950);
    w.window.activateWindow();
    QStringList faults;
    for (const PanelInfo& panel : panelRegistry()) {
        w.services().panels().show(panel.id);
        QCoreApplication::processEvents();
        QDockWidget& dock = *w.services().panels().dock(panel.id);
        dock.raise();
        QCoreApplication::processEvents();
        const std::vector<QWidget*> controls = tabControls(*dock.widget());
        if (controls.empty()) continue;
        const std::set<QWidget*> reached = reachedByTab(*controls.front());
        for (const QWidget* control : controls) {
            if (reached.count(const_cast<QWidget*>(control)) > 0) continue;
            // Of buttons that exclude each other, the arrows go from one to the next.
            const auto* button = qobject_cast<const QAbstractButton*>(control);
            if (button != nullptr && (button->autoExclusive() || button->group() != nullptr)) continue;
            faults << QStringLiteral("%1: %2 “%3”")
                          .arg(panel.id, control->metaObject()->className(), control->objectName());
        }
    }
    INFO(linesOf(faults));
    CHECK(faults.isEmpty());
}
