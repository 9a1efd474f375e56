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
#include "base/screen_pixel.h"
#include "render/cpu/ray_packets.h"
#include "render/cpu/ray_volume.h"
#include "render/cpu/sheared_picture.h"
#include "render/ground_raster.h"
#include "render/overlay.h"
#include "render/picture_layers.h"

namespace pellucid {

namespace {

constexpr int kTile = kTileRows;                  ///< pixels
constexpr float kFaintestHighlight = 1.0f / 4096; ///< less adds nothing to a pixel of eight bits

void copy(const Vec3& from, float (&to)[3]) {
    for (int a = 0; a < 3; ++a) to[a] = static_cast<float>(from[a]);
}
Vec3 vector(const Rgb& c) { return {c.r, c.g, c.b}; }

static_assert(int(PacketMode::Composite) == int(RenderMode::Composite) &&
              int(PacketMode::Mip) == int(RenderMode::Mip) && int(PacketMode::MinIp) == int(RenderMode::MinIp) &&
              int(PacketMode::Average) == int(RenderMode::Average) &&
              int(PacketMode::Surface) == int(RenderMode::Surface));
PacketMode packetMode(RenderMode mode) { return static_cast<PacketMode>(mode); }

/// Where pixels go, as floats: null where they go elsewhere.
struct PacketTarget {
    int width = 0, height = 0;
    float* rgba = nullptr;
};

class CpuRenderer final : public TileRenderer {
public:
    CpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options)
        : m_volume(std::move(volume)), m_options(options), m_rays(sharedIntensityGrid(*m_volume), m_volume->geometry()),
          m_sheared(m_rays.grid(), m_volume->geometry(), options.kernel) {}

    std::string name() const override { return "cpu"; }

    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        settings.validate();
        Image image(settings.width, settings.height);
        std::vector<ImagePart> tiles = tilesOf(image);
        const PictureBands& bands = m_options.bands;
        std::erase_if(tiles, [&](const ImagePart& t) { return t.y0 / kTile % bands.count != bands.first; });
        draw(camera, tf, settings, 1, image, tiles, {}, job);
        return image;
    }

    Image preview(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                  const JobControl& job) override {
        const PreviewSize size = checkedSize(settings, scale);
        Image image(size.width, size.height);
        const PacketTarget target{size.width, size.height, image.rgba.data()};
        if (!drawSheared(camera, tf, settings, scale, target, nullptr, job))
            draw(camera, tf, settings, scale, image, tilesOf(image), {}, job);
        return image;
    }

    void previewOnScreen(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                         std::uint32_t* pixels, const JobControl& job) override {
        PELLUCID_CHECK(settings.background);
        const PreviewSize size = checkedSize(settings, scale);
        if (drawSheared(camera, tf, settings, scale, {size.width, size.height, nullptr}, pixels, job)) return;
        Image image(size.width, size.height);
        draw(
            camera, tf, settings, scale, image, tilesOf(image),
            [&](const ImagePart& part) { toScreen(image, part, pixels); }, job);
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

    PictureLayers layers(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                         const JobControl& job) {
        PictureLayers result(settings.width, settings.height, tf.features.size());
        Seen seen;
        fillScenes(camera, tf, settings, 1, {settings.width, settings.height, result.picture.rgba.data()}, seen);
        m_rays.fillLight(camera, false, seen.first.light); // for normals, whatever the picture needs
        if (settings.light.occlusion > 0) m_rays.fillLight(camera, true, seen.first.light);
        const std::vector<std::array<float, 2>> entries = m_rays.entriesOfFeatures();
        std::vector<float*> planes;
        for (Image& layer : result.features) planes.push_back(layer.rgba.data());
        planes.push_back(result.rest.rgba.data());
        PacketLayers to;
        to.count = static_cast<int>(entries.size());
        to.entries = reinterpret_cast<const float(*)[2]>(entries.data());
        to.rgba = planes.data();
        to.depth = result.depth.values.data();
        to.normal = result.normals.data();
        to.eye = static_cast<float>(-raysOf(camera, settings, 1).middle);
        seen.first.layers = &to;
        drawTiles(seen.first, layerKernel(), tilesOf(result.picture), {}, job);
        return result;
    }

private:
    /// Of the volume that the picture is of, or of which it shows a part.
    const Geometry& whole() const { return m_options.blockOf ? *m_options.blockOf : m_volume->geometry(); }

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
        Seen seen;
        fillScenes(camera, tf, settings, scale, {image.width, image.height, image.rgba.data()}, seen);
        const GroundPicture ground = groundUnder(camera, settings, scale, image, job);
        if (!ground.depth.empty())
            for (PacketScene* scene : {&seen.first, &seen.second}) {
                scene->groundDepth = ground.depth.data();
                scene->ground = ground.rgba.data();
            }
        drawTiles(seen.first, packetKernels()[static_cast<std::size_t>(m_options.kernel)], tiles, done, job);
    }

