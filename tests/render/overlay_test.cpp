// A second volume over the first: where it lies, and both in one picture.
#include <catch2/catch.hpp>

#include <limits>
#include <random>

#include <glm/ext/matrix_transform.hpp>

#include "render/annotation.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/ray_packets.h"
#include "render/overlay.h"
#include "render/slice.h"
#include "render/trilinear.h"
#include "support/picture_checks.h"
#include "support/volumes.h"
#include "tf/opacity.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Mat3 turned(double degrees, const Vec3& axis) {
    return Mat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(axis)));
}

/// A grid around the origin whose voxels are turned and longer along one axis than along another.
Geometry grid(Int3 dims, Vec3 spacing, const Mat3& directions) {
    Geometry g{dims, spacing, Vec3(0), directions, WorldAxes::Patient};
    g.origin = -(g.boxCenter());
    return g;
}
Geometry anatomyGrid() { return grid({26, 22, 20}, {1, 1.2, 1.4}, turned(20, {1, 2, 3})); }
Geometry mapGrid() { return grid({14, 17, 15}, {2.1, 1.6, 1.9}, turned(-35, {3, 1, -1})); }

std::shared_ptr<const Overlay> overlayOf(std::shared_ptr<const Volume> volume, const Geometry& first,
                                         TransferFunction tf) {
    auto overlay = std::make_shared<Overlay>();
    overlay->geometry = overlayPlace(first, volume->geometry()).geometry;
    overlay->volume = std::move(volume);
    overlay->tf = std::move(tf);
    return overlay;
}

std::shared_ptr<const Volume> roughOn(const Geometry& geometry, unsigned seed, bool holes = false) {
    std::mt19937 random(seed);
    const auto rough = roughVolume(random, geometry.dims, geometry.spacing);
    return volumeFrom(geometry, [&](int i, int j, int k) {
        if (holes && random() % 7 == 0) return std::numeric_limits<double>::quiet_NaN();
        return rough->intensity(voxelIndex(geometry.dims, i, j, k));
    });
}

/// One colour, opacity rising from intensity 0.4 to `peak`.
TransferFunction risingTo(double peak, const Rgb& color) {
    TransferFunction tf;
    tf.points = {{0.4, 0, color, false, {}}, {0.7, peak, color, false, {}}, {1, peak, {1, 1, 0.5}, false, {}}};
    tf.features = {{"all", 0, 1, color, {}}};
    return tf;
}

RenderSettings onNothing(int width, int height) {
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.background = {};
    settings.finestInD0 = 1.0 / 16;
    return settings;
}

/// A volume in the reference: emission and absorption at a place of the world.
struct Component {
    const Volume& volume;
    Geometry geometry;
    TfSampler tf;
    std::vector<double> intensities;

    Component(const Volume& v, const Geometry& g, const TransferFunction& function)
        : volume(v), geometry(g), tf(function) {
        for (std::size_t i = 0; i < v.size(); ++i) intensities.push_back(v.intensity(i));
    }
    /// τ per world length, and the colour.
    std::pair<double, Rgb> at(const Vec3& world) const {
        if (!geometry.contains(world)) return {0, {}};
        const Interpolated s = interpolateValid([this](std::size_t i) { return intensities[i]; }, volume.dims(),
                                                geometry.voxelFromWorld(world));
        if (s.validShare == 0) return {0, {}};
        return {opticalDepthOfOpacity(tf.opacity(s.value)) * s.validShare / geometry.d0(), tf.color(s.value)};
    }
};

