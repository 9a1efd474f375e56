#include "saliency/appearance.h"

#include <algorithm>
#include <cmath>

#include "volume/error.h"

namespace pellucid {

AppearanceReader::AppearanceReader(const Volume& volume, const TransferFunction& tf, const Rgb& background)
    : m_volume(volume), m_sampler(tf), m_features(tf.features), m_background(appearanceOf(background)),
      m_coder(volume) {
    if (!m_coder.exact()) return;
    // Only codes that occur are multiples of the exact scale, but filling every entry costs less than telling which.
    m_ofCode.resize(static_cast<std::size_t>(m_coder.maxCode()) + 1);
    for (std::size_t c = 0; c < m_ofCode.size(); ++c) m_ofCode[c] = atIntensity(m_coder.intensity(static_cast<int>(c)));
}

Appearance AppearanceReader::atIntensity(double s) const {
    if (featureAt(m_features, s) < 0) return m_background; // NaN is in no feature
    return appearanceOf(m_sampler.color(s));
}

void AppearanceReader::readRow(std::size_t first, std::span<float> brightness, std::span<float> saturation) const {
    std::visit(
        [&](const auto& values) {
            for (std::size_t x = 0; x < brightness.size(); ++x) {
                const double s = m_volume.intensityOfValue(static_cast<double>(values[first + x]));
                Appearance a = m_background;
                if (m_ofCode.empty())
                    a = atIntensity(s);
                else if (!std::isnan(s))
                    a = m_ofCode[m_coder.code(s)];
                brightness[x] = static_cast<float>(a.brightness);
                saturation[x] = static_cast<float>(a.saturation);
            }
        },
        m_volume.samples());
}

BallKernel::BallKernel(const Geometry& geometry, double radiusInD0, SaliencyKernel kernel) {
    const double scale = kernel == SaliencyKernel::Thesis ? 2 * radiusInD0 : radiusInD0 / 4;
    const Vec3 unit = geometry.spacing / geometry.d0(); // one voxel along each axis, in d0
    const double limit = radiusInD0 * radiusInD0;
    for (int axis = 0; axis < 3; ++axis) {
        auto& w = weights[static_cast<std::size_t>(axis)];
        for (int d = 0; std::pow(d * unit[axis], 2) < limit; ++d)
            w.push_back(std::exp(-std::pow(d * unit[axis] / scale, 2)));
    }
    for (int dz = -reach(2); dz <= reach(2); ++dz)
        for (int dy = -reach(1); dy <= reach(1); ++dy) {
            const double rest = std::pow(dy * unit.y, 2) + std::pow(dz * unit.z, 2);
            int half = -1;
            while (half < reach(0) && std::pow((half + 1) * unit.x, 2) + rest < limit) ++half;
            if (half >= 0) runs.push_back({dy, dz, half});
        }
}

void validate(const SaliencyOptions& o) {
    if (!(o.sigma > 0) || !(o.sigma <= 8))
        throw UsageError("sigma lies in (0, 8] reference lengths", "saliency", "give --sigma such a value");
    if (!std::isfinite(o.w1) || !std::isfinite(o.w2) || o.w1 < 0 || o.w2 < 0)
        throw UsageError("w1 and w2 are finite and not negative", "saliency", "correct --w1, --w2");
}

WeightFields emptyWeightFields(const Int3& dims, const SaliencyOptions& options) {
    const double w = std::max(options.w1, options.w2);
    return {dims, w, 1.34 * w};
}

} // namespace pellucid
