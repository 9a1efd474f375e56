// Everything that can be done: found by typing, and by keys that people change.
#include "gui_support.h"

#include <set>

#include <QAction>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QTreeWidget>

#include "dialogs/command_palette.h"
#include "dialogs/keys_dialog.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

QTreeWidgetItem* rowOf(QTreeWidget& list, const QString& text) {
    const QList<QTreeWidgetItem*> found = list.findItems(text, Qt::MatchExactly);
    REQUIRE(found.size() == 1);
    return found.front();
}

KeysDialog::Keys keysOf(Actions& actions) {
    return {[&actions](const QAction& action) { return actions.defaultKeys(action); },
            [&actions](QAction& action, const QList<QKeySequence>& keys) { actions.setKeys(action, keys); }};
}

} // namespace

TEST_CASE("what fits best comes first", "[palette]") {
    const auto score = [](const char* typed, const char* text) { return paletteScore(typed, text, "File", "a tip"); };
    CHECK(score("save", "Save image") > score("image", "Save image")); // its beginning before a word of it
    CHECK(score("image", "Save image") > score("mage", "Save image")); // a word before a part of one
    CHECK(score("mage", "Save image") > score("svi", "Save image"));   // a part before letters in their order
    CHECK(score("svi", "Save image") > 0);
    CHECK(score("ivs", "Save image") == 0);
    CHECK(score("save zebra", "Save image") == 0); // all words count
    CHECK(score("image save", "Save image") == score("save image", "Save image"));
    CHECK(score("file", "Save image") > 0); // the menu
    CHECK(score("tip", "Save image") > 0);
    CHECK(score("", "Save image") > 0);
}

TEST_CASE("the palette does what is typed and chosen", "[palette]") {
    OpenWindow w;
    QSettings().remove("paletteRecent");
    const std::vector<ActionRow> rows = w.services().actions().rows();
    CommandPalette palette(rows, &w.window);
    palette.show();
    auto& list = *palette.findChild<QTreeWidget*>("paletteList");
    auto& find = *palette.findChild<QLineEdit*>("paletteFind");
    CHECK(list.topLevelItemCount() == static_cast<int>(rows.size()));
    QTest::keyClicks(&find, "copy cap");
    REQUIRE(list.topLevelItemCount() >= 1);
    CHECK(list.topLevelItem(0)->text(0) == "Copy caption");
    CHECK(list.topLevelItem(0)->text(1) == "File");
    CHECK(!list.topLevelItem(0)->text(2).isEmpty());
    CHECK(list.currentItem() == list.topLevelItem(0));
    QTest::keyClick(&find, Qt::Key_Return);
    CHECK(palette.result() == QDialog::Accepted);
    CHECK(palette.chosen() == &w.child<QAction>("copyCaptionAction"));
    // The latest comes first before anything is typed.
    CommandPalette again(rows, &w.window);
    CHECK(again.findChild<QTreeWidget*>("paletteList")->topLevelItem(0)->text(0) == "Copy caption");
    // Down goes to the next one while one types.
    again.show();
    auto& line = *again.findChild<QLineEdit*>("paletteFind");
    auto& other = *again.findChild<QTreeWidget*>("paletteList");
    QTest::keyClicks(&line, "save");
    QTreeWidgetItem* const first = other.currentItem();
    QTest::keyClick(&line, Qt::Key_Down);
    CHECK(other.currentItem() != first);
}

TEST_CASE("what cannot be done now is listed, but not done", "[palette]") {
    OpenWindow w;
    REQUIRE_FALSE(w.child<QAction>("saveReportAction").isEnabled());
    CommandPalette palette(w.services().actions().rows(), &w.window);
    palette.show();
    auto& find = *palette.findChild<QLineEdit*>("paletteFind");
    QTest::keyClicks(&find, "save report");
    CHECK(rowOf(*palette.findChild<QTreeWidget*>("paletteList"), "Save report of the last run")->isDisabled());
    QTest::keyClick(&find, Qt::Key_Return);
    CHECK(palette.chosen() == nullptr);
}

TEST_CASE("every action has a name, a place, a tip, and keys that no other one has", "[palette]") {
    OpenWindow w;
    std::set<QString> ids;
    std::map<QString, QString> keys;
    for (const ActionRow& row : w.services().actions().rows()) {
        CAPTURE(row.action->objectName().toStdString());
        CHECK(!row.action->objectName().isEmpty());
        CHECK(ids.insert(row.action->objectName()).second);
        CHECK(!plainText(*row.action).isEmpty()); // which screen readers say
        CHECK(!row.action->toolTip().isEmpty());
        for (const QKeySequence& key : row.action->shortcuts()) {
            const auto [known, isNew] = keys.emplace(key.toString(), row.action->objectName());
            CAPTURE(key.toString().toStdString(), known->second.toStdString());
            CHECK(isNew);
            CHECK(row.action->toolTip().contains(key.toString(QKeySequence::NativeText)));
        }
    }
    CHECK(keys.at("Ctrl+K") == "paletteAction");
}

TEST_CASE("keys are changed, conflicts are told, and defaults come back", "[palette]") {
    OpenWindow w;
    Actions& actions = w.services().actions();
    QAction &caption = w.child<QAction>("copyCaptionAction"), &save = w.child<QAction>("saveSessionAction");
    const QList<QKeySequence> ofCaption = caption.shortcuts(), ofSave = save.shortcuts();
    REQUIRE(ofSave == QList<QKeySequence>{QKeySequence("Ctrl+S")});
    {
        KeysDialog dialog(actions.rows(), keysOf(actions), &w.window);
        dialog.show();
        auto& list = *dialog.findChild<QTreeWidget*>("keysDialogList");
        auto& edit = *dialog.findChild<QKeySequenceEdit*>("keysDialogKey");
        auto& conflict = *dialog.findChild<QLabel*>("keysDialogConflict");
        list.setCurrentItem(rowOf(list, "Copy caption"));
        edit.setKeySequence(QKeySequence("Ctrl+Alt+Shift+F9"));
        CHECK(conflict.text().isEmpty());
        edit.setKeySequence(QKeySequence("Ctrl+S"));
        CHECK(conflict.text().contains("Save session"));
        dialog.findChild<QPushButton*>("keysDialogSet")->click();
        CHECK(caption.shortcuts() == ofSave);
        CHECK(save.shortcuts().isEmpty());
        CHECK(caption.toolTip().contains("Ctrl+S"));
        CHECK(rowOf(list, "Copy caption")->text(2) == "Ctrl+S");
        CHECK(rowOf(list, "Save session")->text(2).isEmpty());
    }
    { // Another window has them, too.
        OpenWindow other;
        CHECK(other.child<QAction>("copyCaptionAction").shortcuts() == ofSave);
        CHECK(other.child<QAction>("saveSessionAction").shortcuts().isEmpty());
    }
    KeysDialog dialog(actions.rows(), keysOf(actions), &w.window);
    { // The default of one action takes its key from the other that has it.
        auto& list = *dialog.findChild<QTreeWidget*>("keysDialogList");
        list.setCurrentItem(rowOf(list, "Save session"));
        dialog.findChild<QPushButton*>("keysDialogDefault")->click();
        CHECK(save.shortcuts() == ofSave);
        CHECK(caption.shortcuts().isEmpty());
    }
    dialog.findChild<QPushButton*>("keysDialogAllDefault")->click();
    CHECK(caption.shortcuts() == ofCaption);
    CHECK(save.shortcuts() == ofSave);
    CHECK_FALSE(QSettings().contains("keys/copyCaptionAction"));
    CHECK_FALSE(QSettings().contains("keys/saveSessionAction"));
}
