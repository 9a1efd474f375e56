// Pictures of blocks on ranks against the picture of the same volume in one piece.
#include <catch2/catch.hpp>

#include <cmath>

#include "ranks/rank_renderer.h"
#include "ranks/rank_volume.h"
#include "render/ssim.h"
#include "support/random_cases.h"
#include "support/thread_ranks.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// The picture that each of so many ranks gets; that of rank `told` is returned.
Image drawnByRanks(const RandomCase& c, int count, const RenderSettings& settings, int told) {
    const Decomposition blocks(c.volume->dims(), count);
    Image picture;
    onRanks(count, [&](Communicator& ranks) {
        const auto volume = std::make_shared<const Volume>(
            volumeOfBlocks(ranks, blockOf(c.volume, blocks, ranks.rank(), Int3(kRayGhosts)), *c.volume));
        Image mine = makeRendererOnRanks(ranks, volume)->render(c.camera, c.tf, settings);
        if (ranks.rank() == told) picture = std::move(mine);
    });
    return picture;
}

double meanDifference(const Image& a, const Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        sum += std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
    return sum / static_cast<double>(a.rgba.size());
}

RenderSettings pictureSettings() {
    RenderSettings settings;
    settings.width = 96;
    settings.height = 70; // no multiple of the bands that ranks put together
    settings.finestInD0 = 1.0 / 32;
    settings.background = Rgb{0.1, 0.2, 0.3};
    settings.backgroundTop = Rgb{0.5, 0.4, 0.3};
    return settings;
}

} // namespace

TEST_CASE("ranks draw what one process draws", "[ranks]") {
    for (std::uint32_t number = 0; number < 24; ++number) {
        const RandomCase c = randomCase(number, 1, {number % 3 == 1, number % 4 >= 2, number % 4 == 3});
        INFO(c.describe());
        RenderSettings settings = pictureSettings();
        settings.clipping = c.clipping;
        settings.light.on = number % 2 == 1;
        settings.light.depthCue = number % 4 == 3 ? 0.5 : 0; // counts from the middle of the whole
        settings.light.silhouettes = number % 6 == 5 ? 0.5 : 0;
        const Image whole = makeCpuRenderer(c.volume)->render(c.camera, c.tf, settings);
        for (const int count : {2, 3, 8}) {
            INFO(count << " ranks");
            const Image picture = drawnByRanks(c, count, settings, count - 1);
            CHECK(ssim(whole, picture) > 0.999);
            CHECK(meanDifference(whole, picture) < 1e-3);
        }
    }
}

TEST_CASE("a picture of blocks without a background has the opacity of the whole", "[ranks]") {
    const RandomCase c = randomCase(3, 1);
    RenderSettings settings = pictureSettings();
    settings.background.reset();
    settings.backgroundTop.reset();
    const Image whole = makeCpuRenderer(c.volume)->render(c.camera, c.tf, settings);
    const Image picture = drawnByRanks(c, 5, settings, 0);
    double most = 0, opaque = 0;
    for (std::size_t i = 3; i < whole.rgba.size(); i += 4) {
        most = std::max(most, std::abs(static_cast<double>(whole.rgba[i]) - static_cast<double>(picture.rgba[i])));
        opaque = std::max(opaque, static_cast<double>(whole.rgba[i]));
    }
    CHECK(opaque > 0.05); // there is something to compare
    CHECK(most < 0.01);
}

TEST_CASE("ranks that all have the whole volume share the picture, to the bit", "[ranks]") {
    const RandomCase c = randomCase(2, 1);
    RenderSettings settings = pictureSettings();
    for (const RenderMode mode : {RenderMode::Composite, RenderMode::Mip}) {
        settings.mode = mode;
        const Image whole = makeCpuRenderer(c.volume)->render(c.camera, c.tf, settings);
        onRanks(3, [&](Communicator& ranks) {
            const Image mine = makeRendererOnRanks(ranks, c.volume)->render(c.camera, c.tf, settings);
            if (ranks.rank() == 1) CHECK(mine.rgba == whole.rgba);
        });
    }
}

TEST_CASE("what blocks do not draw by themselves is refused", "[ranks]") {
    const RandomCase c = randomCase(2, 1);
    RenderSettings settings = pictureSettings();
    settings.mode = RenderMode::Mip;
    CHECK_THROWS_AS(drawnByRanks(c, 2, settings, 0), UsageError);
    settings = pictureSettings();
    settings.light.occlusion = 0.5;
    CHECK_THROWS_AS(drawnByRanks(c, 2, settings, 0), UsageError);
}
