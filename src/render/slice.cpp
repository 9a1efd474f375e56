#include "render/slice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/vector_relational.hpp>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "render/overlay.h"
#include "tf/opacity.h"
#include "tf/tf_table.h"

namespace pellucid {

namespace {

/// How many d0 thick the slab is whose colour is laid over the grey: opacities of a path of d0 are often too small to
/// be seen on a plane.
constexpr double kSlab = 16;
constexpr int kTableSize = 16384;

/// World axis of each index axis: the assignment that is nearest to the grid's directions.
std::array<int, 3> worldAxes(const Geometry& g) {
    constexpr std::array<std::array<int, 3>, 6> kOrders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const auto nearness = [&](const std::array<int, 3>& order) {
        double sum = 0;
        for (int a = 0; a < 3; ++a) sum += std::abs(g.directions[a][order[static_cast<std::size_t>(a)]]);
        return sum;
    };
    std::array<int, 3> best = kOrders[0];
    for (const auto& order : kOrders)
        if (nearness(order) > nearness(best) + 1e-9) best = order;
    return best;
}

struct Across {
    int axis;  ///< index axis
    bool flip; ///< the picture's direction is against it
};

/// The index axis nearest to a world axis, in the direction `positive` of it.
Across across(const Geometry& g, const std::array<int, 3>& world, int worldAxis, bool positive) {
    const int a = static_cast<int>(std::ranges::find(world, worldAxis) - world.begin());
    return {a, (g.directions[a][worldAxis] > 0) != positive};
}

double length(const Geometry& g, int axis) { return g.dims[axis] * g.spacing[axis]; }

/// Along one axis of the picture, or perpendicular to it: the two voxels around a coordinate, and the second one's
/// weight; `in` false beyond the box.
struct Between {
    std::size_t low = 0, high = 0; ///< times the axis's stride
    float weight = 0;
    bool in = false;
};

Between between(double at, int count, std::size_t stride, bool linear) {
    Between b;
    b.in = at >= -0.5 && at <= count - 0.5;
    const double held = std::clamp(at, 0.0, static_cast<double>(count - 1));
    if (!linear) {
        b.low = b.high = static_cast<std::size_t>(std::min(count - 1, static_cast<int>(held + 0.5))) * stride;
        return b;
    }
    const int low = std::min(static_cast<int>(held), std::max(0, count - 2));
    b.low = static_cast<std::size_t>(low) * stride;
    b.high = static_cast<std::size_t>(std::min(low + 1, count - 1)) * stride;
    b.weight = static_cast<float>(held - low);
    return b;
}

/// Calls take(index, value, weight) for those of up to eight voxels that are valid and have a weight.
template <class Values, class Take>
void forEachCorner(const Values& values, std::optional<double> missing, const Between (&b)[3], const Take& take) {
    for (unsigned corner = 0; corner < 8; ++corner) {
        double w = 1;
        std::size_t at = 0;
        for (unsigned a = 0; a < 3; ++a) {
            const bool high = corner >> a & 1;
            w *= static_cast<double>(high ? b[a].weight : 1.0f - b[a].weight);
            at += high ? b[a].high : b[a].low;
        }
        if (w == 0) continue;
        const auto v = static_cast<double>(values[at]);
        if (std::isfinite(v) && !(missing && v == *missing)) take(at, v, w);
    }
}

/// The mean over the valid of up to eight voxels.
template <class Values>
bool mean(const Values& values, bool allValid, std::optional<double> missing, const Between (&b)[3], double& result) {
    if (allValid) { // nearly always: no weights to keep
        const auto alongX = [&](std::size_t at) {
            const auto low = static_cast<double>(values[at + b[0].low]),
                       high = static_cast<double>(values[at + b[0].high]);
            return low + static_cast<double>(b[0].weight) * (high - low);
        };
        const auto alongY = [&](std::size_t at) {
            const double low = alongX(at + b[1].low), high = alongX(at + b[1].high);
            return low + static_cast<double>(b[1].weight) * (high - low);
        };
        const double low = alongY(b[2].low);
        result = b[2].weight == 0 ? low : low + static_cast<double>(b[2].weight) * (alongY(b[2].high) - low);
        return true;
    }
    double sum = 0, share = 0;
    forEachCorner(values, missing, b, [&](std::size_t, double v, double w) {
        sum += w * v;
        share += w;
    });
    if (share < 0.5) return false;
    result = sum / share;
    return true;
}

/// The colour between up to eight voxels, over the valid ones as the value is.
template <class Values>
Rgb meanColor(const VoxelColors& colors, const Values& values, std::optional<double> missing, const Between (&b)[3]) {
    double sum[3]{}, share = 0;
    forEachCorner(values, missing, b, [&](std::size_t at, double, double w) {
        for (unsigned c = 0; c < 3; ++c) sum[c] += w * (colors.rgba[at] >> (8 * c) & 255u) / 255;
        share += w;
    });
    return {sum[0] / share, sum[1] / share, sum[2] / share};
}

std::array<std::size_t, 3> strides(const Int3& dims) { return {1, static_cast<std::size_t>(dims.x), layerSize(dims)}; }

/// Where in a window values lie, [0, 1]. In halves, since its ends may lie further apart than the largest double.
struct Window {
    double lo, perHalf; ///< perHalf 0: the window is one value
    double ifEqual;     ///< what values from there on are