    static void drawTiles(const PacketScene& scene, PacketKernel kernel, const std::vector<ImagePart>& tiles,
                          const std::function<void(const ImagePart&)>& done, const JobControl& job) {
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

    static PreviewSize checkedSize(const RenderSettings& settings, double scale) {
        PELLUCID_CHECK(scale > 0 && scale <= 1);
        settings.validate();
        return previewSize(settings, scale);
    }

    /// Into `pixels` or, where that is null, into the target. False where the picture cannot be drawn in storage order.
    bool drawSheared(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                     const PacketTarget& target, std::uint32_t* pixels, const JobControl& job) {
        const auto view = shearOf(camera, settings, scale);
        if (!view) return false;
        Seen seen;
        fillScenes(camera, tf, settings, scale, target, seen);
        m_sheared.draw(seen.first, camera, *view, pixels, job);
        return true;
    }

    std::optional<ShearView> shearOf(const Camera& camera, const RenderSettings& settings, double scale) const {
        if (!m_options.sheared || !ShearedPicture::canDraw(settings)) return {};
        camera.validate(m_volume->geometry(), "camera");
        ShearDensity density = m_options.density;
        density.closest /= scale; // else fewer pixels would take as many rays where voxels are larger than they
        return pellucid::shearOf(camera, m_volume->geometry(), settings.clipping, settings.width * scale,
                                 settings.height * scale, density);
    }

    /// All but the ground.
    struct Seen {
        PacketScene first, second; ///< of the volume, and of the overlay where there is one
    };
    void fillScenes(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, double scale,
                    const PacketTarget& target, Seen& seen) {
        camera.validate(m_volume->geometry(), "camera");
        settings.featureAlone(tf); // tells where there is none
        m_rays.prepare(tf, settings.onlyFeature, settings.mode == RenderMode::Surface);
        fillPicture(settings, target, seen.first);
        seen.first.mode = packetMode(settings.mode);
        fillColors(settings, seen.first);
        m_rays.fillFeatures(seen.first);
        prepareOverlay(settings.overlay);
        if (settings.overlay) {
            fillPicture(settings, target, seen.second);
            seen.first.overlay = &seen.second;
        }
        const PictureRays picture = raysOf(camera, settings, scale);
        const VoxelClipping clipping = clippingInVoxels(settings.clipping, m_volume->geometry());
        const std::vector<VoxelPlane> part = planesInVoxels(m_options.part, m_volume->geometry());
        const auto fill = [&](RayVolume& volume, PacketScene& scene) {
            volume.fillVolume(scene);
            volume.fillCamera(camera, picture, scene);
            volume.fillRegion(part, clipping, m_rays.geometry(), scene);
            fillLight(settings, scene.light);
            if (scene.light.any) volume.fillLight(camera, settings.light.occlusion > 0, scene.light);
        };
        fill(m_rays, seen.first);
        if (settings.overlay) fill(*m_overRays, seen.second);
    }

    /// Null: the last one is let go.
    void prepareOverlay(const std::shared_ptr<const Overlay>& overlay) {
        // Over one volume the same voxels lie in one place.
        const bool sameVoxels = overlay && m_overlay && m_overlay->volume == overlay->volume;
        m_overlay = overlay;
        if (!sameVoxels) m_overRays.reset();
        if (!overlay) return;
        if (!m_overRays) m_overRays.emplace(sharedIntensityGrid(*overlay->volume), overlay->geometry);
        m_overRays->prepare(overlay->tf, -1, false);
    }

    PictureRays raysOf(const Camera& camera, const RenderSettings& settings, double scale) const {
        const Geometry& g = whole();
        double shortest = g.d0(); // the finer of the two decides how long steps are
        if (settings.overlay) {
            const Vec3& spacing = settings.overlay->geometry.spacing;
            shortest = std::min({shortest, spacing.x, spacing.y, spacing.z});
        }
        PictureRays rays;
        rays.width = settings.width * scale;
        rays.height = settings.height * scale;
        rays.middle = glm::dot(g.boxCenter() - camera.eye, camera.forward());
        rays.step = settings.stepInD0 * shortest;
        rays.stepInD0 = rays.step / g.d0();
        return rays;
    }

    /// Empty where the picture has none.
    GroundPicture groundUnder(const Camera& camera, const RenderSettings& settings, double scale, const Image& image,
                              const JobControl& job) const {
        if (!showsGround(settings)) return {};
        return groundOf(settings, camera, m_volume->geometry(),
                        {settings.width * scale, settings.height * scale, 0, 0, image.width, image.height}, job);
    }

    void fillColors(const RenderSettings& settings, PacketScene& s) const {
        if (!settings.colors) return;
        PELLUCID_CHECK(settings.colors->dims == m_volume->dims() &&
                       settings.colors->rgba.size() == voxelCount(m_volume->dims()));
        s.voxelColors = settings.colors->rgba.data();
    }

    /// What does not depend on the volume, but for the mode.
    void fillPicture(const RenderSettings& settings, const PacketTarget& target, PacketScene& s) const {
        s.width = target.width;
        s.height = target.height;
        s.rgba = target.rgba;
        s.leap = m_options.leap;
        s.halvings = settings.halvings();
        s.jitter = settings.jitter;
        if (!settings.background || m_options.blockOf) return;
        s.hasBackground = true;
        copy(vector(*settings.background), s.background);
        copy(vector(settings.backgroundTop.value_or(*settings.background)), s.backgroundTop);
    }

    void fillLight(const RenderSettings& settings, PacketLight& l) {
        const Light& from = settings.light;
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
        const auto seen = std::upper_bound(m_specular.begin(), m_specular.end(), kFaintestHighlight);
        l.specularFrom = static_cast<float>(seen - m_specular.begin() - 1) / kSpecularEntries;
        const Geometry& g = whole();
        l.gradientOpacity = static_cast<float>(from.gradientOpacity);
        l.silhouettes = static_cast<float>(from.silhouettes);
        l.occlusion = static_cast<float>(from.occlusion);
        l.depthCue = static_cast<float>(from.depthCue);
        l.cueFrom = static_cast<float>(-g.radius()); // depths count from the middle of the box
        l.cuePerDepth = static_cast<float>(1 / (2 * g.radius()));
        if (settings.background) copy(vector(*settings.background), l.cueColor);
    }

    std::shared_ptr<const Volume> m_volume;
    CpuRenderOptions m_options;
    RayVolume m_rays;
    ShearedPicture m_sheared;
    std::shared_ptr<const Overlay> m_overlay; ///< the last one that was drawn
    std::optional<RayVolume> m_overRays;      ///< its voxels
    std::vector<float> m_specular;
};

} // namespace

