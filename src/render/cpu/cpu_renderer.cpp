// The renderer on the CPU: prepares what packets of rays need (see ray_packets.h) and shares the picture's tiles among
// threads (docs/method.md, "The picture").
#include "render/cpu/cpu_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/parallel.h"
#include "render/ambient_occlusion.h"
#include "render/cpu/ray_packets.h"
#include "render/cpu/ray_table.h"
#include "render/cpu/sheared_picture.h"
#include "render/ground_raster.h"
#include "render/ray_blocks.h"

namespace pellucid {

namespace {

constexpr int kTile = 32; ///< pixels

void copy(const Vec3& from, float (&to)[3]) {
    for (int a = 0; a < 3; ++a) to[a] = static_cast<float>(from[a]);
}
Vec3 vector(const Rgb& c) { return {c.r, c.g, c.b}; }

static_assert(int(PacketMode::Composite) == int(RenderMode::Composite) &&
              int(PacketMode::Mip) == int(RenderMode::Mip) && int(PacketMode::MinIp) == int(RenderMode::MinIp) &&
              int(PacketMode::Average) == int(RenderMode::Average) &&
              int(PacketMode::Surface) == int(RenderMode::Surface));
PacketMode packetMode(RenderMode mode) { return static_cast<PacketMode>(mode); }

class CpuRenderer final : public TileRenderer {
public:
    CpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options)
        : m_volume(std::move(volume)), m_options(options), m_grid(sharedIntensityGrid(*m_volume)), m_blocks(*m_grid),
          m_sheared(*m_grid, m_volume->geometry(), options.kernel) {}

    std::string name() const override { return "cpu"; }

    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        settings.validate();
        Image image(settings.width, settings.height);
        draw(camera, tf, settings, 1, image, tilesOf(image), {}, job);
        return image;
    }

    Image preview(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                  const JobControl& job) override {
        PELLUCID_CHECK(scale > 0 && scale <= 1);
        settings.validate();
        const auto scaled = [scale](int pixels) { return static_cast<int>(std::ceil(pixels * scale - 1e-9)); };
        Image image(scaled(settings.width), scaled(settings.height));
        if (!drawSheared(camera, tf, settings, scale, image, job))
            draw(camera, tf, settings, scale, image, tilesOf(image), {}, job);
        return image;
    }

    bool previewsInStorageOrder(const Camera& camera, const RenderSettings& settings) const override {
        return shearOf(camera, settings, 1).has_value();
    }

    void refine(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, Image& image, int x,
                int y, const std::function<void(const ImagePart&)>& done, const JobControl& job) override {
        settings.validate();
        PELLUCID_CHECK(image.width == settings.width && image.height == settings.height);
        std::vector<ImagePart> tiles = tilesOf(image);
        const auto distance = [&](const ImagePart& t) {
            const std::int64_t dx = t.x0 + kTile / 2 - x, dy = t.y0 + kTile / 2 - y;
            return dx * dx + dy * dy;
        };
        std::ranges::stable_sort(tiles, {}, distance);
        draw(camera, tf, settings, 1, image, tiles, done, job);
    }

private:
    static std::vector<ImagePart> tilesOf(const Image& image) {
        std::vector<ImagePart> tiles;
        for (int y = 0; y < image.height; y += kTile)
            for (int x = 0; x < image.width; x += kTile)
                tiles.push_back({x, y, std::min(x + kTile, image.width), std::min(y + kTile, image.height)});
        return tiles;
    }

