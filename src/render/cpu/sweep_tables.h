// The transfer functions of a sweep as its kernel reads them (see sweep.h).
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "render/cpu/sweep.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// How the codes of a volume are to be read: intensity is code / max.
struct SweepCodes {
    int max = 65535;
    bool someInvalid = false; ///< kInvalidCode is no intensity
    bool fine = false;        ///< tables are to have more entries
};

/// Side by side in lanes. Lanes without a transfer function of their own repeat the last one, so that they keep no ray
/// alive. Depends on the transfer functions and on SweepCodes::max and `fine` alone: blocks of one volume have the
/// same.
class SweepTables {
public:
    /// Up to kSweepLanes candidates, which share the features of the first. Throws Error for too many features.
    SweepTables(std::span<const TransferFunction> tfs, const SweepCodes& codes);
    /// One transfer function and the derivatives of its depth by the peaks of features from `firstDerivative` on.
    /// A voxel that is transparent now but not under a higher peak counts: its visibility has a derivative.
    SweepTables(const TransferFunction& tf, int firstDerivative, const SweepCodes& codes);

    /// Per block of kBlockSize³ voxels, of the given ranges of codes (low > high: nothing valid): a bit per lane that
    /// is opaque anywhere in the range; for derivatives all bits if any lane is.
    std::vector<std::uint8_t> opaqueBlocks(const std::vector<std::array<std::uint16_t, 2>>& ranges) const;

    /// Sets what SweepInput says of transfer functions; refers to this.
    void giveTo(SweepInput& in) const;

    SweepMode mode() const { return m_mode; }
    /// Lanes that say something of their own.
    int usedLanes() const { return m_used; }
    std::size_t features() const { return m_features; }
    /// Of a kernel's sums: [features + 1][3][lanes].
    std::size_t sumCount() const { return (m_features + 1) * 3 * m_lanes; }

private:
    SweepTables(SweepMode mode, std::span<const Feature> features, const SweepCodes& codes);
    template <class Taus>
    void fillIntegral(const Taus& taus);
    template <class Fill>
    void fillCodes(const std::vector<Feature>& features, const Fill& fill);

    SweepMode m_mode;
    std::size_t m_features, m_lanes, m_codes, m_entries = 0;
    bool m_someInvalid;
    int m_firstDerivative = 0, m_used = 1;
    float m_entryOfCode = 0;
    std::vector<std::int32_t> m_integral;
    std::vector<float> m_alpha;
    std::array<float, kJacobianLanes> m_units{};
    std::vector<std::uint16_t> m_featureOfCode;
    std::vector<int> m_opaqueCodes; ///< [codes + 1][lanes], how many before
};

/// Calls body(first, last) for pieces of [0, count), on any thread.
void inSweepPieces(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body);

} // namespace pellucid