void toScreen(const Image& from, const ImagePart& part, std::uint32_t* pixels) {
    for (int y = part.y0; y < part.y1; ++y) {
        const float* pixel = from.pixel(part.x0, y);
        std::uint32_t* line = pixels + static_cast<std::ptrdiff_t>(y) * from.width;
        for (int x = part.x0; x < part.x1; ++x, pixel += 4) line[x] = screenPixel(pixel);
    }
}

TileRenderer::PreviewSize TileRenderer::previewSize(const RenderSettings& settings, double scale) {
    const auto scaled = [scale](int pixels) { return static_cast<int>(std::ceil(pixels * scale - 1e-9)); };
    return {scaled(settings.width), scaled(settings.height)};
}

std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options) {
    return std::make_unique<CpuRenderer>(std::move(volume), options);
}
std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume) {
    return makeCpuRenderer(std::move(volume), {});
}

PictureLayers pictureLayers(std::shared_ptr<const Volume> volume, const Camera& camera, const TransferFunction& tf,
                            const RenderSettings& settings, const JobControl& job) {
    checkLayers(tf, settings);
    RenderSettings transparent = settings;
    transparent.background.reset();
    transparent.backgroundTop.reset();
    return CpuRenderer(std::move(volume), {}).layers(camera, tf, transparent, job);
}

} // namespace pellucid
