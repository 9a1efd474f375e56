// Captions: every number in them is one that was measured.
#include "session/caption.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <regex>

#include "engines/engines.h"
#include "optimize/answer/visibility_words.h"
#include "session/workspace.h"
#include "support/caption_numbers.h"
#include "support/random_cases.h"
#include "support/temp_folder.h"
#include "volume/volume_writer.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

CaptionFeature feature(const std::string& name, double vws, double visibility) { return {name, vws, visibility}; }

/// All "12 %", "1.2 %" and "< 0.1 %" of a text, in their order.
std::vector<std::string> percentsIn(const std::string& text) {
    static const std::regex kPercent("(< )?[0-9.]+ %");
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), kPercent); it != std::sregex_iterator(); ++it)
        found.push_back(it->str());
    return found;
}

/// A random volume of at most 21 voxels along each axis in a file, opened as the command line opens one: features of
/// random shape and opacity, some of them hidden, from a random view in either projection, lit or not.
Scene randomScene(std::uint32_t number, const TempFolder& folder) {
    constexpr std::array kNames{"amber", "beryl", "coral", "delta", "ebony"};
    const RandomCase c = randomCase(number, 0.45);
    Random random(number);
    VolumeSource source;
    source.path = folder.path("scene" + std::to_string(number) + ".nrrd");
    source.missing = c.volume->missing();
    writeVolume(*c.volume, source.path);
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    TransferFunction tf = c.tf;
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        tf.features[f].name = kNames.at(f);
        tf.features[f].hidden = random.chance(0.2);
    }
    inputs.session.setTf(tf);
    inputs.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    inputs.session.display.edit([&](DisplaySettings& d) { d.light.on = random.chance(0.5); });
    inputs.camera = c.camera;
    inputs.cameraName = c.cameraKind;
    return openScene(inputs);
}

/// The mean alpha over those of 96 × 96 rays that meet a feature which is drawn (docs/method.md, "Coverage").
double coverageByDefinition(const MeasureInput& input) {
    const std::vector<double> opacity = featureOpacities(input.tf);
    std::vector<char> drawn;
    for (const double x : opacity) drawn.push_back(x > 0);
    if (std::ranges::none_of(drawn, [](char d) { return d != 0; })) drawn.assign(drawn.size(), 1);
    return RayBundle(*input.volume, input.tf, input.view, 96).appearances({input.tf}, drawn).front().alpha;
}

/// [i][j]: the part of the visibility of feature i that feature j takes away: one sweep with each and one without.
OcclusionMatrix occlusionByDefinition(const MeasureInput& input) {
    const auto engine = makeEngine(EngineChoice::Cpu, input.volume, input.settings.quality);
    const auto visibilityOf = [&](const TransferFunction& tf) {
        return engine->sums(input.view, {&tf, 1}, nullptr).front().visibility;
    };
    const std::vector<double> opacity = featureOpacities(input.tf), with = visibilityOf(input.tf);
    const std::size_t n = opacity.size();
    OcclusionMatrix matrix(n, std::vector<double>(n, 0.0));
    for (std::size_t j = 0; j < n; ++j) {
        std::vector<double> others = opacity;
        others[j] = 0;
        const std::vector<double> without = visibilityOf(withFeatureOpacities(input.tf, others));
        for (std::size_t i = 0; i < n; ++i)
            if (i != j && without[i] > 0) matrix[i][j] = std::max(0.0, 1 - with[i] / without[i]);
    }
    return matrix;
}

/// The largest parts from 10 % on, two at most.
void checkHides(const std::vector<SaidNumbers::Hiding>& said, const OcclusionMatrix& measured,
                const std::vector<Feature>& features) {
    const auto indexOf = [&](const std::string& name) {
        return static_cast<std::size_t>(std::ranges::find(features, name, &Feature::name) - features.begin());
    };
    std::vector<double> parts;
    for (const auto& row : measured)
        for (const double part : row)
            if (part >= 0.1) parts.push_back(part);
    std::ranges::sort(parts, std::greater{});
    REQUIRE(said.size() == std::min<std::size_t>(2, parts.size()));
    for (std::size_t n = 0; n < said.size(); ++n) {
        INFO(said[n].hider << " hides " << said[n].hidden);
        const double part = measured.at(indexOf(said[n].hidden)).at(indexOf(said[n].hider));
        CHECK(part == Approx(parts[n]));
        checkSaid(said[n].part, part);
    }
}

} // namespace

