// The files that were open lately, kept on this machine, each with a small picture of how it was left.
#pragma once

#include <vector>

#include <QSize>
#include <QString>

#include "volume/loader.h"

class QIcon;
class QWidget;

namespace pellucid::gui {

class Services;

inline constexpr QSize kRecentPicture{128, 96}; ///< pixels

struct RecentFile {
    QString entry;       ///< as it is kept
    QString name;        ///< "tooth.nrrd", "f1.nrrd … f10.nrrd (3 files)"
    QString path;        ///< of the first file
    QString missing;     ///< why it cannot be opened; empty: it can
    QString pictureFile; ///< empty: there is none
};

/// The latest first; those that this version cannot read are left out.
std::vector<RecentFile> recentFiles();
/// Puts it first. What the preferences have no room for is forgotten, with its picture.
void noteRecent(const QString& entry);
void clearRecent();
/// Forgets what the preferences have no room for, and the pictures of what is forgotten.
void trimRecent();
/// Whose pictures are kept in this window.
void setRecentView(Services& services, QWidget& view);
/// Of what is open, as that view shows it: cut to the shape of kRecentPicture and kept, for its owner alone. Nothing,
/// where the preferences do not want it, or it is not among the recent files. `sessionPath`: that of the session, or
/// empty.
void keepRecentPicture(Services& services, const QString& sessionPath);

/// A path, or where that does not suffice to open it again, the source as JSON.
QString recentEntry(const VolumeSource& source);
/// Throws Error where the entry is of another version.
VolumeSource recentSource(const QString& entry);

/// The picture of a file, or a plain card of the same size.
QIcon recentIcon(const RecentFile& file);
/// "tooth.nrrd, in /data/teeth", and why it cannot be opened: for those who hear it.
QString spokenText(const RecentFile& file);

} // namespace pellucid::gui
