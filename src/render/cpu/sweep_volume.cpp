#include "render/cpu/sweep_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "volume/memory_use.h"

namespace pellucid {

namespace {

/// In voxels. The rays of an eye farther off are parallel: over 4096 voxels they diverge by less than 0.2.
constexpr double kFarEye = 1e8;
constexpr std::size_t kSmallVolume = 128 * 128 * 128; ///< voxels
/// Rays that make more than this many voxels along a slice for one across are left to another sweep.
constexpr double kSteepest = 1.25;

/// How lines are sampled, see SweepInput (docs/method.md has the same as a table).
struct Sampling {
    int stepsPerSlice, ownSteps;
    float tolerance;
};
constexpr Sampling kSmall{3, 6, 0.2f}, kSmallHigh{4, 16, 0.01f}, kSmallHighLong{4, 8, 0.1f},
    kLarge{1, 6, std::numeric_limits<float>::infinity()}, kLargeHigh{2, 4, 0.3f};
constexpr int kMostFollowedFinely = 512; ///< slices: to follow lines to their end takes time as their square

/// Rays are given up at this optical depth: what lies behind is seen by 1e-3 at most. Derivatives fall off more
/// slowly, as D·exp(−D); and small volumes and high quality have the time (6e-6).
constexpr double kExhausted = 6.9, kExhaustedDerivative = 9, kExhaustedExact = 12;

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }

std::ptrdiff_t offsetOf(const SweepStrides& strides, const Int3& at) {
    return at.x * strides.u + at.y * strides.v + at.z * strides.w;
}

} // namespace

Vec3 sweepEye(const Camera& camera, const Geometry& geometry) {
    return glm::round(geometry.voxelFromWorld(camera.eye) * 1048576.0) / 1048576.0;
}

Camera sweepCamera(const Camera& camera, const Geometry& g) {
    camera.validate(g, "camera");
    if (camera.projection != Projection::Perspective) return camera;
    const Vec3 eye = camera.eye - g.boxCenter(), inVoxels = glm::abs(g.indexFromWorld() * eye);
    if (std::max({inVoxels.x, inVoxels.y, inVoxels.z}) <= kFarEye) return camera;
    Camera parallel = camera;
    parallel.projection = Projection::Orthographic;
    parallel.center = g.boxCenter();
    parallel.up = std::abs(eye.z) > std::hypot(eye.x, eye.y) ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    parallel.height = 1; // of the image; no ray depends on it
    return parallel;
}

std::vector<SweepPass> sweepPasses(const Camera& camera, const Geometry& g) {
    const auto passOf = [](int w, bool flipped, bool pyramid) {
        return SweepPass{w == 0 ? 1 : 0, w == 2 ? 1 : 2, w, flipped, pyramid};
    };
    if (camera.projection == Projection::Orthographic) {
        const Vec3 d = g.indexFromWorld() * camera.forward();
        int w = 0;
        for (int a = 1; a < 3; ++a)
            if (std::abs(d[a]) > std::abs(d[w])) w = a;
        return {passOf(w, d[w] < 0, false)};
    }
    const Vec3 eye = sweepEye(camera, g), last = Vec3(g.dims - 1);
    int best = -1;
    double slope = kSteepest;
    for (int w = 0; w < 3; ++w) {
        const double away = std::max(0 - eye[w], eye[w] - last[w]); // of the nearest slice
        if (away <= 0) continue;
        double lateral = 0;
        for (int a = 0; a < 3; ++a)
            if (a != w) lateral = std::max({lateral, eye[a], last[a] - eye[a]});
        if (lateral / away > slope) continue;
        slope = lateral / away;
        best = w;
    }
    if (best >= 0) return {passOf(best, eye[best] > 0, false)};
    std::vector<SweepPass> passes;
    for (int w = 0; w < 3; ++w)
        for (const bool flipped : {false, true}) {
            const double away = flipped ? eye[w] : last[w] - eye[w]; // of the farthest slice
            bool any = away > 0;
            for (int a = 0; a < 3; ++a)
                if (a != w) any = any && eye[a] + away >= 0 && eye[a] - away <= last[a];
            if (any) passes.push_back(passOf(w, flipped, true));
        }
    return passes;
}