/// docs/method.md, "The overlay", written out: equal steps of d0/250 along each ray, which at the
/// ends of boxes and at planes may be off by half a step: by 0.5·0.73/250 = 0.0015 of alpha at the largest τ below.
Image drawnOver(const Component& first, const Component& second, const Camera& camera, const RenderSettings& settings) {
    Image image(settings.width, settings.height);
    const VoxelClipping clipping = clippingInVoxels(settings.clipping, first.geometry);
    const double step = first.geometry.d0() / 250, reach = first.geometry.radius() + second.geometry.radius();
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const Ray ray = pixelRay(camera, x + 0.5, y + 0.5, settings.width, settings.height);
            const double middle = glm::dot(first.geometry.boxCenter() - ray.origin, ray.direction);
            double clear = 1;
            Vec3 color(0);
            for (double t = middle - reach; t < middle + reach; t += step) {
                const Vec3 world = ray.origin + (t + step / 2) * ray.direction;
                bool kept = true, faint = false;
                const Vec3 voxel = first.geometry.voxelFromWorld(world);
                for (const VoxelPlane& plane : clipping.cut) kept &= plane.beyond(voxel) <= 0;
                for (const VoxelPlane& plane : clipping.faint) faint |= plane.beyond(voxel) > 0;
                if (!kept) continue;
                auto [tauA, a] = first.at(world);
                auto [tauB, b] = second.at(world);
                if (faint) { // the overlay has nothing there
                    tauA *= clipping.density;
                    tauB = 0;
                }
                if (tauA + tauB == 0) continue;
                const double seen = clear * (1 - std::exp(-(tauA + tauB) * step));
                color += seen / (tauA + tauB) * (tauA * Vec3(a.r, a.g, a.b) + tauB * Vec3(b.r, b.g, b.b));
                clear -= seen;
            }
            float* pixel = image.pixel(x, y);
            for (int c = 0; c < 3; ++c) pixel[c] = clear < 1 ? static_cast<float>(color[c] / (1 - clear)) : 0.0f;
            pixel[3] = static_cast<float>(1 - clear);
        }
    return image;
}

} // namespace

TEST_CASE("two volumes of different maps agree about 200 places of the world", "[overlay]") {
    // Of each coordinate of the world a volume: linear functions are what trilinear interpolation keeps, so that the
    // three values are the place that was sampled. 1e-4 of a voxel is what samples of single precision leave.
    const Geometry first = anatomyGrid(), second = mapGrid();
    std::shared_ptr<const Overlay> coordinate[3];
    for (int axis = 0; axis < 3; ++axis)
        coordinate[axis] = overlayOf(
            volumeFrom(
                second, [&](int i, int j, int k) { return second.worldFromVoxel(Vec3(i, j, k))[axis]; }, std::nullopt),
            first, {});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    int places = 0;
    while (places < 200) {
        const Vec3 voxel = Vec3(unit(random), unit(random), unit(random)) * Vec3(first.dims - 1);
        const Vec3 world = first.worldFromVoxel(voxel), there = second.voxelFromWorld(world);
        bool amongCentres = true;
        for (int a = 0; a < 3; ++a) amongCentres &= there[a] >= 0 && there[a] <= second.dims[a] - 1;
        if (!amongCentres) continue;
        ++places;
        Vec3 found(0);
        for (int axis = 0; axis < 3; ++axis) found[axis] = coordinate[axis]->valueAt(world).value();
        CHECK(glm::length(found - world) < 1e-4 * first.d0());
    }
}

TEST_CASE("what lies at a place of the overlay is seen where that place is", "[overlay]") {
    // A ball of three voxels' width in the overlay; the volume is clear. The middle of what is seen lies where the
    // place is projected, to half a voxel of the overlay's shortest side.
    const Geometry first = anatomyGrid(), second = mapGrid();
    const auto clear = volumeFrom(first, [](int, int, int) { return 0.0; });
    for (const Projection projection : {Projection::Orthographic, Projection::Perspective})
        for (const Vec3& place : {Vec3(0), Vec3(6, -3, 4), Vec3(-7, 5, -5)}) {
            const auto ball = volumeFrom(second, [&](int i, int j, int k) {
                const double r = glm::length(second.worldFromVoxel(Vec3(i, j, k)) - place) / 4;
                return std::max(0.0, 1 - r * r);
            });
            RenderSettings settings = onNothing(200, 200);
            settings.overlay = overlayOf(ball, first, risingTo(0.02, {1, 1, 1}));
            const Camera camera = cameraFromView(first, 30, 20, 1, projection);
            const Image image = makeCpuRenderer(clear)->render(camera, homogeneous(0), settings);
            double sum = 0, x = 0, y = 0;
            for (int row = 0; row < 200; ++row)
                for (int column = 0; column < 200; ++column) {
                    const double alpha = image.pixel(column, row)[3];
                    sum += alpha;
                    x += alpha * (column + 0.5);
                    y += alpha * (row + 0.5);
                }
            REQUIRE(sum > 0);
            const Ray ray = pixelRay(camera, x / sum, y / sum, 200, 200);
            const Vec3 away = place - ray.origin;
            CHECK(glm::length(away - glm::dot(away, ray.direction) * ray.direction) < 0.5 * 1.6);
        }
}

