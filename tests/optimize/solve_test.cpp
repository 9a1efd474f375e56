// The solvers of quadratic problems, against brute force and the conditions of an optimum; opacities as unknowns.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <Eigen/QR>

#include "optimize/solve/block_tridiagonal.h"
#include "optimize/solve/boxed_step.h"
#include "optimize/solve/flattest_direction.h"
#include "optimize/solve/least_variance.h"
#include "optimize/solve/log_depths.h"

using namespace pellucid;

namespace {

struct Problem {
    Matrix a;
    Vector g, lowest, highest;
    double value(const Vector& p) const { return 0.5 * p.dot(a * p) + g.dot(p); }
};

enum class Kind {
    Usual,
    Degenerate, ///< rank of a half, but for a ridge of 1e-7; every fourth range one point, every fourth one-sided
    Twins,      ///< every second unknown as the one before it, but for a ridge
    IllScaled   ///< unknowns in units from 1e-8 to 1e8
};
const char* kNames[] = {"usual", "degenerate", "twins", "ill-scaled"};

Problem randomProblem(std::uint32_t seed, Eigen::Index n, Kind kind) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto some = [&](Eigen::Index rows, Eigen::Index columns) {
        return Matrix::NullaryExpr(rows, columns, [&] { return 2 * unit(random) - 1; }).eval();
    };
    Matrix root = some(kind == Kind::Degenerate ? (n + 1) / 2 : n + 2, n);
    if (kind == Kind::Twins)
        for (Eigen::Index i = 1; i < n; i += 2) root.col(i) = root.col(i - 1);
    Problem p{root.transpose() * root, some(n, 1), -some(n, 1).cwiseAbs(), some(n, 1).cwiseAbs()};
    p.a.diagonal().array() += 1e-7 * p.a.diagonal().maxCoeff();
    for (Eigen::Index i = 0; i < n && kind == Kind::Degenerate; ++i) {
        if (i % 4 == 1) p.lowest[i] = p.highest[i] = 0;
        if (i % 4 == 2) (unit(random) < 0.5 ? p.lowest : p.highest)[i] = 0;
    }
    if (kind == Kind::IllScaled) {
        const Vector scale = Vector::NullaryExpr(n, [&] { return std::pow(10, 16 * unit(random) - 8); });
        p.a = (scale.asDiagonal() * p.a * scale.asDiagonal()).eval();
        p.g.array() *= scale.array();
        p.lowest.array() /= scale.array();
        p.highest.array() /= scale.array();
    }
    return p;
}

/// The least value over all faces of the box: each unknown at its lower, at its upper bound, or free; of those whose
/// minimum lies within the box.
double bruteForce(const Problem& p, Sum sum) {
    const Eigen::Index n = p.g.size();
    double best = std::numeric_limits<double>::infinity();
    for (int face = 0; face < std::pow(3, n); ++face) {
        std::vector<Eigen::Index> free;
        Vector x(n);
        int rest = face;
        for (Eigen::Index i = 0; i < n; ++i, rest /= 3) {
            if (rest % 3 == 2) free.push_back(i);
            x[i] = rest % 3 == 0 ? p.lowest[i] : rest % 3 == 1 ? p.highest[i] : 0;
        }
        // Slope λ for all that is free, and their sum that of the bound ones, negative; without a sum λ is 0.
        const auto m = static_cast<Eigen::Index>(free.size());
        const Eigen::Index more = sum == Sum::Kept ? 1 : 0;
        Matrix system = Matrix::Zero(m + more, m + more);
        Vector right(m + more);
        // In units in which the diagonal of A is 1.
        const Vector unit = p.a.diagonal()(free).cwiseSqrt().cwiseInverse();
        system.topLeftCorner(m, m) = unit.asDiagonal() * p.a(free, free) * unit.asDiagonal();
        right.head(m) = unit.cwiseProduct(-(p.a * x + p.g)(free));
        if (more == 1) {
            system.col(m).head(m) = unit;
            system.row(m).head(m) = unit;
            right[m] = -x.sum();
        }
        if (m > 0) x(free) = unit.cwiseProduct(system.fullPivLu().solve(right).head(m)).eval();
        const Vector over = (p.lowest - x).cwiseMax(x - p.highest), width = p.highest - p.lowest;
        if (((over - 1e-9 * width).array() > 0).any()) continue;
        if (more == 1 && std::abs(x.sum()) > 1e-9 * width.maxCoeff()) continue;
        best = std::min(best, p.value(x));
    }
    return best;
}

