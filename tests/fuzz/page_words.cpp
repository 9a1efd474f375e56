// The texts in TIFF files that say how pages follow each other: ImageJ's, and OME-XML.
#include "foreign/images/page_words.h"

#include <algorithm>
#include <cmath>

#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FirstPage page;
    page.description = fuzz::textOf(data, size);
    page.pixelsPerUnitY = static_cast<double>(size);
    page.shape.samples = size % 2 == 0 ? 1 : 3;
    page.fileName = "a.ome.tif";
    const PageOrder order = pageOrderIn(page);
    for (const ImageInFile& image : imagesNamedIn(page)) {
        require(!image.name.empty(), "images have names");
        require(image.firstPage >= 0, "pages are counted");
    }
    const SliceMetadata slices = sliceMetadataIn(page);
    for (int a = 0; a < 3; ++a)
        require(slices.spacing[a] > 0 && std::isfinite(slices.spacing[a]), "slices are a length apart");
    constexpr int kMost = 1'000'000;
    require(order.slices >= 0 && order.slices <= kMost, "slices can be counted");
    require(order.channels >= 1 && order.channels <= kMost, "channels can be counted");
    require(order.steps >= 1 && order.steps <= kMost, "time steps can be counted");
    const bool isEach = std::ranges::is_permutation(order.axes, std::string("zct"));
    require(isEach || (order.axes == "z" && order.channels == 1 && order.steps == 1),
            "pages vary along each axis once");
    const std::size_t pictures = static_cast<std::size_t>(order.slices) * static_cast<std::size_t>(order.channels) *
                                 static_cast<std::size_t>(order.steps);
    require(order.pages.empty() || (order.pages.size() == pictures && pictures <= kMostPages),
            "each picture has a page, or none is named");
    require(std::ranges::all_of(order.pages, [](int n) { return n >= PageOrder::kElsewhere; }), "pages are counted");
    require(order.elsewhere >= 0 && static_cast<std::size_t>(order.elsewhere) <= order.pages.size(),
            "no more pictures are elsewhere than there are");
    require(!order.scaling || (std::isfinite(order.scaling->slope) && order.scaling->slope != 0 &&
                               std::isfinite(order.scaling->intercept)),
            "values are scaled by numbers");
    for (int a = 0; a < 3; ++a) require(order.spacing[a] > 0 && std::isfinite(order.spacing[a]), "spacing is a length");
    require(order.stepSeconds >= 0 && std::isfinite(order.stepSeconds), "steps do not run backward");
    return 0;
}
