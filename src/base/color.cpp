#include "base/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

Rgb rgbFromHsv(double hueDegrees, double saturation, double value) {
    // Each channel is value·(1 − saturation·k), where k ∈ [0,1] is how far the hue is from that channel's sector.
    const double hue = std::fmod(std::fmod(hueDegrees, 360.0) + 360.0, 360.0) / 60.0;
    const auto channel = [&](double offset) {
        const double h = std::fmod(offset + hue, 6.0);
        return value - value * saturation * std::clamp(std::min(h, 4.0 - h), 0.0, 1.0);
    };
    return {channel(5), channel(3), channel(1)};
}

Hsv hsvFromRgb(const Rgb& c) {
    const double hi = std::max({c.r, c.g, c.b});
    const double span = hi - std::min({c.r, c.g, c.b});
    Hsv hsv;
    hsv.value = hi;
    hsv.saturation = hi > 0 ? span / hi : 0.0;
    if (span > 0) {
        double sector = 0;
        if (hi == c.r)
            sector = (c.g - c.b) / span;
        else if (hi == c.g)
            sector = (c.b - c.r) / span + 2;
        else
            sector = (c.r - c.g) / span + 4;
        hsv.hueDegrees = std::fmod(sector * 60 + 360, 360.0);
    }
    return hsv;
}

std::string hexFromRgb(const Rgb& rgb) {
    const auto byte = [](double v) { return static_cast<unsigned>(std::lround(std::clamp(v, 0.0, 1.0) * 255)); };
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(rgb.r), byte(rgb.g), byte(rgb.b));
    return text.data();
}

Rgb rgbFromHex(const std::string& text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    const bool shortForm = text.size() == 4, longForm = text.size() == 7;
    bool good = (shortForm || longForm) && text[0] == '#';
    for (std::size_t i = 1; good && i < text.size(); ++i) good = digit(text[i]) >= 0;
    if (!good) throw Error("'" + text + "' is not a colour", "", "write #rrggbb");
    const auto channel = [&](std::size_t i) {
        return shortForm ? digit(text[1 + i]) * 17 / 255.0
                         : (digit(text[1 + 2 * i]) * 16 + digit(text[2 + 2 * i])) / 255.0;
    };
    return {channel(0), channel(1), channel(2)};
}

Rgb rgbFromText(const std::string& text) {
    constexpr const char* kForm = "give #rrggbb or R,G,B with components from 0 to 1";
    if (text.starts_with('#')) try {
            return rgbFromHex(text);
        } catch (const Error& e) {
            throw UsageError(e.problem(), "", kForm);
        }
    std::array<double, 3> parts{};
    std::size_t start = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t end = i < 2 ? text.find(',', start) : text.size();
        if (end == std::string::npos || !parseNumber(std::string_view(text).substr(start, end - start), parts[i]) ||
            !(parts[i] >= 0 && parts[i] <= 1))
            throw UsageError("'" + text + "' is not a colour", "", kForm);
        start = end + 1;
    }
    return {parts[0], parts[1], parts[2]};
}

} // namespace pellucid
