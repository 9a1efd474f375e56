#include "tf/formats/paraview_preset.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "tf/shown_tf.h"

namespace pellucid {

nlohmann::json paraViewPreset(const TransferFunction& tf, const ValueRange& window, const std::string& name) {
    constexpr double kApart = 1e-6; // ParaView keeps one point for each x
    nlohmann::json colors = nlohmann::json::array(), opacities = nlohmann::json::array();
    const std::vector<ControlPoint> points = shownTf(tf).pointsWithEnds();
    double last = -1; // intensity
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ControlPoint& p = points[i];
        double x = i == 0 ? p.x : std::max(p.x, last + kApart);
        if (x > 1) { // a step at the upper end: what lies below it keeps its place but for a little
            x = 1;
            const std::size_t at = colors.size() - 4;
            colors[at] = opacities[at] = window.lo + (1 - kApart) * (window.hi - window.lo);
        }
        last = x;
        const double value = window.lo + x * (window.hi - window.lo);
        for (const double v : {value, p.color.r, p.color.g, p.color.b}) colors.push_back(v);
        for (const double v : {value, p.opacity, 0.5, 0.0}) opacities.push_back(v); // straight on to the next
    }
    return nlohmann::json::array({{{"Name", name},
                                   {"Creator", "Pellucid"},
                                   {"ColorSpace", "RGB"},
                                   {"NanColor", {0, 0, 0}},
                                   {"RGBPoints", std::move(colors)},
                                   {"Points", std::move(opacities)}}});
}

} // namespace pellucid
