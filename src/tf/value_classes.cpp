#include "tf/value_classes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"

namespace pellucid {

std::vector<double> smoothed(const std::vector<double>& density, double sigma) {
    const int n = static_cast<int>(density.size()), radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> kernel(static_cast<std::size_t>(radius) + 1);
    double sum = 0;
    for (int r = 0; r <= radius; ++r) {
        kernel[static_cast<std::size_t>(r)] = std::exp(-r * r / (2 * sigma * sigma));
        sum += (r == 0 ? 1 : 2) * kernel[static_cast<std::size_t>(r)];
    }
    std::vector<double> result(density.size(), 0.0);
    const auto mirrored = [n](int i) {
        while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
        return static_cast<std::size_t>(i);
    };
    for (int i = 0; i < n; ++i)
        for (int r = -radius; r <= radius; ++r)
            result[static_cast<std::size_t>(i)] +=
                density[mirrored(i + r)] * kernel[static_cast<std::size_t>(std::abs(r))] / sum;
    return result;
}

std::vector<int> prominentPeaks(const std::vector<double>& density, double prominence, double mass) {
    const int n = static_cast<int>(density.size());
    const auto at = [&](int i) { return density[static_cast<std::size_t>(i)]; };
    const double whole = std::accumulate(density.begin(), density.end(), 0.0);
    std::vector<int> peaks;
    for (int i = 0; i < n; ++i) {
        if (at(i) <= 0 || (i > 0 && at(i - 1) >= at(i)) || (i + 1 < n && at(i + 1) > at(i))) continue;
        // How deep the density falls on either side before it is as high again; an end of the range is a fall.
        double saddle = 0, own = at(i);
        for (const int sign : {-1, 1}) {
            double lowest = at(i);
            int j = i + sign;
            double sum = 0, sumToLowest = 0;
            for (; j >= 0 && j < n && at(j) <= at(i); j += sign) {
                sum += at(j);
                if (at(j) < lowest) lowest = at(j), sumToLowest = sum;
            }
            if (j < 0 || j >= n)
                lowest = 0, sumToLowest = sum;
            own += sumToLowest;
            saddle = std::max(saddle, lowest);
        }
        if (saddle <= (1 - prominence) * at(i) && own >= mass * whole) peaks.push_back(i);
    }
    return peaks;
}

std::vector<int> multiOtsu(const std::vector<double>& counts, int begin, int end, int classes, double& explained) {
    PELLUCID_CHECK(0 <= begin && begin < end && end <= static_cast<int>(counts.size()) && classes >= 1);
    const int n = end - begin;
    const auto size = static_cast<std::size_t>(n) + 1;
    std::vector<double> weight(size, 0), moment(size, 0);
    double second = 0;
    for (int i = 0; i < n; ++i) {
        const double c = counts[static_cast<std::size_t>(begin + i)];
        weight[static_cast<std::size_t>(i) + 1] = weight[static_cast<std::size_t>(i)] + c;
        moment[static_cast<std::size_t>(i) + 1] = moment[static_cast<std::size_t>(i)] + c * i;
        second += c * i * i;
    }
    // Between-class variance is Σ moment²/weight over classes, but for a constant.
    const auto gain = [&](int a, int b) {
        const double w = weight[static_cast<std::size_t>(b)] - weight[static_cast<std::size_t>(a)];
        const double m = moment[static_cast<std::size_t>(b)] - moment[static_cast<std::size_t>(a)];
        return w > 0 ? m * m / w : 0.0;
    };
    const double lowest = -std::numeric_limits<double>::infinity();
    std::vector<std::vector<double>> best(static_cast<std::size_t>(classes) + 1, std::vector<double>(size, lowest));
    std::vector<std::vector<int>> from(static_cast<std::size_t>(classes) + 1, std::vector<int>(size, 0));
    best[0][0] = 0;
    for (int k = 1; k <= classes; ++k)
        for (int b = k; b <= n; ++b)
            for (int a = k - 1; a < b; ++a) {
                const double value = best[static_cast<std::size_t>(k) - 1][static_cast<std::size_t>(a)] + gain(a, b);
                if (value > best[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)]) {
                    best[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)] = value;
                    from[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)] = a;
                }
            }
    const int used = std::min(classes, n);
    std::vector<int> borders;
    for (int k = used, b = n; k > 1; --k) {
        b = from[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)];
        borders.insert(borders.begin(), begin + b);
    }
    const double mean = weight.back() > 0 ? moment.back() * moment.back() / weight.back() : 0.0;
    const double whole = second - mean;
    explained = whole > 0
                    ? (best[static_cast<std::size_t>(used)][static_cast<std::size_t>(n)] - mean) / whole
                    : 1.0;
    return borders;
}

} // namespace pellucid
