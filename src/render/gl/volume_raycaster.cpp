#include "render/gl/volume_raycaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "render/ambient_occlusion.h"
#include "render/box_in_image.h"
#include "render/cpu/ray_blocks.h"
#include "render/cpu/ray_packets.h"
#include "render/gl/gl_resources.h"
#include "render/gl/picture_rays.h"
#include "render/gl/shader_program.h"
#include "render/gl/volume_bricks.h"
#include "render/gl/volume_texture.h"
#include "render/ground_raster.h"
#include "tf/tf_table.h"

namespace pellucid::gl {

namespace {

constexpr int kTableSize = 16384;
/// Samples drawn at a time, at most: well under a second even where the CPU does the drawing, between two looks at
/// JobControl, and before a GPU's watchdog.
constexpr double kSamplesAtOnce = 8e6;
constexpr double kMostSteps = 1e6; ///< along one ray
constexpr std::size_t kMostSurfaces = 128;
constexpr double kMostGroundAtOnce = 4096 * 4096; ///< pixels: the ground of larger pictures is drawn tile by tile

using glm::value_ptr;

/// composite.vert and raycast.frag, one permutation; locations are those written there.
class RaycastProgram {
public:
    explicit RaycastProgram(const std::vector<std::string>& defines)
        : m_program(makeProgram({"composite.vert", "raycast.frag"}, defines)), m_id(m_program.id()) {}

