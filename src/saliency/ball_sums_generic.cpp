// The loops for vectors of 16 bytes, which every x86-64 and ARM processor has, and the choice between them and others.
#define PELLUCID_VECTOR_BYTES 16
#include "saliency/ball_sums.inl"

namespace pellucid {

const BallSumsKernel kBallSumsGeneric{sumRangeAlongZ, packRow, packRowDirect};

std::span<const BallSumsKernel* const> ballSumsKernels() {
#ifdef PELLUCID_HAVE_X86_BALL_SUMS
    static constexpr const BallSumsKernel* kAll[] = {&kBallSumsAvx512, &kBallSumsAvx2, &kBallSumsGeneric};
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    static const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                               __builtin_cpu_supports("avx512vl");
    return std::span(kAll).subspan(avx512 ? 0 : avx2 ? 1 : 2);
#else
    static constexpr const BallSumsKernel* kAll[] = {&kBallSumsGeneric};
    return kAll;
#endif
}

const BallSumsKernel& ballSumsKernel() { return *ballSumsKernels().front(); }

} // namespace pellucid
