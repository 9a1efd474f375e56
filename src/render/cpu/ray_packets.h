// Rays of a picture, eight at a time: what the kernel is given, as plain data, and its entry points. One .cpp per
// instruction set compiles it. Positions are in voxels: how voxels lie in the world is in the matrices of the camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pellucid {

/// Side of the blocks that are passed over where nothing is opaque, in cells (between two voxel centres).
inline constexpr int kRayBlockShift = 2, kRayBlock = 1 << kRayBlockShift;
/// Distances of blocks to the next opaque one are counted up to this.
inline constexpr int kMostBlockDistance = 15;
/// What a component of a pixel may change by where one segment is halved; and what a lit colour changes by, about,
/// along d0 (docs/method.md, "The picture").
inline constexpr float kHalvingTolerance = 0.4f / 255, kLightTurn = 0.4f;
/// Transmittance below which a ray ends: what lies behind would change a pixel by less than a quarter of an 8-bit
/// level.
inline constexpr float kDark = 1.0f / 1024;

enum class PacketMode { Composite, Mip, MinIp, Average, Surface };

/// A half-space in voxels: keeps n·p ≤ offset.
struct PacketPlane {
    float normal[3], offset;
};

/// Ray of pixel (x, y): points p + t·d, affine in the pixel. t is the depth along the view, world units, 0 in a plane
/// through the middle of the box, so that single precision does wherever the eye is.
struct PacketCamera {
    float middle[2];     ///< pixels: where `point` and `direction` hold
    float point[3];      ///< voxels, at t = 0
    float pointBy[2][3]; ///< voxels per pixel to the right, downward
    float direction[3];  ///< voxels per world unit of depth
    float directionBy[2][3];
    float slope[2]; ///< world: a ray goes that far to the right and downward per depth and pixel
    float nearest;  ///< t of the eye; −1e30 for parallel rays
};

/// Light in camera coordinates: right, up, toward the viewer.
struct PacketLight {
    bool any = false; ///< gradients are wanted, or anything below
    bool shaded = false;
    float ambient = 1, diffuse = 0;
    float toward[3] = {0, 0, 1};      ///< unit vector
    const float* specular = nullptr;  ///< kSpecularEntries + 1: highlight by the cosine to the reflected light
    float specularFrom = 0;           ///< the cosine from which on there is one to speak of
    float cameraFromGradient[3][3]{}; ///< rows; from codes per voxel to intensity per d0
    float gradientOpacity = 0, silhouettes = 0, occlusion = 0, depthCue = 0; ///< strengths, [0,1]
    float cueFrom = 0, cuePerDepth = 0;                                      ///< cue = (t − from)·perDepth
    float cueColor[3] = {0, 0, 0};
    const std::uint8_t* openness = nullptr; ///< of AmbientOcclusion, null without
    int opennessDims[3]{};
    float cellOfVoxel = 0, cellOfVoxelOffset = 0; ///< position in that grid: voxel·this + offset
};
inline constexpr int kSpecularEntries = 2048;
inline constexpr std::size_t kMostSurfaces = 256; ///< features that mode Surface draws

/// What a picture is made of, beside it, in pixels as many as it has. All begin as they are where nothing is met.
struct PacketLayers {
    int count = 0;                       ///< features, at most kMostSurfaces − 1; what lies in none is one layer more
    const float (*entries)[2] = nullptr; ///< of each: [first, end) in the table of the transfer function
    float* const* rgba = nullptr;        ///< [count + 1]: pixels × 4, colour and share of the opacity; 0 at first
    float* depth = nullptr;              ///< world length from the eye to where half is absorbed; infinity at first
    float* normal = nullptr;             ///< pixels × 3: right, up, toward the viewer; 0 at first
    float eye = 0;                       ///< t of the eye, or of the plane through it for parallel rays
};

