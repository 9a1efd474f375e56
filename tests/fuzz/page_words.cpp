// The texts in TIFF files that say how pages follow each other: ImageJ's, and OME-XML.
#include "foreign/images/page_words.h"

#include <algorithm>
#include <cmath>

#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const PageOrder order = pageOrderIn(fuzz::textOf(data, size), 0, static_cast<double>(size));
    constexpr int kMost = 1'000'000;
    require(order.slices >= 0 && order.slices <= kMost, "slices can be counted");
    require(order.channels >= 1 && order.channels <= kMost, "channels can be counted");
    require(order.steps >= 1 && order.steps <= kMost, "time steps can be counted");
    const bool isEach = std::ranges::is_permutation(order.axes, std::string("zct"));
    require(isEach || (order.axes == "z" && order.channels == 1 && order.steps == 1),
            "pages vary along each axis once");
    for (int a = 0; a < 3; ++a) require(order.spacing[a] > 0 && std::isfinite(order.spacing[a]), "spacing is a length");
    require(order.stepSeconds >= 0 && std::isfinite(order.stepSeconds), "steps do not run backward");
    return 0;
}
