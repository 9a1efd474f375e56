#include "dialogs/error_dialog.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QLabel>
#include <QStyle>

namespace pellucid::gui {
namespace {

QString asSentence(QString text) {
    text = text.trimmed();
    if (text.isEmpty()) return text;
    text[0] = text[0].toUpper();
    if (!text.endsWith('.') && !text.endsWith('?')) text += '.';
    return text;
}

QLabel* selectable(const QString& text, const char* name, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setObjectName(name);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
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
        return QObject::tr("close other programs, or open a smaller volume");
    case Remedy::GiveRawLayout:
        return orElse(QObject::tr("open it with File ▸ Open raw data and say how its bytes lie"));
    case Remedy::OtherEngine:
        return orElse(QObject::tr("choose the CPU as engine and renderer"));
    case Remedy::CorrectRawLayout:
    case Remedy::GiveSpacing:
    case Remedy::NoComponent:
    case Remedy::AsSaid:
        break;
    }
    return said;
}

void showError(QWidget* parent, const QString& title, const Error& error) {
    const QString what = QString::fromStdString(error.problem()), where = QString::fromStdString(error.where()),
                  whatToDo = adviceFor(error);
    auto* dialog = new QDialog(parent);
    dialog->setObjectName("errorDialog");
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle(title);
    dialog->setModal(true);

    auto* icon = new QLabel(dialog);
    icon->setPixmap(dialog->style()->standardIcon(QStyle::SP_MessageBoxWarning).pixmap(40, 40));
    auto* grid = new QGridLayout(dialog);
    grid->setContentsMargins(20, 18, 20, 14);
    grid->setHorizontalSpacing(14);
    grid->setVerticalSpacing(10);
    grid->addWidget(icon, 0, 0, Qt::AlignTop);
    QLabel* problem = selectable(asSentence(what), "errorWhat", dialog);
    QFont bold = problem->font();
    bold.setBold(true);
    problem->setFont(bold);
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
    part(QObject::tr("Where"), where, "errorWhere");
    part(QObject::tr("What to do"), asSentence(whatToDo), "errorWhatToDo");
    grid->setColumnStretch(2, 1);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok, dialog);
    QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
    grid->addWidget(buttons, row, 0, 1, 3);
    dialog->open();
}

} // namespace pellucid::gui
