#include "render/gl/volume_raycaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "render/ambient_occlusion.h"
#include "render/box_in_image.h"
#include "render/cpu/ray_packets.h"
#include "render/gl/gl_resources.h"
#include "render/gl/picture_rays.h"
#include "render/gl/shader_program.h"
#include "render/gl/volume_bricks.h"
#include "render/gl/volume_texture.h"
#include "render/ground_raster.h"
#include "render/ray_blocks.h"
#include "tf/tf_table.h"

namespace pellucid::gl {

namespace {

constexpr int kTableSize = 16384;
/// Samples drawn at a time, at most: well under a second even where the CPU does the drawing, between two looks at
/// JobControl, and before a GPU's watchdog.
constexpr double kSamplesAtOnce = 8e6;
constexpr double kMostSteps = 1e6; ///< along one ray
constexpr double kSamplesPerHalved =
    8; ///< of a ray whose steps are halved where that matters, about, for one of another
constexpr std::size_t kMostSurfaces = 128;
constexpr double kMostGroundAtOnce = 4096 * 4096; ///< pixels: the ground of larger pictures is drawn tile by tile

glm::dvec3 vectorOf(const Rgb& c) { return {c.r, c.g, c.b}; }

/// composite.vert and raycast.frag, one permutation.
struct RaycastProgram : Program {
    explicit RaycastProgram(const std::vector<std::string>& defines)
        : Program({"composite.vert", "raycast.frag"}, defines) {}
};

/// Half as many cells along an axis: the means of two neighbours.
Grid<std::uint8_t> everySecond(const Grid<std::uint8_t>& cells, int axis) {
    Int3 dims = cells.dims();
    dims[axis] = (dims[axis] + 1) / 2;
    Grid<std::uint8_t> half(dims);
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                Int3 one(i, j, k);
                one[axis] *= 2;
                Int3 other = one;
                other[axis] = std::min(other[axis] + 1, cells.dims()[axis] - 1);
                half.at(i, j, k) = static_cast<std::uint8_t>(
                    (cells.at(one.x, one.y, one.z) + cells.at(other.x, other.y, other.z) + 1) / 2);
            }
    return half;
}

struct Tile {
    int x, y, width, height; ///< pixels of the picture, from its top left corner
};

Tile tileOf(const RenderSettings& settings, const DrawTarget& target) {
    Tile tile{target.tileX, target.tileY, target.tileWidth, target.tileHeight};
    if (tile.width == 0 && tile.height == 0) tile = {0, 0, settings.width, settings.height};
    PELLUCID_CHECK(tile.x >= 0 && tile.y >= 0 && tile.width > 0 && tile.height > 0 &&
                   tile.x + tile.width <= settings.width && tile.y + tile.height <= settings.height);
    return tile;
}

/// An interval of intensities [low, high) as codes/65535, as texels give them.
struct CodeInterval {
    double low, high;
};

/// A feature that mode Surface draws.
struct Surface {
    CodeInterval codes;
    double opacity;
    Rgb color;
};

CodeInterval codesOf(const Feature& feature, int maxCode) {
    // A hair lower, so that rounding in the texture unit leaves voxels that lie on a border on their side of it.
    constexpr double kHair = 0.01;
    const auto code = [&](double s) { return (s * maxCode - kHair) / 65535; };
    return {code(feature.a), feature.b >= 1 ? 2.0 : code(feature.b)};
}

/// The ground of a picture, or of a tile of it, kept as long as the same is drawn.
class GroundTextures {
public:
    /// `window`: the whole picture or a part of it.
    void prepare(const RenderSettings& settings, const Camera& camera, const Geometry& geometry,
                 const GroundWindow& window, const JobControl& job) {
        Drawn wanted{settings.ground,     camera, geometry.boxCenter(), geometry.radius(), settings.light.depthCue,
                     settings.background, window};
        if (m_drawn == wanted) return;
        m_drawn.reset();
        const GroundPicture picture = groundOf(settings, camera, geometry, window, job);
        const glm::ivec2 size(picture.width, picture.height);
        if (m_color.size != size) {
            m_color = makeTexture2d(size, GL_RGBA8, GL_LINEAR, "the ground");
            m_depth = makeTexture2d(size, GL_R32F, GL_NEAREST, "the depth of the ground");
        }
        upload(m_color, GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, picture.rgba.data(), "uploading the ground");
        upload(m_depth, GL_RED, GL_FLOAT, picture.depth.data(), "uploading the ground");
        m_drawn = std::move(wanted);
    }
    /// Where a point of the picture lies in it, both in pixels from the top left corner.
    glm::dvec2 at(const glm::dvec2& inPicture, const RenderSettings& settings) const {
        const GroundWindow& w = m_drawn->window;
        const glm::dvec2 scale =
            glm::dvec2(w.pictureWidth, w.pictureHeight) / glm::dvec2(settings.width, settings.height);
        return inPicture * scale - glm::dvec2(w.left, w.top);
    }
    glm::dvec2 size() const { return m_color.size; }
    const TextureName& color() const { return m_color.name; }
    const TextureName& depth() const { return m_depth.name; }
    void clear() { *this = {}; }

private:
    struct Drawn {
        std::shared_ptr<const Ground> ground;
        Camera camera;
        Vec3 center; // of the box: what depths count from
        double radius = 0, depthCue = 0;
        std::optional<Rgb> background;
        GroundWindow window;
        bool operator==(const Drawn&) const = default;
    };
    std::optional<Drawn> m_drawn;
    Texture2d m_color, m_depth;
};

/// In d0, so that the ends of a step lie in the texture of the brick that holds its middle.
double longestStepInBricks(const Geometry& g) {
    const Mat3 indexFromWorld = glm::transpose(g.indexFromWorld()); // its columns: voxels per world unit along an axis
    double most = 0;
    for (int a = 0; a < 3; ++a) most = std::max(most, glm::length(indexFromWorld[a]));
    return kBrickStep / (most * g.d0());
}

/// Leaves the state that VolumeRaycaster promises.
struct TidyAfterDrawing {
    unsigned framebuffer;
    ~TidyAfterDrawing() {
        glDisable(GL_SCISSOR_TEST);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glBindVertexArray(0);
        glUseProgram(0);
        for (const GLuint unit : {0u, 1u}) glBindImageTexture(unit, 0, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
        for (const GLenum unit : {6u, 5u, 4u, 3u, 2u, 1u, 0u}) {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D, 0);
            glBindTexture(GL_TEXTURE_3D, 0);
        }
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    }
};

} // namespace

