// What every visibility engine must satisfy, whichever it is.
#pragma once

#include <catch2/catch.hpp>

#include <array>

#include <glm/matrix.hpp>

#include "render/visibility.h"
#include "support/disagreement.h"
#include "support/random_cases.h"
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

/// Small random cases of a variant against the reference: turned, mirrored and sheared grids, clipped boxes.
template <class MakeEngine>
void checkVariant(const MakeEngine& makeEngine, const Variant& variant, std::uint32_t cases,
                  const Tolerances& allowed) {
    // In so few voxels steps of d0/16 leave the reference off by 0.007 of FV (case 8: shells, opacity 1, 3.4 : 1).
    const int referenceSteps = allowed.figure < kNormalTolerances.figure ? 64 : 16;
    for (std::uint32_t n = 0; n < cases; ++n) {
        const RandomCase c = randomCase(n, 0.65, variant); // at most 31 voxels per axis
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const Disagreement d =
            compare(*makeReferenceEngine(c.volume, referenceSteps), *makeEngine(c.volume), c.view(), c.tf, weights);
        INFO(c.describe());
        CHECK(d.visibilityRms <= allowed.visibilityRms);
        CHECK(d.visibility <= allowed.figure);
        CHECK(d.vws <= allowed.figure);
    }
}
template <class MakeEngine>
void checkAffine(const MakeEngine& makeEngine, std::uint32_t cases, const Tolerances& allowed = kNormalTolerances) {
    checkVariant(makeEngine, {.affine = true, .clipped = false}, cases, allowed);
}
/// Grids along the world's axes and affine ones in turn.
template <class MakeEngine>
void checkClipping(const MakeEngine& makeEngine, std::uint32_t cases, const Tolerances& allowed = kNormalTolerances) {
    checkVariant(makeEngine, {.affine = false, .clipped = true}, cases / 2, allowed);
    checkVariant(makeEngine, {.affine = true, .clipped = true}, cases - cases / 2, allowed);
}
/// With a faint rest, clipped besides or not.
template <class MakeEngine>
void checkFaintRest(const MakeEngine& makeEngine, std::uint32_t cases, const Tolerances& allowed = kNormalTolerances) {
    checkVariant(makeEngine, {.affine = false, .clipped = false, .faint = true}, cases / 2, allowed);
    checkVariant(makeEngine, {.affine = true, .clipped = true, .faint = true}, cases - cases / 2, allowed);
}

/// A homogeneous block of α, cut across the view: what lies before the plane hides nothing. Seen along +z, kept from
/// z = c on, the voxel k ≥ c has light left of (1 − α)^(k − ½ − c), from the plane to ½ in front of its centre, or 1
/// where that point lies before the plane. Voxels exactly on the plane are kept, those before it have none.
/// Cut behind, the rest stays what it was: v_k = α(1 − α)^k. Where what lies before the plane is faint and keeps a part
/// r of its optical depth, the light has passed min(k − ½, c) + ½ of it besides: another (1 − α)^(r·that). Of that what
/// lies before z = 0.5 may be cut away.
template <class MakeEngine>
void checkClippedBlock(const MakeEngine& makeEngine) {
    const double alpha = 0.3;
    const auto volume = slab({5, 4, 7}, 0.5);
    const auto engine = makeEngine(volume);
    const auto expect = [&](const Clipping& clipping, const auto& expected) {
        for (const bool reversed : {false, true}) {
            const Camera camera = lookingAlong(volume->geometry(), {0, 0, 1});
            Clipping mirrored = clipping; // the same seen from behind
            View view(camera, clipping);
            if (reversed) {
                view.camera = lookingAlong(volume->geometry(), {0, 0, -1});
                for (ClipPlane& plane : mirrored.planes) plane = {-plane.normal, plane.offset - 6 * plane.normal.z};
                std::swap(mirrored.lo.z, mirrored.hi.z);
                mirrored.lo.z = 1 - mirrored.lo.z;
                mirrored.hi.z = 1 - mirrored.hi.z;
                for (ClipPlane& plane : mirrored.rest.within.planes)
                    plane = {-plane.normal, plane.offset - 6 * plane.normal.z};
                std::swap(mirrored.rest.within.lo.z, mirrored.rest.within.hi.z);
                mirrored.rest.within.lo.z = 1 - mirrored.rest.within.lo.z;
                mirrored.rest.within.hi.z = 1 - mirrored.rest.within.hi.z;
                view.clipping = mirrored;
            }
            const Grid<float> v = engine->field(view, homogeneous(alpha)).values;
            for (int k = 0; k < 7; ++k) {
                INFO("plane " << k << (reversed ? ", from behind" : ""));
                CHECK(v.at(2, 1, reversed ? 6 - k : k) == Approx(expected(k)).margin(1e-4));
            }
        }
    };
    const auto front = [&](double at) {
        return [=](int k) { return k < at ? 0.0 : alpha * std::pow(1 - alpha, std::max(0.0, k - 0.5 - at)); };
    };
    expect({{}, {1, 1, 1}, {{{0, 0, -2}, -2 * 2.25}}}, front(2.25)); // z ≥ 2.25
    expect({{}, {1, 1, 1}, {{{0, 0, -1}, -3}}}, front(3));           // through the centres of voxel plane 3
    expect({{0, 0, 3.0 / 7}, {1, 1, 1}, {}}, front(2.5));            // three of seven voxels away
    expect({{}, {1, 1, 1}, {{{0, 0, 1}, 4.0}}},                      // z ≤ 4
           [&](int k) { return k > 4 ? 0.0 : alpha * std::pow(1 - alpha, k); });
    const auto faintFront = [&](double at, double part, double begin = -0.5) {
        return [=](int k) {
            const double clear = std::max(0.0, k - 0.5 - at), faint = std::min(k - 0.5, at) - begin;
            return k < at ? 0.0 : alpha * std::pow(1 - alpha, clear + part * faint);
        };
    };
    const auto faint = [](const BoxPart& within, double density) {
        Clipping clipping;
        clipping.rest = {within, density};
        return clipping;
    };
    expect(faint({{}, {1, 1, 1}, {{{0, 0, -2}, -2 * 2.25}}}, 0.3), faintFront(2.25, 0.3));
    expect(faint({{0, 0, 3.0 / 7}, {1, 1, 1}, {}}, 0.05), faintFront(2.5, 0.05));
    expect(faint({{0, 0, 3.0 / 7}, {1, 1, 1}, {}}, 0), front(2.5)); // left out
    Clipping both = faint({{0, 0, 3.0 / 7}, {1, 1, 1}, {}}, 0.2);
    both.lo.z = 1.0 / 7;
    expect(both, faintFront(2.5, 0.2, 0.5));
    const View nothing(lookingAlong(volume->geometry(), {0, 0, 1}), {{}, {1, 1, 1}, {{{0, 0, 1}, -50}}});
    const TransferFunction tf = homogeneous(alpha);
    CHECK(engine->sums(nothing, {&tf, 1}, nullptr)[0].allVisibility == 0);
    const Grid<float> none = engine->field(nothing, tf).values;
    CHECK(std::all_of(none.begin(), none.end(), [](float v) { return v == 0; }));
    View allFaint(nothing.camera); // in no feature, either
    allFaint.clipping.rest = {nothing.clipping.part(), 0.5};
    CHECK(engine->sums(allFaint, {&tf, 1}, nullptr)[0].allVisibility == 0);
}

