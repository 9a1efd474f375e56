// Saliency, fast (the sums are explained in ball_sums.h). Work is cut into tiles that are swept along z with a ring of
// slices; what lies within one colour, as half of a scan does, is |w1 − w2|·O and is not computed.
#include "saliency/saliency_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "saliency/slice_ring.h"

namespace pellucid {

namespace {

/// Calls body(from, to) for the floats of each run of set bits, as SliceRing::findBusyBlocks() gives them.
template <class Body>
void forEachRun(std::uint64_t blocks, const Body& body) {
    for (std::uint64_t left = blocks; left != 0;) {
        const int first = std::countr_zero(left), end = first + std::countr_one(left >> first);
        body(2 * (kHaloVoxels + (first - 1) * kBlockVoxels), 2 * (kHaloVoxels + (end - 1) * kBlockVoxels));
        left = end < 64 ? left >> end << end : 0;
    }
}

class TileSweep {
public:
    TileSweep(const BallPair& balls, const BallPlan& plan, const AppearanceReader& reader,
              const SaliencyOptions& options, const Tile& tile, WeightFields& fields, bool used)
        : m_plan(plan.sums()), m_kernel(ballSumsKernel()), m_tile(tile), m_dims(fields.dims()), m_fields(fields),
          m_ring(reader, m_dims, tile, balls[1], m_plan.stride),
          m_scaler(balls, m_dims, tile, m_plan.stride, options, fields), m_used(used),
          m_constantWeight(std::abs(options.w1 - options.w2)), m_reachY(balls[1].reach(1)), m_reachZ(balls[1].reach(2)),
          m_sumsFloats(m_plan.zSumCount * m_plan.stride),
          m_zSums(static_cast<std::size_t>((2 * m_reachY + 1) * m_sumsFloats)),
          m_zeros(static_cast<std::size_t>(m_sumsFloats), 0.0f),
          m_profiles(static_cast<std::size_t>(m_plan.profileCount * m_plan.stride)),
          m_packed(static_cast<std::size_t>(m_plan.stride / 2)), m_busy(static_cast<std::size_t>(tile.y1 - tile.y0)),
          m_rows(static_cast<std::size_t>(2 * std::max(m_reachY, m_reachZ) + 1)) {}

    void run() {
        m_ring.sweep([&](int z) { makeSlice(z); });
    }

private:
    std::uint64_t busy(int y) const {
        return y >= m_tile.y0 && y < m_tile.y1 ? m_busy[static_cast<std::size_t>(y - m_tile.y0)] : 0;
    }

    void makeSlice(int z) {
        m_ring.findBusyBlocks(z, m_busy);
        for (int y = m_tile.y0 - m_reachY; y < m_tile.y1 + m_reachY; ++y) {
            sumRow(y, z);
            if (y - m_reachY >= m_tile.y0) makeRow(y - m_reachY, z);
        }
    }

    float* zSums(int y) {
        const int slots = 2 * m_reachY + 1;
        return m_zSums.get() + (y + slots) % slots * m_sumsFloats;
    }

    /// The sums along z of a row, wherever rows nearby need them.
    void sumRow(int y, int z) {
        if (y < 0 || y >= m_dims.y) return;
        std::uint64_t needed = 0;
        for (int dy = -m_reachY; dy <= m_reachY; ++dy) needed |= busy(y + dy);
        if (needed == 0) return;
        const float** rows = m_rows.data() + m_reachZ;
        for (int dz = -m_reachZ; dz <= m_reachZ; ++dz) rows[dz] = m_ring.row(y, z + dz);
        forEachRun(needed, [&](int from, int to) { m_kernel.sumAlongZ(m_plan, rows, from, to, zSums(y)); });
    }

