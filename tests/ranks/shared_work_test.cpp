// Work that ranks divide: views, frames, and whatever each can do without the others.
#include <atomic>
#include <filesystem>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "optimize/views/view_search.h"
#include "ranks/process_ranks.h"
#include "ranks/rank_volume.h"
#include "render/cpu/cpu_engine.h"
#include "render/memory_needs.h"
#include "saliency/saliency_field.h"
#include "support/temp_folder.h"
#include "support/thread_ranks.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

SharedWork workOf(Communicator& ranks) {
    return {static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size()),
            [&ranks](std::span<const std::byte> bytes) { return ranks.gather(bytes); }};
}

/// Another engine, and how often it was asked.
class Counted final : public VisibilityEngine {
public:
    Counted(std::unique_ptr<VisibilityEngine> engine, int& calls) : m_engine(std::move(engine)), m_calls(calls) {}
    std::string name() const override { return m_engine->name(); }
    const Volume& volume() const override { return m_engine->volume(); }
    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        ++m_calls;
        return m_engine->sums(view, tfs, weights, job);
    }
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        return m_engine->jacobian(view, tf, weights, job);
    }
    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        return m_engine->field(view, tf, job);
    }

private:
    std::unique_ptr<VisibilityEngine> m_engine;
    int& m_calls;
};

/// A box that a plate hides from one side.
std::shared_ptr<const Volume> boxBehindPlate() {
    return volumeFrom(geometryOf(Int3(24)), [](int i, int j, int k) {
        const auto inside = [](int v, int lo, int hi) { return v >= lo && v < hi; };
        if (inside(i, 9, 15) && inside(j, 9, 15) && inside(k, 9, 15)) return 0.75;
        return inside(i, 4, 7) && inside(j, 2, 22) && inside(k, 2, 22) ? 0.25 : 0.0;
    });
}
TransferFunction twoTents() {
    TransferFunction tf;
    tf.points = {{0.1, 0, {0, 1, 0}, false, {}}, {0.25, 0.5, {0, 1, 0}, false, {}}, {0.4, 0, {1, 0, 0}, false, {}},
                 {0.6, 0, {1, 0, 0}, false, {}}, {0.75, 0.5, {1, 0, 0}, false, {}}, {0.9, 0, {1, 0, 0}, false, {}}};
    tf.features = {{"plate", 0.1, 0.4, {0, 1, 0}, {}}, {"box", 0.6, 0.9, {1, 0, 0}, {}}};
    return tf;
}

/// The rank of a group that is not there: nobody may ask it for anything.
class RankOfMany final : public Communicator {
public:
    int rank() const override { return 1; }
    int size() const override { return 3; }
    void await(const Work&) override { throw RankLost(); }
    std::vector<RankMessage> exchange(std::vector<RankMessage>) override { throw RankLost(); }
    void sum(std::span<double>) override { throw RankLost(); }
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte>) override { throw RankLost(); }
};

} // namespace

TEST_CASE("what ranks make together all of them have, in order, each thing made once", "[ranks]") {
    for (const std::size_t count : {0u, 1u, 2u, 7u}) {
        std::vector<std::atomic<int>> made(count);
        std::vector<std::vector<std::vector<double>>> of(3);
        onRanks(3, [&](Communicator& ranks) {
            of[static_cast<std::size_t>(ranks.rank())] = madeTogether(workOf(ranks), count, [&](std::size_t i) {
                ++made[i];
                return std::vector<double>(i, 1.0 / static_cast<double>(i + 3)); // of different lengths, 0 too
            });
        });
        INFO(count);
        for (const auto& all : of) {
            REQUIRE(all.size() == count);
            for (std::size_t i = 0; i < count; ++i)
                CHECK(all[i] == std::vector<double>(i, 1.0 / static_cast<double>(i + 3)));
        }
        for (const auto& times : made) CHECK(times == 1);
    }
}

