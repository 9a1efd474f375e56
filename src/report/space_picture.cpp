#include "report/space_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "base/round_numbers.h"
#include "base/text.h"
#include "render/annotation_raster.h"
#include "render/image_renderer.h"
#include "render/mark_maker.h"
#include "render/named_box.h"
#include "render/projected.h"
#include "tf/color_maps.h"

namespace pellucid {

namespace {

constexpr double kLowShare = 0.12, kHighShare = 0.2; // of the samples of F that are drawn at either end
constexpr double kLowAlpha = 0.7, kHighAlpha = 0.25; // at the ends, per tenth of an axis
constexpr double kVwsAlpha = 0.40;                   // where W is 1, likewise
constexpr double kRoomAround = 0.86;                 // zoom that leaves room for ticks and names
constexpr int kAlongRay = 200;                       // places looked at on the way through the cube

/// Of an opacity per tenth of an axis that of the distance between samples.
double perSample(double alpha, const ParameterSpace& space) {
    return 1 - std::pow(1 - alpha, 10.0 / (space.axes.samples - 1));
}

double quantile(std::vector<double> values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

ValueRange shownRange(const ParameterSpace& space, int shown) {
    return shown == kObjective ? space.range(shown) : ValueRange{0, 1};
}

std::string titleOf(const ParameterSpace& space, const SpaceView& view) {
    if (view.shown != kObjective) return "W of " + view.names.at(static_cast<std::size_t>(view.shown));
    return "F, targets " + joined(space.targets, ", ", [](double target) { return numberText(target, 1); });
}

MarkMaker makerOf(const SpaceView& view) {
    return {view.width * 1.0, view.height * 1.0, view.density, view.background};
}

/// A row of the legend above the picture.
struct Row {
    enum class Sign { None, Path, Minimum, Present, Contour } sign = Sign::None;
    Rgb color;
    std::string text;
};

bool hasContour(const ParameterSpace& space, const SpaceView& view) {
    if (!space.isFlat() || view.shown != kObjective) return false;
    const ValueRange range = space.range(kObjective);
    return range.lo < view.tolerance && view.tolerance < range.hi;
}

std::vector<Row> rowsOf(const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    std::vector<Row> rows{
        {Row::Sign::None, make.ink, titleOf(space, view)},
        {Row::Sign::Minimum, make.ink, "least of the grid: F " + numberText(space.objective[space.best], 0.01)}};
    if (view.present) rows.push_back({Row::Sign::Present, make.ink, "the opacities now"});
    if (hasContour(space, view))
        rows.push_back({Row::Sign::Contour, make.ink, "F = " + numberText(view.tolerance, view.tolerance)});
    const auto most = static_cast<std::size_t>(std::max(3.0, 0.35 * view.height / (1.9 * make.capHeight)));
    for (const SpacePath& path : view.paths) {
        if (path.states.empty()) continue;
        if (rows.size() == most) { // the others are drawn, and not named
            rows.back() = {Row::Sign::None, make.ink, "…"};
            break;
        }
        const std::size_t moves = path.states.size() - 1;
        rows.push_back({Row::Sign::Path, path.color,
                        path.name + ": " + std::to_string(moves) + (moves == 1 ? " move" : " moves") + ", F " +
                            numberText(path.states.at(path.best).objective, 0.01)});
    }
    return rows;
}

double rowHeight(const MarkMaker& make) { return 1.9 * make.capHeight; }

Mark coloredLine(const MarkMaker& make, std::vector<Vec2> points, double width, const Rgb& color) {
    Mark mark = make.lineMark(AnnotationPart::Legend, std::move(points), width);
    mark.color = color;
    return mark;
}

/// A dot, as a line too short to be seen: painters give it round ends.
Mark dot(const MarkMaker& make, const Vec2& at, double diameter, const Rgb& color) {
    return coloredLine(make, {at, at + Vec2(0.01, 0)}, diameter, color);
}

Mark ring(const MarkMaker& make, const Vec2& at, double diameter, double width, const Rgb& color) {
    constexpr int kSides = 24;
    std::vector<Vec2> points;
    for (int i = 0; i <= kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        points.push_back(at + Vec2(std::cos(angle), std::sin(angle)) * (diameter / 2));
    }
    return coloredLine(make, std::move(points), width, color);
}

/// The points of a rectangle, closed.
std::vector<Vec2> outline(const Vec2& lo, const Vec2& hi) { return {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}, lo}; }

Mark square(const MarkMaker& make, const Vec2& at) {
    const Vec2 r(0.6 * make.capHeight);
    return make.lineMark(AnnotationPart::Legend, outline(at - r, at + r), 0.22 * make.capHeight);
}

void addCross(std::vector<Mark>& marks, const MarkMaker& make, const Vec2& at) {
    const double reach = 0.6 * make.capHeight;
    for (const Vec2& way : {Vec2(reach, reach), Vec2(reach, -reach)})
        marks.push_back(make.lineMark(AnnotationPart::Legend, {at - way, at + way}, 0.26 * make.capHeight));
}

void addRows(std::vector<Mark>& marks, const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    const double cap = make.capHeight, sign = 2.2 * cap;
    double y = make.margin + 0.5 * cap;
    for (const Row& row : rowsOf(space, view)) {
        const double x = make.margin + (row.sign == Row::Sign::None ? 0 : sign + 0.7 * cap);
        const Vec2 from{make.margin, y}, to{make.margin + sign, y};
        switch (row.sign) {
        case Row::Sign::Path:
            marks.push_back(coloredLine(make, {from, to}, 0.3 * cap, row.color));
            break;
        case Row::Sign::Minimum:
            addCross(marks, make, (from + to) * 0.5);
            break;
        case Row::Sign::Present:
            marks.push_back(square(make, (from + to) * 0.5));
            break;
        case Row::Sign::Contour:
            marks.push_back(make.lineMark(AnnotationPart::Legend, {from, to}, 0.2 * cap));
            break;
        case Row::Sign::None:
            break;
        }
        const std::string text = shortenedText(row.text, (view.width - make.margin - x) / cap);
        marks.push_back(make.textMark(AnnotationPart::Legend, text, {x, y}, Align::Start, Align::Middle, cap));
        y += rowHeight(make);
    }
}

/// The ways through the picture, the farther ones thinner and first, with a ring at the start and a dot at the best.
void addPaths(std::vector<Mark>& marks, const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    const Projected project(view.camera, view.width, view.height);
    const double nearest = space.isFlat() ? 0 : project.depth(view.camera.center) - 0.9;
    /// 1 near the eye, 0.6 at the far corner.
    const auto nearness = [&](const Vec3& p) {
        return space.isFlat() ? 1.0 : std::clamp(1 - 0.4 * (project.depth(p) - nearest) / 1.8, 0.6, 1.0);
    };
    struct Piece {
        double near;
        Mark mark;
    };
    std::vector<Piece> lines, signs;
    for (const SpacePath& path : view.paths) {
        std::optional<Vec2> before;
        for (std::size_t i = 0; i < path.states.size(); ++i) {
            const Vec3 position = space.positionOf(path.states[i].opacity);
            const std::optional<Vec2> at = pixelOf(space, view, position);
            if (!at) {
                before.reset();
                continue;
            }
            const double near = nearness(position), unit = near * make.capHeight;
            if (before && glm::length(*at - *before) > 1e-6)
                lines.push_back({near, coloredLine(make, {*before, *at}, 0.3 * unit, path.color)});
            if (i == 0) signs.push_back({near, ring(make, *at, 1.3 * unit, 0.26 * unit, path.color)});
            if (i == path.best)
                signs.push_back({near + 1, dot(make, *at, 1.2 * unit, path.color)}); // over the others
            else if (i > 0)
                signs.push_back({near, dot(make, *at, 0.6 * unit, path.color)});
            before = at;
        }
    }
    const auto byNearness = [](const Piece& a, const Piece& b) { return a.near < b.near; };
    std::stable_sort(lines.begin(), lines.end(), byNearness);
    std::stable_sort(signs.begin(), signs.end(), byNearness);
    for (Piece& piece : lines) { // all rims below all lines: joints are not cut
        Mark rim = piece.mark;
        rim.width += 2 * rim.halo;
        rim.color = rim.haloColor;
        rim.alpha = kHaloAlpha;
        rim.halo = piece.mark.halo = 0;
        marks.push_back(rim);
    }
    for (const Piece& piece : lines) marks.push_back(piece.mark);
    for (const Piece& piece : signs) marks.push_back(piece.mark);
}

/// The lines along which F is `level`, in positions: in each cell between the edges that it crosses.
std::vector<std::array<Vec3, 2>> contour(const ParameterSpace& space, double level) {
    const int n = space.axes.samples;
    const auto value = [&](int i, int j) { return space.objective[static_cast<std::size_t>(j * n + i)] - level; };
    const auto position = [&](int i, int j) {
        return Vec3(space.axes.positionOfSample(i), space.axes.positionOfSample(j), 0);
    };
    std::vector<std::array<Vec3, 2>> lines;
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            const std::array<std::array<int, 2>, 5> corners{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}, {i, j}}};
            std::vector<Vec3> crossings; // in turn around the cell
            double sum = 0;
            for (std::size_t c = 0; c < 4; ++c) {
                const auto [i0, j0] = corners[c];
                const auto [i1, j1] = corners[c + 1];
                const double a = value(i0, j0), b = value(i1, j1);
                sum += a;
                if ((a < 0) != (b < 0))
                    crossings.push_back(position(i0, j0) + (position(i1, j1) - position(i0, j0)) * (a / (a - b)));
            }
            if (crossings.size() == 2) lines.push_back({crossings[0], crossings[1]});
            if (crossings.size() == 4) { // a saddle: the corners on the middle's side are joined
                const bool joinsFirst = (value(i, j) < 0) == (sum < 0);
                const std::size_t shift = joinsFirst ? 0 : 1;
                lines.push_back({crossings[shift], crossings[1 + shift]});
                lines.push_back({crossings[2 + shift], crossings[(3 + shift) % 4]});
            }
        }
    return lines;
}

