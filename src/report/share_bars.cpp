#include "report/share_bars.h"
#include "base/round_numbers.h"

#include <algorithm>

namespace pellucid {

PlotDrawing drawingOf(const std::vector<ShareBar>& bars, double most, const PlotPage& page) {
    const double row = 2.6 * page.fontSize, gap = 6;
    const double names = std::min(0.35 * page.width, 12 * page.fontSize);
    const double numbers = page.widthOf("0.000") + gap, width = page.width - names - numbers;
    using Anchor = PlotText::Anchor;
    PlotDrawing drawing;
    drawing.width = page.width;
    drawing.height = row * static_cast<double>(bars.size());
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const ShareBar& bar = bars[i];
        const double top = row * static_cast<double>(i) + 0.15 * row;
        const auto x = [&](double share) { return names + std::clamp(share / most, 0.0, 1.0) * width; };
        const auto area = [&](double from, double height, double to, PlotInk ink) {
            drawing.areas.push_back({{names, from}, {to, from + height}, ink, bar.color});
        };
        area(top, 0.7 * row, names + width, PlotInk::Shade);
        // A rim, so that a white bar is seen on white.
        area(top, 0.45 * row, x(bar.vws), PlotInk::Rim);
        drawing.areas.push_back(
            {{names, top + 1}, {std::max(names, x(bar.vws) - 1), top + 0.45 * row - 1}, PlotInk::Own, bar.color});
        if (bar.visibility) area(top + 0.52 * row, 0.14 * row, x(*bar.visibility), PlotInk::Faint);
        if (bar.target)
            drawing.strokes.push_back(
                {{{x(*bar.target), top - 2}, {x(*bar.target), top + 0.7 * row}}, PlotInk::Text, {}, 2});
        const double base = top + 0.3 * row + 0.35 * page.fontSize;
        drawing.texts.push_back(
            {{names - gap, base}, page.fitted(bar.name, names - gap), PlotInk::Text, Anchor::End, page.fontSize});
        drawing.texts.push_back({{page.width, base}, fixedText(bar.vws, 3), PlotInk::Text, Anchor::End, page.fontSize});
    }
    return drawing;
}

} // namespace pellucid
