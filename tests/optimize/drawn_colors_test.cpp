// Regions of pictures whose colours are by voxel.
#include <catch2/catch.hpp>

#include "optimize/refine/drawn_colors.h"
#include "volume/histogram.h"

using namespace pellucid;

namespace {

/// 64 voxels each of the intensities 0.25 (red) and 0.75 (blue), half of each `apart` below and half above.
struct TwoColors {
    Geometry g;
    Volume volume;
    VoxelColors colors;
};

TwoColors twoColors(float apart = 0) {
    Geometry g;
    g.dims = {8, 8, 2};
    std::vector<float> values(128, 0.25f);
    for (std::size_t i = 64; i < 128; ++i) values[i] = 0.75f;
    for (std::size_t i = 0; i < 128; ++i) values[i] += i % 2 == 0 ? apart : -apart;
    VoxelColors colors{g.dims, std::vector<std::uint32_t>(128, VoxelColors::pack(255, 0, 0))};
    for (std::size_t i = 64; i < 128; ++i) colors.rgba[i] = VoxelColors::pack(0, 0, 255);
    Volume volume = Volume(g, SampleArray<float>(std::move(values))).withRange({0, 1});
    return {g, std::move(volume), std::move(colors)};
}

TransferFunction grey(std::initializer_list<double> places) {
    TransferFunction tf;
    for (const double x : places) tf.points.push_back({x, 0.5, {0.5, 0.5, 0.5}, false, {}});
    return tf;
}

} // namespace

TEST_CASE("a control point has the mean colour of the voxels around it", "[refine][colors]") {
    const TwoColors data = twoColors();
    // 0.25 lies halfway between 0.2 and 0.3, 0.75 a quarter of the way from 0.7 to 0.9; 0.05 has voxels on no side.
    const TransferFunction drawn = withDrawnColors(grey({0.05, 0.1, 0.2, 0.3, 0.7, 0.9}), data.volume, &data.colors);
    CHECK(drawn.points[0].color == Rgb{0.5, 0.5, 0.5});
    CHECK(drawn.points[1].color == Rgb{0.5, 0.5, 0.5});
    CHECK(drawn.points[2].color == Rgb{1, 0, 0});
    CHECK(drawn.points[3].color == Rgb{1, 0, 0});
    CHECK(drawn.points[4].color == Rgb{0, 0, 1});
    CHECK(drawn.points[5].color == Rgb{0, 0, 1});
    // A point at 0.5 gets both at equal weights.
    const TransferFunction mixed = withDrawnColors(grey({0, 0.5, 1}), data.volume, &data.colors);
    CHECK(mixed.points[1].color.r == Approx(0.5).margin(2e-3)); // bins of 1/1024
    CHECK(mixed.points[1].color.g == 0);
    CHECK(mixed.points[1].color.b == Approx(0.5).margin(2e-3));
    CHECK(withDrawnColors(grey({0, 1}), data.volume, nullptr) == grey({0, 1}));
}

TEST_CASE("a region favours what is drawn in its colour", "[refine][colors]") {
    const TwoColors data = twoColors(0.03f); // on both sides of each peak
    const Histogram histogram = makeHistogram(data.volume);
    TransferFunction tf = grey({0.15, 0.25, 0.35, 0.65, 0.75, 0.85});
    for (const std::size_t end : {0u, 2u, 3u, 5u}) {
        tf.points[end].opacity = 0;
        tf.points[end].fixed = true;
    }
    RefineOptions options;
    const auto ratio = [&](const Rgb& chosen) {
        options.priority.region = {{chosen, 10}};
        const RefineResult r = refineAsDrawn(histogram, tf, data.volume, &data.colors, options);
        for (std::size_t i = 0; i < tf.points.size(); ++i) CHECK(r.tf.points[i].color == tf.points[i].color);
        return r.tf.points[1].opacity / r.tf.points[4].opacity;
    };
    // Half of the voxels are red and half blue: what favours the one does to the other what the other would.
    const double red = ratio({1, 0, 0}), blue = ratio({0, 0, 1});
    CHECK(red > 1.5);
    CHECK(blue < 1 / 1.5);
    // By the colours of the transfer function, all grey, no region favours any point.
    options.priority.region = {{{1, 0, 0}, 10}};
    const RefineResult plain = refineAsDrawn(histogram, tf, data.volume, nullptr, options);
    CHECK(plain.tf.points[1].opacity == Approx(plain.tf.points[4].opacity).margin(0.01));
}