    Window(const ValueRange& range, double equal)
        : lo(range.lo), perHalf(range.hi > range.lo ? 1 / (range.hi / 2 - range.lo / 2) : 0), ifEqual(equal) {}
    double operator()(double value) const {
        if (perHalf == 0) return value < lo ? 0 : ifEqual;
        return std::clamp((value / 2 - lo / 2) * perHalf, 0.0, 1.0);
    }
};

/// What lies over the grey at an intensity.
struct Tint {
    float r, g, b;
    float weight; ///< of the colour, [0, 1]
};

std::vector<Tint> tints(const TransferFunction& tf, double strength) {
    const TfTable table = makeTfTable(tf, kTableSize);
    std::vector<Tint> result;
    result.reserve(table.rgba.size());
    for (const auto& c : table.rgba)
        result.push_back({c[0], c[1], c[2], static_cast<float>(strength * opacityOfStep(c[3], kSlab))});
    return result;
}

/// `over` on a pixel of straight colour.
void lay(const Tint& over, float* pixel) {
    const float under = pixel[3] * (1 - over.weight), alpha = under + over.weight;
    if (!(over.weight > 0)) return;
    const float color[3] = {over.r, over.g, over.b};
    for (int c = 0; c < 3; ++c) pixel[c] = (under * pixel[c] + over.weight * color[c]) / alpha;
    pixel[3] = alpha;
}

/// The second volume over the slice, within the box of the first and its kept part.
void layOverlay(Image& image, const Geometry& g, const SlicePlane& plane, const SliceSettings& settings) {
    const Overlay& overlay = *settings.overlay;
    const std::vector<Tint> tint = tints(overlay.tf, 1);
    const std::vector<VoxelPlane> cuts = planesInVoxels(settings.clipping.part(), g);
    const Window intensityOf(overlay.volume->range(), 0);
    const Vec3 lo = g.voxelBoxMin(), hi = g.voxelBoxMax();
    parallelFor(static_cast<std::size_t>(plane.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < plane.width; ++x) {
            const Vec3 voxel = voxelAtPixel(g, plane, {x + 0.5, y + 0.5});
            if (glm::any(glm::lessThan(voxel, lo)) || glm::any(glm::greaterThan(voxel, hi)) || !keeps(cuts, voxel))
                continue;
            const std::optional<double> value =
                valueAt(*overlay.volume, overlay.geometry.voxelFromWorld(g.worldFromVoxel(voxel)), settings.linear);
            if (value)
                lay(tint[static_cast<std::size_t>(intensityOf(*value) * (kTableSize - 1) + 0.5)], image.pixel(x, y));
        }
    });
}

} // namespace

