#include "window/keys_dialog.h"

#include <QLineEdit>
#include <QScreen>
#include <QTextBrowser>

#include "dialogs/closing_buttons.h"
#include "services/actions.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {
namespace {

constexpr int kWidth = 620;               // logical pixels
constexpr double kMostOfTheScreen = 0.85; // of its height

} // namespace

void showKeys(const Actions& actions, QWidget* parent) {
    QDialog dialog(parent);
    dialog.setObjectName("keysBox");
    dialog.setWindowTitle(QObject::tr("Mouse and keys"));
    auto* find = named(new QLineEdit(&dialog), "keysFind");
    find->setPlaceholderText(QObject::tr("Find a key or what it does"));
    find->setClearButtonEnabled(true);
    auto* table = named(new QTextBrowser(&dialog), "keysTable");
    table->setHtml(actions.keyTable());
    QObject::connect(find, &QLineEdit::textChanged, table,
                     [table, &actions](const QString& text) { table->setHtml(actions.keyTable(text)); });
    dialog.setLayout(columnOf({find, {table, 1}, closingButtons(dialog, QDialogButtonBox::Close)}));
    const QSize screen = dialog.screen()->availableSize();
    const QSize most(screen.width() * 9 / 10, static_cast<int>(kMostOfTheScreen * screen.height()));
    dialog.resize(QSize(kWidth, most.height()).boundedTo(most));
    dialog.exec();
}

} // namespace pellucid::gui
