#include "render/published_engine.h"

#include <array>
#include <atomic>
#include <cstdint>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "tf/eight_bit.h"
#include "tf/opacity.h"
#include "volume/intensity_grid.h"

namespace pellucid {

namespace {

/// q8((1 − A)·α) in 255ths: the product of two such numbers lies never half way between two.
int growth(int accumulated, int alpha) { return ((255 - accumulated) * alpha + 127) / 255; }

/// The feature of an intensity by closed intervals, −1: none.
int closedFeatureAt(const std::vector<Feature>& features, double s) {
    const int inside = featureAt(features, s);
    if (inside >= 0) return inside;
    for (std::size_t f = 0; f < features.size(); ++f)
        if (s == features[f].b) return static_cast<int>(f);
    return -1;
}

/// How voxels follow each other along the rays: `lines` bundles of `across` rays of `depth` voxels.
struct Passage {
    int lines, across, depth;
    std::ptrdiff_t first;                           ///< index of the voxel where the first ray enters
    std::ptrdiff_t lineStep, acrossStep, depthStep; ///< to the next voxel
    std::ptrdiff_t at(int line, int ray, int plane) const {
        return first + line * lineStep + ray * acrossStep + plane * depthStep;
    }
};

Passage passageOf(const View& view, const Geometry& g) {
    constexpr double kAligned = 1e-6;
    view.camera.validate(g, "camera");
    const Vec3 direction = g.indexFromWorld() * view.camera.forward();
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (std::abs(direction[a]) > std::abs(direction[axis])) axis = a;
    bool isAligned = true;
    for (int a = 0; a < 3; ++a)
        isAligned = isAligned && (a == axis || std::abs(direction[a]) <= kAligned * std::abs(direction[axis]));
    if (!isAligned || view.camera.projection != Projection::Orthographic)
        throw UsageError("the published profile looks along an axis of the grid, in parallel", "camera",
                         "choose one of its six views, or the other definitions");
    const std::array<std::ptrdiff_t, 3> step{1, g.dims.x, static_cast<std::ptrdiff_t>(g.dims.x) * g.dims.y};
    const int outer = axis == 2 ? 1 : 2, inner = 3 - axis - outer;
    const auto stepOf = [&](int a) { return step[static_cast<std::size_t>(a)]; };
    const bool downward = direction[axis] < 0;
    return {g.dims[outer],
            g.dims[inner],
            g.dims[axis],
            downward ? (g.dims[axis] - 1) * stepOf(axis) : 0,
            stepOf(outer),
            stepOf(inner),
            downward ? -stepOf(axis) : stepOf(axis)};
}

/// Sums of whole numbers: visibility in 255ths, weights in their own units.
struct Tally {
    std::uint64_t visibility = 0;
    std::array<std::uint64_t, 2> weighted{0, 0};
};

class PublishedEngine final : public VisibilityEngine {
public:
    explicit PublishedEngine(std::shared_ptr<const Volume> volume)
        : m_volume(std::move(volume)), m_grid(sharedIntensityGrid(*m_volume)) {}

    std::string name() const override { return "published"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        if (tfs.empty()) return {};
        const std::vector<std::int16_t> features = featureTable(tfs[0]);
        std::vector<std::vector<std::uint8_t>> alphas;
        for (const TransferFunction& tf : tfs) {
            PELLUCID_CHECK(tf.features == tfs[0].features);
            alphas.push_back(alphaTable(tf));
        }
        const Passage passage = passageOf(view, m_volume->geometry());
        const std::size_t count = tfs[0].features.size() + 1; // the last for voxels in none
        using Line = std::vector<Tally>;                      // [candidate][feature]
        std::vector<Line> lines(static_cast<std::size_t>(passage.lines));
        forEachLine(view, passage, job, [&](int line, const auto& forEachVoxel) {
            Line& tallies = lines[static_cast<std::size_t>(line)];
            tallies.resize(tfs.size() * count);
            for (std::size_t c = 0; c < tfs.size(); ++c) {
                Tally* tally = tallies.data() + c * count;
                const std::uint8_t* alpha = alphas[c].data();
                std::vector<std::uint8_t> accumulated(static_cast<std::size_t>(passage.across), 0);
                forEachVoxel([&](std::size_t ray, std::size_t voxel, std::size_t code) {
                    const int v = growth(accumulated[ray], alpha[code]);
                    if (v == 0) return;
                    accumulated[ray] = static_cast<std::uint8_t>(accumulated[ray] + v);
                    Tally& t = tally[features[code]];
                    const auto seen = static_cast<std::uint64_t>(v);
                    t.visibility += seen;
                    if (weights == nullptr) return;
                    const std::uint32_t units = weights->units(voxel);
                    t.weighted[0] += seen * (units & 0xffffu);
                    t.weighted[1] += seen * (units >> 16);
                });
            }
        });
        std::vector<FeatureSums> all;
        for (std::size_t c = 0; c < tfs.size(); ++c) {
            std::vector<Tally> total(count);
            for (const Line& line : lines)
                for (std::size_t f = 0; f < count; ++f) {
                    const Tally& part = line[c * count + f];
                    total[f].visibility += part.visibility;
                    for (std::size_t w = 0; w < 2; ++w) total[f].weighted[w] += part.weighted[w];
                }
            all.push_back(sumsOf(total, weights));
        }
        return all;
    }

