#include "render/cpu/sweep_tables.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr int kTableEntries = 4096; ///< at most; 128 KiB with 8 lanes: stays in the second-level cache
constexpr int kFineTableEntries = 16384;

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }

} // namespace

void inSweepPieces(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t kPiece = 1024;
    parallelFor((count + kPiece - 1) / kPiece,
                [&](std::size_t i) { body(i * kPiece, std::min(count, (i + 1) * kPiece)); });
}

SweepTables::SweepTables(SweepMode mode, std::span<const Feature> features, const SweepCodes& codes)
    : m_mode(mode), m_features(features.size()), m_lanes(asSize(lanesOf(mode))), m_codes(asSize(codes.max) + 1),
      m_someInvalid(codes.someInvalid) {
    if (features.size() >= kTransparent)
        throw Error("at most " + std::to_string(kTransparent - 1) + " features can be measured", "transfer function",
                    "join some");
    // Where codes are exact every value has an entry of its own, so that what is constant is measured exactly.
    const int most = codes.fine ? kFineTableEntries : kTableEntries;
    const int perValue = std::max(1, (most - 1) / codes.max);
    m_entries = asSize(std::min(codes.max * perValue, most - 1)) + 1;
    m_entryOfCode = static_cast<float>(m_entries - 1) / static_cast<float>(codes.max);
}

/// `taus(s, tau)` sets the lanes that are not 0.
template <class Taus>
void SweepTables::fillIntegral(const Taus& taus) {
    std::vector<double> tau(m_entries * m_lanes, 0.0);
    inSweepPieces(m_entries, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            taus(static_cast<double>(i) / static_cast<double>(m_entries - 1), &tau[i * m_lanes]);
    });
    // 32-bit integers, since differences of floats that large would drown a small τ.
    m_integral.assign((m_entries + 1) * m_lanes, 0);
    for (std::size_t lane = 0; lane < m_lanes; ++lane) {
        double all = 0;
        for (std::size_t i = 0; i < m_entries; ++i) all += tau[i * m_lanes + lane];
        const double unit = all > 0 ? all / (1 << 30) : 1;
        m_units[lane] = static_cast<float>(unit);
        double sum = 0;
        for (std::size_t i = 0; i < m_entries; ++i) {
            sum += tau[i * m_lanes + lane];
            m_integral[(i + 1) * m_lanes + lane] = static_cast<std::int32_t>(std::lround(sum / unit));
        }
    }
}

/// `fill(code, s)` fills α and gives a bit per lane in which voxels of that code count.
template <class Fill>
void SweepTables::fillCodes(const std::vector<Feature>& features, const Fill& fill) {
    m_featureOfCode.assign(65536, kTransparent);
    std::vector<std::uint16_t> opaque(m_codes);
    inSweepPieces(m_codes, [&](std::size_t first, std::size_t last) {
        for (std::size_t code = first; code < last; ++code) {
            const double s = static_cast<double>(code) / static_cast<double>(m_codes - 1);
            opaque[code] = static_cast<std::uint16_t>(fill(code, s));
            if (opaque[code] == 0) continue;
            const int f = featureAt(features, s);
            m_featureOfCode[code] = static_cast<std::uint16_t>(f < 0 ? static_cast<int>(m_features) : f);
        }
    });
    if (m_someInvalid) m_featureOfCode[kInvalidCode] = kTransparent;
    m_opaqueCodes.assign((m_codes + 1) * m_lanes, 0);
    for (std::size_t i = 0; i < m_codes * m_lanes; ++i)
        m_opaqueCodes[i + m_lanes] = m_opaqueCodes[i] + (opaque[i / m_lanes] >> (i % m_lanes) & 1);
}

