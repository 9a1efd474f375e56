// The loops for vectors of 16 bytes, which every x86-64 and ARM processor has, and the choice between them and others.
#define PELLUCID_VECTOR_BYTES 16
#include "saliency/ball_sums.inl"

namespace pellucid {

const BallSumsKernel kBallSumsGeneric{sumRangeAlongZ, packRow, packRowDirect};

const BallSumsKernel& ballSumsKernel() {
#ifdef PELLUCID_HAVE_X86_BALL_SUMS
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    static const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                               __builtin_cpu_supports("avx512vl");
    if (avx512) return kBallSumsAvx512;
    if (avx2) return kBallSumsAvx2;
#endif
    return kBallSumsGeneric;
}

} // namespace pellucid