    void draw(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
              Image& image, const std::vector<ImagePart>& tiles, const std::function<void(const ImagePart&)>& done,
              const JobControl& job) {
        PacketScene scene = sceneOf(camera, tf, settings, scale, image);
        const GroundPicture ground = groundUnder(camera, settings, scale, image, job);
        if (!ground.depth.empty()) {
            scene.groundDepth = ground.depth.data();
            scene.ground = ground.rgba.data();
        }
        const PacketKernel kernel = packetKernels()[static_cast<std::size_t>(m_options.kernel)];
        std::mutex mutex;
        std::atomic<std::size_t> count = 0;
        parallelFor(tiles.size(), [&](std::size_t i) {
            job.throwIfStopped();
            const ImagePart& tile = tiles[i];
            kernel(scene, {tile.x0, tile.y0, tile.x1, tile.y1});
            if (done) {
                const std::lock_guard lock(mutex);
                done(tile);
            }
            job.report(static_cast<double>(++count) / static_cast<double>(tiles.size()));
        });
    }

    /// False where the picture cannot be drawn in storage order.
    bool drawSheared(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                     Image& image, const JobControl& job) {
        const auto view = shearOf(camera, settings, scale);
        if (!view) return false;
        m_sheared.draw(sceneOf(camera, tf, settings, scale, image), camera, *view, job);
        return true;
    }

    std::optional<ShearView> shearOf(const Camera& camera, const RenderSettings& settings, double scale) const {
        if (!m_options.sheared || !ShearedPicture::canDraw(settings)) return {};
        camera.validate(m_volume->geometry(), "camera");
        return pellucid::shearOf(camera, m_volume->geometry(), settings.clipping, settings.width * scale,
                                 settings.height * scale, m_options.density);
    }

    /// All but the ground.
    PacketScene sceneOf(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                        Image& image) {
        camera.validate(m_volume->geometry(), "camera");
        prepare(tf, settings);
        PacketScene scene;
        fillVolume(scene);
        fillColors(settings, scene);
        fillCamera(camera, settings, scale, scene);
        fillRegion(settings, scene);
        fillMode(tf, settings, scene);
        fillLight(camera, settings, scene);
        scene.width = image.width;
        scene.height = image.height;
        scene.rgba = image.rgba.data();
        scene.leap = m_options.leap;
        return scene;
    }

    /// Empty where the picture has none.
    GroundPicture groundUnder(const Camera& camera, const RenderSettings& settings, double scale, const Image& image,
                              const JobControl& job) const {
        if (!showsGround(settings)) return {};
        return groundOf(settings, camera, m_volume->geometry(),
                        {settings.width * scale, settings.height * scale, 0, 0, image.width, image.height}, job);
    }

    /// Tables and blocks of the transfer function, where it is not the last one.
    void prepare(const TransferFunction& tf, const RenderSettings& settings) {
        const Feature* only = settings.featureAlone(tf);
        const Prepared wanted{tf, settings.onlyFeature, settings.mode == RenderMode::Surface};
        if (m_table && m_prepared == wanted) return;
        m_table.reset();
        m_features.clear();
        m_openness.reset();
        if (wanted.surfaces) {
            prepareFeatures(tf, only);
            m_table.emplace(
                [&](double s) {
                    const float code = static_cast<float>(s * m_grid->maxCode);
                    return std::ranges::any_of(m_features,
                                               [&](const auto& f) { return code >= f.low && code < f.high; });
                },
                *m_grid);
        } else {
            m_table.emplace(tf, only, *m_grid);
        }
        m_distances = m_blocks.distances([&](int low, int high) { return m_table->isOpaque(low, high); });
        m_prepared = wanted;
    }

    /// Those that mode Surface draws.
    void prepareFeatures(const TransferFunction& tf, const Feature* only) {
        const std::vector<double> peaks = featureOpacities(tf);
        for (std::size_t f = 0; f < peaks.size(); ++f) {
            const Feature& feature = tf.features[f];
            if (peaks[f] <= 0 || (only && only != &feature)) continue;
            PacketScene::Feature to{lowestCode(feature), endCode(feature), {}, static_cast<float>(peaks[f])};
            copy(vector(feature.color), to.rgb);
            m_features.push_back(to);
        }
        if (m_features.size() > kMostSurfaces)
            throw Error(std::to_string(m_features.size()) + " features have an opacity", "surfaces",
                        "draw at most " + std::to_string(kMostSurfaces));
    }
    float lowestCode(const Feature& f) const { return static_cast<float>(f.a * m_grid->maxCode); }
    float endCode(const Feature& f) const { ///< 1 belongs to a feature that ends there
        return f.b >= 1 ? 65536.0f : static_cast<float>(f.b * m_grid->maxCode);
    }