TEST_CASE("the picture of two volumes is that of two media along each ray", "[overlay]") {
    const Geometry first = anatomyGrid(), second = mapGrid();
    for (const bool holes : {false, true})
        for (const double peak : {0.05, 0.4}) {
            const auto a = roughOn(first, 3, holes), b = roughOn(second, 4, holes);
            const TransferFunction tfA = risingTo(peak, {0.2, 0.5, 1}), tfB = risingTo(1.3 * peak, {1, 0.3, 0});
            RenderSettings settings = onNothing(12, 12);
            settings.overlay = overlayOf(b, first, tfB);
            if (holes) settings.clipping.lo = {0.3, 0, 0}, settings.clipping.planes = {{{0.2, 1, 0.4}, 4}};
            if (peak > 0.1) settings.clipping.rest = {{{0, 0, 0.2}, {1, 1, 1}, {{{-0.4, 1, 0.4}, 6}}}, 0.3};
            const Component one(*a, first, tfA), other(*b, settings.overlay->geometry, tfB);
            for (const Projection projection : {Projection::Orthographic, Projection::Perspective}) {
                const Camera camera = cameraFromView(first, 40, 25, 1, projection);
                INFO("peak " << peak << (holes ? ", holes" : ""));
                CHECK(distance(makeCpuRenderer(a)->render(camera, tfA, settings),
                               drawnOver(one, other, camera, settings)) < 0.004);
            }
        }
}

TEST_CASE("a picture with a faint rest is that of a medium thinned there", "[overlay][clip]") {
    // The reference with an overlay in which nothing is.
    const Geometry g = anatomyGrid();
    const auto volume = roughOn(g, 3), nothing = volumeFrom(g, [](int, int, int) { return 0.0; });
    const TransferFunction tf = risingTo(0.4, {0.2, 0.5, 1});
    const Component one(*volume, g, tf), other(*nothing, g, homogeneous(0));
    RenderSettings settings = onNothing(24, 24);
    settings.clipping.hi.x = 0.9;
    settings.clipping.rest = {{{0.3, 0, 0.2}, {1, 0.8, 1}, {{{0.2, 1, 0.4}, 4}}}, 0.25};
    for (const Projection projection : {Projection::Orthographic, Projection::Perspective}) {
        const Camera camera = cameraFromView(g, 40, 25, 1, projection);
        CHECK(distance(makeCpuRenderer(volume)->render(camera, tf, settings), drawnOver(one, other, camera, settings)) <
              0.004);
    }
}

TEST_CASE("it does not matter which of two volumes lies over which", "[overlay]") {
    Geometry first = anatomyGrid(), second = mapGrid();
    second.referenceLength = first.d0(); // opacities are of the same path
    const auto a = roughOn(first, 3), b = roughOn(second, 4);
    const TransferFunction tfA = risingTo(0.2, {0.2, 0.5, 1}), tfB = risingTo(0.3, {1, 0.3, 0});
    const Camera camera = cameraFromView(first, 40, 25, 1, Projection::Perspective);
    RenderSettings over = onNothing(40, 40), under = over;
    over.overlay = overlayOf(b, first, tfB);
    under.overlay = overlayOf(a, second, tfA);
    CHECK(distance(makeCpuRenderer(a)->render(camera, tfA, over), makeCpuRenderer(b)->render(camera, tfB, under)) <
          0.004);
}

