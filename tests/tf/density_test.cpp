#include <catch2/catch.hpp>

#include "support/random_tfs.h"
#include "tf/edit.h"
#include "tf/opacity.h"

using namespace pellucid;

TEST_CASE("density multiplies the extinction at every point", "[density]") {
    TransferFunction tf;
    for (const double opacity : {0.0, 0.19, 0.5, 0.75, 1.0}) tf.points.push_back({opacity, opacity, {}, false, {}});
    const TransferFunction dense = withDensity(tf, 2), thin = withDensity(tf, 0.5);
    // 1 − (1 − α)²: 0, 1 − 0.81² = 0.3439, 0.75, 1 − 1/16; 1 − √(1 − α): 0, 0.1, 1 − √½, 0.5. Opaque stays opaque.
    const double denser[] = {0, 0.3439, 0.75, 0.9375, 1}, thinner[] = {0, 0.1, 0.2928932188, 0.5, 1};
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(dense.points[i].opacity == Approx(denser[i]).margin(1e-12));
        CHECK(thin.points[i].opacity == Approx(thinner[i]).margin(1e-9));
    }
    CHECK(withDensity(tf, 1) == tf);
}

TEST_CASE("density goes there and back, and touches nothing else", "[density]") {
    test::Random random(3);
    for (int i = 0; i < 100; ++i) {
        const TransferFunction tf = test::randomTf(random);
        const double factor = std::exp2(random.between(-4, 4));
        const TransferFunction dense = withDensity(tf, factor);
        REQUIRE_NOTHROW(dense.validate());
        CHECK(dense.features == tf.features);
        for (std::size_t p = 0; p < tf.points.size(); ++p) {
            ControlPoint same = dense.points[p];
            same.opacity = tf.points[p].opacity;
            CHECK(same == tf.points[p]);
            if (tf.points[p].opacity < 0.5)
                CHECK(opticalDepthOfOpacity(dense.points[p].opacity) ==
                      Approx(factor * opticalDepthOfOpacity(tf.points[p].opacity)).epsilon(1e-6).margin(1e-12));
        }
        // Up to 16 times as dense, opacities below 0.5 stay below 1 − 2⁻¹⁶, far enough from 1 to come back.
        const TransferFunction back = withDensity(dense, 1 / factor);
        for (std::size_t p = 0; p < tf.points.size(); ++p)
            if (tf.points[p].opacity < 0.5) CHECK(back.points[p].opacity == Approx(tf.points[p].opacity).margin(1e-9));
    }
}
