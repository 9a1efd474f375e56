#include "tf/color_spaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "volume/grid.h"

namespace pellucid {

namespace {

using std::numbers::pi;

double mix(double a, double b, double t) { return (1 - t) * a + t * b; }
double square(double v) { return v * v; }

/// Of the white point D65 that sRGB has.
const Vec3 kWhite{0.4124564 + 0.3575761 + 0.1804375, 0.2126729 + 0.7151522 + 0.0721750,
                  0.0193339 + 0.1191920 + 0.9503041};

Vec3 xyzFromSrgb(const Rgb& c) {
    const double r = linearFromSrgb(c.r), g = linearFromSrgb(c.g), b = linearFromSrgb(c.b);
    return {0.4124564 * r + 0.3575761 * g + 0.1804375 * b, 0.2126729 * r + 0.7151522 * g + 0.0721750 * b,
            0.0193339 * r + 0.1191920 * g + 0.9503041 * b};
}

Rgb srgbFromXyz(const Vec3& xyz) {
    const auto [x, y, z] = std::array{xyz.x, xyz.y, xyz.z};
    const auto encoded = [](double v) { return v <= 0 ? 12.92 * v : srgbFromLinear(v); };
    Rgb c{encoded(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
          encoded(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
          encoded(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
    const double most = std::max({c.r, c.g, c.b, 1.0});
    const auto fitted = [most](double v) { return std::clamp(v / most, 0.0, 1.0); };
    return {fitted(c.r), fitted(c.g), fitted(c.b)};
}

double labCurveInverse(double f) {
    constexpr double kDelta = 6.0 / 29.0;
    return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29.0);
}

// ---- proLab: a projective map of XYZ (Konovalenko, Smagina, Nikolaev, Nikolaev 2021)

constexpr std::array<std::array<double, 3>, 3> kProLab{
    {{75.54, 486.66, 167.39}, {617.72, -595.45, -22.27}, {48.34, 194.94, -243.28}}};
constexpr std::array<double, 3> kProLabBelow{0.7554, 3.8666, 1.6739};

using Row = std::array<double, 4>;

/// The solution of three equations, each a·x + b·y + c·z = d.
Vec3 solved(std::array<Row, 3> rows) {
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t pivot = i;
        for (std::size_t j = i + 1; j < 3; ++j)
            if (std::abs(rows[j][i]) > std::abs(rows[pivot][i])) pivot = j;
        std::swap(rows[i], rows[pivot]);
        for (std::size_t j = 0; j < 3; ++j) {
            if (j == i) continue;
            const double factor = rows[j][i] / rows[i][i];
            for (std::size_t k = i; k < 4; ++k) rows[j][k] -= factor * rows[i][k];
        }
    }
    return {rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]};
}

Vec3 proLabFromSrgb(const Rgb& c) {
    const Vec3 p = xyzFromSrgb(c) / kWhite;
    const double below = kProLabBelow[0] * p.x + kProLabBelow[1] * p.y + kProLabBelow[2] * p.z + 1;
    const auto part = [&](std::size_t i) { return (kProLab[i][0] * p.x + kProLab[i][1] * p.y + kProLab[i][2] * p.z); };
    return {part(0) / below, part(1) / below, part(2) / below};
}

Rgb srgbFromProLab(const Vec3& c) {
    // v·(q·p + 1) = Q·p, solved for p
    const std::array<double, 3> v{c.x, c.y, c.z};
    std::array<Row, 3> rows;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) rows[i][k] = kProLab[i][k] - v[i] * kProLabBelow[k];
        rows[i][3] = v[i];
    }
    return srgbFromXyz(solved(rows) * kWhite);
}

// ---- Msh: polar CIELAB (Moreland 2009)

struct Msh {
    double m = 0, s = 0, h = 0; ///< magnitude; angles in radians
};

Msh mshFromLab(const Lab& c) {
    Msh p;
    p.m = std::sqrt(square(c.lightness) + square(c.a) + square(c.b));
    if (p.m > 0.001) p.s = std::acos(std::clamp(c.lightness / p.m, -1.0, 1.0));
    if (p.s > 0.001) p.h = std::atan2(c.b, c.a);
    return p;
}

Lab labFromMsh(const Msh& p) {
    return {p.m * std::cos(p.s), p.m * std::sin(p.s) * std::cos(p.h), p.m * std::sin(p.s) * std::sin(p.h)};
}

/// The hue that a grey of magnitude `m` has on the way to `saturated`, so that colours change evenly.
double hueOfGrey(const Msh& saturated, double m) {
    if (saturated.m >= m - 0.1) return saturated.h;
    const double spin =
        saturated.s * std::sqrt(square(m) - square(saturated.m)) / (saturated.m * std::sin(saturated.s));
    return saturated.h > -0.3 * pi ? saturated.h + spin : saturated.h - spin;
}

double angleBetween(double p, double q) {
    const double d = std::fmod(std::abs(p - q), 2 * pi);
    return d > pi ? 2 * pi - d : d;
}

Rgb divergingBetween(const Rgb& from, const Rgb& to, double t) {
    constexpr double kSaturated = 0.05, kFarApart = 0.33 * pi, kLeastWhite = 88;
    Msh p = mshFromLab(labFromSrgb(from)), q = mshFromLab(labFromSrgb(to));
    if (p.s > kSaturated && q.s > kSaturated && angleBetween(p.h, q.h) > kFarApart) {
        const Msh white{std::max({p.m, q.m, kLeastWhite}), 0, 0};
        (t < 0.5 ? q : p) = white;
        t = t < 0.5 ? 2 * t : 2 * t - 1;
    }
    if (p.s < kSaturated && q.s > kSaturated)
        p.h = hueOfGrey(q, p.m);
    else if (q.s < kSaturated && p.s > kSaturated)
        q.h = hueOfGrey(p, q.m);
    return srgbFromLab(labFromMsh({mix(p.m, q.m, t), mix(p.s, q.s, t), mix(p.h, q.h, t)}));
}

Rgb hsvBetween(const Rgb& from, const Rgb& to, double t, bool wrapped) {
    Hsv p = hsvFromRgb(from), q = hsvFromRgb(to);
    if (wrapped && std::abs(p.hueDegrees - q.hueDegrees) > 180) (p.hueDegrees > q.hueDegrees ? p : q).hueDegrees -= 360;
    return rgbFromHsv(mix(p.hueDegrees, q.hueDegrees, t), mix(p.saturation, q.saturation, t), mix(p.value, q.value, t));
}

// ---- the shortest way by CIEDE2000, over a lattice of colours

constexpr int kLattice = 17; ///< colours along each of r, g and b, as VTK has it

struct Cell {
    int r = 0, g = 0, b = 0;
    std::size_t index() const { return static_cast<std::size_t>((b * kLattice + g) * kLattice + r); }
    static Cell of(std::size_t index) {
        const int i = static_cast<int>(index);
        return {i % kLattice, i / kLattice % kLattice, i / kLattice / kLattice};
    }
    bool isInside() const {
        const auto fits = [](int v) { return v >= 0 && v < kLattice; };
        return fits(r) && fits(g) && fits(b);
    }
};

Cell cellOf(const Rgb& c) {
    const auto nearest = [](double v) { return static_cast<int>(v * (kLattice - 1) + 0.5); };
    return {nearest(c.r), nearest(c.g), nearest(c.b)};
}

const std::vector<Lab>& latticeColors() {
    static const std::vector<Lab> colors = [] {
        std::vector<Lab> all(static_cast<std::size_t>(kLattice * kLattice * kLattice));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Cell c = Cell::of(i);
            const auto part = [](int v) { return v / static_cast<double>(kLattice - 1); };
            all[i] = labFromSrgb({part(c.r), part(c.g), part(c.b)});
        }
        return all;
    }();
    return colors;
}

