#include "dialogs/error_dialog.h"

#include <QGridLayout>
#include <QStyle>

#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/sentence.h"

namespace pellucid::gui {
namespace {

QLabel* selectable(const QString& text, const char* name, QWidget* parent) {
    QLabel* label = wrappedLabel(name, parent);
    label->setText(text);
    label->setTextFormat(Qt::PlainText);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
    label->setMinimumWidth(380);
    return label;
}

} // namespace

QString adviceFor(const Error& error) {
    const QString said = QString::fromStdString(error.whatToDo());
    const auto orElse = [&](const QString& more) {
        return said.isEmpty() ? more : QObject::tr("%1, or %2").arg(said, more);
    };
    switch (error.remedy()) {
    case Remedy::AllowMoreMemory:
        return QObject::tr("close other programs, allow more in Edit ▸ Preferences, or open a smaller volume");
    case Remedy::GiveRawLayout:
        return orElse(QObject::tr("open it with File ▸ Open raw data and say how its bytes are laid out"));
    case Remedy::AllowOutside:
        return orElse(QObject::tr("open the file again and allow it, if you trust it"));
    case Remedy::OtherEngine:
        return orElse(QObject::tr("choose the CPU as engine and renderer"));
    default:
        return said;
    }
}

namespace {

QDialog* dialogOf(QWidget* parent, const QString& title, const Error& error) {
    auto* dialog = new QDialog(parent);
    dialog->setObjectName("errorDialog");
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle(title);
    dialog->setModal(true);

    auto* icon = new QLabel(dialog);
    icon->setPixmap(dialog->style()->standardIcon(QStyle::SP_MessageBoxWarning).pixmap(40, 40));
    auto* grid = inset(new QGridLayout(dialog), {20, 18, 20, 14});
    grid->setHorizontalSpacing(14);
    grid->setVerticalSpacing(10);
    grid->addWidget(icon, 0, 0, Qt::AlignTop);
    QLabel* problem = selectable(asSentence(QString::fromStdString(error.problem())), "errorWhat", dialog);
    makeBold(*problem);
    grid->addWidget(problem, 0, 1, 1, 2);
    int row = 1;
    const auto part = [&](const QString& caption, const QString& text, const char* name) {
        if (text.isEmpty()) return;
        auto* head = new QLabel(caption, dialog);
        head->setEnabled(false);
        grid->addWidget(head, row, 1, Qt::AlignTop);
        grid->addWidget(selectable(text, name, dialog), row, 2);
        ++row;
    };
    part(QObject::tr("Where"), QString::fromStdString(error.where()), "errorWhere");
    part(QObject::tr("What to do"), asSentence(adviceFor(error)), "errorWhatToDo");
    grid->setColumnStretch(2, 1);
    grid->addWidget(closingButtons(*dialog, QDialogButtonBox::Ok), row, 0, 1, 3);
    return dialog;
}

} // namespace

void showError(QWidget* parent, const QString& title, const Error& error) { dialogOf(parent, title, error)->open(); }

void showErrorFirst(QWidget* parent, const QString& title, const Error& error) {
    dialogOf(parent, title, error)->exec();
}

} // namespace pellucid::gui
