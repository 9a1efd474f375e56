#include "render/cpu/sheared_picture.h"

#include <algorithm>
#include <iterator>

#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "render/cpu/sheared_rays.h"
#include "render/ground_raster.h"

namespace pellucid {

namespace {

constexpr int kTileHeight = 16, kWarpTile = 64; ///< rays and pixels
constexpr int kPacket = 8;                      ///< rays

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }

std::vector<PacketTile> tilesOf(int width, int height, int tileWidth, int tileHeight) {
    std::vector<PacketTile> tiles;
    for (int y = 0; y < height; y += tileHeight)
        for (int x = 0; x < width; x += tileWidth)
            tiles.push_back({x, y, std::min(x + tileWidth, width), std::min(y + tileHeight, height)});
    return tiles;
}

void set(float (&to)[2], const ShearView::Line& from) {
    to[0] = static_cast<float>(from.at0);
    to[1] = static_cast<float>(from.per1);
}

/// Swaps x and y in each layer.
template <class T>
void turnInto(ZeroedVector<T>& to, const T* from, const Int3& n) {
    constexpr int kSide = 32; // squares that stay in the nearest memory
    parallelFor(asSize(n.z), [&](std::size_t z) {
        const T* source = from + z * layerSize(n);
        T* target = to.data() + z * layerSize(n);
        for (int y0 = 0; y0 < n.y; y0 += kSide)
            for (int x0 = 0; x0 < n.x; x0 += kSide)
                for (int x = x0; x < std::min(n.x, x0 + kSide); ++x)
                    for (int y = y0; y < std::min(n.y, y0 + kSide); ++y)
                        target[asSize(y) + asSize(n.y) * asSize(x)] = source[asSize(x) + asSize(n.x) * asSize(y)];
    });
}

/// What follows from the view alone.
void fillView(const ShearView& view, ShearedScene& s) {
    for (std::size_t a = 0; a < 3; ++a) {
        s.axis[a] = view.axis[a];
        s.dims[a] = view.dims[static_cast<int>(a)];
    }
    s.reversed = view.reversed;
    set(s.scale, view.scale);
    for (std::size_t a = 0; a < 2; ++a) {
        set(s.shift[a], view.shift[a]);
        s.first[a] = static_cast<float>(view.first[a]);
        s.pitch[a] = static_cast<float>(view.pitch[a]);
    }
    s.width = view.width;
    s.height = view.height;
    // In rays of the grid: (U − first)/pitch, over what U is divided by.
    const auto& [u, v, below] = view.ofPixel;
    const auto put = [](float(&to)[3], double constant, double perX, double perY) {
        to[0] = static_cast<float>(constant);
        to[1] = static_cast<float>(perX);
        to[2] = static_cast<float>(perY);
    };
    const auto ray = [&](float(&to)[3], const ShearView::Fraction& of, double first, double pitch) {
        put(to, (of.constant - first * below.constant) / pitch, (of.perX - first * below.perX) / pitch,
            (of.perY - first * below.perY) / pitch);
    };
    ray(s.ofPixel[0], u, view.first[0], view.pitch[0]);
    ray(s.ofPixel[1], v, view.first[1], view.pitch[1]);
    put(s.ofPixel[2], below.constant, below.perX, below.perY);
}

void fillPlanes(const PacketScene& scene, ShearedScene& s) {
    const auto fill = [&s](const PacketPlane* all, int count, PacketPlane* turned) {
        for (int p = 0; p < count; ++p) {
            const PacketPlane& from = all[p];
            PacketPlane& to = turned[p];
            for (int a = 0; a < 3; ++a) to.normal[a] = from.normal[s.axis[a]];
            to.offset = from.offset;
            if (s.reversed) { // n·(last − w) ≤ offset
                to.offset -= to.normal[2] * static_cast<float>(s.dims[2] - 1);
                to.normal[2] = -to.normal[2];
            }
        }
    };
    fill(scene.planes, scene.planeCount, s.planes);
    fill(scene.faintPlanes, scene.faintCount, s.faintPlanes);
}

/// Where the rows of rays have met something, see ShearedScene::extents.
std::vector<int> extentsOf(const std::vector<std::uint8_t>& touched, int height) {
    const int packets = height > 0 ? static_cast<int>(touched.size()) / height : 0;
    std::vector<int> own(2 * asSize(height)), all(own.size());
    for (int y = 0; y < height; ++y) {
        const auto row = touched.begin() + static_cast<std::ptrdiff_t>(y) * packets, end = row + packets;
        const auto first = std::find(row, end, 1);
        const auto last = std::find(std::reverse_iterator(end), std::reverse_iterator(row), 1);
        own[2 * asSize(y)] = kPacket * static_cast<int>(first - row);
        own[2 * asSize(y) + 1] = kPacket * static_cast<int>(last.base() - row) - 1;
    }
    for (int y = 0; y < height; ++y) {
        int from = kPacket * packets, to = -1;
        for (int r = std::max(0, y - 1); r <= std::min(height - 1, y + 2); ++r) {
            from = std::min(from, own[2 * asSize(r)]);
            to = std::max(to, own[2 * asSize(r) + 1]);
        }
        all[2 * asSize(y)] = from;
        all[2 * asSize(y) + 1] = to;
    }
    return all;
}

void fillGradient(const PacketLight& light, ShearedScene& s) {
    for (int row = 0; row < 3; ++row)
        for (int a = 0; a < 3; ++a) {
            const float by = light.cameraFromGradient[row][s.axis[a]];
            s.cameraFromGradient[row][a] = a == 2 && s.reversed ? -by : by;
        }
}

/// How ways through (u, v, w) lie in the world and before the camera.
void fillWorld(const ShearView& view, const Camera& camera, const Geometry& geometry, ShearedScene& s) {
    const Mat3 worldFromIndex = geometry.worldFromIndex();
    const Vec3 zero = view.inVoxels(Vec3(0));
    const Vec3 right = camera.right(), down = -camera.trueUp(), ahead = camera.forward();
    for (int a = 0; a < 3; ++a) {
        Vec3 unit(0);
        unit[a] = 1;
        const Vec3 way = worldFromIndex * (view.inVoxels(unit) - zero);
        s.right[a] = static_cast<float>(glm::dot(way, right));
        s.down[a] = static_cast<float>(glm::dot(way, down));
        s.ahead[a] = static_cast<float>(glm::dot(way, ahead));
    }
    s.depthAtZero = static_cast<float>(glm::dot(geometry.worldFromVoxel(zero) - geometry.boxCenter(), ahead));
    s.d0 = static_cast<float>(geometry.d0());
}

} // namespace

