// Our images as Qt's.
#pragma once

#include <QImage>

#include "base/image.h"

namespace pellucid::gui {

/// 8 bits per channel, straight alpha.
QImage qImageFromImage(const Image& image);

} // namespace pellucid::gui
