// The sweep for any processor, and what all instruction sets share.
#include <algorithm>
#include <cmath>
#include <memory>

#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void* SweepScratch::bytes(Slot slot, std::size_t count) {
    constexpr std::size_t kAlignment = 64;
    auto& v = m_memory[slot];
    if (v.size() < count + kAlignment) v.resize(count + kAlignment);
    void* p = v.data();
    std::size_t space = v.size();
    return std::align(kAlignment, count, p, space);
}

std::vector<SweepBand> sweepBands(const SweepInput& in) {
    constexpr int kRowsPerBand =
        12; // one row in thirteen is computed twice; small volumes still give every thread work
    double lo = 1e30, hi = -1e30;
    for (const int k : {0, in.nw - 1}) {
        const double scale = in.perspective ? in.firstSlopeStep * (k - in.eyeW) : in.raySpacing;
        const double base = in.perspective ? in.eyeV : in.slopeV * k;
        lo = std::min(lo, (0 - base) / scale);
        hi = std::max(hi, (in.nv - 1 - base) / scale);
    }
    const int first = static_cast<int>(std::floor(lo)), last = static_cast<int>(std::floor(hi)) + 1;
    std::vector<SweepBand> bands;
    for (int b = first; b < last; b += kRowsPerBand)
        bands.push_back({b, std::min(last, b + kRowsPerBand), false, false});
    bands.front().outermostLow = true;
    bands.back().outermostHigh = true;
    return bands;
}

void sweepGeneric(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    sweepBand(in, band, scratch, sums);
}

SweepKernel sweepKernel() {
#ifdef PELLUCID_HAVE_AVX2_SWEEP
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (avx2) return sweepAvx2;
#endif
    return sweepGeneric;
}

} // namespace pellucid
