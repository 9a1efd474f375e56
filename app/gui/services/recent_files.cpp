#include "services/recent_files.h"

#include <algorithm>

#include <QCryptographicHash>
#include <QDir>
#include <QFileInfo>
#include <QIcon>
#include <QImage>
#include <QPainter>
#include <QPixmap>
#include <QSaveFile>
#include <QSettings>
#include <QStandardPaths>
#include <QWidget>

#include <nlohmann/json.hpp>

#include "dialogs/series_files.h"
#include "services/services.h"
#include "session/scene.h"
#include "session/session_json.h"
#include "session/variable_edits.h"
#include "volume/file_names.h"
#include "widgets/preferences.h"

namespace pellucid::gui {
namespace {

constexpr auto kRecentKey = "recentFiles", kView = "recentView";
constexpr auto kOwnerFile = QFileDevice::ReadOwner | QFileDevice::WriteOwner;
constexpr auto kOwnerFolder = kOwnerFile | QFileDevice::ExeOwner;

VolumeSource sourceAt(const QString& path) {
    VolumeSource source;
    source.path = path.toStdString();
    return source;
}

QStringList entries() { return QSettings().value(kRecentKey).toStringList(); }

QString pictureFolder() {
    return QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation) + "/pellucid/recent";
}

QString pictureName(const QString& entry) {
    return QString::fromLatin1(QCryptographicHash::hash(entry.toUtf8(), QCryptographicHash::Sha1).toHex()) + ".png";
}

QString pictureFile(const QString& entry) { return pictureFolder() + "/" + pictureName(entry); }

/// Why it cannot be opened; of a pattern, whose files nobody counts for this, whether its folder is there.
QString whyMissing(const QString& path) {
    const QFileInfo file(path);
    if (file.exists()) return {};
    const bool isPattern = isGlob(path.toStdString()) || numberedName(path.toStdString());
    if (isPattern && file.dir().exists()) return {};
    return file.dir().exists() ? QObject::tr("it is not there any more")
                               : QObject::tr("its folder is not there: %1").arg(file.path());
}

QImage cutToShape(const QImage& picture) {
    const QImage filled = picture.scaled(kRecentPicture, Qt::KeepAspectRatioByExpanding, Qt::SmoothTransformation);
    return filled.copy(
        QRect(QPoint((filled.width() - kRecentPicture.width()) / 2, (filled.height() - kRecentPicture.height()) / 2),
              kRecentPicture));
}

} // namespace

QString recentEntry(const VolumeSource& source) {
    const auto absolutePath = [](const std::string& path) {
        return QFileInfo(QString::fromStdString(path)).absoluteFilePath().toStdString();
    };
    VolumeSource absolute = source;
    absolute.path = absolutePath(source.path);
    for (std::string& path : absolute.more) path = absolutePath(path);
    const QString path = QString::fromStdString(absolute.path);
    if (absolute == sourceAt(path)) return path;
    return QString::fromStdString(jsonFromSession(sessionOf(absolute), "", DataPaths::Absolute).dump());
}

VolumeSource recentSource(const QString& entry) {
    if (!entry.startsWith('{')) return sourceAt(entry);
    const nlohmann::json document = nlohmann::json::parse(entry.toStdString(), nullptr, false);
    return sessionFromJson({document, "recent files"}, "").session.variable().source;
}

std::vector<RecentFile> recentFiles() {
    std::vector<RecentFile> files;
    for (const QString& entry : entries()) {
        try {
            const VolumeSource source = recentSource(entry);
            const QString path = QString::fromStdString(source.path), picture = pictureFile(entry);
            files.push_back(
                {entry, titleOf(source), path, whyMissing(path), QFileInfo::exists(picture) ? picture : QString()});
        } catch (const Error&) {
            continue; // of another version
        }
    }
    return files;
}

void noteRecent(const QString& entry) {
    QStringList files = entries();
    files.removeAll(entry);
    files.prepend(entry);
    QSettings().setValue(kRecentKey, files);
    trimRecent();
}

void clearRecent() {
    QSettings().remove(kRecentKey);
    trimRecent();
}

void trimRecent() {
    const Preferences preferences = keptPreferences();
    const QStringList all = entries(), files = all.mid(0, preferences.recentCount);
    if (files.size() < all.size()) QSettings().setValue(kRecentKey, files);
    QStringList wanted;
    if (preferences.recentPictures)
        for (const QString& entry : files) wanted << pictureName(entry);
    QDir folder(pictureFolder());
    for (const QString& name : folder.entryList({"*.png"}, QDir::Files))
        if (!wanted.contains(name)) folder.remove(name);
}

void setRecentView(Services& services, QWidget& view) {
    services.setProperty(kView, QVariant::fromValue(static_cast<QObject*>(&view)));
}

void keepRecentPicture(Services& services, const QString& sessionPath) {
    auto* const view = qobject_cast<QWidget*>(services.property(kView).value<QObject*>());
    if (view == nullptr || !services.store().hasVolume() || !keptPreferences().recentPictures) return;
    const QString entry = sessionPath.isEmpty() ? recentEntry(dataVariable(services.scene().session).source)
                                                : QFileInfo(sessionPath).absoluteFilePath();
    if (!entries().contains(entry)) return;
    if (!QDir().mkpath(pictureFolder())) return; // a list without pictures will do
    QFile::setPermissions(pictureFolder(), kOwnerFolder);
    QSaveFile file(pictureFile(entry));
    if (!file.open(QIODevice::WriteOnly)) return;
    file.setPermissions(kOwnerFile);
    if (cutToShape(view->grab().toImage()).save(&file, "PNG")) file.commit();
}

QIcon recentIcon(const RecentFile& file) {
    QPixmap picture(file.pictureFile);
    if (picture.isNull()) {
        picture = QPixmap(kRecentPicture);
        picture.fill(theme::kTrack);
        QPainter painter(&picture);
        painter.setPen(theme::kFaint);
        const QString suffix = QFileInfo(file.path).suffix();
        painter.drawText(picture.rect(), Qt::AlignCenter, suffix.size() <= 6 ? suffix : QString());
    }
    return QIcon(picture);
}

QString spokenText(const RecentFile& file) {
    const QString place = QObject::tr("%1, in %2").arg(file.name, QFileInfo(file.path).path());
    return file.missing.isEmpty() ? place : QObject::tr("%1: %2").arg(place, file.missing);
}

} // namespace pellucid::gui
