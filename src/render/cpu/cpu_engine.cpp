// The fast engine: sets up sweeps (see sweep.h) and runs their bands on threads.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "base/zeroed_memory.h"
#include "render/cpu/cpu_engine.h"
#include "tf/opacity.h"
#include "volume/intensity_grid.h"

namespace pellucid {

namespace {

/// In voxels. The rays of an eye farther off are parallel: over 4096 voxels they diverge by less than 0.2.
constexpr double kFarEye = 1e8;
constexpr std::size_t kSmallVolume = 128 * 128 * 128; ///< voxels

/// How lines are sampled, see SweepInput (docs/method.md has the same as a table).
struct Sampling {
    int stepsPerSlice, ownSteps;
    float tolerance;
};
constexpr Sampling kSmall{3, 6, 0.2f}, kSmallHigh{4, 16, 0.01f}, kSmallHighLong{4, 8, 0.1f},
    kLarge{1, 6, std::numeric_limits<float>::infinity()}, kLargeHigh{2, 4, 0.3f};
constexpr int kMostFollowedFinely = 512; ///< slices: to follow lines to their end takes time as their square

constexpr int kTableEntries = 4096; ///< at most; 128 KiB with 8 lanes: stays in the second-level cache
constexpr int kFineTableEntries = 16384;

/// Rays are given up at this optical depth: what lies behind is seen by 1e-3 at most. Derivatives fall off more
/// slowly, as D·exp(−D); and small volumes and high quality have the time (6e-6).
constexpr double kExhausted = 6.9, kExhaustedDerivative = 9, kExhaustedExact = 12;

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }

/// Calls body(first, last) for pieces of [0, count).
void inPieces(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t kPiece = 1024;
    parallelFor((count + kPiece - 1) / kPiece,
                [&](std::size_t i) { body(i * kPiece, std::min(count, (i + 1) * kPiece)); });
}

/// How the codes of a volume are to be read: intensity is code / max.
struct Codes {
    int max = 65535;
    bool someInvalid = false; ///< kInvalidCode is no intensity
    bool fine = false;        ///< tables are to have more entries
};

/// The transfer functions of one sweep as its kernel reads them, side by side in lanes. Lanes without a transfer
/// function of their own repeat the last one, so that they keep no ray alive.
class SweepTables {
public:
    /// Up to kSweepLanes candidates.
    SweepTables(std::span<const TransferFunction> tfs, const Codes& codes)
        : SweepTables(tfs.size() == 1 ? SweepMode::Single : SweepMode::Batch, tfs[0].features, codes) {
        std::vector<TfSampler> samplers(tfs.begin(), tfs.end());
        while (samplers.size() < m_lanes) samplers.push_back(samplers.back());
        fillIntegral([&](double s, double* tau) {
            for (std::size_t lane = 0; lane < m_lanes; ++lane)
                tau[lane] = opticalDepthOfOpacity(samplers[lane].opacity(s));
        });
        m_alpha.assign(m_codes * m_lanes, 0.0f);
        fillCodes([&](std::size_t code, double s) {
            unsigned opaque = 0;
            for (std::size_t lane = 0; lane < m_lanes; ++lane) {
                const double a = samplers[lane].opacity(s);
                m_alpha[code * m_lanes + lane] = static_cast<float>(a);
                if (a > 0) opaque |= 1u << lane;
            }
            return opaque;
        });
    }
    /// One transfer function and the derivatives of its depth by the peaks of features from `firstDerivative` on.
    /// A voxel that is transparent now but not under a higher peak counts: its visibility has a derivative.
    SweepTables(const TransferFunction& tf, int firstDerivative, const Codes& codes)
        : SweepTables(SweepMode::Jacobian, tf.features, codes) {
        m_firstDerivative = firstDerivative;
        const TfSampler sampler(tf), shapes(withFullPeaks(tf));
        fillIntegral([&](double s, double* tau) {
            const double a = sampler.opacity(s);
            tau[0] = opticalDepthOfOpacity(a);
            const int lane = featureAt(tf.features, s) - firstDerivative + 1;
            if (lane >= 1 && lane < kJacobianLanes && a < kMaxOpacity) tau[lane] = shapes.opacity(s) / (1 - a);
        });
        m_alpha.assign(m_codes * 2, 0.0f);
        fillCodes([&](std::size_t code, double s) {
            m_alpha[2 * code] = static_cast<float>(sampler.opacity(s));
            if (featureAt(tf.features, s) >= 0) m_alpha[2 * code + 1] = static_cast<float>(shapes.opacity(s));
            return m_alpha[2 * code] > 0 || m_alpha[2 * code + 1] > 0 ? 1u : 0u;
        });
    }

