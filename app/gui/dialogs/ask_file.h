// Asking for files, beginning in the folder of the latest ones of their kind.
#pragma once

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QSettings>

#include "tf/formats/tf_file.h"

namespace pellucid::gui {

/// The folder kept under `key`, such as "volumeFolder"; `first` before there is one.
inline QString keptFolder(const QString& key, const QString& first = {}) {
    return QSettings().value(key, first).toString();
}
inline void keepFolderOf(const QString& key, const QString& path) {
    QSettings().setValue(key, QFileInfo(path).absolutePath());
}

/// `path` with the ending of a filter of file dialogs, such as "Presets (*.paraview.json)", unless it has it. What
/// follows the last dot of that ending is not written twice.
inline QString withEndingOf(QString path, const QString& filter) {
    if (!filter.contains("(*")) return path;
    const QString ending = filter.section("(*", -1).section(')', 0, 0), last = "." + ending.section('.', -1);
    if (ending.isEmpty() || path.endsWith(ending, Qt::CaseInsensitive)) return path;
    if (path.endsWith(last, Qt::CaseInsensitive)) path.chop(last.size());
    return path + ending;
}

/// Asks where to write a file, and offers `name`, or a path. What does not end in `ending` gets `suffix`; where several
/// filters may be chosen, the ending of any but the first. Empty: the user gave up.
inline QString askSavePath(QWidget* parent, const QString& title, const QString& key, const QString& name,
                           const QString& filter, const QString& ending, const QString& suffix) {
    QString chosen;
    QString path = QFileDialog::getSaveFileName(parent, title, QDir(keptFolder(key)).filePath(name), filter, &chosen);
    if (path.isEmpty()) return {};
    if (!chosen.isEmpty() && chosen != filter.section(";;", 0, 0)) path = withEndingOf(path, chosen);
    if (!path.endsWith(ending, Qt::CaseInsensitive)) path += suffix;
    keepFolderOf(key, path);
    return path;
}

/// Asks where there is such a file already; false: it is to stay.
inline bool mayReplaceFile(QWidget* parent, const QString& path, const QString& title) {
    const QFileInfo file(path);
    return !file.exists() ||
           QMessageBox::question(parent, title, QObject::tr("%1 exists. Replace it?").arg(file.fileName())) ==
               QMessageBox::Yes;
}

/// Of the files that hold transfer functions and nothing else: "*.tf.json *.tfi …".
inline QString tfPatterns() {
    QStringList patterns;
    for (const std::string& suffix : tfSuffixes()) patterns << "*" + QString::fromStdString(suffix);
    return patterns.join(' ');
}

/// Asks for files to read; empty: the user gave up.
inline QStringList askOpenPaths(QWidget* parent, const QString& title, const QString& key, const QString& filter) {
    const QStringList paths = QFileDialog::getOpenFileNames(parent, title, keptFolder(key), filter);
    if (!paths.isEmpty()) keepFolderOf(key, paths.front());
    return paths;
}

} // namespace pellucid::gui
