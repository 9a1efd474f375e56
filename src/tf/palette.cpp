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
        return colors({"#efc265"});
    case 2:
        return colors({"#e58a55", "#fbf6e6"});
    case 3:
        return colors({"#6f97d8", "#e58a55", "#fbf6e6"});
    case 4:
        return colors({"#6f97d8", "#d9734e", "#efc265", "#fbf6e6"});
    case 5:
        return colors({"#6f97d8", "#62c0b0", "#d9734e", "#efc265", "#fbf6e6"});
    default:
        break;
    }
    static const std::vector<Rgb> kCycle = colors({"#6f97d8", "#efc265", "#b8608a", "#8fd3b0", "#d9734e", "#fbf6e6"});
    std::vector<Rgb> result;
    for (int i = 0; i < count; ++i) result.push_back(kCycle[static_cast<std::size_t>(i) % kCycle.size()]);
    return result;
}

std::vector<Rgb> divergingColors() { return colors({"#3a7bd5", "#8fc1ee", "#f5ab84", "#d24a43"}); }

TissueColors tissueColors() {
    const auto all = colors({"#7fa3d4", "#e8b48a", "#c04f47", "#f1e3bd", "#ffffff"});
    return {all[0], all[1], all[2], all[3], all[4]};
}

} // namespace pellucid