// ---- the heat map

struct MapLayout {
    PixelBox map, bar; ///< whole pixels
};

double widestTick(const std::vector<ParameterAxes::Tick>& ticks) {
    double widest = 0;
    for (const auto& tick : ticks) widest = std::max(widest, textWidth(tick.text));
    return widest;
}

MapLayout layoutOf(const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    const double cap = make.capHeight;
    const ValueRange range = shownRange(space, view.shown);
    double labels = 0;
    for (const double tick : axisTicks(range.lo, range.hi, 5))
        labels = std::max(labels, textWidth(numberText(tick, range.hi - range.lo)));
    const double left = make.margin + cap * (1 + 0.7 + widestTick(space.axes.ticks(5)) + 1.0);
    const double right = view.width - make.margin - cap * (labels + 0.9 + 1.3 + 1.5);
    const double bottom = view.height - make.margin - cap * (1 + 0.8 + 1 + 1.0);
    const double top = make.margin + rowHeight(make) * (0.5 + static_cast<double>(rowsOf(space, view).size()));
    const double side = std::max(8.0, std::floor(std::min(right - left, bottom - top)));
    const double x = std::floor(left + std::max(0.0, right - left - side) / 2);
    const double y = std::floor(top + std::max(0.0, bottom - top - side) / 2);
    const double bar = std::round(x + side + 1.5 * cap);
    return {{x, y, x + side, y + side}, {bar, y, bar + std::round(1.3 * cap), y + side}};
}

