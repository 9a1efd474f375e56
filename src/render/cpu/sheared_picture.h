// The quick picture of the cpu renderer: rays in storage order, then a warp (docs/method.md, "The quick picture").
#pragma once

#include <cstdint>
#include <vector>

#include "base/job.h"
#include "base/zeroed_memory.h"
#include "render/cpu/ray_packets.h"
#include "render/cpu/shear_view.h"
#include "render/render_settings.h"
#include "volume/intensity_grid.h"

namespace pellucid {

/// For the codes of one volume; used by one thread at a time.
class ShearedPicture {
public:
    /// `grid` and `geometry` outlive it. `kernel` is an index into shearedKernels().
    ShearedPicture(const IntensityGrid& grid, const Geometry& geometry, int kernel)
        : m_grid(grid), m_geometry(geometry), m_kernel(kernel) {}

    /// Whether it draws all that the settings ask for: emission and absorption in the colours of the transfer function,
    /// above no ground.
    static bool canDraw(const RenderSettings& settings);
    /// Into `pixels` (as screenPixel() makes them; the scene has a background) or, where that is null, into the picture
    /// of `scene`, which says all but the rays. Throws Cancelled.
    void draw(const PacketScene& scene, const Camera& camera, const ShearView& view, std::uint32_t* pixels,
              const JobControl& job);

private:
    void turn();

    const IntensityGrid& m_grid;
    const Geometry& m_geometry;
    int m_kernel;
    /// The same voxels, y fastest, then x, then z, so that neighbours of rays along x lie side by side. Empty until
    /// such a picture is drawn, and where codes are narrow: volumes so large that their memory counts.
    ZeroedVector<std::uint16_t> m_turned;
    ZeroedVector<std::uint8_t> m_turnedValid;
    std::vector<std::int16_t> m_rays;
    std::vector<std::uint8_t> m_touched;
};

} // namespace pellucid
