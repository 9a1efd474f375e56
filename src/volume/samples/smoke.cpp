// Smoke by Stam's stable fluids with vorticity confinement (Fedkiw et al. 2001): semi-Lagrangian transport, buoyancy,
// and a projection that leaves a flow without sources.
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "volume/noise.h"
#include "volume/samples/cubic_zoom.h"
#include "volume/samples/time_samples.h"

namespace pellucid {

namespace {

constexpr Int3 kCells{36, 36, 72};

/// A closed box of air, open at the top. Lengths are cells, times frames.
class SmokeSolver {
public:
    explicit SmokeSolver(std::uint32_t seed) : m_seed(seed) {
        for (Grid<float>& v : m_velocity) v = Grid<float>(kCells);
        m_density = m_heat = m_pressure = m_divergence = Grid<float>(kCells);
    }

    const Grid<float>& density() const { return m_density; }

    void step(int frame) {
        addSource(frame);
        addForces();
        project();
        transport();
    }

private:
    using Cell = std::array<int, 3>;

    static std::size_t indexOf(int i, int j, int k) { return voxelIndex(kCells, i, j, k); }

    /// Calls body(i, j, k, index) for every cell; slices on any thread, so that it writes to its own cell alone.
    template <class Body>
    static void forEachCell(const Body& body) {
        parallelFor(static_cast<std::size_t>(kCells.z), [&](std::size_t slice) {
            const int k = static_cast<int>(slice);
            for (int j = 0; j < kCells.y; ++j)
                for (int i = 0; i < kCells.x; ++i) body(i, j, k, indexOf(i, j, k));
        });
    }

    static float at(const Grid<float>& grid, int i, int j, int k) {
        return grid[indexOf(std::clamp(i, 0, kCells.x - 1), std::clamp(j, 0, kCells.y - 1),
                            std::clamp(k, 0, kCells.z - 1))];
    }

    static float sample(const Grid<float>& grid, float x, float y, float z) {
        x = std::clamp(x, 0.0f, static_cast<float>(kCells.x) - 1.001f);
        y = std::clamp(y, 0.0f, static_cast<float>(kCells.y) - 1.001f);
        z = std::clamp(z, 0.0f, static_cast<float>(kCells.z) - 1.001f);
        const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
        const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j), fz = z - static_cast<float>(k);
        const std::size_t c = indexOf(i, j, k), dy = static_cast<std::size_t>(kCells.x),
                          dz = dy * static_cast<std::size_t>(kCells.y);
        const auto along = [&](std::size_t n) { return grid[n] + fx * (grid[n + 1] - grid[n]); };
        const auto plane = [&](std::size_t n) { return along(n) + fy * (along(n + dy) - along(n)); };
        return plane(c) + fz * (plane(c + dz) - plane(c));
    }

    /// A hot disk near the bottom that flickers, and wanders a little.
    void addSource(int frame) {
        const float phase = 0.09f * static_cast<float>(frame);
        const float cx = 0.5f * kCells.x + 2.2f * std::sin(phase), cy = 0.5f * kCells.y + 2.2f * std::cos(0.8f * phase);
        forEachCell([&](int i, int j, int k, std::size_t n) {
            if (k < 2 || k > 4) return;
            const float dx = static_cast<float>(i) - cx, dy = static_cast<float>(j) - cy;
            const float r = std::sqrt(dx * dx + dy * dy);
            if (r > 6) return;
            const auto flicker =
                static_cast<float>(0.75 + 0.35 * smoothNoise({0.45 * i, 0.45 * j, 0.16 * frame}, m_seed));
            const float amount = std::clamp(flicker * (1.15f - r / 6), 0.0f, 1.0f);
            m_density[n] = std::max(m_density[n], amount);
            m_heat[n] = std::max(m_heat[n], amount);
        });
    }

