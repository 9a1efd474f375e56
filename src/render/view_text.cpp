#include "render/view_text.h"

#include <cctype>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

namespace {

constexpr const char* kForm =
    "give AZIMUTH,ELEVATION[,ZOOM] in degrees, or anterior, posterior, left, right, superior, "
    "inferior, front, back, top or bottom";

UsageError noView(const std::string& text) { return {"'" + text + "' is not a view", "", kForm}; }

double numberIn(const std::string& text) {
    double value = 0;
    if (parseNumber(text, value) && std::isfinite(value)) return value;
    throw UsageError("'" + text + "' is not a number", "", "give a finite decimal number such as 2 or 0.5");
}

double zoomIn(const std::string& text) {
    constexpr double kMostZoom = 1e6; // beyond that the angle of view is 0 or 180 degrees to within rounding
    const double zoom = numberIn(text);
    if (!(zoom >= 1 / kMostZoom && zoom <= kMostZoom))
        throw UsageError("the zoom is not a number from 1e-6 to 1e6", "",
                         "1 fits the whole volume, 2 is twice as large");
    return zoom;
}

std::vector<std::string> partsOf(const std::string& text) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == ',')
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

} // namespace

WordedView viewFromText(const std::string& text) {
    const std::vector<std::string> parts = partsOf(text);
    if (std::optional<NamedView> named = namedView(parts[0]); named && parts.size() <= 2) {
        if (parts.size() == 2) named->zoom = zoomIn(parts[1]);
        return *named;
    }
    if (!text.empty() && std::isalpha(static_cast<unsigned char>(text.front()))) throw noView(text);
    std::vector<double> numbers;
    for (const std::string& part : parts) numbers.push_back(numberIn(part));
    if (numbers.size() != 2 && numbers.size() != 3) throw noView(text);
    if (std::abs(numbers[1]) > 90) throw UsageError("the elevation is not between -90 and 90 degrees", "", kForm);
    return ViewAngles{numbers[0], numbers[1], parts.size() == 3 ? zoomIn(parts[2]) : 1.0};
}

} // namespace pellucid