TEST_CASE("captions of 100 random scenes say the numbers that are measured", "[caption]") {
    const TempFolder folder;
    int withShares = 0, withHides = 0, withHidden = 0, lit = 0, parallel = 0;
    for (std::uint32_t number = 0; number < 100; ++number) {
        const Scene scene = randomScene(number, folder);
        const MeasureInput input = measureInput(scene);
        // As `describe` and `render --caption` do.
        Workspace workspace;
        Measures figures = workspace.measure(input);
        figures.coverage = workspace.coverage(input);
        const std::string text = caption(captionFacts(scene, figures, workspace.occlusion(input)));
        const SaidNumbers said = numbersIn(text);
        CAPTURE(number, text);
        REQUIRE(said.numbers == std::ranges::count(text, '%')); // there is none that nobody looks at

        // Measured anew, and what it is the sentence should speak of.
        Workspace another;
        const std::vector<FeatureMeasures> measured = another.measure(input).features;
        const std::vector<Feature>& features = scene.tf.features;
        std::vector<std::size_t> drawn;
        std::vector<std::string> hidden, empty;
        for (std::size_t f = 0; f < features.size(); ++f)
            if (features[f].hidden)
                hidden.push_back(features[f].name);
            else if (scene.isEmpty(f))
                empty.push_back(features[f].name);
            else
                drawn.push_back(f);
        lit += scene.session.display->light.on;
        parallel += scene.camera.projection == Projection::Orthographic;
        withHidden += !hidden.empty();
        CHECK((text.find(", lit") != std::string::npos) == scene.session.display->light.on);
        if (std::ranges::none_of(measured, [](const FeatureMeasures& m) { return m.visibility > 0; })) {
            CHECK_THAT(text, Catch::EndsWith(". Nothing is visible."));
            CHECK(said.numbers == 0);
            continue;
        }
        ++withShares;
        // Up to five features are named, and all of these have at most five.
        REQUIRE(said.order.size() == drawn.size());
        CHECK_FALSE(said.others);
        for (const std::size_t f : drawn) {
            INFO(features[f].name);
            REQUIRE(said.shares.count(features[f].name) == 1);
            const SaidNumbers::Shares& shares = said.shares.at(features[f].name);
            checkSaid(shares.vws, measured[f].vws);
            checkSaid(shares.visibility, measured[f].visibility);
        }
        std::ranges::stable_sort(drawn, std::greater{}, [&](std::size_t f) { return measured[f].vws; });
        for (std::size_t n = 0; n < drawn.size(); ++n) CHECK(said.order[n] == features[drawn[n]].name);
        REQUIRE(said.coverage);
        checkSaid(*said.coverage, coverageByDefinition(input));
        checkHides(said.hides, occlusionByDefinition(input), features);
        withHides += !said.hides.empty();
        CHECK((text.find("Not drawn: " + listed(hidden)) != std::string::npos) == !hidden.empty());
        CHECK((text.find("Not in these data: " + listed(empty)) != std::string::npos) == !empty.empty());
    }
    // What is compared occurs.
    CHECK(withShares >= 80);
    CHECK(withHides >= 20);
    CHECK(withHidden >= 20);
    CHECK((lit > 20 && lit < 80));
    CHECK((parallel > 10 && parallel < 90));
}

TEST_CASE("directions are named as people say them", "[caption]") {
    // Of a file: the front is the side of low y, left that of low x.
    CHECK(directionWords({0, -1, 0}, WorldAxes::File) == "from the front");
    CHECK(directionWords({0, 5, 0}, WorldAxes::File) == "from behind");
    CHECK(directionWords({-1, 0, 0}, WorldAxes::File) == "from the left");
    CHECK(directionWords({0, 0, 1}, WorldAxes::File) == "from above");
    CHECK(directionWords({0, 0, -1}, WorldAxes::File) == "from below");
    // The patient's left is at +x, his front (anterior) at −y.
    CHECK(directionWords({1, 0, 0}, WorldAxes::Patient) == "from the patient's left");
    CHECK(directionWords({-1, 0, 0}, WorldAxes::Patient) == "from the patient's right");
    CHECK(directionWords({0, -1, 0}, WorldAxes::Patient) == "from the front");
    // 20 degrees aside are none of the side's: 70 degrees from it. 30 degrees are.
    CHECK(directionWords({std::sin(0.35), -std::cos(0.35), 0}, WorldAxes::File) == "from the front");
    CHECK(directionWords({0.5, -std::sqrt(3) / 2, 0}, WorldAxes::File) == "from the front and the right");
    CHECK(directionWords({0.6, -0.5, 0.62}, WorldAxes::File) == "from above, the right and the front");
}

