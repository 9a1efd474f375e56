// Smoke by Stam's stable fluids with vorticity confinement (Fedkiw et al. 2001): semi-Lagrangian transport, buoyancy,
// and a projection that leaves a flow without sources.
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "volume/noise.h"
#include "volume/samples/cubic_zoom.h"
#include "volume/samples/time_samples.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr Int3 kCells{36, 36, 72};

/// One cell along an axis.
Int3 stepAlong(int axis) { return {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0}; }

/// A closed box of air, open at the top. Lengths are cells, times frames.
class SmokeSolver {
public:
    explicit SmokeSolver(std::uint32_t seed)
        : m_seed(seed), m_velocity(kCells), m_density(kCells), m_heat(kCells), m_pressure(kCells),
          m_divergence(kCells) {}

    const Grid<float>& density() const { return m_density; }

    void step(int frame) {
        addSource(frame);
        addForces();
        project();
        transport();
    }

private:
    /// Calls body(cell, index) for every cell; slices on any thread, so that it writes to its own cell alone.
    template <class Body>
    static void forEachCell(const Body& body) {
        forEachPlace(kCells, {}, body);
    }

    template <class T>
    static T at(const Grid<T>& grid, const Int3& cell) {
        const Int3 inside = glm::clamp(cell, Int3(0), kCells - 1);
        return grid.at(inside.x, inside.y, inside.z);
    }

    /// Trilinear.
    template <class T>
    static T sample(const Grid<T>& grid, const glm::vec3& place) {
        const glm::vec3 inside = glm::clamp(place, glm::vec3(0), glm::vec3(kCells) - 1.001f);
        const Int3 cell(inside);
        const glm::vec3 f = inside - glm::vec3(cell);
        const std::size_t c = grid.index(cell.x, cell.y, cell.z), dy = static_cast<std::size_t>(kCells.x),
                          dz = layerSize(kCells);
        const auto along = [&](std::size_t n) { return grid[n] + f.x * (grid[n + 1] - grid[n]); };
        const auto plane = [&](std::size_t n) { return along(n) + f.y * (along(n + dy) - along(n)); };
        return plane(c) + f.z * (plane(c + dz) - plane(c));
    }

    /// A hot disk near the bottom that flickers, and wanders a little.
    void addSource(int frame) {
        const float phase = 0.09f * static_cast<float>(frame);
        const float cx = 0.5f * kCells.x + 2.2f * std::sin(phase), cy = 0.5f * kCells.y + 2.2f * std::cos(0.8f * phase);
        forEachCell([&](const Int3& c, std::size_t n) {
            if (c.z < 2 || c.z > 4) return;
            const float dx = static_cast<float>(c.x) - cx, dy = static_cast<float>(c.y) - cy;
            const float r = std::sqrt(dx * dx + dy * dy);
            if (r > 6) return;
            const auto flicker =
                static_cast<float>(0.75 + 0.35 * smoothNoise({0.45 * c.x, 0.45 * c.y, 0.16 * frame}, m_seed));
            const float amount = std::clamp(flicker * (1.15f - r / 6), 0.0f, 1.0f);
            m_density[n] = std::max(m_density[n], amount);
            m_heat[n] = std::max(m_heat[n], amount);
        });
    }

    void addForces() {
        // Curl first: the strength of confinement follows its magnitude.
        Grid<glm::vec3> curl(kCells);
        Grid<float> size(kCells);
        forEachCell([&](const Int3& c, std::size_t n) {
            const auto slope = [&](int axis) {
                return 0.5f * (at(m_velocity, c + stepAlong(axis)) - at(m_velocity, c - stepAlong(axis)));
            };
            const glm::vec3 alongX = slope(0), alongY = slope(1), alongZ = slope(2);
            curl[n] = {alongY.z - alongZ.y, alongZ.x - alongX.z, alongX.y - alongY.x};
            size[n] = glm::length(curl[n]);
        });
        constexpr float kBuoyancy = 0.16f, kWeight = 0.02f, kConfinement = 0.22f;
        forEachCell([&](const Int3& c, std::size_t n) {
            m_velocity[n].z += kBuoyancy * m_heat[n] - kWeight * m_density[n];
            glm::vec3 rise;
            for (int a = 0; a < 3; ++a) rise[a] = at(size, c + stepAlong(a)) - at(size, c - stepAlong(a));
            const float length = glm::length(rise);
            if (length >= 1e-6f) m_velocity[n] += kConfinement / length * glm::cross(rise, curl[n]);
        });
    }

