// The loops for x86-64 processors with AVX-512 (F, BW, VL); compiled with those switched on.
#define PELLUCID_VECTOR_BYTES 64
#include "saliency/ball_sums.inl"

namespace pellucid {

const BallSumsKernel kBallSumsAvx512{sumRangeAlongZ, packRow, packRowDirect};

} // namespace pellucid
