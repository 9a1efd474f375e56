#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "volume/noise.h"
#include "volume/samples/time_samples.h"

namespace pellucid {

namespace {

constexpr double kTop = 20000;          ///< of the box, m
constexpr std::uint32_t kLandSeed = 10; ///< added to that of the storm

/// Height of the land at (u, v) ∈ [0,1]² of the map, m; the coast runs from the south west to the north east.
double landHeight(double u, double v, std::uint32_t seed) {
    const double coast = v - 0.55 - 0.25 * u + 0.10 * smoothNoise({4 * u, 4 * v, 0.5}, seed) +
                         0.04 * smoothNoise({13 * u, 13 * v, 1.5}, seed);
    const double ridge = 1 - std::abs(smoothNoise({5 * (u + v), 9 * (v - u), 2.5}, seed + 1));
    const double hills = 0.55 * ridge * ridge + 0.25 * (1 + smoothNoise({16 * u, 16 * v, 3.5}, seed + 2)) / 2 +
                         0.2 * (1 + smoothNoise({40 * u, 40 * v, 4.5}, seed + 3)) / 2;
    return 1800 * smoothStep(0.0, 0.28, coast) * hills;
}

/// What the storm is like at a place of the map, seen from its eye.
struct Place {
    double r, wall, bands, noise; ///< distance in widths of the box, [0,1], [0,1], about [−1,1]
    double wind;                  ///< near the ground, m/s
};

class Storm {
public:
    explicit Storm(const SampleOrder& order)
        : m_seed(order.seed), m_t(static_cast<double>(order.step) / (kHurricaneFrames - 1)) {
        // From the open sea in the south east to the land in the north west, in a curve.
        m_u = 0.80 - 0.52 * m_t + 0.05 * std::sin(4 * m_t);
        m_v = 0.18 + 0.50 * m_t * (0.6 + 0.4 * m_t);
        const double over = landHeight(m_u, m_v, m_seed + kLandSeed) / 1800;
        m_strength = 0.75 + 0.25 * std::sin(std::numbers::pi * std::min(1.0, 1.4 * m_t)) - 0.5 * over;
    }

    Place at(double u, double v) const {
        const double dx = u - m_u, dy = v - m_v, r = std::sqrt(dx * dx + dy * dy);
        const double angle = std::atan2(dy, dx);
        const double turned = angle - 18 * m_t / (1 + 9 * r); // the core turns fastest
        Place p{r, 0, 0, 0, 0};
        const double fromWall = (r - 0.045) / 0.020;
        p.wall = std::exp(-fromWall * fromWall);
        const double spiral = std::cos(2 * (turned + 5.5 * std::log(0.06 + r)));
        p.bands = smoothStep(-0.1, 0.95, spiral) * std::exp(-r / 0.20) * smoothStep(0.03, 0.08, r);
        // Grain that turns with the storm.
        const double x = r * std::cos(turned), y = r * std::sin(turned);
        p.noise = 0.6 * smoothNoise({22 * x, 22 * y, 3 * m_t}, m_seed) +
                  0.4 * smoothNoise({55 * x, 55 * y, 6 * m_t}, m_seed + 1);
        const double s = r / 0.05;
        p.wind = 72 * m_strength * (s < 1 ? s : std::pow(s, -0.55)) * (1 + 0.10 * p.noise);
        return p;
    }

    double cloud(const Place& p, double w) const {
        // Towers in wall and bands, and a shield high above that flows out of them.
        const double tower = smoothStep(0.05, 0.2, w) * (1 - smoothStep(0.68, 0.82, w));
        const double shield =
            std::exp(-std::pow((w - 0.66) / 0.09, 2)) * std::exp(-p.r / 0.26) * smoothStep(0.02, 0.06, p.r);
        const double water =
            (0.95 * p.wall + 0.75 * p.bands) * tower * (0.75 + 0.45 * p.noise) + 0.38 * shield * (0.8 + 0.6 * p.noise);
        return kCloudRange.hi * std::clamp(m_strength * water, 0.0, 1.0);
    }

    double precipitation(const Place& p, double w) const {
        const double column = 1 - smoothStep(0.30, 0.50, w);
        const double rain = (1.05 * p.wall + 0.95 * p.bands * p.bands) * column * (0.7 + 0.55 * p.noise);
        return kPrecipitationRange.hi * std::clamp(m_strength * rain - 0.03, 0.0, 1.0);
    }

    double wind(const Place& p, double w) const {
        return std::clamp(p.wind * (1 - 0.75 * smoothStep(0.05, 0.9, w)) * smoothStep(-0.2, 0.04, w), 0.0,
                          kWindRange.hi);
    }

private:
    std::uint32_t m_seed;
    double m_t, m_u = 0, m_v = 0, m_strength = 1;
};

/// Calls body(i, j, u, v) for the columns of a grid, rows on any thread; (u, v) ∈ [0,1]² is where they lie on the map.
template <class Body>
void forEachColumn(const Int3& dims, const JobControl& job, const Body& body) {
    parallelFor(static_cast<std::size_t>(dims.y), [&](std::size_t row) {
        job.throwIfStopped();
        const int j = static_cast<int>(row);
        for (int i = 0; i < dims.x; ++i) body(i, j, (i + 0.5) / dims.x, (j + 0.5) / dims.y);
    });
}

Volume fillStorm(const Geometry& geometry, const SampleOrder& order, const ValueRange& range, const JobControl& job,
                 double (Storm::*valueAt)(const Place&, double) const) {
    const Storm storm(order);
    std::vector<float> values(voxelCount(geometry.dims));
    forEachColumn(geometry.dims, job, [&](int i, int j, double u, double v) {
        const Place place = storm.at(u, v);
        const double land = landHeight(u, v, order.seed + kLandSeed);
        for (int k = 0; k < geometry.dims.z; ++k) {
            const double w = (k + 0.5) / geometry.dims.z;
            values[voxelIndex(geometry.dims, i, j, k)] = w * kTop < land
                                                             ? std::numeric_limits<float>::quiet_NaN()
                                                             : static_cast<float>((storm.*valueAt)(place, w));
        }
    });
    return Volume(geometry, SampleArray<float>(std::move(values))).withRange(range);
}

} // namespace

Volume makeCloud(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    return fillStorm(geometry, order, kCloudRange, job, &Storm::cloud);
}

Volume makePrecipitation(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    return fillStorm(geometry, order, kPrecipitationRange, job, &Storm::precipitation);
}

Volume makeWind(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    return fillStorm(geometry, order, kWindRange, job, &Storm::wind);
}

Volume makeHurricaneGround(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    Geometry g = geometry;
    g.dims.z = 1; // whatever size it has
    std::vector<float> values(voxelCount(g.dims));
    forEachColumn(g.dims, job, [&](int i, int j, double u, double v) {
        values[voxelIndex(g.dims, i, j, 0)] = static_cast<float>(landHeight(u, v, order.seed + kLandSeed));
    });
    return Volume(g, SampleArray<float>(std::move(values))).withRange(kGroundRange);
}

} // namespace pellucid
