#include "options/camera_options.h"

#include "parse.h"
#include "render/view_text.h"

namespace pellucid::cli {

namespace {

constexpr const char* kCameraGroup = "View";

} // namespace

void CameraOptions::add(CLI::App& app) {
    m_added = true;
    addValue(app, "--camera", "FILE", file, anyText, "camera file (JSON)", kCameraGroup);
    addView(app, "--view",
            "degrees; 0,0 looks along +y from the front, z up; or anterior, posterior, left, right, superior, "
            "inferior, front, back, top, bottom; zoom 1 fits the sphere around the box" +
                std::string(mayBeBest ? "; best: found together with the opacities" : "") +
                " (default: the session's camera, else " +
                std::string(fallback ? "30,20)"
                                     : "the view that the window opens on, fitted to what is drawn; with a --tf of "
                                       "yours 30,20, fitted to the box)"));
    app.add_flag("--orthographic", orthographic, "parallel rays (default: perspective)")->group(kCameraGroup);
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
            view.reset();
            namedView.reset();
            const WordedView worded = atOption(option, [&] { return viewFromText(text); });
            if (const auto* named = std::get_if<NamedView>(&worded))
                namedView = *named;
            else
                view = std::get<ViewAngles>(worded);
        },
        help, kCameraGroup);
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
