// The inner loops of saliency (docs/method.md, "Saliency"): weighted sums over the two balls around voxels, for rows of
// voxels. Plain data, so that the loops can be compiled once per instruction set.
//
// Rows hold both attributes of their voxels in turn, brightness first: float[2·voxels]. A ball's weights are a product
// over the axes; only its outline couples them: at (dx, dy) it holds the voxels |dz| ≤ h(dx, dy). So the sums along z
// are made first, one per ball and half-height h that occurs; then along y one per *profile*, the half-heights of one
// dx, which several dx share; last along x. For σ = 2 and cubic voxels that is 4 sums, 4 profiles and about 40 vector
// operations, where the balls have 278 voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pellucid {

/// One step outward along z, from |dz| − 1 to |dz|: the weights of the two balls there, and the index of the sum that
/// is complete with it, −1 where none is. Balls are 0 the centre and 1 the surround.
struct ZStep {
    float weight[2];
    int sum[2];
};
/// Two rows at the same |dy|: a z-sum of each, times `weight`. Offsets are floats.
struct YTap {
    int dy;
    std::ptrdiff_t offset; ///< of the sum, from the row's first one
    float weight;
};
/// Σ_dy g(dy)·sum: the sum at `offset` for dy = 0, whose weight is 1, and taps [firstTap, endTap) of yTaps.
struct YProfile {
    std::ptrdiff_t offset;
    int firstTap, endTap;
};
/// Two voxels at the same |dx|: their profile, times `weight`.
struct XTap {
    std::ptrdiff_t before, after; ///< of the profile's floats at −|dx| and +|dx|
    float weight;
};
struct BallSumsPlan {
    std::ptrdiff_t stride = 0;     ///< floats between the sums (profiles) of one row
    const ZStep* zSteps = nullptr; ///< [zReach[1] + 1], |dz| from 0
    int zReach[2] = {0, 0};        ///< of the centre ≤ of the surround
    int zSumCount = 0;
    const YProfile* profiles = nullptr;
    int profileCount = 0;
    const YTap* yTaps = nullptr;
    std::ptrdiff_t xMiddle[2] = {0, 0}; ///< offset of the profile at dx = 0 of each ball
    const XTap* xTaps[2] = {nullptr, nullptr};
    int xTapCount[2] = {0, 0};
    int xReach = 0; ///< voxels
};

/// One (dy, dz) of a ball for the direct sum: weights[h + dx], |dx| ≤ h.
struct DirectRun {
    const float* row;
    int halfWidth;
    const float* weights;
};

/// What turns sums into weights, per float of a row: w1 / (Σ weights inside the volume · unit of the 16 bits).
struct RowScales {
    const float* centre;
    const float* surround;
};

/// Ranges are floats of a row, multiples of kRangeFloats; rows begin at addresses of multiples of 64 bytes.
struct BallSumsKernel {
    static constexpr int kRangeFloats = 32; ///< 16 voxels

    /// Sums along z over [from, to) widened by xReach: out[sum·stride + x] from rows[dz], |dz| ≤ zReach[1].
    void (*sumAlongZ)(const BallSumsPlan&, const float* const* rows, int from, int to, float* out);
    /// The packed weights of a row in [from, to): out[x / 2] = |centre − surround|. zSums[dy] is what sumAlongZ made of
    /// row y + dy; `scratch` has profileCount·stride floats.
    void (*packRow)(const BallSumsPlan&, const float* const* zSums, const RowScales& scales, int from, int to,
                    float* scratch, std::uint32_t* out);
    /// The same by plain sums over runs along x.
    void (*packRowDirect)(const DirectRun* const* runs, const int* runCounts, const RowScales& scales, int from, int to,
                          std::uint32_t* out);
};

/// Those that this processor can run, the best first.
std::span<const BallSumsKernel* const> ballSumsKernels();
const BallSumsKernel& ballSumsKernel(); ///< the best

// One per instruction set (ball_sums_*.cpp).
extern const BallSumsKernel kBallSumsGeneric;
extern const BallSumsKernel kBallSumsAvx2;
extern const BallSumsKernel kBallSumsAvx512;

} // namespace pellucid
