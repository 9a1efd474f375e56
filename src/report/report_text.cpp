#include "report/report_text.h"

#include <array>
#include <charconv>

namespace pellucid {

namespace {

std::string printed(double value, std::chars_format format, int precision) {
    std::array<char, 400> buffer{}; // the largest double has 309 digits before the point
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision).ptr;
    return {buffer.data(), end};
}

} // namespace

std::string fixedText(double value, int decimals) { return printed(value, std::chars_format::fixed, decimals); }
std::string shortText(double value) { return printed(value, std::chars_format::general, 4); }

} // namespace pellucid