/// The cells from one to another by which the sum of differences is smallest (Dijkstra 1959), both ends included.
std::vector<std::size_t> cellsBetween(const Cell& from, const Cell& to) {
    const std::vector<Lab>& colors = latticeColors();
    std::vector<double> distance(colors.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> next(colors.size());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    distance[to.index()] = 0;
    front.push({0.0, to.index()});
    while (!front.empty() && front.top().second != from.index()) {
        const auto [soFar, here] = front.top();
        front.pop();
        if (soFar > distance[here]) continue;
        const Cell c = Cell::of(here);
        for (int n = 0; n < 27; ++n) {
            const Cell other{c.r + n % 3 - 1, c.g + n / 3 % 3 - 1, c.b + n / 9 - 1};
            if (n == 13 || !other.isInside()) continue;
            const double by = soFar + ciede2000(colors[here], colors[other.index()]);
            if (by >= distance[other.index()]) continue;
            distance[other.index()] = by;
            next[other.index()] = here;
            front.push({by, other.index()});
        }
    }
    std::vector<std::size_t> cells{from.index()};
    while (cells.back() != to.index()) cells.push_back(next[cells.back()]);
    return cells;
}

} // namespace

double ciede2000(const Lab& p, const Lab& q) {
    // Sharma, Wu, Dalal 2005; k_L = k_C = k_H = 1
    const auto seventh = [](double c) { return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7))); };
    const double meanChroma = (std::hypot(p.a, p.b) + std::hypot(q.a, q.b)) / 2;
    const double stretch = 1 + 0.5 * (1 - seventh(meanChroma));
    const double c1 = std::hypot(stretch * p.a, p.b), c2 = std::hypot(stretch * q.a, q.b);
    const auto hue = [&](const Lab& c) {
        const double h = std::atan2(c.b, stretch * c.a);
        return h < 0 ? h + 2 * pi : h;
    };
    const double h1 = c1 == 0 ? 0 : hue(p), h2 = c2 == 0 ? 0 : hue(q);
    const bool grey = c1 * c2 == 0;
    double dh = grey ? 0 : h2 - h1;
    if (dh > pi) dh -= 2 * pi;
    if (dh < -pi) dh += 2 * pi;
    double meanHue = h1 + h2;
    if (!grey) {
        meanHue /= 2;
        if (std::abs(h1 - h2) > pi) meanHue += h1 + h2 < 2 * pi ? pi : -pi;
    }
    const double dL = q.lightness - p.lightness, dC = c2 - c1, dH = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2);
    const double meanL = (p.lightness + q.lightness) / 2, meanC = (c1 + c2) / 2;
    const double degree = pi / 180;
    const double t = 1 - 0.17 * std::cos(meanHue - 30 * degree) + 0.24 * std::cos(2 * meanHue) +
                     0.32 * std::cos(3 * meanHue + 6 * degree) - 0.20 * std::cos(4 * meanHue - 63 * degree);
    const double turn = 30 * degree * std::exp(-square((meanHue - 275 * degree) / (25 * degree)));
    const double sL = 1 + 0.015 * square(meanL - 50) / std::sqrt(20 + square(meanL - 50));
    const double l = dL / sL, c = dC / (1 + 0.045 * meanC), h = dH / (1 + 0.015 * meanC * t);
    const double rotation = -std::sin(2 * turn) * 2 * seventh(meanC);
    return std::sqrt(std::max(0.0, l * l + c * c + h * h + rotation * c * h));
}

