// Every command on small samples: what it prints, what it writes, and that the figures agree with each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/round_numbers.h"
#include "cli_runner.h"
#include "image_io/image_file.h"
#include "render/ssim.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::operator+;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

double sum(const json& numbers) {
    double total = 0;
    for (const json& n : numbers) total += n.get<double>();
    return total;
}

std::vector<double> column(const json& objects, const char* key) {
    std::vector<double> values;
    for (const json& o : objects) values.push_back(o.at(key).get<double>());
    return values;
}

/// No null anywhere: fields that a command does not know are absent.
bool hasNull(const json& j) {
    if (j.is_null()) return true;
    if (!j.is_structured()) return false;
    return std::any_of(j.begin(), j.end(), [](const json& v) { return hasNull(v); });
}

/// Everything but the times.
json withoutSeconds(json j) {
    j.erase("seconds");
    return j;
}

Volume readVolume(const std::filesystem::path& path, int sampleSize = 0) {
    VolumeSource source;
    source.path = path.string();
    source.sampleSize = sampleSize;
    return loadVolume(source);
}

/// A transfer function with keys that Pellucid does not know, on three levels.
const char* const kForeignTf = R"({"format":"pellucid-tf","version":1,"range":[-10,300],"author":"someone",
  "points":[{"x":0.1,"opacity":0,"color":"#ff8800","fixed":true,"note":[1,2]},
            {"x":0.3,"opacity":0.4,"color":"#ff8800"},
            {"x":0.5,"opacity":0,"color":"#ff8800","fixed":true}],
  "features":[{"name":"dentine","range":[0.1,0.5],"color":"#ff8800","id":"D1"}]})";

} // namespace

TEST_CASE("samples lists each built-in volume", "[cli]") {
    const Workshop w;
    const json j = w.json({"samples"});
    CHECK(j["command"] == "samples");
    std::vector<std::string> names;
    for (const json& s : j["samples"]) names.push_back(s["name"]);
    for (const char* name : {"disks", "shells", "knee"}) CHECK(std::count(names.begin(), names.end(), name) == 1);
    const Outcome text = w.run({"samples"});
    CHECK(text.status == 0);
    CHECK(text.out.find("sample:shells") != std::string::npos);
}

TEST_CASE("info tells what a generated file holds", "[cli]") {
    const Workshop w;
    // The knee is 379 x 229 x 305 voxels; 24 along x leave round(229·24/379) = 15 and round(305·24/379) = 19.
    const json made = w.json({"generate", "knee", "--size", "24", "--seed", "3", "--out", "knee.nrrd"});
    CHECK(made["dims"] == json({24, 15, 19}));
    CHECK(w.list() == std::vector<std::string>{"knee.nrrd"});

    const json j = w.json({"info", "knee.nrrd"});
    CHECK(j["command"] == "info");
    CHECK(j["dims"] == json({24, 15, 19}));
    CHECK(j["type"] == "i16");
    CHECK(j["format"] == "NRRD");
    CHECK(j["title"] == "knee.nrrd");
    CHECK(j["invalid"] == 0);
    CHECK(j["memory_bytes"] == 24 * 15 * 19 * 2);
    CHECK(j["notices"].is_array());
    const json direct = w.json({"info", "sample:knee", "--size", "24", "--seed", "3"});
    for (const char* key : {"range", "spacing", "origin"}) {
        INFO(key);
        const auto inFile = j[key].get<std::vector<double>>(), inMemory = direct[key].get<std::vector<double>>();
        REQUIRE(inFile.size() == inMemory.size());
        for (std::size_t i = 0; i < inFile.size(); ++i) CHECK(inFile[i] == Approx(inMemory[i]).epsilon(1e-9));
    }
}

TEST_CASE("a volume opens coarser, or a part of it", "[cli]") {
    const Workshop w;
    w.json({"generate", "knee", "--size", "24", "--out", "knee.nrrd"}); // 24 x 15 x 19
    const json all = w.json({"info", "knee.nrrd"});
    CHECK(all["full_dims"] == all["dims"]);
    CHECK(all["downsample"] == 1);
    const json j = w.json({"info", "knee.nrrd", "--downsample", "3", "--region", "2:14,0:6,3:7"});
    CHECK(j["dims"] == json({4, 2, 2})); // 12, 6 and 4 by 3, rounded up
    CHECK(j["full_dims"] == json({24, 15, 19}));
    CHECK(j["region"] == json({{2, 0, 3}, {14, 6, 7}}));
    CHECK(j["downsample"] == 3);
    CHECK(j["notices"].size() == 2);
    CHECK(w.run({"info", "knee.nrrd", "--region", "2:14,0:6"}).status == 2);
    CHECK(w.run({"info", "knee.nrrd", "--region", "2:14,6:6,0:1"}).status == 2);
    CHECK(w.run({"info", "knee.nrrd", "--region", "2:25,0:6,0:1"}).status == 2);
    CHECK(w.run({"info", "knee.nrrd", "--downsample", "0"}).status == 2);
}

TEST_CASE("info reads headerless data as the options lay it out", "[cli]") {
    const Workshop w;
    // 3 bytes to skip, then the eight u16 0x0100 … 0x0107, big endian, the last one missing.
    std::string bytes("abc");
    for (char i = 0; i < 8; ++i) bytes += std::string{char{1}, i};
    w.write("v.dat", bytes);
    const json j =
        w.json({"info", "v.dat", "--raw", "2,2,2,u16,big", "--skip", "3", "--spacing", "0.5,1,2", "--missing", "263"});
    CHECK(j["type"] == "u16");
    CHECK(j["spacing"] == json({0.5, 1.0, 2.0}));
    CHECK(j["range"] == json({256.0, 262.0}));
    CHECK(j["invalid"] == 1);
    CHECK(j["format"] == "raw");
    CHECK(j["unit"] == "units");
    CHECK(w.json({"info", "v.dat", "--raw", "2,2,2,u16,big", "--skip", "3", "--spacing", "0.5,1,2,um"})["unit"] ==
          "\u00b5m");
    const json windowed = w.json({"info", "v.dat", "--raw", "2,2,2,u16,big", "--skip", "3", "--range", "-5,1000.5"});
    CHECK(windowed["range"] == json({-5.0, 1000.5}));
    CHECK(windowed["data_range"] == json({256.0, 263.0}));
}

