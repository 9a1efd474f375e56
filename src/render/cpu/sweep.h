// One front-to-back sweep over the volume that carries several candidate transfer functions in SIMD lanes: what the
// cpu engine hands to its kernel. Plain data, so that the kernel can be compiled once per instruction set.
//
// Slices are the voxel planes across the axis along which rays cross most voxels, k = 0 the nearest to the eye. (u, v,
// w) are voxel coordinates with w across the slices, growing away from the eye. Rays are fixed through the slices: ray
// (a, b) meets the plane w at u = baseU(w) + a·scale(w), v = baseV(w) + b·scale(w). Each ray keeps the optical depth ∫τ
// per lane. A voxel of slice k needs it d0/2 in front of its centre (docs/method.md, "Visibility"): it follows the last
// slice distance along a line of its own and takes what lies before from the rays, interpolated once, so that nothing
// is resampled from slice to slice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

inline constexpr int kSweepLanes = 8;     ///< candidates of one sweep
inline constexpr int kJacobianLanes = 16; ///< of a sweep for derivatives: the depth itself and up to 15 of them
inline constexpr std::uint16_t kTransparent = 65535; ///< in SweepInput::featureOfCode: opacity 0 in every candidate
inline constexpr std::uint16_t kInvalidCode = 65535;
inline constexpr int kCodePadding = 16;     ///< codes that may be read behind the last voxel
inline constexpr int kMostSweepPlanes = 12; ///< sides of a part of the box, and oblique ones
inline constexpr int kBlockSize = 8;        ///< voxels along each edge of a block of the opaque map
/// Voxels: the rays around a voxel lie at most so far off along u and v on the slice in front of it.
inline constexpr double kRayMargin = 3;

enum class SweepMode {
    Single,  ///< one lane, one transfer function; writes the field if asked to
    Batch,   ///< kSweepLanes transfer functions
    Jacobian ///< lane 0: the depth D of one transfer function; lane 1 + j: ∂D/∂x_j
};
inline constexpr int lanesOf(SweepMode mode) {
    return mode == SweepMode::Single ? 1 : mode == SweepMode::Batch ? kSweepLanes : kJacobianLanes;
}

/// How far the elements of neighbouring voxels lie apart.
struct SweepStrides {
    std::ptrdiff_t u = 1, v = 0, w = 0;
};

/// The blocks first … last of a row; none where last < first.
struct SweepSpan {
    int first = 0, last = -1;
};

/// Voxels lo … hi − 1 along u, v and w; none where any hi ≤ lo.
struct SweepBox {
    int lo[3], hi[3];
};

/// Where stretches of rays count, u, v, w: those that end in [lo, hi), and that begin there too where `fromInside`.
struct SweepReach {
    double lo[3], hi[3];
    bool fromInside = false;
};

/// Rays (a, b), firstCol ≤ a < endCol, firstRow ≤ b < endRow, and numbers of each, [row][col][lanes that are kept].
struct SweepRect {
    int firstRow = 0, endRow = 0, firstCol = 0, endCol = 0;
    bool holds(int a, int b) const { return a >= firstCol && a < endCol && b >= firstRow && b < endRow; }
    std::size_t at(int a, int b, int lanes) const {
        return (static_cast<std::size_t>(b - firstRow) * static_cast<std::size_t>(endCol - firstCol) +
                static_cast<std::size_t>(a - firstCol)) *
               static_cast<std::size_t>(lanes);
    }
    std::size_t rays() const {
        return endRow > firstRow && endCol > firstCol ? at(0, endRow, 1) - at(0, firstRow, 1) : 0;
    }
};

/// The rays first ≤ a < end of a row.
struct RaySpan {
    int first = 0, end = 0;
};

/// Of rays that no voxel of a block asks for: exhausted.
inline constexpr float kUnknownDepth = 1e30f;

/// Rays are handed over where they enter the reach of another block: what they have met so far.
struct SweepHandover {
    SweepReach reach;
    SweepRect rect;          ///< the rays that the other wants
    float* depths = nullptr; ///< of rect; set for those that enter here
};

/// A half-space that is kept: u·U + v·V + w·W ≤ offset, the difference in d0.
struct SweepPlane {
    double u = 0, v = 0, w = 0, offset = 0;
    double beyond(double U, double V, double W) const { return u * U + v * V + w * W - offset; }
};

