#include <catch2/catch.hpp>

#include <numeric>

#include "support/random_tfs.h"
#include "tf/shown_tf.h"

using namespace pellucid;

TEST_CASE("what is hidden is transparent, and nothing else changes", "[shown]") {
    test::Random random(21);
    for (int i = 0; i < 200; ++i) {
        const TransferFunction tf = test::randomTf(random);
        const TransferFunction shown = shownTf(tf);
        REQUIRE_NOTHROW(shown.validate());
        CHECK(shown.features == tf.features);
        for (int k = 0; k <= 2000; ++k) {
            const double x = k / 2000.0 + (k < 2000 ? 1e-6 : 0); // off the grid on which ends lie
            const int f = featureAt(tf.features, x);
            const bool hidden = f >= 0 && tf.features[static_cast<std::size_t>(f)].hidden;
            REQUIRE(shown.opacity(x) == Approx(hidden ? 0 : tf.opacity(x)).margin(1e-9));
        }
    }
}

TEST_CASE("a function without hidden features is shown as it is", "[shown]") { CHECK(shownTf(tents(4)) == tents(4)); }

TEST_CASE("opacities found for what is shown leave hidden features theirs", "[shown]") {
    TransferFunction tf = tents(3, 0.5);
    tf.features[1].hidden = true;
    const TransferFunction changed = withShownOpacities(tf, {0.25, 0.75, 1});
    CHECK(featureOpacities(changed) == std::vector<double>{0.25, 0.5, 1});
    CHECK(featureOpacities(shownTf(changed)) == std::vector<double>{0.25, 0, 1});
}

TEST_CASE("shares of hidden features go to the others", "[shown]") {
    TransferFunction tf = tents(3);
    CHECK(shownShares(tf, {0.2, 0.3, 0.5}) == std::vector<double>{0.2, 0.3, 0.5});
    tf.features[2].hidden = true;
    const std::vector<double> shares = shownShares(tf, {0.2, 0.3, 0.5});
    CHECK(shares[0] == Approx(0.4)); // 0.2 / (0.2 + 0.3)
    CHECK(shares[1] == Approx(0.6));
    CHECK(shares[2] == 0);
    CHECK(shownShares(tf, {0, 0, 1}) == std::vector<double>{0.5, 0.5, 0});
    for (Feature& f : tf.features) f.hidden = true;
    CHECK(shownShares(tf, {0.2, 0.3, 0.5}) == std::vector<double>{0, 0, 0});
}