TEST_CASE("measure prints figures that agree with each other", "[cli]") {
    const Workshop w;
    const json j = w.json({"measure", "sample:shells", "--size", "24", "--tf", "tents:3", "--engine", "cpu"});
    CHECK(j["command"] == "measure");
    CHECK(j["engine"] == "cpu");
    CHECK(j["volume"]["dims"] == json({24, 24, 24}));
    CHECK_FALSE(hasNull(j));

    const json& features = j["features"];
    REQUIRE(features.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const json& f = features[i];
        CHECK(f["name"] == "f" + std::to_string(i + 1));
        // tents n: centre (i + ½)/n, bottoms 0.4/n to both sides, peak ½ (docs/method.md, "Transfer function")
        const double center = (static_cast<double>(i) + 0.5) / 3;
        CHECK(f["range"][0].get<double>() == Approx(center - 0.4 / 3));
        CHECK(f["range"][1].get<double>() == Approx(center + 0.4 / 3));
        CHECK(f["opacity"].get<double>() == Approx(0.5));
        CHECK(f["vws"].get<double>() ==
              Approx(0.5 * f["vws_brightness"].get<double>() + 0.5 * f["vws_saturation"].get<double>()));
    }
    // α is 0 outside the tents, so that their voxels have all the visibility.
    for (const char* key : {"visibility", "vws", "vws_brightness", "vws_saturation"}) {
        INFO(key);
        const auto values = column(features, key);
        for (const double v : values) CHECK((v > 0 && v < 1));
        CHECK(std::accumulate(values.begin(), values.end(), 0.0) == Approx(1.0).epsilon(1e-9));
    }
    const json& histogram = j["visibility_histogram"];
    REQUIRE(histogram.size() == 256);
    CHECK(sum(histogram) == Approx(1.0).epsilon(1e-9));
    // The bins inside a gap between tents hold nothing: (0.3, 0.3667) is bins 77 … 92.
    for (std::size_t bin = 77; bin <= 92; ++bin) CHECK(histogram[bin].get<double>() == 0.0);
    for (const char* key : {"visibility", "saliency", "total"}) CHECK(j["seconds"][key].get<double>() >= 0);

    const Outcome text = w.run({"measure", "sample:shells", "--size", "24", "--tf", "tents:3", "--engine", "cpu"});
    CHECK(text.status == 0);
    CHECK(text.err.empty());
    for (const char* word : {"f1", "f2", "f3", "VWS", "engine cpu"}) CHECK(text.out.find(word) != std::string::npos);
}

TEST_CASE("measure draws its figures as bar charts", "[cli]") {
    const Workshop w;
    const json j = w.json({"measure", "sample:shells", "--size", "24", "--tf", "tents:2", "--bars", "b.svg"});
    CHECK(j["bars"] == "b.svg");
    const std::string svg = w.read("b.svg");
    for (const json& feature : j["features"]) {
        CHECK(svg.find(">" + feature["name"].get<std::string>() + "</text>") != std::string::npos);
        for (const char* key : {"visibility", "vws", "vws_brightness", "vws_saturation"}) {
            INFO(feature["name"] << " " << key);
            CHECK(svg.find(">" + fixedText(feature[key], 4) + "</text>") != std::string::npos);
        }
    }
    // tents:2 have the hues of 90 and 270 degrees.
    CHECK(svg.find("fill=\"#80ff00\"") != std::string::npos);
    CHECK(svg.find("fill=\"#8000ff\"") != std::string::npos);
    CHECK(svg.find("2D feature saliency") == std::string::npos);

    const Outcome pictured = w.run({"measure", "sample:shells", "--sample-size", "16", "--tf", "tents:2", "--2dfs",
                                    "--size", "32x32", "--bars", "b.svg"});
    CHECK(pictured.status == 0);
    CHECK(pictured.out.find("wrote b.svg\n") != std::string::npos);
    CHECK(w.read("b.svg").find("2D feature saliency") != std::string::npos);
    const Outcome wrong = w.run({"measure", "sample:shells", "--bars", "b.csv"});
    CHECK(wrong.status == 2);
    CHECK(wrong.err.find("bars are written as .svg or .png, b.csv") != std::string::npos);
}

TEST_CASE("measure prints how each VWS changes with each opacity", "[cli]") {
    const Workshop w;
    const auto measured = [&](std::vector<double> peaks) {
        // tents:3 with a peak of its own for each
        json tf{{"format", "pellucid-tf"}, {"version", 1}};
        const std::array colors{"#ff0000", "#00ff00", "#0000ff"};
        for (std::size_t i = 0; i < 3; ++i) {
            const double centre = (static_cast<double>(i) + 0.5) / 3;
            for (const double side : {-1.0, 0.0, 1.0})
                tf["points"].push_back({{"x", centre + side * 0.4 / 3},
                                        {"opacity", side == 0 ? peaks[i] : 0.0},
                                        {"color", colors[i]},
                                        {"fixed", side != 0}});
        }
        w.write("t.tf.json", tf.dump());
        return w.json(
            {"measure", "sample:shells", "--size", "24", "--tf", "t.tf.json", "--engine", "cpu", "--jacobian"});
    };
    const std::vector<double> peaks{0.05, 0.1, 0.2};
    const json j = measured(peaks);
    const auto jacobian = j["jacobian"].get<std::vector<std::vector<double>>>();
    REQUIRE(jacobian.size() == 3);
    CHECK(j["seconds"]["jacobian"].get<double>() >= 0);
    for (std::size_t x = 0; x < 3; ++x) {
        // Central differences; the third derivatives that they neglect are of the order of h² = 1 % of 1/x² here.
        constexpr double kShare = 0.1;
        auto more = peaks, less = peaks;
        more[x] += kShare * peaks[x];
        less[x] -= kShare * peaks[x];
        const auto up = column(measured(more)["features"], "vws"), down = column(measured(less)["features"], "vws");
        double total = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            INFO("dW" << i << "/dx" << x);
            REQUIRE(jacobian[i].size() == 3);
            CHECK(jacobian[i][x] * peaks[x] == Approx((up[i] - down[i]) / (2 * kShare)).margin(0.002).epsilon(0.02));
            total += jacobian[i][x];
        }
        // All shares sum to 1 whatever the opacities: the three tents hold everything that is visible.
        CHECK(total == Approx(0).margin(1e-4));
    }
    CHECK_FALSE(w.json({"measure", "sample:shells", "--size", "16", "--engine", "cpu"}).contains("jacobian"));
    const Outcome text = w.run({"measure", "sample:shells", "--size", "16", "--engine", "cpu", "--jacobian"});
    CHECK(text.out.find("dVWS / dopacity of") != std::string::npos);
}

