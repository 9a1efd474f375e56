// The fast engine: sets up sweeps (see sweep.h) and runs their bands on threads.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "render/cpu/sweep.h"
#include "render/visibility.h"
#include "tf/opacity.h"
#include "volume/intensity_grid.h"
#include "volume/parallel.h"

namespace pellucid {

namespace {

/// In voxels. The rays of an eye farther off are parallel: over 4096 voxels they diverge by less than 0.2.
constexpr double kFarEye = 1e8;
constexpr int kDepthTableSize = 4096; ///< 128 KiB with 8 lanes: stays in the second-level cache

/// The tables of up to kSweepLanes transfer functions side by side.
struct SweepTables {
    SweepTables(std::span<const TransferFunction> tfs, int laneCount, int maxCode) : lanes(laneCount) {
        const auto n = static_cast<std::size_t>(lanes), codes = static_cast<std::size_t>(maxCode) + 1;
        depth.assign(static_cast<std::size_t>(kDepthTableSize) * n, 0.0f);
        integral.assign(depth.size(), 0.0f);
        alpha.assign(codes * n, 0.0f);
        featureOfCode.assign(codes, kTransparent);
        for (std::size_t lane = 0; lane < tfs.size(); ++lane) {
            const TfSampler sampler(tfs[lane]);
            double sum = 0, before = 0;
            for (std::size_t i = 0; i < static_cast<std::size_t>(kDepthTableSize); ++i) {
                const double tau =
                    opticalDepthOfOpacity(sampler.opacity(static_cast<double>(i) / (kDepthTableSize - 1)));
                if (i > 0) sum += (before + tau) / 2;
                before = tau;
                depth[i * n + lane] = static_cast<float>(tau);
                integral[i * n + lane] = static_cast<float>(sum);
            }
            for (std::size_t c = 0; c < codes; ++c) {
                const double s = static_cast<double>(c) / maxCode;
                const double a = sampler.opacity(s);
                alpha[c * n + lane] = static_cast<float>(a);
                if (a <= 0 || featureOfCode[c] != kTransparent) continue;
                const int f = featureAt(tfs[0].features, s);
                featureOfCode[c] = static_cast<std::uint8_t>(f < 0 ? static_cast<int>(tfs[0].features.size()) : f);
            }
        }
        opaqueBefore.assign(static_cast<std::size_t>(kDepthTableSize) + 1, 0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(kDepthTableSize); ++i) {
            const auto entry = depth.begin() + static_cast<std::ptrdiff_t>(i * n);
            const bool opaque = std::any_of(entry, entry + lanes, [](float tau) { return tau > 0; });
            opaqueBefore[i + 1] = opaqueBefore[i] + (opaque ? 1 : 0);
        }
    }
    int lanes;
    std::vector<int> opaqueBefore;
    std::vector<float> depth, integral, alpha;
    std::vector<std::uint8_t> featureOfCode;
};

class CpuEngine final : public VisibilityEngine {
public:
    CpuEngine(std::shared_ptr<const Volume> volume, Quality quality)
        : m_volume(std::move(volume)), m_quality(quality), m_grid(makeIntensityGrid(*m_volume)) {}

    std::string name() const override { return "cpu"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const Camera& camera, std::span<const TransferFunction> tfs,
                                  const WeightFields* weights, const JobControl& job) override {
        std::vector<FeatureSums> all;
        for (std::size_t first = 0; first < tfs.size(); first += kSweepLanes) {
            const auto batch = tfs.subspan(first, std::min<std::size_t>(kSweepLanes, tfs.size() - first));
            for (FeatureSums& s : sweep(camera, batch, weights, nullptr, job)) all.push_back(std::move(s));
        }
        return all;
    }

    SumsJacobian jacobian(const Camera&, const TransferFunction&, const WeightFields*, const JobControl&) override {
        throw Error("the cpu engine has no derivatives yet", "", "");
    }

    VisibilityField field(const Camera& camera, const TransferFunction& tf, const JobControl& job) override {
        VisibilityField field{Grid<float>(m_volume->dims())};
        sweep(camera, {&tf, 1}, nullptr, &field.values, job);
        return field;
    }

private:
    struct Axes {
        int u, v, w;
        bool flipped; ///< the nearest slice is the one of the highest index
    };

    static Vec3 permuted(const Vec3& p, const Axes& x) { return {p[x.u], p[x.v], p[x.w]}; }