    void use() const { glUseProgram(m_id); }
    void setPictureFromFragment(const glm::vec4& v) const { glProgramUniform4fv(m_id, 1, 1, value_ptr(v)); }
    void setRays(const PictureRays& rays) const {
        setMatrix(2, rays.origin);
        setMatrix(3, rays.direction);
        const glm::vec2 tangents(rays.tangents);
        glProgramUniform2fv(m_id, 4, 1, value_ptr(tangents));
        glProgramUniform1f(m_id, 8, static_cast<float>(rays.nearest));
    }
    void setStep(double inD0, double d0) const {
        glProgramUniform2f(m_id, 5, static_cast<float>(inD0 * d0), static_cast<float>(inD0));
    }
    void setRegion(const Vec3& lo, const Vec3& hi, const std::vector<VoxelPlane>& planes) const {
        setVector(6, lo);
        setVector(7, hi);
        glProgramUniform1i(m_id, 9, static_cast<int>(planes.size()));
        std::vector<glm::vec4> packed;
        for (const VoxelPlane& plane : planes) packed.emplace_back(plane.normal, plane.offset);
        if (!packed.empty())
            glProgramUniform4fv(m_id, 30, static_cast<GLsizei>(packed.size()), value_ptr(packed.front()));
    }
    /// Size of the picture, pixels; 0: no jitter.
    void setJitter(const glm::vec2& size) const { glProgramUniform2fv(m_id, 10, 1, value_ptr(size)); }
    void setBrick(const VolumeBrick& b, bool oneOfSeveral) const {
        setVector(15, b.textureFromVoxel);
        setVector(16, b.textureOffset);
        if (!oneOfSeveral) return;
        setVector(13, b.lo);
        setVector(14, b.hi);
        setVector(17, b.textureEnd);
    }
    void setBlocks(const Int3& lastVoxel, const Int3& lastBlock) const {
        setVector(21, Vec3(lastVoxel));
        glProgramUniform3i(m_id, 11, lastBlock.x, lastBlock.y, lastBlock.z);
    }
    void setTable(double entriesPerCode, int integralStart) const {
        glProgramUniform1f(m_id, 0, static_cast<float>(entriesPerCode));
        glProgramUniform1i(m_id, 12, integralStart);
    }
    void setFeatureCount(int count) const { glProgramUniform1i(m_id, 18, count); }
    void setShown(double low, double high, double intensityPerCode) const {
        glProgramUniform2f(m_id, 18, static_cast<float>(low), static_cast<float>(high));
        glProgramUniform1f(m_id, 19, static_cast<float>(intensityPerCode));
    }
    void setLight(const Light& light, const Mat3& cameraFromGradient) const {
        setMatrix(22, cameraFromGradient);
        const glm::vec4 none(1, 0, 0, 1);
        const glm::vec4 parts(light.ambient, light.diffuse, light.specular, light.shininess);
        glProgramUniform4fv(m_id, 23, 1, value_ptr(light.on ? parts : none));
        setVector(24, glm::normalize(light.direction));
        const glm::vec4 strengths(light.gradientOpacity, light.silhouettes, light.occlusion, light.depthCue);
        glProgramUniform4fv(m_id, 25, 1, value_ptr(strengths));
    }
    void setOpenness(const Vec3& textureFromVoxel, const Vec3& offset) const {
        setVector(28, textureFromVoxel);
        setVector(29, offset);
    }
    void setGroundOrigin(const glm::ivec2& texel) const { glProgramUniform2iv(m_id, 20, 1, value_ptr(texel)); }
    void setDepthCue(const Rgb& color, double perDepth, double offset) const {
        setVector(26, {color.r, color.g, color.b});
        glProgramUniform2f(m_id, 27, static_cast<float>(perDepth), static_cast<float>(offset));
    }

private:
    void setVector(GLint location, const Vec3& v) const {
        const glm::vec3 single(v);
        glProgramUniform3fv(m_id, location, 1, value_ptr(single));
    }
    void setMatrix(GLint location, const Mat3& m) const {
        const glm::mat3 single(m);
        glProgramUniformMatrix3fv(m_id, location, 1, GL_FALSE, value_ptr(single));
    }
    ProgramName m_program;
    GLuint m_id;
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

/// composite.vert and composite.frag.
class CompositeProgram {
public:
    CompositeProgram() : m_program(makeProgram({"composite.vert", "composite.frag"})), m_id(m_program.id()) {}
    void use() const { glUseProgram(m_id); }
    void setBackground(const glm::vec4& bottom, const glm::vec3& top) const {
        glProgramUniform4fv(m_id, 0, 1, value_ptr(bottom));
        glProgramUniform3fv(m_id, 3, 1, value_ptr(top));
    }
    void setTextureFromFragment(const glm::vec4& v) const { glProgramUniform4fv(m_id, 1, 1, value_ptr(v)); }
    void setHeightFromFragment(const glm::vec2& v) const { glProgramUniform2fv(m_id, 4, 1, value_ptr(v)); }
    void setIsGrey(bool grey) const { glProgramUniform1i(m_id, 2, grey ? 1 : 0); }
    void setHasGround(bool has) const { glProgramUniform1i(m_id, 5, has ? 1 : 0); }
    void setGroundFromFragment(const glm::vec4& v) const { glProgramUniform4fv(m_id, 6, 1, value_ptr(v)); }

private:
    ProgramName m_program;
    GLuint m_id;
};

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
        upload(m_color, GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, picture.rgba.data());
        upload(m_depth, GL_RED, GL_FLOAT, picture.depth.data());
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
    static void upload(const Texture2d& texture, GLenum format, GLenum type, const void* pixels) {
        glBindTexture(GL_TEXTURE_2D, texture.name.id());
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, texture.size.x, texture.size.y, format, type, pixels);
        glBindTexture(GL_TEXTURE_2D, 0);
        throwOnGlError("uploading the ground");
    }
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

/// A byte per texel, x fastest.
void uploadBytes(const Texture3d& texture, const std::uint8_t* bytes, GLenum format) {
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, texture.size.x, texture.size.y, texture.size.z, format, GL_UNSIGNED_BYTE,
                    bytes);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("uploading a map of the volume");
}

/// By the transfer function; else the modes are grey.
bool isColored(RenderMode mode) { return mode == RenderMode::Composite || mode == RenderMode::Surface; }

/// Whether light changes anything that is drawn.
bool changesColors(const Light& light) {
    return light.on || light.gradientOpacity > 0 || light.occlusion > 0 || light.depthCue > 0 || light.silhouettes > 0;
}

glm::vec3 vec3Of(const Rgb& c) { return {c.r, c.g, c.b}; }

} // namespace

struct VolumeRaycaster::Impl {
    CompositeProgram composite;
    std::map<std::vector<std::string>, RaycastProgram> programs; ///< by their defines; compiled when first needed
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

