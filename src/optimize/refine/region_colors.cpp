#include "optimize/refine/region_colors.h"

#include <algorithm>
#include <array>

#include "base/error.h"

namespace pellucid {

std::vector<RegionColor> regionColors(const Image& picture, const ImageRegion& region) {
    std::vector<std::array<float, 3>> pixels;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const float* p = picture.pixel(x, y);
            if (p[3] > 0 && region.contains((x + 0.5) / picture.width, (y + 0.5) / picture.height))
                pixels.push_back({p[0], p[1], p[2]});
        }
    if (pixels.empty())
        throw Error("the region shows nothing", "region of the picture",
                    "choose a part of the picture that shows something");
    std::ranges::sort(pixels);
    std::vector<RegionColor> colors;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (i > 0 && pixels[i] == pixels[i - 1])
            ++colors.back().count;
        else
            colors.push_back({{pixels[i][0], pixels[i][1], pixels[i][2]}, 1});
    }
    return colors;
}

} // namespace pellucid
