// One front-to-back sweep over the volume that carries several candidate transfer functions in SIMD lanes: what the
// cpu engine hands to its kernel. Plain data, so that the kernel can be compiled once per instruction set.
//
// Slices are the voxel planes across the axis along which rays cross most voxels, k = 0 the nearest to the eye. (u, v,
// w) are voxel coordinates with w across the slices, growing away from the eye. Rays are fixed through the slices: ray
// (a, b) meets the plane w at u = baseU(w) + a·scale(w), v = baseV(w) + b·scale(w). Each ray keeps the optical depth ∫τ
// per candidate. A voxel of slice k needs it d0/2 in front of its centre (MEASURES §4): it follows the last slice
// distances along a line of its own and takes what lies before from the rays, interpolated once, so that nothing is
// resampled from slice to slice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid {

inline constexpr int kSweepLanes = 8;             ///< candidates of one sweep
inline constexpr std::uint8_t kTransparent = 255; ///< in SweepInput::featureOfCode: opacity 0 in every candidate

/// How far the elements of neighbouring voxels lie apart.
struct SweepStrides {
    std::ptrdiff_t u = 1, v = 0, w = 0;
};

/// Pointers are to the voxel u = v = 0 of the nearest slice.
struct SweepInput {
    int lanes = kSweepLanes; ///< kSweepLanes or 1: the innermost dimension of the tables

    // The volume.
    int nu = 0, nv = 0, nw = 0;
    const std::uint16_t* codes = nullptr; ///< codeStrides.u is 1
    SweepStrides codeStrides;
    const std::uint8_t* valid = nullptr;          ///< null where every voxel is valid; fieldStrides
    const float* weights[2] = {nullptr, nullptr}; ///< null: no weighted sums; fieldStrides
    float* field = nullptr;                       ///< one lane only: where v goes, zero before; null: not wanted
    SweepStrides fieldStrides;

    // The transfer functions.
    int tableSize = 0;                           ///< of depthTable
    float tableEntryOfCode = 0;                  ///< (tableSize − 1) / maxCode
    const float* depthTable = nullptr;           ///< [tableSize][lanes], −ln(1 − α)
    const float* integralTable = nullptr;        ///< [tableSize][lanes], its integral from entry 0
    const int* opaqueBefore = nullptr;           ///< [tableSize + 1], entries before this one with any τ > 0
    const float* alphaTable = nullptr;           ///< [maxCode + 1][lanes], α
    const std::uint8_t* featureOfCode = nullptr; ///< [maxCode + 1]; `features` for "in none", or kTransparent
    int features = 0;

    // The rays.
    bool perspective = false;
    double slopeU = 0, slopeV = 0;       ///< orthographic: du/dw, dv/dw of every ray
    double eyeU = 0, eyeV = 0, eyeW = 0; ///< perspective: the eye, eyeW < −1/2
    double raySpacing = 1;               ///< of the rays, in voxels; perspective: at most
    double firstSlopeStep = 1;     ///< perspective: slope between neighbouring rays at slice 0; halved further away
    double hu = 1, hv = 1, hw = 1; ///< spacing in d0
    double maxStep = 1.0;          ///< distance of samples along a ray between voxel planes, in d0
    int ownSlices = 1;             ///< slice distances right in front of voxels followed along lines of their own
};

/// The rays b in [first, last], and the voxel rows that lie in [first, last) between them; in units of the first ray
/// grid. The outermost bands take everything beyond their outer edge too.
struct SweepBand {
    int first = 0, last = 0;
    bool outermostLow = false, outermostHigh = false;
};

/// Memory that a band works in, kept between bands.
class SweepScratch {
public:
    float* floats(int slot, std::size_t count); ///< at least `count`, contents kept only while it need not grow
    int* ints(int slot, std::size_t count);

private:
    std::vector<float> m_floats[9];
    std::vector<int> m_ints[3];
};

/// Sums of one band: double[features + 1][3][lanes], the last feature being "in none"; added to.
using SweepKernel = void (*)(const SweepInput& input, const SweepBand& band, SweepScratch& scratch, double* sums);

/// The bands of a sweep: depends on the input alone, never on threads.
std::vector<SweepBand> sweepBands(const SweepInput& input);

/// The best kernel for this processor.
SweepKernel sweepKernel(int lanes);

// One per instruction set (sweep_generic.cpp, sweep_avx2.cpp).
void sweepGeneric8(const SweepInput&, const SweepBand&, SweepScratch&, double*);
void sweepGeneric1(const SweepInput&, const SweepBand&, SweepScratch&, double*);
void sweepAvx2x8(const SweepInput&, const SweepBand&, SweepScratch&, double*);
void sweepAvx2x1(const SweepInput&, const SweepBand&, SweepScratch&, double*);

} // namespace pellucid
