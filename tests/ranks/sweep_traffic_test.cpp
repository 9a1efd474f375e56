// What ranks send against what the geometry of blocks and rays says that they do.
#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>

#include "ranks/rank_engine.h"
#include "ranks/sweep_traffic.h"
#include "support/thread_ranks.h"
#include "support/view_cases.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr int kLanes = 8;

std::shared_ptr<const Volume> knee(int size) {
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = size;
    return std::make_shared<const Volume>(loadHere(source));
}

/// The most that a rank has sent for one sweep of kLanes transfer functions.
Traffic counted(const std::shared_ptr<const Volume>& volume, int ranks, const Camera& camera) {
    // Faint, so that no ray is given up: each is followed through all blocks.
    std::vector<TransferFunction> tfs(kLanes, tents(3, 0.001));
    for (int n = 0; n < kLanes; ++n) tfs[static_cast<std::size_t>(n)].points[2].opacity = 1e-4 * (n + 1);
    const Decomposition blocks(volume->dims(), ranks);
    std::vector<Traffic> sent(static_cast<std::size_t>(ranks));
    onRanks(ranks, [&](Communicator& rank) {
        const auto engine = makeRankEngine(rank, blockOf(volume, blocks, rank.rank(), Int3(kRayGhosts)));
        const Traffic before = rank.traffic();
        engine->sums({camera, {}}, tfs, nullptr);
        Traffic& mine = sent[static_cast<std::size_t>(rank.rank())];
        mine.bytes = rank.traffic().bytes - before.bytes;
        mine.rounds = rank.traffic().rounds - before.rounds - 1; // without adding up what is in each feature, …
        const std::uint64_t all = rank.traffic().bytes;
        std::vector<double> sums(3 * kLanes * (tfs[0].features.size() + 1), 0.0);
        rank.sum(sums); // … which is done here once more
        mine.bytes -= rank.traffic().bytes - all;
    });
    Traffic most;
    for (const Traffic& t : sent) {
        most.bytes = std::max(most.bytes, t.bytes);
        most.rounds = std::max(most.rounds, t.rounds);
    }
    return most;
}

} // namespace

TEST_CASE("ranks send what blocks and rays predict", "[ranks][traffic]") {
    const auto volume = knee(160);
    for (const Camera& camera : viewCases(volume->geometry(), 0.75))
        for (const int ranks : {2, 3, 4, 8}) {
            INFO(ranks << " ranks, eye " << camera.eye.x << ", " << camera.eye.y << ", " << camera.eye.z);
            const Traffic sent = counted(volume, ranks, camera);
            const Traffic expected =
                expectedTraffic(volume->geometry(), Decomposition(volume->dims(), ranks), camera, kLanes);
            CHECK(sent.rounds == expected.rounds);
            CHECK(static_cast<double>(sent.bytes) == Approx(static_cast<double>(expected.bytes)).epsilon(0.1));
        }
}

// Rows of docs/scale.md: PELLUCID_SIZE=400 test_ranks "[.traffic]"
TEST_CASE("traffic of a larger volume", "[.traffic]") {
    const char* size = std::getenv("PELLUCID_SIZE");
    const auto volume = knee(size ? std::atoi(size) : 256);
    const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
    for (const int ranks : {2, 4, 8}) {
        const Traffic sent = counted(volume, ranks, camera);
        const Traffic expected =
            expectedTraffic(volume->geometry(), Decomposition(volume->dims(), ranks), camera, kLanes);
        std::printf("%d ranks: sent %.2f MB, expected %.2f MB, ratio %.3f, %d and %d rounds\n", ranks,
                    1e-6 * static_cast<double>(sent.bytes), 1e-6 * static_cast<double>(expected.bytes),
                    static_cast<double>(sent.bytes) / static_cast<double>(expected.bytes),
                    static_cast<int>(sent.rounds), static_cast<int>(expected.rounds));
    }
}