TEST_CASE("the saliency options change the saliency and nothing else", "[cli]") {
    const Workshop w;
    const auto measured = [&](std::vector<std::string> options) {
        std::vector<std::string> arguments{"measure", "sample:shells", "--size",   "16",
                                           "--tf",    "tents:3",       "--engine", "cpu"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return w.json(arguments)["features"];
    };
    const json plain = measured({});
    const std::vector<std::vector<std::string>> changes{
        {"--sigma", "3"}, {"--kernel", "narrow"}, {"--w2", "0.5"}, {"--saliency-background", "1,1,1"}};
    for (const auto& change : changes) {
        INFO(change[0]);
        const json other = measured(change);
        CHECK(column(other, "visibility") == column(plain, "visibility"));
        CHECK(column(other, "vws_brightness") != column(plain, "vws_brightness"));
    }
    // W = u1·W(brightness) + u2·W(saturation); one share alone determines the other.
    CHECK(column(measured({"--u1", "1"}), "vws") == column(plain, "vws_brightness"));
    CHECK(column(measured({"--u2", "1"}), "vws") == column(plain, "vws_saturation"));
    CHECK(column(measured({"--sigma", "2", "--kernel", "thesis", "--w1", "1", "--w2", "1", "--u1", "0.5", "--u2", "0.5",
                           "--saliency-background", "#000000"}),
                 "vws") == column(plain, "vws"));
}

TEST_CASE("the view decides which disk hides the others", "[cli]") {
    const Workshop w;
    // Three disks one behind the other along x (thesis fig. 4.5, 4.6): azimuth −90 puts the eye at −x, +90 at +x.
    const auto visibility = [&](const std::string& view) {
        return column(w.json({"measure", "sample:disks", "--tf", "tents:3:0.6", "--size", "24", "--view", view,
                              "--orthographic", "--engine", "cpu"})["features"],
                      "visibility");
    };
    const auto fromLeft = visibility("-90,0"), fromRight = visibility("90,0");
    REQUIRE(fromLeft.size() == 3);
    CHECK(fromLeft[0] > fromLeft[1]);
    CHECK(fromLeft[1] > fromLeft[2]);
    CHECK(fromRight[2] > fromRight[1]);
    CHECK(fromRight[1] > fromRight[0]);
}

TEST_CASE("a camera file and the view that it describes give the same figures", "[cli]") {
    const Workshop w;
    // View 0,0 orthographic looks along +y at the middle of the box, which is (7.5, 7.5, 7.5) for 16 voxels of spacing
    // 1; without perspective the distance and the image's height do not matter to the measures.
    w.write("front.camera.json",
            R"({"projection":"orthographic","eye":[7.5,-100,7.5],"center":[7.5,7.5,7.5],"up":[0,0,1],"height":30})");
    const std::vector<std::string> base{"measure", "sample:shells", "--size", "16", "--engine", "cpu"};
    auto byFile = base, byView = base;
    byFile.insert(byFile.end(), {"--camera", "front.camera.json"});
    byView.insert(byView.end(), {"--view", "0,0", "--orthographic"});
    const auto a = column(w.json(byFile)["features"], "vws"), b = column(w.json(byView)["features"], "vws");
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).margin(1e-6));
}

TEST_CASE("the reference engine and high quality measure the same within the tolerances", "[cli]") {
    const Workshop w;
    const auto vws = [&](const std::string& engine, const std::string& quality) {
        const json j = w.json({"measure", "sample:shells", "--size", "12", "--engine", engine, "--quality", quality});
        CHECK(j["engine"] == engine);
        return column(j["features"], "vws");
    };
    const auto reference = vws("reference", "normal"), normal = vws("cpu", "normal"), high = vws("cpu", "high");
    for (std::size_t i = 0; i < reference.size(); ++i) {
        CHECK(normal[i] == Approx(reference[i]).margin(0.01)); // docs/method.md, "Tolerances"
        CHECK(high[i] == Approx(reference[i]).margin(0.005));
    }
}

TEST_CASE("the OpenGL engine measures and draws as the cpu does, or says that there is none", "[cli][gl]") {
    const Workshop w;
    const std::vector<std::string> measure{"measure", "sample:shells", "--size", "24", "--json", "--engine"};
    const auto by = [&](const std::string& engine) {
        auto arguments = measure;
        arguments.push_back(engine);
        return w.run(arguments);
    };
    const Outcome gl = by("gl");
    if (gl.status != 0) {
        CHECK(gl.status == 1);
        CHECK(gl.out.empty());
        CHECK(gl.err.rfind("pellucid-cli: error: ", 0) == 0);
        CHECK(std::count(gl.err.begin(), gl.err.end(), '\n') == 1);
        CHECK(json::parse(by("auto").out)["engine"] == "cpu");
        return;
    }
    const json byGl = json::parse(gl.out), byCpu = json::parse(by("cpu").out);
    CHECK(byGl["engine"] == "gl");
    CHECK(byCpu["engine"] == "cpu");
    for (const char* key : {"visibility", "vws"}) {
        const auto a = column(byGl["features"], key), b = column(byCpu["features"], key);
        REQUIRE(a.size() == b.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            CHECK(a[i] == Approx(b[i]).margin(0.01)); // docs/method.md, "Tolerances"
    }
    for (const std::string engine : {"gl", "cpu"})
        CHECK(w.json({"render", "sample:shells", "--sample-size", "24", "--size", "64x64", "--engine", engine, "--out",
                      engine + ".exr"})["engine"] == engine);
    // Two ways to integrate the same rays: close everywhere, closer on average.
    const Image a = readImage(w.path("gl.exr").string()), b = readImage(w.path("cpu.exr").string());
    REQUIRE(a.rgba.size() == b.rgba.size());
    double total = 0, most = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double difference = std::abs(a.rgba[i] - b.rgba[i]);
        total += difference;
        most = std::max(most, difference);
    }
    CHECK(most < 0.1);
    CHECK(total / static_cast<double>(a.rgba.size()) < 0.005);
}

TEST_CASE("fields writes volumes whose sums are the measures", "[cli]") {
    const Workshop w;
    const std::vector<std::string> input{"sample:shells", "--size", "16", "--tf", "tents:3", "--engine", "cpu"};
    std::vector<std::string> fields{"fields"}, measure{"measure"};
    fields.insert(fields.end(), input.begin(), input.end());
    measure.insert(measure.end(), input.begin(), input.end());
    fields.insert(fields.end(), {"--out", "fields"});
    const json written = w.json(fields);
    CHECK(written["command"] == "fields");
    CHECK(written["files"].size() == 4);
    const json measured = w.json(measure);

    const Volume volume = readVolume("sample:shells", 16);
    const Volume visibility = readVolume(w.path("fields/visibility.nrrd"));
    const Volume brightness = readVolume(w.path("fields/saliency_brightness.nrrd"));
    const Volume saturation = readVolume(w.path("fields/saliency_saturation.nrrd"));
    const Volume vws = readVolume(w.path("fields/vws.nrrd"));
    for (const Volume* field : {&visibility, &brightness, &saturation, &vws}) {
        CHECK(field->dims() == volume.dims());
        CHECK(field->sampleType() == SampleType::F32);
        CHECK(field->geometry().spacing == volume.geometry().spacing);
    }

    struct Sums {
        double visibility = 0, brightness = 0, saturation = 0, vws = 0;
    };
    std::array<Sums, 3> features;
    Sums all;
    for (std::size_t i = 0; i < volume.size(); ++i) {
        const double v = visibility.value(i);
        const Sums voxel{v, v * brightness.value(i), v * saturation.value(i), vws.value(i)};
        const auto add = [&](Sums& s) {
            s.visibility += voxel.visibility;
            s.brightness += voxel.brightness;
            s.saturation += voxel.saturation;
            s.vws += voxel.vws;
        };
        add(all);
        for (std::size_t f = 0; f < 3; ++f) {
            const json& range = measured["features"][f]["range"];
            const double s = volume.intensity(i);
            if (s >= range[0].get<double>() && s < range[1].get<double>()) add(features[f]);
        }
    }
    CHECK(all.vws == Approx(1.0).epsilon(1e-5));
    for (std::size_t f = 0; f < 3; ++f) {
        const json& m = measured["features"][f];
        CHECK(features[f].visibility / all.visibility == Approx(m["visibility"].get<double>()).margin(1e-5));
        CHECK(features[f].brightness / all.brightness == Approx(m["vws_brightness"].get<double>()).margin(1e-5));
        CHECK(features[f].saturation / all.saturation == Approx(m["vws_saturation"].get<double>()).margin(1e-5));
        CHECK(features[f].vws == Approx(m["vws"].get<double>()).margin(1e-5));
    }
}