    void fillVolume(PacketScene& s) const {
        const Int3 n = m_volume->dims();
        s.codes = m_grid->codes.wide();
        s.narrowCodes = m_grid->codes.narrow();
        s.valid = m_grid->valid.empty() ? nullptr : m_grid->valid.data();
        for (int a = 0; a < 3; ++a) {
            s.dims[a] = n[a];
            s.blockDims[a] = m_blocks.dims()[a];
        }
        s.middleSlice = n.z / 2;
        s.middleVoxel = static_cast<std::int64_t>(s.middleSlice) * n.x * n.y;
        s.blockDistance = m_distances.data();
        s.blockRange = m_blocks.ranges().data();
        s.cellOfCode = m_table->cellOfCode();
        s.intensityOfCode = 1.0f / static_cast<float>(m_grid->maxCode);
        s.integral = m_table->integral();
        s.colors = m_table->colors();
        s.depthUnit = m_table->depthUnit();
        s.lastEntry = static_cast<float>(m_table->cells());
    }

    void fillColors(const RenderSettings& settings, PacketScene& s) const {
        if (!settings.colors) return;
        PELLUCID_CHECK(settings.colors->dims == m_volume->dims() &&
                       settings.colors->rgba.size() == voxelCount(m_volume->dims()));
        s.voxelColors = settings.colors->rgba.data();
    }

    void fillCamera(const Camera& camera, const RenderSettings& settings, double scale, PacketScene& s) const {
        const Geometry& g = m_volume->geometry();
        const bool perspective = camera.projection == Projection::Perspective;
        const Vec3 ahead = camera.forward(), right = camera.right(), down = -camera.trueUp();
        const double half = perspective ? std::tan(glm::radians(camera.fovY) / 2) : camera.height / 2;
        const double perPixel = 2 * half / (settings.height * scale);
        const double middle = glm::dot(g.boxCenter() - camera.eye, ahead); // depth of the box
        PacketCamera& c = s.camera;
        c.middle[0] = static_cast<float>(settings.width * scale / 2);
        c.middle[1] = static_cast<float>(settings.height * scale / 2);
        copy(g.voxelFromWorld(camera.eye + middle * ahead), c.point);
        copy(inVoxels(ahead), c.direction);
        for (int i = 0; i < 2; ++i) {
            const Vec3 side = inVoxels(perPixel * (i == 0 ? right : down));
            copy(perspective ? middle * side : side, c.pointBy[i]);
            copy(perspective ? side : Vec3(0), c.directionBy[i]);
            c.slope[i] = perspective ? static_cast<float>(perPixel) : 0;
        }
        c.nearest = perspective ? static_cast<float>(-middle) : -1e30f;
        s.halvings = settings.halvings();
        s.step = static_cast<float>(settings.stepInD0 * g.d0());
        s.stepInD0 = static_cast<float>(settings.stepInD0);
    }

    void fillRegion(const RenderSettings& settings, PacketScene& s) const {
        const auto add = [&](const Vec3& normal, double offset) {
            PacketPlane& plane = s.planes[s.planeCount++];
            copy(normal, plane.normal);
            plane.offset = static_cast<float>(offset);
        };
        const Geometry& g = m_volume->geometry();
        for (int a = 0; a < 3; ++a) {
            Vec3 normal(0);
            normal[a] = 1;
            add(-normal, -g.voxelBoxMin()[a]);
            add(normal, g.voxelBoxMax()[a]);
        }
        for (const VoxelPlane& plane : planesInVoxels(settings.clipping, g)) add(plane.normal, plane.offset);
    }

