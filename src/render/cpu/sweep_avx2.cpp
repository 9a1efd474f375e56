// The sweep for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void sweepAvx2(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums) {
    sweepPiece(in, piece, scratch, sums);
}

} // namespace pellucid
