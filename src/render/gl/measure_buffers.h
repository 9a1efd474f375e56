// What the engines on the device share: transfer functions and features in buffers, and sums per feature.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "render/gl/depth_tables.h"
#include "render/gl/gl_resources.h"
#include "render/gl/resident_volume.h"
#include "render/gl/shader_program.h"
#include "volume/intensity_grid.h"

namespace pellucid::gl {

inline constexpr int kGroupSide = 8;      ///< local_size of the engines' shaders, both axes
inline constexpr int kPlanesPerGroup = 8; ///< of visibility_gather.comp and slices_gather.comp
/// Features and one; with one candidate they fit into 32 KiB, which every device has.
inline constexpr int kMostSlots = 2048;

/// Work groups for `count` things, `size` at a time.
inline GLuint groups(int count, int size) { return static_cast<GLuint>((count + size - 1) / size); }
void bindStorage(GLuint binding, const Buffer& buffer);
/// Makes the buffer anew where it is smaller; `what` names its content in errors. Throws OutOfMemory.
void ensureStorage(Buffer& buffer, double bytes, const std::string& what);

/// The tables that shaders/include/ray_depth.glsl reads.
class TableBuffers {
public:
    void upload(const DepthTables& tables); ///< and binds them
    /// Sets the uniforms of a program that reads them.
    static void describe(const Program& program, const DepthTables& tables, int maxCode);

private:
    Buffer m_integral, m_tau, m_opaque;
};

/// Sets what shaders/include/resident.glsl reads: voxel of the resident box = voxelFrom·p + offset.
void describeVolume(const Program& program, const ResidentVolume& volume, const Mat3& voxelFrom, const Vec3& offset);
/// Runs a gathering shader, its uniforms being set, over `voxels` along x, y and the planes of one step. What it writes
/// can be read by shaders and by readVisibility() afterwards.
void gatherVoxels(const Program& program, const Int3& voxels);
/// Calls use(the first `count` visibilities in the buffer). Throws Error where it cannot be read.
void readVisibility(const Buffer& buffer, std::size_t count, const std::function<void(std::span<const float>)>& use);

/// Slots come in powers of two, so that a feature more rarely means another program.
int slotsFor(int features);
/// As many invocations per item as a work group has, where shared memory has room for their accumulators; 0: no room.
int segmentsFor(int candidates, int slots);
/// The permutation of the engines' shaders; slots 0: the field instead of sums. `clipped`, `faint`: there are planes
/// beyond which there is nothing, and such beyond which optical depths are thinned.
std::vector<std::string> definesFor(const ResidentVolume& volume, int candidates, int slots, bool clipped, bool faint);
/// Throws Error: more features than any device has room for.
void refuseTooManyFeatures(int features);
/// Slot of every code: the index of its feature, or the number of features for "in none".
std::vector<std::uint16_t> slotsOfCodes(const IntensityGrid& grid, const std::vector<Feature>& features);

/// The sums that work groups leave, added up on the device in double precision (visibility_reduce.comp).
class FeatureTotals {
public:
    FeatureTotals();
    /// Binds what include/feature_sums.glsl reads, and starts at 0; `entries`: slots × 3 × candidates.
    void begin(const std::vector<std::uint16_t>& slotOfCode, int entries);
    void add(GLuint workGroups); ///< of the sums at binding 5
    std::vector<double> read() const;

private:
    Program m_reduce;
    Buffer m_slotOfCode, m_totals;
    std::vector<std::uint16_t> m_uploadedSlots;
    int m_entries = 0;
    bool m_first = true;
};

/// What the engines on the device have in common: the volume, and derivatives, for which the device has no sweep, so
/// that the cpu engine answers, on the same volume.
class DeviceEngine : public VisibilityEngine {
public:
    const Volume& volume() const override { return *m_volume; }
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override;

protected:
    DeviceEngine(std::shared_ptr<const Volume> volume, Quality quality);
    /// Throws as VisibilityEngine::sums() does of an input that is not valid.
    void check(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights) const;

    std::shared_ptr<const Volume> m_volume;
    Quality m_quality;
    std::shared_ptr<const IntensityGrid> m_codes;
    int m_cells; ///< tableCells()

private:
    std::unique_ptr<VisibilityEngine> m_cpu; ///< made when first needed
};

/// A number that tells weights apart: they come as plain memory, which may be filled anew between two calls.
std::uint64_t keyOf(const WeightFields& weights);

} // namespace pellucid::gl