    const RaycastProgram& program(const RenderSettings& settings) {
        std::vector<std::string> defines{"MODE " + std::to_string(static_cast<int>(settings.mode)),
                                         "BLOCK_SHIFT " + std::to_string(kRayBlockShift)};
        if (bricks->hasInvalid()) defines.emplace_back("HAS_INVALID");
        if (bricks->count() > 1) defines.emplace_back("BRICKS");
        if (showsGround(settings)) defines.emplace_back("GROUND");
        if (isColored(settings.mode) && settings.colors) defines.emplace_back("VOXEL_COLORS");
        if (isColored(settings.mode) && changesColors(settings.light)) {
            defines.emplace_back("LIGHT");
            if (settings.light.gradientOpacity > 0) defines.emplace_back("GRADIENT_OPACITY");
            if (settings.light.occlusion > 0) defines.emplace_back("OCCLUSION");
        }
        const auto found = programs.find(defines);
        return found != programs.end() ? found->second
                                       : programs.emplace(defines, RaycastProgram(defines)).first->second;
    }

    void fillColors(const RenderSettings& settings);
    void fillGround(const Camera& camera, const RenderSettings& settings, const Tile& tile, double scale,
                    const JobControl& job);
    void fillTables(const RenderSettings& settings);
    void fillTable(const RenderSettings& settings);
    void fillSurfaces(const Feature* only);
    void fillDistances(bool toSurfaces);
    void fillOpenness(const RenderSettings& settings);
    void resize(glm::ivec2 size);
    void setUniforms(const RaycastProgram& p, const Camera& camera, const RenderSettings& settings, const Tile& tile);
    void cast(const Camera& camera, const RenderSettings& settings, const Tile& tile, const JobControl& job);
    void drawComposite(const RenderSettings& settings, const DrawTarget& target, const Tile& tile);
};

/// Colours lie beside the intensities: with the first, and after the last, those go up again.
void VolumeRaycaster::Impl::fillColors(const RenderSettings& settings) {
    if (!isColored(settings.mode)) return;
    if (settings.colors)
        PELLUCID_CHECK(settings.colors->dims == volume->dims() &&
                       settings.colors->rgba.size() == voxelCount(volume->dims()));
    const bool colored = settings.colors != nullptr;
    if (bricks->isColored() != colored) bricks = std::make_unique<BrickedVolume>(*volume, longestTexture, colored);
    if (colored) bricks->setColors(settings.colors);
}

/// In one piece for all tiles of a picture, unless it is large or drawn at a lower resolution.
void VolumeRaycaster::Impl::fillGround(const Camera& camera, const RenderSettings& settings, const Tile& tile,
                                       double scale, const JobControl& job) {
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

void VolumeRaycaster::Impl::fillTables(const RenderSettings& settings) {
    if (tableFeature != settings.onlyFeature) fillTable(settings);
    if (isColored(settings.mode)) fillDistances(settings.mode == RenderMode::Surface);
    if (settings.light.occlusion > 0 && !opennessIsMade) fillOpenness(settings);
}

/// (τ·rgb, τ) per entry, then their running integral (shaders/include/tf_segment.glsl); a feature alone leaves the
/// other intensities transparent.
void VolumeRaycaster::Impl::fillTable(const RenderSettings& settings) {
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
    table.fill(values, 4);
    fillSurfaces(only);
    tableFeature = settings.onlyFeature;
}

/// The features that mode Surface draws, by their intervals.
void VolumeRaycaster::Impl::fillSurfaces(const Feature* only) {
    drawn.clear();
    const std::vector<double> opacities = featureOpacities(*tf);
    for (std::size_t f = 0; f < tf->features.size(); ++f) {
        const Feature& feature = tf->features[f];
        if (opacities[f] > 0 && feature.a < feature.b && (only == nullptr || only == &feature))
            drawn.push_back({codesOf(feature, bricks->maxCode()), opacities[f], feature.color});
    }
    std::sort(drawn.begin(), drawn.end(), [](const Surface& a, const Surface& b) { return a.codes.low < b.codes.low; });
    std::vector<float> values;
    for (const Surface& s : drawn)
        for (const double v : {s.codes.low, s.codes.high, s.opacity, 0.0, s.color.r, s.color.g, s.color.b, 0.0})
            values.push_back(static_cast<float>(v));
    if (drawn.empty()) values.resize(4); // no texture is empty
    surfaces.fill(values, 4);
}

/// Blocks that rays leap over.
void VolumeRaycaster::Impl::fillDistances(bool toSurfaces) {
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
        return std::any_of(drawn.begin(), drawn.end(), [&](const Surface& s) {
            return (high + 1) / 65535.0 >= s.codes.low && (low - 1) / 65535.0 < s.codes.high;
        });
    };
    std::vector<std::uint8_t> blockDistances = toSurfaces ? blocks->distances(isSurface) : blocks->distances(isOpaque);
    Int3 size = blocks->dims();
    if (std::max({size.x, size.y, size.z}) > glInteger(GL_MAX_3D_TEXTURE_SIZE)) {
        size = Int3(1); // longer than any texture: nothing is leapt over
        blockDistances = {0};
    }
    if (distances.size != size) distances = makeTexture3d(size, GL_R8UI, GL_NEAREST, "the map of empty space");
    uploadBytes(distances, blockDistances.data(), GL_RED_INTEGER);
    distancesToSurfaces = toSurfaces;
}

