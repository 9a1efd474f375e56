#include "optimize/solve/log_depths.h"

#include <algorithm>
#include <cmath>

#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr double kLeastOpacity = 1e-6;
constexpr double kMostOpacity = 0.999; // as good as 1: ln τ goes on from here without that anything changes

/// Solves A x = b of a positive definite A, by Cholesky's method.
Numbers solvePositive(Rows a, Numbers b) {
    const std::size_t n = b.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = std::sqrt(std::max(a[j][j], 1e-300));
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return b;
}

} // namespace

double logDepthOf(double opacity) { return std::log(opticalDepthOfOpacity(opacity)); }
double opacityOfLogDepth(double y) { return -std::expm1(-std::exp(y)); }

LogDepths::LogDepths(const std::vector<OpacityLimits>& limits, const std::vector<double>& start) : m_opacity(start) {
    for (std::size_t f = 0; f < start.size(); ++f) {
        const OpacityLimits limit = limits.empty() ? OpacityLimits{} : limits[f];
        if (limit.locked) continue;
        m_opacity[f] = std::clamp(start[f], limit.lowest, limit.highest);
        if (m_opacity[f] <= 0 || limit.lowest == limit.highest) continue;
        m_features.push_back(f);
        const double least = std::max(limit.lowest, std::min(kLeastOpacity, m_opacity[f]));
        m_lowest.push_back(logDepthOf(std::min(least, kMostOpacity)));
        m_highest.push_back(logDepthOf(std::max(least, std::min(limit.highest, kMostOpacity))));
        m_start.push_back(std::clamp(logDepthOf(m_opacity[f]), m_lowest.back(), m_highest.back()));
    }
}

Numbers LogDepths::clamped(Numbers y) const {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = std::clamp(y[i], m_lowest[i], m_highest[i]);
    return y;
}

std::vector<double> LogDepths::opacity(const Numbers& y) const {
    std::vector<double> x = m_opacity;
    for (std::size_t i = 0; i < y.size(); ++i) x[m_features[i]] = opacityOfLogDepth(y[i]);
    return x;
}

Numbers LogDepths::from(const std::vector<double>& opacity) const {
    Numbers y;
    for (const std::size_t f : m_features) y.push_back(logDepthOf(std::max(opacity[f], kLeastOpacity)));
    return clamped(std::move(y));
}

Rows LogDepths::derivatives(const Rows& byOpacity, const Numbers& y) const {
    Rows rows;
    for (const Numbers& row : byOpacity) {
        Numbers& out = rows.emplace_back();
        for (std::size_t i = 0; i < y.size(); ++i) // ∂α/∂y = (1 − α) τ
            out.push_back(row[m_features[i]] * std::exp(y[i] - std::exp(y[i])));
    }
    return rows;
}

Numbers leastSquaresStep(const Rows& jacobian, const Numbers& residual, const Numbers& lowest, const Numbers& highest,
                         double ridge) {
    const std::size_t n = lowest.size();
    Numbers d(n, 0.0);
    std::vector<char> held(n, 0);
    for (std::size_t round = 0; round <= n; ++round) {
        std::vector<std::size_t> free;
        for (std::size_t i = 0; i < n; ++i)
            if (!held[i]) free.push_back(i);
        Numbers rest = residual; // with what is held already taken
        for (std::size_t r = 0; r < rest.size(); ++r)
            for (std::size_t i = 0; i < n; ++i)
                if (held[i]) rest[r] += jacobian[r][i] * d[i];
        Rows normal(free.size(), Numbers(free.size(), 0.0));
        Numbers right(free.size(), 0.0);
        for (std::size_t a = 0; a < free.size(); ++a) {
            for (std::size_t r = 0; r < rest.size(); ++r) {
                right[a] -= jacobian[r][free[a]] * rest[r];
                for (std::size_t b = 0; b < free.size(); ++b)
                    normal[a][b] += jacobian[r][free[a]] * jacobian[r][free[b]];
            }
            normal[a][a] += ridge;
        }
        const Numbers solved = solvePositive(std::move(normal), std::move(right));
        std::size_t worst = n;
        double beyond = 0;
        for (std::size_t a = 0; a < free.size(); ++a) {
            const std::size_t i = free[a];
            d[i] = solved[a];
            const double over = std::max(lowest[i] - d[i], d[i] - highest[i]);
            if (over > beyond) {
                beyond = over;
                worst = i;
            }
        }
        if (worst == n) break;
        d[worst] = std::clamp(d[worst], lowest[worst], highest[worst]);
        held[worst] = 1;
    }
    return d;
}

double largestOf(const Numbers& v) {
    double most = 0;
    for (const double x : v) most = std::max(most, std::abs(x));
    return most;
}

Numbers plus(const Numbers& a, double factor, const Numbers& b) {
    Numbers sum = a;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * b[i];
    return sum;
}

} // namespace pellucid
