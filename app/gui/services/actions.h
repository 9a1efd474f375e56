// Everything that can be done, in one list: menus, shortcuts, the tool bar and the table of keys are made from it.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <QAction>
#include <QKeySequence>
#include <QList>
#include <QObject>
#include <QString>

#include "dialogs/action_row.h"

class QMainWindow;
class QMenu;
class QToolBar;

namespace pellucid::gui {

/// What few entries of the list have.
struct ActionMore {
    std::function<bool()> enabled = {};    ///< in place of what its ActionMenu says
    std::function<bool()> checked = {};    ///< empty: not checkable
    std::function<QString()> say = {};     ///< the tool tip's text, where it changes ("Undo: Move point")
    std::function<QString()> caption = {}; ///< the text, where it changes
    bool separatorBefore = false, inToolBar = false;
    QString section = {}; ///< the heading of the entries from this one on
};

/// What the mouse does somewhere, for the table of keys.
struct Gesture {
    QString place, how, what; ///< "Volume", "Left drag", "rotate"
};

/// Makes the actions; the window they are built into owns them. refresh() asks every predicate anew; whoever changes
/// what one depends on calls it.
class Actions : public QObject {
    Q_OBJECT
public:
    explicit Actions(QObject* parent = nullptr);

    /// One entry of the list. Texts are for people; `id` is the action's object name, for tests and settings.
    /// `menu`: "&File", or "&Transfer function/&Presets" for one inside another; empty: in no menu. `text`: with the
    /// menu's mnemonic. `keys`: "Ctrl+Y", or several, "R; F". `tip`: beyond the text, tool tip and status line; may be
    /// empty. `enabled` empty: always.
    QAction* add(const QString& menu, const QString& id, const QString& text, const QString& keys, const QString& tip,
                 const std::function<void()>& trigger, const std::function<bool()>& enabled = {},
                 const ActionMore& more = {});
    void addGestures(std::vector<Gesture> gestures);
    void refresh();

    /// Menus in the order in which they first occur, the tool bar after them.
    void build(QMainWindow& window);
    /// Whether the tool bar has words below its icons; kept on this machine.
    bool hasWords() const;
    void showWords(bool shown);
    /// A menu of `build()` that somebody fills himself, such as that of recent files.
    QMenu* menu(const QString& path) const;

    /// All entries, in the order of the menus.
    std::vector<ActionRow> rows() const;
    /// The keys that an action came with.
    QList<QKeySequence> defaultKeys(const QAction& action) const;
    /// Other keys for an action, kept on this machine; those that it came with are forgotten again.
    void setKeys(QAction& action, const QList<QKeySequence>& keys);

    /// A table of keys and gestures as rich text: all, or those in whose row `text` occurs.
    QString keyTable(const QString& text = {}) const;

private:
    struct Entry {
        QString menu;
        std::function<bool()> enabled;
        ActionMore more;
        QAction* action;
        QList<QKeySequence> keys; ///< that it came with
        QString tool, status;     ///< texts of its tips, without keys
    };
    std::vector<Entry> m_entries;
    std::vector<Gesture> m_gestures;
    std::map<QString, QMenu*> m_menus; // by path
    QMainWindow* m_window = nullptr;   // from build() on
    QToolBar* m_bar = nullptr;
    QMenu* menuAt(QMainWindow& window, const QString& path);
    void giveKeptKeys(); ///< a key that somebody has given to an action is no other one's
    void placeBar();     ///< with words in a row of its own, else beside the menus
};

/// Adds entries to one menu, which are enabled alike; parameters as those of Actions::add().
class ActionMenu {
public:
    ActionMenu(Actions& actions, QString menu, std::function<bool()> enabled = {})
        : m_actions(actions), m_menu(std::move(menu)), m_enabled(std::move(enabled)) {}

    /// The next entry stands below a line.
    void separate() { m_separates = true; }
    void beginSection(const QString& title) { m_section = title; } ///< with the next entry
    QAction* add(const QString& id, const QString& text, const QString& keys, const QString& tip,
                 const std::function<void()>& trigger, ActionMore more = {});
    /// An entry with a check mark while `checked` says so.
    QAction* addCheck(const QString& id, const QString& text, const QString& keys, const QString& tip,
                      std::function<bool()> checked, const std::function<void()>& trigger, bool inToolBar = false);

private:
    Actions& m_actions;
    QString m_menu;
    std::function<bool()> m_enabled;
    bool m_separates = false;
    QString m_section;
};

} // namespace pellucid::gui