void addMapAxes(std::vector<Mark>& marks, const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    const double cap = make.capHeight, tick = 0.5 * cap, line = std::max(view.density, 0.1 * cap);
    const auto [map, bar] = layoutOf(space, view);
    const double side = map.right - map.left;
    const auto frame = [&](const PixelBox& b) {
        Mark mark = make.lineMark(AnnotationPart::Axes, outline({b.left, b.top}, {b.right, b.bottom}), line);
        mark.halo = 0;
        marks.push_back(mark);
    };
    const auto text = [&](const std::string& words, const Vec2& at, Align horizontal, Align vertical) {
        marks.push_back(make.textMark(AnnotationPart::Axes, words, at, horizontal, vertical, cap));
    };
    frame(map);
    frame(bar);
    const auto ticks = space.axes.ticks(5);
    for (const auto& [position, words] : ticks) {
        const double x = map.left + position * side, y = map.bottom - position * side;
        marks.push_back(make.lineMark(AnnotationPart::Axes, {{x, map.bottom}, {x, map.bottom + tick}}, line));
        marks.push_back(make.lineMark(AnnotationPart::Axes, {{map.left - tick, y}, {map.left, y}}, line));
        text(words, {x, map.bottom + 2 * tick}, Align::Middle, Align::Start);
        text(words, {map.left - 2 * tick, y}, Align::End, Align::Middle);
    }
    const auto caption = [&](std::size_t axis) {
        return shortenedText("opacity of " + view.names.at(space.axes.features[axis]), side / cap);
    };
    text(caption(0), {(map.left + map.right) / 2, map.bottom + 2 * tick + 1.8 * cap}, Align::Middle, Align::Start);
    Mark upright = make.textMark(AnnotationPart::Axes, caption(1), {0, 0}, Align::Start, Align::Start, cap);
    upright.across = {0, -cap};
    upright.up = {-cap, 0};
    upright.points = {{map.left - 2 * tick - cap * (widestTick(ticks) + 0.7),
                       (map.top + map.bottom) / 2 + 0.5 * cap * textWidth(caption(1))}};
    marks.push_back(upright);

    const ValueRange range = shownRange(space, view.shown);
    for (const double value : axisTicks(range.lo, range.hi, 5)) {
        const double y = map.bottom - (value - range.lo) / (range.hi - range.lo) * side;
        marks.push_back(make.lineMark(AnnotationPart::Axes, {{bar.right, y}, {bar.right + tick, y}}, line));
        text(numberText(value, range.hi - range.lo), {bar.right + 2 * tick, y}, Align::Start, Align::Middle);
    }
}

