#include "support/random_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <vector>

#include <glm/geometric.hpp>

#include "render/ray_box.h"

namespace pellucid::test {

namespace {

constexpr double kTwoPi = 6.283185307179586;

const std::vector<std::string> kVolumeKinds{"blobs", "waves",         "balls", "shells",      "checker",
                                            "steps", "blurred noise", "rods",  "rough waves", "white noise"};
const std::vector<std::string> kCameraKinds{"persp any",  "persp near face",   "ortho any",      "ortho 45",
                                            "persp wide", "persp near edge",   "ortho diagonal", "persp 45",
                                            "ortho axis", "persp near corner", "persp diagonal", "ortho tilted",
                                            "persp far"};
const std::vector<std::string> kTfKinds{"tents",       "thin tents",     "boxes", "mixed",
                                        "solid boxes", "tents and more", "ramp"};

/// Which of `kinds` case `number` takes: a fresh permutation for each round through them, another for each stream.
std::size_t kindOf(std::uint32_t number, std::size_t kinds, std::uint32_t stream) {
    const auto round = number / static_cast<std::uint32_t>(kinds);
    Random random(1000003u * stream + round);
    std::vector<std::size_t> order(kinds);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = kinds - 1; i > 0; --i)
        std::swap(order[i], order[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
    return order[number % kinds];
}

// ---------------------------------------------------------------------------------------------------------- volumes

Vec3 randomDirection(Random& random) {
    const double z = random.between(-1, 1), angle = random.between(0, kTwoPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Geometry randomGeometry(Random& random, double size) {
    Geometry g;
    for (int a = 0; a < 3; ++a) {
        do g.dims[a] = 20 + random.below(25);
        while ((a > 0 && g.dims[a] == g.dims[0]) || (a > 1 && g.dims[a] == g.dims[1]));
        g.origin[a] = random.between(-50, 50);
    }
    const int thick = random.below(3);
    switch (random.below(3)) {
    case 0:
        g.spacing = Vec3(random.chance(0.5) ? 1.0 : 0.37);
        break;
    case 1: // slices three voxels apart, fewer of them, as scanners make them
        g.spacing[thick] = random.between(2, 3.5);
        g.dims[thick] = 12 + random.below(12);
        break;
    default:
        g.spacing = {random.between(0.5, 1.6), random.between(0.5, 1.6), random.between(0.5, 1.6)};
    }
    if (random.chance(0.2)) g.dims[random.below(3)] = 45 + random.below(4);
    for (int a = 0; a < 3; ++a) g.dims[a] = std::max(6, static_cast<int>(g.dims[a] * size));
    return g;
}

using Density = std::function<double(const Vec3&)>; ///< of a place in voxels; about [0,1], clamped afterwards

Density waves(Random& random, int count, double steepest) {
    struct Wave {
        Vec3 k;
        double phase;
    };
    std::vector<Wave> all;
    for (int n = 0; n < count; ++n) {
        const Vec3 direction = randomDirection(random);
        const double frequency = steepest * random.between(0.2, 1);
        all.push_back({direction * frequency, random.between(0, kTwoPi)});
    }
    return [all](const Vec3& p) {
        double s = 0;
        for (const Wave& w : all) s += std::sin(glm::dot(w.k, p) + w.phase);
        return 0.5 + 0.6 * s / static_cast<double>(all.size());
    };
}

/// Balls, or their shells of 1 to 2 voxels, with edges as sharp as a grid can hold, each of its own intensity.
Density balls(Random& random, const Int3& dims, bool hollow) {
    struct Ball {
        Vec3 center;
        double radius, wall, inside, shell;
    };
    std::vector<Ball> all;
    for (int n = 0; n < 7; ++n) {
        Ball b;
        for (int a = 0; a < 3; ++a) b.center[a] = random.unit() * dims[a];
        b.radius = random.between(3, 13);
        b.wall = random.between(1, 2);
        b.shell = random.between(0.2, 1);
        b.inside = hollow ? random.between(0, 0.3) : b.shell;
        all.push_back(b);
    }
    return [all](const Vec3& p) {
        double s = 0.05;
        for (const Ball& b : all) {
            const double d = glm::length(p - b.center);
            if (d < b.radius) s = d < b.radius - b.wall ? b.inside : b.shell;
        }
        return s;
    };
}

Density rods(Random& random, const Int3& dims) {
    struct Rod {
        Vec3 center, along;
        double radius, value;
    };
    std::vector<Rod> all;
    for (int n = 0; n < 9; ++n) {
        Rod r;
        for (int a = 0; a < 3; ++a) r.center[a] = random.unit() * dims[a];
        r.along = randomDirection(random);
        r.radius = random.between(0.8, 3);
        r.value = random.between(0.25, 1);
        all.push_back(r);
    }
    return [all](const Vec3& p) {
        double s = 0.1;
        for (const Rod& r : all) {
            const Vec3 d = p - r.center;
            if (glm::length(d - glm::dot(d, r.along) * r.along) < r.radius) s = r.value;
        }
        return s;
    };
}

/// Cubes of a few voxels, alternately low and high, on a slope: without it only intensities 0 and 1 would occur.
Density checker(Random& random) {
    const int size = 2 + random.below(5);
    const double low = random.between(0, 0.2), high = random.between(0.5, 0.8);
    const Vec3 slope = randomDirection(random) * 0.006;
    return [=](const Vec3& p) {
        const auto cell = glm::ivec3(p) / size;
        return ((cell.x + cell.y + cell.z) % 2 == 0 ? low : high) + glm::dot(slope, p);
    };
}

/// Layers of constant intensity, tilted, a few voxels thick.
Density steps(Random& random) {
    const Vec3 normal = randomDirection(random);
    const double thickness = random.between(2, 7);
    std::array<double, 16> values{};
    for (double& v : values) v = random.unit();
    return [=](const Vec3& p) {
        const double layer = std::floor(glm::dot(normal, p) / thickness);
        return values[static_cast<std::size_t>(static_cast<int>(layer) & 15)];
    };
}

/// Each voxel the mean of 27 independent ones, stretched back to the contrast of about [0,1].
std::vector<double> blurred(const Int3& dims, const std::vector<double>& white) {
    const Grid<double> source(dims, white);
    std::vector<double> out;
    out.reserve(white.size());
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                double sum = 0;
                for (int dk = -1; dk <= 1; ++dk)
                    for (int dj = -1; dj <= 1; ++dj)
                        for (int di = -1; di <= 1; ++di)
                            sum += source.at(std::clamp(i + di, 0, dims.x - 1), std::clamp(j + dj, 0, dims.y - 1),
                                             std::clamp(k + dk, 0, dims.z - 1));
                out.push_back(0.5 + (sum / 27 - 0.5) * 3);
            }
    return out;
}

std::vector<double> densities(const std::string& kind, Random& random, const Int3& dims) {
    Density density;
    double noise = 0;
    if (kind == "blobs") {
        density = waves(random, 5, 1.0);
        noise = 0.05;
    } else if (kind == "waves") {
        density = waves(random, 2, 0.6);
    } else if (kind == "rough waves") {
        density = waves(random, 3, 0.4);
        noise = 0.15;
    } else if (kind == "balls" || kind == "shells") {
        density = balls(random, dims, kind == "shells");
        noise = 0.02;
    } else if (kind == "rods") {
        density = rods(random, dims);
    } else if (kind == "checker") {
        density = checker(random);
    } else if (kind == "steps") {
        density = steps(random);
        noise = 0.01;
    } else { // noise of either sort
        density = [](const Vec3&) { return 0.5; };
        noise = 1;
    }
    std::vector<double> values;
    values.reserve(voxelCount(dims));
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) values.push_back(density(Vec3(i, j, k)) + noise * (random.unit() - 0.5));
    if (kind == "blurred noise") values = blurred(dims, values);
    for (double& v : values) v = std::clamp(v, 0.0, 1.0);
    return values;
}

template <class T>
Samples quantized(const std::vector<double>& values, double scale, double offset) {
    std::vector<T> samples;
    samples.reserve(values.size());
    for (const double v : values) samples.push_back(static_cast<T>(std::lround(v * scale + offset)));
    return samples;
}

/// A ball of `missing`, and a few voxels alone.
template <class T>
void invalidate(Random& random, const Int3& dims, std::vector<T>& samples, T missing) {
    Vec3 center;
    for (int a = 0; a < 3; ++a) center[a] = random.unit() * dims[a];
    const double radius = random.between(3, 9);
    std::size_t at = 0;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i, ++at)
                if (glm::length(Vec3(i, j, k) - center) < radius || random.chance(0.01)) samples[at] = missing;
}

std::shared_ptr<const Volume> randomVolume(std::string& kind, Random& random, double size) {
    const Geometry geometry = randomGeometry(random, size);
    const std::vector<double> values = densities(kind, random, geometry.dims);
    std::optional<double> missing;
    Samples samples;
    switch (random.below(5)) {
    case 0:
    case 1:
        samples = quantized<std::uint8_t>(values, 255, 0);
        break;
    case 2:
        samples = quantized<std::int16_t>(values, 4095, -1000);
        kind += " i16";
        break;
    default:
        std::vector<float> floats(values.begin(), values.end());
        kind += " f32";
        if (random.chance(0.4)) {
            invalidate(random, geometry.dims, floats, std::numeric_limits<float>::quiet_NaN());
            kind += " holes";
        }
        samples = std::move(floats);
    }
    Random holes = random; // a copy: other cases stay what they were
    if (holes.chance(0.3))
        std::visit(
            [&](auto& integers) {
                using T = typename std::decay_t<decltype(integers)>::value_type;
                if constexpr (std::is_integral_v<T>) {
                    std::vector<T> holed(integers.begin(), integers.end());
                    invalidate(holes, geometry.dims, holed, std::numeric_limits<T>::max());
                    integers = std::move(holed);
                    missing = static_cast<double>(std::numeric_limits<T>::max());
                    kind += " holes";
                }
            },
            samples);
    return std::make_shared<const Volume>(geometry, std::move(samples), missing);
}

// ----------------------------------------------------------------------------------------------- transfer functions

/// 0.01 … 1, equally likely in each octave; now and then exactly 0 or 1.
double randomOpacity(Random& random) {
    const double kind = random.unit(), octave = random.unit();
    if (kind < 0.06) return 0;
    if (kind < 0.2) return 1;
    return std::pow(100.0, octave - 1);
}

void addTent(TransferFunction& tf, Random& random, double a, double b, double peak) {
    const Rgb color = rgbFromHsv(360 * random.unit(), random.between(0.3, 1), random.between(0.4, 1));
    const double center = a + (b - a) * random.between(0.3, 0.7);
    tf.points.push_back({a, 0, color, true, {}});
    tf.points.push_back({center, peak, color, false, {}});
    tf.points.push_back({b, 0, color, true, {}});
    tf.features.push_back({"f" + std::to_string(tf.features.size() + 1), a, b, color, {}});
}

void addBox(TransferFunction& tf, Random& random, double a, double b, double peak) {
    const Rgb color = rgbFromHsv(360 * random.unit(), random.between(0.3, 1), random.between(0.4, 1));
    for (const auto& [x, alpha] : {std::pair{a, 0.0}, {a, peak}, {b, peak}, {b, 0.0}})
        tf.points.push_back({x, alpha, color, false, {}});
    tf.features.push_back({"f" + std::to_string(tf.features.size() + 1), a, b, color, {}});
}

/// Disjoint intervals of width `least` … `most`, ascending, around intensities that the volume has.
std::vector<std::pair<double, double>> randomIntervals(Random& random, const Volume& volume, int count, double least,
                                                       double most) {
    std::vector<std::pair<double, double>> all;
    for (int attempt = 0; attempt < 200 && static_cast<int>(all.size()) < count; ++attempt) {
        const double s = volume.intensity(static_cast<std::size_t>(random.unit() * static_cast<double>(volume.size())));
        const double width = random.between(least, most), start = s - width * random.between(0.2, 0.8);
        if (!(start >= 0 && start + width <= 1)) continue; // NaN too
        const bool apart = std::none_of(all.begin(), all.end(), [&](const auto& other) {
            return start < other.second + 1e-3 && other.first < start + width + 1e-3;
        });
        if (apart) all.emplace_back(start, start + width);
    }
    if (all.empty()) all.emplace_back(0.5 - least / 2, 0.5 + least / 2);
    std::sort(all.begin(), all.end());
    return all;
}

TransferFunction randomTf(const std::string& kind, Random& random, const Volume& volume) {
    TransferFunction tf;
    const int count = random.chance(0.08) ? 1 : 2 + random.below(4); // one alone has always W = 1
    if (kind == "ramp") { // opacity everywhere; the features meet without a gap
        const int points = 3 + random.below(5);
        for (int i = 0; i < points; ++i) {
            const double x = static_cast<double>(i) / (points - 1);
            tf.points.push_back({x, std::max(0.005, randomOpacity(random)), rgbFromHsv(300 * x, 1, 1), false, {}});
        }
        for (int f = 0; f < count; ++f) {
            const double a = static_cast<double>(f) / count, b = static_cast<double>(f + 1) / count;
            tf.features.push_back({"f" + std::to_string(f + 1), a, b, tf.color((a + b) / 2), {}});
        }
        return tf;
    }
    const bool thin = kind == "thin tents";
    const auto intervals = thin ? randomIntervals(random, volume, count, 0.02, 0.05)
                                : randomIntervals(random, volume, count, 0.08, 0.9 / count);
    for (const auto& [a, b] : intervals) {
        const double peak = kind == "solid boxes" ? random.between(0.5, 1) : randomOpacity(random);
        const bool box = kind == "boxes" || kind == "solid boxes" || (kind == "mixed" && random.chance(0.5));
        if (box)
            addBox(tf, random, a, b, peak);
        else
            addTent(tf, random, a, b, peak);
    }
    if (kind == "tents and more" && tf.features.size() > 1) tf.features.pop_back(); // opacity that is in no feature
    const bool invisible =
        std::all_of(tf.points.begin(), tf.points.end(), [](const ControlPoint& p) { return p.opacity == 0; });
    if (invisible) tf.points[1].opacity = 0.3;
    return tf;
}

// ---------------------------------------------------------------------------------------------------------- cameras

Camera randomCamera(const std::string& kind, Random& random, const Geometry& g) {
    Camera camera;
    const Vec3 lo = g.boundsMin(), hi = g.boundsMax();
    const double radius = 0.5 * glm::length(hi - lo);
    camera.projection = kind.starts_with("ortho") ? Projection::Orthographic : Projection::Perspective;
    camera.center = g.boxCenter();
    camera.height = 2 * radius;

    const auto contains = [&](const char* part) { return kind.find(part) != std::string::npos; };
    if (contains("near")) { // two voxels in front of a face, an edge, a corner
        const int sides = contains("face") ? 1 : contains("edge") ? 2 : 3;
        const int first = random.below(3);
        for (int a = 0; a < 3; ++a) camera.eye[a] = random.between(lo[a], hi[a]);
        for (int n = 0; n < sides; ++n) {
            const int a = (first + n) % 3;
            camera.eye[a] = random.chance(0.5) ? lo[a] - 2 * g.spacing[a] : hi[a] + 2 * g.spacing[a];
        }
    } else {
        Vec3 toEye = randomDirection(random);
        const Vec3 signs{random.sign(), random.sign(), random.sign()};
        const int axis = random.below(3);
        // Exactly between axes: of the world, or of the grid, whichever an engine counts in.
        const Vec3 scale = random.chance(0.5) ? g.spacing : Vec3(1);
        if (contains("45") || contains("diagonal")) toEye = signs * scale;
        if (contains("45")) toEye[axis] = 0;
        if (contains("axis") || contains("tilted")) {
            toEye = Vec3(0);
            toEye[axis] = signs[axis];
        }
        if (contains("tilted")) toEye += 0.02 * randomDirection(random);
        double distance = radius * random.between(1.5, 5);
        if (contains("wide")) distance = radius * random.between(1.02, 1.15);
        if (contains("far")) distance = radius * 40;
        if (contains("ortho")) distance = radius * random.between(0.5, 2); // the eye's place is of no account
        camera.eye = camera.center + toEye * (distance / glm::length(toEye));
    }
    const Vec3 forward = camera.forward();
    camera.up = std::abs(forward.z) > 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    camera.validate(g, kind);
    return camera;
}

/// The columns of a random rotation, some of them mirrored, up to two of them leaning toward another one.
Mat3 randomDirections(Random& random) {
    const Vec3 x = randomDirection(random), z = glm::normalize(glm::cross(x, randomDirection(random)));
    Mat3 directions(x, glm::cross(z, x), z);
    for (int a = 0; a < 3; ++a) directions[a] *= random.sign();
    for (int shears = random.below(3); shears > 0; --shears) {
        const int leaning = random.below(3), toward = (leaning + 1 + random.below(2)) % 3;
        const double angle = random.between(5, 20) * kTwoPi / 360;
        directions[leaning] =
            glm::normalize(std::cos(angle) * directions[leaning] + std::sin(angle) * directions[toward]);
    }
    return directions;
}

/// Keeps the middle of the box, and half of it or more along each axis, less what one to three planes cut off.
Clipping randomClipping(Random& random, const Geometry& g) {
    Clipping clipping;
    for (int a = 0; a < 3; ++a) {
        if (random.chance(0.5)) clipping.lo[a] = random.between(0, 0.35);
        if (random.chance(0.5)) clipping.hi[a] = random.between(0.65, 1);
    }
    for (int planes = 1 + random.below(3); planes > 0; --planes) {
        ClipPlane plane;
        plane.normal = randomDirection(random) * random.between(0.5, 2); // of any length
        plane.offset =
            glm::dot(plane.normal, g.boxCenter()) + glm::length(plane.normal) * g.radius() * random.between(0.05, 0.5);
        clipping.planes.push_back(plane);
    }
    clipping.validate();
    return clipping;
}

} // namespace

RandomCase randomCase(std::uint32_t number, double size) { return randomCase(number, size, {}); }

RandomCase randomCase(std::uint32_t number, double size, const Variant& variant) {
    RandomCase c;
    c.number = number;
    c.volumeKind = kVolumeKinds[kindOf(number, kVolumeKinds.size(), 1)];
    c.cameraKind = kCameraKinds[kindOf(number, kCameraKinds.size(), 2)];
    c.tfKind = kTfKinds[kindOf(number, kTfKinds.size(), 3)];
    Random random(77777u + number);
    c.volume = randomVolume(c.volumeKind, random, size);
    Random more(555555u + number); // a stream of its own: what has no variant stays what it was
    if (variant.affine) {
        Geometry geometry = c.volume->geometry();
        geometry.directions = randomDirections(more);
        c.volume = std::make_shared<const Volume>(geometry, c.volume->samples(), c.volume->missing());
        c.volumeKind += " affine";
    }
    if (variant.clipped) {
        c.clipping = randomClipping(more, c.volume->geometry());
        c.volumeKind += " clipped";
    }
    if (variant.faint) {
        c.clipping.rest = {randomClipping(more, c.volume->geometry()).part(), more.between(0.02, 0.6)};
        c.volumeKind += " faint";
    }
    c.camera = randomCamera(c.cameraKind, random, c.volume->geometry());
    c.tf = randomTf(c.tfKind, random, *c.volume);
    c.tf.validate();
    return c;
}

std::string RandomCase::describe() const {
    const Geometry& g = volume->geometry();
    std::ostringstream text;
    text << std::setw(4) << number << "  " << std::left << std::setw(38) << volumeKind << std::setw(18) << cameraKind
         << std::setw(15) << tfKind << std::setprecision(3) << g.dims.x << 'x' << g.dims.y << 'x' << g.dims.z << " ("
         << g.spacing.x << ' ' << g.spacing.y << ' ' << g.spacing.z << ')';
    return text.str();
}

} // namespace pellucid::test
