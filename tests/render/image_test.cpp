#include <catch2/catch.hpp>

#include "base/error.h"
#include "render/image_renderer.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

RenderSettings small() {
    RenderSettings settings;
    settings.width = 31, settings.height = 21;
    settings.background = {};
    return settings;
}

} // namespace

TEST_CASE("a pixel's alpha is 1 − exp(−∫τ), its colour that of the volume", "[image]") {
    // Ten planes of α = 0.1 along the view: 1 − 0.9^10.
    const auto volume = slab({12, 10, 12}, 0.5);
    const Image image =
        makeCpuRenderer(volume)->render(lookingAlong(volume->geometry(), {0, 1, 0}), homogeneous(0.1), small());
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 8;
    const Image close = makeCpuRenderer(volume)->render(camera, homogeneous(0.1), small());
    CHECK(close.pixel(15, 10)[3] == Approx(1 - std::pow(0.9, 10)).margin(1e-3));
    CHECK(close.pixel(15, 10)[0] == Approx(1).margin(1e-3));
    CHECK(close.pixel(15, 10)[1] == Approx(0).margin(1e-3));
    CHECK(image.pixel(0, 0)[3] == 0); // beside the volume
}

TEST_CASE("a background shows through in proportion", "[image]") {
    const auto volume = slab({12, 4, 12}, 0.5);
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 4;
    RenderSettings settings = small();
    settings.background = Rgb{0, 0, 1};
    const Image image = makeCpuRenderer(volume)->render(camera, homogeneous(0.2), settings);
    CHECK(image.pixel(15, 10)[2] == Approx(std::pow(0.8, 4)).margin(1e-3));
    CHECK(image.pixel(15, 10)[0] == Approx(1 - std::pow(0.8, 4)).margin(1e-3));
    CHECK(image.pixel(15, 10)[3] == 1);
}

TEST_CASE("clipping shortens the path", "[image]") {
    const auto volume = slab({12, 10, 12}, 0.5);
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 4;
    RenderSettings settings = small();
    settings.clipping.hi.y = 0.5;
    CHECK(makeCpuRenderer(volume)->render(camera, homogeneous(0.1), settings).pixel(15, 10)[3] ==
          Approx(1 - std::pow(0.9, 5)).margin(1e-3));
}

TEST_CASE("what an object lies on can be drawn faintly", "[image][clip]") {
    // Ten voxels of alpha 0.1: five whole, five of which 0.2 of the optical depth counts: as many as six.
    const auto volume = slab({12, 10, 12}, 0.5);
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 4;
    RenderSettings settings = small();
    FaintRest& rest = settings.clipping.rest;
    rest.density = 0.2;
    const auto renderer = makeCpuRenderer(volume);
    const auto alphaIs = [&](double expected) {
        CHECK(renderer->render(camera, homogeneous(0.1), settings).pixel(15, 10)[3] == Approx(expected).margin(1e-3));
        CHECK(renderer->preview(camera, homogeneous(0.1), settings, 1).pixel(15, 10)[3] ==
              Approx(expected).margin(0.01));
    };
    for (const bool behind : {false, true}) { // the faint half
        rest.within.lo.y = behind ? 0 : 0.5;
        rest.within.hi.y = behind ? 0.5 : 1;
        alphaIs(1 - std::pow(0.9, 6));
    }
    // Half of it cut away: 2.5 voxels, or as many as 0.5.
    settings.clipping.hi.y = 0.75;
    alphaIs(1 - std::pow(0.9, 5.5));
    settings.clipping.hi.y = 1;
    rest.density = 0; // left out
    alphaIs(1 - std::pow(0.9, 5));
    // Other modes leave it out: of a half of 1 and a half of 0.5 they show the first alone.
    const auto halves = volumeFrom(geometryOf({12, 10, 12}), [](int, int j, int) { return j < 5 ? 0.5 : 1; });
    rest = {{{0, 0, 0}, {1, 0.4, 1}, {}}, 0.5};
    settings.mode = RenderMode::Mip;
    CHECK(makeCpuRenderer(halves)->render(camera, homogeneous(0.1), settings).pixel(15, 10)[0] ==
          Approx(0.5).margin(1e-3));
}

TEST_CASE("one feature can be drawn alone", "[image]") {
    // A block of intensity 1/6 (feature 1 of three tents) in front of one of 5/6 (feature 3).
    const auto volume = volumeFrom(geometryOf({8, 8, 8}), [](int, int j, int) { return j < 4 ? 1.0 / 6 : 5.0 / 6; });
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 4;
    RenderSettings settings = small();
    settings.onlyFeature = 2;
    const Image image = makeCpuRenderer(volume)->render(camera, tents(3, 0.9), settings);
    const Rgb expected = tents(3).features[2].color; // magenta
    CHECK(image.pixel(15, 10)[0] == Approx(expected.r).margin(0.02));
    CHECK(image.pixel(15, 10)[1] == Approx(expected.g).margin(0.02));
    CHECK(image.pixel(15, 10)[3] > 0.9);
}

TEST_CASE("a feature that is not there is wrong usage", "[image]") {
    const auto volume = slab({4, 4, 4}, 0.5);
    const Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    RenderSettings settings = small();
    for (const int index : {3, 1'000'000, -2}) {
        settings.onlyFeature = index;
        CHECK_THROWS_MATCHES(makeCpuRenderer(volume)->render(camera, tents(3), settings), UsageError,
                             Catch::Message("there is no feature number " + std::to_string(index) +
                                            ", transfer function, it has 3, counted from 0"));
    }
    settings.onlyFeature = 0;
    CHECK_THROWS_WITH(makeCpuRenderer(volume)->render(camera, TransferFunction{}, settings),
                      Catch::Contains("it has 0"));
}

TEST_CASE("shading changes colours, never alpha", "[image]") {
    const auto volume = volumeFrom(geometryOf({16, 16, 16}), [](int i, int j, int k) {
        return std::clamp(1.2 - glm::length(Vec3(i, j, k) - 7.5) / 8, 0.0, 1.0);
    });
    const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
    RenderSettings settings = small();
    const Image flat = makeCpuRenderer(volume)->render(camera, tents(2), settings);
    settings.light.on = true;
    const Image lit = makeCpuRenderer(volume)->render(camera, tents(2), settings);
    double difference = 0;
    for (std::size_t i = 0; i < flat.rgba.size(); ++i) {
        if (i % 4 == 3)
            CHECK(lit.rgba[i] == flat.rgba[i]);
        else
            difference = std::max(difference, static_cast<double>(std::abs(lit.rgba[i] - flat.rgba[i])));
    }
    CHECK(difference > 0.1);
}

TEST_CASE("impossible settings are refused", "[image]") {
    const auto refused = [](auto change) {
        RenderSettings settings;
        change(settings);
        CHECK_THROWS_AS(settings.validate(), UsageError);
    };
    refused([](RenderSettings& s) { s.width = 0; });
    refused([](RenderSettings& s) { s.height = 20000; });
    refused([](RenderSettings& s) { s.stepInD0 = 0; });
    refused([](RenderSettings& s) { s.finestInD0 = 0.001; });
    refused([](RenderSettings& s) { s.clipping.lo.x = 1; });
    refused([](RenderSettings& s) { s.clipping.rest.density = 1; });
    refused([](RenderSettings& s) { s.clipping.rest.within.hi.z = 0; });
}
