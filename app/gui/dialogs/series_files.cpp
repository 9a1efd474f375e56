#include "dialogs/series_files.h"

#include <algorithm>

#include <QDir>
#include <QFileInfo>

#include "volume/file_names.h"
#include "volume/series.h"

namespace pellucid::gui {

VolumeSource sourceOf(const QStringList& paths) {
    VolumeSource source;
    for (const QString& path : paths) source.more.push_back(path.toStdString());
    std::sort(source.more.begin(), source.more.end(), countsBefore);
    source.path = source.more.front();
    source.more.erase(source.more.begin());
    return source;
}

QString titleOf(const VolumeSource& source) {
    const QString path = QString::fromStdString(source.path);
    const QString first = source.isSample() ? path : QFileInfo(QDir::cleanPath(path)).fileName();
    if (source.more.empty()) return first;
    return QObject::tr("%1 … %2 (%L3 files)")
        .arg(first, QFileInfo(QString::fromStdString(source.more.back())).fileName())
        .arg(source.more.size() + 1);
}

QStringList filesOfFrames(const VolumeSource& source) {
    QStringList files;
    for (const std::string& path : seriesFiles(source)) files << QString::fromStdString(path);
    return files;
}

} // namespace pellucid::gui
