#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "volume/noise.h"
#include "volume/samples/cubic_zoom.h"
#include "volume/samples/time_samples.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr int kCoarse = 56; ///< voxels of the grid that waves are added up on
constexpr int kWaves = 40;
constexpr double kTurn = 2 * std::numbers::pi;

/// sin(2π·turns) from a table, right to 1e-6: waves are added up millions of times.
class SineTable {
public:
    SineTable() {
        for (std::size_t i = 0; i < m_values.size(); ++i)
            m_values[i] = static_cast<float>(std::sin(kTurn * static_cast<double>(i) / kSteps));
    }
    float operator()(float turns) const {
        const float at = (turns - std::floor(turns)) * kSteps;
        const auto i = static_cast<std::size_t>(at);
        return m_values[i] + (at - static_cast<float>(i)) * (m_values[i + 1] - m_values[i]);
    }

private:
    static constexpr int kSteps = 4096;
    std::array<float, kSteps + 2> m_values{};
};

/// One wave of vorticity: amplitude · sin(2π(k·p + phase)), p in the unit box; k ⟂ amplitude, so that none flows out.
struct Wave {
    glm::vec3 k, amplitude;
    float phase = 0;
};

class Dice {
public:
    explicit Dice(std::uint32_t seed) : m_seed(seed) {}
    double next() { // [0, 1)
        return static_cast<double>(hashOf(m_count++, 17, 31, m_seed) >> 11) / 9007199254740992.0;
    }
    double between(double a, double b) { return a + (b - a) * next(); }

private:
    std::uint32_t m_seed;
    std::int64_t m_count = 0;
};

/// The waves of a moment, t in [0,1] over all frames.
std::vector<Wave> wavesAt(double t, std::uint32_t seed) {
    Dice dice(seed);
    std::vector<Wave> waves;
    double energy = 0;
    while (waves.size() < kWaves) {
        const Vec3 k(std::round(dice.between(-6.5, 6.5)), std::round(dice.between(-6.5, 6.5)),
                     std::round(dice.between(-6.5, 6.5)));
        const double length = glm::length(k);
        const Vec3 random(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1));
        const double phase = dice.next(), drift = dice.between(-1, 1), swell = dice.next();
        if (length < 1.5 || length > 6.5) continue;
        const Vec3 across = glm::cross(k / length, random);
        if (glm::length(across) < 0.1) continue;
        // Large waves carry most; small ones turn over faster and fade first; each swells and ebbs a little.
        const double strength = std::pow(length, -0.9) * std::exp(-0.012 * length * length * t) *
                                (1 + 0.35 * std::sin(kTurn * (0.8 * t + swell)));
        waves.push_back({glm::vec3(k), glm::vec3(glm::normalize(across) * strength),
                         static_cast<float>(phase + 0.32 * drift * std::pow(length, 2.0 / 3) * t)});
        energy += strength * strength;
    }
    // What drives the flow keeps its energy.
    const auto scale = static_cast<float>(1 / std::sqrt(energy));
    for (Wave& wave : waves) wave.amplitude *= scale;
    return waves;
}

} // namespace

Volume makeVortex(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    static const SineTable s_sine;
    const double t = static_cast<double>(order.step) / (kVortexFrames - 1);
    const std::vector<Wave> waves = wavesAt(t, order.seed);
    Grid<float> coarse(Int3(kCoarse, kCoarse, kCoarse));
    forEachPlace(coarse.dims(), job, [&](const Int3& place, std::size_t index) {
        const auto unit = [](int n) { return static_cast<float>((n + 0.5) / kCoarse); };
        const float x = unit(place.x), y = unit(place.y), z = unit(place.z), time = static_cast<float>(t);
        // A larger flow carries everything along and draws it out into tubes.
        constexpr float kReach = 0.075f;
        const float px = x + kReach * (s_sine(y + 0.4f * time) + s_sine(2 * z - 0.3f * time)) + 0.15f * time;
        const float py = y + kReach * (s_sine(z + 0.25f + 0.3f * time) + s_sine(2 * x + 0.2f * time));
        const float pz = z + kReach * (s_sine(x + 0.6f - 0.35f * time) + s_sine(2 * y + 0.1f)) - 0.1f * time;
        glm::vec3 sum(0);
        for (const Wave& w : waves) sum += w.amplitude * s_sine(glm::dot(w.k, {px, py, pz}) + w.phase);
        coarse[index] = glm::dot(sum, sum);
    });
    // Its magnitude, drawn out so that strong vortices stand apart.
    const Grid<float> fine = cubicZoom(coarse, geometry.dims, true, job);
    std::vector<std::uint8_t> values(fine.size());
    constexpr float kScale = 90.0f;
    forEachPlace(geometry.dims, job, [&](const Int3&, std::size_t i) {
        const float squared = std::max(0.0f, fine[i]);
        values[i] = static_cast<std::uint8_t>(
            std::min(255.0f, kScale * std::sqrt(squared) * std::sqrt(std::sqrt(squared)) + 0.5f));
    });
    return Volume(geometry, SampleArray<std::uint8_t>(std::move(values))).withRange(kVortexRange);
}

} // namespace pellucid