void VolumeRaycaster::Impl::fillOpenness(const RenderSettings& settings) {
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
    uploadBytes(openness, open.data(), GL_RED);
    opennessIsMade = true;
}

void VolumeRaycaster::Impl::resize(glm::ivec2 size) {
    if (accumulated.color.size == size) return;
    seen = {};
    accumulated = makeColorTarget(size, GL_RGBA32F, GL_LINEAR, "the picture");
}

void VolumeRaycaster::Impl::setUniforms(const RaycastProgram& p, const Camera& camera, const RenderSettings& settings,
                                        const Tile& tile) {
    const Geometry& g = volume->geometry();
    const glm::vec2 size(accumulated.color.size), picture(settings.width, settings.height);
    // The tile in picture coordinates: [−1,1]² over the whole picture, y up.
    const glm::vec2 tileSize = 2.0f * glm::vec2(tile.width, tile.height) / picture;
    const glm::vec2 tileLow(2.0f * static_cast<float>(tile.x) / picture.x - 1.0f,
                            1.0f - 2.0f * static_cast<float>(tile.y + tile.height) / picture.y);
    p.setPictureFromFragment({tileSize / size, tileLow});
    p.setRays(PictureRays(camera, g, static_cast<double>(settings.width) / settings.height));

    double step = settings.stepInD0;
    if (bricks->count() > 1) step = std::min(step, longestStepInBricks(g));
    if (!(2 * g.radius() / (step * g.d0()) <= kMostSteps))
        throw Error("the picture needs over a million samples along a ray", "step", "make the step longer");
    p.setStep(step, g.d0());
    Clipping oblique;
    oblique.planes = settings.clipping.planes;
    const Vec3 dims(g.dims);
    p.setRegion(settings.clipping.lo * dims - 0.5, settings.clipping.hi * dims - 0.5, planesInVoxels(oblique, g));
    p.setJitter(settings.jitter ? picture : glm::vec2(0));
    p.setBlocks(g.dims - 1, distances.size - 1);

    const double codes = 65535.0 / bricks->maxCode(); // intensity of code/65535 = 1
    if (settings.mode == RenderMode::Composite) {
        p.setTable(codes * (kTableSize - 1), kTableSize);
    } else if (settings.mode == RenderMode::Surface) {
        p.setFeatureCount(static_cast<int>(drawn.size()));
    } else {
        const Feature* const only = settings.featureAlone(*tf);
        const CodeInterval shown = only != nullptr ? codesOf(*only, bricks->maxCode()) : CodeInterval{-1, 2};
        p.setShown(shown.low, shown.high, codes);
        return;
    }
    if (!changesColors(settings.light)) return;
    // Central differences over two voxels; the world's gradient is A⁻ᵀ times that along the grid.
    const Mat3 cameraFromWorld = glm::transpose(Mat3(camera.right(), camera.trueUp(), -camera.forward()));
    p.setLight(settings.light, cameraFromWorld * glm::transpose(g.indexFromWorld()) * (0.5 * codes * g.d0()));
    if (settings.light.occlusion > 0) {
        constexpr double kCell = AmbientOcclusion::kCell;
        const Vec3 cells(openness.size);
        const Vec3 voxels = kCell * Vec3(opennessCells); // of a texel
        p.setOpenness(1.0 / (voxels * cells), (0.5 - 0.5 * (voxels - 1.0) / voxels) / cells);
    }
    p.setDepthCue(settings.background.value_or(Rgb{}), 0.5 / g.radius(), 0.5);
}

