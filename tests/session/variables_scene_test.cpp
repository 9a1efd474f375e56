// Scenes of several variables: colours, pictures, figures.
#include <cmath>

#include <catch2/catch.hpp>

#include "engines/engines.h"
#include "render/image_renderer.h"
#include "session/coarser_input.h"
#include "session/variable_edits.h"
#include "session/view_workspace.h"
#include "session/workspace.h"
#include "tf/hsb_colors.h"

using namespace pellucid;

namespace {

/// Cloud x and precipitation y of the small hurricane at a frame; volatility of x over n frames as saturation.
SceneInputs hurricane(int frame, int n) {
    SceneInputs inputs;
    VolumeSource source;
    source.path = "sample:hurricane";
    source.sampleSize = 40;
    inputs.session = sessionOf(source);
    Variable rain;
    rain.name = "y";
    rain.source = source;
    rain.source.path = "sample:hurricane/precipitation";
    addVariable(inputs.session, rain);
    inputs.session.hsb.edit([&](HsbMapping& h) {
        h.on = true;
        h.saturation = "volatility:x:" + std::to_string(n);
        h.brightness = "y";
        h.a = 7;
        h.b = 3;
        h.hueFrom = 0;
    });
    inputs.frame = frame;
    inputs.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return inputs;
}

std::vector<float> pictureOf(const Scene& scene) {
    const PictureInput in = pictureInput(scene, 48, 40);
    const auto renderer = makeRenderer(EngineChoice::Cpu, in.volume);
    return renderer->render(in.camera, in.tf, in.settings).rgba;
}

} // namespace

TEST_CASE("the colours of a scene are equation 6.1 of its frames, to 1/255", "[variables]") {
    // Frame 3 of n = 10 has four frames before and with it; hue 0 is red: (B, B(1 − S), B(1 − S)).
    for (const auto& [frame, n] : {std::pair{3, 10}, std::pair{12, 5}, std::pair{12, 1}}) {
        const Scene scene = openScene(hurricane(frame, n));
        REQUIRE(scene.colors != nullptr);
        const ValueRange x = scene.series->range();
        TimeSeries& rain = *scene.others.at("y");
        const ValueRange y = rain.range();
        std::vector<std::shared_ptr<const Volume>> frames;
        for (int f = std::max(0, frame - n + 1); f <= frame; ++f) frames.push_back(scene.series->load(f));
        const auto now = rain.load(frame);
        double colored = 0;
        for (std::size_t i = 0; i < scene.volume->size(); ++i) {
            double mean = 0, sum = 0;
            bool valid = true;
            const auto normal = [&](const Volume& v) { return (v.value(i) - x.lo) / (x.hi - x.lo); };
            for (const auto& v : frames) valid = valid && v->isValid(i);
            if (valid) {
                for (const auto& v : frames) mean += normal(*v) / static_cast<double>(frames.size());
                for (const auto& v : frames) sum += std::pow(normal(*v) - mean, 2);
            }
            const double s = std::min(1.0, 7 * std::sqrt(sum / static_cast<double>(frames.size())));
            const double b = 1 - (now->isValid(i) ? std::min(1.0, 3 * (now->value(i) - y.lo) / (y.hi - y.lo)) : 0.0);
            const std::uint32_t c = scene.colors->rgba[i];
            const auto channel = [&](int at) { return static_cast<double>(c >> (8 * at) & 255u); };
            REQUIRE(channel(0) == Approx(255 * b).margin(1));
            REQUIRE(channel(1) == Approx(255 * b * (1 - s)).margin(1));
            REQUIRE(channel(2) == Approx(255 * b * (1 - s)).margin(1));
            colored = std::max(colored, channel(0) - channel(1));
        }
        if (n == 1)
            CHECK(colored == 0); // one frame does not vary
        else
            CHECK(colored > 50);
    }
}

TEST_CASE("swapping X and Y and back gives the same picture", "[variables]") {
    const Scene first = openScene(hurricane(12, 5));
    const std::vector<float> before = pictureOf(first);
    Session swapped = first.session;
    swapOpacityAndBrightness(swapped);
    const Scene second = resolve(swapped, first);
    CHECK(second.session.variable().name == "y");
    CHECK_FALSE(pictureOf(second) == before);
    Session back = second.session;
    swapOpacityAndBrightness(back);
    const Scene third = resolve(back, second);
    CHECK(third.tf == first.tf);
    CHECK(third.colors->rgba == first.colors->rgba);
    CHECK(pictureOf(third) == before);
}

