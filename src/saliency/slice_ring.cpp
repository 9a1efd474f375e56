#include "saliency/slice_ring.h"

#include <algorithm>
#include <atomic>

#include <glm/common.hpp>

#include "base/parallel.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

// Tiles are large enough that their halos cost little, and small enough that a ring of slices stays in the
// second-level cache: 7 · 38 rows of 192 + 32 voxels are 477 KB.
constexpr int kTileWidth = 192, kTileRows = 32, kTileSlices = 96;
static_assert(kTileWidth <= kLargestTileWidth);

/// `count` cut into equal parts of at most `most`.
int partSize(int count, int most) {
    const int parts = (count + most - 1) / most;
    return (count + parts - 1) / parts;
}

/// All ones from bit 0 to bit n − 1.
std::uint64_t lowBits(int n) { return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1; }

bool allEqual(const AppearanceReader::Pair* pairs, int count) {
    // In noise a look at few voxels is enough.
    if (pairs[0] != pairs[count - 1] || pairs[0] != pairs[count / 2]) return false;
    AppearanceReader::Pair difference = 0;
    if (count == kBlockVoxels)
        for (int i = 0; i < kBlockVoxels; ++i) difference |= pairs[i] ^ pairs[0];
    else
        for (int i = 1; i < count; ++i) difference |= pairs[i] ^ pairs[0];
    return difference == 0;
}

} // namespace

Tiling::Tiling(const Int3& dims, const BallPair& balls) : m_dims(dims) {
    const int width = partSize(dims.x, kTileWidth);
    m_size.x = (width + kBlockVoxels - 1) / kBlockVoxels * kBlockVoxels;
    m_size.y = partSize(dims.y, std::max(kTileRows, 4 * balls[1].reach(1)));
    m_size.z = partSize(dims.z, std::max(kTileSlices, 6 * balls[1].reach(2)));
    for (int a = 0; a < 3; ++a) m_count[a] = (dims[a] + m_size[a] - 1) / m_size[a];
}

Tile Tiling::tile(std::size_t index) const {
    const Int3 first = voxelAt(m_count, index) * m_size;
    const Int3 end = glm::min(first + m_size, m_dims);
    return {first.x, end.x, first.y, end.y, first.z, end.z};
}

void Tiling::forEach(const JobControl& job, const std::function<void(const Tile&)>& body) const {
    const std::size_t count = voxelCount(m_count);
    std::atomic<std::size_t> done = 0;
    parallelFor(count, [&](std::size_t i) {
        job.throwIfStopped();
        body(tile(i));
        job.report(static_cast<double>(++done) / static_cast<double>(count));
    });
}

SliceRing::SliceRing(const AppearanceReader& reader, const Int3& dims, const Tile& tile, const BallKernel& surround,
                     std::ptrdiff_t stride)
    : m_reader(reader), m_dims(dims), m_tile(tile), m_reach{surround.reach(0), surround.reach(1), surround.reach(2)},
      m_slots(2 * m_reach[2] + 1), m_firstRow(std::max(0, tile.y0 - m_reach[1])),
      m_endRow(std::min(dims.y, tile.y1 + m_reach[1])), m_rowVoxels(static_cast<std::size_t>(stride / 2)),
      m_pairs(static_cast<std::size_t>(m_slots * (m_endRow - m_firstRow)) * m_rowVoxels), m_zeros(m_rowVoxels, 0),
      m_agreements(static_cast<std::size_t>(m_slots * (m_endRow - m_firstRow))),
      m_agreeing(static_cast<std::size_t>(m_endRow - m_firstRow)) {
    // Positions in a row: voxel x is at x − x0 + kHaloVoxels.
    const int end = dims.x - tile.x0 + kHaloVoxels; // of the volume
    const int tileEnd = tile.x1 - tile.x0 + kHaloVoxels;
    m_voxels = {tile.x0 > 0 ? kHaloVoxels - m_reach[0] : kHaloVoxels, std::min(end, tileEnd + m_reach[0])};
    m_blocks.push_back({m_voxels.first, kHaloVoxels});
    for (int first = kHaloVoxels; first < tileEnd; first += kBlockVoxels)
        m_blocks.push_back({first, std::min(first + kBlockVoxels, tileEnd)});
    m_blocks.push_back({tileEnd, m_voxels.end});
}

const float* SliceRing::row(int y, int z) const {
    const bool inside = y >= 0 && y < m_dims.y && z >= 0 && z < m_dims.z;
    return reinterpret_cast<const float*>(inside ? pairs(y, z) : m_zeros.data());
}

SliceRing::Agreement SliceRing::agreementOf(const Pair* row, const Pair* above, const Pair* before) const {
    Agreement agreement{~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}};
    for (std::size_t b = 0; b < m_blocks.size(); ++b) {
        const Block block = m_blocks[b];
        if (block.first == block.end) continue; // outside the volume
        const std::uint64_t bit = std::uint64_t{1} << b;
        const Pair first = row[block.first];
        if (!allEqual(row + block.first, block.end - block.first)) {
            agreement.inside &= ~bit; // whatever agrees with it, it is busy
            continue;
        }
        if (b + 1 < m_blocks.size() && m_blocks[b + 1].first < m_blocks[b + 1].end &&
            row[m_blocks[b + 1].first] != first)
            agreement.next &= ~bit;
        if (above != nullptr && above[block.first] != first) agreement.above &= ~bit;
        if (before != nullptr && before[block.first] != first) agreement.before &= ~bit;
    }
    return agreement;
}

