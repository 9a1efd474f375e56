#include "options/camera_options.h"

#include <cctype>
#include <cmath>

#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kGroup = "View";

void requireZoom(double zoom, const std::string& option) {
    constexpr double kMostZoom = 1e6; // beyond that the angle of view is 0 or 180 degrees to within rounding
    if (!(zoom >= 1 / kMostZoom && zoom <= kMostZoom))
        throw UsageError("the zoom is not a number from 1e-6 to 1e6", option,
                         "1 fits the whole volume, 2 is twice as large");
}

/// NAME[,ZOOM]; empty where it begins with no name of a view.
std::optional<NamedView> parseNamedView(const std::string& text, const std::string& option) {
    const std::size_t comma = text.find(',');
    std::optional<NamedView> view = namedView(text.substr(0, comma));
    if (view && comma != std::string::npos) view->zoom = parseReal(text.substr(comma + 1), option);
    if (view) requireZoom(view->zoom, option);
    return view;
}

ViewAngles parseView(const std::string& text, const std::string& option) {
    const std::string form = "give AZIMUTH,ELEVATION[,ZOOM] in degrees, or anterior, posterior, left, right, superior, "
                             "inferior, front, back, top or bottom";
    if (!text.empty() && std::isalpha(static_cast<unsigned char>(text.front())))
        throw UsageError("'" + text + "' is not a view", option, form);
    const auto v = parseReals(text, option);
    if (v.size() != 2 && v.size() != 3) throw UsageError("'" + text + "' is not a view", option, form);
    if (std::abs(v[1]) > 90) throw UsageError("the elevation is not between -90 and 90 degrees", option, form);
    const ViewAngles view{v[0], v[1], v.size() == 3 ? v[2] : 1.0};
    requireZoom(view.zoom, option);
    return view;
}

} // namespace

void CameraOptions::add(CLI::App& app) {
    m_added = true;
    addValue(app, "--camera", "FILE", file, anyText, "camera file (JSON)", kGroup);
    addView(app, "--view",
            "degrees; 0,0 looks along +y from the front, z up; or anterior, posterior, left, right, superior, "
            "inferior, front, back, top, bottom; zoom 1 fits the sphere around the box" +
                std::string(mayBeBest ? "; best: found together with the opacities" : "") +
                " (default: the session's camera, else " +
                std::string(fallback ? "30,20)" : "30,20 with the box as large as it fits, as the window opens)"));
    app.add_flag("--orthographic", orthographic, "parallel rays (default: perspective)")->group(kGroup);
}

void CameraOptions::addView(CLI::App& app, const std::string& name, const std::string& help) {
    addValue(
        app, name, std::string("AZIMUTH,ELEVATION[,ZOOM]|SIDE[,ZOOM]") + (mayBeBest ? "|best" : ""),
        [this](const std::string& text, const std::string& option) {
            best = text == "best";
            if (best && !mayBeBest)
                throw UsageError("this command does not look for the best view", option,
                                 "ask pellucid-cli views for it, or optimize with --view best");
            if (best) return;
            namedView = parseNamedView(text, option);
            if (!namedView) view = parseView(text, option);
        },
        help, kGroup);
}

void CameraOptions::applyTo(SceneInputs& inputs) const {
    if (!m_added) { // nobody looks
        inputs.session.camera.reset();
        return;
    }
    if (file) {
        if (view || namedView || best) throw UsageError("two views are given", "--camera and --view", "leave one out");
        if (orthographic)
            throw UsageError("a camera file states its own projection", "--orthographic", "leave it out or use --view");
        inputs.camera = readCamera(*file);
        inputs.cameraName = *file;
        return;
    }
    inputs.view = view;
    inputs.namedView = namedView;
    if (!view && !namedView && !inputs.session.camera) inputs.view = fallback;
    if (orthographic) inputs.projection = Projection::Orthographic;
}

} // namespace pellucid::cli