TEST_CASE("render --preview writes the quick picture and says in which order it was drawn", "[cli]") {
    const Workshop w;
    const Words base{"render", "sample:shells", "--sample-size", "24", "--size", "64x48", "--tf", "tents:3:0.25"};
    const auto rendered = [&](const std::string& file, const Words& options) {
        return w.json(base + options + Words{"--out", file});
    };
    const json quick = rendered("quick.png", {"--preview"});
    CHECK(quick["preview"] == "slices");
    CHECK(quick["engine"] == "cpu");
    CHECK_FALSE(rendered("full.png", {"--engine", "cpu"}).contains("preview"));
    CHECK(ssim(readImage(w.path("quick.png").string()), readImage(w.path("full.png").string())) > 0.97);
    CHECK(rendered("mip.png", {"--preview", "--mode", "mip"})["preview"] == "rays");

    for (const Words& wrong : {Words{"--slice", "z:0.5"}, Words{"--engine", "gl"}}) {
        const Outcome refused = w.run(base + wrong + Words{"--preview", "--out", "none.png"});
        CHECK(refused.status == 2);
        CHECK(refused.err.find("--preview") != std::string::npos);
    }
    CHECK_FALSE(w.has("none.png"));
}

TEST_CASE("render writes a picture of the asked size over the asked background", "[cli]") {
    const Workshop w;
    const std::vector<std::string> base{"render", "sample:shells", "--tf", "tents:3:0.25", "--sample-size",
                                        "24",     "--engine",      "cpu",  "--size",       "64x48"};
    const auto rendered = [&](const std::string& file, std::vector<std::string> options) {
        std::vector<std::string> arguments = base;
        arguments.insert(arguments.end(), options.begin(), options.end());
        arguments.insert(arguments.end(), {"--out", file});
        const json j = w.json(arguments);
        CHECK(j["command"] == "render");
        CHECK(j["size"] == json({64, 48}));
        return readImage(w.path(file).string());
    };
    // 8 bits in a PNG
    const double rounding = 0.5 / 255 + 1e-6;
    const Image colored = rendered("a.png", {"--background", "0.2,0.4,0.6"});
    REQUIRE(colored.width == 64);
    REQUIRE(colored.height == 48);
    // zoom 1 fits the box's sphere into the picture: the corner sees none of it, the middle the volume.
    const float* corner = colored.pixel(0, 0);
    CHECK(corner[0] == Approx(0.2).margin(rounding));
    CHECK(corner[1] == Approx(0.4).margin(rounding));
    CHECK(corner[2] == Approx(0.6).margin(rounding));
    CHECK(corner[3] == Approx(1.0));
    const float* middle = colored.pixel(32, 24);
    CHECK(std::abs(middle[0] - 0.2) + std::abs(middle[1] - 0.4) + std::abs(middle[2] - 0.6) > 0.05);

    const Image transparent = rendered("b.tif", {"--background", "transparent"});
    CHECK(transparent.pixel(0, 0)[3] == Approx(0.0));
    CHECK(transparent.pixel(32, 24)[3] > 0.05);

    const Image plain = rendered("c.png", {});
    CHECK(plain.pixel(0, 0)[0] == Approx(0.0));
    const std::vector<std::vector<std::string>> changes{
        {"--shading"},       {"--clip", "y:0.5:1"}, {"--clip", "x:0:0.5", "z:0:0.6"},
        {"--feature", "f3"}, {"--view", "30,20,2"}, {"--orthographic"}};
    for (const auto& change : changes) {
        INFO(change[0] << " " << change.back());
        CHECK(rendered("d.png", change).rgba != plain.rgba);
    }
    // Steps are small against the volume's detail: another one changes little, but something.
    const Image fine = rendered("e.exr", {"--step", "0.1"}), half = rendered("g.exr", {"--step", "0.5"}),
                high = rendered("f.exr", {"--quality", "high", "--finest-step", "0.5"}),
                quarter = rendered("h.exr", {"--step", "0.25"}), normal = rendered("i.exr", {}),
                same = rendered("j.exr", {"--step", "0.5", "--finest-step", "0.0625"});
    CHECK(high.rgba == quarter.rgba);
    CHECK(high.rgba != half.rgba);
    CHECK(rendered("k.exr", {"--finest-step", "0.5"}).rgba == half.rgba);
    // By themselves steps are halved where that matters; one that is given is kept unless the finest is given, too.
    CHECK(normal.rgba == same.rgba);
    CHECK(normal.rgba != half.rgba);
    for (std::size_t i = 0; i < fine.rgba.size(); ++i) REQUIRE(std::abs(fine.rgba[i] - normal.rgba[i]) < 0.05f);
}

TEST_CASE("a list of clips ends where the volume's name begins", "[cli]") {
    const Workshop w;
    const std::vector<std::string> tail{"--sample-size", "16", "--size", "32x32", "--engine", "cpu"};
    const auto rendered = [&](std::vector<std::string> arguments, const std::string& file) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), tail.begin(), tail.end());
        arguments.insert(arguments.end(), {"--out", file});
        w.json(arguments);
        return readImage(w.path(file).string()).rgba;
    };
    const auto asList = rendered({"--clip", "x:0:0.5", "y:0:0.5", "sample:shells"}, "a.png");
    CHECK(asList == rendered({"sample:shells", "--clip", "y:0:0.5", "--clip", "x:0:0.5"}, "b.png"));
    CHECK(asList != rendered({"sample:shells", "--clip", "y:0:0.5"}, "c.png"));
}

TEST_CASE("refine lowers the energy and tells the edges it is made of", "[cli]") {
    const Workshop w;
    const json j =
        w.json({"refine", "sample:shells", "--size", "24", "--tf", "tents:3", "--out-tf", "refined.tf.json"});
    CHECK(j["command"] == "refine");
    CHECK_FALSE(hasNull(j));
    // Nine control points and the two added ends: ten edges.
    REQUIRE(j["edges_before"].size() == 10);
    REQUIRE(j["edges_after"].size() == 10);
    const auto energy = [](const json& edges) {
        const double mean = sum(edges) / static_cast<double>(edges.size());
        double total = 0;
        for (const json& e : edges) total += std::pow(e.get<double>() - mean, 2);
        return total;
    };
    CHECK(j["energy_before"].get<double>() == Approx(energy(j["edges_before"])));
    CHECK(j["energy_after"].get<double>() == Approx(energy(j["edges_after"])));
    CHECK(j["energy_movable_after"].get<double>() < j["energy_movable_before"].get<double>());
    CHECK(j["iterations"].get<int>() > 0);
    CHECK(json::parse(w.read("refined.tf.json")) == j["tf"]);
    CHECK(j["tf"]["range"] == json({0.0, 255.0}));

    CHECK(w.json({"refine", "sample:shells", "--size", "24", "--max-iterations", "3"})["iterations"] == 3);
    const auto refined = [&](std::vector<std::string> options) {
        options.insert(options.begin(),
                       {"refine", "sample:shells", "--size", "24", "--tf", "tents:3", "--max-iterations", "1"});
        return w.json(options)["tf"]["points"];
    };
    // One iteration moves two opacities at most, by the steps: peaks are points 1, 4, 7 and start at ½.
    const auto moves = [](const json& points) {
        std::vector<double> m;
        for (const std::size_t peak : {1, 4, 7}) m.push_back(points[peak]["opacity"].get<double>() - 0.5);
        std::sort(m.begin(), m.end());
        return m;
    };
    CHECK(moves(refined({"--step-down", "0.125", "--step-up", "0.25"})) == std::vector<double>{-0.125, 0.0, 0.25});
    CHECK(moves(refined({"--step-down", "0.125", "--step-up", "auto"}))[0] == -0.125);
}

