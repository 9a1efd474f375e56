// Names and folders of studies in dialogs.
#pragma once

#include <QCoreApplication>
#include <QDialog>
#include <QFileDialog>
#include <QLineEdit>
#include <QPushButton>

#include "widgets/layouts.h"

namespace pellucid::gui {

inline QString studyFilter() { return QCoreApplication::translate("Study", "Studies (*.study.json)"); }
inline QString withStudySuffix(const QString& path) {
    return path.endsWith(".json", Qt::CaseInsensitive) ? path : path + ".study.json";
}

/// The folder of a prepared study, which `edit` holds, with a button that asks for another one.
inline QLayout* preparedStudyRow(QLineEdit& edit, QDialog& dialog) {
    edit.setMinimumWidth(340);
    auto* browse = new QPushButton(QCoreApplication::translate("Study", "Browse…"), &dialog);
    browse->setToolTip(QCoreApplication::translate("Study", "Choose it among the folders of this machine"));
    browse->setAutoDefault(false);
    edit.setAccessibleName(QCoreApplication::translate("Study", "Prepared study"));
    QObject::connect(browse, &QPushButton::clicked, &dialog, [&edit, &dialog] {
        const QString title = QCoreApplication::translate("Study", "Prepared study");
        const QString chosen = QFileDialog::getExistingDirectory(&dialog, title, edit.text());
        if (!chosen.isEmpty()) edit.setText(chosen);
    });
    return rowOf({{&edit, 1}, browse});
}

} // namespace pellucid::gui
