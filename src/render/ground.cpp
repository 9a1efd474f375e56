#include "render/ground.h"

#include <limits>

namespace pellucid {

GroundImage drawGround(const Ground&, const Camera&, int width, int height, const JobControl&) {
    return {Image(width, height), std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                                     std::numeric_limits<float>::infinity())};
}

} // namespace pellucid