void setSweepRays(SweepInput& in, const Camera& camera, const SweepPass& pass, const Geometry& g, SweepCare care) {
    const Int3 size = pass.permuted(g.dims);
    in.nu = size.x, in.nv = size.y, in.nw = size.z;
    const double sign = pass.flipped ? -1 : 1; // w runs against the axis
    const Mat3 axesInD0 = g.worldFromIndex() / g.d0();
    const Vec3 u = axesInD0[pass.u], v = axesInD0[pass.v], w = sign * axesInD0[pass.w];
    in.guu = glm::dot(u, u), in.gvv = glm::dot(v, v), in.gww = glm::dot(w, w);
    in.guv = glm::dot(u, v), in.guw = glm::dot(u, w), in.gvw = glm::dot(v, w);
    const bool large = care == SweepCare::Large;
    const Sampling& sampling = large                          ? kLarge
                               : care == SweepCare::LargeHigh ? kLargeHigh
                               : care == SweepCare::Small     ? kSmall
                               : in.nw > kMostFollowedFinely  ? kSmallHighLong
                                                              : kSmallHigh;
    in.stepsPerSlice = sampling.stepsPerSlice;
    in.ownSteps = sampling.ownSteps;
    in.tolerance = sampling.tolerance;
    in.exhaustedDepth = static_cast<float>(!large                           ? kExhaustedExact
                                           : in.mode == SweepMode::Jacobian ? kExhaustedDerivative
                                                                            : kExhausted);
    in.perspective = camera.projection == Projection::Perspective;
    if (large && in.perspective) in.raySpacing = 1.2; // at most: nearer to the eye they are denser
    if (!in.perspective) {
        const Vec3 d = pass.permuted(g.indexFromWorld() * camera.forward());
        in.slopeU = d.x / (sign * d.z);
        in.slopeV = d.y / (sign * d.z);
        return;
    }
    const Vec3 eye = pass.permuted(sweepEye(camera, g));
    in.eyeU = eye.x;
    in.eyeV = eye.y;
    in.eyeW = pass.flipped ? in.nw - 1 - eye.z : eye.z;
    in.pyramid = pass.pyramid;
    in.ownsTieU = pass.w < pass.u;
    in.ownsTieV = pass.w < pass.v;
}

SweepVolume::SweepVolume(std::shared_ptr<const Volume> volume, Quality quality, bool draft)
    : m_volume(std::move(volume)), m_geometry(m_volume->geometry()) {
    const bool high = quality == Quality::High, small = !draft && m_volume->size() < kSmallVolume;
    m_care =
        small ? (high ? SweepCare::SmallHigh : SweepCare::Small) : (high ? SweepCare::LargeHigh : SweepCare::Large);
    makeCodes();
}

SweepVolume::SweepVolume(std::shared_ptr<const Volume> block, const Geometry& whole, const Int3& first)
    : m_volume(std::move(block)), m_geometry(whole), m_first(first), m_care(SweepCare::Large) {
    makeCodes();
}

void SweepVolume::makeCodes() {
    // A block's codes are as those of the whole would be.
    if (m_geometry.dims == m_volume->dims())
        m_shared = sharedIntensityGrid(*m_volume);
    else
        m_shared = std::make_shared<const IntensityGrid>(makeIntensityGrid(
            *m_volume, isLean(m_geometry.dims, m_volume->sampleType()) ? CodeWidth::Narrow : CodeWidth::Wide));
    const IntensityGrid& grid = *m_shared;
    const bool someInvalid = !grid.valid.empty();
    // Without gaps, so that tables are short; and with one code for all that is invalid.
    m_codeSpace = {grid.maxCode / grid.codeStep, someInvalid, m_care != SweepCare::Large};
    static_assert(kCodePadding <= CodeGrid::kPadding);
    if (!grid.codes.isNarrow() && (grid.codeStep > 1 || someInvalid)) makeOwnCodes(grid);
    m_firstBlock = m_first / kBlockSize;
    m_blocks = (m_first + m_volume->dims() - 1) / kBlockSize + 1 - m_firstBlock;
    narrowCodes() ? findRanges(narrowCodes()) : findRanges(wideCodes());
}

void SweepVolume::makeOwnCodes(const IntensityGrid& grid) {
    const bool someInvalid = !grid.valid.empty();
    m_codes = ZeroedVector<std::uint16_t>(grid.codes.size() + kCodePadding);
    const std::uint16_t* codes = grid.codes.wide();
    inSweepPieces(grid.codes.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) m_codes[i] = static_cast<std::uint16_t>(codes[i] / grid.codeStep);
        if (someInvalid)
            for (std::size_t i = first; i < last; ++i)
                m_codes[i] = grid.valid[i] ? std::min<std::uint16_t>(m_codes[i], kInvalidCode - 1) : kInvalidCode;
    });
    m_shared.reset(); // others may need it, not we
}