struct PacketScene {
    PacketMode mode = PacketMode::Composite;
    PacketCamera camera;
    int width = 0, height = 0; ///< pixels
    float* rgba = nullptr;     ///< width × height × 4

    const std::uint16_t* codes = nullptr;      ///< a few more may be read behind the last, see CodeGrid::kPadding
    const std::uint8_t* narrowCodes = nullptr; ///< in place of `codes` where these are null; all voxels are valid then
    const std::uint8_t* valid = nullptr;       ///< null: all are
    int dims[3]{};
    std::int64_t middleVoxel = 0; ///< index of what `codes` + it points to, so that 32 bits reach all
    int middleSlice = 0;

    const std::uint8_t* blockDistance = nullptr; ///< per block, in blocks; 0: opaque. Three more bytes may be read
    const std::int32_t* blockRange = nullptr;    ///< per block: lowest code + 65536·(highest code); for Mip and MinIp
    int blockDims[3]{};
    bool leap = true; ///< false: visits every sample

    PacketPlane planes[36]; ///< all that bounds the drawn region, the box included
    int planeCount = 0;
    PacketPlane faintPlanes[12]; ///< beyond these optical depths are thinned, in mode Composite
    int faintCount = 0;
    float faintDensity = 0; ///< to this part of their own
    float step = 1;         ///< world units
    float stepInD0 = 1;     ///< the same in reference lengths
    /// How often a step may be halved, in mode Composite: once everywhere, and on where the picture hangs on it by more
    /// than kHalvingTolerance. 0: never.
    int halvings = 0;
    bool jitter = false;

    // Of the transfer function: cells of equal width, with constant τ and colour in each.
    float cellOfCode = 0; ///< position in the table is ½ + code·this
    float intensityOfCode = 0;
    const std::int32_t* integral =
        nullptr; ///< [cells + 1]: 2·(running integral in `depthUnit`) + (this cell is opaque)
    /// [cells + 1] × 4: the same of τ·rgb, in the same units, without the bit; and that of `integral` with it.
    const std::int32_t* colors = nullptr;
    float depthUnit = 0; ///< optical depth of one unit on a path of d0
    float lastEntry = 0; ///< number of cells
    /// A colour per voxel (VoxelColors) in place of `colors` and of those of features; null: none. Of the voxel 0.
    const std::uint32_t* voxelColors = nullptr;

    // Mode Surface: the features that can be hit, in codes.
    struct Feature {
        float low, high; ///< [low, high)
        float rgb[3], opacity;
    };
    const Feature* features = nullptr;
    int featureCount = 0;
    float lowestShown = 0, highestShown = 65536; ///< codes that count in Mip, MinIp, Average: [low, high)

    const float* groundDepth = nullptr;    ///< width × height: where rays end; infinity: nowhere. Null: no ground
    const std::uint32_t* ground = nullptr; ///< its colours (VoxelColors::pack())

    const PacketLayers* layers = nullptr; ///< for layer kernels
    const PacketScene* overlay = nullptr; ///< a second volume, seen by the same rays; null: none

    bool hasBackground = false;
    float background[3]{}, backgroundTop[3]{}; ///< bottom and top of the picture
    PacketLight light;
};

/// Pixels [x0, x1) × [y0, y1); x0 a multiple of 4, y0 of 2.
struct PacketTile {
    int x0, y0, x1, y1;
};

using PacketKernel = void (*)(const PacketScene&, const PacketTile&);
void renderTileGeneric(const PacketScene&, const PacketTile&);
void renderTileAvx2(const PacketScene&, const PacketTile&);
/// The kernels that this processor can run, the fastest first.
std::span<const PacketKernel> packetKernels();

/// The same picture, in mode Composite without ground and overlay, and its layers.
void layerTileGeneric(const PacketScene&, const PacketTile&);
void layerTileAvx2(const PacketScene&, const PacketTile&);
PacketKernel layerKernel(); ///< the fastest that this processor can run

} // namespace pellucid
