#include <catch2/catch.hpp>

#include "session/workspace.h"

using namespace pellucid;

namespace {

MeasureInput inputOf(std::shared_ptr<const Volume> volume, const TransferFunction& tf) {
    return {std::move(volume), tf, {}, {}};
}

} // namespace

TEST_CASE("saliency is computed again for colours and features, never for opacities", "[compute]") {
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 12 * 12 * 12; ++i) samples.push_back(static_cast<std::uint8_t>(i * 37 % 256));
    const auto volume =
        std::make_shared<const Volume>(Geometry{{12, 12, 12}, Vec3(1), Vec3(0)}, Samples(std::move(samples)));
    const TransferFunction tf = tents(3);
    Workspace cache;
    const WeightFields first = cache.weights(inputOf(volume, tf), {});
    CHECK(first == saliencyFields(*volume, tf));

    // A computation would hear that it should stop.
    std::stop_source stop;
    stop.request_stop();
    const JobControl stopped{stop.get_token(), {}};
    CHECK(cache.weights(inputOf(volume, withFeatureOpacities(tf, {0.1, 0.9, 0.0})), stopped) == first);
    TransferFunction renamed = tf;
    renamed.features[1].name = "other";
    CHECK(cache.weights(inputOf(volume, renamed), stopped) == first);

    TransferFunction moved = tf;
    moved.features[1].a += 0.01;
    TransferFunction recoloured = tf;
    for (ControlPoint& p : recoloured.points) p.color = {0.3, 0.5, 0.7};
    for (const TransferFunction& other : {moved, recoloured}) {
        CHECK_THROWS_AS(cache.weights(inputOf(volume, other), stopped), Cancelled);
        CHECK(cache.weights(inputOf(volume, other), {}) == saliencyFields(*volume, other));
    }
    // A stopped one leaves nothing behind that would be taken for finished.
    CHECK_THROWS_AS(cache.weights(inputOf(volume, tf), stopped), Cancelled);
    CHECK_THROWS_AS(cache.weights(inputOf(volume, tf), stopped), Cancelled);
    CHECK(cache.weights(inputOf(volume, tf), {}) == first);
    // The same samples in another volume.
    const auto other = std::make_shared<const Volume>(*volume);
    CHECK_THROWS_AS(cache.weights(inputOf(other, tf), stopped), Cancelled);
}
