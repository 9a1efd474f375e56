// The matrices and vectors that are calculated with; what layers above hand on is std::vector.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pellucid {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// The same numbers, not copied.
inline Eigen::Map<const Vector> vectorOf(const std::vector<double>& v) {
    return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// Of rows of equal length, [row][column].
inline Matrix matrixOf(const std::vector<std::vector<double>>& rows) {
    Matrix m(rows.size(), rows.empty() ? 0 : rows.front().size());
    for (std::size_t i = 0; i < rows.size(); ++i) m.row(static_cast<Eigen::Index>(i)) = vectorOf(rows[i]);
    return m;
}

} // namespace pellucid