/// The codes that occur in each block of voxels and one voxel around it: what interpolation there can give.
template <class Code>
void SweepVolume::findRanges(const Code* codes) {
    const Int3 n = m_volume->dims();
    const bool someInvalid = m_codeSpace.someInvalid;
    m_ranges.resize(voxelCount(m_blocks));
    parallelFor(asSize(m_blocks.z), [&](std::size_t bz) {
        // Voxels of the stored ones that block b of an axis reaches.
        const auto firstOf = [&](int b, int a) {
            return std::max(0, (b + m_firstBlock[a]) * kBlockSize - 1 - m_first[a]);
        };
        const auto lastOf = [&](int b, int a) {
            return std::min(n[a] - 1, (b + m_firstBlock[a] + 1) * kBlockSize - m_first[a]);
        };
        const int k = static_cast<int>(bz);
        // Across the rows of a row of blocks first: whole vectors at a time.
        std::vector<Code> low(asSize(n.x)), high(low.size());
        for (int by = 0; by < m_blocks.y; ++by) {
            std::ranges::fill(low, std::numeric_limits<Code>::max());
            std::ranges::fill(high, Code{0});
            for (int z = firstOf(k, 2); z <= lastOf(k, 2); ++z)
                for (int y = firstOf(by, 1); y <= lastOf(by, 1); ++y) {
                    const Code* row = codes + voxelIndex(n, 0, y, z);
                    for (std::size_t x = 0; x < low.size(); ++x) {
                        low[x] = std::min(low[x], row[x]); // the invalid code is the largest
                        high[x] = std::max(high[x], someInvalid && row[x] == kInvalidCode ? Code{0} : row[x]);
                    }
                }
            for (int block = 0; block < m_blocks.x; ++block) {
                const auto first = firstOf(block, 0), end = lastOf(block, 0) + 1;
                m_ranges[voxelIndex(m_blocks, block, by, k)] = {
                    *std::min_element(low.begin() + first, low.begin() + end),
                    *std::max_element(high.begin() + first, high.begin() + end)};
            }
        }
    });
}

void SweepVolume::setClipping(SweepInput& in, const VoxelClipping& clipping, const SweepPass& pass) {
    const auto set = [&](std::span<const VoxelPlane> planes, SweepPlane* to) {
        PELLUCID_CHECK(planes.size() <= kMostSweepPlanes);
        for (const VoxelPlane& plane : planes) {
            SweepPlane& p = *to++;
            const Vec3 n = pass.permuted(plane.normal);
            p = {n.x, n.y, n.z, plane.offset};
            if (!pass.flipped) continue;
            p.w = -n.z;
            p.offset = plane.offset - n.z * (in.nw - 1);
        }
        return static_cast<int>(planes.size());
    };
    in.clipTie = kClipTie;
    in.planeCount = set(clipping.cut, in.planes);
    in.faintCount = set(clipping.faint, in.faintPlanes);
    in.faintDensity = static_cast<float>(clipping.density);
}

OpaqueMap SweepVolume::opaqueMap(const SweepTables& tables, const VoxelClipping& clipping) const {
    OpaqueMap map;
    map.blocks = tables.opaqueBlocks(m_ranges);
    // Blocks that are clipped away, with all that interpolation around them reaches.
    for (const VoxelPlane& plane : clipping.cut)
        parallelFor(asSize(m_blocks.z), [&](std::size_t z) {
            std::uint8_t* block = &map.blocks[z * layerSize(m_blocks)];
            for (int y = 0; y < m_blocks.y; ++y)
                for (int x = 0; x < m_blocks.x; ++x, ++block) {
                    // The corner that is least beyond.
                    Vec3 corner;
                    const Vec3 first =
                        Vec3(m_firstBlock + Int3(x, y, static_cast<int>(z))) * static_cast<double>(kBlockSize);
                    for (int a = 0; a < 3; ++a) corner[a] = first[a] + (plane.normal[a] > 0 ? -1 : kBlockSize);
                    if (plane.beyond(corner) > kClipTie) *block = 0;
                }
        });
    return map;
}

SweepStrides SweepVolume::stridesOf(const Int3& dims, const SweepPass& pass) {
    const std::array<std::ptrdiff_t, 3> natural{1, dims.x, static_cast<std::ptrdiff_t>(dims.x) * dims.y};
    return {natural[asSize(pass.u)], natural[asSize(pass.v)], natural[asSize(pass.w)]};
}

