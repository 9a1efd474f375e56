// The appearance of a tile of a volume, slice by slice, as the sums over balls read it (ball_sums.h).
#pragma once

#include <functional>
#include <memory>
#include <new>
#include <vector>

#include "saliency/appearance.h"
#include "saliency/ball_plan.h"

namespace pellucid {

/// Rows are cut into blocks of this many voxels, which are computed or left out as one.
inline constexpr int kBlockVoxels = BallSumsKernel::kRangeFloats / 2;
/// Voxels in front of a tile's rows and behind them: as many as a ball can reach (σ ≤ 8).
inline constexpr int kHaloVoxels = 16;
inline constexpr int kLargestTileWidth = 61 * kBlockVoxels; ///< blocks and both halos are bits of one word

/// The voxels that one piece of work makes.
struct Tile {
    int x0, x1, y0, y1, z0, z1; ///< [x0, x1) × …; x0 is a multiple of kBlockVoxels
};

/// The tiles of a volume: depends on it and on the reach of the balls alone, never on threads.
class Tiling {
public:
    Tiling(const Int3& dims, const BallPair& balls);
    /// Calls body(tile) for each, on any thread. Throws Cancelled.
    void forEach(const JobControl& job, const std::function<void(const Tile&)>& body) const;
    /// Floats of a row with its halos.
    std::ptrdiff_t stride() const { return 2 * (m_size.x + 2 * kHaloVoxels); }

private:
    Tile tile(std::size_t index) const;
    Int3 m_dims, m_size, m_count;
};

/// Memory at addresses that suit the widest vectors; not initialised.
template <class T>
class AlignedArray {
public:
    explicit AlignedArray(std::size_t count)
        : m_data(static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64}))) {}
    T* get() const noexcept { return m_data.get(); }

private:
    struct Free {
        void operator()(T* p) const { ::operator delete (p, std::align_val_t{64}); }
    };
    std::unique_ptr<T, Free> m_data;
};

/// The last 2·reachZ + 1 slices of a tile, with all that its balls reach around it; 0 outside the volume.
class SliceRing {
public:
    SliceRing(const AppearanceReader& reader, const Int3& dims, const Tile& tile, const BallKernel& surround,
              std::ptrdiff_t stride);

    /// Calls body(z) for the slices of the tile, in ascending order, with all in the ring that its balls reach.
    void sweep(const std::function<void(int z)>& body);
    /// One row's floats; halo first. Zeros where (y, z) lies outside the volume.
    const float* row(int y, int z) const;

    /// Bit 1 + b of the answer: the tile's block b has voxels whose balls hold more than one colour. `busy` has a word
    /// per row of the tile.
    void findBusyBlocks(int z, std::vector<std::uint64_t>& busy);

private:
    using Pair = AppearanceReader::Pair;
    /// Blocks as bits: first the halo in front, last the halo behind. Voxels outside the volume never disagree.
    struct Agreement {
        std::uint64_t inside; ///< all voxels of the block have one colour
        std::uint64_t next;   ///< the first voxels of this block and the next agree
        std::uint64_t above;  ///< … of this row and the one before
        std::uint64_t before; ///< … of this slice and the one before
    };
    struct Block {
        int first, end; ///< voxels of a row, inside the volume
    };
    std::size_t rowIndex(int y, int z) const {
        return static_cast<std::size_t>(z % m_slots) * static_cast<std::size_t>(m_endRow - m_firstRow) +
               static_cast<std::size_t>(y - m_firstRow);
    }
    void load(int z); ///< in ascending order, inside the volume
    const Pair* pairs(int y, int z) const { return m_pairs.get() + rowIndex(y, z) * m_rowVoxels; }
    Agreement agreementOf(const Pair* row, const Pair* above, const Pair* before) const;

    const AppearanceReader& m_reader;
    Int3 m_dims;
    Tile m_tile;
    std::array<int, 3> m_reach;
    int m_slots, m_firstRow, m_endRow;
    std::size_t m_rowVoxels;
    std::vector<Block> m_blocks;
    Block m_voxels{0, 0}; ///< of a row: those in reach, inside the volume
    AlignedArray<Pair> m_pairs;
    std::vector<Pair> m_zeros;
    std::vector<Agreement> m_agreements;
    std::vector<std::uint64_t> m_agreeing; ///< per row, along z
    int m_firstSlice = -1;                 ///< the first that was loaded
};

/// RowScales for the rows of a tile.
class RowScaler {
public:
    RowScaler(const BallPair& balls, const Int3& dims, const Tile& tile, std::ptrdiff_t stride,
              const SaliencyOptions& options, const WeightFields& fields);
    RowScales at(int y, int z); ///< valid until the next call

private:
    std::array<BallNorm, 2> m_norms;
    std::array<int, 3> m_reach;
    Int3 m_dims;
    Tile m_tile;
    std::array<double, 2> m_w, m_unitsPerWeight;
    std::array<std::vector<float>, 2> m_scales; ///< by ball
    int m_y = -1, m_z = -1;                     ///< the row that m_scales were made for
};

} // namespace pellucid