SweepTables::SweepTables(std::span<const TransferFunction> tfs, const SweepCodes& codes)
    : SweepTables(tfs.size() == 1 ? SweepMode::Single : SweepMode::Batch, tfs[0].features, codes) {
    m_used = static_cast<int>(tfs.size());
    std::vector<TfSampler> samplers(tfs.begin(), tfs.end());
    while (samplers.size() < m_lanes) samplers.push_back(samplers.back());
    fillIntegral([&](double s, double* tau) {
        for (std::size_t lane = 0; lane < m_lanes; ++lane) tau[lane] = opticalDepthOfOpacity(samplers[lane].opacity(s));
    });
    m_alpha.assign(m_codes * m_lanes, 0.0f);
    fillCodes(tfs[0].features, [&](std::size_t code, double s) {
        unsigned opaque = 0;
        for (std::size_t lane = 0; lane < m_lanes; ++lane) {
            const double a = samplers[lane].opacity(s);
            m_alpha[code * m_lanes + lane] = static_cast<float>(a);
            if (a > 0) opaque |= 1u << lane;
        }
        return opaque;
    });
}

SweepTables::SweepTables(const TransferFunction& tf, int firstDerivative, const SweepCodes& codes)
    : SweepTables(SweepMode::Jacobian, tf.features, codes) {
    m_firstDerivative = firstDerivative;
    m_used = std::min(kJacobianLanes, 1 + static_cast<int>(tf.features.size()) - firstDerivative);
    const TfSampler sampler(tf), shapes(withFullPeaks(tf));
    fillIntegral([&](double s, double* tau) {
        const double a = sampler.opacity(s);
        tau[0] = opticalDepthOfOpacity(a);
        const int lane = featureAt(tf.features, s) - firstDerivative + 1;
        if (lane >= 1 && lane < kJacobianLanes && a < kMaxOpacity) tau[lane] = shapes.opacity(s) / (1 - a);
    });
    m_alpha.assign(m_codes * 2, 0.0f);
    fillCodes(tf.features, [&](std::size_t code, double s) {
        m_alpha[2 * code] = static_cast<float>(sampler.opacity(s));
        if (featureAt(tf.features, s) >= 0) m_alpha[2 * code + 1] = static_cast<float>(shapes.opacity(s));
        return m_alpha[2 * code] > 0 || m_alpha[2 * code + 1] > 0 ? 1u : 0u;
    });
}

std::vector<std::uint8_t> SweepTables::opaqueBlocks(const std::vector<std::array<std::uint16_t, 2>>& ranges) const {
    std::vector<std::uint8_t> opaque(ranges.size(), 0);
    inSweepPieces(ranges.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto [low, high] = ranges[i];
            if (low > high) continue; // nothing valid
            const auto first = static_cast<std::size_t>(static_cast<float>(low) * m_entryOfCode),
                       last = static_cast<std::size_t>(static_cast<float>(high) * m_entryOfCode) + 1;
            const auto *before = &m_integral[first * m_lanes],
                       *after = &m_integral[std::min(last + 1, m_entries) * m_lanes];
            const auto *codesBefore = &m_opaqueCodes[low * m_lanes],
                       *codesAfter = &m_opaqueCodes[(asSize(high) + 1) * m_lanes];
            unsigned lanes = 0;
            for (std::size_t lane = 0; lane < m_lanes; ++lane)
                if (after[lane] != before[lane] || codesAfter[lane] != codesBefore[lane]) lanes |= 1u << lane;
            opaque[i] = static_cast<std::uint8_t>(m_mode == SweepMode::Jacobian && lanes != 0 ? 255 : lanes);
        }
    });
    return opaque;
}

void SweepTables::giveTo(SweepInput& in) const {
    in.mode = m_mode;
    in.tableEntryOfCode = m_entryOfCode;
    in.integralTable = m_integral.data();
    in.alphaTable = m_alpha.data();
    in.featureOfCode = m_featureOfCode.data();
    in.features = static_cast<int>(m_features);
    in.firstDerivative = m_firstDerivative;
    std::copy(m_units.begin(), m_units.end(), in.depthUnit);
}

} // namespace pellucid