void addContour(std::vector<Mark>& marks, const ParameterSpace& space, const SpaceView& view) {
    const MarkMaker make = makerOf(view);
    const auto lines = contour(space, view.tolerance);
    for (const bool rim : {true, false})
        for (const auto& [a, b] : lines) {
            Mark mark = make.lineMark(AnnotationPart::Axes, {*pixelOf(space, view, a), *pixelOf(space, view, b)},
                                      (rim ? 0.5 : 0.2) * make.capHeight);
            if (rim) mark.color = mark.haloColor;
            mark.halo = 0;
            marks.push_back(mark);
        }
}

// ---- the cube

NamedBox namedBox(const ParameterSpace& space, const SpaceView& view) {
    NamedBox box;
    const auto ticks = space.axes.ticks(5);
    for (std::size_t a = 0; a < 3; ++a) {
        box.captions[a] = shortenedText(view.names.at(space.axes.features[a]), 18);
        for (const auto& [position, words] : ticks) box.ticks[a].push_back({position, words});
    }
    return box;
}

/// `number`: of a run that has none.
std::string nameOf(const Run& run, int number) {
    if (!run.name.empty()) return run.name;
    return "run " + std::to_string(run.number > 0 ? run.number : number) +
           (run.hasStart() ? std::string(", ") + name(run.start->options.method) : std::string());
}

} // namespace

Rgb pathColor(std::size_t n) {
    static constexpr std::array<Rgb, 6> kColors{Rgb{0.36, 0.90, 0.46}, Rgb{1.00, 0.40, 0.85}, Rgb{1.00, 0.93, 0.35},
                                                Rgb{0.40, 0.95, 0.95}, Rgb{0.76, 0.62, 1.00}, Rgb{0.95, 0.95, 0.95}};
    return kColors[n % kColors.size()];
}

Camera spaceCamera(const ParameterSpace& space, double azimuth, double elevation, double zoom) {
    Geometry g = space.geometry();
    g.spacing = Vec3(1.0) / Vec3(g.dims); // the box of the volume is the cube itself
    g.origin = g.spacing * 0.5;
    return cameraFromView(g, azimuth, elevation, zoom * kRoomAround, Projection::Perspective);
}

std::shared_ptr<const Volume> spaceVolume(const ParameterSpace& space, int shown) {
    const std::vector<double>& values = space.values(shown);
    std::vector<float> samples(values.begin(), values.end());
    Volume volume(space.geometry(), SampleArray<float>(std::move(samples)));
    const ValueRange range = shownRange(space, shown);
    if (shown != kObjective) return std::make_shared<const Volume>(volume.withRange(range));
    return std::make_shared<const Volume>(std::move(volume));
}