Rgb srgbFromLab(const Lab& lab) {
    const double fy = (lab.lightness + 16) / 116;
    return srgbFromXyz(Vec3(labCurveInverse(fy + lab.a / 500), labCurveInverse(fy), labCurveInverse(fy - lab.b / 200)) *
                       kWhite);
}

ColorWay::ColorWay(const Rgb& from, const Rgb& to, ColorSpace space) : m_from(from), m_to(to), m_space(space) {
    if (space != ColorSpace::Ciede2000) return;
    for (const std::size_t cell : cellsBetween(cellOf(from), cellOf(to))) m_stops.push_back({latticeColors()[cell], 0});
    m_stops.front().lab = labFromSrgb(from);
    if (m_stops.size() == 1) m_stops.push_back(m_stops.front());
    m_stops.back().lab = labFromSrgb(to);
    for (std::size_t i = 1; i < m_stops.size(); ++i)
        m_stops[i].distance = m_stops[i - 1].distance + ciede2000(m_stops[i - 1].lab, m_stops[i].lab);
}

Rgb ColorWay::between(double t) const {
    switch (m_space) {
    case ColorSpace::Rgb:
        return {mix(m_from.r, m_to.r, t), mix(m_from.g, m_to.g, t), mix(m_from.b, m_to.b, t)};
    case ColorSpace::Hsv:
    case ColorSpace::HsvWrapped:
        return hsvBetween(m_from, m_to, t, m_space == ColorSpace::HsvWrapped);
    case ColorSpace::Lab: {
        const Lab p = labFromSrgb(m_from), q = labFromSrgb(m_to);
        return srgbFromLab({mix(p.lightness, q.lightness, t), mix(p.a, q.a, t), mix(p.b, q.b, t)});
    }
    case ColorSpace::Diverging:
        return divergingBetween(m_from, m_to, t);
    case ColorSpace::ProLab: {
        const Vec3 p = proLabFromSrgb(m_from), q = proLabFromSrgb(m_to);
        return srgbFromProLab(p * (1 - t) + q * t);
    }
    case ColorSpace::Ciede2000: {
        const double at = t * m_stops.back().distance;
        std::size_t i = 1;
        while (i + 1 < m_stops.size() && m_stops[i].distance < at) ++i;
        const Stop &p = m_stops[i - 1], &q = m_stops[i];
        const double s = q.distance > p.distance ? (at - p.distance) / (q.distance - p.distance) : 0;
        return srgbFromLab(
            {mix(p.lab.lightness, q.lab.lightness, s), mix(p.lab.a, q.lab.a, s), mix(p.lab.b, q.lab.b, s)});
    }
    case ColorSpace::Step:
        break;
    }
    return m_to;
}

Rgb ColorWay::at(double t) const {
    if (t <= 0) return m_from; // exactly, whatever a space makes of it
    return t >= 1 ? m_to : between(t);
}

} // namespace pellucid
