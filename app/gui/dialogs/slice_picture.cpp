#include "dialogs/slice_picture.h"

#include <algorithm>
#include <vector>

namespace pellucid::gui {

QImage pictureOfSlice(const Volume& slice) {
    const Int3 dims = slice.dims();
    const auto width = static_cast<std::size_t>(dims.x), count = width * static_cast<std::size_t>(dims.y);
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i)
        if (slice.isValid(i)) values.push_back(slice.value(i));
    if (values.empty()) return {};
    const auto part = [&](double share) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::ranges::nth_element(values, at);
        return *at;
    };
    constexpr double kDark = 0.01, kBright = 0.995; // a few wild values do not make the rest grey
    const double lo = part(kDark), hi = std::max(part(kBright), lo + 1e-30);
    QImage image(dims.x, dims.y, QImage::Format_Grayscale8);
    for (int y = 0; y < dims.y; ++y)
        for (int x = 0; x < dims.x; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            const double shade = slice.isValid(i) ? 255 * (slice.value(i) - lo) / (hi - lo) : 0;
            image.scanLine(y)[x] = static_cast<uchar>(std::clamp(shade, 0.0, 255.0));
        }
    return image;
}

} // namespace pellucid::gui
