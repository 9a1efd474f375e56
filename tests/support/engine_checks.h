// What every visibility engine must satisfy, whichever it is.
#pragma once

#include <catch2/catch.hpp>

#include "render/visibility.h"
#include "support/disagreement.h"
#include "support/volumes.h"

namespace pellucid::test {

/// docs/method.md, "Visibility": v_k = α(1 − α)^k for the k-th voxel plane, along each axis from both ends, to 1e-4 per
/// voxel.
template <class MakeEngine>
void checkHomogeneousBlock(const MakeEngine& makeEngine) {
    const auto volume = slab({7, 6, 5}, 0.5, Vec3(1.5));
    const auto engine = makeEngine(volume);
    for (const double alpha : {0.0, 0.1, 0.5, 0.9, 1.0})
        for (int axis = 0; axis < 3; ++axis)
            for (const int sign : {1, -1}) {
                Vec3 direction(0);
                direction[axis] = sign;
                const Grid<float> v =
                    engine->field(lookingAlong(volume->geometry(), direction), homogeneous(alpha)).values;
                double worst = 0;
                for (int k = 0; k < 5; ++k)
                    for (int j = 0; j < 6; ++j)
                        for (int i = 0; i < 7; ++i) {
                            const Int3 at{i, j, k};
                            const int plane = sign > 0 ? at[axis] : volume->dims()[axis] - 1 - at[axis];
                            const double expected = alpha * std::pow(1 - std::min(alpha, 1 - 1e-7), plane);
                            worst = std::max(worst, std::abs(static_cast<double>(v.at(i, j, k)) - expected));
                        }
                INFO("alpha " << alpha << " axis " << axis << " sign " << sign);
                CHECK(worst < 1e-4);
            }
}

/// Along one axis of anisotropic voxels a step of s/d0 reference lengths lies between planes: the voxel behind m others
/// has light left of exp(−τ·(m·s + (s − d0)/2)): whole planes, and what its own and the first voxel hold before the
/// point d0/2 in front of its centre.
template <class MakeEngine>
void checkAnisotropicBlock(const MakeEngine& makeEngine) {
    const double alpha = 0.3;
    const auto volume = slab({4, 4, 6}, 0.5, Vec3(1, 1, 2.5));
    const Grid<float> v =
        makeEngine(volume)->field(lookingAlong(volume->geometry(), {0, 0, 1}), homogeneous(alpha)).values;
    for (int k = 0; k < 6; ++k)
        CHECK(v.at(1, 2, k) == Approx(alpha * std::pow(1 - alpha, k * 2.5 + 0.75)).margin(1e-4));
}

/// Invalid voxels in front of others hide nothing and show nothing; the corners that touch them count by their share.
///   plane 0, 1  invalid;  plane 2, 3  α = ½, seen along z from the side of plane 0
/// The share of valid corners is 0 up to z = 1, rises to 1 at z = 2 and stays there. Depths are in ln 2, what one d0 at
/// α = ½ absorbs, so that T = 0.5^depth:
///                                    plane 2, from z = 1.5     plane 3, from z = 2.5
///   as it should be                  ∫ share = 1/8: 0.4585     1/2 + 1/2 = 1: 0.25
///   the share is left out, z > 1     1/2:           0.3536     3/2:           0.1768
///   nothing is absorbed, z < 2       0:             0.5        1/2:           0.3536
///   the hole is filled, z > −0.5     2:             0.125      3:             0.0625
/// Shares are linear along a stretch, which is how the engines take them: only rounding is left.
template <class MakeEngine>
void checkInvalidVoxels(const MakeEngine& makeEngine) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto volume = volumeFrom(geometryOf({3, 3, 4}), [&](int, int, int k) { return k < 2 ? nan : 0.5f; });
    const Grid<float> v =
        makeEngine(volume)->field(lookingAlong(volume->geometry(), {0, 0, 1}), homogeneous(0.5)).values;
    CHECK(v.at(1, 1, 0) == 0);
    CHECK(v.at(1, 1, 1) == 0);
    CHECK(v.at(1, 1, 2) == Approx(0.5 * std::pow(0.5, 0.125)).margin(1e-4));
    CHECK(v.at(1, 1, 3) == Approx(0.25).margin(1e-4));
}

} // namespace pellucid::test
