#include "figure/figure_layout.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/round_numbers.h"
#include "figure/figure_marks.h"
#include "figure/print.h"
#include "optimize/answer/visibility_words.h"

namespace pellucid {

namespace {

constexpr Rgb kInk{0, 0, 0}, kFaintInk{0.35, 0.35, 0.35}, kRule{0.6, 0.6, 0.6}, kGround{0.93, 0.93, 0.93};
constexpr Rgb kThinBar{0.45, 0.45, 0.45};
constexpr double kCapitalOfFont = 0.7; // about what a capital has of the size of its font
constexpr double kRim = 0.05;          // width of lines around areas, in sizes of the font
constexpr double kEdge = 0.15;         // between lines and the edge of the page, which viewers and printers cut
constexpr double kSmall = 0.9;         // of headings of columns and of numbers at axes
constexpr int kMostCaptionLines = 24;

/// Columns of the table of features, from left to right.
struct Columns {
    double name = 0, nameWidth = 0;        ///< where names begin, and how wide they may be
    std::optional<double> opacity, shares; ///< right ends of numbers
    double bars = 0, barsEnd = 0;          ///< what shares from 0 to `most` take; equal: there are no bars
    double most = 1;
};

class Layout {
public:
    explicit Layout(const FigureContent& content)
        : m_in(content), m_set(content.settings), m_parts(figurePartsOf(m_set.parts)), m_width(m_set.widthMm),
          m_em(m_set.fontPt * kMmPerPoint), m_capital(extentOf(textOf("H"), m_set.font).capital) {
        m_figure.width = m_width;
        m_figure.title = content.title;
        m_figure.font = m_set.font;
    }

    Figure figure() {
        if (m_parts.title) addTitle();
        addPicture();
        const bool shares = m_parts.shares && !m_in.rows.empty() && m_in.rows.front().vws.has_value();
        if ((m_parts.legend || shares) && !m_in.rows.empty()) addTable(shares);
        if (m_parts.colors) addColors();
        if (m_parts.caption) addCaption();
        m_figure.height = m_y;
        m_figure.description = m_in.caption.empty() ? m_in.alt : m_in.caption;
        if (m_figure.height > kMostFigureMm)
            throw Error("the figure would be " + numberText(m_figure.height / 1000, 1) + " m high", "",
                        "make it narrower, or its letters smaller");
        return std::move(m_figure);
    }

private:
    // ------------------------------------------------------------------------------------------------- elements

    FigureText textOf(const std::string& words, const Vec2& at = {}, Align align = Align::Start,
                      double size = 1) const {
        return {.text = words, .at = at, .points = m_set.fontPt * size, .align = align, .color = kInk};
    }
    double widthOf(const std::string& words, double size = 1) const {
        return extentOf(textOf(words, {}, Align::Start, size), m_set.font).width;
    }
    FigureGroup& group(const std::string& name, const std::string& label) {
        return m_figure.groups.emplace_back(FigureGroup{.name = name, .label = label, .clip = {}});
    }
    static FigureArea boxOf(const PixelBox& b, const Rgb& color) {
        return {.corners = {{b.left, b.top}, {b.right, b.top}, {b.right, b.bottom}, {b.left, b.bottom}},
                .color = color};
    }
    FigureLine lineOf(const Vec2& from, const Vec2& to, const Rgb& color = kInk, double width = 0.07) const {
        return {.points = {from, to}, .color = color, .width = width * m_em};
    }
    /// With a rim, so that white can be seen on paper.
    void addRimmed(FigureGroup& all, const PixelBox& box, const Rgb& color) const {
        all.elements.push_back(boxOf(box, color));
        addRim(all, box);
    }
    void addRim(FigureGroup& all, const PixelBox& box) const {
        FigureLine rim{.points = boxOf(box, {}).corners, .color = kRule, .width = kRim * m_em};
        rim.points.push_back(rim.points.front());
        all.elements.push_back(rim);
    }
    /// Room between the parts.
    void leaveGap(double ems) { m_y += ems * m_em; }