SliceView sliceView(const Geometry& geometry, int axis) {
    PELLUCID_CHECK(axis >= 0 && axis < 3);
    const auto world = worldAxes(geometry);
    const bool patient = geometry.worldAxes == WorldAxes::Patient; // L, P, S are positive
    const int through = world[static_cast<std::size_t>(axis)];
    const Across right = across(geometry, world, through == 0 ? 1 : 0, true);
    const Across down = through == 2 ? across(geometry, world, 1, patient) : across(geometry, world, 2, false);
    return {right.axis, down.axis, right.flip, down.flip};
}

int sliceWorldAxis(const Geometry& geometry, int axis) {
    PELLUCID_CHECK(axis >= 0 && axis < 3);
    return worldAxes(geometry)[static_cast<std::size_t>(axis)];
}

const char* sliceName(const Geometry& geometry, int axis) {
    constexpr std::array kOfPatient{"sagittal", "coronal", "axial"}, kOfFile{"x", "y", "z"};
    const auto world = static_cast<std::size_t>(sliceWorldAxis(geometry, axis));
    return geometry.worldAxes == WorldAxes::Patient ? kOfPatient[world] : kOfFile[world];
}

Vec2 sliceSize(const Geometry& geometry, int axis) {
    const SliceView view = sliceView(geometry, axis);
    return {length(geometry, view.right), length(geometry, view.down)};
}

SliceRect fittedSlice(const Geometry& geometry, int axis, int width, int height) {
    PELLUCID_CHECK(width > 0 && height > 0);
    const Vec2 size = sliceSize(geometry, axis);
    const double perPixel = std::max(size.x / width, size.y / height);
    const double w = perPixel * width, h = perPixel * height;
    return {(size.x - w) / 2, (size.y - h) / 2, w, h};
}

Vec3 voxelAtPixel(const Geometry& geometry, const SlicePlane& plane, const Vec2& pixel) {
    const SliceView view = sliceView(geometry, plane.axis);
    const auto along = [&](int a, bool flip, double from, double extent, double fraction) {
        const double at = (from + fraction * extent) / geometry.spacing[a]; // from the side of the box
        return (flip ? geometry.dims[a] - at : at) - 0.5;
    };
    Vec3 voxel;
    voxel[plane.axis] = plane.position;
    voxel[view.right] = along(view.right, view.flipRight, plane.shown.left, plane.shown.width, pixel.x / plane.width);
    voxel[view.down] = along(view.down, view.flipDown, plane.shown.top, plane.shown.height, pixel.y / plane.height);
    return voxel;
}

Vec2 pixelOfVoxel(const Geometry& geometry, const SlicePlane& plane, const Vec3& voxel) {
    const SliceView view = sliceView(geometry, plane.axis);
    const auto along = [&](int a, bool flip, double from, double extent) {
        const double at = voxel[a] + 0.5;
        return ((flip ? geometry.dims[a] - at : at) * geometry.spacing[a] - from) / extent;
    };
    return {along(view.right, view.flipRight, plane.shown.left, plane.shown.width) * plane.width,
            along(view.down, view.flipDown, plane.shown.top, plane.shown.height) * plane.height};
}

std::optional<double> valueAt(const Volume& volume, const Vec3& voxel, bool linear) {
    const auto stride = strides(volume.dims());
    Between around[3];
    for (int a = 0; a < 3; ++a) {
        around[a] = between(voxel[a], volume.dims()[a], stride[static_cast<std::size_t>(a)], linear);
        if (!around[a].in) return {};
    }
    double value = 0;
    const bool found = std::visit(
        [&](const auto& values) { return mean(values, volume.invalidCount() == 0, volume.missing(), around, value); },
        volume.samples());
    if (!found) return {};
    return value;
}

