// Which keys do what, to be changed.
#pragma once

#include <functional>
#include <vector>

#include <QDialog>
#include <QKeySequence>

#include "dialogs/action_row.h"

class QKeySequenceEdit;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace pellucid::gui {

/// All actions with their keys. A key belongs to one action: where another one has it, that is told, and setting it
/// takes it from there. Changes hold at once.
class KeysDialog : public QDialog {
    Q_OBJECT
public:
    struct Keys {
        std::function<QList<QKeySequence>(const QAction&)> byDefault;
        std::function<void(QAction&, const QList<QKeySequence>&)> set;
    };
    KeysDialog(std::vector<ActionRow> rows, Keys keys, QWidget* parent);

private:
    void find(const QString& text);
    void follow();
    void setKey();
    /// Takes them from other actions that have them.
    void give(QAction& action, const QList<QKeySequence>& keys);
    void setKeys(QAction& action, const QList<QKeySequence>& keys);
    QAction* selected() const;
    /// The other action with the key that has been typed; null: none.
    QAction* holder() const;
    void showKeysOf(QTreeWidgetItem& item);

    std::vector<ActionRow> m_rows;
    Keys m_keys;
    QLineEdit* m_find;
    QTreeWidget* m_list;
    QKeySequenceEdit* m_edit;
    QLabel* m_conflict;
    QPushButton *m_set, *m_none, *m_default, *m_allDefault;
};

} // namespace pellucid::gui
