// Everything that can be done, in one list: menus, shortcuts, the tool bar and the table of keys are made from it.
#pragma once

#include <functional>
#include <vector>

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QString>

class QMainWindow;
class QMenu;

namespace pellucid::gui {

/// One entry of the list. Texts are for people; `id` is the action's object name, for tests and settings.
struct ActionSpec {
    QString id = {};
    QString menu = {}; ///< "&File", or "&Transfer function/&Presets" for one inside another; empty: in no menu
    QString text = {}; ///< with the menu's mnemonic
    QList<QKeySequence> keys = {};
    QString tip = {}; ///< beyond the text: tool tip and status line; may be empty
    std::function<void()> trigger = {};
    std::function<bool()> enabled = {}; ///< empty: always
    std::function<bool()> checked = {}; ///< empty: not checkable
    std::function<QString()> say = {};  ///< the tool tip's text, where it changes ("Undo: Move point")
    bool separatorBefore = false;
    bool inToolBar = false;
    bool inKeyTable = true;                ///< only where it has keys
    std::function<QString()> caption = {}; ///< the text, where it changes
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

    QAction* add(ActionSpec spec);
    void addGestures(std::vector<Gesture> gestures);
    void refresh();

    /// Menus in the order in which they first occur, the tool bar after them.
    void build(QMainWindow& window);
    /// A menu of `build()` that somebody fills himself, such as that of recent files.
    QMenu* menu(const QString& path) const;

    /// A table of keys and gestures as rich text: all, or those in whose row `text` occurs.
    QString keyTable(const QString& text = {}) const;

private:
    struct Entry {
        ActionSpec spec;
        QAction* action;
    };
    std::vector<Entry> m_entries;
    std::vector<Gesture> m_gestures;
    std::vector<std::pair<QString, QMenu*>> m_menus;
    QMenu* menuAt(QMainWindow& window, const QString& path);
};

} // namespace pellucid::gui
