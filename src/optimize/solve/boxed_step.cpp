#include "optimize/solve/boxed_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pellucid {

namespace {

/// Solves A_FF·p = b by Cholesky, F the indices `free`.
std::vector<double> solve(const Matrix& a, const std::vector<std::size_t>& free, std::vector<double> b) {
    const std::size_t n = free.size();
    std::vector<double> l(n * n, 0.0);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[free[i]][free[j]];
            for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
            // Rounding can take a tiny pivot below 0: then nothing is known along it, and nothing moves.
            l[i * n + j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / l[j * n + j];
        }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= l[i * n + k] * b[k];
        b[i] /= l[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k * n + i] * b[k];
        b[i] /= l[i * n + i];
    }
    return b;
}

} // namespace

std::vector<double> boxedStep(const Matrix& a, const std::vector<double>& g, const std::vector<double>& lowest,
                              const std::vector<double>& highest) {
    const std::size_t n = g.size();
    std::vector<double> p(n, 0.0);
    std::vector<bool> bound(n, false);
    const auto slope = [&](std::size_t i) {
        double sum = g[i];
        for (std::size_t j = 0; j < n; ++j) sum += a[i][j] * p[j];
        return sum;
    };
    for (std::size_t round = 0; round < 4 * n + 8; ++round) {
        std::vector<std::size_t> free;
        std::vector<double> rhs;
        for (std::size_t i = 0; i < n; ++i)
            if (!bound[i]) {
                free.push_back(i);
                rhs.push_back(-slope(i));
            }
        const std::vector<double> toMinimum = solve(a, free, std::move(rhs));
        // As far towards the minimum over the free ones as the box goes.
        double length = 1;
        std::size_t hit = n;
        for (std::size_t k = 0; k < free.size(); ++k) {
            const double d = toMinimum[k], room = (d > 0 ? highest : lowest)[free[k]] - p[free[k]];
            if (d != 0 && room / d < length) {
                length = std::max(0.0, room / d);
                hit = free[k];
            }
        }
        for (std::size_t k = 0; k < free.size(); ++k) {
            const std::size_t i = free[k];
            p[i] = std::clamp(p[i] + length * toMinimum[k], lowest[i], highest[i]);
        }
        if (hit < n) {
            p[hit] = p[hit] - lowest[hit] < highest[hit] - p[hit] ? lowest[hit] : highest[hit];
            bound[hit] = true;
            continue;
        }
        // At the minimum of this face: the bound that pulls inwards most is let go.
        double most = 1e-12;
        std::size_t released = n;
        for (std::size_t i = 0; i < n; ++i) {
            if (!bound[i] || lowest[i] == highest[i]) continue;
            const double inwards = p[i] == lowest[i] ? -slope(i) : slope(i);
            if (inwards > most) {
                most = inwards;
                released = i;
            }
        }
        if (released == n) break;
        bound[released] = false;
    }
    return p;
}

} // namespace pellucid