struct VolumeRaycaster::Impl {
    Program composite{{"composite.vert", "composite.frag"}};
    Permutations<RaycastProgram> programs;
    VertexArrayName emptyArray = VertexArrayName::make();
    ColorTarget accumulated; ///< what raycast.frag calls u_state
    Texture2d seen;          ///< u_seen; of the same size, made only for surfaces in bricks

    std::shared_ptr<const Volume> volume;
    int longestTexture = 1 << 30; ///< as setVolume() was told
    std::unique_ptr<BrickedVolume> bricks;
    GroundTextures ground;
    std::unique_ptr<RayBlocks> blocks;
    Texture3d distances;                     ///< of the blocks, to the next that is drawn
    std::optional<bool> distancesToSurfaces; ///< what they were made for: surfaces or opacity; empty: out of date
    std::optional<TransferFunction> tf;
    TableTexture table, surfaces;
    std::vector<int> opaqueBefore;   ///< number of opaque entries of the table before each
    std::vector<Surface> drawn;      ///< in `surfaces`: by their intervals
    Texture3d openness;              ///< of AmbientOcclusion
    Int3 opennessCells{1};           ///< cells of AmbientOcclusion per texel
    bool opennessIsMade = false;     ///< for the tables' transfer function
    std::optional<int> tableFeature; ///< onlyFeature that the tables were made for; empty: they are out of date

    const Program& program(const RenderSettings& settings) {
        std::vector<std::string> defines{"MODE " + std::to_string(static_cast<int>(settings.mode)),
                                         "BLOCK_SHIFT " + std::to_string(kRayBlockShift)};
        if (bricks->hasInvalid()) defines.emplace_back("HAS_INVALID");
        if (bricks->count() > 1) defines.emplace_back("BRICKS");
        if (showsGround(settings)) defines.emplace_back("GROUND");
        if (settings.halvings() > 0) defines.emplace_back("HALVES");
        if (settings.drawsFaint()) defines.emplace_back("FAINT");
        if (isColored(settings.mode) && settings.colors) defines.emplace_back("VOXEL_COLORS");
        if (isColored(settings.mode) && settings.light.changesColors()) {
            defines.emplace_back("LIGHT");
            if (settings.light.gradientOpacity > 0) defines.emplace_back("GRADIENT_OPACITY");
            if (settings.light.occlusion > 0) defines.emplace_back("OCCLUSION");
        }
        return programs.of(defines);
    }