TEST_CASE("refine says what it was asked for, how the methods compare, and what it did", "[cli]") {
    const Workshop w;
    const Words base{"refine", "sample:shells", "--sample-size", "24", "--tf", "tents:3"};
    const json plain = w.json(base);
    CHECK(plain["method"] == "greedy");
    CHECK(plain["priority"] == json{{"kind", "none"}});
    for (const json& d : plain["factors"]) CHECK(d == 1.0);
    CHECK(plain["energy_curve"][0] == plain["energy_movable_before"]);
    CHECK(plain["energy_curve"].size() == plain["iterations"].get<std::size_t>() + 1);
    const json& both = plain["comparison"];
    CHECK(both["greedy"] == plain["energy_movable_after"]);
    CHECK(both["exact"].get<double>() <= both["greedy"].get<double>());
    double total = 0; // of the peaks, which are movable
    for (const std::size_t peak : {1, 4, 7}) total += plain["tf"]["points"][peak]["opacity"].get<double>();
    CHECK(both["total_opacity"].get<double>() == Approx(total));
    REQUIRE(plain["changes"].size() == 3);
    for (std::size_t f = 0; f < 3; ++f) { // the mean over a tent is half its peak
        CHECK(plain["changes"][f]["before"].get<double>() == Approx(0.25));
        CHECK(plain["changes"][f]["after"].get<double>() ==
              Approx(plain["tf"]["points"][3 * f + 1]["opacity"].get<double>() / 2));
    }
    const std::string text = w.run(base).out;
    CHECK(text.find(plain["text"].get<std::string>()) != std::string::npos);

    const json exact = w.json(base + Words{"--method", "exact"});
    CHECK(exact["method"] == "exact");
    double kept = 0;
    for (const std::size_t peak : {1, 4, 7}) kept += exact["tf"]["points"][peak]["opacity"].get<double>();
    CHECK(kept == Approx(1.5)); // as in the start
}

TEST_CASE("refine prioritizes an intensity, a hue, or what a region shows", "[cli]") {
    const Workshop w;
    const Words base{"refine", "sample:shells", "--sample-size", "24", "--tf", "tents:3"};
    // tents:3: peaks at 1/6, ½, 5/6 of hues 60, 180, 300; with the added ends eleven points.
    const json byIntensity = w.json(base + Words{"--intensity", "0.5"}), byHue = w.json(base + Words{"--hue", "180"});
    CHECK(byIntensity["priority"]["kind"] == "intensity");
    CHECK(byIntensity["factors"][5] == 0.0);
    CHECK(byIntensity["factors"][0] == 0.5);
    CHECK(byHue["priority"]["hue"] == 180.0);
    CHECK(byHue["priority"]["intensity"] == 0.5);
    CHECK(byHue["tf"] == byIntensity["tf"]);
    const auto share = [](const json& answer, std::size_t peak) {
        double all = 0;
        for (const std::size_t i : {1, 4, 7}) all += answer["tf"]["points"][i]["opacity"].get<double>();
        return answer["tf"]["points"][peak]["opacity"].get<double>() / all;
    };
    CHECK(share(byIntensity, 4) > share(w.json(base), 4));

    // The middle of the picture shows the outer shell; on a cut through the middle it shows what is innermost.
    const Words view{"--view", "0,0", "--size", "60x60", "--region", "28,28,32,32"};
    const auto nearest = [](const json& answer) { // index of the tent that is nearest to the region
        std::size_t best = 1;
        for (const std::size_t peak : {4, 7})
            if (answer["factors"][peak + 1] < answer["factors"][best + 1]) best = peak;
        return best;
    };
    const json outside = w.json(base + view), cut = w.json(base + view + Words{"--clip", "y:0.5:1"});
    CHECK(outside["priority"]["kind"] == "region");
    CHECK(outside["priority"]["pixels"] == 16);
    CHECK(outside["priority"]["size"] == json({60, 60}));
    CHECK(nearest(outside) != nearest(cut));
    CHECK(outside["tf"] != cut["tf"]);
    double sum = 0; // W_R is normalised over the nine points of the user
    for (std::size_t i = 1; i <= 9; ++i) sum += cut["factors"][i].get<double>();
    CHECK(sum == Approx(1));
    // Three intervals are voxels of the data, as in all commands.
    const Outcome part =
        w.run({"refine", "sample:shells", "--size", "24", "--tf", "tents:3", "--region", "0:12,0:24,0:24", "--json"});
    CHECK(part.err.find("12 x 24 x 24") != std::string::npos);
    const json halved = json::parse(part.out);
    CHECK(halved["edges_before"] != w.json(base)["edges_before"]);
    CHECK(halved["priority"]["kind"] == "none");
}

TEST_CASE("refine leaves fixed control points alone", "[cli]") {
    const Workshop w;
    // The peaks are at 1/6, 1/2, 5/6; a rounded number finds them.
    const json points = w.json(
        {"refine", "sample:shells", "--size", "24", "--tf", "tents:3", "--fix", "0.1667", "0.5"})["tf"]["points"];
    for (const std::size_t peak : {1, 4}) {
        CHECK(points[peak]["opacity"].get<double>() == 0.5);
        CHECK(points[peak]["fixed"] == true);
    }
    CHECK(points[7]["fixed"] == false);
}