    // ---------------------------------------------------------------------------------------------------- parts

    /// A text as wide as the figure.
    void addParagraph(FigureText text, const std::string& name, const std::string& label, int lines) {
        text.width = m_width;
        text.lines = lines;
        const TextExtent extent = extentOf(text, m_set.font);
        text.at = {0, m_y + extent.baseline};
        group(name, label).elements.push_back(text);
        m_y += extent.height;
    }

    void addTitle() {
        if (m_in.title.empty()) return;
        FigureText text = textOf(m_in.title, {}, Align::Start, 1.2);
        text.bold = true;
        addParagraph(text, "heading", "Title", 2);
        leaveGap(0.5);
    }

    void addCaption() {
        leaveGap(0.7);
        addParagraph(textOf(m_in.caption), "caption", "Caption", kMostCaptionLines);
    }

    void addPicture() {
        const FigurePixels pixels = figurePixels(m_set);
        const Vec2 corner{0, m_y};
        const double height = pixels.height * pixels.mmPerPixel;
        group("picture", m_in.alt)
            .elements.push_back(FigurePicture{.at = corner, .width = m_width, .height = height, .image = m_in.image});
        AnnotationInput around = m_in.around;
        AnnotationChoice& show = around.show = AnnotationChoice::none();
        show.scale = m_parts.scale;
        show.letters = m_parts.letters;
        show.cube = m_parts.cube;
        show.axes = m_parts.axes;
        show.measures = m_parts.measures;
        const std::vector<Mark> marks = annotationMarks(around);
        m_figure.scale = scaleOf(marks, pixels.mmPerPixel);
        if (!marks.empty()) {
            FigureGroup& over = group("annotations", "Scale and directions");
            over.clip = PixelBox{0, m_y, m_width, m_y + height};
            over.elements = figureElements(marks, pixels.mmPerPixel, corner, m_set.font);
        }
        m_y += height;
    }

    // ------------------------------------------------------------------------------------- the table of features

    std::size_t shownRows() const { return std::min(m_in.rows.size(), kMostFigureRows); }

    double mostShare() const {
        double most = 0;
        for (std::size_t r = 0; r < shownRows(); ++r) {
            const FigureRow& row = m_in.rows[r];
            most = std::max({most, row.vws.value_or(0), row.visibility.value_or(0), row.target.value_or(0)});
        }
        return most > 0 ? std::min(1.0, most) : 1;
    }

    Columns columnsOf(bool bars) const {
        Columns columns;
        columns.name = 1.5 * m_em;
        double names = widthOf("Feature", kSmall);
        for (std::size_t r = 0; r < shownRows(); ++r) names = std::max(names, widthOf(m_in.rows[r].name));
        const bool shares = m_parts.legend && m_in.rows.front().vws.has_value();
        const double number = 4.2 * m_em, gap = 1.2 * m_em;
        const double numbers = (m_parts.legend ? number : 0) + (shares ? number : 0);
        const double leastBars = bars ? std::clamp(keyWidth(), 0.3 * m_width, 0.5 * m_width) : 0;
        const double room = m_width - columns.name - numbers - (bars ? gap + leastBars : 0);
        columns.nameWidth = std::max(2 * m_em, std::min(names, room));
        double x = bars ? columns.name + columns.nameWidth + 0.1 * m_em : m_width - numbers;
        if (m_parts.legend) columns.opacity = x += number;
        if (shares) columns.shares = x += number;
        columns.bars = bars ? x + gap : m_width;
        columns.most = mostShare();
        columns.barsEnd = m_width - (bars ? 1.6 * m_em : 0); // half the number at the axis stands beyond
        return columns;
    }

