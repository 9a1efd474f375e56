#include "saliency/saliency_direct.h"

#include "saliency/slice_ring.h"

namespace pellucid {

namespace {

/// The weights along x of every run of a ball, each run's own times its weight at (dy, dz).
std::vector<std::vector<float>> runWeights(const BallKernel& ball) {
    std::vector<std::vector<float>> all;
    for (const KernelRun& run : ball.runs) {
        std::vector<float>& weights = all.emplace_back();
        for (int dx = -run.halfWidth; dx <= run.halfWidth; ++dx)
            weights.push_back(static_cast<float>(ball.weight(dx, run.dy, run.dz)));
    }
    return all;
}

void sweepTile(const BallPair& balls, const std::array<std::vector<std::vector<float>>, 2>& weights,
               const AppearanceReader& reader, const SaliencyOptions& options, const Tile& tile, std::ptrdiff_t stride,
               WeightFields& fields) {
    const Int3 dims = fields.dims();
    const int width = tile.x1 - tile.x0;
    SliceRing ring(reader, dims, tile, balls[1], stride);
    RowScaler scaler(balls, dims, tile, stride, options, fields);
    const AlignedArray<std::uint32_t> packed(static_cast<std::size_t>(stride / 2));
    std::array<std::vector<DirectRun>, 2> runs;
    ring.sweep([&](int z) {
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (std::size_t b = 0; b < 2; ++b) {
                runs[b].clear();
                for (std::size_t r = 0; r < weights[b].size(); ++r) {
                    const KernelRun& run = balls[b].runs[r];
                    runs[b].push_back({ring.row(y + run.dy, z + run.dz), run.halfWidth, weights[b][r].data()});
                }
            }
            const DirectRun* const first[2] = {runs[0].data(), runs[1].data()};
            const int counts[2] = {static_cast<int>(runs[0].size()), static_cast<int>(runs[1].size())};
            const int blocks = (width + kBlockVoxels - 1) / kBlockVoxels;
            ballSumsKernel().packRowDirect(first, counts, scaler.at(y, z), 2 * kHaloVoxels,
                                           2 * (kHaloVoxels + blocks * kBlockVoxels), packed.get());
            fields.store(voxelIndex(dims, tile.x0, y, z), packed.get() + kHaloVoxels, static_cast<std::size_t>(width));
        }
    });
}

} // namespace

void updateSaliencyFieldsDirect(WeightFields& fields, const Volume& volume, const TransferFunction& tf,
                                const SaliencyOptions& options, const JobControl& job, const VoxelColors* colors) {
    validate(options);
    const BallPair balls = ballsOf(volume.geometry(), options);
    const Tiling tiling(volume.dims(), balls);
    const std::array weights{runWeights(balls[0]), runWeights(balls[1])};
    const AppearanceReader reader(volume, tf, options.background, colors);
    keepWeightFields(fields, volume.dims(), options); // every voxel is written
    tiling.forEach(
        job, [&](const Tile& tile) { sweepTile(balls, weights, reader, options, tile, tiling.stride(), fields); });
}

} // namespace pellucid
