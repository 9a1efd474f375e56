// The buttons below a dialog.
#pragma once

#include <QDialog>
#include <QDialogButtonBox>

namespace pellucid::gui {

/// A row of buttons, which accept or reject the dialog.
inline QDialogButtonBox* closingButtons(QDialog& dialog, QDialogButtonBox::StandardButtons which) {
    auto* buttons = new QDialogButtonBox(which, &dialog);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    return buttons;
}

} // namespace pellucid::gui