    /// The sweep axis: the one along which a ray crosses most voxels; for a perspective eye the one whose rays stay
    /// steepest. Counted in voxels, so that rays cross about one voxel per slice however unequal the spacing is.
    Axes chooseAxes(const Camera& camera) const {
        const Geometry& g = m_volume->geometry();
        int w = 0;
        bool flipped = false;
        if (camera.projection == Projection::Orthographic) {
            const Vec3 d = camera.forward() / g.spacing;
            for (int a = 1; a < 3; ++a)
                if (std::abs(d[a]) > std::abs(d[w])) w = a;
            flipped = d[w] < 0;
        } else {
            const Vec3 lo(-0.5), hi = Vec3(g.dims) - 0.5, eye = g.voxelFromWorld(camera.eye);
            double best = std::numeric_limits<double>::infinity();
            for (int a = 0; a < 3; ++a) {
                const double outside = std::max(lo[a] - eye[a], eye[a] - hi[a]);
                if (outside < 0) continue;
                double lateral = 0;
                for (int b = 0; b < 3; ++b)
                    if (b != a) lateral = std::max({lateral, std::abs(lo[b] - eye[b]), std::abs(hi[b] - eye[b])});
                const double slope = lateral / (outside + (hi[a] - lo[a]) / 2);
                if (slope >= best) continue;
                best = slope;
                w = a;
                flipped = eye[a] >= hi[a];
            }
        }
        return {w == 0 ? 1 : 0, w == 2 ? 1 : 2, w, flipped};
    }

    void setRays(SweepInput& in, const Camera& camera, const Axes& axes) const {
        const Geometry& g = m_volume->geometry();
        const Vec3 h = permuted(g.spacing, axes) / g.d0();
        in.hu = h.x, in.hv = h.y, in.hw = h.z;
        const double sign = axes.flipped ? -1 : 1;
        const bool high = m_quality == Quality::High;
        in.maxStep = high ? 0.5 : 1.0;
        in.raySpacing = high ? 0.4 : 0.75;
        in.ownSlices = high ? 3 : 2;
        in.perspective = camera.projection == Projection::Perspective;
        if (!in.perspective) {
            const Vec3 d = permuted(camera.forward() / g.spacing, axes);
            in.slopeU = d.x / (sign * d.z);
            in.slopeV = d.y / (sign * d.z);
            if (in.slopeU == 0 && in.slopeV == 0) { // every ray is a voxel's own line
                in.raySpacing = 1;
                in.ownSlices = 0;
            }
            return;
        }
        const Vec3 eye = permuted(g.voxelFromWorld(camera.eye), axes);
        in.eyeU = eye.x;
        in.eyeV = eye.y;
        in.eyeW = axes.flipped ? in.nw - 1 - eye.z : eye.z;
        const double near = 0 - in.eyeW, far = in.nw - 1 - in.eyeW;
        const double halvings = std::floor(std::log2(far / near));
        in.firstSlopeStep = in.raySpacing / far * std::exp2(halvings);
    }

    /// Codes laid out so that neighbours along u are neighbours in memory.
    const std::uint16_t* codesFor(const Axes& axes, SweepStrides& strides) {
        const Int3 n = m_volume->dims();
        const std::ptrdiff_t nx = n.x, ny = n.y, nz = n.z;
        if (axes.w != 0) {
            strides = axes.w == 2 ? SweepStrides{1, nx, nx * ny} : SweepStrides{1, nx * ny, nx};
            return m_grid.codes.data();
        }
        if (m_codesYZX.empty()) {
            m_codesYZX.resize(m_grid.codes.size());
            parallelFor(static_cast<std::size_t>(nz), [&](std::size_t k) {
                for (int j = 0; j < n.y; ++j)
                    for (int i = 0; i < n.x; ++i)
                        m_codesYZX[static_cast<std::size_t>(j + ny * (static_cast<std::ptrdiff_t>(k) + nz * i))] =
                            m_grid.codes.at(i, j, static_cast<int>(k));
            });
        }
        strides = {1, ny, ny * nz};
        return m_codesYZX.data();
    }

