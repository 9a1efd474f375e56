// What was chosen gains on all others, or a sentence says why not; a refinement that darkens the picture says so.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <catch2/catch.hpp>

#include "optimize/answer/first_sight.h"
#include "optimize/coverage.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_outcome.h"
#include "optimize/refine/region_colors.h"
#include "render/camera_motion.h"
#include "render/image_renderer.h"
#include "support/volumes.h"
#include "volume/loader.h"
#include "volume/procedural.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

struct Start {
    std::shared_ptr<const Volume> volume; ///< through the window that the data propose
    TransferFunction tf;                  ///< the automatic start
};

Start startOf(const Volume& data) {
    const Proposal proposal = propose(data);
    Start start;
    start.volume = std::make_shared<const Volume>(
        data.dataRange().lo < data.dataRange().hi ? data.withRange(proposal.window) : data);
    const View home(homeCamera(data.geometry(), Projection::Perspective));
    start.tf = withOpacitiesForView(*start.volume, proposal, proposal.tf, home).tf;
    return start;
}

/// Σ α·p over the bins of each feature, at their middles: another way than the program's integrals.
std::vector<double> summedParts(const Histogram& h, const TransferFunction& tf) {
    constexpr int kPlaces = 16; // of a bin: features end within bins
    std::vector<double> parts(tf.features.size(), 0.0);
    const TfSampler sampler(tf);
    const double bins = static_cast<double>(h.counts.size());
    for (std::size_t b = 0; b < h.counts.size(); ++b)
        for (int i = 0; i < kPlaces; ++i) {
            const double s = (static_cast<double>(b) + (i + 0.5) / kPlaces) / bins;
            const int f = featureAt(tf.features, s);
            if (f >= 0) parts[static_cast<std::size_t>(f)] += sampler.opacity(s) * h.p(b) / kPlaces;
        }
    return parts;
}

/// Whether feature `chosen` and the value x gain on every other feature, by summedParts().
bool gains(const Histogram& h, const TransferFunction& before, const TransferFunction& after, std::size_t chosen,
           double x) {
    const auto was = summedParts(h, before), is = summedParts(h, after);
    const double value = before.opacity(x) > 0 ? after.opacity(x) / before.opacity(x) : 0;
    const double part = was[chosen] > 0 ? is[chosen] / was[chosen] : 0;
    for (std::size_t f = 0; f < was.size(); ++f) {
        if (f == chosen || before.features[f].hidden) continue;
        if (!(was[f] > 0)) {
            if (is[f] > 0) return false;
            continue;
        }
        if (!(std::min(value, part) > is[f] / was[f])) return false;
    }
    return std::min(value, part) > 1 - 1e-9;
}

struct Tally {
    int cases = 0, gained = 0, said = 0, wrong = 0, dark = 0, helped = 0;
    double least = 1e300; ///< gain of what was chosen over the strongest other's, where it gained
};

/// One priority under one method: checked, and counted.
void tryOut(const Histogram& h, const TransferFunction& tf, const RayBundle& rays, const RefineOptions& options,
            Tally& tally, const std::string& where) {
    INFO(where);
    const RefineAgain again = [&](const RefineOptions& by) { return refine(h, tf, by).tf; };
    const TransferFunction after = again(options);
    const auto outcome = priorityOutcome(h, tf, after, options, again);
    REQUIRE(outcome);
    const auto chosen = prioritizedFeature(h, tf, options.priority);
    if (!chosen) { // no feature has a voxel
        ++tally.cases;
        ++tally.said;
        CHECK_FALSE(outcome->gained);
        CHECK(outcome->text.find("nothing to bring out") != std::string::npos);
        return;
    }
    double x = 0;
    if (options.priority.intensity) {
        x = *options.priority.intensity;
    } else {
        const Feature& f = tf.features[*chosen];
        x = (f.a + f.b) / 2;
        for (const ControlPoint& p : tf.points)
            if (p.x > f.a && p.x < f.b && p.opacity > tf.opacity(x)) x = p.x;
    }
    ++tally.cases;
    bool right = true;
    if (outcome->gained) {
        ++tally.gained;
        tally.least = std::min(tally.least, std::min(outcome->valueGain, outcome->partGain) / outcome->othersGain);
        right = outcome->text.empty() && gains(h, tf, after, *chosen, x);
    } else {
        ++tally.said;
        right = !outcome->text.empty();
        for (const RefineMethod method : {RefineMethod::Greedy, RefineMethod::Exact}) {
            RefineOptions by = options;
            by.method = method;
            const bool offered = outcome->text.find(method == RefineMethod::Exact ? "method Exact" : "method Greedy") !=
                                 std::string::npos;
            if (offered) right = right && gains(h, tf, again(by), *chosen, x);
        }
        std::printf("      %s: %s\n", where.c_str(), outcome->text.c_str());
    }
    CHECK(right);
    if (!right) ++tally.wrong;
    if (const auto dark = darkeningOf(rays, h, tf, after, options, again)) {
        ++tally.dark;
        if (dark->help == Darkening::Help::None) {
            std::printf("      %s: %s\n", where.c_str(), darkeningText(*dark).c_str());
            return;
        }
        ++tally.helped;
        RefineOptions by = options;
        if (dark->help == Darkening::Help::Exact) by.method = RefineMethod::Exact;
        if (dark->help == Darkening::Help::Stop) by.maxIterations = dark->iterations;
        CHECK(coverageOf(rays, again(by)).coverage >= kFaintCoverage);
    }
}

