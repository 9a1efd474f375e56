// Linear systems whose unknowns come in blocks that are coupled with the next and the previous block alone: the frames
// of a series.
#pragma once

#include "optimize/solve/matrix.h"

namespace pellucid {

/// The x, a column per block, with own[i]·x_i − beside[i]·x_{i−1} − beside[i+1]ᵀ·x_{i+1} = b_i. All matrices are n×n,
/// as many as b has columns; beside[0] is not used. The whole matrix is symmetric and positive definite. O(blocks·n³).
Matrix solveBlockTridiagonal(std::vector<Matrix> own, const std::vector<Matrix>& beside, Matrix b);

} // namespace pellucid