    /// Per block of kBlockSize³ voxels, of the given ranges of codes: a bit per lane that is opaque anywhere in the
    /// range; for derivatives all bits if any lane is.
    std::vector<std::uint8_t> opaqueBlocks(const std::vector<std::array<std::uint16_t, 2>>& ranges) const {
        std::vector<std::uint8_t> opaque(ranges.size(), 0);
        inPieces(ranges.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto [low, high] = ranges[i];
                if (low > high) continue; // nothing valid
                const auto first = static_cast<std::size_t>(static_cast<float>(low) * m_entryOfCode),
                           last = static_cast<std::size_t>(static_cast<float>(high) * m_entryOfCode) + 1;
                const auto *before = &m_integral[first * m_lanes],
                           *after = &m_integral[std::min(last + 1, m_entries) * m_lanes];
                const auto *codesBefore = &m_opaqueCodes[low * m_lanes],
                           *codesAfter = &m_opaqueCodes[(asSize(high) + 1) * m_lanes];
                unsigned lanes = 0;
                for (std::size_t lane = 0; lane < m_lanes; ++lane)
                    if (after[lane] != before[lane] || codesAfter[lane] != codesBefore[lane]) lanes |= 1u << lane;
                opaque[i] = static_cast<std::uint8_t>(m_mode == SweepMode::Jacobian && lanes != 0 ? 255 : lanes);
            }
        });
        return opaque;
    }

    void giveTo(SweepInput& in) const {
        in.mode = m_mode;
        in.tableEntryOfCode = m_entryOfCode;
        in.integralTable = m_integral.data();
        in.alphaTable = m_alpha.data();
        in.featureOfCode = m_featureOfCode.data();
        in.features = static_cast<int>(m_features->size());
        in.firstDerivative = m_firstDerivative;
        std::copy(m_units.begin(), m_units.end(), in.depthUnit);
    }

