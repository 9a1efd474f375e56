#include "figure/figure_settings.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "figure/figure.h"

namespace pellucid {

FigureParts figurePartsOf(const std::string& text) {
    FigureParts parts;
    for (const std::string& word : splitAt(',', text)) {
        const std::string name = trimmed(word);
        if (name == "picture") continue;
        if (name == "all") {
            for (const FigurePartInfo& part : kFigureParts) parts.*part.shown = true;
            continue;
        }
        const auto part = std::ranges::find_if(kFigureParts, [&](const FigurePartInfo& p) { return name == p.name; });
        if (part == kFigureParts.end())
            throw UsageError(inQuotes(name) + " is no part of a figure", "",
                             "give all, or some of picture, " + joined(kFigureParts, ", ", &FigurePartInfo::name) +
                                 " with commas between");
        parts.*part->shown = true;
    }
    return parts;
}

std::string textOf(const FigureParts& parts) {
    std::string text = "picture";
    for (const FigurePartInfo& part : kFigureParts)
        if (parts.*part.shown) text += std::string(",") + part.name;
    return text;
}

template <>
std::span<const Setting> settingsOf<FigureSettings>() {
    using F = FigureSettings;
    static const Setting kSettings[] = {
        {.key = "width_mm",
         .at = member<&F::widthMm>,
         .words = "&Width",
         .help = "How wide the figure and its picture are on paper. Columns of journals are 85, 114 or 174 mm wide.",
         .range = {20, 1000},
         .unit = "mm"},
        {.key = "height_mm",
         .at = member<&F::heightMm>,
         .words = "&Height of the picture",
         .help = "How high the picture is on paper; what stands around it comes on top of that. Without it the height "
                 "is three quarters of the width.",
         .range = {10, 1000},
         .unit = "mm"},
        {.key = "dpi",
         .at = member<&F::dpi>,
         .words = "&Resolution",
         .help = "Pixels of the picture per inch; all else is drawn as lines, areas and letters.",
         .range = {36, 2400},
         .unit = "dpi"},
        {.key = "font_pt",
         .at = member<&F::fontPt>,
         .words = "Font &size",
         .help = "Size of the letters.",
         .range = {4, 36},
         .unit = "pt"},
        {.key = "font",
         .at = member<&F::font>,
         .words = "F&ont",
         .help =
             "Families of fonts with commas between; the first that is installed counts. Where none is, another one "
             "stands in, and a note says which.",
         .checkText =
             [](const std::string& text) {
                 if (text.size() > 200) throw UsageError("the names of fonts are too long", "", "name one or two");
             }},
        {.key = "parts",
         .at = member<&F::parts>,
         .words = "&Parts",
         .help =
             "What the figure has: all, or some of picture, title, scale, letters, cube, axes, measures, legend, "
             "shares, targets, colors, caption with commas between. The picture is always there; targets stand among "
             "the bars of shares.",
         .checkText = [](const std::string& text) { figurePartsOf(text); }},
        {.key = "title",
         .at = member<&F::title>,
         .words = "&Title",
         .help = "What the part title says, and what files call the figure. Without it: the name of the volume."},
    };
    return kSettings;
}

FigurePixels figurePixels(const FigureSettings& settings) {
    const auto pixels = [&](double mm) {
        return std::max(1, static_cast<int>(std::lround(mm * settings.dpi / kMmPerInch)));
    };
    const int width = pixels(settings.widthMm);
    return {width, pixels(settings.heightMm.value_or(0.75 * settings.widthMm)), settings.widthMm / width};
}

} // namespace pellucid
