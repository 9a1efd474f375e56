#include "report/share_bars.h"

#include <algorithm>
#include <functional>

#include "base/check.h"
#include "base/error.h"
#include "base/round_numbers.h"
#include "report/drawing_file.h"

namespace pellucid {

namespace {

using Anchor = PlotText::Anchor;

constexpr double kBarGap = 6;      ///< between texts and what they stand beside, pixels
constexpr double kChart = 150;     ///< height of the bars of a share at the upper end of the scale
constexpr double kWidestBar = 64;  ///< pixels
constexpr double kWidestName = 10; ///< in font sizes
constexpr int kDigits = 4;         ///< of a share

/// One of the charts.
struct Measured {
    std::string title;
    std::function<std::optional<double>(const ShareBar&)> of;
    bool hasTarget = false;
};

std::vector<Measured> measuredOf(const std::vector<ShareBar>& bars) {
    std::vector<Measured> all{{"Feature visibility", [](const ShareBar& b) { return b.visibility; }},
                              {"VWS of brightness", [](const ShareBar& b) { return b.vwsBrightness; }},
                              {"VWS of saturation", [](const ShareBar& b) { return b.vwsSaturation; }},
                              {"Visibility-weighted saliency", [](const ShareBar& b) { return std::optional(b.vws); }},
                              {"2D feature saliency", [](const ShareBar& b) { return b.fs; }}};
    all[3].hasTarget = true;
    std::erase_if(all, [&](const Measured& measured) {
        return std::none_of(bars.begin(), bars.end(), [&](const ShareBar& bar) { return measured.of(bar); });
    });
    return all;
}

/// From 0 to beyond the largest share, for all charts.
PlotAxis scaleOf(const std::vector<ShareBar>& bars, const std::vector<Measured>& charts) {
    double most = 0;
    for (const ShareBar& bar : bars)
        for (const Measured& chart : charts) {
            most = std::max(most, chart.of(bar).value_or(0));
            if (chart.hasTarget) most = std::max(most, bar.target.value_or(0));
        }
    return {.label = {}, .lo = 0, .hi = most > 0 ? std::min(1.0, 1.05 * most) : 1};
}

/// Draws charts of one size, whose upper left corner is given.
class ChartDrawing {
public:
    ChartDrawing(const std::vector<ShareBar>& bars, const std::vector<Measured>& charts, const PlotPage& page,
                 PlotAxis scale)
        : m_bars(bars), m_page(page), m_scale(std::move(scale)), m_ticks(ticksOf(m_scale, 5)) {
        for (const Measured& chart : charts) m_title = std::max(m_title, m_page.widthOf(chart.title));
        for (const double tick : m_ticks)
            m_axis = std::max(m_axis, m_page.widthOf(tickText(m_scale, tick)) + 2 * kBarGap);
        m_slot = m_page.widthOf(fixedText(0, kDigits)) + kBarGap;
        for (const ShareBar& bar : bars)
            m_slot = std::max(m_slot, std::min(m_page.widthOf(bar.name), kWidestName * m_page.fontSize) + kBarGap);
    }
    double leastWidth() const {
        return m_axis + std::max(m_slot * static_cast<double>(m_bars.size()), m_title) + kBarGap;
    }
    double height() const { return 2 * kBarGap + 4 * line() + kChart; }
    void setWidth(double width) {
        m_width = width;
        m_slot = (width - m_axis - kBarGap) / static_cast<double>(std::max<std::size_t>(1, m_bars.size()));
    }

    void add(const Measured& chart, const Vec2& corner, PlotDrawing& to) const {
        const double left = corner.x + m_axis, bottom = corner.y + kBarGap + 2.5 * line() + kChart;
        const auto yOf = [&](double share) { return bottom - kChart * share / m_scale.hi; };
        to.texts.push_back({{left, corner.y + kBarGap + m_page.fontSize},
                            m_page.fitted(chart.title, m_width - m_axis - kBarGap),
                            PlotInk::Text,
                            Anchor::Start,
                            m_page.fontSize,
                            false,
                            true});
        for (const double tick : m_ticks) {
            const double y = yOf(tick);
            to.areas.push_back({{left, y - 0.5}, {corner.x + m_width - kBarGap, y + 0.5}, PlotInk::Grid, {}});
            to.texts.push_back({{left - kBarGap, y + 0.35 * m_page.fontSize},
                                tickText(m_scale, tick),
                                PlotInk::Faint,
                                Anchor::End,
                                m_page.fontSize});
        }
        for (std::size_t i = 0; i < m_bars.size(); ++i)
            addBar(chart, m_bars[i], left + m_slot * (static_cast<double>(i) + 0.5), bottom, to);
    }

private:
    double line() const { return 1.5 * m_page.fontSize; }

