// docs/method.md, "Tolerances", on random cases, for any engine.
#pragma once

#include <catch2/catch.hpp>

#include <array>
#include <memory>
#include <vector>

#include "support/disagreement.h"
#include "support/random_cases.h"

namespace pellucid::test {

/// makeEngine(volume, quality); the first `count` random cases, both qualities.
template <class MakeEngine>
void checkRandomCases(const MakeEngine& makeEngine, std::uint32_t count) {
    constexpr std::array kQualities{std::pair{Quality::Normal, kNormalTolerances},
                                    std::pair{Quality::High, kHighTolerances}};
    std::array<std::vector<double>, kQualities.size()> visibility, vws;
    for (std::uint32_t n = 0; n < count; ++n) {
        const RandomCase c = randomCase(n);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const Grid<float> expected = makeReferenceEngine(c.volume)->field(c.camera, c.tf).values;
        for (std::size_t q = 0; q < kQualities.size(); ++q) {
            const auto& [quality, allowed] = kQualities[q];
            const std::unique_ptr<VisibilityEngine> engine = makeEngine(c.volume, quality);
            const Disagreement d = compareWithField(expected, *engine, c.camera, c.tf, weights);
            INFO(c.describe() << (quality == Quality::High ? ", quality high" : ""));
            CHECK(d.visibilityRms <= allowed.visibilityRms);
            CHECK(d.visibility <= allowed.figure);
            CHECK(d.vws <= allowed.figure);
            visibility[q].push_back(d.visibility);
            vws[q].push_back(d.vws);
        }
    }
    for (std::size_t q = 0; q < kQualities.size(); ++q) {
        INFO("quality " << (q == 0 ? "normal" : "high"));
        CHECK(median(visibility[q]) <= kQualities[q].second.median);
        CHECK(median(vws[q]) <= kQualities[q].second.median);
    }
}

} // namespace pellucid::test
