// The sweep for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void sweepAvx2x8(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    Band<Vec8>(in, band, scratch, sums).run();
}
void sweepAvx2x1(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    Band<float>(in, band, scratch, sums).run();
}

} // namespace pellucid