/// Pointers are to the voxel u = v = 0 of the nearest slice, also where that is not stored: of a block of a volume are
/// stored the voxels from firstU to lastU, along v and w those that its window and its reach touch.
struct SweepInput {
    SweepMode mode = SweepMode::Batch; ///< sets the innermost dimension of the tables, `lanes` below

    // The volume.
    int nu = 0, nv = 0, nw = 0;                ///< of the whole volume
    int firstU = 0, lastU = 0;                 ///< that are stored
    const std::uint16_t* codes = nullptr;      ///< codeStrides.u is 1; kInvalidCode where invalid
    const std::uint8_t* narrowCodes = nullptr; ///< in place of them, none invalid; codeStrides.u may be any
    SweepStrides codeStrides;
    bool someInvalid = false;
    const std::uint32_t* weights = nullptr;       ///< low half L_b, high half L_s; fieldStrides
    const std::uint8_t* compactWeights = nullptr; ///< in place of them, entries of weightOfByte; both null: no sums
    const std::uint32_t* weightOfByte = nullptr;  ///< [256], as `weights` are
    float* field = nullptr; ///< Single only: where v goes, zero before; null: not wanted; fieldStrides
    SweepStrides fieldStrides;
    /// Per block, a bit per lane that is opaque there or up to a voxel around (Jacobian: 255 if any is); opaqueStrides.
    const std::uint8_t* opaque = nullptr;
    SweepStrides opaqueStrides;
    const SweepSpan* opaqueSpans =
        nullptr; ///< per row of blocks, of the blocks that are opaque; opaqueSpans[row + spanStride·slice]
    std::ptrdiff_t spanStride = 0;
    int firstBlockU = 0, lastBlockU = 0; ///< of the opaque map that are there
    bool flipped = false; ///< w runs against the blocks: `opaque` points to the block of voxel 0 of the last slice

    // The transfer functions.
    float tableEntryOfCode = 0;                  ///< entries of integralTable per code
    const std::int32_t* integralTable = nullptr; ///< [entries + 1][lanes], Σ of τ·d0 before the entry, in units below
    const float* alphaTable = nullptr; ///< [maxCode + 1][lanes], α; Jacobian: [maxCode + 1][2], α and ∂α/∂x
    const std::uint16_t* featureOfCode = nullptr; ///< [65536]; `features` for "in none", or kTransparent
    int features = 0;
    float depthUnit[kJacobianLanes] = {}; ///< optical depth of one unit of integralTable
    float exhaustedDepth = 0;             ///< a ray is given up in the lanes whose depth exceeds this
    int firstDerivative = 0;              ///< Jacobian: the feature of lane 1

    // What is left of the volume.
    SweepPlane planes[kMostSweepPlanes];
    int planeCount = 0;
    double clipTie = 0;                       ///< voxels no farther than this beyond a plane are kept
    SweepPlane faintPlanes[kMostSweepPlanes]; ///< what lies beyond these is faint
    int faintCount = 0;
    float faintDensity = 0; ///< FaintRest::density

    SweepBox window{}; ///< the voxels that are measured

    // Of a block of a volume alone (docs/method.md, "Blocks of a volume").
    bool bounded = false; ///< `reach` says where rays go on, and these are given:
    int keptLanes = 0;    ///< of the depths below: the first of all lanes, which say what there is to say
    SweepReach reach{};
    const float* startDepths = nullptr; ///< of startRect: what rays have met before; null: nothing
    SweepRect startRect;
    /// What rays have met at their end, of endRect, where they are carried and nothing is measured; null: measure.
    float* endDepths = nullptr;
    SweepRect endRect;
    /// Per row of endRect and group of eight rays, counted from its first column; 0: not to be carried. Null: all are.
    const std::uint8_t* carried = nullptr;
    const SweepHandover* handovers = nullptr; ///< of rays that are carried
    int handoverCount = 0;

