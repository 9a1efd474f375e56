#include "volume/intensity_grid.h"

#include <cmath>
#include <type_traits>

#include "volume/parallel.h"

namespace pellucid {

namespace {

constexpr int kCodes = 65535;

/// Codes per unit of value such that code = (value − lo)·scale is exact, or 0 where that is impossible.
int exactScale(const Volume& volume) {
    const ValueRange r = volume.range();
    const bool integers =
        std::visit([](const auto& v) { return std::is_integral_v<typename std::decay_t<decltype(v)>::value_type>; },
                   volume.samples());
    const double span = r.hi - r.lo;
    if (!integers || span < 1 || span > kCodes || r.lo != std::floor(r.lo) || r.hi != std::floor(r.hi)) return 0;
    return kCodes / static_cast<int>(span);
}

} // namespace

IntensityGrid makeIntensityGrid(const Volume& volume) {
    IntensityGrid grid;
    grid.codes = Grid<std::uint16_t>(volume.dims());
    const bool someInvalid = volume.invalidCount() > 0;
    if (someInvalid) grid.valid.assign(volume.size(), 1);
    const int scale = exactScale(volume);
    const double span = volume.range().hi - volume.range().lo;
    if (scale > 0) grid.maxCode = scale * static_cast<int>(span);

    std::visit(
        [&](const auto& values) {
            const std::size_t plane =
                static_cast<std::size_t>(volume.dims().x) * static_cast<std::size_t>(volume.dims().y);
            parallelFor(static_cast<std::size_t>(volume.dims().z), [&](std::size_t k) {
                for (std::size_t i = k * plane; i < (k + 1) * plane; ++i) {
                    const double s = volume.intensityOfValue(static_cast<double>(values[i]));
                    if (std::isnan(s))
                        grid.valid[i] = 0;
                    else
                        grid.codes[i] = static_cast<std::uint16_t>(std::lround(s * grid.maxCode));
                }
            });
        },
        volume.samples());
    return grid;
}

} // namespace pellucid