    std::vector<FeatureSums> sweep(const Camera& camera, std::span<const TransferFunction> tfs,
                                   const WeightFields* weights, Grid<float>* field, const JobControl& job) {
        const Geometry& g = m_volume->geometry();
        camera.validate(g, "camera");
        if (camera.projection == Projection::Perspective) {
            const Vec3 eye = camera.eye - g.boxCenter();
            if (std::max({std::abs(eye.x / g.spacing.x), std::abs(eye.y / g.spacing.y),
                          std::abs(eye.z / g.spacing.z)}) > kFarEye) {
                Camera parallel = camera;
                parallel.projection = Projection::Orthographic;
                parallel.center = g.boxCenter();
                parallel.up = std::abs(eye.z) > std::hypot(eye.x, eye.y) ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
                parallel.height = 1; // of the image; no ray depends on it
                return sweep(parallel, tfs, weights, field, job);
            }
        }
        const std::size_t features = tfs[0].features.size();
        for (const TransferFunction& tf : tfs) PELLUCID_CHECK(tf.features.size() == features);
        if (features >= kTransparent)
            throw Error("at most 254 features can be measured", "transfer function", "join some");

        const int lanes = tfs.size() == 1 ? 1 : kSweepLanes;
        const SweepTables tables(tfs, lanes, m_grid.maxCode);
        const Axes axes = chooseAxes(camera);

        SweepInput in;
        in.lanes = lanes;
        in.nu = g.dims[axes.u], in.nv = g.dims[axes.v], in.nw = g.dims[axes.w];
        in.codes = codesFor(axes, in.codeStrides);
        const std::array<std::ptrdiff_t, 3> natural{1, g.dims.x, static_cast<std::ptrdiff_t>(g.dims.x) * g.dims.y};
        in.fieldStrides = {natural[static_cast<std::size_t>(axes.u)], natural[static_cast<std::size_t>(axes.v)],
                           natural[static_cast<std::size_t>(axes.w)]};
        std::ptrdiff_t start = 0;
        if (axes.flipped) {
            start = (in.nw - 1) * in.fieldStrides.w;
            in.codes += (in.nw - 1) * in.codeStrides.w;
            in.fieldStrides.w = -in.fieldStrides.w;
            in.codeStrides.w = -in.codeStrides.w;
        }
        if (!m_grid.valid.empty()) in.valid = m_grid.valid.data() + start;
        std::vector<Grid<float>> unpacked;
        if (weights) {
            PELLUCID_CHECK(weights->dims() == g.dims);
            for (int attribute = 0; attribute < 2; ++attribute) {
                unpacked.push_back(gridOf(*weights, attribute));
                in.weights[attribute] = unpacked.back().data() + start;
            }
        }
        if (field) in.field = field->data() + start;
        in.tableSize = kDepthTableSize;
        in.tableEntryOfCode = static_cast<float>(kDepthTableSize - 1) / static_cast<float>(m_grid.maxCode);
        in.depthTable = tables.depth.data();
        in.opaqueBefore = tables.opaqueBefore.data();
        in.integralTable = tables.integral.data();
        in.alphaTable = tables.alpha.data();
        in.featureOfCode = tables.featureOfCode.data();
        in.features = static_cast<int>(features);
        setRays(in, camera, axes);
        return run(in, tfs.size(), job);
    }

    std::vector<FeatureSums> run(const SweepInput& in, std::size_t candidates, const JobControl& job) {
        const auto bands = sweepBands(in);
        const auto lanes = static_cast<std::size_t>(in.lanes), features = static_cast<std::size_t>(in.features);
        std::vector<std::vector<double>> partial(bands.size());
        std::atomic<std::size_t> done = 0;
        parallelFor(bands.size(), [&](std::size_t i) {
            job.throwIfStopped();
            partial[i].assign((features + 1) * 3 * lanes, 0.0);
            const auto scratch = borrowScratch();
            sweepKernel(in.lanes)(in, bands[i], *scratch, partial[i].data());
            returnScratch(scratch);
            job.report(static_cast<double>(++done) / static_cast<double>(bands.size()));
        });

        std::vector<FeatureSums> all(candidates);
        for (std::size_t lane = 0; lane < candidates; ++lane) {
            FeatureSums& sums = all[lane];
            sums.visibility.assign(features, 0.0);
            for (auto& w : sums.weighted) w.assign(features, 0.0);
            for (const auto& part : partial) // in the order of the bands, whatever thread made them
                for (std::size_t f = 0; f <= features; ++f) {
                    const double* v = &part[f * 3 * lanes + lane];
                    sums.allVisibility += v[0];
                    sums.allWeighted[0] += v[lanes];
                    sums.allWeighted[1] += v[2 * lanes];
                    if (f == features) continue;
                    sums.visibility[f] += v[0];
                    sums.weighted[0][f] += v[lanes];
                    sums.weighted[1][f] += v[2 * lanes];
                }
        }
        return all;
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
    IntensityGrid m_grid;
    std::vector<std::uint16_t> m_codesYZX; ///< made when a sweep along x first needs it
    std::mutex m_scratchMutex;
    std::vector<std::shared_ptr<SweepScratch>> m_scratch;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return std::make_unique<CpuEngine>(std::move(volume), quality);
}

} // namespace pellucid