private:
    SweepTables(SweepMode mode, const std::vector<Feature>& features, const Codes& codes)
        : m_mode(mode), m_features(&features), m_lanes(asSize(lanesOf(mode))), m_codes(asSize(codes.max) + 1),
          m_someInvalid(codes.someInvalid) {
        if (features.size() >= kTransparent)
            throw Error("at most " + std::to_string(kTransparent - 1) + " features can be measured",
                        "transfer function", "join some");
        // Where codes are exact every value has an entry of its own, so that what is constant is measured exactly.
        const int most = codes.fine ? kFineTableEntries : kTableEntries;
        const int perValue = std::max(1, (most - 1) / codes.max);
        m_entries = asSize(std::min(codes.max * perValue, most - 1)) + 1;
        m_entryOfCode = static_cast<float>(m_entries - 1) / static_cast<float>(codes.max);
    }

    /// `taus(s, tau)` sets the lanes that are not 0.
    template <class Taus>
    void fillIntegral(const Taus& taus) {
        std::vector<double> tau(m_entries * m_lanes, 0.0);
        inPieces(m_entries, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                taus(static_cast<double>(i) / static_cast<double>(m_entries - 1), &tau[i * m_lanes]);
        });
        // 32-bit integers, since differences of floats that large would drown a small τ.
        m_integral.assign((m_entries + 1) * m_lanes, 0);
        for (std::size_t lane = 0; lane < m_lanes; ++lane) {
            double all = 0;
            for (std::size_t i = 0; i < m_entries; ++i) all += tau[i * m_lanes + lane];
            const double unit = all > 0 ? all / (1 << 30) : 1;
            m_units[lane] = static_cast<float>(unit);
            double sum = 0;
            for (std::size_t i = 0; i < m_entries; ++i) {
                sum += tau[i * m_lanes + lane];
                m_integral[(i + 1) * m_lanes + lane] = static_cast<std::int32_t>(std::lround(sum / unit));
            }
        }
    }

    /// `fill(code, s)` fills α and gives a bit per lane in which voxels of that code count.
    template <class Fill>
    void fillCodes(const Fill& fill) {
        m_featureOfCode.assign(65536, kTransparent);
        std::vector<std::uint16_t> opaque(m_codes);
        inPieces(m_codes, [&](std::size_t first, std::size_t last) {
            for (std::size_t code = first; code < last; ++code) {
                const double s = static_cast<double>(code) / static_cast<double>(m_codes - 1);
                opaque[code] = static_cast<std::uint16_t>(fill(code, s));
                if (opaque[code] == 0) continue;
                const int f = featureAt(*m_features, s);
                m_featureOfCode[code] = static_cast<std::uint16_t>(f < 0 ? static_cast<int>(m_features->size()) : f);
            }
        });
        if (m_someInvalid) m_featureOfCode[kInvalidCode] = kTransparent;
        m_opaqueCodes.assign((m_codes + 1) * m_lanes, 0);
        for (std::size_t i = 0; i < m_codes * m_lanes; ++i)
            m_opaqueCodes[i + m_lanes] = m_opaqueCodes[i] + (opaque[i / m_lanes] >> (i % m_lanes) & 1);
    }

    SweepMode m_mode;
    const std::vector<Feature>* m_features;
    std::size_t m_lanes, m_codes, m_entries = 0;
    bool m_someInvalid;
    int m_firstDerivative = 0;
    float m_entryOfCode = 0;
    std::vector<std::int32_t> m_integral;
    std::vector<float> m_alpha;
    std::array<float, kJacobianLanes> m_units{};
    std::vector<std::uint16_t> m_featureOfCode;
    std::vector<int> m_opaqueCodes; ///< [codes + 1][lanes], how many before
};

class CpuEngine final : public VisibilityEngine {
public:
    CpuEngine(std::shared_ptr<const Volume> volume, Quality quality, SweepKernel kernel, bool draft = false)
        : m_volume(std::move(volume)), m_quality(quality), m_kernel(kernel), m_draft(draft) {
        m_shared = sharedIntensityGrid(*m_volume);
        const IntensityGrid& grid = *m_shared;
        const bool someInvalid = !grid.valid.empty();
        // Without gaps, so that tables are short; and with one code for all that is invalid.
        m_codeSpace = {grid.maxCode / grid.codeStep, someInvalid, quality == Quality::High || isSmall()};
        static_assert(kCodePadding <= CodeGrid::kPadding);
        if (!grid.codes.isNarrow() && (grid.codeStep > 1 || someInvalid)) makeOwnCodes(grid);
        findRanges();
    }

