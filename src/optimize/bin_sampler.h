// Bins of intensity along rays: what ray_bundle and ray_vws have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/trilinear.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

inline constexpr int kIntensityBins = 1024;

inline double intensityOfBin(int bin) { return (bin + 0.5) / kIntensityBins; }
inline int binOfIntensity(double s) { return std::min(static_cast<int>(s * kIntensityBins), kIntensityBins - 1); }

/// Length of a ray's steps, d0: ½, and longer where the diagonal of the box would have more than 400 of them.
inline double stepAlongRays(const Geometry& geometry) {
    constexpr int kMost = 400;
    return std::max(0.5, 2 * geometry.radius() / geometry.d0() / kMost);
}

/// What the bins of a transfer function's features are, whatever their opacities.
struct BinFeatures {
    std::vector<int> slot;  ///< of each bin its feature; as many as there are features where it is in none
    std::vector<char> kept; ///< whether something can be opaque there: hidden features cannot

    explicit BinFeatures(const TransferFunction& tf) {
        const TfSampler opacities(tf);
        for (int bin = 0; bin < kIntensityBins; ++bin) {
            const double s = intensityOfBin(bin);
            const int feature = featureAt(tf.features, s);
            slot.push_back(feature < 0 ? static_cast<int>(tf.features.size()) : feature);
            kept.push_back(feature < 0 ? opacities.opacity(s) > 0
                                       : !tf.features[static_cast<std::size_t>(feature)].hidden);
        }
    }
    bool keeps(int bin) const { return kept[static_cast<std::size_t>(bin)] != 0; }
};

/// Trilinear, of intensities: their bin; −1 where more than half of it is invalid.
template <class Values>
class BinSampler {
public:
    BinSampler(const Volume& volume, const Values& values)
        : m_volume(volume), m_values(values), m_dims(volume.dims()), m_lo(volume.range().lo),
          m_perSpan(1 / (volume.range().hi - volume.range().lo)),
          m_simple(volume.invalidCount() == 0 && std::isfinite(m_perSpan) && m_perSpan > 0) {}

    int at(const Vec3& voxel) const {
        if (!m_simple) {
            const Interpolated met = interpolateValid(
                [&](std::size_t i) { return m_volume.intensityOfValue(static_cast<double>(m_values[i])); }, m_dims,
                voxel);
            return met.validShare < 0.5 ? -1 : binOfIntensity(met.value);
        }
        const TrilinearCell cell(m_dims, voxel);
        const std::size_t sx = cell.step[0], sy = cell.step[1], sz = cell.step[2];
        const double fx = cell.fraction[0], fy = cell.fraction[1], fz = cell.fraction[2];
        const auto value = [&](std::size_t offset) {
            return std::clamp((static_cast<double>(m_values[cell.corner + offset]) - m_lo) * m_perSpan, 0.0, 1.0);
        };
        const auto along = [&](std::size_t o) {
            const double first = value(o);
            return first + fx * (value(o + sx) - first);
        };
        const double lower = along(0), higher = along(sz);
        const double near = lower + fy * (along(sy) - lower), far = higher + fy * (along(sz + sy) - higher);
        return binOfIntensity(near + fz * (far - near));
    }

private:
    const Volume& m_volume;
    const Values& m_values;
    Int3 m_dims;
    double m_lo, m_perSpan;
    bool m_simple; ///< all are valid, and the range is one that can be divided by
};

} // namespace pellucid