    double barX(const Columns& columns, double share) const {
        return columns.bars + (columns.barsEnd - columns.bars) * std::clamp(share / columns.most, 0.0, 1.0);
    }
    /// Of what addKey() says.
    double keyWidth() const {
        const double each = 2.7 * m_em; // sample, and room around it
        double width = 2 * each + widthOf("Saliency", kSmall) + widthOf("Visibility", kSmall);
        if (hasTargets()) width += each + widthOf("Target", kSmall);
        return width - 1.1 * m_em; // none behind the last
    }
    bool hasTargets() const {
        return std::ranges::any_of(m_in.rows, [](const FigureRow& row) { return row.target.has_value(); });
    }

    void addTable(bool bars) {
        leaveGap(0.9);
        const Columns columns = columnsOf(bars);
        addHeadings(columns, bars);
        const double row = 1.55 * m_em, top = m_y;
        for (std::size_t r = 0; r < shownRows(); ++r) addRow(m_in.rows[r], columns, row, bars);
        if (const std::size_t others = m_in.rows.size() - shownRows(); others > 0) {
            const std::string text = "and " + std::to_string(others) + (others == 1 ? " other" : " others");
            group("others", "").elements.push_back(textOf(text, {columns.name, m_y + row / 2 + m_capital / 2}));
            if (!bars) m_y += row;
        }
        if (bars) addShareAxis(columns, top);
    }

    void addHeadings(const Columns& columns, bool bars) {
        const double row = 1.4 * m_em, baseline = m_y + row - 0.45 * m_em;
        FigureGroup& head = group("headings", "");
        const auto say = [&](const std::string& words, double x, Align align) {
            FigureText text = textOf(words, {x, baseline}, align, kSmall);
            text.color = kFaintInk;
            head.elements.push_back(text);
        };
        say("Feature", columns.name, Align::Start);
        if (columns.opacity) say("Opacity", *columns.opacity, Align::End);
        if (columns.shares) say("Saliency", *columns.shares, Align::End);
        if (bars) addKey(head, columns, baseline);
        m_y += row;
    }

    /// What the marks among the bars are, as far as there is room.
    void addKey(FigureGroup& head, const Columns& columns, double baseline) const {
        double x = columns.bars;
        const double middle = baseline - 0.5 * kSmall * m_capital;
        const auto add = [&](const std::string& words, double sample, const FigureElement& mark) {
            const double wide = widthOf(words, kSmall);
            if (x + sample + 0.4 * m_em + wide > m_width + 1e-9) return;
            head.elements.push_back(mark);
            FigureText text = textOf(words, {x + sample + 0.4 * m_em, baseline}, Align::Start, kSmall);
            text.color = kFaintInk;
            head.elements.push_back(text);
            x += sample + wide + 1.2 * m_em;
        };
        const double bar = 1.1 * m_em;
        add("Saliency", bar, boxOf({x, middle - 0.28 * m_em, x + bar, middle + 0.28 * m_em}, kRule));
        add("Visibility", bar, boxOf({x, middle - 0.09 * m_em, x + bar, middle + 0.09 * m_em}, kThinBar));
        if (hasTargets())
            add("Target", 0.2 * m_em,
                lineOf({x + 0.1 * m_em, middle - 0.4 * m_em}, {x + 0.1 * m_em, middle + 0.4 * m_em}, kInk, 0.12));
    }

    /// Two tell them apart, unless some are small.
    int opacityDecimals() const {
        const auto isSmall = [](const FigureRow& row) { return row.opacity > 0 && row.opacity < 0.095; };
        return std::ranges::any_of(m_in.rows, isSmall) ? 3 : 2;
    }

    static std::string labelOf(const FigureRow& row) {
        std::string text = row.name + ": opacity " + shortText(row.opacity);
        if (row.vws) text += ", " + percentText(*row.vws) + " of the saliency";
        if (row.visibility) text += ", " + percentText(*row.visibility) + " of what is visible";
        if (row.target) text += ", target " + percentText(*row.target);
        return text;
    }

