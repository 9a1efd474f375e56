// Rays in storage order (see shear_view.h), eight neighbours at a time: what the kernel is given, as plain data, and
// its entry points. One .cpp per instruction set compiles it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/cpu/ray_packets.h"

namespace pellucid {

/// Coordinates (u, v, w) and the plane `base` are those of the ShearView that it was made from.
struct ShearedScene {
    const PacketScene* scene = nullptr; ///< table, blocks, light and background; its camera and size are the picture's

    // Voxels: that at (u, v, w) has the index `origin` + u·along[0] + v·along[1] + w·along[2], where `codes` or else
    // `narrowCodes` and `valid` (null: all are) are not those of `scene` but may be a turned copy.
    const std::uint16_t* codes = nullptr;
    const std::uint8_t* narrowCodes = nullptr;
    const std::uint8_t* valid = nullptr;
    std::int64_t origin = 0, along[3]{};
    int dims[3]{};
    int axis[3]{}; ///< of the volume
    bool reversed = false;

    float scale[2]{};    ///< scale(w) = [0] + w·[1]
    float shift[2][2]{}; ///< of u and of v, likewise
    float first[2]{}, pitch[2]{};
    int width = 0, height = 0; ///< rays
    /// width × height × 4, rows `stride` numbers apart: colour times alpha, and alpha, in parts of 2¹⁴.
    std::int16_t* rgba = nullptr;
    std::int64_t stride = 0;

    std::uint8_t* touched = nullptr; ///< [height][stride/32]: whether any of eight rays has met anything
    /// [height][2]: the rays from the first to the last of a row and its three neighbours, one before and two behind,
    /// that have met anything. For the warp.
    const int* extents = nullptr;

    PacketPlane planes[36], faintPlanes[12]; ///< those of `scene`, in (u, v, w)
    /// By u, v and w: along the picture to the right, downward and ahead, world units per voxel.
    float right[3]{}, down[3]{}, ahead[3]{};
    float cameraFromGradient[3][3]{}; ///< that of PacketLight by u, v and w
    float depthAtZero = 0;            ///< along the view, of (0, 0, 0)
    float d0 = 1;

    // The warp: where the ray of a pixel passes the plane `base`, see ShearView::ofPixel; in rays of the grid.
    float ofPixel[3][3]{};
    std::uint32_t* pixels = nullptr; ///< where the picture goes as screenPixel() has it; null: into scene->rgba
};

/// Rays that go on together, at most: tiles are no wider.
inline constexpr int kShearedTileWidth = 64;
/// Rays [x0, x1) × [y0, y1) of the grid; x0 a multiple of 8.
using ShearedKernel = void (*)(const ShearedScene&, const PacketTile&);
/// Pixels of the picture, from all rays.
using WarpKernel = void (*)(const ShearedScene&, const PacketTile&);

void castTileGeneric(const ShearedScene&, const PacketTile&);
void castTileAvx2(const ShearedScene&, const PacketTile&);
void warpTileGeneric(const ShearedScene&, const PacketTile&);
void warpTileAvx2(const ShearedScene&, const PacketTile&);

struct ShearedKernels {
    ShearedKernel cast;
    WarpKernel warp;
};
/// Those that this processor can run, the fastest first; as many as packetKernels().
std::span<const ShearedKernels> shearedKernels();

} // namespace pellucid
