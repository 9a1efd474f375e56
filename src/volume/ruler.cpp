#include "volume/ruler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "base/round_numbers.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

/// Voxels whose centres lie on the surface belong to the body, whatever the last bits of their coordinates say.
constexpr double kOnSurface = 1e-9;
/// Rows of voxels up to which the places beyond the grid are counted one by one. A body of more is so large that its
/// volume says the same to some millionths.
constexpr double kMostRows = 4e6;

/// Whole numbers from first to last; none where last < first.
struct Whole {
    long long first = 0, last = -1;
    std::size_t count() const { return last < first ? 0 : static_cast<std::size_t>(last - first + 1); }
    Whole within(int n) const { return {std::max(first, 0LL), std::min(last, static_cast<long long>(n) - 1)}; }
};

Whole wholeBetween(double lo, double hi) {
    constexpr double kFar = 1e15; // beyond any grid, and a whole number still
    return {static_cast<long long>(std::ceil(std::clamp(lo, -kFar, kFar))),
            static_cast<long long>(std::floor(std::clamp(hi, -kFar, kFar)))};
}

/// A convex body as rows of voxels along i: row() says which voxels of row (j, k) it holds.
struct Sphere {
    Sphere(const Geometry& g, const Vec3& centerInWorld, double radius)
        : worldFromIndex(g.worldFromIndex()), center(g.voxelFromWorld(centerInWorld)),
          reach(radius * (1 + kOnSurface)) {
        const Mat3 rows = glm::transpose(g.indexFromWorld());
        // The farthest point along an index axis lies in the direction of that row of the inverse.
        for (int a = 0; a < 3; ++a) {
            const double half = glm::length(rows[a]) * reach;
            lo[a] = center[a] - half;
            hi[a] = center[a] + half;
        }
        volume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    }
    Whole row(double j, double k) const {
        // |a·t + b|² ≤ r², t from the centre along i.
        const Vec3& a = worldFromIndex[0];
        const Vec3 b = worldFromIndex * Vec3(0, j - center.y, k - center.z);
        const double aa = glm::dot(a, a), ab = glm::dot(a, b);
        const double discriminant = ab * ab - aa * (glm::dot(b, b) - reach * reach);
        if (discriminant < 0) return {};
        const double half = std::sqrt(discriminant);
        return wholeBetween(center.x + (-ab - half) / aa, center.x + (-ab + half) / aa);
    }

    Mat3 worldFromIndex;
    Vec3 center; ///< voxel coordinates
    double reach;
    Vec3 lo{0}, hi{0}; ///< voxel coordinates between which it lies
    double volume = 0; ///< world units, cubed
};

struct Box {
    Box(const Geometry& g, const Vec3& loInWorld, const Vec3& hiInWorld)
        : worldFromIndex(g.worldFromIndex()), origin(g.origin), least(loInWorld), most(hiInWorld) {
        for (int w = 0; w < 3; ++w) {
            const double size = std::max({std::abs(least[w]), std::abs(most[w]), std::abs(origin[w])});
            const double tolerance = kOnSurface * g.d0() + 1e-15 * size;
            least[w] -= tolerance;
            most[w] += tolerance;
        }
        lo = hi = g.voxelFromWorld(least);
        for (int n = 1; n < 8; ++n) {
            const Vec3 corner(n & 1 ? most.x : least.x, n & 2 ? most.y : least.y, n & 4 ? most.z : least.z);
            lo = glm::min(lo, g.voxelFromWorld(corner));
            hi = glm::max(hi, g.voxelFromWorld(corner));
        }
        const Vec3 size = hiInWorld - loInWorld;
        volume = size.x * size.y * size.z;
    }
    Whole row(double j, double k) const {
        const Vec3 start = origin + worldFromIndex * Vec3(0, j, k);
        double first = -INFINITY, last = INFINITY;
        for (int w = 0; w < 3; ++w) {
            const double step = worldFromIndex[0][w], below = least[w] - start[w], above = most[w] - start[w];
            if (step == 0) {
                if (below > 0 || above < 0) return {};
                continue;
            }
            first = std::max(first, std::min(below / step, above / step));
            last = std::min(last, std::max(below / step, above / step));
        }
        return wholeBetween(first, last);
    }

    Mat3 worldFromIndex;
    Vec3 origin, least, most; ///< world
    Vec3 lo{0}, hi{0};        ///< as in Sphere
    double volume = 0;
};

