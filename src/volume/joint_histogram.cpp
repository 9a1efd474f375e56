#include "volume/joint_histogram.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/parallel.h"
#include "volume/histogram.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostVoxels = std::size_t{1} << 24; ///< more tell the same, and take longer
constexpr double kShown = 0.9995;                         ///< share of the gradients below the histogram's upper end
constexpr int kFine = 16384;                              ///< bins of the gradients alone, to find that end

/// Intensities and gradients at every n-th voxel along each axis.
template <class T>
class Gradients {
public:
    Gradients(const Volume& volume, const T& samples) : m_volume(volume), m_samples(samples), m_dims(volume.dims()) {
        while (voxelCount(m_dims) / (static_cast<std::size_t>(m_every) * static_cast<std::size_t>(m_every)) >
               kMostVoxels)
            ++m_every;
        // ∇s in the world is A⁻ᵀ·(∂s/∂i, ∂s/∂j, ∂s/∂k); times d0 it is per reference length.
        m_toWorld = glm::transpose(volume.geometry().indexFromWorld()) * volume.geometry().d0();
    }

    std::size_t planes() const { return (static_cast<std::size_t>(m_dims.z) + every() - 1) / every(); }
    /// |∇s| of a change of 1 from voxel to voxel along every axis, at most.
    double bound() const {
        double sum = 0;
        for (int a = 0; a < 3; ++a) sum += glm::length(m_toWorld[a]);
        return sum;
    }

    /// use(intensity, |∇s|·d0) for the voxels of the n-th plane that is looked at.
    template <class Use>
    void ofPlane(std::size_t n, const Use& use) const {
        const int k = static_cast<int>(n) * m_every;
        for (int j = 0; j < m_dims.y; j += m_every)
            for (int i = 0; i < m_dims.x; ++i) {
                const double s = at(i, j, k);
                if (std::isnan(s)) continue;
                const Vec3 change{difference({i, j, k}, 0), difference({i, j, k}, 1), difference({i, j, k}, 2)};
                const double g = glm::length(m_toWorld * change);
                if (!std::isnan(g)) use(s, g);
            }
    }

private:
    std::size_t every() const { return static_cast<std::size_t>(m_every); }
    double at(int i, int j, int k) const {
        return m_volume.intensityOfValue(static_cast<double>(m_samples[voxelIndex(m_dims, i, j, k)]));
    }
    double difference(const Int3& at_, int axis) const {
        Int3 lo = at_, hi = at_;
        lo[axis] = std::max(0, lo[axis] - 1);
        hi[axis] = std::min(m_dims[axis] - 1, hi[axis] + 1);
        if (lo[axis] == hi[axis]) return 0;
        return (at(hi.x, hi.y, hi.z) - at(lo.x, lo.y, lo.z)) / (hi[axis] - lo[axis]);
    }

    const Volume& m_volume;
    const T& m_samples;
    Int3 m_dims;
    int m_every = 1;
    Mat3 m_toWorld{1};
};

template <class T>
JointHistogram count(const Volume& volume, const T& samples, int bins, int gradientBins, const JobControl& job) {
    const Gradients<T> gradients(volume, samples);
    const std::size_t planes = gradients.planes(), pieces = std::min<std::size_t>(16, planes);
    const auto overPlanes = [&](auto& partial, std::size_t cells, const auto& use) {
        partial.assign(pieces, {});
        parallelFor(pieces, [&](std::size_t p) {
            partial[p].assign(cells, 0);
            for (std::size_t n = planes * p / pieces; n < planes * (p + 1) / pieces; ++n) {
                job.throwIfStopped();
                gradients.ofPlane(n, [&](double s, double g) { ++partial[p][use(s, g)]; });
            }
        });
        for (std::size_t p = 1; p < pieces; ++p)
            for (std::size_t c = 0; c < cells; ++c) partial[0][c] += partial[p][c];
    };

    const double bound = gradients.bound();
    std::vector<std::vector<std::uint32_t>> fine, joint;
    overPlanes(fine, kFine, [&](double, double g) { return static_cast<std::size_t>(histogramBin(g / bound, kFine)); });
    // Where most voxels lie in homogeneous matter, the quantile is of those that do not.
    std::uint64_t rising = 0, seen = 0;
    for (int b = 1; b < kFine; ++b) rising += fine[0][static_cast<std::size_t>(b)];
    JointHistogram result{bins, gradientBins, 0, {}};
    for (int b = 1; b < kFine && rising > 0; ++b) {
        seen += fine[0][static_cast<std::size_t>(b)];
        result.mostGradient = bound * (b + 1) / kFine;
        if (static_cast<double>(seen) >= kShown * static_cast<double>(rising)) break;
    }
    const double most = result.mostGradient > 0 ? result.mostGradient : bound;
    const auto width = static_cast<std::size_t>(bins);
    overPlanes(joint, width * static_cast<std::size_t>(gradientBins), [&](double s, double g) {
        return static_cast<std::size_t>(histogramBin(g / most, gradientBins)) * width +
               static_cast<std::size_t>(histogramBin(s, bins));
    });
    result.counts = std::move(joint[0]);
    return result;
}

} // namespace

JointHistogram makeJointHistogram(const Volume& volume, int bins, int gradientBins, const JobControl& job) {
    return withSamples(volume, [&](const auto& samples) { return count(volume, samples, bins, gradientBins, job); });
}

} // namespace pellucid