/// Karush, Kuhn and Tucker: with some λ (0 where the sum is free) the slope of what is free is λ, at lower bounds it is
/// not below, at upper ones not above. In the size of what slopes are the sums of.
void checkOptimal(const Problem& p, const Vector& x, Sum sum, double tolerance = 1e-9) {
    REQUIRE(x.size() == p.g.size());
    REQUIRE(x.allFinite());
    CHECK((x.array() >= p.lowest.array()).all());
    CHECK((x.array() <= p.highest.array()).all());
    const Vector slope = p.a * x + p.g, size = p.a.cwiseAbs() * x.cwiseAbs() + p.g.cwiseAbs();
    double most = -1e300, least = 1e300, largest = 0; // of λ
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const double margin = tolerance * size[i];
        largest = std::max(largest, margin);
        if (x[i] > p.lowest[i]) most = std::max(most, slope[i] - margin);    // it could go down: not uphill
        if (x[i] < p.highest[i]) least = std::min(least, slope[i] + margin); // it could go up: not downhill
    }
    if (sum == Sum::Kept) {
        CHECK(most <= least);
        CHECK(std::abs(x.sum()) <= 1e-12 * x.cwiseAbs().sum());
    } else {
        CHECK(most <= 0);
        CHECK(least >= 0);
    }
}

} // namespace

TEST_CASE("a step in a box is the least of all faces of the box", "[solve]") {
    for (const Kind kind : {Kind::Usual, Kind::Degenerate, Kind::Twins, Kind::IllScaled})
        for (const Sum sum : {Sum::Free, Sum::Kept}) {
            if (kind == Kind::IllScaled && sum == Sum::Kept) continue; // a sum of 1e-8 and 1e8 is the latter
            for (std::uint32_t seed = 0; seed < 60; ++seed) {
                const Problem p = randomProblem(seed, 1 + seed % 6, kind);
                INFO(kNames[static_cast<int>(kind)] << (sum == Sum::Kept ? ", sum kept, " : ", ") << seed);
                const Vector x = boxedStep(p.a, p.g, p.lowest, p.highest, sum);
                checkOptimal(p, x, sum);
                CHECK(p.value(x) == Approx(bruteForce(p, sum)).epsilon(1e-9).margin(1e-12));
            }
        }
}

TEST_CASE("a step in a box meets the conditions of an optimum with up to 64 unknowns", "[solve]") {
    for (const Kind kind : {Kind::Usual, Kind::Degenerate, Kind::Twins, Kind::IllScaled})
        for (Eigen::Index n = 1; n <= 64; ++n) {
            Problem p = randomProblem(1000 + static_cast<std::uint32_t>(n), n, kind);
            INFO(kNames[static_cast<int>(kind)] << ", " << n << " unknowns");
            checkOptimal(p, boxedStep(p.a, p.g, p.lowest, p.highest), Sum::Free);
            if (kind != Kind::IllScaled)
                checkOptimal(p, boxedStep(p.a, p.g, p.lowest, p.highest, Sum::Kept), Sum::Kept);
            for (const double unit : {1e-8, 1e8}) { // of the function; then of the unknowns
                Problem q = p;
                q.a *= unit;
                q.g *= unit;
                const Vector x = boxedStep(q.a, q.g, q.lowest, q.highest);
                checkOptimal(q, x, Sum::Free);
                q = {p.a / (unit * unit), p.g / unit, p.lowest * unit, p.highest * unit};
                checkOptimal(q, boxedStep(q.a, q.g, q.lowest, q.highest), Sum::Free);
            }
        }
}