TEST_CASE("a caption says view, shares, what hides what, and what is left out", "[caption]") {
    CaptionFacts facts;
    facts.title = "tooth";
    facts.from = "from the right";
    facts.lit = true;
    facts.features = {feature("dentine", 0.4, 0.383), feature("enamel", 0.48, 0.52), feature("pulp", 0.0004, 0.001)};
    facts.features.push_back({"bone", 0, 0, CaptionFeature::State::Hidden});
    facts.features.push_back({"metal", 0, 0, CaptionFeature::State::Empty});
    facts.hides = {"dentine hides 83 % of pulp"};
    facts.coverage = 0.63;
    CHECK(caption(facts) == "From the right, lit: tooth. Enamel has 48 % of the saliency and 52 % of what is visible; "
                            "dentine 40 % and 38 %; "
                            "pulp < 0.1 % and 0.1 %. Where there is something to see, the picture is 63 % opaque. "
                            "Dentine hides 83 % of pulp. Not drawn: bone. Not in these data: metal.");
    CHECK(altText(facts) == "From the right, lit: tooth, mostly enamel (48 % of the saliency) and dentine (40 %).");
    facts.frame = "t = 3 s";
    facts.cut = true;
    CHECK_THAT(caption(facts), StartsWith("From the right, lit, cut open: tooth, t = 3 s. Enamel"));
    facts.mode = RenderMode::Mip; // which shows no features
    CHECK(caption(facts) == "From the right, the largest value along each ray, lit, cut open: tooth, t = 3 s.");
    facts.mode = RenderMode::Composite;
    for (CaptionFeature& f : facts.features) f.vws = f.visibility = 0;
    CHECK(caption(facts) == "From the right, lit, cut open: tooth, t = 3 s. Nothing is visible.");
    facts = {};
    facts.title = "empty";
    facts.from = "from above";
    CHECK(caption(facts) == "From above: empty.");
}

TEST_CASE("a caption of a feature that is drawn alone speaks of no other", "[caption]") {
    CaptionFacts facts;
    facts.title = "tooth";
    facts.from = "from the right";
    facts.alone = "dentine";
    facts.features = {feature("dentine", 0.4, 0.383)};
    CHECK(caption(facts) ==
          "From the right: tooth, dentine alone. Where all features are drawn, dentine has 40 % of the "
          "saliency and 38 % of what is visible.");
    CHECK(altText(facts) == "From the right: tooth, dentine alone.");
    // The others hide all of it, but they are not there.
    facts.features.front().vws = facts.features.front().visibility = 0;
    CHECK_THAT(caption(facts), !Contains("Nothing is visible"));
    facts.features.front().state = CaptionFeature::State::Hidden;
    CHECK(caption(facts) == "From the right: tooth, dentine alone. Not drawn: dentine.");
    facts.mode = RenderMode::Mip;
    CHECK(caption(facts) == "From the right, the largest value along each ray: tooth, dentine alone.");
}

TEST_CASE("what is said of a scene is what it draws", "[caption]") {
    const TempFolder folder;
    std::uint32_t number = 0;
    Scene scene = randomScene(number, folder);
    while (scene.tf.features.size() < 2) scene = randomScene(++number, folder);
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    Measures measures = workspace.measure(input);
    measures.coverage = workspace.coverage(input);
    CHECK(captionFacts(scene, measures).features.size() == scene.tf.features.size());
    scene.session.display.edit([&](DisplaySettings& d) { d.onlyFeature = scene.tf.features[1].id; });
    const CaptionFacts facts = captionFacts(scene, measures, workspace.occlusion(input));
    CHECK(facts.alone == "beryl"); // the second of the names
    REQUIRE(facts.features.size() == 1);
    CHECK(facts.features.front().name == "beryl");
    CHECK(facts.features.front().vws == measures.features[1].vws);
    CHECK(facts.hides.empty());
    CHECK_FALSE(facts.coverage);
}

TEST_CASE("in captions of random figures each number is the one that it speaks of", "[caption]") {
    std::mt19937 random(28);
    std::uniform_real_distribution<double> share(0, 1);
    for (int scene = 0; scene < 100; ++scene) {
        CaptionFacts facts;
        facts.title = "volume";
        facts.from = "from the front";
        facts.coverage = share(random);
        const int count = 1 + static_cast<int>(random() % 9);
        double sum = 0;
        for (int f = 0; f < count; ++f) {
            facts.features.push_back(feature("f" + std::to_string(f), share(random), share(random)));
            sum += facts.features.back().vws;
        }
        for (CaptionFeature& f : facts.features) f.vws /= sum;
        std::vector<CaptionFeature> order = facts.features;
        std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.vws > b.vws; });
        std::vector<std::string> expected;
        const std::size_t named = count <= 5 ? order.size() : 4; // one left over is named, too
        for (std::size_t n = 0; n < named; ++n) {
            expected.push_back(percentText(order[n].vws));
            expected.push_back(percentText(order[n].visibility));
        }
        if (named < order.size()) {
            double vws = 0, visibility = 0;
            for (std::size_t n = named; n < order.size(); ++n) {
                vws += order[n].vws;
                visibility += order[n].visibility;
            }
            expected.push_back(percentText(vws));
            expected.push_back(percentText(visibility));
            CHECK_THAT(caption(facts), Contains(std::to_string(count - 4) + " others"));
        }
        expected.push_back(percentText(*facts.coverage));
        CAPTURE(caption(facts));
        REQUIRE(percentsIn(caption(facts)) == expected);
    }
}
