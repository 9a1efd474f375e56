#include "session/keyframes_file.h"

#include <random>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "session/session_json.h"
#include "support/film_scene.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;
using nlohmann::json;

namespace {

std::string messageOf(const json& document, const Scene& scene) {
    try {
        keyframesFromJson({document, "a.film.json"}, ".", scene);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

} // namespace

TEST_CASE("keyframes are read as they were written", "[film]") {
    const TempFolder folder;
    const Scene scene = filmScene();
    Keyframes keys = twoKeys(scene, 2, Easing::EaseOut);
    keys[1].state.clipping.planes.push_back({{0, 1, 0}, 3.5});
    writeKeyframes(keys, folder.path("a.film.json"));
    CHECK(readKeyframes(folder.path("a.film.json"), scene) == keys);
    // The same bytes again.
    writeKeyframes(readKeyframes(folder.path("a.film.json"), scene), folder.path("b.film.json"));
    CHECK(readText(folder.path("a.film.json")) == readText(folder.path("b.film.json")));
}

TEST_CASE("what a key does not say is as in the key before it", "[film]") {
    const TempFolder folder;
    const Scene scene = filmScene();
    const json document{{"format", "pellucid-film"},
                        {"version", 1},
                        {"keys",
                         {{{"time", 0}},
                          {{"time", 1}, {"tf", "tents:2:0.25"}, {"clip", {{"lo", {0, 0, 0}}, {"hi", {0.5, 1, 1}}}}},
                          {{"time", 2}}}}};
    const Keyframes keys = keyframesFromJson({document, "a.film.json"}, folder.path(""), scene);
    REQUIRE(keys.size() == 3);
    CHECK(keys[0].state == keyStateOf(scene));
    CHECK(keys[1].state.tf.features.size() == 2);
    CHECK(keys[1].state.tf.range == scene.volume->range());
    CHECK(keys[2].state == keys[1].state);
    CHECK(keys[2].state.clipping.hi.x == 0.5);
}

TEST_CASE("sessions are keys at equal times, from rest to rest", "[film]") {
    const TempFolder folder;
    const Scene scene = filmScene();
    Session one = scene.session;
    one.camera = cameraFromView(scene.volume->geometry(), 10, 0, 1, Projection::Perspective);
    writeSession(one, folder.path("one.pellucid.json"));
    one.clipping = Clipping{{0, 0, 0}, {1, 0.5, 1}, {}};
    writeSession(one, folder.path("two.pellucid.json"));
    const std::string a = folder.path("one.pellucid.json"), b = folder.path("two.pellucid.json");
    const Keyframes keys = keyframesOfText(a + "; " + b + ";" + a, 6, scene);
    REQUIRE(keys.size() == 3);
    CHECK(keys[1].time == 3);
    CHECK(keys[1].name == "two");
    CHECK(keys[0].state.camera == *one.camera);
    CHECK(keys[1].state.clipping.hi.y == 0.5);
    CHECK(keys[2].state == keys[0].state);
    CHECK(keys[0].easing == Easing::EaseIn);
    CHECK(keys[1].easing == Easing::EaseOut);
    CHECK(keyframesOfText(a + ";" + b, 6, scene)[0].easing == Easing::Smooth);
    CHECK_THROWS_AS(keyframesOfText(a, 6, scene), UsageError);
    CHECK_THROWS_AS(keyframesOfText(a + "; nothing.pellucid.json", 6, scene), FileError);
    CHECK(isFilmFile("some/where.film.json"));
    CHECK_FALSE(isFilmFile(a));
}

TEST_CASE("a wrong file of keyframes is refused with the place", "[film]") {
    const Scene scene = filmScene();
    const json good = jsonFromKeyframes(twoKeys(scene, 2));
    REQUIRE(messageOf(good, scene).empty());
    const auto says = [&](const char* pointer, const json& value, const char* place) {
        json bad = good;
        bad[json::json_pointer(pointer)] = value;
        INFO(pointer << ": " << messageOf(bad, scene));
        CHECK(messageOf(bad, scene).find(place) != std::string::npos);
    };
    says("/format", "other", "a.film.json");
    says("/version", 2, "a.film.json");
    says("/keys", json::array(), "a.film.json at /keys");
    says("/keys", 3, "a.film.json at /keys");
    says("/keys/1/time", -1, "/keys/1/time");
    says("/keys/1/time", 0, "/keys/1/time"); // not after the first
    says("/keys/1/time", 3601, "/keys/1/time");
    says("/keys/0/easing", "bounce", "/keys/0/easing");
    says("/keys/1/frame", 1, "/keys/1"); // there is one frame
    says("/keys/1/camera/eye", {0, 0}, "/keys/1/camera/eye");
    says("/keys/1/camera", "none.camera.json", "none.camera.json");
    says("/keys/1/session", "none.pellucid.json", "none.pellucid.json");
    says("/keys/1/tf", "none.tf.json", "none.tf.json");
    says("/keys/1/clip/lo", {0.9, 0, 0}, "/keys/1/clip");
    says("/keys/1/light/ambient", 7, "/keys/1/light/ambient");
    says("/keys/0/tf/points/0/x", 2, "/keys/0/tf");
    const Vec3 middle = scene.volume->geometry().boxCenter();
    says("/keys/0/camera/eye", {middle.x, middle.y, middle.z + 0.5}, "/keys/0");
}

TEST_CASE("keyframes that were damaged at random are read or refused", "[film]") {
    const Scene scene = filmScene();
    const std::string good = jsonFromKeyframes(twoKeys(scene, 2)).dump();
    std::mt19937 random(7);
    const std::string bits = "{}[],:\"-0123456789eE.tfn x";
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        std::string text = good;
        for (int n = 0; n < 3; ++n) text[random() % text.size()] = bits[random() % bits.size()];
        try {
            const json document = json::parse(text);
            for (const Keyframe& key : keyframesFromJson({document, "a"}, ".", scene)) {
                key.state.tf.validate();
                key.state.clipping.validate();
            }
        } catch (const json::exception&) {
            ++refused;
        } catch (const Error&) {
            ++refused;
        }
    }
    CHECK(refused > 100);
}
