#include "dialogs/ask_preset.h"

#include <QDialog>
#include <QFileInfo>
#include <QLabel>
#include <QListWidget>
#include <QVBoxLayout>

#include "base/error.h"
#include "dialogs/closing_buttons.h"
#include "tf/formats/tf_file.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

namespace {

QStringList namesIn(const QString& path) {
    QStringList names;
    try {
        for (const std::string& name : tfNamesIn(path.toStdString())) names << QString::fromStdString(name);
    } catch (const Error&) {
        return {};
    }
    return names;
}

} // namespace

QString askPreset(const QString& path, QWidget* parent) {
    const QStringList names = namesIn(path);
    if (names.isEmpty()) return path;
    QDialog dialog(parent);
    dialog.setObjectName("presetDialog");
    dialog.setWindowTitle(QObject::tr("Choose a transfer function"));
    auto* what = wrappedLabel("presetWhat", &dialog);
    what->setTextFormat(Qt::PlainText);
    what->setText(QObject::tr("%2 holds %L1 transfer functions. Which one do you want to open?")
                      .arg(names.size())
                      .arg(QFileInfo(path).fileName()));
    auto* list =
        named(new QListWidget(&dialog), "presetList", QObject::tr("Double-click a transfer function to open it"));
    list->addItems(names);
    list->setCurrentRow(0);
    list->setMinimumSize(360, 300);
    QObject::connect(list, &QListWidget::itemActivated, &dialog, &QDialog::accept);
    add(*inset(new QVBoxLayout(&dialog), {18, 16, 18, 12}),
        {what, {list, 1}, closingButtons(dialog, QDialogButtonBox::Open | QDialogButtonBox::Cancel)});
    list->setFocus();
    if (dialog.exec() != QDialog::Accepted) return {};
    return path + '#' + names.at(list->currentRow());
}

QString nameOfPreset(const QString& path) {
    const QString file = QString::fromStdString(fileOfTf(path.toStdString()));
    return QFileInfo(file).fileName() + path.mid(file.size());
}

} // namespace pellucid::gui
