#include "options/overlay_options.h"

#include "parse.h"
#include "tf/formats/tf_file.h"

namespace pellucid::cli {

namespace {

constexpr const char* kOverlayGroup = "Overlay";

} // namespace

void OverlayOptions::add(CLI::App& app) {
    addValue(
        app, "--overlay", "FILE|none",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the name of the overlay is empty", option, "name a file or sample");
            path = text;
        },
        "a second volume over the first, as a t-map over its anatomy: a volume file or sample:NAME; none: not that of "
        "the session",
        kOverlayGroup);
    addValue(app, "--overlay-tf", "TF|none", tf, anyText,
             "its own transfer function, as --tf takes it, in the place of threshold, top and colours; none: not that "
             "of the session",
             kOverlayGroup);
    given.add(app, kOverlayGroup);
}

void OverlayOptions::applyTo(SceneInputs& inputs) const {
    Part<OverlayView>& overlay = inputs.session.overlay;
    if (path) {
        OverlayView named;
        if (*path != "none") named.source.path = *path;
        overlay = named;
    }
    if (!tf && given.given().empty()) return;
    const std::string detail = tf ? "--overlay-tf" : given.given().front()->optionName();
    if (overlay->isNone()) throw UsageError("there is no overlay", detail, "add --overlay FILE");
    std::optional<TransferFunction> curve;
    if (tf && *tf != "none") {
        for (const Setting* setting : given.given())
            if (std::string_view(setting->key) != "opacity")
                throw UsageError("an overlay with a transfer function of its own has no such setting",
                                 setting->optionName(), "leave it or --overlay-tf out");
        curve = atOption("--overlay-tf " + *tf, [&] { return loadTf(*tf); });
    }
    overlay.edit([&](OverlayView& view) {
        if (tf) view.curve = curve;
        given.applyTo(view);
        view.shown = true;
    });
}

std::vector<std::string> OverlayOptions::convertTf(Scene& scene) const {
    if (!tf || *tf == "none" || !scene.overlay) return {};
    const ReadTf read = readTfNamed(*tf);
    const Geometry& geometry = scene.data->geometry();
    if (TransferFunction curve = forVolume(read, geometry); !(curve == read.tf)) {
        scene.session.overlay.edit([&](OverlayView& view) { view.curve = std::move(curve); });
        auto dressed = std::make_shared<SceneOverlay>(*scene.overlay);
        dressOverlay(*dressed, *scene.session.overlay);
        scene.overlay = std::move(dressed);
    }
    return openingNotices(read, geometry, scene.overlay->volume->range());
}

} // namespace pellucid::cli
