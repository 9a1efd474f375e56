#include "optimize/solve/least_variance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {

namespace {

using Vector = std::vector<double>;

double sumOf(const Vector& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return sum;
}

/// e − ē.
Vector deviations(const LeastVariance& p, const Vector& x) {
    Vector e = p.constants;
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t v = 0; v < x.size(); ++v) e[i] += p.rows[i][v] * x[v];
    const double mean = e.empty() ? 0 : sumOf(e) / static_cast<double>(e.size());
    for (double& d : e) d -= mean;
    return e;
}

double energyAt(const LeastVariance& p, const Vector& x) {
    double energy = 0;
    for (const double d : deviations(p, x)) energy += d * d;
    return energy;
}

/// Half the gradient of the energy: Aᵀ(e − ē).
Vector gradientAt(const LeastVariance& p, const Vector& x) {
    const Vector d = deviations(p, x);
    Vector g(x.size(), 0.0);
    for (std::size_t i = 0; i < d.size(); ++i)
        for (std::size_t v = 0; v < g.size(); ++v) g[v] += p.rows[i][v] * d[i];
    return g;
}

/// Half its Hessian: AᵀA less the square of the column sums.
std::vector<Vector> hessianOf(const LeastVariance& p) {
    const std::size_t n = p.variables;
    std::vector<Vector> h(n, Vector(n, 0.0));
    Vector column(n, 0.0);
    for (const Vector& row : p.rows)
        for (std::size_t v = 0; v < n; ++v) {
            if (row[v] == 0) continue;
            column[v] += row[v];
            for (std::size_t w = 0; w < n; ++w) h[v][w] += row[v] * row[w];
        }
    const double rows = static_cast<double>(std::max<std::size_t>(p.rows.size(), 1));
    for (std::size_t v = 0; v < n; ++v)
        for (std::size_t w = 0; w < n; ++w) h[v][w] -= column[v] * column[w] / rows;
    return h;
}

/// Lower triangle L of M = L Lᵀ, in place; M is positive definite.
void factorize(std::vector<Vector>& m) {
    for (std::size_t j = 0; j < m.size(); ++j)
        for (std::size_t i = j; i < m.size(); ++i) {
            double sum = m[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
            m[i][j] = i == j ? std::sqrt(std::max(sum, std::numeric_limits<double>::min())) : sum / m[j][j];
        }
}

Vector solved(const std::vector<Vector>& l, Vector b) {
    const std::size_t n = b.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= l[i][k] * b[k];
        b[i] /= l[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k][i] * b[k];
        b[i] /= l[i][i];
    }
    return b;
}

/// Which bound a variable is held at.
enum class Held : char { Free, Lower, Upper };

/// A bound that should be left: the worst, and by how much; of none, `variable` is npos.
struct Violation {
    static constexpr std::size_t npos = static_cast<std::size_t>(-1);
    std::size_t variable = npos, partner = npos; ///< the partner is let go as well where nothing is free
    double amount = 0;
};

/// The search, on a problem whose coefficients are about 1.
class ActiveSets {
public:
    ActiveSets(const LeastVariance& problem, Vector start, const JobControl& job)
        : m_problem(problem), m_job(job), m_hessian(hessianOf(problem)), m_x(std::move(start)), m_held(m_x.size()) {
        for (std::size_t v = 0; v < m_x.size(); ++v)
            m_held[v] = m_x[v] <= problem.bounds.low(v)    ? Held::Lower
                        : m_x[v] >= problem.bounds.high(v) ? Held::Upper
                                                           : Held::Free;
        for (std::size_t v = 0; v < m_x.size(); ++v) m_largest = std::max(m_largest, m_hessian[v][v]);
    }

