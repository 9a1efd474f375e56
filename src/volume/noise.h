// What built-in volumes are made of: smooth steps, and noise that depends on its place and a seed alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "volume/grid.h"

namespace pellucid {

/// A well mixed 64-bit number of a lattice point (multiply and shift rounds, so that neighbours share nothing).
inline std::uint64_t hashOf(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t seed) {
    std::uint64_t h = seed * 0x9e3779b97f4a7c15ull + 0x7f4a7c159e3779b9ull;
    for (const std::int64_t c : {i, j, k}) {
        h ^= static_cast<std::uint64_t>(c);
        h *= 0xd6e8feb86659fd93ull;
        h ^= h >> 32;
    }
    h *= 0xd6e8feb86659fd93ull;
    return h ^ (h >> 29);
}

/// White noise, mean 0, standard deviation 1: the sum of four uniform numbers, close to Gaussian within ±3.4.
inline double whiteNoise(int i, int j, int k, std::uint32_t seed) {
    const std::uint64_t h = hashOf(i, j, k, seed);
    const auto sum = static_cast<double>((h & 0xffff) + ((h >> 16) & 0xffff) + ((h >> 32) & 0xffff) + (h >> 48));
    constexpr double kMean = 2.0 * 65535.0;
    constexpr double kDeviation = 0.57735026918962576 * 65536.0; // sqrt(4 / 12)
    return (sum - kMean) / kDeviation;
}

/// 0 below a, 1 above b, smooth between.
inline double smoothStep(double a, double b, double x) {
    const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Value noise: random numbers in [−1, 1] on the integer lattice, joined smoothly (first derivative continuous).
inline double smoothNoise(const Vec3& p, std::uint32_t seed) {
    const auto lattice = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return static_cast<double>(hashOf(i, j, k, seed) >> 11) * (2.0 / 9007199254740992.0) - 1.0;
    };
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const double tx = ease(p.x - fx), ty = ease(p.y - fy), tz = ease(p.z - fz);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy), k = static_cast<std::int64_t>(fz);
    const auto alongX = [&](std::int64_t jj, std::int64_t kk) {
        const double a = lattice(i, jj, kk);
        return a + tx * (lattice(i + 1, jj, kk) - a);
    };
    const auto inPlane = [&](std::int64_t kk) {
        const double a = alongX(j, kk);
        return a + ty * (alongX(j + 1, kk) - a);
    };
    const double a = inPlane(k);
    return a + tz * (inPlane(k + 1) - a);
}

} // namespace pellucid