    /// Colours lie beside the intensities: with the first, and after the last, those go up again.
    void fillColors(const RenderSettings& settings) {
        if (!isColored(settings.mode)) return;
        if (settings.colors)
            PELLUCID_CHECK(settings.colors->dims == volume->dims() &&
                           settings.colors->rgba.size() == voxelCount(volume->dims()));
        const bool colored = settings.colors != nullptr;
        if (bricks->isColored() != colored) bricks = std::make_unique<BrickedVolume>(*volume, longestTexture, colored);
        if (colored) bricks->setColors(settings.colors);
    }

    /// In one piece for all tiles of a picture, unless it is large or drawn at a lower resolution.
    void fillGround(const Camera& camera, const RenderSettings& settings, const Tile& tile, double scale,
                    const JobControl& job) {
        if (!settings.ground) ground.clear();
        if (!showsGround(settings)) return;
        const double width = settings.width, height = settings.height;
        GroundWindow window{width, height, 0, 0, settings.width, settings.height};
        if (scale != 1 || width * height > kMostGroundAtOnce) {
            const glm::dvec2 size(accumulated.color.size), perPixel = size / glm::dvec2(tile.width, tile.height);
            window = {width * perPixel.x,       height * perPixel.y,      tile.x * perPixel.x,    tile.y * perPixel.y,
                      accumulated.color.size.x, accumulated.color.size.y, perPixel.y / perPixel.x};
        }
        ground.prepare(settings, camera, volume->geometry(), window, job);
    }

    void fillTables(const RenderSettings& settings) {
        if (tableFeature != settings.onlyFeature) fillTable(settings);
        if (isColored(settings.mode)) fillDistances(settings.mode == RenderMode::Surface);
        if (settings.light.occlusion > 0 && !opennessIsMade) fillOpenness(settings);
    }

