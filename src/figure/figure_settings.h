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
    bool FigureParts::*shown;
};
inline constexpr std::array<FigurePartInfo, 11> kFigureParts{{{"title", "Title", &FigureParts::title},
                                                              {"scale", "Scale bar", &FigureParts::scale},
                                                              {"letters", "Anatomical letters", &FigureParts::letters},
                                                              {"cube", "Orientation cube", &FigureParts::cube},
                                                              {"axes", "Axes", &FigureParts::axes},
                                                              {"measures", "Measures", &FigureParts::measures},
                                                              {"legend", "Legend of features", &FigureParts::legend},
                                                              {"shares", "Bars of shares", &FigureParts::shares},
                                                              {"targets", "Targets of shares", &FigureParts::targets},
                                                              {"colors", "Colour scale", &FigureParts::colors},
                                                              {"caption", "Caption", &FigureParts::caption}}};
/// "scale,legend"; "picture" may be among them, and stands for nothing more. Throws UsageError without a place.
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
