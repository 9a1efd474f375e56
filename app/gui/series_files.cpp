#include "series_files.h"

#include <algorithm>

#include <QDir>
#include <QFileInfo>

#include "volume/series.h"

namespace pellucid::gui {

bool comesBefore(const QString& a, const QString& b) {
    const auto digitsFrom = [](const QString& text, qsizetype from) {
        qsizetype end = from;
        while (end < text.size() && text[end].isDigit()) ++end;
        return end;
    };
    qsizetype i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (a[i].isDigit() && b[j].isDigit()) {
            const qsizetype endA = digitsFrom(a, i), endB = digitsFrom(b, j);
            while (i + 1 < endA && a[i] == '0') ++i;
            while (j + 1 < endB && b[j] == '0') ++j;
            if (endA - i != endB - j) return endA - i < endB - j; // numbers of any length
            for (; i < endA; ++i, ++j)
                if (a[i] != b[j]) return a[i] < b[j];
            continue;
        }
        const QChar x = a[i].toLower(), y = b[j].toLower();
        if (x != y) return x < y;
        ++i;
        ++j;
    }
    if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
    return a < b;
}

VolumeSource sourceOf(QStringList paths) {
    std::sort(paths.begin(), paths.end(), comesBefore);
    VolumeSource source;
    source.path = paths.front().toStdString();
    for (qsizetype i = 1; i < paths.size(); ++i) source.more.push_back(paths[i].toStdString());
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
    if (source.isSample()) return files;
    if (!source.more.empty()) {
        files << QString::fromStdString(source.path);
        for (const std::string& path : source.more) files << QString::fromStdString(path);
        return files;
    }
    if (QFileInfo(QString::fromStdString(source.path)).isFile()) return {QString::fromStdString(source.path)};
    VolumeSource names = source; // as if without headers: none is opened for this
    names.raw = RawLayout{{1, 1, 1}};
    for (const SeriesFrame& frame : listSeries(names).frames) files << QString::fromStdString(frame.source.path);
    files.removeDuplicates();
    return files;
}

} // namespace pellucid::gui
