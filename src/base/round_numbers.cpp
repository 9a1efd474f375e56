#include "base/round_numbers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace pellucid {

namespace {

std::string printed(double value, std::chars_format format, int precision) {
    std::array<char, 400> buffer{}; // the largest double has 309 digits before the point
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision).ptr;
    return {buffer.data(), end};
}

} // namespace

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

double roundNumberBelow(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    const double multiple = most / power * (1 + 1e-12);
    return power * (multiple >= 10 ? 10 : multiple >= 5 ? 5 : multiple >= 2 ? 2 : 1);
}

std::string fixedText(double value, int decimals) { return printed(value, std::chars_format::fixed, decimals); }
std::string plainText(double value) { return printed(value, std::chars_format::general, 6); }
std::string shortText(double value) { return printed(value, std::chars_format::general, 4); }

std::string exactText(double value) {
    std::array<char, 40> buffer{};
    return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

std::string numberText(double value, double span) {
    const double size = std::max(std::abs(value), span);
    if (size != 0 && (size >= 1e7 || size < 1e-3)) return shortText(value);
    if (span <= 0) return printed(value, std::chars_format::general, 6);
    std::string text = printed(value, std::chars_format::fixed, std::max(0, decimalsFor(span) - 1));
    if (text.find('.') != std::string::npos) {
        while (text.back() == '0') text.pop_back();
        if (text.back() == '.') text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

int decimalsFor(double span) {
    if (!(span > 0) || !std::isfinite(span)) return 3;
    return std::clamp(4 - static_cast<int>(std::floor(std::log10(span))), 0, 12);
}

} // namespace pellucid
