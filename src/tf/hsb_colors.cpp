#include "tf/hsb_colors.h"

namespace pellucid {

VoxelColors hsbColors(const HsbInput& input, const JobControl&) {
    return {input.dims, std::vector<std::uint32_t>(voxelCount(input.dims), VoxelColors::pack(255, 255, 255))};
}

double automaticScale(const Volume&) { return 1; }

} // namespace pellucid
