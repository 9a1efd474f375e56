// --session: what the window has saved, and what is given beside it.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "render/image_renderer.h"
#include "session/session_json.h"
#include "session/workspace.h"
#include "tf/formats/tf_json.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

/// In the folder: knee.nrrd and a.pellucid.json, a session in which everything is other than usual.
struct Saved {
    Workshop w;
    Session session;

    Saved() {
        REQUIRE(w.run({"generate", "knee", "--size", "24", "--out", "knee.nrrd"}).status == 0);
        VolumeSource source;
        source.path = w.path("knee.nrrd").string();
        session = sessionOf(source);
        session.variables.edit([](std::vector<Variable>& all) { all[0].window = ValueRange{-500, 1500}; });
        TransferFunction tf = tents(3, 0.1);
        tf.range = ValueRange{-600, 1200};
        tf.features[1].name = "middle";
        tf.points[4].color = tf.features[1].color = {0.1 + 0.2, 0.5, 0.7};
        session.setTf(tf);
        session.goals = withTargets(*session.goals, *session.tf(), {0.2, 0.3, 0.5});
        session.camera = camera();
        session.measure.edit([](MeasureSettings& m) {
            m.engine = EngineChoice::Cpu;
            m.saliency.sigma = 1.5;
            m.saliency.background = {0.25, 0.5, 0.1};
            m.vws = {0.3, 0.7};
        });
        session.optimize.edit([](OptimizeOptions& o) {
            o.method = SearchMethod::Line;
            o.maxIterations = 3;
            o.tolerance = 1e-6;
        });
        save();
    }
    void save() const { writeSession(session, w.path("a.pellucid.json").string()); }
    Scene scene() const { return resolve(session, {}); }
    Camera camera() const {
        VolumeSource source;
        source.path = w.path("knee.nrrd").string();
        return cameraFromView(loadVolume(source).geometry(), 70, 15, 1.5, Projection::Perspective);
    }
};

json measuredBy(const Workshop& w, std::vector<std::string> options) {
    options.insert(options.begin(), {"measure", "--session", "a.pellucid.json"});
    return w.json(options);
}

std::vector<double> column(const json& objects, const char* key) {
    std::vector<double> values;
    for (const json& o : objects) values.push_back(o.at(key).get<double>());
    return values;
}

} // namespace

TEST_CASE("a session measures as the window does", "[cli][session]") {
    const Saved saved;
    const json j = measuredBy(saved.w, {});
    const Scene scene = saved.scene();
    const Measures expected = Workspace().measure(measureInput(scene));
    REQUIRE(j["features"].size() == expected.features.size());
    CHECK(j["volume"]["range"] == json({-500.0, 1500.0}));
    CHECK(j["features"][1]["name"] == "middle");
    for (std::size_t f = 0; f < expected.features.size(); ++f) {
        CHECK(j["features"][f]["vws"] == expected.features[f].vws);
        CHECK(j["features"][f]["visibility"] == expected.features[f].visibility);
        CHECK(j["features"][f]["range"][0] == scene.tf.features[f].a);
    }
    CHECK(j["visibility_histogram"] == json(expected.visibilityHistogram));
}

TEST_CASE("a session optimizes towards its own targets, in its own way", "[cli][session]") {
    const Saved saved;
    const json j = saved.w.json({"optimize", "--session", "a.pellucid.json", "--out-tf", "o.tf.json"});
    CHECK(j["target"] == json({0.2, 0.3, 0.5}));
    CHECK(j["method"] == "line");
    CHECK(j["iterations"].get<int>() <= 3);
    const OptimizeResult expected =
        Workspace().optimize(measureInput(saved.scene()), {0.2, 0.3, 0.5}, {}, *saved.session.optimize);
    CHECK(j["objective"].back() == expected.history.back().objective);
    // The exact colour survives.
    CHECK(readTf(saved.w.path("o.tf.json").string()).features[1].color == Rgb{0.1 + 0.2, 0.5, 0.7});
    CHECK(readTf(saved.w.path("o.tf.json").string()) == expected.tf);

    const json other = saved.w.json({"optimize", "--session", "a.pellucid.json", "--target", "1,1,2", "--method",
                                     "fixed", "--max-iterations", "1", "--step", "0.01", "--tolerance", "0.5"});
    CHECK(other["target"] == json({0.25, 0.25, 0.5}));
    CHECK(other["method"] == "fixed");
    CHECK(other["iterations"].get<int>() <= 1);
}