    /// Directions in which the energy is flat make the Hessian singular. So each round minimises the energy plus a
    /// little times the squared distance from the round before: what is left of that term goes to 0 with the rounds.
    void run() {
        constexpr int kRounds = 30;
        constexpr double kLittle = 1e-10, kSettled = 1e-13;
        if (!(m_largest > 0)) return;
        m_little = kLittle * m_largest;
        for (int round = 0; round < kRounds; ++round) {
            const Vector before = m_x;
            minimise(before);
            double moved = 0;
            for (std::size_t v = 0; v < m_x.size(); ++v) moved = std::max(moved, std::abs(m_x[v] - before[v]));
            if (moved < kSettled) break;
        }
    }

    const Vector& x() const { return m_x; }
    int steps() const { return m_steps; }
    double residual() const {
        const Vector g = gradientAt(m_problem, m_x);
        double worst = worstBound(g).amount;
        const double lambda = multiplier(g);
        for (std::size_t v = 0; v < g.size(); ++v)
            if (m_held[v] == Held::Free) worst = std::max(worst, std::abs(g[v] + lambda));
        return m_largest > 0 ? worst / m_largest : 0;
    }

private:
    /// λ with gradient + λ = 0 over the free variables, in the mean.
    double multiplier(const Vector& g) const {
        double sum = 0;
        int count = 0;
        for (std::size_t v = 0; v < g.size(); ++v)
            if (m_held[v] == Held::Free) {
                sum -= g[v];
                ++count;
            }
        return count > 0 ? sum / count : 0;
    }

    Violation worstBound(const Vector& g) const {
        Violation worst;
        if (std::find(m_held.begin(), m_held.end(), Held::Free) == m_held.end()) {
            // Any λ will do: opacity may go from where it weighs most to where it weighs least.
            std::size_t from = Violation::npos, to = Violation::npos;
            for (std::size_t v = 0; v < g.size(); ++v) {
                if (m_held[v] == Held::Upper && (from == Violation::npos || g[v] > g[from])) from = v;
                if (m_held[v] == Held::Lower && (to == Violation::npos || g[v] < g[to])) to = v;
            }
            if (from != Violation::npos && to != Violation::npos && g[from] > g[to])
                worst = {from, to, g[from] - g[to]};
            return worst;
        }
        const double lambda = multiplier(g);
        for (std::size_t v = 0; v < g.size(); ++v) {
            const double amount = m_held[v] == Held::Lower   ? -(g[v] + lambda)
                                  : m_held[v] == Held::Upper ? g[v] + lambda
                                                             : 0.0;
            if (amount > worst.amount) worst = {v, Violation::npos, amount};
        }
        return worst;
    }