TEST_CASE("optimize reaches the targets and tells the way there", "[cli]") {
    const Workshop w;
    const std::vector<std::string> base{
        "optimize", "sample:shells", "--size",   "24",    "--tf",          "tents:3:0.1",
        "--engine", "cpu",           "--target", "1,3,6", "--exact-shares"}; // these shares take a faint picture
    for (const std::string method : {"newton", "parallel", "line"}) {
        INFO(method);
        auto arguments = base;
        arguments.insert(arguments.end(), {"--method", method, "--out-tf", method + ".tf.json", "--require-converged"});
        const json j = w.json(arguments);
        CHECK(j["command"] == "optimize");
        CHECK(j["method"] == method);
        CHECK(j["direction"] == "gradient");
        CHECK(j["converged"] == true);
        CHECK_FALSE(hasNull(j));
        const auto target = j["target"].get<std::vector<double>>();
        REQUIRE(target.size() == 3);
        CHECK(target[0] == Approx(0.1));
        CHECK(target[2] == Approx(0.6));

        const std::size_t states = j["objective"].size();
        CHECK(j["iterations"].get<std::size_t>() + j["coarse_iterations"].get<std::size_t>() +
                  j["later_steps"].get<std::size_t>() ==
              states - 1);
        REQUIRE(j["vws"].size() == states);
        REQUIRE(j["opacity"].size() == states);
        CHECK(j["opacity"][0] == json({0.1, 0.1, 0.1}));
        CHECK(j["evaluations"].get<std::size_t>() >= states);
        for (std::size_t i = 0; i < states; ++i) {
            double squares = 0; // F = sqrt(Σ (W − t)² / n)
            for (std::size_t f = 0; f < 3; ++f) squares += std::pow(j["vws"][i][f].get<double>() - target[f], 2);
            CHECK(j["objective"][i].get<double>() == Approx(std::sqrt(squares / 3)).margin(1e-9));
        }
        CHECK(j["objective"].back().get<double>() < 0.03);
        // The peaks of the answer are the opacities of its last state, and measuring it finds the last VWS again.
        for (std::size_t f = 0; f < 3; ++f)
            CHECK(j["tf"]["points"][3 * f + 1]["opacity"].get<double>() ==
                  Approx(j["opacity"].back()[f].get<double>()));
        CHECK(json::parse(w.read(method + ".tf.json")) == j["tf"]);
        const json again =
            w.json({"measure", "sample:shells", "--size", "24", "--tf", method + ".tf.json", "--engine", "cpu"});
        for (std::size_t f = 0; f < 3; ++f)
            CHECK(again["features"][f]["vws"].get<double>() == Approx(j["vws"].back()[f].get<double>()).margin(1e-3));
    }
    // What is locked stays, what is limited stays within; the others do what they can.
    auto limited = base;
    limited.insert(limited.end(), {"--lock", "f1", "--limits", "f3:0.2:0.3", "--direction", "exact", "--b", "2",
                                   "--no-coarse", "--no-restarts"});
    const json held = w.json(limited);
    CHECK(held["direction"] == "exact");
    for (const json& opacity : held["opacity"]) {
        CHECK(opacity[0] == 0.1);
        CHECK(opacity[2].get<double>() >= 0.2); // the start, 0.1, is taken there
        CHECK(opacity[2].get<double>() <= 0.3);
    }
    const Outcome text = w.run(base);
    CHECK(text.status == 0);
    CHECK(text.out.find("converged") != std::string::npos);
}

TEST_CASE("the fixed step moves each opacity by 0.05 times twice the distance to its target", "[cli]") {
    const Workshop w;
    const json j =
        w.json({"optimize", "sample:shells", "--size", "24", "--tf", "tents:3", "--engine", "cpu", "--target", "1,3,6",
                "--method", "fixed", "--max-iterations", "1", "--direction", "gradient"});
    CHECK(j["iterations"] == 1);
    CHECK(j["converged"] == false);
    for (std::size_t f = 0; f < 3; ++f) {
        const double distance = j["vws"][0][f].get<double>() - j["target"][f].get<double>();
        CHECK(j["opacity"][1][f].get<double>() == Approx(0.5 - 0.05 * 2 * distance));
    }
    // --normalize takes a step of length --step.
    const json n =
        w.json({"optimize", "sample:shells", "--size", "24", "--tf", "tents:3", "--engine", "cpu", "--target", "1,3,6",
                "--method", "fixed", "--max-iterations", "1", "--normalize", "--step", "0.02"});
    double length = 0;
    for (std::size_t f = 0; f < 3; ++f) length += std::pow(n["opacity"][1][f].get<double>() - 0.5, 2);
    CHECK(std::sqrt(length) == Approx(0.02));
}

TEST_CASE("optimize keeps the coverage or goes to the one that is asked for, measure tells it again", "[cli]") {
    const Workshop w;
    const std::vector<std::string> base{"optimize", "sample:shells", "--size",   "24",    "--tf",     "tents:3:0.1",
                                        "--engine", "cpu",           "--target", "1,3,6", "--out-tf", "a.tf.json"};
    const auto stateOf = [](const json& j) { return j["best"].get<std::size_t>(); };
    for (const double wanted : {0.4, 0.25}) {
        auto arguments = base;
        arguments[9] = "6,3,1"; // the other way round less of the picture can be covered
        arguments.insert(arguments.end(), {"--coverage", std::to_string(wanted)});
        const json j = w.json(arguments);
        CHECK(j["objective"][stateOf(j)].get<double>() < 0.001);
        CHECK(j["coverage"].get<double>() == Approx(wanted).epsilon(0.11));
        const json again = w.json({"measure", "sample:shells", "--size", "24", "--tf", "a.tf.json", "--engine", "cpu"});
        CHECK(again["coverage"].get<double>() == Approx(j["coverage"].get<double>()).margin(1e-6));
        for (std::size_t f = 0; f < 3; ++f)
            CHECK(again["features"][f]["cover"].get<double>() == Approx(j["covers"][f].get<double>()).margin(1e-6));
    }
    // 0.002 of the attention for a shell that hides the core: not without the picture's vanishing, unless it is asked
    // for.
    auto hidden = base;
    hidden[9] = "1,1,2000";
    const json kept = w.json(hidden);
    CHECK(kept["coverage"].get<double>() >= 0.199);
    for (const json& cover : kept["covers"]) CHECK(cover.get<double>() >= 0.0199);
    REQUIRE(kept.contains("exact"));
    hidden.push_back("--exact-shares");
    const json exact = w.json(hidden);
    CHECK(exact["objective"][stateOf(exact)].get<double>() <= kept["objective"][stateOf(kept)].get<double>());
    CHECK(exact.contains("faint"));
}

