// The buttons below a dialog.
#pragma once

#include <QDialog>
#include <QDialogButtonBox>
#include <QPushButton>

namespace pellucid::gui {

/// A row of buttons, which accept or reject the dialog.
inline QDialogButtonBox* closingButtons(QDialog& dialog, QDialogButtonBox::StandardButtons which) {
    auto* buttons = new QDialogButtonBox(which, &dialog);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    return buttons;
}

/// Beside a line for a file or folder.
inline QPushButton* browseButton(QWidget& parent) {
    auto* button = new QPushButton(QObject::tr("Browse…"), &parent);
    button->setToolTip(QObject::tr("Choose it among the files of this machine"));
    button->setAutoDefault(false);
    return button;
}

} // namespace pellucid::gui
