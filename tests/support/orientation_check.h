// The same anatomy looks the same and has the same figures however its file stores it.
#pragma once

#include <array>

#include <catch2/catch.hpp>

#include "render/image_renderer.h"
#include "render/ssim.h"
#include "render/visibility.h"
#include "saliency/saliency_field.h"
#include "support/orientations.h"
#include "volume/procedural.h"

namespace pellucid::test {

/// Twelve times the mean over three voxels along each axis: what trilinear interpolation then describes well, so that
/// oblique grids hold the same anatomy.
inline Volume smoothed(const Volume& volume) {
    const Int3 d = volume.dims();
    std::vector<float> now(volume.size());
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = static_cast<float>(volume.value(i));
    const std::array<std::size_t, 3> strides{1, static_cast<std::size_t>(d.x), static_cast<std::size_t>(d.x * d.y)};
    for (int pass = 0; pass < 12; ++pass)
        for (int a = 0; a < 3; ++a) {
            const std::vector<float> before = now;
            for (std::size_t i = 0; i < now.size(); ++i) {
                const int at = static_cast<int>(i / strides[static_cast<std::size_t>(a)]) % d[a];
                const float lower = at > 0 ? before[i - strides[static_cast<std::size_t>(a)]] : before[i],
                            upper = at + 1 < d[a] ? before[i + strides[static_cast<std::size_t>(a)]] : before[i];
                now[i] = (lower + before[i] + upper) / 3;
            }
        }
    return Volume(volume.geometry(), std::move(now)).withRange(volume.range());
}

/// A smooth knee in LPS, seen from the same place in the world; three tents, air left out.
struct OrientationCase {
    std::vector<Oriented> stored;
    TransferFunction tf;
    Camera camera;

    explicit OrientationCase(int size = 52) {
        const Volume knee = makeSample("knee", size);
        Geometry g = knee.geometry();
        g.worldAxes = WorldAxes::Patient;
        // Air all around, as deep as fourteen voxels, so that the ends of the box cut nothing.
        const Volume inPatient(g, knee.samples());
        const Geometry wide = regridded(g, g.dims + 28, g.directions, g.spacing);
        const Volume padded = smoothed(Volume(wide, sampledOn(wide, inPatient, knee.dataRange().lo)));
        stored = orientations(padded, knee.dataRange().lo);
        tf = withFeatureOpacities(tents(3), {0.05, 0.1, 0.4});
        camera = cameraFromView(wide, 25, 15, 1.2, Projection::Perspective);
    }
};

/// FV and W of each feature, however it is stored, to `tolerance` of those of the first.
template <class MakeEngine>
void checkOrientationsMeasure(const OrientationCase& c, const MakeEngine& makeEngine, double tolerance) {
    std::vector<FeatureMeasures> first;
    for (const Oriented& o : c.stored) {
        const WeightFields weights = saliencyFields(*o.volume, c.tf);
        const auto engine = makeEngine(o.volume);
        const auto now = featureMeasures(engine->sums(c.camera, {&c.tf, 1}, &weights)[0]);
        if (first.empty()) first = now;
        for (std::size_t f = 0; f < now.size(); ++f) {
            INFO(o.name << ", feature " << f << ", " << engine->name());
            CHECK(std::abs(now[f].visibility - first[f].visibility) < tolerance);
            CHECK(std::abs(now[f].vws - first[f].vws) < tolerance);
        }
    }
}

template <class MakeRenderer>
void checkOrientationsLook(const OrientationCase& c, const MakeRenderer& makeRenderer) {
    for (const bool lit : {false, true}) {
        RenderSettings settings;
        settings.width = settings.height = 160;
        settings.light.on = lit;
        Image first;
        for (const Oriented& o : c.stored) {
            const Image now = makeRenderer(o.volume)->render(c.camera, c.tf, settings);
            if (first.width == 0) first = now;
            INFO(o.name << (lit ? ", lit" : ""));
            CHECK(ssim(now, first) > 0.97);
        }
    }
}

} // namespace pellucid::test
