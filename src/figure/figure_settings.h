// What a figure for print has, and how large it is.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/setting.h"

namespace pellucid {

/// What stands in a figure beside its picture.
struct FigureParts {
    bool title = false, scale = false, letters = false, cube = false, axes = false, measures = false;
    bool legend = false, shares = false, targets = false, colors = false, caption = false;
    bool operator==(const FigureParts&) const = default;
};
struct FigurePartInfo {
    const char* name;  ///< as settings call it
    const char* words; ///< as controls do
    const char* help;  ///< a sentence
    bool FigureParts::*shown;
};
inline constexpr std::array<FigurePartInfo, 11> kFigureParts{
    {{"title", "Title", "A line above the picture, set in bold", &FigureParts::title},
     {"scale", "Scale bar", "A line in the picture as long on paper as it says", &FigureParts::scale},
     {"letters", "Anatomical letters", "L R A P S I at the edges of the picture, for data of a patient",
      &FigureParts::letters},
     {"cube", "Orientation cube", "A small cube that shows from which side the volume is seen", &FigureParts::cube},
     {"axes", "Axes", "The axes of the world at a corner of the volume", &FigureParts::axes},
     {"measures", "Measures", "Distances, angles, spheres and boxes that the session has", &FigureParts::measures},
     {"legend", "Legend of features", "Colour, name, highest opacity and share of each feature that is drawn",
      &FigureParts::legend},
     {"shares", "Bars of shares", "How much of the saliency and of what is visible each feature has, as bars",
      &FigureParts::shares},
     {"targets", "Targets of shares", "Upright lines at the wanted shares; they need the bars", &FigureParts::targets},
     {"colors", "Colour scale", "Colours and opacities over the values", &FigureParts::colors},
     {"caption", "Caption", "What the picture shows, in measured words", &FigureParts::caption}}};
/// "scale,legend", or "all"; "picture" may be among them, and stands for nothing more. Throws UsageError without a
/// place.
FigureParts figurePartsOf(const std::string& text);
/// Names with commas between, in the order of kFigureParts; "picture" where there are none.
std::string textOf(const FigureParts& parts);

struct FigureSettings {
    double widthMm = 85;                               ///< of the figure, and of its picture
    std::optional<double> heightMm = {};               ///< of the picture; empty: 3/4 of its width
    double dpi = 300;                                  ///< pixels of the picture per inch
    double fontPt = 7;                                 ///< size of letters
    std::string font = "Liberation Sans, DejaVu Sans"; ///< families, the first that is there counts
    std::string parts = "picture,scale,letters,legend,shares";
    std::string title = {}; ///< empty: the name of the volume
    bool operator==(const FigureSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<FigureSettings>();

/// Of the picture, with square pixels.
struct FigurePixels {
    int width = 1, height = 1;
    double mmPerPixel = 1;
};
FigurePixels figurePixels(const FigureSettings& settings);

} // namespace pellucid
