// What draws the picture inside the volume view: OpenGL where there is one, else the CPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <QWidget>

#include "base/error.h"
#include "render/box_in_image.h"
#include "session/scene.h"

namespace pellucid::gui {

/// How good the picture on the screen is.
struct PictureInfo {
    int width = 0, height = 0;      ///< pixels of the screen
    double resolutionScale = 1;     ///< rays per pixel along each axis
    double stepInD0 = 0.5;          ///< distance of samples along a ray, where it is smallest
    bool complete = false;          ///< the best that will come of this scene
    const Volume* volume = nullptr; ///< which one it shows; to be compared, no more
};

/// How finely a picture is drawn.
struct PicturePlan {
    double resolutionScale = 1; ///< rays per pixel along each axis
    double stepInD0 = 1;        ///< between samples of a ray
    std::optional<double> finestInD0 = {};
    bool operator==(const PicturePlan&) const = default;

    RenderSettings applied(RenderSettings settings, const QSize& pixels) const {
        settings.width = pixels.width();
        settings.height = pixels.height();
        settings.stepInD0 = stepInD0;
        settings.finestInD0 = finestInD0;
        return settings;
    }
};

/// The widget's size in pixels of the screen, at least one of them.
inline QSize devicePixels(const QWidget& widget) {
    const auto pixels = [&](int length) {
        return std::max(1, static_cast<int>(std::lround(length * widget.devicePixelRatioF())));
    };
    return {pixels(widget.width()), pixels(widget.height())};
}

/// A child widget of the view that shows a scene: a coarse picture at once, a full one when the scene has stayed the
/// same for a moment, and then the one that would be saved. What is complete depends on the scene and the size alone,
/// never on timing.
class ViewSurface {
public:
    virtual ~ViewSurface() = default;
    virtual QWidget* widget() = 0;
    /// What is to be shown, in the end as finely as its settings say. Its size is ignored: the widget's pixels.
    virtual void setScene(const PictureInput& scene) = 0;
    virtual const PictureInfo& picture() const = 0;
    virtual QString rendererName() const = 0; ///< for the status line

    std::function<void()> onPicture;             ///< after each new picture
    std::function<void(const Error&)> onFailure; ///< it cannot draw; called from the event loop
};

} // namespace pellucid::gui
