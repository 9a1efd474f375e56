// What live refinement of an edit begins with.
#include <catch2/catch.hpp>

#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_live.h"

using namespace pellucid;

namespace {

/// Points at the quarters of the intensity, of these opacities.
TransferFunction quarters(const std::vector<double>& opacities) {
    TransferFunction tf;
    for (std::size_t i = 0; i < opacities.size(); ++i) {
        ControlPoint point;
        point.x = 0.25 * static_cast<double>(i);
        point.opacity = opacities[i];
        tf.points.push_back(point);
    }
    return tf;
}

/// As many voxels of each intensity.
Histogram even() {
    Histogram histogram;
    std::fill(histogram.counts.begin(), histogram.counts.end(), 1);
    return histogram;
}

} // namespace

TEST_CASE("the points that an edit has set are held, all of them none", "[refine]") {
    const TransferFunction before = quarters({0.1, 0.2, 0.3, 0.2, 0.1});
    CHECK(heldPoints(before, before).empty());
    CHECK(heldPoints(before, quarters({0.1, 0.6, 0.3, 0.2, 0.1})) == std::vector<std::size_t>{1});
    CHECK(heldPoints(before, quarters({0.2, 0.4, 0.6, 0.4, 0.2})).empty());

    TransferFunction added = before; // one more than there were
    added.points.insert(added.points.begin() + 1, added.points[1]);
    added.points[1].x = 0.1;
    added.points[1].opacity = 0.5;
    CHECK(heldPoints(before, added) == std::vector<std::size_t>{1});

    TransferFunction fixed = quarters({0.1, 0.6, 0.3, 0.2, 0.1});
    fixed.points[1].fixed = true; // held already
    CHECK(heldPoints(before, fixed).empty());
}

TEST_CASE("the other points give way, by no more than a factor", "[refine]") {
    const TransferFunction before = quarters({0.1, 0.2, 0.3, 0.2, 0.2});
    const TransferFunction after = quarters({0.1, 0.4, 0.3, 0.2, 0.2});
    const TransferFunction start = liveStart(even(), before, after, {1});
    CHECK(start.points[1].fixed);
    CHECK(start.points[1].opacity == 0.4);
    // 0.2 more there: of the others' 0.8 are left 0.6.
    CHECK(start.points[0].opacity == Approx(0.75 * 0.1));
    CHECK(start.points[2].opacity == Approx(0.75 * 0.3));
    CHECK_FALSE(start.points[0].fixed);

    const TransferFunction most = liveStart(even(), before, quarters({0.1, 1, 0.3, 0.2, 0.2}), {1});
    CHECK(most.points[2].opacity == Approx(0.25 * 0.3)); // nothing would be left of them: a quarter is
    CHECK(liveStart(even(), before, after, {}) == after);
}

TEST_CASE("refinement comes out another way where points have moved, and by colours where those count", "[refine]") {
    const TransferFunction before = quarters({0.1, 0.2, 0.3});
    TransferFunction colored = before;
    colored.points[1].color = {1, 0, 0};
    CHECK_FALSE(refinesOtherwise(before, before, true));
    CHECK_FALSE(refinesOtherwise(before, colored, false));
    CHECK(refinesOtherwise(before, colored, true));
    CHECK(refinesOtherwise(before, quarters({0.1, 0.2, 0.4}), false));
    CHECK(refinesOtherwise(before, quarters({0.1, 0.2}), false));
}