/// Five values and five regions under the automatic start and six tents, by both methods.
void tryVolume(const std::string& name, const Volume& data) {
    const Start start = startOf(data);
    if (start.tf.features.empty()) {
        std::printf("%-18s no features\n", name.c_str());
        return;
    }
    const View home(homeCamera(data.geometry(), Projection::Perspective));
    const Histogram h = makeHistogram(*start.volume);
    for (const bool opening : {true, false}) {
        const TransferFunction tf = opening ? start.tf : tents(6);
        const RayBundle rays(*start.volume, tf, home, kCoverageRays);
        RenderSettings settings;
        settings.width = settings.height = 96;
        settings.background.reset();
        const Image picture = makeCpuRenderer(start.volume)->render(home.camera, tf, settings);
        std::vector<std::pair<std::string, RefinePriority>> priorities;
        for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9})
            priorities.push_back({"value " + std::to_string(x).substr(0, 3), {x, {}}});
        const double places[][2] = {{0.5, 0.5}, {0.38, 0.5}, {0.62, 0.5}, {0.5, 0.38}, {0.5, 0.62}};
        for (const auto& [u, v] : places) {
            try {
                const ImageRegion region{
                    {{u - 0.03, v - 0.03}, {u + 0.03, v - 0.03}, {u + 0.03, v + 0.03}, {u - 0.03, v + 0.03}}};
                priorities.push_back(
                    {"region at " + std::to_string(u).substr(0, 4) + "," + std::to_string(v).substr(0, 4),
                     {{}, regionColors(picture, region)}});
            } catch (const Error&) { // the region shows nothing there
            }
        }
        for (const RefineMethod method : {RefineMethod::Greedy, RefineMethod::Exact}) {
            Tally tally;
            for (const auto& [what, priority] : priorities) {
                RefineOptions options;
                options.method = method;
                options.priority = priority;
                tryOut(h, tf, rays, options, tally,
                       name + (opening ? ", opening, " : ", tents:6, ") + pellucid::name(method) + ", " + what);
            }
            std::printf("%-18s %-8s %-7s cases %2d gained %2d said %2d wrong %d least gain over others %.4g dark %d "
                        "helped %d\n",
                        name.c_str(), opening ? "opening" : "tents:6", pellucid::name(method), tally.cases,
                        tally.gained, tally.said, tally.wrong, tally.gained > 0 ? tally.least : 0.0, tally.dark,
                        tally.helped);
            // Where features move as wholes the exceptions are values in no feature and features fully opaque.
            CHECK(tally.wrong == 0);
        }
    }
}

/// Two features that meet at 0.4, where α is 0.1: "soft" of 0.1 all over [0.2, 0.4), "hard" up to 0.5 on [0.4, 0.8).
TransferFunction softAndHard() {
    TransferFunction tf;
    tf.points = {{0.2, 0.1, {1, 0, 0}, false, {}},
                 {0.4, 0.1, {1, 0, 0}, false, {}},
                 {0.5, 0.5, {0, 0, 1}, false, {}},
                 {0.8, 0.5, {0, 0, 1}, false, {}}};
    tf.features = {{"soft", 0.2, 0.4, {1, 0, 0}, {}}, {"hard", 0.4, 0.8, {0, 0, 1}, {}}};
    return tf;
}

/// Every intensity as often as any other.
Histogram even() {
    Histogram h;
    h.counts.assign(256, 4);
    h.total = 1024;
    h.maxCode = 512; // bin b holds one value, in its middle
    for (std::uint16_t b = 0; b < 256; ++b) h.codes.push_back(static_cast<std::uint16_t>(2 * b + 1));
    return h;
}

std::string sentenceFor(const Histogram& h, const TransferFunction& tf, double x) {
    RefineOptions options;
    options.priority.intensity = x;
    const RefineAgain again = [&](const RefineOptions& by) { return refine(h, tf, by).tf; };
    return priorityOutcome(h, tf, again(options), options, again)->text;
}

} // namespace