TEST_CASE("ranks that divide the views find what one finds alone, bit by bit", "[ranks]") {
    const auto volume = boxBehindPlate();
    const TransferFunction tf = twoTents();
    const WeightFields weights = saliencyFields(*volume, tf);
    const ViewSubject subject{View(homeCamera(volume->geometry(), Projection::Perspective)), tf, {}};
    ViewMetric metric;
    metric.targets = {0.2, 0.8};
    const std::vector<OpacityLimits> limits(2);
    OptimizeOptions options;
    options.maxIterations = 2;
    constexpr int kViews = 52; // no multiple of what is looked at at once

    const auto engine = makeDraftEngine(volume);
    const ViewLevel level{*engine, weights};
    const ViewSearch search = searchViews(level, subject, metric, kViews);
    const std::vector<ReachableView> reachable = reachableViews(level, subject, search, limits, options);

    std::vector<ViewSearch> searches(3);
    std::vector<std::vector<ReachableView>> reached(3);
    std::vector<int> looks(3, 0);
    onRanks(3, [&](Communicator& ranks) {
        const auto r = static_cast<std::size_t>(ranks.rank());
        Counted counted(makeDraftEngine(volume), looks[r]);
        const ViewLevel divided{counted, weights, workOf(ranks)};
        searches[r] = searchViews(divided, subject, metric, kViews);
        const int before = looks[r];
        reached[r] = reachableViews(divided, subject, searches[r], limits, options);
        looks[r] = before;
    });
    CHECK(looks[0] + looks[1] + looks[2] == kViews);
    for (std::size_t r = 0; r < 3; ++r) {
        INFO(r);
        CHECK(looks[r] >= 17); // 52 = 48 + 4: 16 of the first, and 1 or 2
        CHECK(looks[r] <= 18);
        CHECK(searches[r].map.directions == search.map.directions);
        CHECK(searches[r].map.values == search.map.values);
        CHECK(searches[r].figures == search.figures);
        REQUIRE(reached[r].size() == reachable.size());
        for (std::size_t i = 0; i < reachable.size(); ++i) {
            CHECK(reached[r][i].camera == reachable[i].camera);
            CHECK(reached[r][i].opacity == reachable[i].opacity);
            CHECK(reached[r][i].objective == reachable[i].objective);
            CHECK(reached[r][i].seen == reachable[i].seen);
        }
    }
}

TEST_CASE("a rank that works alone asks no other, and keeps what it writes", "[ranks]") {
    const TempFolder folder;
    const auto isKept = [&](const std::string& name) {
        writeTextAtomically(folder.path(name), "text");
        return std::filesystem::exists(folder.path(name));
    };
    RankOfMany group;
    setRanksOfProcess(&group);
    CHECK(workOfProcess().part == 1);
    CHECK(workOfProcess().parts == 3);
    CHECK_FALSE(isKept("group")); // the first rank keeps it
    {
        const WorkAlone alone;
        CHECK(workOfProcess().parts == 1);
        CHECK(isKept("alone"));
        std::vector<double> values{1, 2};
        ranksOfProcess()->sum(values);
        CHECK(values == std::vector<double>{1, 2});
        CHECK(gatherValues(*ranksOfProcess(), 7) == std::vector<int>{7});
    }
    CHECK(ranksOfProcess() == &group);
    CHECK_FALSE(isKept("group again"));
    setRanksOfProcess(nullptr);
    CHECK(workOfProcess().parts == 1);
    CHECK(isKept("process"));
    {
        const WorkAlone alone; // which it is anyway
        CHECK(ranksOfProcess() == nullptr);
    }
}

TEST_CASE("frames are on each rank as a whole where there is room and they are divided", "[ranks]") {
    RankLayout layout;
    const Int3 large(200), small(100);
    const MemoryUse use = toMeasureAndDrawField();
    const std::uint64_t needed = bytesOf(use, large, SampleType::U16) + 4 * 2 * voxelCount(large);
    layout.roomForFrame = needed;
    CHECK(layout.isWhole(small, SampleType::U16, use, 4)); // too small for blocks
    CHECK(layout.isWhole(large, SampleType::U16, use, 1)); // no other rank
    CHECK_FALSE(layout.isWhole(large, SampleType::U16, use, 4));
    divideFrames(true);
    CHECK(layout.isWhole(large, SampleType::U16, use, 4));
    layout.roomForFrame = needed - 1;
    CHECK_FALSE(layout.isWhole(large, SampleType::U16, use, 4));
    divideFrames(false);
}