    /// The step to the least value over the free variables, the sum of the others' kept.
    Vector stepOver(const std::vector<std::size_t>& free, const Vector& g) {
        const std::size_t n = free.size();
        std::vector<Vector> m(n, Vector(n));
        Vector gradient(n);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) m[i][j] = m_hessian[free[i]][free[j]];
            m[i][i] += m_little;
            gradient[i] = g[free[i]];
        }
        factorize(m);
        const Vector u = solved(m, gradient), w = solved(m, Vector(n, 1.0));
        const double lambda = -sumOf(u) / sumOf(w);
        Vector step(n);
        for (std::size_t i = 0; i < n; ++i) step[i] = -u[i] - lambda * w[i];
        const double drift = sumOf(step) / static_cast<double>(n); // of rounding
        for (double& s : step) s -= drift;
        ++m_steps;
        return step;
    }

    void minimise(const Vector& centre) {
        constexpr double kNoStep = 1e-15;
        const double violation = 1e-15 * m_largest;
        const std::size_t most = 100 + 20 * m_x.size(); // far above what is needed; ends a cycle of rounding
        for (std::size_t n = 0; n < most; ++n) {
            m_job.throwIfStopped();
            Vector g = gradientAt(m_problem, m_x);
            for (std::size_t v = 0; v < g.size(); ++v) g[v] += m_little * (m_x[v] - centre[v]);
            std::vector<std::size_t> free;
            for (std::size_t v = 0; v < m_x.size(); ++v)
                if (m_held[v] == Held::Free) free.push_back(v);
            if (free.size() > 1 && advance(free, stepOver(free, g), kNoStep)) continue;
            const Violation worst = worstBound(g);
            if (!(worst.amount > violation)) return;
            m_held[worst.variable] = Held::Free;
            if (worst.partner != Violation::npos) m_held[worst.partner] = Held::Free;
        }
    }

    double roomOf(std::size_t v, bool upward) const {
        return upward ? m_problem.bounds.high(v) - m_x[v] : m_x[v] - m_problem.bounds.low(v);
    }

    /// Goes as far as bounds allow; false where that is nowhere and nothing stands in the way.
    bool advance(const std::vector<std::size_t>& free, const Vector& step, double noStep) {
        double longest = 0, share = 1;
        for (std::size_t i = 0; i < free.size(); ++i) {
            longest = std::max(longest, std::abs(step[i]));
            const double room = roomOf(free[i], step[i] > 0);
            if (std::abs(step[i]) > noStep && room < share * std::abs(step[i])) share = room / std::abs(step[i]);
        }
        if (longest <= noStep) return false;
        bool met = false;
        for (std::size_t i = 0; i < free.size(); ++i) {
            const std::size_t v = free[i];
            const double room = roomOf(v, step[i] > 0);
            if (std::abs(step[i]) > noStep && room <= share * std::abs(step[i])) {
                m_x[v] = step[i] > 0 ? m_problem.bounds.high(v) : m_problem.bounds.low(v);
                m_held[v] = step[i] > 0 ? Held::Upper : Held::Lower;
                met = true;
            } else {
                m_x[v] += share * step[i];
            }
        }
        // A whole step ends where the next one is 0 but for rounding.
        return met || longest > 1e-12;
    }

    const LeastVariance& m_problem;
    const JobControl& m_job;
    std::vector<Vector> m_hessian;
    Vector m_x;
    std::vector<Held> m_held;
    double m_largest = 0; ///< diagonal element of the Hessian
    double m_little = 0;
    int m_steps = 0;
};

} // namespace

std::vector<double> nearestOfTotal(std::vector<double> x, double total, const VariableBounds& bounds) {
    Vector low(x.size()), high(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) {
        low[v] = bounds.low(v);
        high[v] = bounds.high(v);
    }
    if (total <= sumOf(low)) return low;
    if (total >= sumOf(high)) return high;
    const auto shifted = [&](double by) {
        Vector y = x;
        for (std::size_t v = 0; v < y.size(); ++v) y[v] = std::clamp(y[v] + by, low[v], high[v]);
        return y;
    };
    x = shifted(0);
    if (sumOf(x) == total) return x;
    double lo = -1, hi = 1; // every x is at its lower bound at the one and at its upper one at the other
    for (int i = 0; i < 100 && lo < hi; ++i) {
        const double middle = lo + (hi - lo) / 2;
        (sumOf(shifted(middle)) < total ? lo : hi) = middle;
    }
    return shifted(hi);
}

LeastVarianceAnswer solve(const LeastVariance& problem, const std::vector<double>& start, const JobControl& job) {
    const Vector first = nearestOfTotal(start, problem.total, problem.bounds);
    LeastVarianceAnswer answer{first, energyAt(problem, first), 0, 0};
    double largest = 0;
    for (const Vector& row : problem.rows)
        for (const double a : row) largest = std::max(largest, std::abs(a));
    if (!(largest > 0)) return answer; // nothing depends on x
    LeastVariance scaled = problem;
    for (Vector& row : scaled.rows)
        for (double& a : row) a /= largest;
    for (double& b : scaled.constants) b /= largest;

    ActiveSets search(scaled, first, job);
    search.run();
    answer.steps = search.steps();
    answer.residual = search.residual();
    const double energy = energyAt(problem, search.x());
    if (energy <= answer.energy) {
        answer.x = search.x();
        answer.energy = energy;
    }
    return answer;
}

} // namespace pellucid
