// A picture of any format but TIFF, by OpenImageIO. Runs in pellucid-image-reader only.
#pragma once

#include <memory>
#include <string>

#include "foreign/images/picture_file.h"

namespace pellucid {

/// Throws FileError.
std::unique_ptr<PictureFile> openOtherPicture(const std::string& path);

} // namespace pellucid