/// Codes laid out so that neighbours along u are neighbours in memory; narrow ones as they are, for all directions.
void SweepVolume::setCodes(SweepInput& in, const SweepPass& pass) {
    const Int3 n = m_volume->dims();
    in.codeStrides = stridesOf(n, pass);
    if (narrowCodes() == nullptr && pass.w == 0) {
        if (m_codesYZX.empty()) {
            m_codesYZX = ZeroedVector<std::uint16_t>(m_volume->size() + kCodePadding);
            parallelFor(asSize(n.z), [&](std::size_t k) {
                const std::uint16_t* codes = wideCodes();
                for (std::size_t i = 0; i < asSize(n.x); ++i)
                    for (std::size_t j = 0; j < asSize(n.y); ++j)
                        m_codesYZX[j + asSize(n.y) * (k + asSize(n.z) * i)] =
                            codes[i + asSize(n.x) * (j + asSize(n.y) * k)];
            });
        }
        in.codeStrides = {1, n.y, static_cast<std::ptrdiff_t>(n.y) * n.z};
        in.codes = m_codesYZX.data();
    } else if (narrowCodes() != nullptr) {
        in.narrowCodes = narrowCodes();
    } else {
        in.codes = wideCodes();
    }
}

void SweepVolume::setOpaque(SweepInput& in, OpaqueMap& opaque, const SweepPass& pass) const {
    const Int3 blocks = pass.permuted(m_blocks), first = pass.permuted(m_firstBlock);
    const SweepStrides strides = in.opaqueStrides = stridesOf(m_blocks, pass);
    opaque.spans.assign(asSize(blocks.y) * asSize(blocks.z), SweepSpan{first.x + blocks.x, -1});
    for (int w = 0; w < blocks.z; ++w)
        for (int v = 0; v < blocks.y; ++v) {
            SweepSpan& span = opaque.spans[asSize(v + blocks.y * w)];
            for (int u = 0; u < blocks.x; ++u) {
                if (!opaque.blocks[static_cast<std::size_t>(offsetOf(strides, {u, v, w}))]) continue;
                span.first = std::min(span.first, first.x + u);
                span.last = first.x + u;
            }
        }
    in.opaque = opaque.blocks.data() - offsetOf(strides, first);
    in.spanStride = blocks.y;
    in.opaqueSpans = opaque.spans.data() - (first.y + static_cast<std::ptrdiff_t>(blocks.y) * first.z);
    in.firstBlockU = first.x;
    in.lastBlockU = first.x + blocks.x - 1;
    in.flipped = pass.flipped;
}

SweepInput SweepVolume::input(const Camera& camera, const VoxelClipping& clipping, const SweepPass& pass,
                              const SweepTables& tables, OpaqueMap& opaque, const WeightFields* weights,
                              Grid<float>* field) {
    SweepInput in;
    tables.giveTo(in);
    setSweepRays(in, camera, pass, m_geometry, m_care);
    const Int3 first = pass.permuted(m_first), stored = pass.permuted(m_volume->dims());
    in.firstU = first.x, in.lastU = first.x + stored.x - 1;
    setCodes(in, pass);
    in.someInvalid = m_codeSpace.someInvalid;
    in.fieldStrides = stridesOf(m_volume->dims(), pass);
    setOpaque(in, opaque, pass);
    // From what is stored first to the voxel u = v = 0 of the nearest slice, which may not be stored.
    const std::ptrdiff_t last = pass.flipped ? in.nw - 1 : 0,
                         code = last * in.codeStrides.w - offsetOf(in.codeStrides, first),
                         value = last * in.fieldStrides.w - offsetOf(in.fieldStrides, first);
    if (in.narrowCodes)
        in.narrowCodes += code;
    else
        in.codes += code;
    if (pass.flipped) {
        in.fieldStrides.w = -in.fieldStrides.w;
        in.codeStrides.w = -in.codeStrides.w;
    }
    if (weights) {
        PELLUCID_CHECK(weights->dims() == m_volume->dims());
        if (weights->isCompact()) {
            in.compactWeights = weights->compactData() + value;
            in.weightOfByte = weights->weightOfByte().data();
        } else {
            in.weights = weights->data() + value;
        }
    }
    if (field) in.field = field->data() + value;
    setClipping(in, clipping, pass);
    in.window = {{0, 0, 0}, {in.nu, in.nv, in.nw}};
    return in;
}

} // namespace pellucid