TEST_CASE("an overlay over a clear volume looks as that volume alone does", "[overlay]") {
    // Light, clipping and the end of rays are the same for both.
    const Geometry g = anatomyGrid();
    const auto alone = roughOn(g, 3), clear = volumeFrom(g, [](int, int, int) { return 0.0; });
    const TransferFunction tf = risingTo(0.3, {1, 0.6, 0.3});
    const Camera camera = cameraFromView(g, 40, 25, 1.3, Projection::Perspective);
    for (const bool lit : {false, true}) {
        RenderSettings settings = onNothing(60, 50);
        settings.background = Rgb{0.1, 0.2, 0.3};
        settings.clipping.hi = {0.8, 1, 1};
        settings.jitter = lit;
        if (lit)
            settings.light = {
                .on = true, .gradientOpacity = 0.3, .occlusion = 0.5, .depthCue = 0.4, .silhouettes = 0.4};
        const Image wanted = makeCpuRenderer(alone)->render(camera, tf, settings);
        settings.overlay = overlayOf(alone, g, tf);
        INFO((lit ? "lit" : "unlit"));
        CHECK(distance(makeCpuRenderer(clear)->render(camera, homogeneous(0), settings), wanted) < 0.004);
    }
}

TEST_CASE("rays that miss the overlay draw the same bits as without it", "[overlay]") {
    const Geometry first = anatomyGrid();
    Geometry second = mapGrid();
    second.dims = {4, 4, 4};
    const auto a = roughOn(first, 3), b = roughOn(second, 4);
    const TransferFunction tf = risingTo(0.3, {0.2, 0.5, 1});
    const Camera camera = cameraFromView(first, 40, 25, 1, Projection::Perspective);
    RenderSettings settings = onNothing(64, 64);
    const Image without = makeCpuRenderer(a)->render(camera, tf, settings);
    const Geometry placed = overlayPlace(first, second).geometry;
    settings.overlay = overlayOf(b, first, risingTo(0.9, {1, 0, 0}));
    const Image with = makeCpuRenderer(a)->render(camera, tf, settings);
    // Eight rays go together; steps are the volume's, since the overlay is nowhere finer.
    const auto meets = [&](int x, int y) {
        return !intersectBox(inVoxels(pixelRay(camera, x + 0.5, y + 0.5, 64, 64), placed), placed).empty();
    };
    int missed = 0, differing = 0;
    for (int y = 0; y < 64; y += 2)
        for (int x = 0; x < 64; x += 4) {
            bool met = false, equal = true;
            for (int n = 0; n < 8; ++n) {
                const int px = x + n % 4, py = y + n / 4;
                met |= meets(px, py);
                equal &= std::equal(with.pixel(px, py), with.pixel(px, py) + 4, without.pixel(px, py));
            }
            if (!met) CHECK(equal);
            missed += met ? 0 : 1;
            differing += equal ? 0 : 1;
        }
    CHECK(missed > 100);
    CHECK(differing > 5);
}

TEST_CASE("leaping, kernels and previews draw the same of two volumes", "[overlay]") {
    const Geometry first = anatomyGrid();
    const auto a = roughOn(first, 3), b = roughOn(mapGrid(), 4);
    const Camera camera = cameraFromView(first, 40, 25, 1, Projection::Perspective);
    const TransferFunction tf = tents(6, 0.3);
    for (const bool lit : {false, true}) {
        RenderSettings settings = onNothing(48, 40);
        settings.overlay = overlayOf(b, first, tents(4, 0.2));
        settings.light.on = lit;
        settings.jitter = lit;
        const Image with = makeCpuRenderer(a, {0, true})->render(camera, tf, settings);
        CHECK((makeCpuRenderer(a, {0, false})->render(camera, tf, settings).rgba == with.rgba));
        for (int kernel = 1; kernel < static_cast<int>(packetKernels().size()); ++kernel)
            CHECK(distance(makeCpuRenderer(a, {kernel, true})->render(camera, tf, settings), with) < 1.5 / 255);
        const auto renderer = makeCpuRenderer(a);
        CHECK_FALSE(renderer->previewsInStorageOrder(camera, settings)); // which knows of one volume alone
        CHECK((renderer->preview(camera, tf, settings, 1).rgba == with.rgba));
    }
}

