#include "optimize/solve/block_tridiagonal.h"

#include <Eigen/Cholesky>

namespace pellucid {

// Factorized block by block, LDLᵀ: what is left of own[i] without the blocks before it is positive definite, too.
Matrix solveBlockTridiagonal(std::vector<Matrix> own, const std::vector<Matrix>& beside, Matrix b) {
    const std::size_t blocks = own.size();
    const auto column = [&b](std::size_t i) { return b.col(static_cast<Eigen::Index>(i)); };
    std::vector<Eigen::LDLT<Matrix>> factors;
    for (std::size_t i = 0; i < blocks; ++i) {
        if (i > 0) {
            own[i] -= beside[i] * factors[i - 1].solve(beside[i].transpose());
            column(i) += beside[i] * factors[i - 1].solve(column(i - 1));
        }
        factors.emplace_back(own[i]);
    }
    for (std::size_t i = blocks; i-- > 0;) {
        if (i + 1 < blocks) column(i) += beside[i + 1].transpose() * column(i + 1);
        column(i) = factors[i].solve(column(i)).eval();
    }
    return b;
}

} // namespace pellucid
