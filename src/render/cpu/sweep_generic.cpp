// The sweep for any processor, and what all instruction sets share.
#include <algorithm>
#include <cmath>

#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

float* SweepScratch::floats(int slot, std::size_t count) {
    auto& v = m_floats[slot];
    if (v.size() < count) v.resize(count);
    return v.data();
}

int* SweepScratch::ints(int slot, std::size_t count) {
    auto& v = m_ints[slot];
    if (v.size() < count) v.resize(count);
    return v.data();
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

void sweepGeneric8(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    Band<Vec8>(in, band, scratch, sums).run();
}
void sweepGeneric1(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    Band<float>(in, band, scratch, sums).run();
}

SweepKernel sweepKernel(int lanes) {
#ifdef PELLUCID_HAVE_AVX2_SWEEP
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (avx2) return lanes == 1 ? sweepAvx2x1 : sweepAvx2x8;
#endif
    return lanes == 1 ? sweepGeneric1 : sweepGeneric8;
}

} // namespace pellucid