TransferFunction spaceTf(const ParameterSpace& space, const SpaceView& view) {
    TransferFunction tf;
    const auto add = [&](double x, double alpha, const Rgb& color) {
        tf.points.push_back({x, perSample(alpha, space), color, false, {}});
    };
    if (view.shown != kObjective) {
        const Rgb featureColor = view.colors.at(static_cast<std::size_t>(view.shown));
        add(0, 0, mixed({0, 0, 0}, featureColor, 0.15));
        add(1, kVwsAlpha, featureColor);
        return tf;
    }
    const ValueRange range = space.range(kObjective);
    const double span = range.hi - range.lo;
    const auto intensity = [&](double share) {
        return span > 0 ? (quantile(space.objective, share) - range.lo) / span : 0.0;
    };
    const double low = std::clamp(intensity(kLowShare), 0.02, 0.45),
                 high = std::clamp(intensity(1 - kHighShare), 0.55, 0.98);
    const ColorMap& map = colorMapNamed("blue-orange");
    add(0, kLowAlpha, map.colorAt(0));
    add(low / 2, kLowAlpha / 4, map.colorAt(low / 2));
    add(low, 0, map.colorAt(low));
    add(high, 0, map.colorAt(high));
    add((high + 1) / 2, kHighAlpha / 4, map.colorAt((high + 1) / 2));
    add(1, kHighAlpha, map.colorAt(1));
    return tf;
}

RenderSettings spaceRenderSettings(const ParameterSpace& space, const SpaceView& view) {
    RenderSettings settings;
    settings.width = view.width;
    settings.height = view.height;
    settings.background = view.background;
    settings.stepInD0 = 0.25;
    const double half = 0.5 / space.axes.samples; // of a voxel: the corners of the cube are centres
    settings.clipping.lo = Vec3(half);
    settings.clipping.hi = Vec3(1 - half);
    return settings;
}

PixelBox heatMapBox(const ParameterSpace& space, const SpaceView& view) { return layoutOf(space, view).map; }

Rgb heatMapColor(double value, const ValueRange& range) {
    static const ColorMap& kMap = colorMapNamed("spiral");
    return kMap.colorAt(range.lo < range.hi ? std::clamp((value - range.lo) / (range.hi - range.lo), 0.0, 1.0) : 0.0);
}

Image heatMap(const ParameterSpace& space, const SpaceView& view) {
    constexpr int kShades = 1024;
    std::vector<Rgb> shades;
    for (int i = 0; i <= kShades; ++i) shades.push_back(heatMapColor(i, {0, kShades}));
    const ValueRange range = shownRange(space, view.shown);
    const double scale = range.lo < range.hi ? kShades / (range.hi - range.lo) : 0;
    const auto shade = [&](double value) {
        return shades[static_cast<std::size_t>(std::clamp(std::lround((value - range.lo) * scale), 0l, 1l * kShades))];
    };
    const auto [map, bar] = layoutOf(space, view);
    Image image(view.width, view.height);
    const auto inside = [](const PixelBox& b, const Vec2& p) {
        return p.x > b.left && p.x < b.right && p.y > b.top && p.y < b.bottom;
    };
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const Vec2 p{x + 0.5, y + 0.5};
            const Vec3 position{(p.x - map.left) / (map.right - map.left), (map.bottom - p.y) / (map.bottom - map.top),
                                0};
            const Rgb color = inside(map, p)   ? shade(space.valueAt(view.shown, position))
                              : inside(bar, p) ? shade(range.lo + position.y * (range.hi - range.lo))
                                               : view.background;
            float* const pixel = image.pixel(x, y);
            pixel[0] = static_cast<float>(color.r);
            pixel[1] = static_cast<float>(color.g);
            pixel[2] = static_cast<float>(color.b);
            pixel[3] = 1;
        }
    return image;
}

Image spaceImage(const ParameterSpace& space, const SpaceView& view, const JobControl& job) {
    Image image = space.isFlat()
                      ? heatMap(space, view)
                      : makeCpuRenderer(spaceVolume(space, view.shown))
                            ->render(view.camera, spaceTf(space, view), spaceRenderSettings(space, view), job);
    drawMarks(image, spaceMarks(space, view));
    return image;
}

std::optional<Vec2> pixelOf(const ParameterSpace& space, const SpaceView& view, const Vec3& position) {
    if (space.isFlat()) {
        const PixelBox map = heatMapBox(space, view);
        return Vec2(map.left + position.x * (map.right - map.left), map.bottom - position.y * (map.bottom - map.top));
    }
    const Projected project(view.camera, view.width, view.height);
    if (project.isPerspective() && !(project.depth(position) > 0)) return {};
    return project(position);
}

