// Options of the light → the light that is drawn.
#include <algorithm>

#include <catch2/catch.hpp>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "options/light_options.h"
#include "parse.h"
#include "render/light_presets.h"

using namespace pellucid;
using namespace pellucid::cli;

namespace {

Light lightOf(std::vector<std::string> words, Light session = {}) {
    CLI::App app;
    LightOptions options;
    options.add(app);
    std::reverse(words.begin(), words.end());
    app.parse(std::move(words));
    options.applyTo(session);
    return session;
}

} // namespace

TEST_CASE("light is off unless it is asked for, or on in the session", "[cli][light]") {
    CHECK(lightOf({}) == Light{});
    CHECK_FALSE(lightOf({}).on);
    Light lit;
    lit.on = true;
    lit.specular = 0.5;
    CHECK(lightOf({}, lit) == lit);
    CHECK_FALSE(lightOf({"--no-shading"}, lit).on);
    CHECK(lightOf({"--no-shading"}, lit).specular == 0.5);
    for (const std::vector<std::string>& asked : {std::vector<std::string>{"--shading"},
                                                  {"--light", "diffuse=1"},
                                                  {"--light-preset", "matte"},
                                                  {"--light-direction", "1,0,0"}})
        CHECK(lightOf(asked).on);
    CHECK_FALSE(lightOf({"--silhouettes", "0.5"}).on); // it works without
}

TEST_CASE("single numbers lie over the preset, the preset over the session", "[cli][light]") {
    Light session;
    session.direction = {1, 2, 3};
    session.depthCue = 0.25;
    const Light metal = lightOf({"--light-preset", "metal"}, session);
    CHECK(metal == withPreset(session, lightPreset("metal")));
    const Light light =
        lightOf({"--light-preset", "metal", "--light", "ambient=0.5,shininess=10", "--light-direction", "-1,0,1",
                 "--occlusion", "0.5", "--depth-cue", "1", "--gradient-opacity", "0.75", "--silhouettes", "0"},
                session);
    CHECK(light.ambient == 0.5);
    CHECK(light.shininess == 10);
    CHECK(light.diffuse == metal.diffuse);
    CHECK(light.direction == Vec3(-1, 0, 1));
    CHECK(light.occlusion == 0.5);
    CHECK(light.depthCue == 1);
    CHECK(light.gradientOpacity == 0.75);
    CHECK(light.silhouettes == 0);
}

TEST_CASE("wrong lights are wrong usage", "[cli][light]") {
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--light", "ambient"},
                                                  {"--light", "ambient=3"},
                                                  {"--light", "shininess=0"},
                                                  {"--light", "colour=1"},
                                                  {"--light-preset", "gold"},
                                                  {"--light-direction", "0,0,0"},
                                                  {"--light-direction", "1,2"},
                                                  {"--occlusion", "2"},
                                                  {"--no-shading", "--shading"},
                                                  {"--no-shading", "--light-preset", "soft"}}) {
        INFO(wrong.back());
        CHECK_THROWS_AS(lightOf(wrong), UsageError);
    }
}

TEST_CASE("a background is a colour or two", "[cli]") {
    const Gradient plain = parseBackground("0.5,0,1", "--background");
    CHECK(plain.bottom == Rgb{0.5, 0, 1});
    CHECK_FALSE(plain.top);
    const Gradient both = parseBackground("#fff/0,0,0.5", "--background"); // as they are seen: the top first
    CHECK(both.bottom == Rgb{0, 0, 0.5});
    CHECK(both.top == Rgb{1, 1, 1});
    for (const char* wrong : {"", "/", "#fff/", "#fff/#000/#fff", "red"})
        CHECK_THROWS_AS(parseBackground(wrong, "--background"), UsageError);
}
