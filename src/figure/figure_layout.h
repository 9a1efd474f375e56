// Where everything of a figure lies on paper.
#pragma once

#include <vector>

#include "figure/figure.h"
#include "figure/figure_settings.h"
#include "session/scene.h"

namespace pellucid {

/// A feature in the legend and among the bars.
struct FigureRow {
    std::string name;
    Rgb color;
    double opacity = 0;             ///< of its peak, [0,1]
    std::optional<double> vws = {}; ///< share of saliency, [0,1]; empty: the mode has none
    std::optional<double> visibility = {};
    std::optional<double> target = {}; ///< wanted VWS; empty: not asked for
};

/// What a figure is made of.
struct FigureContent {
    FigureSettings settings;
    std::shared_ptr<const Image> image; ///< figurePixels() of the settings
    PictureInput picture;               ///< as it was drawn
    AnnotationInput around;             ///< what stands over it; what is shown, the settings say
    std::vector<FigureRow> rows;        ///< of what is drawn
    std::string unit;                   ///< of the data; may be empty
    std::string title, caption, alt;    ///< printable()
};

/// Pixels of a picture in which lengths of the screen are one, so that letters over it are as large as beside it.
double annotationDensity(const FigureSettings& settings);

inline constexpr std::size_t kMostFigureRows = 40; ///< the others are counted

/// Throws as extentOf() does, and Error where it would be higher than kMostFigureMm.
Figure layOut(const FigureContent& content);
inline constexpr double kMostFigureMm = 5000; ///< about the largest page of PDF

} // namespace pellucid