bool ShearedPicture::canDraw(const RenderSettings& settings) {
    return settings.mode == RenderMode::Composite && !settings.colors && !settings.overlay && !showsGround(settings);
}

void ShearedPicture::turn() {
    const Int3 n = m_grid.codes.dims();
    m_turned = ZeroedVector<std::uint16_t>(m_grid.codes.size() + CodeGrid::kPadding);
    turnInto(m_turned, m_grid.codes.wide(), n);
    if (m_grid.valid.empty()) return;
    m_turnedValid = ZeroedVector<std::uint8_t>(m_grid.valid.size() + CodeGrid::kPadding);
    turnInto(m_turnedValid, m_grid.valid.data(), n);
}

void ShearedPicture::draw(const PacketScene& scene, const Camera& camera, const ShearView& view, std::uint32_t* pixels,
                          const JobControl& job) {
    ShearedScene s;
    s.scene = &scene;
    s.pixels = pixels;
    fillView(view, s);
    fillPlanes(scene, s);
    fillGradient(scene.light, s);
    fillWorld(view, camera, m_geometry, s);
    const Int3 n = m_grid.codes.dims();
    std::int64_t steps[3] = {1, n.x, static_cast<std::int64_t>(n.x) * n.y};
    s.codes = m_grid.codes.wide();
    s.narrowCodes = m_grid.codes.narrow();
    s.valid = m_grid.valid.empty() ? nullptr : m_grid.valid.data();
    if (view.axis[2] == 0 && s.codes) {
        if (m_turned.empty()) turn();
        s.codes = m_turned.data();
        s.valid = m_turnedValid.empty() ? nullptr : m_turnedValid.data();
        steps[0] = n.y;
        steps[1] = 1;
    }
    for (int a = 0; a < 3; ++a) s.along[a] = steps[s.axis[a]];
    if (s.reversed) {
        s.origin = (s.dims[2] - 1) * s.along[2];
        s.along[2] = -s.along[2];
    }
    const int columns = (view.width + kPacket - 1) / kPacket * kPacket;
    s.stride = 4 * static_cast<std::int64_t>(columns);
    m_rays.resize(std::max<std::size_t>(4, asSize(view.height) * static_cast<std::size_t>(s.stride)));
    s.rgba = m_rays.data();
    m_touched.assign(asSize(view.height) * asSize(columns / kPacket), 0);
    s.touched = m_touched.data();
    const ShearedKernels& kernel = shearedKernels()[asSize(m_kernel)];
    const std::vector<PacketTile> rays = tilesOf(view.width, view.height, kShearedTileWidth, kTileHeight);
    parallelFor(rays.size(), [&](std::size_t i) {
        job.throwIfStopped();
        kernel.cast(s, rays[i]);
    });
    const std::vector<int> extents = extentsOf(m_touched, view.height);
    s.extents = extents.data();
    const std::vector<PacketTile> parts = tilesOf(scene.width, scene.height, kWarpTile, kWarpTile);
    parallelFor(parts.size(), [&](std::size_t i) { kernel.warp(s, parts[i]); });
}

} // namespace pellucid