    std::string name() const override { return "cpu"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        std::vector<FeatureSums> all;
        for (const TransferFunction& tf : tfs) PELLUCID_CHECK(tf.features == tfs[0].features);
        const std::size_t batches = (tfs.size() + kSweepLanes - 1) / kSweepLanes;
        for (std::size_t first = 0; first < tfs.size(); first += kSweepLanes) {
            const auto batch = tfs.subspan(first, std::min<std::size_t>(kSweepLanes, tfs.size() - first));
            const Sums sums =
                sweep(view, SweepTables(batch, m_codeSpace), weights, nullptr, job.part(first / kSweepLanes, batches));
            for (std::size_t lane = 0; lane < batch.size(); ++lane) all.push_back(sums.ofLane(lane));
        }
        return all;
    }

    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        SumsJacobian result;
        constexpr std::size_t kAtOnce = kJacobianLanes - 1;
        const std::size_t sweeps = std::max<std::size_t>(1, (tf.features.size() + kAtOnce - 1) / kAtOnce);
        for (std::size_t first = 0; first < sweeps * kAtOnce; first += kAtOnce) {
            const SweepTables tables(tf, static_cast<int>(first), m_codeSpace);
            const Sums sums = sweep(view, tables, weights, nullptr, job.part(first / kAtOnce, sweeps));
            if (first == 0) result.sums = sums.ofLane(0);
            for (std::size_t lane = 1; lane < kJacobianLanes && first + lane <= tf.features.size(); ++lane)
                result.byOpacity.push_back(sums.ofLane(lane));
        }
        return result;
    }

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        VisibilityField field{Grid<float>(m_volume->dims())};
        sweep(view, SweepTables({&tf, 1}, m_codeSpace), nullptr, &field.values, job);
        return field;
    }

