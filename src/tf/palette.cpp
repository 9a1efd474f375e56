#include "tf/palette.h"

#include <string>

#include "base/check.h"

namespace pellucid {

namespace {

std::vector<Rgb> colors(const std::vector<std::string>& hex) {
    std::vector<Rgb> result;
    result.reserve(hex.size());
    for (const std::string& h : hex) result.push_back(rgbFromHex(h));
    return result;
}

} // namespace

std::vector<Rgb> classColors(int count) {
    PELLUCID_CHECK(count >= 1);
    switch (count) {
    case 1:
        return colors({"#e6b85c"});
    case 2:
        return colors({"#c96a4a", "#f6f0de"});
    case 3:
        return colors({"#4f74b3", "#d9824f", "#f6f0de"});
    case 4:
        return colors({"#4f74b3", "#c96a4a", "#e6b85c", "#f6f0de"});
    case 5:
        return colors({"#4f74b3", "#5fb0a5", "#c96a4a", "#e6b85c", "#f6f0de"});
    default:
        break;
    }
    static const std::vector<Rgb> kCycle = colors({"#4f74b3", "#e6b85c", "#a8516e", "#7cc4a4", "#c96a4a", "#f6f0de"});
    std::vector<Rgb> result;
    for (int i = 0; i < count; ++i) result.push_back(kCycle[static_cast<std::size_t>(i) % kCycle.size()]);
    return result;
}

std::vector<Rgb> divergingColors() { return colors({"#2f6fc4", "#7fb4e6", "#f0a27a", "#c43c39"}); }

TissueColors tissueColors() {
    const auto all = colors({"#5a7fb0", "#d9a877", "#b5483f", "#ead9a6", "#fdfbf4"});
    return {all[0], all[1], all[2], all[3], all[4]};
}

} // namespace pellucid
