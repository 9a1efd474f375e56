// The sweep for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void sweepAvx2(const SweepInput& in, const SweepBand& band, SweepScratch& scratch, double* sums) {
    sweepBand(in, band, scratch, sums);
}

} // namespace pellucid
