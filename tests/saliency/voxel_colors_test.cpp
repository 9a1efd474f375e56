#include <cmath>

#include <catch2/catch.hpp>

#include "saliency/saliency_direct.h"
#include "saliency/saliency_field.h"
#include "tf/lch.h"
#include "volume/noise.h"

using namespace pellucid;

namespace {

constexpr Int3 kDims{19, 14, 11};

/// Smooth noise as float, or as bytes.
Volume noise(bool bytes) {
    Geometry g;
    g.dims = kDims;
    std::vector<float> floats;
    for (int k = 0; k < kDims.z; ++k)
        for (int j = 0; j < kDims.y; ++j)
            for (int i = 0; i < kDims.x; ++i)
                floats.push_back(static_cast<float>(127 + 120 * smoothNoise({0.4 * i, 0.4 * j, 0.4 * k}, 3)));
    if (!bytes) {
        floats[77] = std::nanf("");
        return Volume(g, SampleArray<float>(floats));
    }
    return Volume(g, SampleArray<std::uint8_t>(std::vector<std::uint8_t>(floats.begin(), floats.end())));
}

VoxelColors colors() {
    VoxelColors c{kDims, {}};
    for (std::size_t i = 0; i < voxelCount(kDims); ++i) {
        const auto channel = [&](std::uint32_t seed) {
            return static_cast<std::uint8_t>(127.5 +
                                             127 * smoothNoise({0.31 * static_cast<double>(i), 0.5, 0.2}, seed));
        };
        c.rgba.push_back(VoxelColors::pack(channel(5), channel(6), channel(7)));
    }
    return c;
}

} // namespace

TEST_CASE("saliency under colours by voxel is that of the reference", "[saliency]") {
    const VoxelColors c = colors();
    for (const bool bytes : {true, false}) {
        const Volume volume = noise(bytes);
        const WeightFields fast = saliencyFields(volume, tents(3), {}, {}, &c);
        const WeightFields slow = saliencyFieldsReference(volume, tents(3), {}, {}, &c);
        WeightFields direct;
        updateSaliencyFieldsDirect(direct, volume, tents(3), {}, {}, &c);
        double most = 0, mostDirect = 0, apart = 0;
        const WeightFields plain = saliencyFields(volume, tents(3));
        for (std::size_t i = 0; i < volume.size(); ++i)
            for (int a = 0; a < 2; ++a) {
                most = std::max<double>(most, std::abs(fast.at(a, i) - slow.at(a, i)));
                mostDirect = std::max<double>(mostDirect, std::abs(direct.at(a, i) - slow.at(a, i)));
                apart = std::max<double>(apart, std::abs(plain.at(a, i) - slow.at(a, i)));
            }
        CHECK(most < 1e-4); // the contract's tolerance
        CHECK(mostDirect < 1e-4);
        CHECK(apart > 0.01); // and the colours matter
    }
}

TEST_CASE("a voxel in no feature has the background, whatever its colour", "[saliency]") {
    // w2 = 0 and σ below one voxel: L is O of the voxel itself.
    const VoxelColors c = colors();
    const Volume volume = noise(true);
    SaliencyOptions options;
    options.sigma = 0.5;
    options.w2 = 0;
    const TransferFunction tf = tents(3);
    const WeightFields fields = saliencyFields(volume, tf, options, {}, &c);
    for (std::size_t i = 0; i < volume.size(); ++i) {
        const std::uint32_t v = c.rgba[i];
        const Lch lch = lchFromSrgb({(v & 255u) / 255.0, (v >> 8 & 255u) / 255.0, (v >> 16 & 255u) / 255.0});
        const bool inside = featureAt(tf.features, volume.intensity(i)) >= 0;
        CHECK(fields.at(0, i) == Approx(inside ? lch.lightness / 100 : 0).margin(1e-4));
        CHECK(fields.at(1, i) == Approx(inside ? lch.chroma / 100 : 0).margin(1e-4));
    }
}