    /// From v = α·T, T = Π(1 − α) over the voxels in front: ∂v/∂x_j = ∂α/∂x_j·T − v·Σ ∂α/∂x_j/(1 − α). Inside feature j
    /// ∂α/∂x_j is the shape that x_j scales.
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        const std::size_t n = tf.features.size();
        const std::vector<std::int16_t> features = featureTable(tf);
        const std::vector<double> alpha = opacityTable(tf), shape = opacityTable(withFullPeaks(tf));
        const Passage passage = passageOf(view, m_volume->geometry());
        struct Line {
            FeatureSums sums;
            std::vector<FeatureSums> byOpacity;
        };
        std::vector<Line> lines(static_cast<std::size_t>(passage.lines));
        forEachLine(view, passage, job, [&](int number, const auto& forEachVoxel) {
            Line& line = lines[static_cast<std::size_t>(number)];
            line = {emptySums(n), std::vector<FeatureSums>(n, emptySums(n))};
            std::vector<double> transmittance(static_cast<std::size_t>(passage.across), 1.0);
            std::vector<double> depths(transmittance.size() * n, 0.0); // per ray and j: Σ ∂α/∂x_j/(1 − α)
            forEachVoxel([&](std::size_t ray, std::size_t voxel, std::size_t code) {
                const int feature = features[code] == static_cast<int>(n) ? -1 : features[code];
                const double a = std::min(alpha[code], kMaxOpacity), own = feature < 0 ? 0.0 : shape[code];
                if (a == 0 && own == 0) return;
                double& t = transmittance[ray];
                double* depth = depths.data() + ray * n;
                const double v = a * t;
                const double brightness = weights ? weights->brightness(voxel) : 0.0;
                const double saturation = weights ? weights->saturation(voxel) : 0.0;
                addVoxel(line.sums, feature, v, brightness, saturation);
                for (std::size_t j = 0; j < n; ++j)
                    addVoxel(line.byOpacity[j], feature,
                             (static_cast<int>(j) == feature ? own * t : 0.0) - v * depth[j], brightness, saturation);
                if (feature >= 0) depth[static_cast<std::size_t>(feature)] += own / (1 - a);
                t *= 1 - a;
            });
        });
        Line unrounded = std::move(lines[0]);
        for (std::size_t i = 1; i < lines.size(); ++i) {
            add(unrounded.sums, lines[i].sums);
            for (std::size_t j = 0; j < n; ++j) add(unrounded.byOpacity[j], lines[i].byOpacity[j]);
        }
        SumsJacobian result{sums(view, {&tf, 1}, weights, job)[0], std::move(unrounded.byOpacity)};
        for (FeatureSums& d : result.byOpacity) scale(d, unrounded.sums, result.sums);
        return result;
    }

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        const std::vector<std::uint8_t> alpha = alphaTable(tf);
        const Passage passage = passageOf(view, m_volume->geometry());
        VisibilityField field{Grid<float>(m_volume->dims())};
        forEachLine(view, passage, job, [&](int, const auto& forEachVoxel) {
            std::vector<std::uint8_t> accumulated(static_cast<std::size_t>(passage.across), 0);
            forEachVoxel([&](std::size_t ray, std::size_t voxel, std::size_t code) {
                const int v = growth(accumulated[ray], alpha[code]);
                accumulated[ray] = static_cast<std::uint8_t>(accumulated[ray] + v);
                field.values[voxel] = static_cast<float>(v) / 255;
            });
        });
        return field;
    }

private:
    /// make(intensity of each code in use).
    template <class T, class Make>
    std::vector<T> table(const Make& make) const {
        std::vector<T> values(static_cast<std::size_t>(m_grid->maxCode) + 1);
        for (int code = 0; code <= m_grid->maxCode; code += m_grid->codeStep)
            values[static_cast<std::size_t>(code)] = make(static_cast<double>(code) / m_grid->maxCode);
        return values;
    }
    std::vector<double> opacityTable(const TransferFunction& tf) const {
        const TfSampler sampler(tf);
        return table<double>([&](double s) { return sampler.opacity(s); });
    }
    std::vector<std::uint8_t> alphaTable(const TransferFunction& tf) const {
        const TfSampler sampler(tf);
        return table<std::uint8_t>([&](double s) { return static_cast<std::uint8_t>(eightBit(sampler.opacity(s))); });
    }
    /// The number of features for none.
    std::vector<std::int16_t> featureTable(const TransferFunction& tf) const {
        const auto none = static_cast<int>(tf.features.size());
        return table<std::int16_t>([&](double s) {
            const int f = closedFeatureAt(tf.features, s);
            return static_cast<std::int16_t>(f < 0 ? none : f);
        });
    }

