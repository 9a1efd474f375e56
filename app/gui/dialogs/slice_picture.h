// A small picture of a volume that can be opened, before it is.
#pragma once

#include <QImage>

#include "volume/volume.h"

namespace pellucid::gui {

/// The first layer of a volume in shades of grey, as large as that, a few wild values cut; null where none is valid.
QImage pictureOfSlice(const Volume& slice);

} // namespace pellucid::gui