std::optional<Vec3> positionAt(const ParameterSpace& space, const SpaceView& view, const Vec2& pixel) {
    if (space.isFlat()) {
        const PixelBox map = heatMapBox(space, view);
        const Vec3 position{(pixel.x - map.left) / (map.right - map.left),
                            (map.bottom - pixel.y) / (map.bottom - map.top), 0};
        if (position.x < 0 || position.x > 1 || position.y < 0 || position.y > 1) return {};
        return position;
    }
    const Ray ray = pixelRay(view.camera, pixel.x, pixel.y, view.width, view.height);
    double from = 0, to = 1e300;
    for (int a = 0; a < 3; ++a) {
        if (ray.direction[a] == 0) {
            if (ray.origin[a] < 0 || ray.origin[a] > 1) return {};
            continue;
        }
        const double t0 = -ray.origin[a] / ray.direction[a], t1 = (1 - ray.origin[a]) / ray.direction[a];
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    if (!(from < to)) return {};
    const double sign = view.shown == kObjective ? 1 : -1;
    Vec3 chosen{0, 0, 0};
    double least = 1e300;
    for (int i = 0; i <= kAlongRay; ++i) {
        const Vec3 p = glm::clamp(ray.origin + ray.direction * (from + (to - from) * i / kAlongRay), Vec3(0), Vec3(1));
        const double value = sign * space.valueAt(view.shown, p);
        if (value < least) {
            least = value;
            chosen = p;
        }
    }
    return chosen;
}

std::vector<Mark> spaceMarks(const ParameterSpace& space, const SpaceView& view) {
    std::vector<Mark> marks;
    if (space.isFlat()) {
        addMapAxes(marks, space, view);
        if (hasContour(space, view)) addContour(marks, space, view);
    } else {
        AnnotationChoice show = AnnotationChoice::none();
        show.axes = show.legend = true;
        marks = annotationMarks({show, view.camera, space.geometry(), spaceTf(space, view),
                                 shownRange(space, view.shown), "", spaceRenderSettings(space, view), view.density},
                                namedBox(space, view));
    }
    addPaths(marks, space, view);
    if (const auto least = pixelOf(space, view, space.positionOfSample(space.best)))
        addCross(marks, makerOf(view), *least);
    if (view.present)
        if (const auto now = pixelOf(space, view, space.positionOf(*view.present)))
            marks.push_back(square(makerOf(view), *now));
    addRows(marks, space, view);
    return marks;
}

std::optional<PathState> pathStateAt(const ParameterSpace& space, const SpaceView& view, const Vec2& pixel,
                                     double reach) {
    std::optional<PathState> nearest;
    for (std::size_t p = 0; p < view.paths.size(); ++p)
        for (std::size_t s = 0; s < view.paths[p].states.size(); ++s) {
            const auto at = pixelOf(space, view, space.positionOf(view.paths[p].states[s].opacity));
            if (!at || !(glm::length(*at - pixel) <= reach)) continue;
            reach = glm::length(*at - pixel);
            nearest = {p, s};
        }
    return nearest;
}

std::vector<SpacePath> pathsOfRuns(const std::vector<Run>& runs, const TransferFunction& tf,
                                   const ParameterAxes& axes) {
    std::vector<SpacePath> paths;
    int number = 0;
    for (const Run& run : runs) {
        if (run.kind != "optimize" || run.history.empty()) continue;
        ++number;
        const auto placeOf = [&](std::size_t feature) {
            return static_cast<std::size_t>(
                std::find(run.features.begin(), run.features.end(), tf.features[feature].name) - run.features.begin());
        };
        if (std::any_of(axes.features.begin(), axes.features.end(),
                        [&](std::size_t f) { return placeOf(f) == run.features.size(); }))
            continue;
        SpacePath path{nameOf(run, number), pathColor(paths.size()), {}, run.best};
        for (const OptimizeState& state : run.history) {
            OptimizeState one = state;
            one.opacity.assign(tf.features.size(), 0.0);
            one.vws = one.opacity;
            for (std::size_t f = 0; f < tf.features.size(); ++f) {
                const std::size_t place = placeOf(f);
                if (place >= state.opacity.size()) continue;
                one.opacity[f] = state.opacity[place];
                if (place < state.vws.size()) one.vws[f] = state.vws[place];
            }
            path.states.push_back(std::move(one));
        }
        paths.push_back(std::move(path));
    }
    return paths;
}

} // namespace pellucid
