// Files that people choose together.
#pragma once

#include <QString>
#include <QStringList>

#include "volume/loader.h"

namespace pellucid::gui {

/// The source that names all of these files, in the order in which people count; they are not empty.
VolumeSource sourceOf(const QStringList& paths);

/// What the source names, for titles and menus: "f01.mhd", "f01.mhd … f12.mhd (12 files)", "f%02d.mhd".
QString titleOf(const VolumeSource& source);

/// Files of the source's frames, as far as they are there; empty for a sample.
QStringList filesOfFrames(const VolumeSource& source);

} // namespace pellucid::gui
