// The attributes that saliency is made of, voxel by voxel (docs/method.md, "Saliency").
#pragma once

#include <cstdint>
#include <vector>

#include "saliency/saliency_field.h"

namespace pellucid {

/// The appearance attributes of a colour (docs/method.md, "Saliency").
struct Appearance {
    double brightness = 0; ///< O_b = L*/100, [0,1]
    double saturation = 0; ///< O_s = C*ab/100, [0, about 1.34] for sRGB colours
};
Appearance appearanceOf(const Rgb& srgb);

/// O_b and O_s of every voxel of a volume under a transfer function, read row by row so that no field is stored.
class AppearanceReader {
public:
    /// `colors`, if any, outlive this.
    AppearanceReader(const Volume& volume, const TransferFunction& tf, const Rgb& background,
                     const VoxelColors* colors = nullptr);

    Appearance at(std::size_t voxel) const;

    /// Brightness and saturation as two floats, in this order in memory.
    using Pair = std::uint64_t;
    /// The `count` voxels from index `first` on: samples of up to 16 bits through a table of all their values; others,
    /// where the volume is large, through a table of intensities that is right to 1e-5.
    void readRow(std::size_t first, int count, Pair* out) const;

private:
    struct Bin {
        float brightness, saturation;         ///< at the bin's lower end
        float brightnessStep, saturationStep; ///< over the bin; NaN: not linear there, evaluate
    };
    /// The latest intensity and colour that were asked for: neighbouring values often have the same.
    struct Latest {
        double intensity = -1;
        Rgb color{-1, -1, -1};
        Pair ofIntensity = 0, ofColor = 0;
    };
    Appearance atIntensity(double s) const;
    Pair pairAt(double s, Latest& latest) const;
    void readColoredRow(std::size_t first, int count, Pair* out) const;
    void tabulateSamples();
    void tabulateIntensities();
    Bin binAt(int index) const;

    const Volume& m_volume;
    const VoxelColors* m_colors;
    TfSampler m_sampler;
    std::vector<Feature> m_features;
    Appearance m_background;
    std::vector<double> m_breaks; ///< where features or colours may change
    std::vector<Pair> m_ofSample; ///< by value, the lowest first; only for samples of 8 and 16 bits
    std::vector<Bin> m_ofIntensity;
};

/// One direction of a truncated kernel: the voxels (i+dx, j+dy, k+dz), |dx| ≤ halfWidth, of the ball around (i,j,k).
struct KernelRun {
    int dy = 0, dz = 0, halfWidth = 0;
};

/// The ball of radius R = `radiusInD0` around a voxel and its weights, a product of three one-dimensional ones:
/// exp(−|j−i|²/s²), s = 2R (4.7) or R/4 (Narrow); |j−i| < R strictly, in units of d0.
struct BallKernel {
    BallKernel(const Geometry& geometry, double radiusInD0, SaliencyKernel kernel);

    std::vector<KernelRun> runs;
    std::array<std::vector<double>, 3> weights; ///< per axis, by |offset|
    double weight(int dx, int dy, int dz) const {
        return weights[0][static_cast<std::size_t>(std::abs(dx))] * weights[1][static_cast<std::size_t>(std::abs(dy))] *
               weights[2][static_cast<std::size_t>(std::abs(dz))];
    }
    int reach(int axis) const { return static_cast<int>(weights[static_cast<std::size_t>(axis)].size()) - 1; }
};

void validate(const SaliencyOptions& options);

} // namespace pellucid