    // The rays.
    bool perspective = false;
    double slopeU = 0, slopeV = 0;       ///< orthographic: du/dw, dv/dw of every ray
    double eyeU = 0, eyeV = 0, eyeW = 0; ///< perspective: the eye; only voxels with w > eyeW are visited
    bool pyramid = false; ///< perspective: … and only those that lie no farther off along u and v than along w;
    bool ownsTieU = false, ownsTieV = false; ///< … or as far
    double raySpacing = 1;                   ///< of the rays, in voxels; perspective: at most
    /// The length in d0 of a difference Δ of voxel coordinates is √(Δᵀ·metric·Δ): guu … the entries of that symmetric
    /// matrix.
    double guu = 1, gvv = 1, gww = 1, guv = 0, guw = 0, gvw = 0;
    int stepsPerSlice = 1; ///< samples of a line per slice distance
    int ownSteps = 4;      ///< samples per slice distance of the lines of voxels that are followed all the way
    float tolerance = 1;   ///< transmittance: where neighbouring rays differ by more, voxels follow their own line
};

/// A part of a sweep that needs no other: the voxels of the slices [begin, end) that lie between the rows of rays
/// [firstRow, lastRow). The outermost ones take everything beyond their outer edge too.
struct SweepPiece {
    int begin = 0, end = 0;
    double slopeStep = 1; ///< perspective: slope between neighbouring rays
    int firstRow = 0, lastRow = 0;
    int firstRay = 0, lastRay = 0; ///< of a row, that voxels lie between
    bool outermostLow = false, outermostHigh = false;
};

/// Memory that a piece is worked on in, kept between pieces; aligned to 64 bytes.
class SweepScratch {
public:
    enum Slot { Accumulator, Depth, Entry, Share, Length, Stamp, Alive, Living, Met, Near, Far, Handing, kSlots };
    /// So many at least; contents are kept only while it need not grow.
    void* bytes(Slot slot, std::size_t count);

private:
    std::vector<unsigned char> m_memory[kSlots];
};

/// Sums of one piece: double[features + 1][3][lanes], the last feature being "in none"; added to.
/// [..][0] Σv, [1] and [2] Σ v times the 16-bit weights. Jacobian: lane 0 Σv…, lane 1 + j their derivatives.
using SweepKernel = void (*)(const SweepInput& input, const SweepPiece& piece, SweepScratch& scratch, double* sums);

/// Slices that share a grid of rays. Rays that diverge from a near eye start anew from the front of the box as soon as
/// they lie too far apart.
struct SweepLayer {
    int begin = 0, end = 0; ///< slices, all of the volume's that are visited once among the layers
    double slopeStep = 0;   ///< as SweepPiece
};
std::vector<SweepLayer> sweepLayers(const SweepInput& input);

/// The rays around the voxels of SweepInput::window in a layer; none where it has none there.
SweepRect raysAround(const SweepInput& input, const SweepLayer& layer);
/// The rays among raysAround() the whole volume that pass through `reach` within a layer.
SweepRect raysThrough(const SweepInput& input, const SweepLayer& layer, const SweepReach& reach);
/// The same of the row of rays `b`, and a ray more on either side, as far as they are in `among`.
RaySpan raysThrough(const SweepInput& input, const SweepLayer& layer, const SweepReach& reach, int b,
                    const SweepRect& among);
/// How far rays move along u and v from slice to slice, at least and at most: those of `rect`.
struct SweepSlopes {
    double lo[2], hi[2];
};
SweepSlopes slopesOf(const SweepInput& input, const SweepLayer& layer, const SweepRect& rect);

/// Between which slices a ray of a layer is in `reach`, widened by a hair; nowhere where enter > leave.
struct SweepStretch {
    double enter, leave;
};
SweepStretch stretchIn(const SweepInput& input, const SweepLayer& layer, int a, int b, const SweepReach& reach);
/// Whether a ray of a layer passes through `reach`, or as good as does.
bool passes(const SweepInput& input, const SweepLayer& layer, int a, int b, const SweepReach& reach);

/// The pieces of a layer, or of all of a sweep: of the voxels of the window, or where rays are carried of endRect.
/// Depends on the input alone, never on threads.
std::vector<SweepPiece> sweepPieces(const SweepInput& input, const SweepLayer& layer);
std::vector<SweepPiece> sweepPieces(const SweepInput& input);

/// All that this processor can run, the best first.
std::span<const SweepKernel> sweepKernels();

// One per instruction set (sweep_generic.cpp, sweep_avx2.cpp).
void sweepGeneric(const SweepInput&, const SweepPiece&, SweepScratch&, double*);
void sweepAvx2(const SweepInput&, const SweepPiece&, SweepScratch&, double*);

} // namespace pellucid
