// A volume as sweeps read it (see sweep.h), whole or one block of a larger one.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/zeroed_memory.h"
#include "render/clipping.h"
#include "render/cpu/sweep_tables.h"
#include "render/visibility.h"
#include "volume/intensity_grid.h"

namespace pellucid {

/// One sweep of those that together visit every voxel of a volume once.
struct SweepPass {
    int u = 0, v = 1, w = 2; ///< the axes i, j, k that run along u, v and w
    bool flipped = false;    ///< the nearest slice is the one of the highest index
    bool pyramid = false;    ///< visits only the voxels that the eye sees along this axis rather than another

    Vec3 permuted(const Vec3& p) const { return {p[u], p[v], p[w]}; }
    Int3 permuted(const Int3& p) const { return {p[u], p[v], p[w]}; }
};

/// How carefully lines are sampled: what is off averages out over many voxels, which small volumes do not have; but
/// they have the time.
enum class SweepCare { Large, LargeHigh, Small, SmallHigh };

/// The same camera, but where its rays are as good as parallel. Throws Error where it is inside the volume.
Camera sweepCamera(const Camera& camera, const Geometry& geometry);
/// In voxels, rounded, so that differences from voxels are exact and each voxel is on one side of a pyramid's face.
Vec3 sweepEye(const Camera& camera, const Geometry& geometry);
/// Axes are compared in voxels, so that rays cross about one voxel per slice however unequal the spacing is.
std::vector<SweepPass> sweepPasses(const Camera& camera, const Geometry& geometry);
/// Sets the size of the volume, and what SweepInput says of rays; its mode is set.
void setSweepRays(SweepInput& in, const Camera& camera, const SweepPass& pass, const Geometry& geometry,
                  SweepCare care);

/// The blocks of kBlockSize³ voxels that a sweep has to look at, under one view and its transfer functions.
struct OpaqueMap {
    std::vector<std::uint8_t> blocks; ///< as SweepInput::opaque
    std::vector<SweepSpan> spans;     ///< of one pass, as SweepInput::opaqueSpans
};

class SweepVolume {
public:
    /// All of `volume`. `draft`: sampled as if it were large.
    SweepVolume(std::shared_ptr<const Volume> volume, Quality quality, bool draft);
    /// The voxels from `first` on of a volume with the geometry `whole`, whose reference length and window `block` has.
    /// A block is sampled as a large volume is, whatever its size, in quality normal.
    SweepVolume(std::shared_ptr<const Volume> block, const Geometry& whole, const Int3& first);

    const Geometry& geometry() const { return m_geometry; } ///< of the whole
    const Volume& stored() const { return *m_volume; }
    const SweepCodes& codes() const { return m_codeSpace; }
    VoxelRegion region() const { return {m_first, m_first + m_volume->dims()}; } ///< that is stored

    OpaqueMap opaqueMap(const SweepTables& tables, const VoxelClipping& clipping) const;
    /// What a pass of a view is, with all of its volume to be measured. `weights` and `field`, where not null, have the
    /// shape of what is stored. Refers to `tables`, `opaque` (whose spans it sets), `weights`, `field` and this.
    SweepInput input(const Camera& camera, const VoxelClipping& clipping, const SweepPass& pass,
                     const SweepTables& tables, OpaqueMap& opaque, const WeightFields* weights, Grid<float>* field);

private:
    void makeCodes();
    void makeOwnCodes(const IntensityGrid& grid);
    template <class Code>
    void findRanges(const Code* codes);
    const std::uint8_t* narrowCodes() const { return m_shared ? m_shared->codes.narrow() : nullptr; }
    const std::uint16_t* wideCodes() const { return m_shared ? m_shared->codes.wide() : m_codes.data(); }
    static void setClipping(SweepInput& in, const VoxelClipping& clipping, const SweepPass& pass);
    void setCodes(SweepInput& in, const SweepPass& pass);
    void setOpaque(SweepInput& in, OpaqueMap& opaque, const SweepPass& pass) const;
    static SweepStrides stridesOf(const Int3& dims, const SweepPass& pass);

    std::shared_ptr<const Volume> m_volume;
    Geometry m_geometry;
    Int3 m_first{0, 0, 0};
    SweepCare m_care;
    SweepCodes m_codeSpace;
    std::shared_ptr<const IntensityGrid> m_shared; ///< whose codes are read as they are; null: m_codes are
    ZeroedVector<std::uint16_t> m_codes; ///< x fastest, and kCodePadding more: without gaps, or with invalid ones
    Int3 m_firstBlock{0, 0, 0}, m_blocks{0, 0, 0};
    std::vector<std::array<std::uint16_t, 2>> m_ranges; ///< per block: the lowest and highest code
    ZeroedVector<std::uint16_t> m_codesYZX;             ///< made when a sweep along x first needs it
};

} // namespace pellucid
