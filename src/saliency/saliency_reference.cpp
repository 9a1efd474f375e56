// Saliency by the book: each voxel, each neighbour, double precision.
#include <cmath>

#include "saliency/appearance.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

/// Weighted means of both attributes over the part of the ball that lies inside the volume (4.6).
Appearance meanOver(const BallKernel& ball, const Grid<Appearance>& o, const Int3& at) {
    const Int3 n = o.dims();
    Appearance sum;
    double norm = 0;
    for (const KernelRun& run : ball.runs) {
        const int y = at.y + run.dy, z = at.z + run.dz;
        if (y < 0 || y >= n.y || z < 0 || z >= n.z) continue;
        for (int dx = -run.halfWidth; dx <= run.halfWidth; ++dx) {
            const int x = at.x + dx;
            if (x < 0 || x >= n.x) continue;
            const double w = ball.weight(dx, run.dy, run.dz);
            sum.brightness += w * o.at(x, y, z).brightness;
            sum.saturation += w * o.at(x, y, z).saturation;
            norm += w;
        }
    }
    return {sum.brightness / norm, sum.saturation / norm};
}

} // namespace

WeightFields saliencyFieldsReference(const Volume& volume, const TransferFunction& tf, const SaliencyOptions& options,
                                     const JobControl& job, const VoxelColors* colors) {
    validate(options);
    const AppearanceReader reader(volume, tf, options.background, colors);
    Grid<Appearance> o(volume.dims());
    for (std::size_t i = 0; i < o.size(); ++i) o[i] = reader.at(i);
    const BallKernel centre(volume.geometry(), options.sigma, options.kernel);
    const BallKernel surround(volume.geometry(), 2 * options.sigma, options.kernel);

    WeightFields fields = emptyWeightFields(volume.dims(), options);
    forEachPlace(volume.dims(), job, [&](const Int3& place, std::size_t index) {
        const Appearance c = meanOver(centre, o, place), s = meanOver(surround, o, place);
        fields.set(index, static_cast<float>(std::abs(options.w1 * c.brightness - options.w2 * s.brightness)),
                   static_cast<float>(std::abs(options.w1 * c.saturation - options.w2 * s.saturation)));
    });
    return fields;
}

} // namespace pellucid