    void addForces() {
        // Curl first: the strength of confinement follows its magnitude.
        Grid<float> size(kCells);
        std::array<Grid<float>, 3> curl{Grid<float>(kCells), Grid<float>(kCells), Grid<float>(kCells)};
        const auto slope = [&](int component, int axis, int i, int j, int k) {
            Cell up{i, j, k}, down{i, j, k};
            ++up[static_cast<std::size_t>(axis)];
            --down[static_cast<std::size_t>(axis)];
            const Grid<float>& v = m_velocity[static_cast<std::size_t>(component)];
            return 0.5f * (at(v, up[0], up[1], up[2]) - at(v, down[0], down[1], down[2]));
        };
        forEachCell([&](int i, int j, int k, std::size_t n) {
            const float x = slope(2, 1, i, j, k) - slope(1, 2, i, j, k);
            const float y = slope(0, 2, i, j, k) - slope(2, 0, i, j, k);
            const float z = slope(1, 0, i, j, k) - slope(0, 1, i, j, k);
            curl[0][n] = x;
            curl[1][n] = y;
            curl[2][n] = z;
            size[n] = std::sqrt(x * x + y * y + z * z);
        });
        constexpr float kBuoyancy = 0.16f, kWeight = 0.02f, kConfinement = 0.22f;
        forEachCell([&](int i, int j, int k, std::size_t n) {
            m_velocity[2][n] += kBuoyancy * m_heat[n] - kWeight * m_density[n];
            const float gx = at(size, i + 1, j, k) - at(size, i - 1, j, k);
            const float gy = at(size, i, j + 1, k) - at(size, i, j - 1, k);
            const float gz = at(size, i, j, k + 1) - at(size, i, j, k - 1);
            const float length = std::sqrt(gx * gx + gy * gy + gz * gz);
            if (length < 1e-6f) return;
            const float e = kConfinement / length;
            m_velocity[0][n] += e * (gy * curl[2][n] - gz * curl[1][n]);
            m_velocity[1][n] += e * (gz * curl[0][n] - gx * curl[2][n]);
            m_velocity[2][n] += e * (gx * curl[1][n] - gy * curl[0][n]);
        });
    }

    /// Takes the gradient of a pressure away that makes the flow free of sources, found by Jacobi's steps from that of
    /// the frame before.
    void project() {
        const auto flow = [&](int component, int i, int j, int k) { // none through walls
            if (i < 0 || j < 0 || k < 0 || i >= kCells.x || j >= kCells.y) return 0.0f;
            return at(m_velocity[static_cast<std::size_t>(component)], i, j, k);
        };
        forEachCell([&](int i, int j, int k, std::size_t n) {
            m_divergence[n] = 0.5f * (flow(0, i + 1, j, k) - flow(0, i - 1, j, k) + flow(1, i, j + 1, k) -
                                      flow(1, i, j - 1, k) + flow(2, i, j, k + 1) - flow(2, i, j, k - 1));
        });
        const auto pressure = [](const Grid<float>& p, int i, int j, int k) { // 0 above the top
            return k >= kCells.z ? 0.0f : at(p, i, j, k);
        };
        Grid<float> next(kCells);
        constexpr int kSteps = 24;
        for (int step = 0; step < kSteps; ++step) {
            forEachCell([&](int i, int j, int k, std::size_t n) {
                const float sum = pressure(m_pressure, i + 1, j, k) + pressure(m_pressure, i - 1, j, k) +
                                  pressure(m_pressure, i, j + 1, k) + pressure(m_pressure, i, j - 1, k) +
                                  pressure(m_pressure, i, j, k + 1) + pressure(m_pressure, i, j, k - 1);
                next[n] = (sum - m_divergence[n]) / 6;
            });
            std::swap(next, m_pressure);
        }
        forEachCell([&](int i, int j, int k, std::size_t n) {
            const auto difference = [&](int di, int dj, int dk) {
                return 0.5f *
                       (pressure(m_pressure, i + di, j + dj, k + dk) - pressure(m_pressure, i - di, j - dj, k - dk));
            };
            m_velocity[0][n] -= difference(1, 0, 0);
            m_velocity[1][n] -= difference(0, 1, 0);
            m_velocity[2][n] -= difference(0, 0, 1);
        });
    }

    /// Everything comes from where the flow carries it from.
    void transport() {
        std::array<Grid<float>, 3> velocity{Grid<float>(kCells), Grid<float>(kCells), Grid<float>(kCells)};
        Grid<float> density(kCells), heat(kCells);
        constexpr float kThinning = 0.996f, kCooling = 0.985f, kDrag = 0.998f;
        forEachCell([&](int i, int j, int k, std::size_t n) {
            // By the middle of the way, so that swirls keep their shape.
            const auto x = static_cast<float>(i), y = static_cast<float>(j), z = static_cast<float>(k);
            const float hx = x - 0.5f * m_velocity[0][n], hy = y - 0.5f * m_velocity[1][n],
                        hz = z - 0.5f * m_velocity[2][n];
            const float px = x - sample(m_velocity[0], hx, hy, hz), py = y - sample(m_velocity[1], hx, hy, hz),
                        pz = z - sample(m_velocity[2], hx, hy, hz);
            for (std::size_t a = 0; a < 3; ++a) velocity[a][n] = kDrag * sample(m_velocity[a], px, py, pz);
            density[n] = kThinning * sample(m_density, px, py, pz);
            heat[n] = kCooling * sample(m_heat, px, py, pz);
        });
        m_velocity = std::move(velocity);
        m_density = std::move(density);
        m_heat = std::move(heat);
    }

    std::uint32_t m_seed;
    std::array<Grid<float>, 3> m_velocity;
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
