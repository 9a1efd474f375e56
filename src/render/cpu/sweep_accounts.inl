// From depths to sums: the visibility v = α·exp(−D) of each voxel, its derivatives, and what features gather of them.
// Implements docs/method.md, "Visibility", the sums of "Visibility-weighted saliency", and "Derivatives": Σ v, Σ v·L_b
// and Σ v·L_s per feature and lane.
//
// Sums are kept in floats over a few slices of a piece, then added to the piece's doubles: flush().
#pragma once

#include "render/cpu/sweep_voxels.inl"

namespace pellucid {
namespace {

/// Read from kJacobianLanes − n on: 1 in lane n, else 0; from 0 on: none.
constexpr float kOneAmongZeros[3 * kJacobianLanes] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
static_assert(kJacobianLanes == 16);

template <SweepMode kMode>
class Accounts {
    using Lanes = LanesOf<kMode>;
    static constexpr int K = Lanes::kLanes, kVectors = Lanes::kVectors;
    static constexpr bool kSingle = kMode == SweepMode::Single;
    static constexpr int kSpread = 4; ///< accumulators that take turns, so that no addition waits for the last

public:
    /// `sums` of the piece, as SweepKernel has them; added to.
    Accounts(const SweepInput& in, SweepScratch& scratch, double* sums)
        : m_in(in), m_sums(sums), m_accumulator(memory<float>(scratch, SweepScratch::Accumulator, size())) {
        clear();
    }

    /// What a block's voxels are accounted with, in registers: stores may not change it, but the compiler cannot know.
    struct Page {
        const std::int32_t* integral;
        const float* alpha;
        const std::uint16_t* featureOfCode;
        const std::uint32_t* weights;       ///< of the first voxel of the block; null where not wanted
        const std::uint8_t* compactWeights; ///< likewise, in place of them
        const std::uint32_t* weightOfByte;
        std::ptrdiff_t weightStep;
        float* sums;           ///< the accumulator
        std::ptrdiff_t spread; ///< from one accumulator to the one that takes turns with it
        Vec8 unit[kVectors];   ///< optical depth of one unit of the table; Jacobian: 0 in lane 0
    };
    Page pageOf(const VoxelBlock& block) const {
        Page page{m_in.integralTable,
                  m_in.alphaTable,
                  m_in.featureOfCode,
                  m_in.weights ? m_in.weights + block.field : nullptr,
                  m_in.compactWeights ? m_in.compactWeights + block.field : nullptr,
                  m_in.weightOfByte,
                  m_in.fieldStrides.u,
                  m_accumulator,
                  static_cast<std::ptrdiff_t>(m_in.features + 1) * 3 * K,
                  {}};
        for (int part = 0; part < kVectors; ++part)
            page.unit[part] = kSingle ? Vec8{} + m_in.depthUnit[0] : load(m_in.depthUnit + part * kWide);
        if (kMode == SweepMode::Jacobian) page.unit[0][0] = 0;
        return page;
    }

    /// Adds what a group of a block shows at its depths: all its listed voxels, or the i-th of them. Always inlined, as
    /// addOne(): the depths are in registers.
    __attribute__((always_inline)) void add(const Page& page, const VoxelBlock& block, int i, const Vec8* depth) const {
        if constexpr (kSingle)
            addEight(page, block, depth[0]);
        else
            addOne(page, block, i, depth);
    }

    /// To be called every few slices: what floats lose stays below 1e-6 of the sum.
    void flush() {
        const std::size_t sums = static_cast<std::size_t>(m_in.features + 1) * 3;
        if (kSingle) {
            for (std::size_t i = 0; i < sums; i += 3) { // the three of a feature
                const float* at = m_accumulator + i * kWide;
                if (none(load(at) != Vec8{})) continue; // of many features few occur in a piece
                for (int n = 0; n < 3 * kWide; ++n)
                    m_sums[i + static_cast<std::size_t>(n / kWide)] += static_cast<double>(at[n]);
            }
        } else {
            for (std::size_t i = 0; i < sums * K * kSpread; ++i)
                m_sums[i % (sums * K)] += static_cast<double>(m_accumulator[i]);
        }
        clear();
    }

private:
    std::size_t size() const {
        return static_cast<std::size_t>(m_in.features + 1) * 3 * (kSingle ? kWide : kSpread * K);
    }
    void clear() {
        for (std::size_t i = 0; i < size(); ++i) m_accumulator[i] = 0.0f;
    }

