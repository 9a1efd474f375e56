#include "tf/formats/paraview_preset.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "tf/shown_tf.h"

namespace pellucid {

nlohmann::json paraViewPreset(const TransferFunction& tf, const ValueRange& window, const std::string& name) {
    constexpr double kApart = 1e-6; // ParaView keeps one point for each x
    nlohmann::json colors = nlohmann::json::array(), opacities = nlohmann::json::array();
    const std::vector<ControlPoint> points = shownTf(tf).pointsWithEnds();
    // Steps give way upward, and those that no longer fit below 1 downward from there.
    std::vector<double> at;
    for (const ControlPoint& p : points) at.push_back(at.empty() ? p.x : std::max(p.x, at.back() + kApart));
    for (std::size_t i = at.size(); i-- > 0;)
        at[i] = std::min(at[i], 1 - kApart * static_cast<double>(at.size() - 1 - i));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ControlPoint& p = points[i];
        const double value = window.lo + at[i] * (window.hi - window.lo);
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
