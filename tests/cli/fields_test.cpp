// Fields on the command line: as files, also of features, and in the place of the data in a picture.
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "tf/color_maps.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::operator+;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kShells{"sample:shells", "--sample-size", "16", "--tf", "tents:3:0.2", "--engine", "cpu"};

Volume readVolume(const std::filesystem::path& path) {
    VolumeSource source;
    source.path = path.string();
    return loadVolume(source);
}

/// slab.raw: 6 × 5 × 6 bytes whose values differ along x alone; and flat.tf.json, α = 0.3 for all of them, one feature.
void writeSlab(const Workshop& w, const std::string& feature) {
    std::string values;
    for (int i = 0; i < 6 * 5 * 6; ++i) values += static_cast<char>(100 + i % 6);
    w.write("slab.raw", values);
    w.write("flat.tf.json",
            R"({"format":"pellucid-tf","version":1,"range":[0,200],"points":[{"x":0,"opacity":0.3,"color":"#ffffff"},
                {"x":1,"opacity":0.3,"color":"#ffffff"}],"features":[{"name":")" +
                feature + R"(","range":[0,1],"color":"#ffffff"}]})");
}

} // namespace

TEST_CASE("the visibility of a homogeneous slab falls as α(1 − α)^k", "[cli][fields]") {
    const Workshop w;
    // Seen along y: plane k from the eye has v = 0.3 · 0.7^k (docs/method.md, "Visibility").
    writeSlab(w, "all/of: it");
    w.json({"fields", "slab.raw", "--raw", "6,5,6,u8", "--tf", "flat.tf.json", "--view", "0,0", "--orthographic",
            "--engine", "cpu", "--feature", "all", "--out", "f"});
    for (const char* file : {"f/visibility.nrrd", "f/visibility_all_of__it.nrrd"}) {
        const Volume field = readVolume(w.path(file));
        REQUIRE(field.dims() == Int3(6, 5, 6));
        for (int k = 0; k < 5; ++k) // along +y from the front
            for (const int x : {0, 3})
                CHECK(field.value(static_cast<std::size_t>(x + 6 * (k + 5 * 2))) ==
                      Approx(0.3 * std::pow(0.7, k)).margin(1e-4));
    }
}

TEST_CASE("a slice of a field has the field's values through its colour map", "[cli][fields]") {
    const Workshop w;
    // The slab above, across z: pixel (x, y) of 6 × 5 is voxel (x, 4 − y, 2), the eye is at the bottom. v = 0.3·0.7^k.
    writeSlab(w, "all");
    const Words large{"render", "slab.raw",  "--raw",          "6,5,6,u8", "--tf", "flat.tf.json",
                      "--view", "0,0",       "--orthographic", "--engine", "cpu",  "--slice",
                      "z:0.42", "--nearest", "--field-top",    "0.3"};
    const Words slice = large + Words{"--size", "6x5"};
    const auto drawn = [&](const std::string& file, const Words& options) {
        const json answer = w.json(slice + options + Words{"--out", file});
        CHECK(answer["field"]["kind"] == "visibility");
        CHECK(answer["slice"]["axis"] == "z");
        return readImage(w.path(file).string());
    };
    const Image picture = drawn("v.png", {"--field", "visibility"});
    const ColorMap& ember = colorMapNamed("ember");
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 6; ++x) {
            const Rgb expected = ember.colorAt(std::pow(0.7, 4 - y)); // of the top, 0.3
            const float* p = picture.pixel(x, y);
            for (const auto& [is, should] : {std::pair{p[0], expected.r}, {p[1], expected.g}, {p[2], expected.b}})
                CHECK(is == Approx(should).margin(0.02)); // 8 bits, and the map is a line of 33 points
        }
    // Below the threshold there is nothing: 0.7⁴ = 0.24 and 0.7³ = 0.343 lie below 0.35 of the top.
    const Image above = drawn("t.png", {"--field", "visibility", "--field-threshold", "0.35"});
    for (int y = 0; y < 5; ++y) CHECK((above.pixel(2, y)[0] > 0.05f) == (y >= 2));

    // A session that shows a field shows it in slices, too: the same picture.
    w.write("s.pellucid.json", R"({"format":"pellucid-session","version":1,"variables":[{"name":"x","source":
        {"path":"slab.raw","raw":{"dims":[6,5,6],"type":"u8","endian":"little","spacing":[1,1,1],"skip":0}},"transfer_functions":[]}],"field":{"kind":"visibility"}})");
    CHECK(drawn("s.png", {"--session", "s.pellucid.json"}).rgba == picture.rgba);
    const json data = w.json({"render", "--session", "s.pellucid.json", "--tf", "flat.tf.json", "--slice", "z:0.42",
                              "--size", "6x5", "--field", "none", "--window", "100,105", "--out", "d.png"});
    CHECK(data.count("field") == 0);
    // Its legend and title are those of the picture of the field.
    w.json(large + Words{"--size", "300x250", "--field", "visibility", "--out", "plain.png"});
    w.json(large + Words{"--size", "300x250", "--field", "visibility", "--annotate", "legend,title", "--out", "l.png"});
    CHECK(readImage(w.path("plain.png").string()).rgba != readImage(w.path("l.png").string()).rgba);
    for (const auto& [options, says] :
         {std::pair{Words{"--field", "visibility", "--annotate", "cube"}, "--annotate"},
          std::pair{Words{"--field", "none", "--annotate", "legend"}, "--annotate"},
          std::pair{Words{"--session", "s.pellucid.json", "--window", "0,1"}, "--window"}}) {
        const Outcome wrong = w.run(slice + options + Words{"--out", "no.png"});
        CHECK(wrong.status == 2);
        CHECK(wrong.err.find(says) != std::string::npos);
        CHECK_FALSE(w.has("no.png"));
    }
}

