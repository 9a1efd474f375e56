// The loops for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#define PELLUCID_VECTOR_BYTES 32
#include "saliency/ball_sums.inl"

namespace pellucid {

const BallSumsKernel kBallSumsAvx2{sumRangeAlongZ, packRow, packRowDirect};

} // namespace pellucid
