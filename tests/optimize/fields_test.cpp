// Fields: what they are made of, that features are parts of them, and how they are drawn at most.
#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "optimize/fields.h"
#include "optimize/measure.h"
#include "support/field_sums.h"
#include "support/random_cases.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

double sum(const Grid<float>& field) { return std::accumulate(field.begin(), field.end(), 0.0); }

} // namespace

TEST_CASE("fields have names", "[fields]") {
    for (const FieldKind kind : allOf<FieldKind>()) {
        CHECK(fromName<FieldKind>(name(kind)) == kind);
        CHECK(std::string(title(kind)) != "");
    }
    CHECK(fileStem(FieldKind::SaliencyBrightness) == "saliency_brightness");
    CHECK_THROWS_WITH(fromName<FieldKind>("depth"), Catch::Contains("saliency-brightness"));
}

TEST_CASE("the VWS field of a feature sums to its W, and parts make the whole", "[fields]") {
    for (std::uint32_t n = 0; n < 6; ++n) {
        const RandomCase c = randomCase(n);
        INFO(c.describe());
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const VwsOptions options{0.3, 0.7};
        const Grid<float> visibility = makeCpuEngine(c.volume)->field(c.camera, c.tf).values;
        const auto expected = featureMeasures(sumsOfField(*c.volume, c.tf.features, visibility, &weights), options);
        Grid<float> vws = visibility;
        visibilityToVws(vws, weights, options);
        Grid<float> rest = vws;
        for (std::size_t f = 0; f < expected.size(); ++f) {
            Grid<float> part = vws;
            keepFeature(part, *c.volume, c.tf, static_cast<int>(f));
            CHECK(sum(part) == Approx(expected[f].vws).margin(1e-5));
            for (std::size_t i = 0; i < part.size(); ++i) {
                if (part[i] == 0) continue;
                if (!c.tf.features[f].contains(c.volume->intensity(i)) || part[i] != vws[i]) FAIL("voxel " << i);
                rest[i] = 0;
            }
        }
        // What is left is in no feature.
        for (std::size_t i = 0; i < rest.size(); ++i)
            if (rest[i] != 0 && featureAt(c.tf.features, c.volume->intensity(i)) >= 0) FAIL("voxel " << i);
        // The same bits with any number of threads.
        Grid<float> once = visibility;
        setThreadCount(1);
        visibilityToVws(once, weights, options);
        setThreadCount(0);
        CHECK(std::equal(once.begin(), once.end(), vws.begin()));
    }
}

TEST_CASE("the saliency field is the weighted sum of its two parts", "[fields]") {
    WeightFields weights({3, 1, 1}, 1, 1);
    weights.set(0, 0.5f, 0.25f);
    weights.set(2, 1.0f, 0.0f);
    const VwsOptions options{0.25, 0.75};
    const Grid<float> b = saliencyGrid(weights, FieldKind::SaliencyBrightness, options);
    const Grid<float> s = saliencyGrid(weights, FieldKind::SaliencySaturation, options);
    const Grid<float> both = saliencyGrid(weights, FieldKind::Saliency, options);
    CHECK(b[0] == Approx(0.5).margin(2e-5)); // 16 bits
    CHECK(s[0] == Approx(0.25).margin(2e-5));
    CHECK(both[0] == Approx(0.25 * 0.5 + 0.75 * 0.25).margin(2e-5));
    CHECK(both[1] == 0);
    CHECK(both[2] == Approx(0.25).margin(2e-5));
    weights.set(0, 0.5f, 0); // saturation nowhere: brightness has all the say
    CHECK(saliencyGrid(weights, FieldKind::Saliency, options)[0] == Approx(0.5).margin(2e-5));
}

TEST_CASE("the usual top leaves a thousandth above it", "[fields]") {
    // 1 … 1000 and as many zeros: the value at place round(0.999 · 999) = 998 of those above 0, counted from 0, is 999.
    Grid<float> field({2000, 1, 1});
    for (int i = 0; i < 1000; ++i) field[static_cast<std::size_t>(2 * i)] = static_cast<float>(i + 1);
    CHECK(usualTop(field) == 999);
    CHECK(usualTop(Grid<float>({4, 4, 4})) == 1);
}

TEST_CASE("a field is a volume on the grid of its data", "[fields]") {
    const Geometry g = geometryOf({4, 3, 2}, {1, 2, 3}, {5, 6, 7});
    Grid<float> values(g.dims, 0.0f);
    values[5] = 0.25f;
    const Field field = fieldVolume(g, values, 0.2, "Visibility");
    CHECK(field.volume->geometry().worldFromVoxel({1, 1, 1}) == g.worldFromVoxel({1, 1, 1}));
    CHECK(field.volume->range() == ValueRange{0, 0.25});
    CHECK(field.volume->value(5) == 0.25);
    CHECK(field.top == 0.2);
    CHECK(fieldVolume(g, Grid<float>(g.dims), 1, "").volume->range() == ValueRange{0, 1}); // nothing anywhere
}

TEST_CASE("making a field can be stopped", "[fields]") {
    std::stop_source stop;
    stop.request_stop();
    const JobControl stopped{stop.get_token(), {}};
    const auto volume = slab({4, 4, 4}, 0.5);
    Grid<float> field(volume->dims(), 1.0f);
    const WeightFields weights(volume->dims(), 1, 1);
    CHECK_THROWS_AS(visibilityToVws(field, weights, {}, stopped), Cancelled);
    CHECK_THROWS_AS(saliencyGrid(weights, FieldKind::Saliency, {}, stopped), Cancelled);
    CHECK_THROWS_AS(keepFeature(field, *volume, homogeneous(0.5), 0, stopped), Cancelled);
}
