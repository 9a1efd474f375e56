// What is written over a picture: which way is which, how large, which colour is which value. Computed as marks in
// pixels, so that the window and saved pictures show the same.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/render_settings.h"
#include "render/stroke_font.h"
#include "tf/transfer_function.h"
#include "volume/orientation.h"
#include "volume/ruler.h"

namespace pellucid {

/// What stands around and over a picture.
struct AnnotationChoice {
    bool on = true; ///< false: nothing, whatever the others say
    bool cube = true, letters = true, axes = false, scale = true, legend = false, title = false, measures = true;
    bool operator==(const AnnotationChoice&) const = default;

    static AnnotationChoice none() { return {true, false, false, false, false, false, false, false}; }
    bool any() const { return on && (cube || letters || axes || scale || legend || title || measures); }
};

enum class AnnotationPart {
    Cube,    ///< a cube that turns with the volume: L R A P S I on its faces, or the file's axes
    Letters, ///< the anatomical direction of each edge of the picture; only where the file knows
    Axes,    ///< the box around the volume along the world's axes, with coordinates
    Scale,   ///< a bar of round length, at the depth of the camera's centre
    Legend,  ///< colours and opacities over the intensity window, in data units
    Title,   ///< of the volume
    Measures ///< distances, angles, spheres and boxes, with what they say
};
struct AnnotationPartInfo {
    AnnotationPart part;
    const char* name; ///< "cube" …, as options and sessions call it
    bool AnnotationChoice::*shown;
};
inline constexpr std::array<AnnotationPartInfo, 7> kAnnotationParts{
    {{AnnotationPart::Cube, "cube", &AnnotationChoice::cube},
     {AnnotationPart::Letters, "letters", &AnnotationChoice::letters},
     {AnnotationPart::Axes, "axes", &AnnotationChoice::axes},
     {AnnotationPart::Scale, "scale", &AnnotationChoice::scale},
     {AnnotationPart::Legend, "legend", &AnnotationChoice::legend},
     {AnnotationPart::Title, "title", &AnnotationChoice::title},
     {AnnotationPart::Measures, "measures", &AnnotationChoice::measures}}};

/// A measure as it is drawn.
struct ShownRuler {
    Ruler ruler;
    std::string label = {};  ///< what it says, such as "12.3 mm"; may be empty
    bool isSelected = false; ///< drawn in another colour
    bool operator==(const ShownRuler&) const = default;
};

struct AnnotationInput {
    AnnotationChoice show;
    Camera camera;
    Geometry geometry;
    TransferFunction tf;
    ValueRange window; ///< data units of intensity 0 and 1
    std::string title;
    RenderSettings picture; ///< size in pixels, background, mode, feature
    double density = 1;     ///< pixels in which lengths of the screen are one: no text gets smaller than 7 of them
    std::vector<ShownRuler> rulers = {}; ///< without those that are hidden
    PatientAxes axes = PatientAxes::Lps; ///< of coordinates
};

/// One thing to draw: in pixels from the top left corner of the picture, y down.
struct Mark {
    enum class Kind { Line, Area, Text };
    AnnotationPart part = AnnotationPart::Cube;
    Kind kind = Kind::Line;
    std::vector<Vec2> points = {}; ///< of a line; corners of a convex area; of a text: where its baseline begins
    Rgb color = {};
    double alpha = 1;
    double width = 1; ///< of lines and of the strokes of a text; they have round ends
    double halo = 0;  ///< how far a rim of `haloColor` reaches around them; 0: none
    Rgb haloColor = {};
    std::string text = {};        ///< UTF-8
    Vec2 across{1, 0}, up{0, -1}; ///< of a text: as far along the line and upward as a capital is high
    bool operator==(const Mark&) const = default;
};
inline constexpr double kHaloAlpha = 0.6; ///< of the alpha of its mark

/// The lines that a Line or Text is drawn as.
std::vector<Polyline> strokesOf(const Mark& mark);

struct PixelBox {
    double left, top, right, bottom;
    bool meets(const PixelBox& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
    /// Wider by this much on all sides.
    PixelBox widened(double by) const { return {left - by, top - by, right + by, bottom + by}; }
};
/// The smallest box that holds all points.
PixelBox boxAround(const std::vector<Vec2>& points);
/// Around all that is drawn of a mark, its halo too.
PixelBox extentOf(const Mark& mark);

/// In the order in which they are drawn. Parts that find no room in a small picture are left out. The parts do not
/// overlap, but for lines of the axes and measures.
std::vector<Mark> annotationMarks(const AnnotationInput& input);

} // namespace pellucid
