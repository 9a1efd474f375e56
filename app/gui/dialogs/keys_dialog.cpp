#include "dialogs/keys_dialog.h"

#include <QHeaderView>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "dialogs/closing_buttons.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

namespace {

constexpr QSize kSize{640, 560};

QAction* actionOf(const QTreeWidgetItem& item) {
    return qobject_cast<QAction*>(item.data(0, Qt::UserRole).value<QObject*>());
}

} // namespace

KeysDialog::KeysDialog(std::vector<ActionRow> rows, Keys keys, QWidget* parent)
    : QDialog(parent), m_rows(std::move(rows)), m_keys(std::move(keys)),
      m_find(
          named(new QLineEdit(this), "keysDialogFind", tr("Lists what has these letters in its name, menu or keys"))),
      m_list(named(new QTreeWidget(this), "keysDialogList", tr("Actions with their keys; bold: changed"))),
      m_edit(named(new QKeySequenceEdit(this), "keysDialogKey",
                   tr("Press the key that is to do it, with Ctrl, Shift or Alt"))),
      m_conflict(named(new QLabel(this), "keysDialogConflict")),
      m_set(named(new QPushButton(tr("&Set"), this), "keysDialogSet", tr("Gives this key to the selected action"))),
      m_none(named(new QPushButton(tr("&No key"), this), "keysDialogNone",
                   tr("Takes the keys of the selected action away"))),
      m_default(named(new QPushButton(tr("&Default"), this), "keysDialogDefault",
                      tr("Gives the selected action the keys that it came with"))),
      m_allDefault(named(new QPushButton(tr("&All defaults"), this), "keysDialogAllDefault",
                         tr("Gives every action the keys that it came with"))) {
    setObjectName("keysDialog");
    setWindowTitle(tr("Keyboard shortcuts"));
    m_find->setPlaceholderText(tr("Find an action or a key"));
    m_find->setAccessibleName(tr("Find an action or a key"));
    m_list->setAccessibleName(tr("Actions and keys"));
    m_edit->setAccessibleName(tr("New key"));
    m_find->setClearButtonEnabled(true);
    m_list->setHeaderLabels({tr("Action"), tr("Menu"), tr("Keys")});
    m_list->setRootIsDecorated(false);
    m_list->setUniformRowHeights(true);
    m_list->header()->setStretchLastSection(false);
    m_list->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    for (const int column : {1, 2}) m_list->header()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
    for (const ActionRow& row : m_rows) {
        auto* item = new QTreeWidgetItem(m_list, {plainText(*row.action), row.place});
        item->setData(0, Qt::UserRole, QVariant::fromValue(static_cast<QObject*>(row.action)));
        item->setToolTip(0, row.action->statusTip());
        showKeysOf(*item);
    }
    for (QPushButton* button : {m_set, m_none, m_default, m_allDefault}) button->setAutoDefault(false);
    m_conflict->setWordWrap(true);
    auto* close = closingButtons(*this, QDialogButtonBox::Close);
    close->button(QDialogButtonBox::Close)->setAutoDefault(false); // Return is a key, too
    setLayout(columnOf({m_find,
                        {m_list, 1},
                        rowOf({new QLabel(tr("New key"), this), {m_edit, 1}, m_set, m_none, m_default}),
                        m_conflict,
                        rowOf({m_allDefault, Cell::rest(), close})}));
    resize(kSize);

    connect(m_find, &QLineEdit::textChanged, this, &KeysDialog::find);
    connect(m_list, &QTreeWidget::currentItemChanged, this, [this] {
        m_edit->clear();
        follow();
    });
    connect(m_edit, &QKeySequenceEdit::keySequenceChanged, this, &KeysDialog::follow);
    connect(m_edit, &QKeySequenceEdit::editingFinished, this, [this] { // one key, not several in turn
        if (m_edit->keySequence().count() > 1) m_edit->setKeySequence(QKeySequence(m_edit->keySequence()[0]));
    });
    connect(m_set, &QPushButton::clicked, this, &KeysDialog::setKey);
    connect(m_none, &QPushButton::clicked, this, [this] { setKeys(*selected(), {}); });
    connect(m_default, &QPushButton::clicked, this, [this] { give(*selected(), m_keys.byDefault(*selected())); });
    connect(m_allDefault, &QPushButton::clicked, this, [this] {
        for (const ActionRow& row : m_rows) setKeys(*row.action, m_keys.byDefault(*row.action));
    });
    m_list->setCurrentItem(m_list->topLevelItem(0));
    follow();
}

void KeysDialog::showKeysOf(QTreeWidgetItem& item) {
    const QAction& action = *actionOf(item);
    item.setText(2, keysText(action));
    QFont font = m_list->font();
    font.setBold(action.shortcuts() != m_keys.byDefault(action)); // what has been changed
    item.setFont(2, font);
}

void KeysDialog::find(const QString& text) {
    for (int n = 0; n < m_list->topLevelItemCount(); ++n) {
        QTreeWidgetItem* item = m_list->topLevelItem(n);
        bool isFound = false;
        for (int column = 0; column < 3; ++column) isFound |= item->text(column).contains(text, Qt::CaseInsensitive);
        item->setHidden(!isFound);
    }
}

QAction* KeysDialog::selected() const {
    const QTreeWidgetItem* item = m_list->currentItem();
    return item == nullptr ? nullptr : actionOf(*item);
}

QAction* KeysDialog::holder() const {
    const QKeySequence key = m_edit->keySequence();
    if (key.isEmpty()) return nullptr;
    for (const ActionRow& row : m_rows)
        if (row.action != selected() && row.action->shortcuts().contains(QKeySequence(key[0]))) return row.action;
    return nullptr;
}

void KeysDialog::follow() {
    const QAction* action = selected();
    const QAction* other = holder();
    m_set->setEnabled(action != nullptr && !m_edit->keySequence().isEmpty());
    m_none->setEnabled(action != nullptr && !action->shortcuts().isEmpty());
    m_default->setEnabled(action != nullptr && action->shortcuts() != m_keys.byDefault(*action));
    m_conflict->setText(
        other == nullptr
            ? QString()
            : tr("%1 is the key of “%2”. Set takes it from there.")
                  .arg(QKeySequence(m_edit->keySequence()[0]).toString(QKeySequence::NativeText), plainText(*other)));
}

void KeysDialog::setKey() {
    give(*selected(), {QKeySequence(m_edit->keySequence()[0])});
    m_edit->clear();
}

void KeysDialog::give(QAction& action, const QList<QKeySequence>& keys) {
    for (const ActionRow& row : m_rows) {
        if (row.action == &action) continue;
        QList<QKeySequence> left = row.action->shortcuts();
        if (left.removeIf([&](const QKeySequence& key) { return keys.contains(key); }) > 0) setKeys(*row.action, left);
    }
    setKeys(action, keys);
}

void KeysDialog::setKeys(QAction& action, const QList<QKeySequence>& keys) {
    m_keys.set(action, keys);
    for (int n = 0; n < m_list->topLevelItemCount(); ++n)
        if (QTreeWidgetItem* item = m_list->topLevelItem(n); actionOf(*item) == &action) showKeysOf(*item);
    follow();
}

} // namespace pellucid::gui