    void addRow(const FigureRow& row, const Columns& columns, double height, bool bars) {
        const double baseline = m_y + height / 2 + m_capital / 2, middle = m_y + height / 2;
        FigureGroup& all = group("feature-" + std::to_string(++m_row), labelOf(row));
        const double left = (kEdge + kRim / 2) * m_em;
        addRimmed(all, {left, middle - 0.45 * m_em, left + 0.9 * m_em, middle + 0.45 * m_em}, row.color);
        FigureText name = textOf(row.name, {columns.name, baseline});
        name.width = columns.nameWidth + 0.05 * m_em; // rounding cuts no letter
        all.elements.push_back(name);
        if (columns.opacity)
            all.elements.push_back(
                textOf(fixedText(row.opacity, opacityDecimals()), {*columns.opacity, baseline}, Align::End));
        if (columns.shares)
            all.elements.push_back(textOf(percentText(*row.vws), {*columns.shares, baseline}, Align::End));
        if (bars) addBars(all, row, columns, middle);
        m_y += height;
    }

    void addBars(FigureGroup& all, const FigureRow& row, const Columns& columns, double middle) const {
        const double thick = 0.62 * m_em, thin = 0.2 * m_em, top = middle - 0.5 * (thick + thin + 0.08 * m_em);
        addRimmed(all, {columns.bars, top, barX(columns, *row.vws), top + thick}, row.color);
        if (row.visibility) {
            const double below = top + thick + 0.08 * m_em;
            all.elements.push_back(
                boxOf({columns.bars, below, barX(columns, *row.visibility), below + thin}, kThinBar));
        }
        if (row.target) {
            const double x = barX(columns, *row.target);
            all.elements.push_back(lineOf({x, top - 0.12 * m_em}, {x, top + thick + 0.12 * m_em}, kInk, 0.12));
        }
    }

    void addShareAxis(const Columns& columns, double top) {
        FigureGroup& axis = group("shares-axis", "Axis of shares, percent");
        const double tick = 0.3 * m_em, length = columns.barsEnd - columns.bars;
        axis.elements.push_back(lineOf({columns.bars, top}, {columns.bars, m_y}));
        axis.elements.push_back(lineOf({columns.bars, m_y}, {columns.barsEnd, m_y}));
        const int wanted = std::clamp(static_cast<int>(length / (4.5 * m_em)), 1, 8);
        const double baseline = m_y + tick + 0.35 * m_em + kSmall * m_capital;
        for (const double share : axisTicks(0, columns.most, wanted)) {
            const double x = barX(columns, share);
            axis.elements.push_back(lineOf({x, m_y}, {x, m_y + tick}));
            axis.elements.push_back(
                textOf(numberText(100 * share, 100 * columns.most) + " %", {x, baseline}, Align::Middle, kSmall));
        }
        m_y = baseline + 0.25 * m_em;
    }

    // ------------------------------------------------------------------------------------------ the colour scale

    void addColors() {
        leaveGap(0.8);
        FigureGroup& scale = group("colors", "Colours and opacities over the values");
        const TransferFunction& tf = m_in.picture.tf;
        const RenderMode mode = m_in.picture.settings.mode;
        const bool grey = !isColored(mode);
        std::vector<ControlPoint> points = tf.pointsWithEnds();
        double most = 0;
        for (const ControlPoint& p : points) most = std::max(most, p.opacity);

        std::string heading = grey ? "Grey over values" : "Colour and opacity over values";
        if (!m_in.unit.empty()) heading += " (" + m_in.unit + ")";
        if (!grey && most > 0) heading += "; highest opacity " + shortText(most);
        FigureText text = textOf(heading, {0, m_y + 0.95 * m_em}, Align::Start, kSmall);
        text.color = kFaintInk;
        text.width = m_width;
        scale.elements.push_back(text);
        m_y += 1.5 * m_em;

        const double inset = 1.6 * m_em; // half a number stands beyond the ends
        const PixelBox strip{inset, m_y + (grey ? 0 : 2.6 * m_em), m_width - inset, m_y + (grey ? 1.1 : 3.7) * m_em};
        const auto xOf = [&](double s) { return strip.left + s * (strip.right - strip.left); };
        if (grey) {
            FigureArea ramp = boxOf(strip, {});
            ramp.stops = {{0, {0, 0, 0}}, {1, {1, 1, 1}}};
            scale.elements.push_back(ramp);
        } else {
            addOpacities(scale, points, most, {strip.left, m_y, strip.right, strip.top}, xOf);
            addSeenColors(scale, points, strip, xOf);
        }
        addRim(scale, strip);
        addValueAxis(scale, strip, xOf);
    }

