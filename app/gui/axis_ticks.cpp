#include "axis_ticks.h"

#include <algorithm>
#include <cmath>

namespace pellucid::gui {

std::vector<double> axisTicks(double lo, double hi, int wanted) {
    std::vector<double> ticks;
    if (!(lo < hi) || !std::isfinite(hi - lo)) return ticks;
    const double rough = (hi - lo) / std::max(1, wanted);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double multiple = rough / power;
    const double step = power * (multiple <= 1 ? 1 : multiple <= 2 ? 2 : multiple <= 5 ? 5 : 10);
    const double first = std::ceil(lo / step - 1e-9);
    const double last = std::floor(hi / step + 1e-9);
    for (double i = first; i <= last && ticks.size() < 1000; i += 1.0) ticks.push_back(i * step + 0.0);
    return ticks;
}

QString numberText(double value, double span) {
    const double size = std::max(std::abs(value), span);
    if (size != 0 && (size >= 1e7 || size < 1e-3)) return QString::number(value, 'g', 4);
    if (span <= 0) return QString::number(value, 'g', 6);
    QString text = QString::number(value, 'f', std::max(0, decimalsFor(span) - 1));
    if (text.contains('.')) {
        while (text.endsWith('0')) text.chop(1);
        if (text.endsWith('.')) text.chop(1);
    }
    return text == "-0" ? QStringLiteral("0") : text;
}

QString rangeText(const ValueRange& range) {
    const double span = range.hi - range.lo;
    return QStringLiteral("%1 – %2").arg(numberText(range.lo, span), numberText(range.hi, span));
}

int decimalsFor(double span) {
    if (!(span > 0) || !std::isfinite(span)) return 3;
    return std::clamp(4 - static_cast<int>(std::floor(std::log10(span))), 0, 12);
}

} // namespace pellucid::gui