    void addBar(const Measured& chart, const ShareBar& bar, double middle, double bottom, PlotDrawing& to) const {
        to.texts.push_back({{middle, bottom + line()},
                            m_page.fitted(bar.name, m_slot - kBarGap),
                            PlotInk::Text,
                            Anchor::Middle,
                            m_page.fontSize});
        const std::optional<double> share = chart.of(bar);
        if (!share) return;
        const double half = std::min(kWidestBar, 0.8 * m_slot) / 2, top = bottom - kChart * *share / m_scale.hi;
        // A rim, so that a white bar is seen on white.
        to.areas.push_back({{middle - half, top}, {middle + half, bottom}, PlotInk::Rim, {}});
        to.areas.push_back({{middle - half + 1, std::min(bottom, top + 1)},
                            {middle + half - 1, std::max(std::min(bottom, top + 1), bottom - 1)},
                            PlotInk::Own,
                            bar.color});
        to.texts.push_back({{middle, top - 0.4 * m_page.fontSize},
                            fixedText(*share, kDigits),
                            PlotInk::Text,
                            Anchor::Middle,
                            m_page.fontSize});
        if (!chart.hasTarget || !bar.target) return;
        const double goal = bottom - kChart * *bar.target / m_scale.hi;
        to.strokes.push_back(
            {{{middle - m_slot / 2 + 2, goal}, {middle + m_slot / 2 - 2, goal}}, PlotInk::Text, {}, 2, true});
    }

    const std::vector<ShareBar>& m_bars;
    const PlotPage& m_page;
    PlotAxis m_scale;
    std::vector<double> m_ticks;
    double m_axis = 0, m_slot = 0, m_title = 0, m_width = 0;
};

/// As many beside each other as have room, and no row with one chart less than it could have.
std::size_t columnsOf(std::size_t charts, double room, double width) {
    const auto most = std::clamp<std::size_t>(static_cast<std::size_t>(room / width), 1, charts);
    const std::size_t rows = (charts + most - 1) / most;
    return (charts + rows - 1) / rows;
}

} // namespace

std::vector<ShareBar> shareBarsOf(const TransferFunction& tf, const std::vector<FeatureMeasures>& measures,
                                  const std::vector<double>& fs) {
    PELLUCID_CHECK(measures.size() == tf.features.size() && (fs.empty() || fs.size() == measures.size()));
    std::vector<ShareBar> bars;
    for (std::size_t f = 0; f < measures.size(); ++f) {
        const FeatureMeasures& m = measures[f];
        ShareBar bar{tf.features[f].name, tf.features[f].color, m.vws, m.visibility, {},
                     m.vwsBrightness,     m.vwsSaturation,      {}};
        if (!fs.empty()) bar.fs = fs[f];
        bars.push_back(std::move(bar));
    }
    return bars;
}

PlotDrawing chartsOf(const std::vector<ShareBar>& bars, const PlotPage& page) {
    PlotDrawing drawing;
    drawing.width = page.width;
    const std::vector<Measured> charts = measuredOf(bars);
    if (charts.empty()) return drawing;
    ChartDrawing chart(bars, charts, page, scaleOf(bars, charts));
    const std::size_t columns = columnsOf(charts.size(), page.width, chart.leastWidth());
    const double width = page.width / static_cast<double>(columns);
    chart.setWidth(width);
    for (std::size_t i = 0; i < charts.size(); ++i)
        chart.add(charts[i],
                  {width * static_cast<double>(i % columns), chart.height() * static_cast<double>(i / columns)},
                  drawing);
    drawing.height = chart.height() * static_cast<double>((charts.size() + columns - 1) / columns);
    return drawing;
}

void writeShareCharts(const std::vector<ShareBar>& bars, const std::string& path) {
    if (bars.empty()) throw Error("there are no features to draw bars of", path, "give the transfer function features");
    writeDrawing([&](const PlotPage& page) { return chartsOf(bars, page); }, {.width = 760}, path);
}

PlotDrawing drawingOf(const std::vector<ShareBar>& bars, double most, const PlotPage& page) {
    const double row = 2.6 * page.fontSize, gap = 6;
    const double names = std::min(0.35 * page.width, 12 * page.fontSize);
    const double numbers = page.widthOf("0.000") + gap, width = page.width - names - numbers;
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
