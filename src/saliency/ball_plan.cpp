#include "saliency/ball_plan.h"

#include <algorithm>
#include <map>

namespace pellucid {

namespace {

/// Half-heights h of a ball, [|dx|][|dy|]: its voxels there are those of |dz| ≤ h; −1 where there are none.
std::vector<std::vector<int>> halfHeights(const BallKernel& ball) {
    std::vector<std::vector<int>> heights(ball.weights[0].size(), std::vector<int>(ball.weights[1].size(), -1));
    for (const KernelRun& run : ball.runs)
        for (int dx = 0; dx <= run.halfWidth && run.dy >= 0; ++dx) {
            int& height = heights[static_cast<std::size_t>(dx)][static_cast<std::size_t>(run.dy)];
            height = std::max(height, run.dz);
        }
    return heights;
}

} // namespace

BallPair ballsOf(const Geometry& geometry, const SaliencyOptions& options) {
    return {BallKernel(geometry, options.sigma, options.kernel),
            BallKernel(geometry, 2 * options.sigma, options.kernel)};
}

BallPlan::BallPlan(const BallPair& balls, std::ptrdiff_t stride) {
    const auto weight = [&](std::size_t ball, int axis, int distance) {
        return static_cast<float>(
            balls[ball].weights[static_cast<std::size_t>(axis)][static_cast<std::size_t>(distance)]);
    };
    m_zSteps.assign(static_cast<std::size_t>(balls[1].reach(2)) + 1, ZStep{{0, 0}, {-1, -1}});
    int zSums = 0;
    for (std::size_t b = 0; b < 2; ++b) {
        const BallKernel& ball = balls[b];
        const std::vector<std::vector<int>> heights = halfHeights(ball);
        for (int dz = 0; dz <= ball.reach(2); ++dz) m_zSteps[static_cast<std::size_t>(dz)].weight[b] = weight(b, 2, dz);
        const auto sumOffset = [&](int half) {
            int& sum = m_zSteps[static_cast<std::size_t>(half)].sum[b];
            if (sum < 0) sum = zSums++;
            return sum * stride;
        };
        std::map<std::vector<int>, std::ptrdiff_t> offsetOf;
        for (int dx = 0; dx <= ball.reach(0); ++dx) {
            const std::vector<int>& profile = heights[static_cast<std::size_t>(dx)];
            const auto [known, isNew] =
                offsetOf.try_emplace(profile, static_cast<std::ptrdiff_t>(m_profiles.size()) * stride);
            if (isNew) {
                const int firstTap = static_cast<int>(m_yTaps.size());
                for (int dy = 1; dy <= ball.reach(1) && profile[static_cast<std::size_t>(dy)] >= 0; ++dy)
                    m_yTaps.push_back({dy, sumOffset(profile[static_cast<std::size_t>(dy)]), weight(b, 1, dy)});
                m_profiles.push_back({sumOffset(profile[0]), firstTap, static_cast<int>(m_yTaps.size())});
            }
            if (dx == 0)
                m_sums.xMiddle[b] = known->second;
            else
                m_xTaps[b].push_back({known->second - 2 * dx, known->second + 2 * dx, weight(b, 0, dx)});
        }
        m_sums.zReach[b] = ball.reach(2);
        m_sums.xTaps[b] = m_xTaps[b].data();
        m_sums.xTapCount[b] = static_cast<int>(m_xTaps[b].size());
    }
    m_sums.stride = stride;
    m_sums.zSteps = m_zSteps.data();
    m_sums.zSumCount = zSums;
    m_sums.profiles = m_profiles.data();
    m_sums.profileCount = static_cast<int>(m_profiles.size());
    m_sums.yTaps = m_yTaps.data();
    m_sums.xReach = balls[1].reach(0);
}

BallNorm::BallNorm(const BallKernel& ball, const Int3& dims) : m_ball(ball), m_dims(dims) {
    m_before.push_back(0);
    for (int dx = -ball.reach(0); dx <= ball.reach(0); ++dx)
        m_before.push_back(m_before.back() + ball.weights[0][static_cast<std::size_t>(std::abs(dx))]);
}

double BallNorm::at(int x, int y, int z) const {
    double sum = 0;
    for (const KernelRun& run : m_ball.runs) {
        if (y + run.dy < 0 || y + run.dy >= m_dims.y || z + run.dz < 0 || z + run.dz >= m_dims.z) continue;
        const int first = std::max(-run.halfWidth, -x), last = std::min(run.halfWidth, m_dims.x - 1 - x);
        sum += m_ball.weight(0, run.dy, run.dz) * (m_before[static_cast<std::size_t>(last + 1 + m_ball.reach(0))] -
                                                   m_before[static_cast<std::size_t>(first + m_ball.reach(0))]);
    }
    return sum;
}

} // namespace pellucid
