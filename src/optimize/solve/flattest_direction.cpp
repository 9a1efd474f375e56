#include "optimize/solve/flattest_direction.h"

#include <Eigen/Cholesky>

namespace pellucid {

Vector flattestDirection(const Matrix& jacobian) {
    Matrix normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += 1e-9 * normal.trace() + 1e-300;
    const Eigen::LDLT<Matrix> factor(normal);
    Vector along = Vector::Ones(jacobian.cols());
    for (int round = 0; round < 8; ++round) {
        along = factor.solve(along).eval();
        along /= along.lpNorm<Eigen::Infinity>();
    }
    return along;
}

} // namespace pellucid