/// Count, mean and sum of squared differences from it: of two parts together they are known exactly (Chan, Golub and
/// LeVeque 1979), and large values lose no digits of a small spread.
struct Moments {
    std::size_t count = 0, invalid = 0;
    double mean = 0, squares = 0, lo = INFINITY, hi = -INFINITY;

    void take(double value) {
        ++count;
        const double off = value - mean;
        mean += off / static_cast<double>(count);
        squares += off * (value - mean);
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    void take(const Moments& other) {
        invalid += other.invalid;
        if (other.count == 0) return;
        const double n = static_cast<double>(count), m = static_cast<double>(other.count);
        const double off = other.mean - mean;
        mean += off * m / (n + m);
        squares += other.squares + off * off * n * m / (n + m);
        count += other.count;
        lo = std::min(lo, other.lo);
        hi = std::max(hi, other.hi);
    }
};

/// Of one layer of voxels.
template <class Body, class Samples>
Moments momentsOfLayer(const Volume& volume, const Samples& samples, const Body& body, long long k) {
    const Int3& dims = volume.dims();
    const double missing = volume.missing().value_or(NAN);
    Moments moments;
    const Whole rows = wholeBetween(body.lo.y, body.hi.y).within(dims.y);
    for (long long j = rows.first; j <= rows.last; ++j) {
        const Whole voxels = body.row(static_cast<double>(j), static_cast<double>(k)).within(dims.x);
        if (voxels.count() == 0) continue;
        const std::size_t start = voxelIndex(dims, 0, static_cast<int>(j), static_cast<int>(k));
        for (long long i = voxels.first; i <= voxels.last; ++i) {
            const auto value = static_cast<double>(samples[start + static_cast<std::size_t>(i)]);
            if (std::isfinite(value) && value != missing)
                moments.take(value);
            else
                ++moments.invalid;
        }
    }
    return moments;
}

/// How many places of the grid, if it went on in all directions, the body holds.
template <class Body>
double placesOf(const Body& body, const Geometry& geometry) {
    const Whole rows = wholeBetween(body.lo.y, body.hi.y), layers = wholeBetween(body.lo.z, body.hi.z);
    if (static_cast<double>(rows.count()) * static_cast<double>(layers.count()) > kMostRows)
        return body.volume / std::abs(glm::determinant(geometry.worldFromIndex()));
    std::size_t places = 0;
    for (long long k = layers.first; k <= layers.last; ++k)
        for (long long j = rows.first; j <= rows.last; ++j)
            places += body.row(static_cast<double>(j), static_cast<double>(k)).count();
    return static_cast<double>(places);
}

template <class Body>
BodyValues valuesIn(const Volume& volume, const Body& body, const JobControl& job) {
    const Whole layers = wholeBetween(body.lo.z, body.hi.z).within(volume.dims().z);
    std::vector<Moments> ofLayer(layers.count());
    withSamples(volume, [&](const auto& samples) {
        parallelFor(ofLayer.size(), [&](std::size_t n) {
            job.throwIfStopped();
            ofLayer[n] = momentsOfLayer(volume, samples, body, layers.first + static_cast<long long>(n));
        });
    });
    Moments all;
    for (const Moments& layer : ofLayer) all.take(layer);
    BodyValues values{.count = all.count, .invalid = all.invalid};
    if (all.count > 0) {
        values.mean = all.mean;
        values.sigma = std::sqrt(all.squares / static_cast<double>(all.count));
        values.lo = all.lo;
        values.hi = all.hi;
    }
    const auto inside = static_cast<double>(all.count + all.invalid);
    const double places = placesOf(body, volume.geometry());
    // A body so small that it holds no place at all lies where its middle does.
    const bool isAway = !volume.geometry().contains(volume.geometry().worldFromVoxel(0.5 * (body.lo + body.hi)));
    values.outside = places > 0 ? std::clamp(1 - inside / places, 0.0, 1.0) : isAway ? 1.0 : 0.0;
    return values;
}

/// Degrees between two directions. As accurate near 0 and 180 as elsewhere, other than the arc cosine.
double angleBetween(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

std::string countText(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

} // namespace

Ruler boxRuler(const Vec3& corner, const Vec3& opposite) {
    return {.kind = RulerKind::Box, .points = {glm::min(corner, opposite), glm::max(corner, opposite)}};
}

Ruler inAxes(PatientAxes axes, const Geometry& geometry, const Ruler& ruler) {
    Ruler turned = ruler;
    for (Vec3& p : turned.points) p = inAxes(axes, geometry, p);
    if (ruler.kind == RulerKind::Box) turned.points = boxRuler(turned.points.at(0), turned.points.at(1)).points;
    return turned;
}

std::string rulerProblem(const Ruler& ruler) {
    if (ruler.points.size() != pointsOf(ruler.kind))
        return std::string("a measure of the kind ") + name(ruler.kind) + " has " +
               countText(pointsOf(ruler.kind), "point", "points");
    for (const Vec3& p : ruler.points)
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) return "a coordinate is not finite";
    if (ruler.kind == RulerKind::Angle && (ruler.points[0] == ruler.points[1] || ruler.points[2] == ruler.points[1]))
        return "a leg of the angle has no length";
    if (ruler.kind == RulerKind::Sphere && !(ruler.radius > 0 && std::isfinite(ruler.radius)))
        return "the radius of the sphere is not above 0";
    if (ruler.kind == RulerKind::Box && glm::any(glm::greaterThan(ruler.points[0], ruler.points[1])))
        return "the corners of the box are the wrong way round";
    return {};
}

BodyValues valuesInSphere(const Volume& volume, const Vec3& center, double radius, const JobControl& job) {
    return valuesIn(volume, Sphere(volume.geometry(), center, radius), job);
}

BodyValues valuesInBox(const Volume& volume, const Vec3& lo, const Vec3& hi, const JobControl& job) {
    return valuesIn(volume, Box(volume.geometry(), lo, hi), job);
}

RulerReading readGeometry(const Ruler& ruler) {
    const std::vector<Vec3>& p = ruler.points;
    if (ruler.kind == RulerKind::Distance) return {.length = glm::length(p.at(1) - p.at(0))};
    if (ruler.kind == RulerKind::Angle) return {.angle = angleBetween(p.at(0) - p.at(1), p.at(2) - p.at(1))};
    return {};
}

RulerReading read(const Ruler& ruler, const Volume& volume, const JobControl& job) {
    RulerReading reading = readGeometry(ruler);
    if (ruler.kind == RulerKind::Sphere) reading.values = valuesInSphere(volume, ruler.points.at(0), ruler.radius, job);
    if (ruler.kind == RulerKind::Box) reading.values = valuesInBox(volume, ruler.points.at(0), ruler.points.at(1), job);
    return reading;
}

std::string labelOf(const RulerReading& reading, const Geometry& geometry, double span) {
    if (reading.length) return shortText(*reading.length) + " " + lengthUnit(geometry);
    if (reading.angle) return fixedText(*reading.angle, 1) + "°";
    if (!reading.values) return {};
    if (reading.values->count == 0) return "no voxels";
    return numberText(reading.values->mean, span) + " ± " + numberText(reading.values->sigma, span);
}

std::string textOf(const RulerReading& reading, const Geometry& geometry, double span) {
    if (reading.length) return plainText(*reading.length) + " " + lengthUnit(geometry);
    if (!reading.values) return labelOf(reading, geometry, span);
    const BodyValues& v = *reading.values;
    std::string text = "no voxels";
    if (v.count > 0)
        text = "mean " + numberText(v.mean, span) + ", sigma " + numberText(v.sigma, span) + ", " +
               numberText(v.lo, span) + " to " + numberText(v.hi, span) + ", " + countText(v.count, "voxel", "voxels");
    if (v.invalid > 0) text += ", " + std::to_string(v.invalid) + " invalid";
    if (v.outside > 0)
        text += ", " + (v.outside < 0.0005 ? std::string("under 0.1") : fixedText(100 * v.outside, 1)) +
                " % outside the volume";
    return text;
}

int addRuler(std::vector<Ruler>& rulers, Ruler ruler) {
    int number = 0, ofKind = 0;
    for (const Ruler& other : rulers) number = std::max(number, other.number);
    ruler.number = number + 1;
    if (ruler.name.empty()) {
        std::string kind = name(ruler.kind);
        kind[0] = static_cast<char>(kind[0] - 'a' + 'A');
        const auto isTaken = [&](const std::string& text) {
            return std::any_of(rulers.begin(), rulers.end(), [&](const Ruler& other) { return other.name == text; });
        };
        do ruler.name = kind + " " + std::to_string(++ofKind);
        while (isTaken(ruler.name));
    }
    rulers.push_back(std::move(ruler));
    return rulers.back().number;
}

} // namespace pellucid
