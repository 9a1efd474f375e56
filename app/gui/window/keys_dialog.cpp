#include "window/keys_dialog.h"

#include <QDialogButtonBox>
#include <QLineEdit>
#include <QScreen>
#include <QTextBrowser>
#include <QVBoxLayout>

#include "services/actions.h"

namespace pellucid::gui {
namespace {

constexpr int kWidth = 620;               // logical pixels
constexpr double kMostOfTheScreen = 0.85; // of its height

} // namespace

KeysDialog::KeysDialog(const Actions& actions, QWidget* parent) : QDialog(parent) {
    setObjectName("keysBox");
    setWindowTitle(tr("Mouse and keys"));
    auto* find = new QLineEdit(this);
    find->setObjectName("keysFind");
    find->setPlaceholderText(tr("Find a key or what it does"));
    find->setClearButtonEnabled(true);
    auto* table = new QTextBrowser(this);
    table->setObjectName("keysTable");
    table->setHtml(actions.keyTable());
    connect(find, &QLineEdit::textChanged, table,
            [table, &actions](const QString& text) { table->setHtml(actions.keyTable(text)); });
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    auto* column = new QVBoxLayout(this);
    column->addWidget(find);
    column->addWidget(table, 1);
    column->addWidget(buttons);
    const QSize screen = this->screen()->availableSize();
    const QSize most(screen.width() * 9 / 10, static_cast<int>(kMostOfTheScreen * screen.height()));
    resize(QSize(kWidth, most.height()).boundedTo(most));
}

} // namespace pellucid::gui
