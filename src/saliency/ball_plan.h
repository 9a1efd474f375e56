// How the sums over both balls of a saliency are made (ball_sums.h), and what normalises them.
#pragma once

#include <array>
#include <vector>

#include "saliency/appearance.h"
#include "saliency/ball_sums.h"

namespace pellucid {

/// The balls of centre and surround.
using BallPair = std::array<BallKernel, 2>;
BallPair ballsOf(const Geometry& geometry, const SaliencyOptions& options);

/// The plan for rows of `stride` floats.
class BallPlan {
public:
    BallPlan(const BallPair& balls, std::ptrdiff_t stride);
    BallPlan(const BallPlan&) = delete;
    BallPlan& operator=(const BallPlan&) = delete;

    const BallSumsPlan& sums() const noexcept { return m_sums; }

private:
    std::vector<ZStep> m_zSteps;
    std::vector<YProfile> m_profiles;
    std::vector<YTap> m_yTaps;
    std::array<std::vector<XTap>, 2> m_xTaps;
    BallSumsPlan m_sums; ///< points into the others
};

/// Σ weights of a ball over the voxels inside a volume, per voxel. Away from the volume's sides it is always the same.
class BallNorm {
public:
    BallNorm(const BallKernel& ball, const Int3& dims);
    /// Of the ball around voxel (x, y, z).
    double at(int x, int y, int z) const;

private:
    const BallKernel& m_ball;
    Int3 m_dims;
    std::vector<double> m_before; ///< Σ g(dx) over −reach ≤ dx < i − reach
};

} // namespace pellucid
