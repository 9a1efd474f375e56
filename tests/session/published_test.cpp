// The published profile against the thesis's printed figures and the programs behind them.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "optimize/objective.h"
#include "render/published_engine.h"
#include "session/refine_priority.h"
#include "session/workspace.h"
#include "support/volumes.h"

using namespace pellucid;

namespace {

const std::string kShared = PELLUCID_SHARED_DIR "/data/";

bool haveThesisData() {
    if (std::filesystem::exists(kShared + "thesis/nucleon_naive.tfi")) return true;
    WARN("SKIPPED: there is no " << kShared << "thesis");
    return false;
}

Scene published(const std::string& volume, const std::string& tf, Along along = Along::Front) {
    SceneInputs in;
    VolumeSource source;
    source.path = volume;
    in.session = sessionOf(source);
    in.session.measure.edit([along](MeasureSettings& m) {
        m.profile = Profile::Published;
        m.along = along;
    });
    in.tf = tf;
    return openScene(in);
}

Scene thesisScene(const std::string& volume, const std::string& tf) {
    return published(kShared + "real/" + volume + "/" + volume + ".mhd", kShared + "thesis/" + tf + ".tfi");
}

void checkVws(const Scene& scene, const std::vector<double>& vws, const std::vector<double>& visibility) {
    const Measures m = Workspace().measure(measureInput(scene));
    REQUIRE(m.features.size() == 3);
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(m.features[f].vws == Approx(vws[f]).epsilon(0).margin(1e-5));
        if (!visibility.empty()) CHECK(m.features[f].visibility == Approx(visibility[f]).epsilon(0).margin(1e-5));
    }
}

/// To the starting peaks over their sum.
OptimizeResult search(const std::string& volume, SearchMethod method) {
    const Scene scene = thesisScene(volume, volume + "_naive_proportional");
    OptimizeOptions options;
    options.method = method;
    return Workspace().optimize(measureInput(scene), featureOpacities(scene.tf), {}, options);
}

} // namespace

TEST_CASE("the published profile has the figures of the thesis's own programs", "[session][published][real]") {
    if (!haveThesisData()) return;
    checkVws(thesisScene("nucleon", "nucleon_naive"), {0.406511, 0.434633, 0.158856}, {0.551454, 0.369802, 0.078744});
    checkVws(thesisScene("tooth", "tooth_naive"), {0.382546, 0.402091, 0.215363}, {});
}

TEST_CASE("the published profile takes the steps of table 5.1", "[session][published][real]") {
    if (!haveThesisData()) return;
    const OptimizeResult fixed = search("nucleon", SearchMethod::Fixed);
    CHECK(fixed.converged());
    CHECK(fixed.evaluations == 17);
    CHECK(fixed.history.back().objective == Approx(0.029525).epsilon(0).margin(1e-5));
    CHECK(search("tooth", SearchMethod::Fixed).evaluations == 21);
    for (const char* volume : {"nucleon", "tooth"}) {
        const OptimizeResult line = search(volume, SearchMethod::Line),
                             parallel = search(volume, SearchMethod::Parallel);
        CHECK(line.converged());
        CHECK(line.iterations() == 2);
        CHECK(parallel.iterations() == 2);
        CHECK(line.history == parallel.history); // the curves overlap
        CHECK(parallel.evaluations == 9);        // the start, and four steps a move
    }
    CHECK(search("nucleon", SearchMethod::Parallel).history.back().objective ==
          Approx(0.015434).epsilon(0).margin(1e-5));
}

