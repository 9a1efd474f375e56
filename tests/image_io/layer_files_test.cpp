// Layers as files.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"
#include "image_io/image_file.h"
#include "image_io/layer_files.h"
#include "image_io/png_text.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Two pixels: the first 0.5 opaque, from two features; the second has nothing.
PictureLayers twoPixels() {
    PictureLayers layers(2, 1, 2);
    layers.picture.rgba = {0.6f, 0.2f, 0, 0.5f, 0, 0, 0, 0};
    layers.features[0].rgba = {0.2f, 0.1f, 0, 0.3f, 0, 0, 0, 0};
    layers.features[1].rgba = {0.1f, 0, 0, 0.2f, 0, 0, 0, 0};
    layers.depth.values[0] = 12.5f;
    layers.normals = {0.6f, 0, 0.8f, 0, 0, 0};
    return layers;
}

std::vector<Feature> features() { return {{"Bone", 0, 0.5, {}, {}}, {"a/b.c", 0.5, 1, {}, {}}}; }

} // namespace

TEST_CASE("layers are called after their features, harmlessly and differently", "[layers]") {
    const auto named = [](const std::vector<std::string>& names) {
        std::vector<Feature> all;
        for (const std::string& name : names) {
            all.emplace_back();
            all.back().name = name;
        }
        return layerNames(all);
    };
    using Names = std::vector<std::string>;
    CHECK(named({"bone", "Knochen-2", "歯"}) == Names{"bone", "Knochen-2", "歯"});
    CHECK(named({"../x", "a.b", "a b", "", "-rf", "x:y"}) == Names{"___x", "a_b", "a_b_2", "feature", "_rf", "x_y"});
    CHECK(named({"bone", "Bone", "BONE"}) == Names{"bone", "Bone_2", "BONE_3"});
    CHECK(named({"evil\u202etxt.exe", "tab\tnul"}) == Names{"evil_txt_exe", "tab_nul"}); // turns the writing around
    const Names lengthy = named({std::string(300, 'x'), std::string(300, 'x')});
    CHECK(lengthy[0].size() == 64);
    CHECK(lengthy[1].size() == 64);
    CHECK(lengthy[0] != lengthy[1]);
    // Cut between characters: 21 of three bytes are 63.
    std::string teeth;
    for (int i = 0; i < 40; ++i) teeth += "歯";
    CHECK(named({teeth})[0].size() == 63);
}

TEST_CASE("an EXR file of layers has them in linear light, and they sum to the picture", "[layers]") {
    const TempFolder folder;
    const std::string path = folder.path("x.exr");
    writeLayers(twoPixels(), features(), path, {"Pellucid", "two pixels", "", ""});
    const std::string bytes = readText(path);
    for (const char* channel : {"feature.Bone.R", "feature.a_b_c.A", "rest.B", "depth.Z", "normal.X"})
        CHECK(bytes.find(channel) != std::string::npos);
    CHECK(bytes.find("two pixels") != std::string::npos);
    CHECK(bytes.find(R"([{"layer":"feature.Bone","name":"Bone"},{"layer":"feature.a_b_c","name":"a/b.c"}])") !=
          std::string::npos);
    const Image picture = readImage(path);
    CHECK(picture.rgba[0] == Approx(0.6f));
    CHECK(picture.rgba[3] == Approx(0.5f));
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(writeLayers(twoPixels(), features(), folder.path("y.exr"), {}, {stop.get_token(), {}}), Cancelled);
    CHECK_THROWS_AS(writeLayers(twoPixels(), features(), folder.path("y"), {}, {stop.get_token(), {}}), Cancelled);
    CHECK(folder.fileCount() == 1);
    CHECK_THROWS_AS(writeLayers(twoPixels(), features(), folder.path("y.png")), UsageError);
}

TEST_CASE("a folder of layers says which picture is what", "[layers]") {
    const TempFolder folder;
    const std::string path = folder.path("layers");
    writeLayers(twoPixels(), features(), path, {"Pellucid", "", "", ""});
    const auto at = [&](const std::string& name) { return (std::filesystem::path(path) / name).string(); };
    const nlohmann::json index = readJson(at("layers.json"));
    CHECK(index["format"] == "pellucid-layers");
    CHECK(index["size"] == nlohmann::json({2, 1}));
    CHECK(index["features"][1]["name"] == "a/b.c");
    const Image bone = readImage(at(index["features"][0]["picture"]));
    // Straight: 0.2 of a share of 0.3; with 16 bits.
    CHECK(bone.rgba[0] == Approx(0.2 / 0.3).margin(1e-5));
    CHECK(bone.rgba[3] == Approx(0.3).margin(1e-5));
    CHECK(readImage(at(index["features"][1]["mask"])).rgba[0] == Approx(0.2).margin(1e-5));
    const Image depth = readImage(at(index["depth"]["file"]));
    CHECK(index["depth"]["range"] == nlohmann::json({12.5, 12.5}));
    CHECK(depth.rgba[0] == Approx(1 / 65535.0).epsilon(1e-3)); // the nearest is 1, nothing is 0
    CHECK(depth.rgba[4] == 0);
    const Image normal = readImage(at(index["normal"]));
    CHECK(normal.rgba[0] == Approx(0.8).margin(1e-5)); // 0.5 + 0.5 · 0.6
    CHECK(normal.rgba[2] == Approx(0.9).margin(1e-5));
    CHECK(normal.rgba[7] == 0);
    CHECK(readPngTexts(at("picture.png")) == std::vector<PngText>{{"Software", "Pellucid"}});

    writeLayers(twoPixels(), features(), path); // the same again
    std::filesystem::create_directory(folder.path("mine"));
    writeTextAtomically(folder.path("mine") + "/letter.txt", "dear");
    CHECK_THROWS_AS(writeLayers(twoPixels(), features(), folder.path("mine")), FileError);
    CHECK(readText(folder.path("mine") + "/letter.txt") == "dear");
}