TEST_CASE("a feature without a voxel is said to be empty and has no target", "[cli]") {
    const Workshop w;
    // Two nested cubes of 40 and 210 in 0: of quarters of 0 … 255 the second and the third are empty.
    std::string bytes;
    for (int k = 0; k < 12; ++k)
        for (int j = 0; j < 12; ++j)
            for (int i = 0; i < 12; ++i) {
                const int depth = std::min({i, j, k, 11 - i, 11 - j, 11 - k});
                bytes += static_cast<char>(depth < 1 ? 0 : depth < 4 ? 40 : 210);
            }
    w.write("v.raw", bytes);
    const Words about{"v.raw", "--raw", "12,12,12,u8", "--range", "0,255", "--tf", "tents:4:0.3", "--engine", "cpu"};
    const auto names = [&] {
        std::vector<std::string> all;
        const json measured = w.json(Words{"measure"} + about);
        for (const json& f : measured["features"]) all.push_back(f["name"]);
        return all;
    }();
    REQUIRE(names.size() == 4);
    const std::string empty = names[1] + " (empty)";

    SECTION("measure and probe list it as empty") {
        const json measured = w.json(Words{"measure"} + about);
        for (std::size_t f = 0; f < 4; ++f) CHECK(measured["features"][f]["empty"] == (f == 1 || f == 2));
        CHECK(w.run(Words{"measure"} + about).out.find(empty) != std::string::npos);
        CHECK(w.run(Words{"probe"} + Words(about.begin(), about.end() - 2) + Words{"9,9", "--size", "20x20"})
                  .out.find(empty) != std::string::npos);
    }
    SECTION("words skip it") {
        const json j = w.json(Words{"optimize"} + about + Words{"--target", "equal", "--exact-shares"});
        CHECK(j["target"] == json({0.5, 0, 0, 0.5}));
        CHECK(j["empty"] == json({false, true, true, false}));
        CHECK(j["converged"] == true);
        CHECK_FALSE(j.contains("verdict"));
        if (j.contains("faint"))
            for (const json& f : j["faint"]["features"]) CHECK((f != 1 && f != 2));
        const Outcome only = w.run(Words{"optimize"} + about + Words{"--target", "only:" + names[2]});
        CHECK(only.status == 2);
        CHECK(only.err.find("is empty: no voxel has its values") != std::string::npos);
    }
    SECTION("a number for it is answered with a sentence, and counts as 0") {
        for (const char* command : {"optimize", "space", "views"}) {
            INFO(command);
            const Words more = command == std::string("space")   ? Words{"--samples", "3"}
                               : command == std::string("views") ? Words{"--count", "20"}
                                                                 : Words{};
            const Outcome r = w.run(Words{command} + about + Words{"--target", "1,2,0,3", "--json"} + more);
            REQUIRE(r.status == 0);
            CHECK(r.err.find("'" + names[1] + "' has no voxel: its target counts as 0") != std::string::npos);
            CHECK(json::parse(r.out)["target"] == json({0.25, 0, 0, 0.75}));
        }
        const Outcome none = w.run(Words{"optimize"} + about + Words{"--target", "1,0,0,3"});
        CHECK(none.err.find("no voxel") == std::string::npos);
        CHECK(none.out.find(empty) != std::string::npos);
    }
    SECTION("a verdict has nothing to say of it") {
        // Locked where it is, the inner cube cannot have what is wanted.
        const Outcome r = w.run(Words{"optimize"} + about +
                                Words{"--target", "1,4,4,9", "--lock", names[0], "--lock", names[3], "--json"});
        REQUIRE(r.status == 0);
        const json j = json::parse(r.out);
        REQUIRE(j["converged"] == false);
        const std::string verdict = j["verdict"].dump();
        CHECK(verdict.find(names[1]) == std::string::npos);
        CHECK(verdict.find(names[2]) == std::string::npos);
    }
    SECTION("a series says in how many frames it is empty, and aims at nothing there") {
        std::string other = bytes; // in the second frame some voxels of the third quarter
        int count = 0;             // every other one
        for (char& c : other)
            if (c == 40 && ++count % 2 == 0) c = static_cast<char>(150);
        w.write("s0.raw", bytes);
        w.write("s1.raw", other);
        const Words series{"sequence", "s%d.raw",     "--raw",         "12,12,12,u8", "--range", "0,255",
                           "--tf",     "tents:4:0.3", "--engine",      "cpu",         "--mode",  "optimize",
                           "--target", "equal",       "--no-pictures", "--out",       "o",       "--json"};
        const Outcome r = w.run(series);
        REQUIRE(r.status == 0);
        const json j = json::parse(r.out);
        CHECK(j["frames"][0]["target"] == json({0.5, 0, 0, 0.5}));
        CHECK(j["frames"][0]["empty"] == json({false, true, true, false}));
        CHECK(j["frames"][1]["empty"] == json({false, true, false, false}));
        CHECK(j["frames"][1]["target"][1] == 0);
        CHECK(j["frames"][1]["target"][2] > 0);
        CHECK(r.err.find("'" + names[1] + "' is empty in 2 of 2 frames") != std::string::npos);
        CHECK(r.err.find("'" + names[2] + "' is empty in 1 of 2 frames") != std::string::npos);
    }
}

TEST_CASE("an unreached target is an error only where it is demanded", "[cli]") {
    const Workshop w;
    std::vector<std::string> arguments{
        "optimize", "sample:shells", "--size", "16",       "--target", "1,3,6", "--max-iterations",
        "1",        "--tolerance",   "0.001",  "--engine", "cpu",      "--json"};
    const Outcome lenient = w.run(arguments);
    CHECK(lenient.status == 0);
    CHECK(json::parse(lenient.out)["converged"] == false);
    arguments.insert(arguments.end(), {"--require-converged", "--out-tf", "best.tf.json"});
    const Outcome strict = w.run(arguments);
    CHECK(strict.status == 1);
    CHECK(strict.err.rfind("pellucid-cli: error: the targets were not reached", 0) == 0);
    CHECK(std::count(strict.err.begin(), strict.err.end(), '\n') == 1);
    // The best one seen is an answer all the same.
    CHECK(json::parse(strict.out)["tf"] == json::parse(w.read("best.tf.json")));
}

TEST_CASE("every figure is the same with one thread and with two", "[cli]") {
    const Workshop w;
    const std::vector<std::vector<std::string>> commands{
        {"measure", "sample:knee", "--size", "32", "--tf", "tents:3", "--engine", "cpu"},
        {"optimize", "sample:shells", "--size", "24", "--tf", "tents:3", "--target", "1,3,6", "--engine", "cpu"},
        {"refine", "sample:knee", "--size", "32", "--tf", "ramp:6"}};
    for (auto command : commands) {
        INFO(command[0]);
        auto two = command;
        command.insert(command.end(), {"--threads", "1"});
        two.insert(two.end(), {"--threads", "2"});
        CHECK(withoutSeconds(w.json(command)) == withoutSeconds(w.json(two)));
    }
    for (const std::string threads : {"1", "2"})
        w.json({"render", "sample:shells", "--sample-size", "24", "--size", "64x64", "--engine", "cpu", "--threads",
                threads, "--out", "t" + threads + ".png"});
    CHECK(w.read("t1.png") == w.read("t2.png"));
}

TEST_CASE("a transfer function comes back with the keys that are not ours", "[cli]") {
    const Workshop w;
    w.write("foreign.tf.json", kForeignTf);
    w.json({"refine", "sample:shells", "--size", "16", "--tf", "foreign.tf.json", "--out-tf", "out.tf.json"});
    const json out = json::parse(w.read("out.tf.json"));
    CHECK(out["format"] == "pellucid-tf");
    CHECK(out["author"] == "someone");
    CHECK(out["points"][0]["note"] == json({1, 2}));
    CHECK(out["features"][0]["id"] == "D1");
    CHECK(out["features"][0]["name"] == "dentine");
    CHECK(out["range"] == json({-10.0, 300.0}));
    REQUIRE(out["points"].size() == 3);
    CHECK(out["points"][1]["x"] == 0.3);
    CHECK(out["points"][1]["color"] == "#ff8800");
}

TEST_CASE("the range of a transfer function is the window unless --range says otherwise", "[cli]") {
    const Workshop w;
    w.write("foreign.tf.json", kForeignTf);
    const std::vector<std::string> base{"measure", "sample:shells",   "--size",   "16",
                                        "--tf",    "foreign.tf.json", "--engine", "cpu"};
    const json byFile = w.json(base);
    CHECK(byFile["volume"]["range"] == json({-10.0, 300.0}));
    auto same = base, other = base;
    same.insert(same.end(), {"--range", "-10,300"});
    other.insert(other.end(), {"--range", "0,255"});
    CHECK(w.json(same)["visibility_histogram"] == byFile["visibility_histogram"]);
    const json windowed = w.json(other);
    CHECK(windowed["volume"]["range"] == json({0.0, 255.0}));
    CHECK(windowed["visibility_histogram"] != byFile["visibility_histogram"]);
}