TEST_CASE("in the other modes the overlay lies in front", "[overlay]") {
    const Geometry first = anatomyGrid();
    const auto a = roughOn(first, 3), b = roughOn(mapGrid(), 4);
    const Camera camera = cameraFromView(first, 40, 25, 1, Projection::Perspective);
    const TransferFunction tf = tents(3, 0.3), over = risingTo(0.2, {1, 0.3, 0});
    for (const RenderMode mode : {RenderMode::Mip, RenderMode::Average, RenderMode::Surface}) {
        RenderSettings settings = onNothing(32, 32);
        settings.mode = mode;
        const Image behind = makeCpuRenderer(a)->render(camera, tf, settings);
        settings.overlay = overlayOf(b, first, over);
        const Image both = makeCpuRenderer(a)->render(camera, tf, settings);
        settings.mode = RenderMode::Composite;
        const Image front = makeCpuRenderer(a)->render(camera, homogeneous(0), settings);
        Image wanted = front;
        for (std::size_t i = 0; i < wanted.rgba.size(); i += 4) {
            const float clear = 1 - front.rgba[i + 3], alpha = front.rgba[i + 3] + clear * behind.rgba[i + 3];
            for (std::size_t c = 0; c < 3; ++c)
                wanted.rgba[i + c] =
                    alpha > 0
                        ? (front.rgba[i + 3] * front.rgba[i + c] + clear * behind.rgba[i + 3] * behind.rgba[i + c]) /
                              alpha
                        : 0;
            wanted.rgba[i + 3] = alpha;
        }
        INFO(name(mode));
        CHECK(distance(both, wanted) < 0.004);
    }
}

TEST_CASE("a slice shows the overlay where it lies", "[overlay][slice]") {
    // The map is 1 where the world's x is above 0. Opacity 0.1 of a path of d0 is 1 − 0.9¹⁶ over a slice.
    const Geometry first{{21, 21, 21}, Vec3(1), Vec3(-10), Mat3(1), WorldAxes::Patient};
    const Geometry second = grid({21, 21, 21}, {1.5, 1.7, 1.3}, turned(30, {0, 0, 1}));
    const auto grey = volumeFrom(first, [](int, int, int) { return 0.5; });
    const auto map = volumeFrom(
        second, [&](int i, int j, int k) { return 1 / (1 + std::exp(-8 * second.worldFromVoxel(Vec3(i, j, k)).x)); });
    TransferFunction tf;
    tf.points = {{0.5, 0, {1, 0, 0}, false, {}}, {0.5, 0.1, {1, 0, 0}, false, {}}, {1, 0.1, {1, 0, 0}, false, {}}};
    SliceSettings settings;
    settings.tfStrength = 0;
    settings.window = {0, 1};
    const SlicePlane plane{2, 10, fittedSlice(first, 2, 42, 42), 42, 42};
    const Image without = renderSlice(*grey, homogeneous(0), plane, settings);
    settings.overlay = overlayOf(map, first, tf);
    const Image with = renderSlice(*grey, homogeneous(0), plane, settings);
    const double weight = 1 - std::pow(0.9, 16);
    for (int y = 2; y < 40; ++y)
        for (int x = 2; x < 40; ++x) {
            const double world = first.worldFromVoxel(voxelAtPixel(first, plane, {x + 0.5, y + 0.5})).x;
            if (std::abs(world) < 0.85) continue; // within half a voxel of the border
            const double share = world > 0 ? weight : 0;
            CHECK(with.pixel(x, y)[0] ==
                  Approx((1 - share) * static_cast<double>(without.pixel(x, y)[0]) + share).margin(0.001));
            CHECK(with.pixel(x, y)[1] ==
                  Approx((1 - share) * static_cast<double>(without.pixel(x, y)[1])).margin(0.001));
        }
}