    /// (τ·rgb, τ) per entry, then their running integral (shaders/include/tf_segment.glsl); a feature alone leaves the
    /// other intensities transparent.
    void fillTable(const RenderSettings& settings) {
        const Feature* const only = settings.featureAlone(*tf);
        const TfTable made = makeTfTable(*tf, kTableSize);
        std::vector<float> values(static_cast<std::size_t>(8 * kTableSize));
        glm::dvec4 integral(0), before(0);
        opaqueBefore.assign(static_cast<std::size_t>(kTableSize + 1), 0);
        for (std::size_t i = 0; i < made.rgba.size(); ++i) {
            const double s = static_cast<double>(i) / (kTableSize - 1);
            const bool isDrawn = only == nullptr || only->contains(s);
            const double tau = isDrawn ? static_cast<double>(made.opticalDepth[i]) : 0.0;
            const auto& c = made.rgba[i];
            const glm::dvec4 entry(tau * Vec3(c[0], c[1], c[2]), tau);
            if (i > 0) integral += 0.5 * (before + entry);
            before = entry;
            opaqueBefore[i + 1] = opaqueBefore[i] + (tau > 0 ? 1 : 0);
            for (int k = 0; k < 4; ++k) {
                values[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(entry[k]);
                values[4 * (kTableSize + i) + static_cast<std::size_t>(k)] = static_cast<float>(integral[k]);
            }
        }
        tableFeature.reset();
        distancesToSurfaces.reset();
        opennessIsMade = false;
        table.fill(std::move(values));
        fillSurfaces(only);
        tableFeature = settings.onlyFeature;
    }

    /// The features that mode Surface draws, by their intervals.
    void fillSurfaces(const Feature* only) {
        drawn.clear();
        const std::vector<double> opacities = featureOpacities(*tf);
        for (std::size_t f = 0; f < tf->features.size(); ++f) {
            const Feature& feature = tf->features[f];
            if (opacities[f] > 0 && feature.a < feature.b && (only == nullptr || only == &feature))
                drawn.push_back({codesOf(feature, bricks->maxCode()), opacities[f], feature.color});
        }
        std::ranges::sort(drawn, {}, [](const Surface& s) { return s.codes.low; });
        std::vector<float> values;
        for (const Surface& s : drawn)
            for (const double v : {s.codes.low, s.codes.high, s.opacity, 0.0, s.color.r, s.color.g, s.color.b, 0.0})
                values.push_back(static_cast<float>(v));
        if (drawn.empty()) values.resize(4); // no texture is empty
        surfaces.fill(std::move(values));
    }

    /// Blocks that rays leap over.
    void fillDistances(bool toSurfaces) {
        if (distancesToSurfaces == toSurfaces) return;
        distancesToSurfaces.reset();
        const double entriesPerCode = static_cast<double>(kTableSize - 1) / bricks->maxCode();
        const auto isOpaque = [&](int low, int high) {
            // An entry more on both sides: the device rounds in its own way.
            const int first = std::max(0, static_cast<int>(low * entriesPerCode) - 1),
                      end = std::min(kTableSize, static_cast<int>(high * entriesPerCode) + 3);
            return opaqueBefore[static_cast<std::size_t>(end)] != opaqueBefore[static_cast<std::size_t>(first)];
        };
        const auto isSurface = [&](int low, int high) {
            return std::ranges::any_of(drawn, [&](const Surface& s) {
                return (high + 1) / 65535.0 >= s.codes.low && (low - 1) / 65535.0 < s.codes.high;
            });
        };
        std::vector<std::uint8_t> blockDistances =
            toSurfaces ? blocks->distances(isSurface) : blocks->distances(isOpaque);
        Int3 size = blocks->dims();
        if (std::max({size.x, size.y, size.z}) > glInteger(GL_MAX_3D_TEXTURE_SIZE)) {
            size = Int3(1); // longer than any texture: nothing is leapt over
            blockDistances = {0};
        }
        if (distances.size != size) distances = makeTexture3d(size, GL_R8UI, GL_NEAREST, "the map of empty space");
        upload(distances, GL_RED_INTEGER, GL_UNSIGNED_BYTE, blockDistances.data(), "uploading a map of the volume");
        distancesToSurfaces = toSurfaces;
    }

    void fillOpenness(const RenderSettings& settings) {
        const AmbientOcclusion occlusion =
            makeAmbientOcclusion(*sharedIntensityGrid(*volume), volume->geometry(), *tf, settings.featureAlone(*tf));
        Grid<std::uint8_t> open = occlusion.open;
        opennessCells = Int3(1);
        const int longest = glInteger(GL_MAX_3D_TEXTURE_SIZE);
        for (int axis = 0; axis < 3; ++axis)
            while (open.dims()[axis] > longest) { // longer than any texture: coarser along that axis
                open = everySecond(open, axis);
                opennessCells[axis] *= 2;
            }
        const Int3 size = open.dims();
        if (openness.size != size) openness = makeTexture3d(size, GL_R8, GL_LINEAR, "ambient occlusion");
        upload(openness, GL_RED, GL_UNSIGNED_BYTE, open.data(), "uploading a map of the volume");
        opennessIsMade = true;
    }

    void resize(glm::ivec2 size) {
        if (accumulated.color.size == size) return;
        seen = {};
        accumulated = makeColorTarget(size, GL_RGBA32F, GL_LINEAR, "the picture");
    }

    /// At the locations that are written in the shaders; comments say what they are called there.
    void setUniforms(const Program& p, const Camera& camera, const RenderSettings& settings, const Tile& tile) {
        const Geometry& g = volume->geometry();
        const glm::vec2 size(accumulated.color.size), picture(settings.width, settings.height);
        // The tile in picture coordinates: [−1,1]² over the whole picture, y up.
        const glm::vec2 tileSize = 2.0f * glm::vec2(tile.width, tile.height) / picture;
        const glm::vec2 tileLow(2.0f * static_cast<float>(tile.x) / picture.x - 1.0f,
                                1.0f - 2.0f * static_cast<float>(tile.y + tile.height) / picture.y);
        p.set(1, glm::dvec4(tileSize / size, tileLow)); // u_pictureFromFragment
        const PictureRays rays(camera, g, static_cast<double>(settings.width) / settings.height);
        p.set(2, rays.origin);
        p.set(3, rays.direction);
        p.set(4, rays.tangents);
        p.set(8, rays.nearest);

        const int halvings = settings.halvings();
        double step = settings.stepInD0;
        if (bricks->count() > 1) step = std::min(step, longestStepInBricks(g));
        if (!(2 * g.radius() / (step * g.d0()) <= kMostSteps))
            throw Error("the picture needs over a million samples along a ray", "step", "make the step longer");
        p.set(5, glm::dvec2(step * g.d0(), step));
        if (halvings > 0) p.set(36, Vec3(std::ldexp(1.0, 1 - halvings), kHalvingTolerance, kLightTurn)); // u_halves
        const Vec3 dims(g.dims);
        BoxPart oblique;
        oblique.planes = settings.clipping.planes;
        std::vector<VoxelPlane> planes = planesInVoxels(oblique, g);
        const std::vector<VoxelPlane> faint = planesInVoxels(settings.clipping.rest.within, g);
        if (settings.drawsFaint()) {
            p.setPlanes(40, 41, faint);
            p.set(53, settings.clipping.rest.density); // u_faintDensity
        } else {
            planes.insert(planes.end(), faint.begin(), faint.end());
        }
        p.set(6, settings.clipping.lo * dims - 0.5); // the region that is drawn, voxels
        p.set(7, settings.clipping.hi * dims - 0.5);
        p.setPlanes(9, 54, planes);
        p.set(10, glm::dvec2(settings.jitter ? picture : glm::vec2(0))); // u_jitter
        p.set(21, dims - 1.0);                                           // u_lastVoxel
        p.set(11, distances.size - 1);                                   // u_lastBlock

        const double codes = 65535.0 / bricks->maxCode(); // intensity of code/65535 = 1
        if (settings.mode == RenderMode::Composite) {
            p.set(0, codes * (kTableSize - 1)); // entries of the table per code
            p.set(12, kTableSize);              // u_integralStart
        } else if (settings.mode == RenderMode::Surface) {
            p.set(18, static_cast<int>(drawn.size())); // u_featureCount
        } else {
            const Feature* const only = settings.featureAlone(*tf);
            const CodeInterval shown = only != nullptr ? codesOf(*only, bricks->maxCode()) : CodeInterval{-1, 2};
            p.set(18, glm::dvec2(shown.low, shown.high)); // u_shown
            p.set(19, codes);                             // u_intensityPerCode
            return;
        }
        const Light& light = settings.light;
        if (!light.changesColors()) return;
        // Central differences over two voxels; the world's gradient is A⁻ᵀ times that along the grid.
        const Mat3 cameraFromWorld = glm::transpose(Mat3(camera.right(), camera.trueUp(), -camera.forward()));
        p.set(22,
              cameraFromWorld * glm::transpose(g.indexFromWorld()) * (0.5 * codes * g.d0())); // u_cameraFromGradient
        const glm::dvec4 none(1, 0, 0, 1);
        p.set(23,
              light.on ? glm::dvec4(light.ambient, light.diffuse, light.specular, light.shininess) : none); // u_parts
        p.set(24, glm::normalize(light.direction));                                                         // u_toLight
        p.set(25, glm::dvec4(light.gradientOpacity, light.silhouettes, light.occlusion, light.depthCue)); // u_strengths
        if (light.occlusion > 0) {
            constexpr double kCell = AmbientOcclusion::kCell;
            const Vec3 cells(openness.size);
            const Vec3 voxels = kCell * Vec3(opennessCells); // of a texel
            p.set(28, 1.0 / (voxels * cells));               // u_opennessFromVoxel, and the offset
            p.set(29, (0.5 - 0.5 * (voxels - 1.0) / voxels) / cells);
        }
        p.set(26, vectorOf(settings.background.value_or(Rgb{}))); // u_cueColor
        p.set(27, glm::dvec2(0.5 / g.radius(), 0.5));             // u_cue
    }

    void cast(const Camera& camera, const RenderSettings& settings, const Tile& tile, const JobControl& job) {
        const bool bricked = bricks->count() > 1, surface = settings.mode == RenderMode::Surface;
        if (surface && drawn.size() > kMostSurfaces)
            throw Error("surfaces of " + std::to_string(drawn.size()) + " features are too many", "transfer function",
                        "the gl renderer draws " + std::to_string(kMostSurfaces), Remedy::OtherEngine);
        const glm::ivec2 size = accumulated.color.size;
        const Program& p = program(settings);
        setUniforms(p, camera, settings, tile);
        if (showsGround(settings)) {
            const glm::dvec2 bottomLeft = ground.at({tile.x, tile.y + tile.height}, settings);
            p.set(20, glm::ivec2(glm::round(bottomLeft)) - glm::ivec2(0, 1)); // u_groundOrigin
        }

        glBindFramebuffer(GL_FRAMEBUFFER, accumulated.framebuffer.id());
        glViewport(0, 0, size.x, size.y);
        const std::array<float, 4> nothing{};
        glClearBufferfv(GL_COLOR, 0, nothing.data());
        if (surface && bricked) {
            if (seen.size != size) seen = makeTexture2d(size, GL_RGBA32UI, GL_NEAREST, "the surfaces that were met");
            const std::vector<std::uint32_t> none(4 * static_cast<std::size_t>(size.x) *
                                                  static_cast<std::size_t>(size.y));
            upload(seen, GL_RGBA_INTEGER, GL_UNSIGNED_INT, none.data(), "clearing the surfaces that were met");
            glBindImageTexture(1, seen.name.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32UI);
        }
        glBindImageTexture(0, accumulated.color.name.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE); // the shader writes into the image itself

        // Only where the box is, and rows of a bounded number of samples at a time.
        const Geometry& g = volume->geometry();
        const BoxInImage box = boxInImage(camera, g, settings.width, settings.height);
        const glm::dvec2 scale = glm::dvec2(size) / glm::dvec2(tile.width, tile.height);
        const auto within = [](double v, int limit) { return static_cast<int>(std::clamp<double>(v, 0, limit)); };
        const int left = within(std::floor((box.x - tile.x) * scale.x), size.x),
                  right = within(std::ceil((box.x + box.width - tile.x) * scale.x), size.x),
                  bottom = within(std::floor((tile.y + tile.height - box.y - box.height) * scale.y), size.y),
                  top = within(std::ceil((tile.y + tile.height - box.y) * scale.y), size.y);
        if (right > left && top > bottom) {
            glEnable(GL_SCISSOR_TEST);
            glBindVertexArray(emptyArray.id());
            p.use();
            const double samplesPerRow = (right - left) * std::max(1.0, box.depthInD0 / settings.stepInD0) *
                                         (settings.halvings() > 0 ? kSamplesPerHalved : 1);
            const int rows = std::clamp(static_cast<int>(kSamplesAtOnce / samplesPerRow), 1, top - bottom);
            const auto order = bricks->frontToBack(camera);
            for (std::size_t i = 0; i < order.size(); ++i) {
                const JobControl part = job.part(i, order.size());
                const VolumeBrick& brick = bricks->use(order[i]);
                p.set(15, brick.textureFromVoxel);
                p.set(16, brick.textureOffset);
                if (bricked) {
                    p.set(13, brick.lo);
                    p.set(14, brick.hi);
                    p.set(17, brick.textureEnd);
                }
                if (showsGround(settings)) bindTexture(6, GL_TEXTURE_2D, ground.depth());
                bindTexture(4, GL_TEXTURE_2D, surfaces.name());
                if (openness.name) bindTexture(3, GL_TEXTURE_3D, openness.name);
                bindTexture(2, GL_TEXTURE_3D, distances.name);
                bindTexture(1, GL_TEXTURE_2D, table.name());
                for (int row = bottom; row < top; row += rows) {
                    job.throwIfStopped();
                    glScissor(left, row, right - left, std::min(rows, top - row));
                    glDrawArrays(GL_TRIANGLES, 0, 3);
                    // Without waiting the driver would queue everything, and nobody could cancel.
                    if (job.stop.stop_possible() || job.progress) {
                        glFinish();
                        part.report(static_cast<double>(std::min(row + rows, top) - bottom) / (top - bottom));
                    }
                }
                glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); // the next brick goes on from there
            }
        }
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
        throwOnGlError("casting the rays");
    }