    static bool isWeighted(const Page& page) { return page.weights || page.compactWeights; }
    static std::uint32_t weightsOf(const Page& page, int n) {
        const std::ptrdiff_t at = n * page.weightStep;
        return page.weights ? page.weights[at] : page.weightOfByte[page.compactWeights[at]];
    }

    /// One transfer function, eight voxels in the lanes.
    void addEight(const Page& page, const VoxelBlock& block, Vec8 depth) const {
        // What each listed voxel is: opacity, feature and weights. The others have opacity 0 and no feature.
        Vec8 alpha = {}, weights[2] = {};
        Int8 feature = Int8{} + kTransparent;
        for (int i = 0; i < block.listed; ++i) {
            const int n = block.list[i];
            alpha[n] = page.alpha[block.codes[n]];
            feature[n] = page.featureOfCode[block.codes[n]];
            if (!isWeighted(page)) continue;
            const std::uint32_t both = weightsOf(page, n);
            weights[0][n] = static_cast<float>(both & 0xffff);
            weights[1][n] = static_cast<float>(both >> 16);
        }
        // What is seen of it.
        const Vec8 seen = expMinus(depth * page.unit[0]) * alpha;
        if (m_in.field)
            for (int i = 0; i < block.listed; ++i)
                m_in.field[block.field + block.list[i] * m_in.fieldStrides.u] = seen[block.list[i]];
        // The features of the block in turn: nearly always one.
        for (int i = 0; i < block.listed; ++i) {
            const int f = feature[block.list[i]];
            if (f < 0) continue; // has had its turn
            float* sum = page.sums + static_cast<std::size_t>(f) * 3 * kWide;
            const Int8 here = feature == f;
            const Vec8 zero = {}, mine = here ? seen : zero;
            store(sum, load(sum) + mine);
            store(sum + kWide, load(sum + kWide) + mine * weights[0]);
            store(sum + 2 * kWide, load(sum + 2 * kWide) + mine * weights[1]);
            feature |= here; // −1
        }
    }

    /// Many functions in the lanes, the i-th listed voxel.
    __attribute__((always_inline)) void addOne(const Page& page, const VoxelBlock& block, int i,
                                               const Vec8* depth) const {
        const int n = block.list[i];
        const std::uint16_t code = block.codes[n];
        const int feature = page.featureOfCode[code];
        Vec8 seen[kVectors];
        if constexpr (kMode == SweepMode::Batch)
            seen[0] = expMinus(depth[0] * page.unit[0]) * load(page.alpha + static_cast<std::size_t>(code) * K);
        else
            differentiate(page, depth, code, feature, seen);
        float* sum = page.sums + (i & (kSpread - 1)) * page.spread + feature * (3 * K);
        addWeighted(sum, seen, 1.0f);
        if (!isWeighted(page)) return;
        const std::uint32_t both = weightsOf(page, n);
        addWeighted(sum + K, seen, static_cast<float>(both & 0xffff));
        addWeighted(sum + 2 * K, seen, static_cast<float>(both >> 16));
    }
    static void addWeighted(float* sum, const Vec8* seen, float weight) {
        for (int part = 0; part < kVectors; ++part)
            store(sum + part * kWide, load(sum + part * kWide) + seen[part] * weight);
    }

    /// v = α·exp(−D) in lane 0, ∂v/∂x_j = exp(−D)·∂α/∂x_j − v·∂D/∂x_j in lane 1 + j.
    void differentiate(const Page& page, const Vec8* depth, std::uint16_t code, int feature, Vec8* seen) const {
        const float* alpha = page.alpha + static_cast<std::size_t>(code) * 2; // α and ∂α/∂x
        const Vec8 light = expMinus(Vec8{} + depth[0][0] * m_in.depthUnit[0]), v = light * alpha[0];
        const int lane = feature - m_in.firstDerivative + 1;
        const bool own = feature < m_in.features && lane >= 1 && lane < K; // lane of the voxel's own feature
        const float *first = kOneAmongZeros + K, *mine = kOneAmongZeros + K - (own ? lane : K);
        for (int part = 0; part < kVectors; ++part, first += kWide, mine += kWide)
            seen[part] = v * (load(first) - depth[part] * page.unit[part]) + light * alpha[1] * load(mine);
    }

    const SweepInput& m_in;
    double* m_sums;
    float* m_accumulator; ///< Single: [features + 1][3][eight voxels], else [kSpread][features + 1][3][K]
};

} // namespace
} // namespace pellucid
