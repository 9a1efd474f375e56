#include "tf/hsb_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace pellucid {

namespace {

/// The pure colour of a hue in degrees: the hexcone at saturation and brightness 1.
std::array<double, 3> pureColor(double degrees) {
    const auto channel = [&](double offset) { // 1 around its own hue, 0 from 120° on
        double h = std::fmod(degrees - offset, 360.0);
        if (h < 0) h += 360;
        return std::clamp(2 - std::min(h, 360 - h) / 60, 0.0, 1.0);
    };
    return {channel(0), channel(120), channel(240)};
}

/// One row of a channel's values in [0,1]; 0 where invalid.
void readRow(const Volume& volume, std::size_t first, std::vector<double>& row) {
    const double lo = volume.range().lo, span = volume.range().hi - lo, scale = span > 0 ? 1 / span : 0;
    const bool allValid = volume.invalidCount() == 0;
    std::visit(
        [&](const auto& values) {
            for (std::size_t i = 0; i < row.size(); ++i)
                row[i] = allValid || volume.isValid(first + i)
                             ? std::clamp((static_cast<double>(values[first + i]) - lo) * scale, 0.0, 1.0)
                             : 0.0;
        },
        volume.samples());
}

std::uint8_t eightBits(double channel) { return static_cast<std::uint8_t>(255 * channel + 0.5); }

} // namespace

VoxelColors hsbColors(const HsbInput& input, const JobControl& job) {
    for (const auto* channel : {&input.saturation, &input.brightness, &input.hue})
        PELLUCID_CHECK(*channel == nullptr || (*channel)->dims() == input.dims);
    VoxelColors colors{input.dims, std::vector<std::uint32_t>(voxelCount(input.dims))};
    const auto nx = static_cast<std::size_t>(input.dims.x), ny = static_cast<std::size_t>(input.dims.y);
    const std::array<double, 3> constant = pureColor(input.hueFrom);
    parallelFor(static_cast<std::size_t>(input.dims.z), [&](std::size_t k) {
        job.throwIfStopped();
        std::vector<double> s(nx, 0.0), y(nx, 0.0), h(nx, 0.0);
        for (std::size_t j = 0; j < ny; ++j) {
            const std::size_t first = nx * (j + ny * k);
            if (input.saturation) readRow(*input.saturation, first, s);
            if (input.brightness) readRow(*input.brightness, first, y);
            if (input.hue) readRow(*input.hue, first, h);
            for (std::size_t i = 0; i < nx; ++i) {
                const double saturation = input.saturation ? std::min(1.0, input.a * s[i]) : 1.0;
                const double brightness = 1 - std::min(1.0, input.b * y[i]);
                const std::array<double, 3> pure =
                    input.hue ? pureColor(input.hueFrom + h[i] * (input.hueTo - input.hueFrom)) : constant;
                std::array<std::uint8_t, 3> rgb{};
                for (std::size_t c = 0; c < 3; ++c) rgb[c] = eightBits(brightness * (1 - saturation * (1 - pure[c])));
                colors.rgba[first + i] = VoxelColors::pack(rgb[0], rgb[1], rgb[2]);
            }
        }
    });
    return colors;
}

double automaticScale(const Volume& channel) {
    constexpr std::size_t kBins = 4096;
    std::array<std::size_t, kBins + 1> counts{};
    std::size_t above = 0;
    for (std::size_t i = 0; i < channel.size(); ++i) {
        const double s = channel.intensity(i);
        if (!(s > 0.5 / kBins)) continue; // as good as nothing
        ++counts[static_cast<std::size_t>(s * kBins)];
        ++above;
    }
    if (above == 0) return 1;
    std::size_t below = 0, bin = 0;
    for (; bin < kBins && below + counts[bin] < above - above / 100; ++bin) below += counts[bin];
    return static_cast<double>(kBins) / static_cast<double>(std::min(bin + 1, kBins));
}

} // namespace pellucid