private:
    struct Axes {
        int u, v, w;
        bool flipped; ///< the nearest slice is the one of the highest index
    };

    /// Of a whole sweep, as featureSumsOf() takes them.
    struct Sums {
        std::vector<double> values;
        std::size_t features = 0, lanes = 0;
        const WeightFields* weights = nullptr;
        FeatureSums ofLane(std::size_t lane) const { return featureSumsOf(values, features, lane, lanes, weights); }
    };

    void makeOwnCodes(const IntensityGrid& grid) {
        const bool someInvalid = !grid.valid.empty();
        m_codes = ZeroedVector<std::uint16_t>(grid.codes.size() + kCodePadding);
        const std::uint16_t* codes = grid.codes.wide();
        inPieces(grid.codes.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                m_codes[i] = static_cast<std::uint16_t>(codes[i] / grid.codeStep);
            if (someInvalid)
                for (std::size_t i = first; i < last; ++i)
                    m_codes[i] = grid.valid[i] ? std::min<std::uint16_t>(m_codes[i], kInvalidCode - 1) : kInvalidCode;
        });
        m_shared.reset(); // others may need it, not we
    }
    const std::uint8_t* narrowCodes() const { return m_shared ? m_shared->codes.narrow() : nullptr; }
    const std::uint16_t* wideCodes() const { return m_shared ? m_shared->codes.wide() : m_codes.data(); }

    /// The codes that occur in each block of voxels and one voxel around it: what interpolation there can give.
    void findRanges() {
        const Int3 n = m_volume->dims();
        m_blocks = (n + (kBlockSize - 1)) / kBlockSize;
        m_ranges.assign(voxelCount(m_blocks), {kInvalidCode, 0});
        parallelFor(asSize(m_blocks.z), [&](std::size_t bz) {
            const int z0 = static_cast<int>(bz) * kBlockSize;
            for (int by = 0; by < m_blocks.y; ++by) {
                auto* row = &m_ranges[voxelIndex(m_blocks, 0, by, static_cast<int>(bz))];
                for (int z = std::max(0, z0 - 1); z <= std::min(n.z - 1, z0 + kBlockSize); ++z)
                    for (int y = std::max(0, by * kBlockSize - 1); y <= std::min(n.y - 1, (by + 1) * kBlockSize); ++y) {
                        const std::size_t first = voxelIndex(n, 0, y, z);
                        narrowCodes() ? widen(row, narrowCodes() + first) : widen(row, wideCodes() + first);
                    }
            }
        });
    }
    template <class Code>
    void widen(std::array<std::uint16_t, 2>* ranges, const Code* codes) const {
        const int nx = m_volume->dims().x;
        for (int block = 0; block < m_blocks.x; ++block) {
            auto [low, high] = ranges[block];
            const int last = std::min(nx - 1, (block + 1) * kBlockSize);
            for (int x = std::max(0, block * kBlockSize - 1); x <= last; ++x) {
                if (codes[x] == kInvalidCode && m_codeSpace.someInvalid) continue;
                low = std::min<std::uint16_t>(low, codes[x]);
                high = std::max<std::uint16_t>(high, codes[x]);
            }
            ranges[block] = {low, high};
        }
    }

    static Vec3 permuted(const Vec3& p, const Axes& x) { return {p[x.u], p[x.v], p[x.w]}; }

    /// One sweep of those that together visit every voxel once.
    struct Pass {
        Axes axes;
        bool pyramid; ///< visits only the voxels that the eye sees along this axis rather than another
    };

    /// Rays that make more than this many voxels along a slice for one across are left to another sweep.
    static constexpr double kSteepest = 1.25;

    /// Axes are compared in voxels, so that rays cross about one voxel per slice however unequal the spacing is.
    std::vector<Pass> passesOf(const Camera& camera) const {
        const auto axesOf = [](int w, bool flipped) { return Axes{w == 0 ? 1 : 0, w == 2 ? 1 : 2, w, flipped}; };
        const Geometry& g = m_volume->geometry();
        if (camera.projection == Projection::Orthographic) {
            const Vec3 d = g.indexFromWorld() * camera.forward();
            int w = 0;
            for (int a = 1; a < 3; ++a)
                if (std::abs(d[a]) > std::abs(d[w])) w = a;
            return {{axesOf(w, d[w] < 0), false}};
        }
        const Vec3 eye = eyeInVoxels(camera), last = Vec3(g.dims - 1);
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
        if (best >= 0) return {{axesOf(best, eye[best] > 0), false}};
        std::vector<Pass> passes;
        for (int w = 0; w < 3; ++w)
            for (const bool flipped : {false, true}) {
                const double away = flipped ? eye[w] : last[w] - eye[w]; // of the farthest slice
                bool any = away > 0;
                for (int a = 0; a < 3; ++a)
                    if (a != w) any = any && eye[a] + away >= 0 && eye[a] - away <= last[a];
                if (any) passes.push_back({axesOf(w, flipped), true});
            }
        return passes;
    }

    /// Rounded, so that differences from voxels are exact and each voxel is on one side of a pyramid's face.
    Vec3 eyeInVoxels(const Camera& camera) const {
        return glm::round(m_volume->geometry().voxelFromWorld(camera.eye) * 1048576.0) / 1048576.0;
    }

    bool isSmall() const { return !m_draft && m_volume->size() < kSmallVolume; }

    void setRays(SweepInput& in, const Camera& camera, const Pass& pass) const {
        const Axes& axes = pass.axes;
        const Geometry& g = m_volume->geometry();
        const double sign = axes.flipped ? -1 : 1; // w runs against the axis
        const Mat3 axesInD0 = g.worldFromIndex() / g.d0();
        const Vec3 u = axesInD0[axes.u], v = axesInD0[axes.v], w = sign * axesInD0[axes.w];
        in.guu = glm::dot(u, u), in.gvv = glm::dot(v, v), in.gww = glm::dot(w, w);
        in.guv = glm::dot(u, v), in.guw = glm::dot(u, w), in.gvw = glm::dot(v, w);
        const bool high = m_quality == Quality::High;
        // What is off averages out over many voxels, which small volumes do not have; but they have the time.
        const bool small = isSmall();
        const Sampling& sampling = !small                        ? (high ? kLargeHigh : kLarge)
                                   : !high                       ? kSmall
                                   : in.nw > kMostFollowedFinely ? kSmallHighLong
                                                                 : kSmallHigh;
        in.stepsPerSlice = sampling.stepsPerSlice;
        in.ownSteps = sampling.ownSteps;
        in.tolerance = sampling.tolerance;
        in.perspective = camera.projection == Projection::Perspective;
        if (!high && !small && in.perspective) in.raySpacing = 1.2; // at most: nearer to the eye they are denser
        if (!in.perspective) {
            const Vec3 d = permuted(g.indexFromWorld() * camera.forward(), axes);
            in.slopeU = d.x / (sign * d.z);
            in.slopeV = d.y / (sign * d.z);
            return;
        }
        const Vec3 eye = permuted(eyeInVoxels(camera), axes);
        in.eyeU = eye.x;
        in.eyeV = eye.y;
        in.eyeW = axes.flipped ? in.nw - 1 - eye.z : eye.z;
        in.pyramid = pass.pyramid;
        in.ownsTieU = axes.w < axes.u;
        in.ownsTieV = axes.w < axes.v;
    }

    static void setPlanes(SweepInput& in, std::span<const VoxelPlane> planes, const Axes& axes) {
        PELLUCID_CHECK(planes.size() <= kMostSweepPlanes);
        in.clipTie = kClipTie;
        for (const VoxelPlane& plane : planes) {
            SweepPlane& p = in.planes[in.planeCount++];
            const Vec3 n = permuted(plane.normal, axes);
            p = {n.x, n.y, n.z, plane.offset};
            if (!axes.flipped) continue;
            p.w = -n.z;
            p.offset = plane.offset - n.z * (in.nw - 1);
        }
    }

    /// Takes blocks out of the opaque map that are clipped away, with all that interpolation around them reaches.
    void clearClipped(std::vector<std::uint8_t>& opaque, std::span<const VoxelPlane> planes) const {
        for (const VoxelPlane& plane : planes)
            parallelFor(asSize(m_blocks.z), [&](std::size_t z) {
                std::uint8_t* block = &opaque[z * layerSize(m_blocks)];
                for (int y = 0; y < m_blocks.y; ++y)
                    for (int x = 0; x < m_blocks.x; ++x, ++block) {
                        // The corner that is least beyond.
                        Vec3 corner;
                        const Vec3 first = Vec3(x, y, static_cast<int>(z)) * static_cast<double>(kBlockSize);
                        for (int a = 0; a < 3; ++a) corner[a] = first[a] + (plane.normal[a] > 0 ? -1 : kBlockSize);
                        if (plane.beyond(corner) > kClipTie) *block = 0;
                    }
            });
    }

    /// Codes laid out so that neighbours along u are neighbours in memory; narrow ones as they are, for all directions.
    void setCodes(SweepInput& in, const Axes& axes) {
        const Int3 n = m_volume->dims();
        const std::ptrdiff_t ny = n.y, nz = n.z;
        in.narrowCodes = narrowCodes();
        in.codeStrides = stridesOf(n, axes);
        if (in.narrowCodes) return;
        in.codes = wideCodes();
        if (axes.w != 0) return;
        if (m_codesYZX.empty()) {
            m_codesYZX = ZeroedVector<std::uint16_t>(m_volume->size() + kCodePadding);
            parallelFor(asSize(n.z), [&](std::size_t k) {
                for (std::size_t i = 0; i < asSize(n.x); ++i)
                    for (std::size_t j = 0; j < asSize(n.y); ++j)
                        m_codesYZX[j + asSize(n.y) * (k + asSize(n.z) * i)] =
                            in.codes[i + asSize(n.x) * (j + asSize(n.y) * k)];
            });
        }
        in.codeStrides = {1, ny, ny * nz};
        in.codes = m_codesYZX.data();
    }

    static SweepStrides stridesOf(const Int3& dims, const Axes& axes) {
        const std::array<std::ptrdiff_t, 3> natural{1, dims.x, static_cast<std::ptrdiff_t>(dims.x) * dims.y};
        return {natural[asSize(axes.u)], natural[asSize(axes.v)], natural[asSize(axes.w)]};
    }

    static std::vector<SweepSpan> spansOf(const std::vector<std::uint8_t>& opaque, const SweepStrides& strides,
                                          const Int3& blocks) {
        std::vector<SweepSpan> spans(asSize(blocks.y) * asSize(blocks.z));
        for (int w = 0; w < blocks.z; ++w)
            for (int v = 0; v < blocks.y; ++v) {
                SweepSpan& span = spans[asSize(v + blocks.y * w)];
                span = {blocks.x, -1};
                for (int u = 0; u < blocks.x; ++u) {
                    if (!opaque[asSize(static_cast<int>(u * strides.u + v * strides.v + w * strides.w))]) continue;
                    span.first = std::min(span.first, u);
                    span.last = u;
                }
            }
        return spans;
    }

    Sums sweep(const View& view, const SweepTables& tables, const WeightFields* weights, Grid<float>* field,
               const JobControl& job) {
        const Geometry& g = m_volume->geometry();
        const Camera& camera = view.camera;
        camera.validate(g, "camera");
        view.clipping.validate();
        if (camera.projection == Projection::Perspective) {
            const Vec3 eye = camera.eye - g.boxCenter(), inVoxels = glm::abs(g.indexFromWorld() * eye);
            if (std::max({inVoxels.x, inVoxels.y, inVoxels.z}) > kFarEye) {
                Camera parallel = camera;
                parallel.projection = Projection::Orthographic;
                parallel.center = g.boxCenter();
                parallel.up = std::abs(eye.z) > std::hypot(eye.x, eye.y) ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
                parallel.height = 1; // of the image; no ray depends on it
                return sweep({parallel, view.clipping}, tables, weights, field, job);
            }
        }
        const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, g);
        std::vector<std::uint8_t> opaque = tables.opaqueBlocks(m_ranges);
        clearClipped(opaque, planes);
        Sums sums;
        const std::vector<Pass> passes = passesOf(camera);
        for (std::size_t n = 0; n < passes.size(); ++n) {
            Sums part = sweep(camera, planes, passes[n], tables, opaque, weights, field, job.part(n, passes.size()));
            if (n == 0) {
                sums = std::move(part);
                continue;
            }
            for (std::size_t i = 0; i < sums.values.size(); ++i) sums.values[i] += part.values[i];
        }
        return sums;
    }

    Sums sweep(const Camera& camera, std::span<const VoxelPlane> planes, const Pass& pass, const SweepTables& tables,
               const std::vector<std::uint8_t>& opaque, const WeightFields* weights, Grid<float>* field,
               const JobControl& job) {
        const Geometry& g = m_volume->geometry();
        const Axes& axes = pass.axes;
        SweepInput in;
        tables.giveTo(in);
        in.nu = g.dims[axes.u], in.nv = g.dims[axes.v], in.nw = g.dims[axes.w];
        setCodes(in, axes);
        in.someInvalid = m_codeSpace.someInvalid;
        in.fieldStrides = stridesOf(g.dims, axes);
        in.opaqueStrides = stridesOf(m_blocks, axes);
        in.opaque = opaque.data();
        const std::vector<SweepSpan> spans = spansOf(opaque, in.opaqueStrides, permuted(Vec3(m_blocks), axes));
        in.opaqueSpans = spans.data();
        in.flipped = axes.flipped;
        std::ptrdiff_t start = 0;
        if (axes.flipped) {
            start = (in.nw - 1) * in.fieldStrides.w;
            const std::ptrdiff_t last = (in.nw - 1) * in.codeStrides.w;
            if (in.narrowCodes)
                in.narrowCodes += last;
            else
                in.codes += last;
            in.fieldStrides.w = -in.fieldStrides.w;
            in.codeStrides.w = -in.codeStrides.w;
        }
        if (weights) {
            PELLUCID_CHECK(weights->dims() == g.dims);
            if (weights->isCompact()) {
                in.compactWeights = weights->compactData() + start;
                in.weightOfByte = weights->weightOfByte().data();
            } else {
                in.weights = weights->data() + start;
            }
        }
        if (field) in.field = field->data() + start;
        setRays(in, camera, pass);
        setPlanes(in, planes, axes);
        in.exhaustedDepth = static_cast<float>(m_quality == Quality::High || isSmall() ? kExhaustedExact
                                               : in.mode == SweepMode::Jacobian        ? kExhaustedDerivative
                                                                                       : kExhausted);
        return {run(in, job), asSize(in.features), asSize(lanesOf(in.mode)), weights};
    }

    std::vector<double> run(const SweepInput& in, const JobControl& job) {
        const auto pieces = sweepPieces(in);
        const std::size_t size = (asSize(in.features) + 1) * 3 * asSize(lanesOf(in.mode));
        std::vector<std::vector<double>> partial(pieces.size());
        std::atomic<std::size_t> done = 0;
        parallelFor(pieces.size(), [&](std::size_t i) {
            job.throwIfStopped();
            partial[i].assign(size, 0.0);
            const auto scratch = borrowScratch();
            m_kernel(in, pieces[i], *scratch, partial[i].data());
            returnScratch(scratch);
            job.report(static_cast<double>(++done) / static_cast<double>(pieces.size()));
        });
        std::vector<double> sums(size, 0.0);
        for (const auto& part : partial) // in the order of the pieces, whatever thread made them
            for (std::size_t i = 0; i < size; ++i) sums[i] += part[i];
        return sums;
    }

    std::shared_ptr<SweepScratch> borrowScratch() {
        std::lock_guard lock(m_scratchMutex);
        if (m_scratch.empty()) return std::make_shared<SweepScratch>();
        auto scratch = m_scratch.back();
        m_scratch.pop_back();
        return scratch;
    }
    void returnScratch(std::shared_ptr<SweepScratch> scratch) {
        std::lock_guard lock(m_scratchMutex);
        m_scratch.push_back(std::move(scratch));
    }

    std::shared_ptr<const Volume> m_volume;
    Quality m_quality;
    SweepKernel m_kernel;
    bool m_draft; ///< as if the volume were large
    Codes m_codeSpace;
    std::shared_ptr<const IntensityGrid> m_shared; ///< whose codes are read as they are; null: m_codes are
    ZeroedVector<std::uint16_t> m_codes; ///< x fastest, and kCodePadding more: without gaps, or with invalid ones
    Int3 m_blocks{0, 0, 0};
    std::vector<std::array<std::uint16_t, 2>> m_ranges; ///< per block: the lowest and highest code
    ZeroedVector<std::uint16_t> m_codesYZX;             ///< made when a sweep along x first needs it
    std::mutex m_scratchMutex;
    std::vector<std::shared_ptr<SweepScratch>> m_scratch;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return makeCpuEngine(std::move(volume), quality, sweepKernels().front());
}

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                SweepKernel kernel) {
    return std::make_unique<CpuEngine>(std::move(volume), quality, kernel);
}

FeatureSums featureSumsOf(std::span<const double> totals, std::size_t features, std::size_t lane, std::size_t lanes,
                          const WeightFields* weights) {
    FeatureSums sums = emptySums(features);
    for (std::size_t f = 0; f <= features; ++f) {
        const double* item = &totals[f * 3 * lanes + lane];
        sums.allVisibility += item[0];
        if (f < features) sums.visibility[f] = item[0];
        for (std::size_t w = 0; w < 2; ++w) {
            const double scale = weights != nullptr ? static_cast<double>(weights->scale(static_cast<int>(w))) : 0;
            const double weighted = item[(w + 1) * lanes] * scale;
            sums.allWeighted[w] += weighted;
            if (f < features) sums.weighted[w][f] = weighted;
        }
    }
    return sums;
}

std::unique_ptr<VisibilityEngine> makeDraftEngine(std::shared_ptr<const Volume> volume) {
    return std::make_unique<CpuEngine>(std::move(volume), Quality::Normal, sweepKernels().front(), true);
}

} // namespace pellucid