TEST_CASE("options override what the session says", "[cli][session]") {
    const Saved saved;
    const Workshop& w = saved.w;
    const json plain = measuredBy(w, {});
    const std::vector<std::vector<std::string>> changes{{"--tf", "tents:2"},
                                                        {"--range", "-400,1200"},
                                                        {"--view", "0,0"},
                                                        {"--orthographic"},
                                                        {"--sigma", "3"},
                                                        {"--u1", "0.9"},
                                                        {"--saliency-background", "0,0,0"},
                                                        {"--engine", "reference"},
                                                        {"--quality", "high"}};
    for (const auto& change : changes) {
        INFO(change[0]);
        CHECK(column(measuredBy(w, change)["features"], "vws") != column(plain["features"], "vws"));
    }
    CHECK(measuredBy(w, {"--engine", "reference"})["engine"] == "reference");
    CHECK(measuredBy(w, {"--range", "-400,1200"})["volume"]["range"] == json({-400.0, 1200.0}));
    // The curve stays at its data values: tents:3 of −600 … 1200 has its middle one from 60.
    const auto dataValue = [](const json& j) {
        const double lo = j["volume"]["range"][0], hi = j["volume"]["range"][1];
        return lo + j["features"][1]["range"][0].get<double>() * (hi - lo);
    };
    CHECK(dataValue(plain) == Approx(-600 + 1800 * (0.5 - 0.4 / 3)));
    CHECK(dataValue(measuredBy(w, {"--range", "-400,1200"})) == Approx(dataValue(plain)));

    // VOLUME takes the place of the session's data, and of nothing else.
    REQUIRE(w.run({"generate", "knee", "--size", "16", "--out", "small.nrrd"}).status == 0);
    const json small = measuredBy(w, {"small.nrrd"});
    CHECK(small["volume"]["dims"][0] == 16);
    CHECK(small["volume"]["range"] == json({-500.0, 1500.0}));
    CHECK(small["features"][1]["name"] == "middle");
}

TEST_CASE("refine takes what the session prioritizes, a region too", "[cli][session]") {
    Saved s;
    const auto refined = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"refine", "--session", "a.pellucid.json", "--json"});
        const Outcome o = s.w.run(options);
        REQUIRE(o.status == 0);
        return json::parse(o.out);
    };
    CHECK(refined({})["priority"]["kind"] == "none");
    // Without a region there is no picture to have a size.
    CHECK(s.w.run({"refine", "--session", "a.pellucid.json", "--size", "64x64"}).status == 2);

    // The middle quarter of the picture: pixels 16 to 47 of 64.
    s.session.refine.edit([](RefineSettings& r) {
        r.region = ImageRegion{{{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}}};
    });
    s.save();
    const json own = refined({"--size", "64x64"}), given = refined({"--size", "64x64", "--region", "16,16,48,48"});
    CHECK(own["priority"]["kind"] == "region");
    CHECK(own["priority"]["outline"].size() == 4);
    CHECK(own["priority"]["pixels"] == given["priority"]["pixels"]);
    CHECK(own["tf"] == given["tf"]);
    CHECK(refined({"--intensity", "0.5"})["priority"]["kind"] == "intensity");
}

TEST_CASE("every command takes a session", "[cli][session]") {
    const Saved saved;
    const Workshop& w = saved.w;
    const std::vector<std::string> with{"--session", "a.pellucid.json"};
    const auto run = [&](std::vector<std::string> words) {
        words.insert(words.end(), with.begin(), with.end());
        return w.json(words);
    };
    CHECK(run({"info"})["title"] == "knee.nrrd");
    CHECK(run({"info"})["range"] == json({-500.0, 1500.0}));
    CHECK(run({"refine", "--max-iterations", "2"})["tf"]["range"] == json({-500.0, 1500.0}));
    CHECK(run({"fields", "--out", "f"})["files"].size() == 4);
    const json bench = run({"bench", "--only", "sweep", "--threads", "1", "--repeat", "1", "--tf", "tents:2"});
    CHECK(bench["rows"][0]["dims"][0] == 24);
    CHECK(bench["rows"][0]["engine"] == "cpu");

    const auto picture = [&](const std::string& file, std::vector<std::string> options) {
        std::vector<std::string> words{"render", "--size", "40x30", "--out", file};
        words.insert(words.end(), options.begin(), options.end());
        run(words);
        return readImage(w.path(file).string()).rgba;
    };
    const auto plain = picture("a.exr", {});
    const std::vector<std::vector<std::string>> changes{{"--feature", "middle"},         {"--shading"},
                                                        {"--clip", "x:0:0.5"},           {"--background", "0,0,1"},
                                                        {"--background", "transparent"}, {"--view", "0,0"}};
    for (const auto& change : changes) {
        INFO(change[0]);
        CHECK(picture("b.exr", change) != plain);
    }
    // What was cut away in the window is cut away here, unless other clips are given.
    Session session = saved.session;
    session.clipping = Clipping{{0, 0, 0}, {0.5, 1, 1}, {}};
    session.display = DisplaySettings{.light = Light{.on = true},
                                      .background = {0, 0, 1},
                                      .backgroundTop = {},
                                      .onlyFeature = session.tf()->features[1].id};
    writeSession(session, w.path("a.pellucid.json").string());
    const auto shown = picture("c.exr", {});
    CHECK(shown != plain);
    const Scene scene = resolve(session, {});
    const PictureInput expected = pictureInput(scene, 40, 30);
    const Image image = makeCpuRenderer(scene.volume)->render(expected.camera, expected.tf, expected.settings);
    CHECK(image.rgba.size() == shown.size());
    double most = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) most = std::max(most, std::abs(double(shown[i]) - image.rgba[i]));
    CHECK(most < 1e-5);
    CHECK(picture("d.exr", {"--clip", "y:0:0.5"}) != shown);
}

