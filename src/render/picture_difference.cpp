#include "render/picture_difference.h"

#include <algorithm>

#include "base/check.h"
#include "base/error.h"
#include "render/ssim.h"
#include "tf/color_difference.h"

namespace pellucid {

PictureDifference differenceOf(const Image& a, const Image& b, const std::string& where) {
    if (a.width != b.width || a.height != b.height)
        throw Error("the pictures differ in size", where, "draw them in one size");
    PictureDifference d;
    d.map = deltaEOf(a, b);
    d.ssim = ssim(a, b);
    d.mean = meanDeltaE(a, b);
    d.largest = static_cast<double>(*std::ranges::max_element(d.map.values));
    const auto noticed = std::ranges::count_if(d.map.values, [](float e) { return e > kNoticedDeltaE; });
    d.noticed = static_cast<double>(noticed) / static_cast<double>(d.map.values.size());
    return d;
}

Image sideBySide(const Image& a, const Image& b) {
    PELLUCID_CHECK(a.height == b.height);
    Image both(a.width + b.width, a.height);
    for (int y = 0; y < a.height; ++y) {
        std::copy_n(a.pixel(0, y), 4 * a.width, both.pixel(0, y));
        std::copy_n(b.pixel(0, y), 4 * b.width, both.pixel(a.width, y));
    }
    return both;
}

Plane storedDifference(Plane map, bool asFloats) {
    constexpr float kWhite = 100;
    if (!asFloats)
        for (float& e : map.values) e = std::min(1.0f, e / kWhite);
    return map;
}

} // namespace pellucid
