// Of pellucid-image-reader.
#include "foreign/images/image_stack.h"
#include "foreign/images/other_picture.h"

namespace pellucid {

std::unique_ptr<ForeignVolume> openForeign(const std::string& path, const std::string& wanted,
                                           const BeforeFile& before) {
    return std::make_unique<ImageStack>(path, wanted, before, openOtherPicture);
}

} // namespace pellucid