    void makeRow(int y, int z) {
        const std::size_t first = voxelIndex(m_dims, m_tile.x0, y, z);
        if (m_constantWeight > 0) fillRow(y, z, first);
        if (m_constantWeight == 0 && m_used) m_fields.clear(first, static_cast<std::size_t>(m_tile.x1 - m_tile.x0));
        const std::uint64_t blocks = busy(y);
        if (blocks == 0) return;
        const float** rows = m_rows.data() + m_reachY;
        for (int dy = -m_reachY; dy <= m_reachY; ++dy)
            rows[dy] = y + dy >= 0 && y + dy < m_dims.y ? zSums(y + dy) : m_zeros.data();
        const RowScales scales = m_scaler.at(y, z);
        forEachRun(blocks, [&](int from, int to) {
            m_kernel.packRow(m_plan, rows, scales, from, to, m_profiles.get(), m_packed.get());
            const int x = from / 2 - kHaloVoxels, count = std::min(to / 2 - kHaloVoxels, m_tile.x1 - m_tile.x0) - x;
            m_fields.store(first + static_cast<std::size_t>(x), m_packed.get() + from / 2,
                           static_cast<std::size_t>(count));
        });
    }

    /// |w1 − w2|·O, as if the whole row lay within one colour.
    void fillRow(int y, int z, std::size_t first) {
        const float* row = m_ring.row(y, z) + 2 * kHaloVoxels;
        const float w = static_cast<float>(m_constantWeight);
        for (int x = 0; x < m_tile.x1 - m_tile.x0; ++x) {
            std::array<float, 2> o; // what lies there was not written as floats
            std::memcpy(o.data(), row + 2 * x, sizeof o);
            m_fields.set(first + static_cast<std::size_t>(x), w * o[0], w * o[1]);
        }
    }

    const BallSumsPlan& m_plan;
    const BallSumsKernel& m_kernel;
    Tile m_tile;
    Int3 m_dims;
    WeightFields& m_fields;
    SliceRing m_ring;
    RowScaler m_scaler;
    bool m_used; ///< the fields are not all 0
    double m_constantWeight;
    int m_reachY, m_reachZ;
    std::ptrdiff_t m_sumsFloats; ///< of one row
    AlignedArray<float> m_zSums; ///< a ring of rows
    std::vector<float> m_zeros;
    AlignedArray<float> m_profiles;
    AlignedArray<std::uint32_t> m_packed;
    std::vector<std::uint64_t> m_busy;
    std::vector<const float*> m_rows;
};

} // namespace

WeightFields saliencyFields(const Volume& volume, const TransferFunction& tf, const SaliencyOptions& options,
                            const JobControl& job, const VoxelColors* colors) {
    WeightFields fields;
    updateSaliencyFields(fields, volume, tf, options, job, colors);
    return fields;
}

Int3 saliencyReach(const Geometry& geometry, const SaliencyOptions& options) {
    const BallPair balls = ballsOf(geometry, options);
    return {balls[1].reach(0), balls[1].reach(1), balls[1].reach(2)};
}

namespace {

/// Of a volume of which this process has a part: that part. Throws Error where saliency reaches further.
const Volume* partHere(const Volume& whole, const SaliencyOptions& options) {
    if (whole.elsewhere() == nullptr) return &whole;
    const VoxelRegion own = whole.elsewhere()->own(), stored = whole.elsewhere()->stored();
    const Int3 reach = saliencyReach(whole.geometry(), options);
    for (int a = 0; a < 3 && whole.here(); ++a)
        if (stored.lo[a] > std::max(0, own.lo[a] - reach[a]) ||
            stored.hi[a] < std::min(whole.dims()[a], own.hi[a] + reach[a]))
            throw Error("saliency reaches further than the voxels around a block of the volume", "sigma",
                        "give a smaller one");
    return whole.here().get();
}

} // namespace

void updateSaliencyFields(WeightFields& fields, const Volume& whole, const TransferFunction& tf,
                          const SaliencyOptions& options, const JobControl& job, const VoxelColors* colors) {
    validate(options);
    job.throwIfStopped();
    const WeightForm form = weightFormOf(whole.dims());
    const Volume* const part = partHere(whole, options);
    if (part == nullptr) {
        fields = emptyWeightFields(Int3(0), options, form);
        return;
    }
    const Volume& volume = *part;
    const BallPair balls = ballsOf(volume.geometry(), options);
    const Tiling tiling(volume.dims(), balls);
    const BallPlan plan(balls, tiling.stride());
    const AppearanceReader reader(volume, tf, options.background, colors);
    const bool used = keepWeightFields(fields, volume.dims(), options, form);
    tiling.forEach(job, [&](const Tile& tile) { TileSweep(balls, plan, reader, options, tile, fields, used).run(); });
}

} // namespace pellucid