    void drawComposite(const RenderSettings& settings, const DrawTarget& target, const Tile& tile) {
        glDisable(GL_SCISSOR_TEST);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        glViewport(target.x, target.y, tile.width, tile.height);
        composite.use();
        const Rgb bottom = settings.background.value_or(Rgb{});
        const Rgb top = settings.background ? settings.backgroundTop.value_or(bottom) : bottom;
        composite.set(0, glm::dvec4(vectorOf(bottom), settings.background ? 1 : 0)); // u_background
        composite.set(3, vectorOf(top));
        composite.set(2, !isColored(settings.mode)); // u_isGrey
        const glm::vec2 scale = 1.0f / glm::vec2(tile.width, tile.height);
        composite.set(1, glm::dvec4(scale, -glm::vec2(target.x, target.y) * scale)); // u_textureFromFragment
        const float rowsBelow = static_cast<float>(settings.height - tile.y - tile.height - target.y);
        composite.set(
            4, glm::dvec2(glm::vec2(1, rowsBelow) / static_cast<float>(settings.height))); // u_heightFromFragment
        composite.set(5, showsGround(settings));                                           // u_hasGround
        if (showsGround(settings)) {
            // Fragments go up, the ground's rows down.
            const glm::dvec2 corner(tile.x - target.x, tile.y + tile.height + target.y);
            const glm::dvec2 from = ground.at(corner, settings) / ground.size(),
                             next = ground.at(corner + glm::dvec2(1, -1), settings) / ground.size();
            composite.set(6, glm::dvec4(next - from, from)); // u_groundFromFragment
            bindTexture(1, GL_TEXTURE_2D, ground.color());
        }
        bindTexture(0, GL_TEXTURE_2D, accumulated.color.name);
        glBindVertexArray(emptyArray.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        throwOnGlError("drawing the picture");
    }
};

VolumeRaycaster::VolumeRaycaster() {
    requireGl43();
    m_impl = std::make_unique<Impl>();
}
VolumeRaycaster::~VolumeRaycaster() = default;

void VolumeRaycaster::setVolume(std::shared_ptr<const Volume> volume, int longestTexture) {
    auto blocks = std::make_unique<RayBlocks>(*sharedIntensityGrid(*volume));
    // The next frame of what had colours has some, too.
    const bool colored = m_impl->bricks && m_impl->bricks->isColored();
    m_impl->bricks = std::make_unique<BrickedVolume>(*volume, longestTexture, colored);
    m_impl->longestTexture = longestTexture;
    m_impl->blocks = std::move(blocks);
    m_impl->volume = std::move(volume);
    m_impl->tableFeature.reset(); // in the former volume's codes
}

void VolumeRaycaster::setTransferFunction(const TransferFunction& tf) {
    if (m_impl->tf == tf) return;
    m_impl->tf = tf;
    m_impl->tableFeature.reset();
}

void VolumeRaycaster::draw(const Camera& camera, const RenderSettings& settings, const DrawTarget& target,
                           const JobControl& job) {
    PELLUCID_CHECK(m_impl->volume && m_impl->tf);
    PELLUCID_CHECK(target.resolutionScale > 0 && target.resolutionScale <= 1);
    settings.validate();
    if (settings.overlay) throw UsageError("OpenGL draws no overlay", "engine gl", "draw it by the cpu engine");
    camera.validate(m_impl->volume->geometry(), "camera");
    const Tile tile = tileOf(settings, target);
    throwOnGlError("preparing to draw");
    m_impl->fillColors(settings);
    m_impl->fillTables(settings);

    const auto scaled = [&](int pixels) {
        return std::max(1, static_cast<int>(std::ceil(pixels * target.resolutionScale)));
    };
    const glm::ivec2 size(scaled(tile.width), scaled(tile.height));
    m_impl->resize(size);
    m_impl->fillGround(camera, settings, tile, target.resolutionScale, job);

    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_STENCIL_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_BLEND);
    const TidyAfterDrawing tidy{target.framebuffer};
    m_impl->cast(camera, settings, tile, job);
    m_impl->drawComposite(settings, target, tile);
}

} // namespace pellucid::gl