    void fillMode(const TransferFunction& tf, const RenderSettings& settings, PacketScene& s) const {
        s.mode = packetMode(settings.mode);
        s.jitter = settings.jitter;
        s.features = m_features.data();
        s.featureCount = static_cast<int>(m_features.size());
        if (const Feature* only = settings.featureAlone(tf)) {
            s.lowestShown = lowestCode(*only);
            s.highestShown = endCode(*only);
        }
        if (!settings.background) return;
        s.hasBackground = true;
        copy(vector(*settings.background), s.background);
        copy(vector(settings.backgroundTop.value_or(*settings.background)), s.backgroundTop);
    }

    void fillLight(const Camera& camera, const RenderSettings& settings, PacketScene& s) {
        const Light& from = settings.light;
        PacketLight& l = s.light;
        l.shaded = from.on;
        l.any = from.changesColors();
        if (!l.any) return;
        l.ambient = static_cast<float>(from.ambient);
        l.diffuse = static_cast<float>(from.diffuse);
        copy(glm::normalize(from.direction), l.toward);
        m_specular.resize(kSpecularEntries + 1);
        for (int i = 0; i <= kSpecularEntries; ++i)
            m_specular[static_cast<std::size_t>(i)] =
                static_cast<float>(from.specular * std::pow(static_cast<double>(i) / kSpecularEntries, from.shininess));
        l.specular = m_specular.data();
        const Geometry& g = m_volume->geometry();
        const double scale = g.d0() / m_grid->maxCode;
        copy(scale * inVoxels(camera.right()), l.cameraFromGradient[0]);
        copy(scale * inVoxels(camera.trueUp()), l.cameraFromGradient[1]);
        copy(-scale * inVoxels(camera.forward()), l.cameraFromGradient[2]);
        l.gradientOpacity = static_cast<float>(from.gradientOpacity);
        l.silhouettes = static_cast<float>(from.silhouettes);
        l.occlusion = static_cast<float>(from.occlusion);
        l.depthCue = static_cast<float>(from.depthCue);
        l.cueFrom = static_cast<float>(-g.radius()); // depths count from the middle of the box
        l.cuePerDepth = static_cast<float>(1 / (2 * g.radius()));
        if (settings.background) copy(vector(*settings.background), l.cueColor);
        if (from.occlusion > 0) fillOcclusion(settings, l);
    }

    void fillOcclusion(const RenderSettings& settings, PacketLight& l) {
        if (!m_openness)
            m_openness = makeAmbientOcclusion(*m_grid, m_volume->geometry(), m_prepared.tf,
                                              settings.featureAlone(m_prepared.tf));
        l.openness = m_openness->open.data();
        for (int a = 0; a < 3; ++a) l.opennessDims[a] = m_openness->open.dims()[a];
        l.cellOfVoxel = 1.0f / AmbientOcclusion::kCell;
        l.cellOfVoxelOffset = 0.5f / AmbientOcclusion::kCell - 0.5f;
    }

    /// A world direction in voxels; the world's gradient is along e what that in voxels is along inVoxels(e).
    Vec3 inVoxels(const Vec3& direction) const { return m_volume->geometry().indexFromWorld() * direction; }

    /// What tables and distances follow from.
    struct Prepared {
        TransferFunction tf;
        int onlyFeature = -1;
        bool surfaces = false;
        bool operator==(const Prepared&) const = default;
    };

    std::shared_ptr<const Volume> m_volume;
    CpuRenderOptions m_options;
    std::shared_ptr<const IntensityGrid> m_grid;
    RayBlocks m_blocks;
    ShearedPicture m_sheared;
    Prepared m_prepared; ///< of what follows
    std::optional<RayTable> m_table;
    std::vector<std::uint8_t> m_distances;
    std::vector<PacketScene::Feature> m_features;
    std::optional<AmbientOcclusion> m_openness;
    std::vector<float> m_specular;
};

} // namespace

std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options) {
    return std::make_unique<CpuRenderer>(std::move(volume), options);
}
std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume) {
    return makeCpuRenderer(std::move(volume), {});
}

} // namespace pellucid