/// One anatomy stored in eight orientations, seen by the same camera in the world: two permutations of the axes and
/// three mirrored grids hold the same samples at the same places; one turned by 10° and two sheared by 15° hold others
/// of it. FV and W of all lie within `margin` of the first's.
template <class MakeEngine>
void checkOrientations(const MakeEngine& makeEngine, double margin) {
    // Three bells in the world, of three heights, of radius 4 to 6 (1/e): 0 beyond 13 but for less than 0.01.
    const auto anatomy = [](const Vec3& p) {
        const auto bell = [&](const Vec3& center, double radius, double height) {
            const Vec3 d = p - center;
            return height * std::exp(-glm::dot(d, d) / (radius * radius));
        };
        return std::min(1.0, bell({-2, 3, 1}, 6, 0.9) + bell({4, -4, -2}, 5, 0.6) + bell({-3, -5, 4}, 4, 0.35));
    };
    const double turn = 10 * 3.14159265358979 / 180, lean = 15 * 3.14159265358979 / 180;
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const std::array<std::pair<const char*, Mat3>, 8> orientations{{
        {"as the world", {x, y, z}},
        {"x mirrored", {-x, y, z}},
        {"y and z mirrored", {x, -y, -z}},
        {"axes permuted", {y, z, x}},
        {"axes permuted, all mirrored", {-z, -x, -y}},
        {"turned by 10 degrees", {std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x, z}},
        {"sheared by 15 degrees", {x, y, std::cos(lean) * z + std::sin(lean) * x}},
        {"sheared by 15 degrees, mirrored", {-x, std::cos(lean) * y + std::sin(lean) * z, z}},
    }};
    TransferFunction tf = tents(3, 0.12);
    std::vector<std::vector<FeatureMeasures>> first;
    for (const auto& [name, directions] : orientations) {
        Geometry geometry = geometryOf(Int3(36));
        geometry.directions = directions;
        geometry.origin = -(directions * Vec3(17.5)); // the middle of the box is the world's
        const auto volume =
            volumeFrom(geometry, [&](int i, int j, int k) { return anatomy(geometry.worldFromVoxel(Vec3(i, j, k))); });
        const auto engine = makeEngine(volume);
        const WeightFields weights = saliencyFields(*volume, tf);
        std::vector<std::vector<FeatureMeasures>> measures;
        for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
            Camera camera;
            camera.projection = projection;
            camera.eye = {45, -70, 35};
            camera.height = 60;
            Clipping clipping;
            clipping.planes = {{{1, -1, 0.5}, 4}};
            for (const View& view : {View(camera), View(camera, clipping)})
                measures.push_back(featureMeasures(engine->sums(view, {&tf, 1}, &weights)[0]));
        }
        if (first.empty()) first = measures;
        for (std::size_t view = 0; view < measures.size(); ++view)
            for (std::size_t f = 0; f < tf.features.size(); ++f) {
                INFO(name << ", view " << view << ", feature " << f);
                CHECK(measures[view][f].visibility == Approx(first[view][f].visibility).margin(margin));
                CHECK(measures[view][f].vws == Approx(first[view][f].vws).margin(margin));
            }
    }
}

} // namespace pellucid::test
