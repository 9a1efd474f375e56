#include "services/actions.h"

#include <algorithm>

#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QSettings>
#include <QToolBar>

#include "widgets/icons.h"

namespace pellucid::gui {
namespace {

constexpr const char* kWords = "toolBarWords";

/// None of an empty text, of which Qt would make one that no key is in.
QList<QKeySequence> keysIn(const QString& text) {
    return text.isEmpty() ? QList<QKeySequence>() : QKeySequence::listFromString(text);
}

/// Where other keys of an action are kept.
QString keptKeys(const QAction& action) { return "keys/" + action.objectName(); }

void setTips(QAction& action, const QString& tool, const QString& status) {
    const QString keys = keysText(action);
    action.setToolTip(keys.isEmpty() ? tool : QStringLiteral("%1 (%2)").arg(tool, keys));
    action.setStatusTip(status);
}

} // namespace

Actions::Actions(QObject* parent) : QObject(parent) {}

QAction* Actions::add(const QString& menu, const QString& id, const QString& text, const QString& keys,
                      const QString& tip, const std::function<void()>& trigger, const std::function<bool()>& enabled,
                      const ActionMore& more) {
    auto* action = new QAction(text, this);
    action->setObjectName(id);
    const QList<QKeySequence> byDefault = keysIn(keys);
    const QVariant kept = QSettings().value(keptKeys(*action));
    action->setShortcuts(kept.isValid() ? keysIn(kept.toString()) : byDefault);
    action->setCheckable(static_cast<bool>(more.checked));
    connect(action, &QAction::triggered, this, [this, trigger] {
        if (trigger) trigger();
        refresh(); // a check mark shows what is, not what was clicked
    });
    m_entries.push_back({menu, enabled, more, action, byDefault, tip.isEmpty() ? plainText(text) : tip, tip});
    setTips(*action, m_entries.back().tool, tip);
    return action;
}

QAction* ActionMenu::add(const QString& id, const QString& text, const QString& keys, const QString& tip,
                         const std::function<void()>& trigger, ActionMore more) {
    more.separatorBefore |= std::exchange(m_separates, false);
    more.section = std::exchange(m_section, {});
    return m_actions.add(m_menu, id, text, keys, tip, trigger, more.enabled ? more.enabled : m_enabled, more);
}

QAction* ActionMenu::addCheck(const QString& id, const QString& text, const QString& keys, const QString& tip,
                              std::function<bool()> checked, const std::function<void()>& trigger, bool inToolBar) {
    return add(id, text, keys, tip, trigger, {.checked = std::move(checked), .inToolBar = inToolBar});
}

void Actions::addGestures(std::vector<Gesture> gestures) {
    m_gestures.insert(m_gestures.end(), gestures.begin(), gestures.end());
}

std::vector<ActionRow> Actions::rows() const {
    std::vector<ActionRow> rows;
    for (const Entry& e : m_entries) rows.push_back({e.action, plainText(e.menu).replace('/', " › ")});
    return rows;
}

QList<QKeySequence> Actions::defaultKeys(const QAction& action) const {
    const auto entry = std::ranges::find(m_entries, &action, &Entry::action);
    return entry == m_entries.end() ? QList<QKeySequence>() : entry->keys;
}

void Actions::setKeys(QAction& action, const QList<QKeySequence>& keys) {
    const auto entry = std::ranges::find(m_entries, &action, &Entry::action);
    if (entry == m_entries.end()) return;
    action.setShortcuts(keys);
    if (keys == entry->keys)
        QSettings().remove(keptKeys(action));
    else
        QSettings().setValue(keptKeys(action), QKeySequence::listToString(keys));
    setTips(action, entry->tool, entry->status);
    refresh();
}

void Actions::refresh() {
    for (const Entry& e : m_entries) {
        if (e.enabled) e.action->setEnabled(e.enabled());
        if (e.more.checked) e.action->setChecked(e.more.checked());
        if (e.more.caption) e.action->setText(e.more.caption());
        if (e.more.say) setTips(*e.action, plainText(e.more.say()), e.more.say());
    }
}

QMenu* Actions::menuAt(QMainWindow& window, const QString& path) {
    if (QMenu* const known = menu(path)) return known;
    const auto slash = path.lastIndexOf('/');
    const QString name = path.mid(slash + 1);
    QMenu* made = slash < 0 ? window.menuBar()->addMenu(name) : menuAt(window, path.left(slash))->addMenu(name);
    made->setObjectName(plainText(name).toLower().replace(' ', '_') + "Menu");
    made->setToolTipsVisible(true);
    return m_menus[path] = made;
}

QMenu* Actions::menu(const QString& path) const {
    const auto known = m_menus.find(path);
    return known == m_menus.end() ? nullptr : known->second;
}

void Actions::giveKeptKeys() {
    // A later version may give a key to one action that somebody has given to another.
    for (const Entry& kept : m_entries) {
        if (kept.action->shortcuts() == kept.keys) continue;
        for (const Entry& other : m_entries) {
            QList<QKeySequence> left = other.action->shortcuts();
            if (&other == &kept || left != other.keys) continue;
            left.removeIf([&](const QKeySequence& key) { return kept.action->shortcuts().contains(key); });
            if (left == other.keys) continue;
            other.action->setShortcuts(left);
            setTips(*other.action, other.tool, other.status);
        }
    }
}

void Actions::build(QMainWindow& window) {
    auto* bar = new QToolBar(tr("Tools"), &window);
    bar->setObjectName("viewToolBar");
    bar->setMovable(false);
    giveKeptKeys();
    QString barGroup;
    for (const Entry& e : m_entries) {
        e.action->setParent(&window);
        window.addAction(e.action); // its keys work where it is in no menu, or menus are hidden
        if (!e.menu.isEmpty()) {
            QMenu* menu = menuAt(window, e.menu);
            if (!e.more.section.isEmpty())
                menu->addSection(e.more.section);
            else if (e.more.separatorBefore)
                menu->addSeparator();
            menu->addAction(e.action);
        }
        if (!e.more.inToolBar) continue;
        if (!bar->actions().isEmpty() && barGroup != e.menu) bar->addSeparator();
        barGroup = e.menu;
        e.action->setIcon(iconNamed(e.action->objectName()));
        e.action->setIconVisibleInMenu(false);
        bar->addAction(e.action);
    }
    bar->setIconSize({18, 18});
    m_bar = bar;
    m_window = &window;
    placeBar();
    refresh();
}

bool Actions::hasWords() const { return QSettings().value(kWords).toBool(); }

void Actions::showWords(bool shown) {
    QSettings().setValue(kWords, shown);
    placeBar();
}

void Actions::placeBar() {
    const bool shown = hasWords();
    m_bar->setToolButtonStyle(shown ? Qt::ToolButtonTextUnderIcon : Qt::ToolButtonIconOnly);
    // Without words it needs no row of its own: the picture has it.
    if (shown) {
        m_window->menuBar()->setCornerWidget(nullptr);
        m_window->addToolBar(m_bar);
    } else {
        m_window->removeToolBar(m_bar);
        m_window->menuBar()->setCornerWidget(m_bar);
    }
    m_bar->show();
}

QString Actions::keyTable(const QString& text) const {
    QString rows, place;
    const auto row = [&](const QString& at, const QString& how, const QString& what) {
        if (!how.contains(text, Qt::CaseInsensitive) && !what.contains(text, Qt::CaseInsensitive)) return;
        if (at != place)
            rows += QStringLiteral("<tr><td colspan=2><b>%1</b></td></tr>").arg((place = at).toHtmlEscaped());
        rows += QStringLiteral("<tr><td>%1&nbsp;&nbsp;</td><td>%2</td></tr>")
                    .arg(how.toHtmlEscaped(), what.toHtmlEscaped());
    };
    for (const Gesture& g : m_gestures) row(g.place, g.how, g.what);
    for (const Entry& e : m_entries)
        if (const QString keys = keysText(*e.action); !keys.isEmpty())
            row(plainText(e.menu.section('/', 0, 0)), keys, plainText(e.action->text()));
    return QStringLiteral("<table cellpadding=2>%1</table>").arg(rows);
}

} // namespace pellucid::gui