TEST_CASE("published refinement of the thesis's own transfer functions", "[session][published][real]") {
    if (!haveThesisData()) return;
    // Peaks in 255ths, iterations and movable energies of a script that reads the raw files and adds up
    // −α p ln p over whole values by itself.
    struct Expected {
        const char *volume, *tf;
        std::vector<int> peaks;
        int iterations;
        double before, after;
    };
    const Expected all[] = {{"nucleon", "_naive", {60, 58, 137}, 72, 6.495459526e-05, 3.4233941465e-09},
                            {"nucleon", "_naive_proportional", {60, 58, 138}, 54, 6.206338575e-05, 4.5602492e-10},
                            {"tooth", "_naive", {159, 64, 77}, 77, 5.664709735e-04, 6.750454234e-08},
                            {"tooth", "_naive_proportional", {136, 54, 66}, 128, 1.999026911e-03, 1.85966702e-08}};
    for (const Expected& e : all) {
        const Scene scene = thesisScene(e.volume, std::string(e.volume) + e.tf);
        const RefineResult r = refine(*scene.histogram, scene.tf, refineOptions(scene.session));
        const std::vector<double> peaks = featureOpacities(r.tf);
        REQUIRE(peaks.size() == e.peaks.size());
        for (std::size_t f = 0; f < peaks.size(); ++f) CHECK(255 * peaks[f] == Approx(e.peaks[f]));
        CHECK(r.iterations == e.iterations);
        CHECK(r.energyMovableBefore == Approx(e.before).epsilon(1e-6));
        CHECK(r.energyMovableAfter == Approx(e.after).epsilon(1e-4));
    }
}

TEST_CASE("intensities of 8-bit data are value/255 in the published profile", "[session][published]") {
    // The largest value is 200: by default it is the intensity 1.
    const Volume data(test::geometryOf({2, 1, 1}), Samples(std::vector<std::uint8_t>{0, 200}));
    Session session;
    TransferFunction tf = tents(3);
    placeAsPublished(session, data, tf);
    CHECK_FALSE(tf.range);
    session.measure.edit([](MeasureSettings& m) { m.profile = Profile::Published; });
    placeAsPublished(session, data, tf);
    CHECK(tf.range == ValueRange{0, 255});
    tf.range = ValueRange{10, 20}; // a file that says of which values it is
    placeAsPublished(session, data, tf);
    CHECK(tf.range == ValueRange{10, 20});
    const Volume floats(test::geometryOf({2, 1, 1}), Samples(std::vector<float>{0, 200}));
    TransferFunction other = tents(3);
    placeAsPublished(session, floats, other);
    CHECK_FALSE(other.range);

    if (!haveThesisData()) return; // the nucleon's largest value is 249
    const Scene scene = thesisScene("nucleon", "nucleon_naive");
    CHECK(scene.volume->range() == ValueRange{0, 255});
    CHECK(scene.tf.points[0].x == 0.134921);
}

TEST_CASE("published figures depend on nothing that the profile fixes", "[session][published]") {
    Scene scene = published("sample:disks", "tents:3:0.2", Along::Right);
    const MeasureInput before = measureInput(scene);
    CHECK(before.view.camera == cameraAlong(scene.volume->geometry(), Along::Right));
    scene.camera = cameraFromView(scene.volume->geometry(), 70, 10, 2, Projection::Perspective);
    scene.session.measure.edit([](MeasureSettings& m) {
        m.engine = EngineChoice::Gl;
        m.saliency.sigma = 3;
        m.vws = {0.1, 0.9};
    });
    CHECK(measureInput(scene) == before);
    scene.session.measure.edit([](MeasureSettings& m) { m.along = Along::Left; });
    CHECK_FALSE(measureInput(scene) == before);
}

TEST_CASE("published figures of the disks: who stands in front is seen", "[session][published]") {
    // The disks stand one behind the other along x, f1 at the lowest.
    const auto visibility = [](Along along) {
        std::vector<double> all;
        for (const FeatureMeasures& f :
             Workspace().measure(measureInput(published("sample:disks", "tents:3:0.6", along))).features)
            all.push_back(f.visibility);
        return all;
    };
    const std::vector<double> left = visibility(Along::Left), right = visibility(Along::Right);
    CHECK(left[0] > 0.9);
    CHECK(right[2] > 0.9);
    CHECK(left[0] == Approx(right[2]).margin(0.02)); // the sample is the same from both sides
}