TEST_CASE("a step in a box of special cases", "[solve]") {
    CHECK(boxedStep(Matrix(0, 0), Vector(0), Vector(0), Vector(0)).size() == 0);
    // No slope, no step; ranges of one point leave none.
    const Matrix one = Matrix::Identity(3, 3);
    const Vector zero = Vector::Zero(3), ones = Vector::Ones(3);
    CHECK(boxedStep(one, zero, -ones, ones) == zero);
    CHECK(boxedStep(one, ones, zero, zero) == zero);
    CHECK(boxedStep(one, ones, zero, zero, Sum::Kept) == zero);
    // A matrix of zeros knows no minimum, nor do slopes that are no numbers: nothing moves.
    CHECK(boxedStep(Matrix::Zero(3, 3), ones, -ones, ones) == zero);
    CHECK(boxedStep(one, ones * std::numeric_limits<double>::quiet_NaN(), -ones, ones) == zero);
    // The sum kept: ½|p|² − p₀ is least at p₀ = ⅔, p₁ = p₂ = −⅓; with p₀ ≤ ½ at −¼ each.
    Vector g = zero;
    g[0] = -1;
    const Vector p = boxedStep(one, g, -ones, ones, Sum::Kept);
    CHECK((p - Vector{{2.0 / 3, -1.0 / 3, -1.0 / 3}}).norm() < 1e-15);
    int systems = 0;
    CHECK(boxedStep(one, g, -ones, 0.5 * ones, Sum::Kept, {}, &systems) == Vector{{0.5, -0.25, -0.25}});
    CHECK(systems == 2); // to the bound, and on over the other two
    // All at a bound, and the way out is a pair: what weighs most gives to what weighs least.
    const Vector lowest{{0, -1, 0}}, highest{{1, 0, 1}};
    CHECK((boxedStep(one, Vector{{-1, 1, 0}}, lowest, highest, Sum::Kept) - Vector{{1, -1, 0}}).norm() < 1e-15);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(boxedStep(one, g, -ones, ones, Sum::Free, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("least squares within bounds let go of a bound that another one makes needless", "[solve]") {
    // r + J d = (−1 + d₀ + 0.9 d₁, 1 + d₁): 0 at d₁ = −1, d₀ = 1.9. With d₁ ≥ −½ the first is 0 at d₀ = 1 + 0.45.
    const Matrix j{{1, 0.9}, {0, 1}};
    const Vector r{{-1, 1}};
    const Vector d = leastSquaresStep(j, r, Vector{{0, -0.5}}, Vector{{2, 1}}, 1e-12);
    CHECK((d - Vector{{1.45, -0.5}}).norm() < 1e-9);

    // Putting what would leave its bounds there one by one, the farthest first, ends elsewhere in some problems: what
    // is best along two bounds together need not be along the second alone. So it is compared with all faces.
    int released = 0;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1, 1);
        const Eigen::Index n = 2 + static_cast<Eigen::Index>(seed % 4);
        const Matrix jacobian = Matrix::NullaryExpr(n + seed % 2, n, [&] { return unit(random); });
        const Vector residual = Vector::NullaryExpr(n + seed % 2, [&] { return 3 * unit(random); });
        const Vector bounds = Vector::NullaryExpr(n, [&] { return std::abs(unit(random)); });
        constexpr double kRidge = 1e-6;
        Matrix a = jacobian.transpose() * jacobian + kRidge * Matrix::Identity(n, n);
        const Problem p{a, jacobian.transpose() * residual, -bounds, bounds};
        INFO("case " << seed);
        const Vector found = leastSquaresStep(jacobian, residual, -bounds, bounds, kRidge);
        checkOptimal(p, found, Sum::Free);
        CHECK(p.value(found) == Approx(bruteForce(p, Sum::Free)).margin(1e-12));
        // The one by one, for comparison.
        Vector x = Vector::Zero(n);
        std::vector<Eigen::Index> free(static_cast<std::size_t>(n));
        for (Eigen::Index i = 0; i < n; ++i) free[i] = i;
        while (!free.empty()) {
            for (const Eigen::Index i : free) x[i] = 0;
            x(free) = a(free, free).fullPivLu().solve(-(a * x + p.g)(free)).eval();
            std::size_t worst = free.size();
            double beyond = 0;
            for (std::size_t k = 0; k < free.size(); ++k)
                if (const double over = std::abs(x[free[k]]) - bounds[free[k]]; over > beyond) {
                    beyond = over;
                    worst = k;
                }
            if (worst == free.size()) break;
            x[free[worst]] = std::copysign(bounds[free[worst]], x[free[worst]]);
            free.erase(free.begin() + static_cast<std::ptrdiff_t>(worst));
        }
        CHECK(p.value(found) <= p.value(x) + 1e-12);
        released += p.value(found) < p.value(x) - 1e-6;
    }
    CHECK(released > 0);
}

TEST_CASE("least variance meets the conditions of an optimum, however coefficients are scaled", "[solve]") {
    for (const double scale : {1e-8, 1.0, 1e8})
        for (Eigen::Index n = 1; n <= 64; ++n) {
            std::mt19937 random(static_cast<std::uint32_t>(n));
            std::uniform_real_distribution<double> unit(0, 1);
            LeastVariance p{
                Matrix::NullaryExpr(n + 1, n, [&] { return random() % 3 == 0 ? scale * unit(random) : 0.0; }),
                Vector::NullaryExpr(n + 1, [&] { return scale * unit(random); }), Vector::Zero(n), Vector::Ones(n),
                0.4 * static_cast<double>(n)};
            if (n % 3 == 0) p.rows.col(n - 1) = p.rows.col(0); // two that do the same
            if (n % 5 == 0) p.rows.col(n / 2).setZero();       // one that does nothing
            if (n % 7 == 0) p.lowest[0] = p.highest[0] = 0.3;
            INFO("scale " << scale << ", " << n << " variables");
            const Vector start = Vector::Constant(n, 0.4);
            const LeastVarianceAnswer answer = solve(p, start);
            // As a step from there: ½·pᵀHp + gᵀp with H of the centred rows.
            const Matrix centred = p.rows.rowwise() - p.rows.colwise().mean();
            const Vector offset = (p.constants.array() - p.constants.mean()).matrix();
            CHECK(answer.x.sum() == Approx(p.total).epsilon(1e-12));
            const Problem q{centred.transpose() * centred, centred.transpose() * offset, p.lowest, p.highest};
            const Vector slope = q.a * answer.x + q.g;
            const double size = (q.a.cwiseAbs() * answer.x + q.g.cwiseAbs()).maxCoeff();
            double most = -1e300, least = 1e300;
            for (Eigen::Index i = 0; i < n; ++i) {
                REQUIRE(answer.x[i] >= p.lowest[i]);
                REQUIRE(answer.x[i] <= p.highest[i]);
                if (answer.x[i] > p.lowest[i]) most = std::max(most, slope[i]);
                if (answer.x[i] < p.highest[i]) least = std::min(least, slope[i]);
            }
            CHECK(most <= least + 1e-9 * size);
            CHECK(answer.energy == Approx((centred * answer.x + offset).squaredNorm()));
        }
}

TEST_CASE("opacities as logarithms: where they may go, and how they come back", "[solve]") {
    // The first moves freely, the second is locked, the third wanted at 0, the fourth's limits leave one opacity.
    const std::vector<OpacityLimits> limits{{0.001, 0.9}, {0, 1, true}, {0.1, 1}, {0.5, 0.5}, {}};
    for (const auto log : {LogDepths::Log::Depth, LogDepths::Log::Opacity}) {
        const LogDepths depths(limits, {1, 1, 0, 1, 1}, log);
        CHECK(depths.features() == std::vector<std::size_t>{0, 4});
        const bool isDepth = log == LogDepths::Log::Depth;
        const std::vector<double> x{0.2, 0.3, 0.4, 0.5, 0.6};
        const Vector y = depths.from(x);
        CHECK(y[0] == Approx(isDepth ? std::log(-std::log1p(-0.2)) : std::log(0.2)));
        CHECK(depths.opacities(y, x) == x); // to the bit
        // A tenth of ln τ, or of ln α, to either side.
        const std::vector<double> more = depths.opacities((y.array() + 0.1).matrix(), x);
        CHECK(more[0] == Approx(isDepth ? 1 - std::pow(0.8, std::exp(0.1)) : 0.2 * std::exp(0.1)));
        for (const std::size_t f : {1, 2, 3}) CHECK(more[f] == x[f]);
        // Far out they end at their limits, or where extinction is capped.
        const std::vector<double> most = depths.opacities(depths.highest(), x),
                                  least = depths.opacities(depths.lowest(), x);
        CHECK(most[0] == Approx(0.9));
        CHECK(most[4] == Approx(isDepth ? kMostOpacity : 1));
        CHECK(least[0] == Approx(0.001));
        CHECK(least[4] == Approx(kLeastOpacity));
        // Slopes, by central differences.
        const Vector slopes = depths.slopes(x);
        const Vector h = Vector::Constant(2, 1e-5);
        const std::vector<double> forth = depths.opacities(y + h, x), back = depths.opacities(y - h, x);
        for (Eigen::Index i = 0; i < 2; ++i) {
            const std::size_t f = depths.features()[i];
            CHECK(slopes[i] == Approx((forth[f] - back[f]) / 2e-5).epsilon(1e-6));
        }
        const Matrix byOpacity = Matrix::Random(3, 5);
        CHECK((depths.derivatives(byOpacity, x).col(1) - byOpacity.col(4) * slopes[1]).norm() < 1e-15);
        // Steps stay within reach and bounds, and 0 is one of them.
        const auto [down, up] = depths.stepsFrom(depths.highest(), 0.5);
        CHECK(up == Vector::Zero(2));
        CHECK(down == Vector::Constant(2, -0.5));
    }
}

TEST_CASE("a search begins inside its limits, with what is wanted above 0 and the rest as low as may be", "[solve]") {
    const std::vector<OpacityLimits> limits{{}, {}, {0.1, 1}, {0, 1, true}, {0.05, 0.2}, {0.5, 0.5}};
    const LogDepths depths(limits, {1, 1, 0, 1, 1, 1});
    // √(0.04·0.01) = 0.02, of the first and the fifth; the second is there, the third at its lowest, the fourth locked.
    const std::vector<double> x = depths.inside({0.04, 0, 0.7, 0.9, 0.01, 0.2});
    CHECK(x[0] == 0.04);
    CHECK(x[1] == Approx(0.02));
    CHECK(x[2] == 0.1);
    CHECK(x[3] == 0.9);
    CHECK(x[4] == 0.05);
    CHECK(x[5] == 0.5);
    // Nothing to go by.
    CHECK(LogDepths({}, {1, 1}).inside({0, 0}) == std::vector<double>{0.1, 0.1});
    CHECK(depths.capped({1, 1, 1, 1, 1, 1}) == std::vector<double>{kMostOpacity, kMostOpacity, 1, 1, kMostOpacity, 1});
    // Within floating point, and there and back.
    for (const double a : {1e-6, 0.01, 0.5, 0.999}) CHECK(opacityOfLogDepth(logDepthOf(a)) == Approx(a).epsilon(1e-9));
    CHECK(logDepthOf(0) == logDepthOf(kLeastOpacity));
    CHECK(logDepthOf(1) == logDepthOf(kMostOpacity));
}

TEST_CASE("the flattest direction is the singular vector of the least singular value", "[solve]") {
    for (const Eigen::Index n : {1, 2, 5, 16, 64}) {
        CAPTURE(n);
        // J = U S Vᵀ with singular values 1e-3, 2, …, 2: the first column of V, which is (1, 2, …, n) but for its
        // length.
        Matrix start = Matrix::Random(n, n);
        start.col(0) = Vector::LinSpaced(n, 1, static_cast<double>(n));
        const Matrix v = Eigen::HouseholderQR<Matrix>(start).householderQ();
        const Matrix u = Eigen::HouseholderQR<Matrix>(Matrix::Random(n + 1, n + 1)).householderQ();
        Vector values = Vector::Constant(n, 2);
        values[0] = 1e-3;
        const Vector d = flattestDirection(u.leftCols(n) * values.asDiagonal() * v.transpose());
        CHECK(d.lpNorm<Eigen::Infinity>() == Approx(1));
        CHECK(std::abs(d.normalized().dot(v.col(0))) == Approx(1).margin(1e-9));
    }
    // Nothing is flatter than anything else: equal parts.
    CHECK(flattestDirection(Matrix::Zero(3, 4)).isApprox(Vector::Ones(4)));
    CHECK(flattestDirection(Matrix::Identity(4, 4)).isApprox(Vector::Ones(4)));
}

TEST_CASE("blocks that are coupled with their neighbours are solved as the whole matrix is", "[solve]") {
    for (const int n : {1, 2, 5, 8})
        for (const int blocks : {1, 2, 3, 20}) {
            INFO(blocks << " blocks of " << n << " unknowns");
            std::mt19937 random(static_cast<std::uint32_t>(100 * n + blocks));
            std::uniform_real_distribution<double> unit(-1, 1);
            const auto some = [&](int rows, int columns) {
                return Matrix::NullaryExpr(rows, columns, [&] { return unit(random); }).eval();
            };
            std::vector<Matrix> own, beside;
            Matrix whole = Matrix::Zero(n * blocks, n * blocks);
            for (int i = 0; i < blocks; ++i) {
                beside.push_back(some(n, n)); // not symmetric
                const Matrix root = some(n, n);
                // Positive definite: the entries of a row of the blocks beside it sum to at most 2n.
                own.push_back(root.transpose() * root + 2 * n * Matrix::Identity(n, n));
                whole.block(n * i, n * i, n, n) = own.back();
                if (i == 0) continue;
                whole.block(n * i, n * (i - 1), n, n) = -beside.back();
                whole.block(n * (i - 1), n * i, n, n) = -beside.back().transpose();
            }
            const Matrix b = some(n, blocks);
            const Matrix x = solveBlockTridiagonal(own, beside, b);
            const Vector expected = whole.partialPivLu().solve(Vector(b.reshaped()));
            CHECK((Vector(x.reshaped()) - expected).lpNorm<Eigen::Infinity>() <
                  1e-11 * expected.lpNorm<Eigen::Infinity>());
        }
}