    /// Highest where the strip begins to be far: the largest opacity reaches the top.
    template <class XOf>
    void addOpacities(FigureGroup& scale, const std::vector<ControlPoint>& points, double most, const PixelBox& box,
                      const XOf& xOf) const {
        if (!(most > 0)) return;
        FigureLine curve{.color = kInk, .width = 0.08 * m_em};
        for (const ControlPoint& p : points)
            curve.points.push_back({xOf(p.x), box.bottom - (box.bottom - box.top - 0.2 * m_em) * p.opacity / most});
        FigureArea below{.corners = curve.points, .color = kGround};
        below.corners.push_back({box.right, box.bottom});
        below.corners.push_back({box.left, box.bottom});
        scale.elements.push_back(below);
        scale.elements.push_back(curve);
    }

    /// The strip has the colours of all that is drawn; where nothing is, it is empty.
    template <class XOf>
    void addSeenColors(FigureGroup& scale, const std::vector<ControlPoint>& points, const PixelBox& strip,
                       const XOf& xOf) const {
        const auto isSeen = [&](std::size_t i) { return points[i].opacity > 0 || points[i + 1].opacity > 0; };
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            if (!isSeen(i)) continue;
            const std::size_t first = i;
            while (i + 2 < points.size() && isSeen(i + 1)) ++i;
            const double from = points[first].x, span = points[i + 1].x - from;
            if (!(span > 0)) continue;
            FigureArea piece = boxOf({xOf(from), strip.top, xOf(from + span), strip.bottom}, {});
            for (std::size_t n = first; n <= i + 1; ++n)
                piece.stops.push_back({(points[n].x - from) / span, points[n].color});
            scale.elements.push_back(piece);
        }
    }

    template <class XOf>
    void addValueAxis(FigureGroup& scale, const PixelBox& strip, const XOf& xOf) {
        const ValueRange& window = m_in.around.window;
        const double span = window.hi - window.lo, tick = 0.3 * m_em;
        const double baseline = strip.bottom + tick + 0.35 * m_em + kSmall * m_capital;
        const int wanted = std::clamp(static_cast<int>((strip.right - strip.left) / (5 * m_em)), 2, 10);
        if (span > 0 && std::isfinite(span))
            for (const double value : axisTicks(window.lo, window.hi, wanted)) {
                const double x = xOf((value - window.lo) / span);
                scale.elements.push_back(lineOf({x, strip.bottom}, {x, strip.bottom + tick}));
                scale.elements.push_back(textOf(numberText(value, span), {x, baseline}, Align::Middle, kSmall));
            }
        m_y = baseline + 0.25 * m_em;
    }

    const FigureContent& m_in;
    const FigureSettings& m_set;
    FigureParts m_parts;
    double m_width;   ///< mm
    double m_em;      ///< size of the font, mm
    double m_capital; ///< height of its capitals, mm
    double m_y = 0;   ///< where the next part begins, mm
    int m_row = 0;
    Figure m_figure;
};

} // namespace

double annotationDensity(const FigureSettings& settings) {
    constexpr double kCapitalOfScreen = 7; // pixels at density 1, see MarkMaker
    return settings.fontPt * kCapitalOfFont * kMmPerPoint / figurePixels(settings).mmPerPixel / kCapitalOfScreen;
}

Figure layOut(const FigureContent& content) { return Layout(content).figure(); }

} // namespace pellucid