TEST_CASE("where colours are by variable, opacity begins as a ramp with features", "[variables]") {
    const Scene scene = openScene(hurricane(12, 5));
    CHECK(scene.proposal == nullptr);
    REQUIRE(scene.tf.features.size() == 3);
    CHECK(scene.tf.points.front().opacity == 0);
    const double top = scene.tf.points.back().opacity;
    CHECK(top > 0);
    for (const ControlPoint& p : scene.tf.points) CHECK(p.opacity == Approx(top * p.x).margin(1e-12));
    const Measures m = Workspace().measure(measureInput(scene));
    double sum = 0;
    for (const FeatureMeasures& f : m.features) {
        CHECK(f.vws > 0);
        sum += f.vws;
    }
    CHECK(sum == Approx(1).margin(1e-6));
}

TEST_CASE("the average ray along the shortest edge meets an optical depth of 1.5", "[variables]") {
    // Intensity ½ on average, 40 voxels: h·½·40 = 1.5.
    std::vector<float> values(40 * 50 * 60);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 2);
    Geometry g;
    g.dims = {40, 50, 60};
    CHECK(rampOpacity(Volume(g, SampleArray<float>(std::move(values)))) == Approx(0.075));
    CHECK(rampOpacity(Volume(g, SampleArray<float>(std::vector<float>(120000, 0.0f)))) == 1);
}

TEST_CASE("figures, coarser copies and views are of the colours that are drawn", "[variables]") {
    const Scene scene = openScene(hurricane(12, 5));
    const MeasureInput drawn = measureInput(scene);
    REQUIRE(drawn.colors == scene.colors);
    MeasureInput plain = drawn;
    plain.colors.reset();
    Workspace workspace; // one for both: what is kept knows its colours
    const Measures a = workspace.measure(drawn), b = workspace.measure(plain), c = workspace.measure(drawn);
    CHECK(std::abs(a.features[0].vws - b.features[0].vws) > 0.01);
    for (std::size_t f = 0; f < a.features.size(); ++f) {
        CHECK(c.features[f].vws == a.features[f].vws);
        CHECK(a.features[f].visibility == b.features[f].visibility);
    }

    const MeasureInput coarse = coarserInput(drawn, 3);
    REQUIRE(coarse.colors != nullptr);
    CHECK(coarse.colors->dims == coarse.volume->dims());
    const int nx = drawn.colors->dims.x, ny = drawn.colors->dims.y;
    double red = 0; // of the first block
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
                red += (drawn.colors->rgba[static_cast<std::size_t>(i + nx * (j + ny * k))] & 255u) / 27.0;
    CHECK((coarse.colors->rgba[0] & 255u) == Approx(red).margin(0.5 + 1e-9));
    MeasureInput coarsePlain = coarse;
    coarsePlain.colors.reset();
    CHECK(std::abs(workspace.measure(coarse).features[0].vws - workspace.measure(coarsePlain).features[0].vws) > 0.01);

    ViewWorkspace views;
    ViewMetric metric;
    metric.targets = {0.2, 0.3, 0.5};
    const auto mapOf = [&](const MeasureInput& input) { return views.search(input, metric, 20).map.values; };
    const std::vector<double> ofDrawn = mapOf(drawn), ofPlain = mapOf(plain);
    CHECK_FALSE(ofDrawn == ofPlain);
    CHECK(mapOf(drawn) == ofDrawn);
}