TEST_CASE("features that share a border point move as wholes toward the one that is chosen", "[refine][features]") {
    // Σ α·p is ∫ α dx here: soft 0.2 · 0.1 = 0.02, hard 0.1 · (0.1 + 0.5) / 2 + 0.3 · 0.5 = 0.18. Hard gives up three
    // quarters of it, 0.135, by which soft, 0.2 long, rises by 0.675 to 0.775.
    const TransferFunction tf = softAndHard();
    CHECK(movesFeatures(tf));
    CHECK_FALSE(movesFeatures(tents(4)));
    CHECK_FALSE(movesFeatures(ramp(4)));
    for (const RefineMethod method : {RefineMethod::Greedy, RefineMethod::Exact}) {
        INFO(name(method));
        RefineOptions options;
        options.method = method;
        options.priority.intensity = 0.3;
        const RefineResult r = refine(even(), tf, options);
        CHECK(featureOpacities(r.tf)[0] == Approx(0.775).margin(1e-6));
        CHECK(featureOpacities(r.tf)[1] == Approx(0.125).margin(1e-6));
        CHECK(r.tf.opacity(0.3) == Approx(0.775).margin(1e-6));
        CHECK(r.tf.opacity(0.4) == Approx(0.025).margin(1e-6)); // a quarter of 0.1, from the border on
        CHECK(r.edgesBefore.size() == 2);
        CHECK(r.energyMovableAfter < r.energyMovableBefore);
        // Hard can rise to 1 only: by 0.18 · (1 / 0.5 − 1) = 0.18, more than the 0.015 that soft may give, so that it
        // gets these: × 195 / 180.
        options.priority.intensity = 0.6;
        const RefineResult other = refine(even(), tf, options);
        CHECK(featureOpacities(other.tf)[0] == Approx(0.025).margin(1e-6));
        CHECK(featureOpacities(other.tf)[1] == Approx(0.5 * 195 / 180).margin(1e-6));
        CHECK(r.iterations > 0);
    }
    // Nothing chosen: what common and what rare features have changes hands, Σ α·p stays.
    const RefineResult all = refine(even(), tf);
    const auto parts = opacityParts(even(), all.tf);
    CHECK(parts[0] + parts[1] == Approx(0.2).margin(1e-9));
    CHECK(all.edgesAfter == edgeWeights(even(), all.tf));
}

TEST_CASE("a sentence says why what was chosen cannot gain", "[refine][outcome]") {
    TransferFunction tf = softAndHard();
    CHECK(sentenceFor(even(), tf, 0.3).empty());
    CHECK(sentenceFor(even(), tf, 0.95) ==
          "No feature holds the value 0.95; the nearest is hard. Add a feature there to bring the value out.");
    tf.features[0].hidden = true;
    CHECK(sentenceFor(even(), tf, 0.3) == "soft is hidden and cannot be brought out: show it first.");
    tf = softAndHard();
    tf.points[0].fixed = true;
    CHECK(sentenceFor(even(), tf, 0.3) ==
          "soft has a fixed control point and keeps its opacity: release the point to bring it out.");
    tf = softAndHard();
    Histogram h = even();
    for (std::size_t b = 0; b < 128; ++b) h.counts[b] = 0; // up to 0.5
    h.codes.erase(h.codes.begin(), h.codes.begin() + 128);
    h.total = 512;
    CHECK(sentenceFor(h, tf, 0.3) ==
          "No voxel has a value of soft, so there is nothing to bring out: choose another value.");
    // A feature between two values of one bin has no voxel, though the bin has some.
    tf = softAndHard();
    tf.points[0].x = 0.299;
    tf.points[1].x = 0.3;
    tf.features[0].a = 0.299;
    tf.features[0].b = 0.3;
    CHECK(sentenceFor(even(), tf, 0.2995) ==
          "No voxel has a value of soft, so there is nothing to bring out: choose another value.");
}

TEST_CASE("what is chosen gains on all others under every sample, or a sentence says why not", "[refine][outcome]") {
    for (const SampleInfo& sample : samples()) tryVolume(sample.name, makeSample(sample.name, 48));
}

TEST_CASE("what is chosen gains on all others under every real volume, or a sentence says why not", "[.acceptance]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/";
    if (!std::filesystem::is_directory(folder)) {
        WARN("SKIPPED: there is no folder " << folder);
        return;
    }
    for (const char* file : {"nucleon/nucleon.mhd", "tooth/tooth.mhd", "vortex/vorts1.mhd", "walnut/walnut.mhd",
                             "hydrogenatom/hydrogenatom.dat", "viscous_fingers/density_040.mhd",
                             "cranium_ct/cranium_ct.nrrd", "nifti/ch2.nii.gz", "nifti/mpld_asl_4d.nii.gz",
                             "nrrd/FLAIR.nrrd", "mha/epi_short.mha", "pvm/Lobster.pvm", "pvm/Bucky.pvm"}) {
        VolumeSource source;
        source.path = folder + file;
        try {
            tryVolume(file, loadVolume(source));
        } catch (const Error& error) {
            std::printf("%-18s %s\n", file, error.what());
        }
    }
    for (const SampleInfo& sample : samples()) tryVolume(sample.name, makeSample(sample.name));
}