TEST_CASE("an overlay is laid by the world, or by the centres of the boxes where files do not say", "[overlay]") {
    const Geometry patient = anatomyGrid();
    Geometry moved = mapGrid();
    moved.origin += Vec3(3, 2, 1);
    const OverlayPlace byWorld = overlayPlace(patient, moved);
    CHECK_FALSE(byWorld.byCentres);
    CHECK(byWorld.geometry.origin == moved.origin);
    CHECK(byWorld.geometry.d0() == patient.d0()); // opacities are of the same path

    const Geometry plain = geometryOf({10, 10, 10}), small = geometryOf({4, 4, 4}, Vec3(2));
    for (const auto& [one, other] : {std::pair(patient, plain), std::pair(plain, moved), std::pair(plain, small)}) {
        const OverlayPlace place = overlayPlace(one, other);
        CHECK(place.byCentres);
        CHECK(glm::length(place.geometry.boxCenter() - one.boxCenter()) < 1e-9);
    }
    // Two files of one program that both say where they lie.
    CHECK_FALSE(overlayPlace(plain, geometryOf({4, 4, 4}, Vec3(2), Vec3(1, 0, 0))).byCentres);
}

TEST_CASE("how far two boxes are apart", "[overlay]") {
    // [-0.5, 9.5]³, and a cube of side 4 that begins at 12: 2.5 apart.
    const Geometry box = geometryOf({10, 10, 10});
    CHECK(boxGap(box, geometryOf({4, 4, 4}, Vec3(1), Vec3(12.5, 3, 3))) == Approx(2.5));
    CHECK(boxGap(box, geometryOf({4, 4, 4}, Vec3(1), Vec3(9, 3, 3))) == 0);
    CHECK(boxGap(box, geometryOf({2, 2, 2}, Vec3(1), Vec3(4, 4, 4))) == 0); // inside
    // The edge of a cube of side 4, turned by 45° about z, is 2√2 from its centre: 20 − 2√2 − 9.5.
    Geometry turnedCube{{4, 4, 4}, Vec3(1), Vec3(0), turned(45, {0, 0, 1}), WorldAxes::File};
    turnedCube.origin += Vec3(20, 4.5, 4.5) - turnedCube.boxCenter();
    CHECK(boxGap(box, turnedCube) == Approx(10.5 - 2 * std::sqrt(2)));
}

TEST_CASE("the legend of the overlay stands at the left of the picture", "[overlay][annotation]") {
    const Geometry first = anatomyGrid();
    AnnotationInput input{AnnotationChoice::none(),
                          cameraFromView(first, 30, 20, 1, Projection::Perspective),
                          first,
                          tents(2),
                          {0, 100},
                          "",
                          {}};
    input.show.legend = true;
    input.picture.width = 600, input.picture.height = 400;
    const auto textsAt = [&](bool left) {
        std::vector<std::string> texts;
        for (const Mark& mark : annotationMarks(input))
            if (mark.kind == Mark::Kind::Text && (mark.points.front().x < 300) == left) texts.push_back(mark.text);
        return texts;
    };
    CHECK(textsAt(true).empty());
    CHECK_FALSE(textsAt(false).empty());
    const auto map = roughOn(mapGrid(), 4)->withRange({-8, 8});
    input.picture.overlay = overlayOf(std::make_shared<const Volume>(map), first, risingTo(0.2, {1, 0, 0}));
    // Its own values: from -8 to 8.
    const std::vector<std::string> own = textsAt(true);
    CHECK(std::ranges::find(own, "0") != own.end());
    CHECK(std::ranges::find(own, "5") != own.end());
    CHECK(std::ranges::find(own, "100") == own.end());
    CHECK_FALSE(textsAt(false).empty());
}
