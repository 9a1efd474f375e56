// The direction along which a linear function changes least.
#pragma once

#include "optimize/solve/matrix.h"

namespace pellucid {

/// About the d that minimises |jacobian · d| / |d|, by inverse iteration from equal parts; its largest entry is ±1.
/// Where several directions are as flat as each other, the part of equal parts that lies in them.
Vector flattestDirection(const Matrix& jacobian);

} // namespace pellucid
