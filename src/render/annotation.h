// The frame of reference of a picture: which way is which, how large, which colour is which value. Computed as marks in
// pixels, so that the window and saved pictures show the same.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/render_settings.h"
#include "render/stroke_font.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// What stands around and over a picture.
struct FrameOfReference {
    bool on = true; ///< false: nothing, whatever the others say
    bool cube = true, letters = true, axes = false, scale = true, legend = false, title = false;
    bool operator==(const FrameOfReference&) const = default;

    static FrameOfReference none() { return {true, false, false, false, false, false, false}; }
    bool any() const { return on && (cube || letters || axes || scale || legend || title); }
};

enum class FramePart {
    Cube,    ///< a cube that turns with the volume: L R A P S I on its faces, or the file's axes
    Letters, ///< the anatomical direction of each edge of the picture; only where the file knows
    Axes,    ///< the box around the volume along the world's axes, with coordinates
    Scale,   ///< a bar of round length, at the depth of the camera's centre
    Legend,  ///< colours and opacities over the intensity window, in data units
    Title    ///< of the volume
};
struct FramePartInfo {
    FramePart part;
    const char* name; ///< "cube" …, as options and sessions call it
    bool FrameOfReference::*shown;
};
inline constexpr std::array<FramePartInfo, 6> kFrameParts{{{FramePart::Cube, "cube", &FrameOfReference::cube},
                                                           {FramePart::Letters, "letters", &FrameOfReference::letters},
                                                           {FramePart::Axes, "axes", &FrameOfReference::axes},
                                                           {FramePart::Scale, "scale", &FrameOfReference::scale},
                                                           {FramePart::Legend, "legend", &FrameOfReference::legend},
                                                           {FramePart::Title, "title", &FrameOfReference::title}}};

struct AnnotationInput {
    FrameOfReference show;
    Camera camera;
    Geometry geometry;
    TransferFunction tf;
    ValueRange window; ///< data units of intensity 0 and 1
    std::string title;
    RenderSettings picture; ///< size in pixels, background, mode, feature
    double density = 1;     ///< pixels in which lengths of the screen are one: no text gets smaller than 7 of them
};

/// One thing to draw: in pixels from the top left corner of the picture, y down.
struct Mark {
    enum class Kind { Line, Area, Text };
    FramePart part = FramePart::Cube;
    Kind kind = Kind::Line;
    std::vector<Vec2> points; ///< of a line; corners of a convex area; of a text: where its baseline begins
    Rgb color;
    double alpha = 1;
    double width = 1; ///< of lines and of the strokes of a text; they have round ends
    double halo = 0;  ///< how far a rim of `haloColor` reaches around them; 0: none
    Rgb haloColor;
    std::string text;             ///< UTF-8
    Vec2 across{1, 0}, up{0, -1}; ///< of a text: as far along the line and upward as a capital is high
};
inline constexpr double kHaloAlpha = 0.6; ///< of the alpha of its mark

/// The lines that a Line or Text is drawn as.
std::vector<Polyline> strokesOf(const Mark& mark);

struct PixelBox {
    double left, top, right, bottom;
    bool meets(const PixelBox& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
};
/// Around all that is drawn of a mark, its halo too.
PixelBox extentOf(const Mark& mark);

/// In the order in which they are drawn. Parts that find no room in a small picture are left out. The parts do not
/// overlap, but for lines of the axes.
std::vector<Mark> annotationMarks(const AnnotationInput& input);

} // namespace pellucid