void SliceRing::load(int z) {
    const int count = m_voxels.end - m_voxels.first;
    const int x = m_tile.x0 + m_voxels.first - kHaloVoxels;
    if (m_firstSlice < 0) m_firstSlice = z;
    for (int y = m_firstRow; y < m_endRow; ++y) {
        Pair* row = m_pairs.get() + rowIndex(y, z) * m_rowVoxels;
        std::fill_n(row, m_voxels.first, 0);
        m_reader.readRow(voxelIndex(m_dims, x, y, z), count, row + m_voxels.first);
        std::fill(row + m_voxels.end, row + m_rowVoxels, 0);
        m_agreements[rowIndex(y, z)] =
            agreementOf(row, y > m_firstRow ? pairs(y - 1, z) : nullptr, z > m_firstSlice ? pairs(y, z - 1) : nullptr);
    }
}

void SliceRing::sweep(const std::function<void(int z)>& body) {
    int next = std::max(0, m_tile.z0 - m_reach[2]); // slice to be loaded
    for (int z = m_tile.z0; z < m_tile.z1; ++z) {
        for (; next <= std::min(z + m_reach[2], m_dims.z - 1); ++next) load(next);
        body(z);
    }
}

void SliceRing::findBusyBlocks(int z, std::vector<std::uint64_t>& busy) {
    const int z0 = std::max(0, z - m_reach[2]), z1 = std::min(m_dims.z - 1, z + m_reach[2]);
    for (int y = m_firstRow; y < m_endRow; ++y) { // along z
        std::uint64_t agreeing = m_agreements[rowIndex(y, z0)].inside;
        for (int k = z0 + 1; k <= z1; ++k) {
            const Agreement& a = m_agreements[rowIndex(y, k)];
            agreeing &= a.inside & a.before;
        }
        m_agreeing[static_cast<std::size_t>(y - m_firstRow)] = agreeing;
    }
    const std::uint64_t blocks = lowBits(static_cast<int>(m_blocks.size()) - 2) << 1;
    for (int y = m_tile.y0; y < m_tile.y1; ++y) {
        const int y0 = std::max(0, y - m_reach[1]), y1 = std::min(m_dims.y - 1, y + m_reach[1]);
        std::uint64_t agreeing = m_agreeing[static_cast<std::size_t>(y0 - m_firstRow)];
        for (int j = y0 + 1; j <= y1; ++j)
            agreeing &= m_agreeing[static_cast<std::size_t>(j - m_firstRow)] & m_agreements[rowIndex(j, z)].above;
        const std::uint64_t next = m_agreements[rowIndex(y, z)].next;
        const std::uint64_t constant = agreeing & (agreeing << 1) & (next << 1) & (agreeing >> 1) & next;
        busy[static_cast<std::size_t>(y - m_tile.y0)] = ~constant & blocks;
    }
}

RowScaler::RowScaler(const BallPair& balls, const Int3& dims, const Tile& tile, std::ptrdiff_t stride,
                     const SaliencyOptions& options, const WeightFields& fields)
    : m_norms{BallNorm(balls[0], dims), BallNorm(balls[1], dims)}, m_reach{balls[1].reach(0), balls[1].reach(1),
                                                                           balls[1].reach(2)},
      m_dims(dims), m_tile(tile), m_w{options.w1, options.w2} {
    for (int a = 0; a < 2; ++a) {
        const double unit = static_cast<double>(fields.scale(a));
        m_unitsPerWeight[static_cast<std::size_t>(a)] = unit > 0 ? 1 / unit : 0;
    }
    for (auto& scales : m_scales) scales.assign(static_cast<std::size_t>(stride), 0.0f);
}

RowScales RowScaler::at(int y, int z) {
    // Rows as far from the volume's sides, or beyond reach of them, have the same scales.
    const auto representative = [](int i, int n, int reach) {
        return i < reach ? i : std::max(reach, i - (n - 1 - 2 * reach));
    };
    const int yLike = representative(y, m_dims.y, m_reach[1]), zLike = representative(z, m_dims.z, m_reach[2]);
    const bool known = yLike == m_y && zLike == m_z;
    m_y = yLike, m_z = zLike;
    if (!known)
        for (std::size_t ball = 0; ball < 2; ++ball) {
            double scale = 0;
            for (int x = m_tile.x0; x < m_tile.x1; ++x) {
                if (x == m_tile.x0 || x <= m_reach[0] || x >= m_dims.x - m_reach[0])
                    scale = m_w[ball] / m_norms[ball].at(x, y, z);
                float* at = &m_scales[ball][2 * static_cast<std::size_t>(x - m_tile.x0 + kHaloVoxels)];
                for (std::size_t a = 0; a < 2; ++a) at[a] = static_cast<float>(scale * m_unitsPerWeight[a]);
            }
        }
    return {m_scales[0].data(), m_scales[1].data()};
}

} // namespace pellucid
