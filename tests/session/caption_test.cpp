// Captions: every number in them is one that was measured.
#include "session/caption.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <regex>

#include "optimize/answer/visibility_words.h"

using namespace pellucid;
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

} // namespace

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

TEST_CASE("in captions of random scenes each number is the figure that it speaks of", "[caption]") {
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