    /// Takes the gradient of a pressure away that makes the flow free of sources, found by Jacobi's steps from that of
    /// the frame before.
    void project() {
        const auto flow = [&](const Int3& c) { // none through walls
            const bool isWall = c.x < 0 || c.y < 0 || c.z < 0 || c.x >= kCells.x || c.y >= kCells.y;
            return isWall ? glm::vec3(0) : at(m_velocity, c);
        };
        forEachCell([&](const Int3& c, std::size_t n) {
            float sum = 0;
            for (int a = 0; a < 3; ++a) sum = sum + flow(c + stepAlong(a))[a] - flow(c - stepAlong(a))[a];
            m_divergence[n] = 0.5f * sum;
        });
        const auto pressure = [&](const Int3& c) { // 0 above the top
            return c.z >= kCells.z ? 0.0f : at(m_pressure, c);
        };
        Grid<float> next(kCells);
        constexpr int kSteps = 24;
        for (int step = 0; step < kSteps; ++step) {
            forEachCell([&](const Int3& c, std::size_t n) {
                float sum = 0;
                for (int a = 0; a < 3; ++a) sum = sum + pressure(c + stepAlong(a)) + pressure(c - stepAlong(a));
                next[n] = (sum - m_divergence[n]) / 6;
            });
            std::swap(next, m_pressure);
        }
        forEachCell([&](const Int3& c, std::size_t n) {
            for (int a = 0; a < 3; ++a)
                m_velocity[n][a] -= 0.5f * (pressure(c + stepAlong(a)) - pressure(c - stepAlong(a)));
        });
    }

    /// Everything comes from where the flow carries it from.
    void transport() {
        Grid<glm::vec3> velocity(kCells);
        Grid<float> density(kCells), heat(kCells);
        constexpr float kThinning = 0.996f, kCooling = 0.985f, kDrag = 0.998f;
        forEachCell([&](const Int3& c, std::size_t n) {
            // By the middle of the way, so that swirls keep their shape.
            const glm::vec3 to(c), half = to - 0.5f * m_velocity[n], from = to - sample(m_velocity, half);
            velocity[n] = kDrag * sample(m_velocity, from);
            density[n] = kThinning * sample(m_density, from);
            heat[n] = kCooling * sample(m_heat, from);
        });
        m_velocity = std::move(velocity);
        m_density = std::move(density);
        m_heat = std::move(heat);
    }

    std::uint32_t m_seed;
    Grid<glm::vec3> m_velocity;
    Grid<float> m_density, m_heat, m_pressure, m_divergence;
};

/// The coarse densities of all frames so far, of the latest seed.
class SmokeFrames {
public:
    Grid<float> at(const SampleOrder& order, const JobControl& job) {
        const std::lock_guard lock(m_mutex);
        if (!m_solver || m_seed != order.seed) {
            m_solver.emplace(order.seed);
            m_seed = order.seed;
            m_frames.clear();
        }
        constexpr int kStepsPerFrame = 1, kBefore = 12; // the first frame shows something
        while (static_cast<int>(m_frames.size()) <= order.step) {
            job.throwIfStopped();
            const int frame = static_cast<int>(m_frames.size());
            for (int n = 0; n < (frame == 0 ? kBefore : kStepsPerFrame); ++n)
                m_solver->step(frame == 0 ? n - kBefore : frame);
            m_frames.push_back(m_solver->density());
        }
        return m_frames[static_cast<std::size_t>(order.step)];
    }

private:
    std::mutex m_mutex;
    std::uint32_t m_seed = 0;
    std::optional<SmokeSolver> m_solver;
    std::vector<Grid<float>> m_frames;
};

} // namespace

Volume makeSmoke(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    static SmokeFrames s_frames;
    const Grid<float> fine = cubicZoom(s_frames.at(order, job), geometry.dims, false, job);
    std::vector<float> values(fine.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::clamp(fine[i], 0.0f, 1.0f);
    return Volume(geometry, SampleArray<float>(std::move(values))).withRange(kSmokeRange);
}

} // namespace pellucid
