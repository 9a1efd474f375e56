#include "tf/hsb_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "tf/eight_bit.h"
#include "volume/voxel_loops.h"

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
    withSamples(volume, [&](const auto& values) {
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] = allValid || volume.isValid(first + i)
                         ? std::clamp((static_cast<double>(values[first + i]) - lo) * scale, 0.0, 1.0)
                         : 0.0;
    });
}

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
                for (std::size_t c = 0; c < 3; ++c)
                    rgb[c] = static_cast<std::uint8_t>(eightBit(brightness * (1 - saturation * (1 - pure[c]))));
                colors.rgba[first + i] = VoxelColors::pack(rgb[0], rgb[1], rgb[2]);
            }
        }
    });
    return colors;
}

std::optional<double> automaticScale(const Volume& channel) {
    constexpr std::size_t kBins = 4096;
    std::array<std::size_t, kBins + 1> counts{};
    std::size_t above = 0;
    for (std::size_t i = 0; i < channel.size(); ++i) {
        const double s = channel.intensity(i);
        if (!(s > 0.5 / kBins)) continue; // as good as nothing
        ++counts[static_cast<std::size_t>(s * kBins)];
        ++above;
    }
    if (above == 0) return {};
    std::size_t below = 0, bin = 0;
    for (; bin < kBins && below + counts[bin] < above - above / 20; ++bin) below += counts[bin];
    return static_cast<double>(kBins) / static_cast<double>(std::min(bin + 1, kBins));
}

TransferFunction opacityRamp(double top) {
    PELLUCID_CHECK(top > 0 && top <= 1);
    constexpr int kThirds = 3;
    const std::array<const char*, kThirds> names{"low", "middle", "high"};
    const std::array<Rgb, kThirds> colors{Rgb{0.30, 0.55, 0.85}, Rgb{0.90, 0.65, 0.20}, Rgb{0.85, 0.25, 0.25}};
    TransferFunction tf;
    for (int f = 0; f < kThirds; ++f) {
        const auto index = static_cast<std::size_t>(f);
        const double a = static_cast<double>(f) / kThirds, b = (f + 1.0) / kThirds;
        // A pair of points where two features meet: each can be scaled alone.
        tf.points.push_back({a, top * a, colors[index], false, {}});
        tf.points.push_back({b, top * b, colors[index], false, {}});
        tf.features.push_back({names[index], a, b, colors[index], {}});
    }
    return tf;
}

double rampOpacity(const Volume& volume) {
    std::vector<double> sums(static_cast<std::size_t>(volume.dims().z), 0.0);
    const std::size_t plane = layerSize(volume.dims());
    parallelFor(sums.size(), [&](std::size_t k) {
        for (std::size_t i = k * plane; i < (k + 1) * plane; ++i)
            if (const double s = volume.intensity(i); s > 0) sums[k] += s; // NaN is not
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    const Geometry& g = volume.geometry();
    const Vec3 edges = Vec3(g.dims) * g.spacing / g.d0();
    const double depth = sum / static_cast<double>(volume.size()) * std::min({edges.x, edges.y, edges.z});
    constexpr double kDepth = 1.5, kLeast = 0.02;
    return depth > 0 ? std::clamp(kDepth / depth, kLeast, 1.0) : 1.0;
}

} // namespace pellucid