TEST_CASE("fields of features are parts of the whole, each in its file", "[cli][fields]") {
    const Workshop w;
    const json written = w.json(Words{"fields"} + kShells + Words{"--feature", "f2", "--feature", "f3", "--out", "d"});
    CHECK(written["files"].size() == 12); // four fields: all, f2, f3
    const Volume all = readVolume(w.path("d/vws.nrrd"));
    const Volume two = readVolume(w.path("d/vws_f2.nrrd")), three = readVolume(w.path("d/vws_f3.nrrd"));
    const json measured = w.json(Words{"measure"} + kShells);
    double sums[2] = {0, 0};
    for (std::size_t i = 0; i < all.size(); ++i) {
        sums[0] += two.value(i);
        sums[1] += three.value(i);
        if (two.value(i) != 0 && (two.value(i) != all.value(i) || three.value(i) != 0)) FAIL("voxel " << i);
    }
    CHECK(sums[0] == Approx(measured["features"][1]["vws"].get<double>()).margin(1e-5));
    CHECK(sums[1] == Approx(measured["features"][2]["vws"].get<double>()).margin(1e-5));

    const json some = w.json(Words{"fields"} + kShells +
                             Words{"--field", "saliency", "--field", "vws", "--feature", "f1", "--out", "e"});
    CHECK(some["files"] == json({"e/saliency.nrrd", "e/vws.nrrd", "e/saliency_f1.nrrd", "e/vws_f1.nrrd"}));
    const Outcome unknown = w.run(Words{"fields"} + kShells + Words{"--feature", "f9", "--out", "g"});
    CHECK(unknown.status == 2);
    CHECK(unknown.err.find("known: 'f1', 'f2', 'f3'") != std::string::npos);
    CHECK_FALSE(w.has("g"));
}

TEST_CASE("render draws a field in the place of the data", "[cli][fields]") {
    const Workshop w;
    const Words picture = Words{"render"} + kShells + Words{"--size", "40x40"};
    const auto drawn = [&](const std::string& file, const Words& options) {
        const json j = w.json(picture + options + Words{"--out", file});
        CHECK(j["size"] == json({40, 40}));
        return std::pair(readImage(w.path(file).string()), j);
    };
    const auto [data, plain] = drawn("data.png", {});
    CHECK(plain.count("field") == 0);
    const auto [vws, j] = drawn("vws.png", {"--field", "vws", "--field-strength", "0.8"});
    CHECK(vws.rgba != data.rgba);
    CHECK(j["field"]["kind"] == "vws");
    CHECK(j["field"]["strength"] == 0.8);
    CHECK(j["field"]["top"].get<double>() <= j["field"]["largest"].get<double>());
    CHECK(j["field"].count("feature") == 0);
    const auto [part, of] = drawn(
        "f2.png", {"--field", "vws", "--feature", "f2", "--field-colormap", "feature", "--field-threshold", "0.1"});
    CHECK(of["field"]["feature"] == "f2");
    CHECK(of["field"]["top"] == j["field"]["top"]); // so that features compare
    CHECK(part.rgba != vws.rgba);
    const auto [legend, unused] =
        drawn("legend.png", {"--field", "vws", "--field-strength", "0.8", "--annotate", "all"});
    CHECK(legend.rgba != vws.rgba);

    // A slice through the saliency: the colours alone.
    const auto [slice, sliced] = drawn("slice.png", {"--field", "saliency-brightness", "--slice", "y:0.5"});
    CHECK(sliced["slice"]["axis"] == "y");
    CHECK(sliced["field"]["kind"] == "saliency-brightness");
    CHECK(slice.rgba != data.rgba);

    // A session that shows a field is drawn so, unless an option wants the data.
    w.write("s.pellucid.json", R"({"format":"pellucid-session","version":1,"variables":[{"name":"x","source":
        {"sample":"shells","size":16,"seed":1},"transfer_functions":[]}],"field":{"kind":"visibility","strength":0.5}})");
    const Words session{"render", "--session", "s.pellucid.json", "--tf", "tents:3:0.2",
                        "--size", "40x40",     "--engine",        "cpu"};
    CHECK(w.json(session + Words{"--out", "s.png"})["field"]["strength"] == 0.5);
    CHECK(w.json(session + Words{"--field", "none", "--out", "t.png"}).count("field") == 0);

    for (const auto& [options, says] :
         {std::pair{Words{"--field", "depth"}, "give visibility, saliency-brightness"},
          std::pair{Words{"--field", "vws", "--field-colormap", "rainbow"}, "--field-colormap"},
          std::pair{Words{"--field", "vws", "--field-strength", "0"}, "--field-strength"},
          std::pair{Words{"--field", "vws", "--mode", "mip"}, "--mode"},
          std::pair{Words{"--field", "vws", "--slice", "x:0.5", "--window", "0,1"}, "--window"}}) {
        const Outcome wrong = w.run(picture + options + Words{"--out", "no.png"});
        CHECK(wrong.status == 2);
        CHECK(wrong.err.find(says) != std::string::npos);
        CHECK_FALSE(w.has("no.png"));
    }
}