void VolumeRaycaster::Impl::cast(const Camera& camera, const RenderSettings& settings, const Tile& tile,
                                 const JobControl& job) {
    const bool bricked = bricks->count() > 1, surface = settings.mode == RenderMode::Surface;
    if (surface && drawn.size() > kMostSurfaces)
        throw Error("surfaces of " + std::to_string(drawn.size()) + " features are too many", "transfer function",
                    "the gl renderer draws " + std::to_string(kMostSurfaces), Remedy::OtherEngine);
    const glm::ivec2 size = accumulated.color.size;
    const RaycastProgram& p = program(settings);
    setUniforms(p, camera, settings, tile);
    if (showsGround(settings)) {
        const glm::dvec2 bottomLeft = ground.at({tile.x, tile.y + tile.height}, settings);
        p.setGroundOrigin(glm::ivec2(glm::round(bottomLeft)) - glm::ivec2(0, 1));
    }

    glBindFramebuffer(GL_FRAMEBUFFER, accumulated.framebuffer.id());
    glViewport(0, 0, size.x, size.y);
    const std::array<float, 4> nothing{};
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    if (surface && bricked) {
        if (seen.size != size) seen = makeTexture2d(size, GL_RGBA32UI, GL_NEAREST, "the surfaces that were met");
        const std::vector<std::uint32_t> none(4 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
        glBindTexture(GL_TEXTURE_2D, seen.name.id());
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGBA_INTEGER, GL_UNSIGNED_INT, none.data());
        glBindTexture(GL_TEXTURE_2D, 0);
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
        const double samplesPerRow = (right - left) * std::max(1.0, box.depthInD0 / settings.stepInD0);
        const int rows = std::clamp(static_cast<int>(kSamplesAtOnce / samplesPerRow), 1, top - bottom);
        const auto order = bricks->frontToBack(camera);
        for (std::size_t i = 0; i < order.size(); ++i) {
            const JobControl part = job.part(i, order.size());
            p.setBrick(bricks->use(order[i]), bricked);
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

void VolumeRaycaster::Impl::drawComposite(const RenderSettings& settings, const DrawTarget& target, const Tile& tile) {
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(target.x, target.y, tile.width, tile.height);
    composite.use();
    const Rgb bottom = settings.background.value_or(Rgb{});
    const Rgb top = settings.background ? settings.backgroundTop.value_or(bottom) : bottom;
    composite.setBackground({vec3Of(bottom), settings.background ? 1.0f : 0.0f}, vec3Of(top));
    composite.setIsGrey(!isColored(settings.mode));
    const glm::vec2 scale = 1.0f / glm::vec2(tile.width, tile.height);
    composite.setTextureFromFragment({scale, -glm::vec2(target.x, target.y) * scale});
    const float rowsBelow = static_cast<float>(settings.height - tile.y - tile.height - target.y);
    composite.setHeightFromFragment(glm::vec2(1, rowsBelow) / static_cast<float>(settings.height));
    composite.setHasGround(showsGround(settings));
    if (showsGround(settings)) {
        // Fragments go up, the ground's rows down.
        const glm::dvec2 corner(tile.x - target.x, tile.y + tile.height + target.y);
        const glm::dvec2 from = ground.at(corner, settings) / ground.size(),
                         next = ground.at(corner + glm::dvec2(1, -1), settings) / ground.size();
        composite.setGroundFromFragment({next - from, from});
        bindTexture(1, GL_TEXTURE_2D, ground.color());
    }
    bindTexture(0, GL_TEXTURE_2D, accumulated.color.name);
    glBindVertexArray(emptyArray.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    throwOnGlError("drawing the picture");
}

VolumeRaycaster::VolumeRaycaster() {
    requireGl43();
    m_impl = std::make_unique<Impl>();
}
VolumeRaycaster::~VolumeRaycaster() = default;
VolumeRaycaster::VolumeRaycaster(VolumeRaycaster&&) noexcept = default;
VolumeRaycaster& VolumeRaycaster::operator=(VolumeRaycaster&&) noexcept = default;

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
    const auto leaveTidy = [&] {
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
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    };
    try {
        m_impl->cast(camera, settings, tile, job);
        m_impl->drawComposite(settings, target, tile);
    } catch (...) {
        leaveTidy();
        throw;
    }
    leaveTidy();
}

} // namespace pellucid::gl
