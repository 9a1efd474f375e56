#include "tf/palette.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "base/check.h"

namespace pellucid {

namespace {

std::vector<Rgb> colors(const std::vector<std::string>& hex) {
    std::vector<Rgb> result;
    std::ranges::transform(hex, std::back_inserter(result), rgbFromHex);
    return result;
}

} // namespace

std::vector<Rgb> classColors(int count) {
    PELLUCID_CHECK(count >= 1);
    static const std::vector<std::vector<Rgb>> kFew{
        colors({"#efc265"}),
        colors({"#e58a55", "#fbf6e6"}),
        colors({"#6f97d8", "#e58a55", "#fbf6e6"}),
        colors({"#6f97d8", "#d9734e", "#efc265", "#fbf6e6"}),
        colors({"#6f97d8", "#62c0b0", "#d9734e", "#efc265", "#fbf6e6"}),
    };
    const auto n = static_cast<std::size_t>(count);
    if (n <= kFew.size()) return kFew[n - 1];
    static const std::vector<Rgb> kCycle = colors({"#6f97d8", "#efc265", "#b8608a", "#8fd3b0", "#de7752", "#fbf6e6"});
    std::vector<Rgb> result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(kCycle[i % kCycle.size()]);
    return result;
}

std::vector<Rgb> divergingColors() { return colors({"#3a7bd5", "#8fc1ee", "#f5ab84", "#d24a43"}); }

TissueColors tissueColors() {
    const auto all = colors({"#7fa3d4", "#e8b48a", "#c04f47", "#f8e9c3", "#ffffff"});
    return {all[0], all[1], all[2], all[3], all[4]};
}

} // namespace pellucid