void SliceSettings::validate() const {
    if (!std::isfinite(window.lo) || !std::isfinite(window.hi) || !(window.lo <= window.hi))
        throw UsageError("the window of grey needs LO <= HI, both finite", "window", "give two such numbers");
    if (!(tfStrength >= 0 && tfStrength <= 1))
        throw UsageError("the strength of the colours must lie in [0,1]", "slice", "give such a number");
    clipping.validate();
}

Image renderSlice(const Volume& volume, const TransferFunction& tf, const SlicePlane& plane,
                  const SliceSettings& settings) {
    settings.validate();
    PELLUCID_CHECK(plane.width > 0 && plane.height > 0 && plane.shown.width > 0 && plane.shown.height > 0);
    PELLUCID_CHECK(!settings.colors || (settings.colors->dims == volume.dims() &&
                                        settings.colors->rgba.size() == voxelCount(volume.dims())));
    const Geometry& g = volume.geometry();
    const SliceView view = sliceView(g, plane.axis);
    const auto stride = strides(g.dims);
    const auto around = [&](int a, double at) {
        return between(at, g.dims[a], stride[static_cast<std::size_t>(a)], settings.linear);
    };
    Image image(plane.width, plane.height);
    const Between through = around(plane.axis, plane.position);
    if (!through.in) return image;

    std::vector<Between> columns;
    for (int x = 0; x < plane.width; ++x)
        columns.push_back(around(view.right, voxelAtPixel(g, plane, {x + 0.5, 0.5})[view.right]));
    const std::vector<VoxelPlane> cuts = planesInVoxels(settings.clipping.part(), g);
    const std::vector<Tint> tint = tints(tf, settings.tfStrength);
    const auto greyShown = static_cast<float>(std::min(1.0, 2 * (1 - settings.tfStrength)));
    const bool allValid = volume.invalidCount() == 0;
    const Window greyOf(settings.window, 1), intensityOf(volume.range(), 0);

    const auto draw = [&](const auto& values, int y) {
        const Between row = around(view.down, voxelAtPixel(g, plane, {0.5, y + 0.5})[view.down]);
        if (!row.in) return;
        for (int x = 0; x < plane.width; ++x) {
            const Between& column = columns[static_cast<std::size_t>(x)];
            if (!column.in) continue;
            if (!cuts.empty() && !keeps(cuts, voxelAtPixel(g, plane, {x + 0.5, y + 0.5}))) continue;
            const Between corners[3] = {column, row, through};
            double value = 0;
            if (!mean(values, allValid, volume.missing(), corners, value)) continue;
            const double grey = greyOf(value), s = intensityOf(value);
            Tint over = tint[static_cast<std::size_t>(s * (kTableSize - 1) + 0.5)];
            if (settings.colors && over.weight > 0) {
                const Rgb color = meanColor(*settings.colors, values, volume.missing(), corners);
                over.r = static_cast<float>(color.r);
                over.g = static_cast<float>(color.g);
                over.b = static_cast<float>(color.b);
            }
            const float under = (1 - over.weight) * greyShown * static_cast<float>(grey);
            float* pixel = image.pixel(x, y);
            pixel[0] = under + over.weight * over.r;
            pixel[1] = under + over.weight * over.g;
            pixel[2] = under + over.weight * over.b;
            pixel[3] = 1;
        }
    };
    constexpr int kRows = 16;
    parallelFor(static_cast<std::size_t>((plane.height + kRows - 1) / kRows), [&](std::size_t band) {
        std::visit(
            [&](const auto& values) {
                const int first = static_cast<int>(band) * kRows;
                for (int y = first; y < std::min(plane.height, first + kRows); ++y) draw(values, y);
            },
            volume.samples());
    });
    if (settings.overlay) layOverlay(image, g, plane, settings);
    return image;
}

} // namespace pellucid