TEST_CASE("a session that has not changed its data is silent, another is noted", "[cli][session]") {
    const Saved saved;
    const Workshop& w = saved.w;
    REQUIRE(w.run({"generate", "knee", "--size", "20", "--out", "knee.nrrd"}).status == 0);
    const Outcome o = w.run({"info", "--session", "a.pellucid.json"});
    CHECK(o.status == 0);
    CHECK(o.err.rfind("pellucid-cli: note: the file knee.nrrd", 0) == 0);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
}

TEST_CASE("a session that cannot be used fails as files do", "[cli][session]") {
    const Saved saved;
    const Workshop& w = saved.w;
    const auto fails = [&](const std::vector<std::string>& words, int status, const std::string& part) {
        const Outcome o = w.run(words);
        INFO(o.err);
        CHECK(o.status == status);
        CHECK(o.out.empty());
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
        CHECK(o.err.find(part) != std::string::npos);
    };
    fails({"measure", "--session", "none.json"}, 1, "none.json");
    fails({"measure", "--session", ""}, 2, "--session");
    fails({"measure"}, 2, "VOLUME is required");
    w.write("bad.json", R"({"format":"pellucid-session","version":1,"variables":7})");
    fails({"measure", "--session", "bad.json"}, 1, "bad.json at /variables");
    w.write("newer.json", R"({"format":"pellucid-session","version":2,"variables":[]})");
    fails({"measure", "--session", "newer.json"}, 1, "newer than this program knows");
    w.write("empty.json", R"({"format":"pellucid-session","version":1,"variables":[]})");
    fails({"measure", "--session", "empty.json"}, 2, "VOLUME is required");
    CHECK(w.run({"measure", "sample:shells", "--size", "16", "--session", "empty.json"}).status == 0);
    fails({"optimize", "--session", "a.pellucid.json", "--target", "1,2"}, 2, "--target");
    fails({"render", "--session", "a.pellucid.json", "--feature", "f2", "--out", "x.png"}, 2, "'middle'");
    fails({"info", "--session", "a.pellucid.json", "--sample-size", "20"}, 2, "--sample-size");
    // Nothing that is read is overwritten.
    fails({"refine", "--session", "a.pellucid.json", "--out-tf", "a.pellucid.json"}, 2, "overwrite");
    fails({"refine", "--session", "a.pellucid.json", "--out-tf", "knee.nrrd"}, 2, "overwrite");
    std::filesystem::remove(w.path("knee.nrrd"));
    fails({"measure", "--session", "a.pellucid.json"}, 1, "knee.nrrd");
}

TEST_CASE("without a view what is drawn fills the picture, as the window opens", "[cli]") {
    const Workshop w;
    const auto rendered = [&](const std::string& file, std::vector<std::string> options) {
        options.insert(options.begin(), {"render", "sample:shells", "--sample-size", "16", "--size", "48x48",
                                         "--engine", "cpu", "--no-metadata", "--out", file});
        w.json(options);
        return w.read(file);
    };
    const std::string home = rendered("a.png", {});
    CHECK(home != rendered("b.png", {"--view", "30,20"})); // that fits the sphere around it
    SceneInputs in;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    in.session = sessionOf(source);
    const auto byFile = [&](const std::string& file, std::optional<Projection> projection) {
        in.projection = projection;
        w.write("c.camera.json", jsonFromCamera(openScene(in).camera).dump());
        return rendered(file, {"--camera", "c.camera.json"});
    };
    CHECK(home == byFile("c.png", {}));
    CHECK(rendered("d.png", {"--orthographic"}) == byFile("e.png", Projection::Orthographic));
}