    static FeatureSums sumsOf(const std::vector<Tally>& total, const WeightFields* weights) {
        const std::size_t n = total.size() - 1;
        FeatureSums sums = emptySums(n);
        Tally all;
        for (std::size_t f = 0; f <= n; ++f) {
            all.visibility += total[f].visibility;
            if (f < n) sums.visibility[f] = static_cast<double>(total[f].visibility) / 255;
            for (std::size_t w = 0; weights != nullptr && w < 2; ++w) {
                all.weighted[w] += total[f].weighted[w];
                const double unit = weights->scale(static_cast<int>(w)) / 255.0;
                if (f < n) sums.weighted[w][f] = static_cast<double>(total[f].weighted[w]) * unit;
                sums.allWeighted[w] = static_cast<double>(all.weighted[w]) * unit;
            }
        }
        sums.allVisibility = static_cast<double>(all.visibility) / 255;
        return sums;
    }

    static void scale(FeatureSums& d, const FeatureSums& from, const FeatureSums& to) {
        const auto by = [](double whole, double wanted, double& all, std::vector<double>& parts) {
            const double factor = whole > 0 ? wanted / whole : 0.0;
            all *= factor;
            for (double& part : parts) part *= factor;
        };
        by(from.allVisibility, to.allVisibility, d.allVisibility, d.visibility);
        for (std::size_t w = 0; w < 2; ++w) by(from.allWeighted[w], to.allWeighted[w], d.allWeighted[w], d.weighted[w]);
    }

    /// body(line, forEachVoxel), lines on different threads; forEachVoxel(take) calls take(ray, voxel, code) for each
    /// voxel that is valid and not clipped away, plane by plane from the front.
    template <class Body>
    void forEachLine(const View& view, const Passage& passage, const JobControl& job, const Body& body) const {
        view.clipping.validate();
        const Int3 dims = m_volume->dims();
        const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, m_volume->geometry());
        const auto isKept = [&](std::size_t voxel) {
            if (!m_grid->valid.empty() && m_grid->valid[voxel] == 0) return false;
            if (planes.empty()) return true;
            const auto nx = static_cast<std::size_t>(dims.x), ny = static_cast<std::size_t>(dims.y);
            return keeps(planes, Vec3(voxel % nx, voxel / nx % ny, voxel / nx / ny));
        };
        const bool all = m_grid->valid.empty() && planes.empty();
        std::atomic<int> done = 0;
        parallelFor(static_cast<std::size_t>(passage.lines), [&](std::size_t number) {
            job.throwIfStopped();
            const int line = static_cast<int>(number);
            m_grid->codes.visit([&](const auto* codes) {
                body(line, [&](const auto& take) {
                    for (int plane = 0; plane < passage.depth; ++plane) {
                        std::ptrdiff_t at = passage.at(line, 0, plane);
                        for (int ray = 0; ray < passage.across; ++ray, at += passage.acrossStep) {
                            const auto voxel = static_cast<std::size_t>(at);
                            if (all || isKept(voxel)) take(static_cast<std::size_t>(ray), voxel, codes[voxel]);
                        }
                    }
                });
            });
            job.report(static_cast<double>(++done) / passage.lines);
        });
    }

    std::shared_ptr<const Volume> m_volume;
    std::shared_ptr<const IntensityGrid> m_grid;
};

} // namespace

Camera cameraAlong(const Geometry& geometry, Along along) {
    constexpr std::pair<int, double> kViews[] = {{2, -1}, {2, 1}, {1, -1}, {1, 1}, {0, 1}, {0, -1}}; // as in Along
    const auto [axis, sign] = kViews[static_cast<std::size_t>(along)];
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.center = geometry.boxCenter();
    camera.eye = camera.center - geometry.directions[axis] * (sign * 2 * geometry.radius());
    camera.up = geometry.directions[axis == 2 ? 1 : 2];
    camera.height = 2 * geometry.radius();
    return camera;
}

std::unique_ptr<VisibilityEngine> makePublishedEngine(std::shared_ptr<const Volume> volume) {
    return std::make_unique<PublishedEngine>(std::move(volume));
}

} // namespace pellucid