TEST_CASE("constant and invalid volumes are measured as empty ones", "[cli]") {
    const Workshop w;
    w.write("constant.raw", std::string(512, '\7'));
    std::string nan;
    for (int i = 0; i < 512; ++i) nan += std::string("\0\0\xc0\x7f", 4); // little-endian quiet NaN
    w.write("nan.raw", nan);
    const std::vector<std::pair<std::string, std::string>> volumes{{"constant.raw", "8,8,8,u8"},
                                                                   {"nan.raw", "8,8,8,f32"}};
    for (const auto& [file, layout] : volumes) {
        INFO(file);
        const json info = w.json({"info", file, "--raw", layout});
        CHECK(info["notices"].size() == 1);
        CHECK(info["range"][0] == info["range"][1]);
        // Every intensity is 0 or none, and tents:3 is transparent there: all figures are 0, and a remark says why.
        const Outcome outcome =
            w.run({"measure", file, "--raw", layout, "--tf", "tents:3", "--json", "--engine", "cpu"});
        CHECK(outcome.status == 0);
        CHECK(outcome.err.rfind("pellucid-cli: note: ", 0) == 0);
        const json j = json::parse(outcome.out);
        CHECK(sum(j["visibility_histogram"]) == 0);
        for (const json& f : j["features"]) CHECK(f["vws"] == 0.0);
    }
    CHECK(w.json({"info", "nan.raw", "--raw", "8,8,8,f32"})["invalid"] == 512);
}

TEST_CASE("progress goes to stderr where it is asked for", "[cli]") {
    const Workshop w;
    const Outcome quiet = w.run({"measure", "sample:shells", "--size", "16", "--json", "--engine", "cpu"});
    CHECK(quiet.err.empty());
    const Outcome loud = w.run({"measure", "sample:shells", "--size", "16", "--json", "--engine", "cpu", "--progress"});
    CHECK(loud.err.find("saliency 0 %\n") != std::string::npos);
    CHECK(loud.err.find("visibility 0 %\n") != std::string::npos);
    CHECK(withoutSeconds(json::parse(loud.out)) == withoutSeconds(json::parse(quiet.out)));

    // The start and one move.
    const Outcome search = w.run({"optimize", "sample:shells", "--size", "16", "--target", "1,3,6", "--max-iterations",
                                  "1", "--engine", "cpu", "--progress"});
    CHECK(search.err.find("optimizing: 0 moves, distance ") != std::string::npos);
    CHECK(search.err.find("optimizing: 1 moves, distance ") != std::string::npos);
}

TEST_CASE("convert writes a volume, or a part of it, in another format", "[cli]") {
    const Workshop w;
    const json whole = w.json({"convert", "sample:shells", "--sample-size", "16", "--out", "a.nii.gz"});
    CHECK(whole["command"] == "convert");
    CHECK(whole["type"] == w.json({"info", "sample:shells", "--sample-size", "16"})["type"]);
    const json before = w.json({"info", "sample:shells", "--sample-size", "16"}), after = w.json({"info", "a.nii.gz"});
    for (const char* key : {"dims", "spacing", "data_range", "invalid", "type"}) CHECK(after[key] == before[key]);
    const json part =
        w.jsonAndNotes({"convert", "a.nii.gz", "--region", "2:10,0:16,4:8", "--type", "f64", "--out", "b.vti"});
    CHECK(part["dims"] == json({8, 16, 4}));
    CHECK(w.json({"info", "b.vti"})["type"] == "f64");
    CHECK(w.json({"info", "b.vti"})["dims"] == json({8, 16, 4}));
    const Outcome rounded = w.run({"convert", "b.vti", "--type", "u8", "--out", "c.mha"});
    CHECK(rounded.status == 0);
    const Outcome wrong = w.run({"convert", "b.vti", "--out", "c.png"});
    CHECK(wrong.status == 2);
    CHECK_THAT(wrong.err, Catch::Matchers::Contains("--out c.png") && Catch::Matchers::Contains(".nii.gz"));
    const Outcome over = w.run({"convert", "b.vti", "--out", "b.vti"});
    CHECK(over.status == 2);
}

TEST_CASE("convert writes all frames of a series into one file", "[cli]") {
    const Workshop w;
    w.json({"generate", "vortex", "--size", "8", "--frames", "3", "--out", "v%02d.nrrd"});
    const json all = w.json({"convert", "v%02d.nrrd", "--all-frames", "--out", "all.nii.gz"});
    CHECK(all["frames"] == 3);
    for (const char* frame : {"0", "2"}) {
        w.json({"convert", "v%02d.nrrd", "--frame", frame, "--out", "one.nrrd"});
        w.json({"convert", "all.nii.gz", "--frame", frame, "--out", "same.nrrd"});
        CHECK(readVolume(w.path("one.nrrd")).samples() == readVolume(w.path("same.nrrd")).samples());
    }
    const Outcome image = w.run({"convert", "v%02d.nrrd", "--all-frames", "--out", "all.vti"});
    CHECK(image.status != 0);
    CHECK_THAT(image.err, Catch::Matchers::Contains(".pvd"));
}

TEST_CASE("convert says what of the data it did not read", "[cli]") {
    const Workshop w;
    const auto said = [&](const Words& words) {
        const Outcome outcome = w.run(Words{"convert"} + words);
        CHECK(outcome.status == 0);
        return outcome.err;
    };
    w.write("a.raw", std::string(16 * 16 * 16 - 1, 'a') + "b");
    const Words raw{"a.raw", "--raw", "16,16,16,u8"};
    CHECK_THAT(said(raw + Words{"--downsample", "2", "--out", "a.nrrd"}),
               Catch::Matchers::Contains("downsampled by 2 to 8 x 8 x 8 of 16 x 16 x 16 voxels"));
    CHECK_THAT(said(raw + Words{"--region", "0:4,0:4,0:4", "--out", "b.nrrd"}),
               Catch::Matchers::Contains("a region of 4 x 4 x 4 of 16 x 16 x 16 voxels"));
    // Of three components, and of two files, one.
    w.write("c.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 2\nkinds: vector domain domain domain\n"
                      "encoding: raw\n\n" +
                          std::string(24, 'x'));
    CHECK_THAT(said({"c.nrrd", "--out", "d.nrrd"}), Catch::Matchers::Contains("component 0 of 3"));
    w.json({"generate", "vortex", "--size", "8", "--frames", "3", "--out", "v%02d.nrrd"});
    const std::string one = said({"v%02d.nrrd", "--out", "e.nrrd"});
    CHECK_THAT(one, Catch::Matchers::Contains("frame 0 of 3") && Catch::Matchers::Contains("--all-frames writes all"));
    CHECK(said({"v%02d.nrrd", "--frame", "0", "--out", "f.nrrd"}).empty());
    CHECK(said({"v%02d.nrrd", "--all-frames", "--out", "g.nrrd"}).empty());
}

TEST_CASE("fields are written in the format that is asked for", "[cli]") {
    const Workshop w;
    const Words volume{"sample:shells", "--size", "16", "--tf", "tents:3", "--engine", "cpu", "--field", "vws"};
    w.json(Words{"fields"} + volume + Words{"--out", "n"});
    const json written = w.json(Words{"fields"} + volume + Words{"--format", "nii.gz", "--out", "f"});
    CHECK(written["files"] == json::array({"f/vws.nii.gz"}));
    CHECK(readVolume(w.path("f/vws.nii.gz")).samples() == readVolume(w.path("n/vws.nrrd")).samples());
    const Outcome wrong = w.run(Words{"fields"} + volume + Words{"--format", "png", "--out", "g"});
    CHECK(wrong.status == 2);
    CHECK_THAT(wrong.err, Catch::Matchers::Contains("--format png"));
}
