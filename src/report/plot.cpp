#include "report/plot.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

double largest(const Plot& plot) {
    double most = 0;
    for (const PlotSeries& s : plot.series)
        for (const PlotPoint& p : s.points) most = std::max(most, p.y);
    return most;
}

} // namespace

void fitLinear(Plot& plot, double most) {
    const double hi = largest(plot);
    plot.y.lo = 0;
    plot.y.hi = hi > 0 ? std::min(most, 1.1 * hi) : std::min(most, 1.0);
}

void fitDecades(Plot& plot, double smallest) {
    double lo = 1;
    for (const PlotSeries& s : plot.series)
        for (const PlotPoint& p : s.points) lo = std::min(lo, std::max(p.y, smallest));
    plot.y.logarithmic = true;
    plot.y.lo = std::pow(10, std::floor(std::log10(lo) + 1e-9));
    plot.y.hi = std::max(plot.y.lo * 10, std::pow(10, std::ceil(std::log10(std::max(largest(plot), lo)) - 1e-9)));
}

} // namespace pellucid
