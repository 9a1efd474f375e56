// A volume as rays read it: its codes, and what follows of a transfer function.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/ambient_occlusion.h"
#include "render/cpu/ray_packets.h"
#include "render/cpu/ray_table.h"
#include "render/ray_blocks.h"
#include "render/render_settings.h"

namespace pellucid {

struct Camera;

/// What the rays of a picture have in common in all volumes that they go through.
struct PictureRays {
    double width = 1, height = 1; ///< pixels
    double middle = 0;            ///< depth that t counts from, world units ahead of the eye
    double step = 1;              ///< world units
    double stepInD0 = 1;
};

class RayVolume {
public:
    RayVolume(std::shared_ptr<const IntensityGrid> grid, const Geometry& geometry)
        : m_grid(std::move(grid)), m_geometry(geometry), m_blocks(*m_grid) {}

    const IntensityGrid& grid() const { return *m_grid; }
    const Geometry& geometry() const { return m_geometry; }

    /// Tables and blocks of the transfer function, where it is not the last one. `onlyFeature`: as in RenderSettings.
    void prepare(const TransferFunction& tf, int onlyFeature, bool surfaces);
    /// Voxels and tables; prepare() has been called. The scene points into this.
    void fillVolume(PacketScene& scene) const;
    void fillCamera(const Camera& camera, const PictureRays& picture, PacketScene& scene) const;
    /// The sides of the box, what `part` leaves of it, and a clipping, both in the voxels of `first`.
    void fillRegion(std::span<const VoxelPlane> part, const VoxelClipping& clipping, const Geometry& first,
                    PacketScene& scene) const;
    /// Of each feature of the transfer function: [first, end) of its entries in the table.
    std::vector<std::array<float, 2>> entriesOfFeatures() const;
    /// Of features and of the one that is drawn alone.
    void fillFeatures(PacketScene& scene) const;
    /// What of light the volume itself decides.
    void fillLight(const Camera& camera, bool occlusion, PacketLight& light);

private:
    const Feature* featureAlone() const;
    void prepareFeatures();
    float lowestCode(const Feature& f) const { return static_cast<float>(f.a * m_grid->maxCode); }
    float endCode(const Feature& f) const { ///< 1 belongs to a feature that ends there
        return f.b >= 1 ? 65536.0f : static_cast<float>(f.b * m_grid->maxCode);
    }
    /// A world direction in voxels; the world's gradient is along e what that in voxels is along inVoxels(e).
    Vec3 inVoxels(const Vec3& direction) const { return m_geometry.indexFromWorld() * direction; }

    /// What tables and distances follow from.
    struct Prepared {
        TransferFunction tf;
        int onlyFeature = -1;
        bool surfaces = false;
        bool operator==(const Prepared&) const = default;
    };

    std::shared_ptr<const IntensityGrid> m_grid;
    Geometry m_geometry;
    RayBlocks m_blocks;
    Prepared m_prepared; ///< of what follows
    std::optional<RayTable> m_table;
    std::vector<std::uint8_t> m_distances;
    std::vector<PacketScene::Feature> m_features;
    std::optional<AmbientOcclusion> m_openness;
};

} // namespace pellucid