TEST_CASE("published volatility is stretched and each frame is normalised by itself", "[variables][published]") {
    SceneInputs inputs = hurricane(6, 3);
    const Scene before = openScene(inputs);
    inputs.session.measure.edit([](MeasureSettings& m) { m.profile = Profile::Published; });
    const Scene scene = openScene(inputs);
    // Of frames 4 to 6, each over its own largest and least value: the sample deviation (n − 1 = 2), then stretched.
    const std::size_t size = scene.volume->size();
    std::vector<double> deviation(size, 0);
    std::vector<std::vector<double>> frames;
    for (int f = 4; f <= 6; ++f) {
        const auto volume = scene.series->load(f);
        const ValueRange range = volume->dataRange();
        std::vector<double>& scaled = frames.emplace_back();
        for (std::size_t i = 0; i < size; ++i) scaled.push_back((volume->value(i) - range.lo) / (range.hi - range.lo));
    }
    double least = 1e9, most = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const double mean = (frames[0][i] + frames[1][i] + frames[2][i]) / 3;
        double sum = 0;
        for (const auto& f : frames) sum += (f[i] - mean) * (f[i] - mean);
        deviation[i] = std::sqrt(sum / 2);
        if (!scene.volume->isValid(i)) continue;
        least = std::min(least, deviation[i]);
        most = std::max(most, deviation[i]);
    }
    const auto rain = scene.others.at("y")->load(6);
    const ValueRange y = rain->dataRange();
    for (std::size_t i = 0; i < size; i += 7) {
        if (!scene.volume->isValid(i) || !rain->isValid(i)) continue;
        const double s = std::min(1.0, 7 * (deviation[i] - least) / (most - least));
        const double b = 1 - std::min(1.0, 3 * (rain->value(i) - y.lo) / (y.hi - y.lo));
        REQUIRE((scene.colors->rgba[i] & 255u) == Approx(255 * b).margin(1));
        REQUIRE((scene.colors->rgba[i] >> 8 & 255u) == Approx(255 * b * (1 - s)).margin(1));
    }
    CHECK_FALSE(scene.colors->rgba == before.colors->rgba);

    // The definitions changed in a scene that is open, and changed back; a scale found by the one is not the other's.
    Session session = before.session;
    session.measure = scene.session.measure;
    CHECK_FALSE(needsData(session, before));
    const Scene changed = resolve(session, before);
    CHECK(changed.colors->rgba == scene.colors->rgba);
    CHECK(resolve(before.session, changed).colors->rgba == before.colors->rgba);
    inputs.session.hsb.edit([](HsbMapping& h) { h.a.reset(); });
    const Scene automatic = openScene(inputs);
    session = automatic.session;
    session.measure = before.session.measure;
    CHECK(automatic.hsbA < 0.5 * resolve(session, automatic).hsbA);
    CHECK(resolve(session, automatic).hsbA == openScene([&] {
                                                  SceneInputs plain = inputs;
                                                  plain.session.measure = before.session.measure;
                                                  return plain;
                                              }())
                                                  .hsbA);
    CHECK(definitionOf(scene.session, {Derivation::Kind::Volatility, "x", 3, 0}).find("sample") == 0);
    CHECK(definitionOf(before.session, {Derivation::Kind::Volatility, "x", 3, 0}).find("population") == 0);

    // A volatility in the first place is other data then.
    setChannel(session, Channel::Opacity, "volatility:x:3");
    const Scene first = resolve(session, automatic);
    Session published = first.session;
    published.measure = scene.session.measure;
    CHECK(needsData(published, first));
    const Scene other = resolve(published, first);
    CHECK(other.data->dataRange() == ValueRange{0, 1});
    CHECK(first.data->dataRange().hi < 0.6);
}

TEST_CASE("the published profile has no colours by variable", "[variables]") {
    SceneInputs inputs = hurricane(12, 5);
    inputs.session.measure.edit([](MeasureSettings& m) { m.profile = Profile::Published; });
    CHECK(measureInput(openScene(inputs)).colors == nullptr);
}

TEST_CASE("automatic scales are those of the frame where the mapping began, also in a session opened elsewhere",
          "[variables]") {
    SceneInputs inputs = hurricane(20, 5);
    inputs.session.hsb.edit([](HsbMapping& h) { h.a.reset(), h.b.reset(); });
    const Scene began = openScene(inputs);
    const HsbMapping::Found& found = began.session.hsb->found;
    CHECK(found.saturation == "volatility:x:5");
    CHECK(found.brightness == "y");
    CHECK(found.a == began.hsbA);
    CHECK(found.b == began.hsbB);
    Session later = began.session;
    later.frame = 33;
    const Scene moved = resolve(later, began);
    SceneInputs again;
    again.session = moved.session;
    const Scene opened = openScene(again);
    CHECK(opened.session.frame == 33);
    for (const Scene* scene : {&moved, &opened}) {
        CHECK(scene->hsbA == began.hsbA);
        CHECK(scene->hsbB == began.hsbB);
    }
    CHECK(opened.colors->rgba == moved.colors->rgba);

    // Where a variable is 0 everywhere, as volatility is in the first frame, nothing is found yet.
    SceneInputs still = hurricane(0, 5);
    still.session.hsb.edit([](HsbMapping& h) { h.a.reset(); });
    const Scene first = openScene(still);
    CHECK(first.hsbA == 1);
    CHECK_FALSE(first.session.hsb->found.a);
    Session next = first.session;
    next.frame = 20;
    CHECK(resolve(next, first).hsbA == began.hsbA);

    // What is set by hand, and what is of another variable, is not found there.
    Session other = moved.session;
    other.hsb.edit([](HsbMapping& h) {
        h.a = 2;
        h.brightness = "gradient:x";
    });
    const Scene changed = resolve(other, moved);
    CHECK(changed.hsbA == 2);
    CHECK_FALSE(changed.session.hsb->found.a);
    CHECK(changed.session.hsb->found.brightness == "gradient:x");
    TimeSeries& gradient = *changed.others.at("gradient:x");
    CHECK(changed.hsbB == automaticScale(gradient.load(33)->withRange(gradient.range())));
}
