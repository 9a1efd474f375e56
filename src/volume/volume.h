// A scalar volume as it was read: samples in their own type, where they lie in the world, and which are invalid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/enum_names.h"
#include "base/length_unit.h"
#include "volume/grid.h"
#include "volume/sample_array.h"

namespace pellucid {

enum class SampleType { U8, I8, U16, I16, U32, I32, F32, F64 };

template <>
inline constexpr auto kNamesOf<SampleType> = enumNames("sample type", "u8", "i8", "u16", "i16", "u32", "i32", "f32",
                                                       "f64");
constexpr std::size_t bytesPerSample(SampleType type) {
    return std::array<std::size_t, 8>{1, 1, 2, 2, 4, 4, 4, 8}[static_cast<std::size_t>(type)];
}

using Samples = std::variant<SampleArray<std::uint8_t>, SampleArray<std::int8_t>, SampleArray<std::uint16_t>,
                             SampleArray<std::int16_t>, SampleArray<std::uint32_t>, SampleArray<std::int32_t>,
                             SampleArray<float>, SampleArray<double>>;

/// An intensity window in data units; intensity 0 at lo, 1 at hi.
struct ValueRange {
    double lo = 0, hi = 1;
    bool operator==(const ValueRange&) const = default;
};

/// What the axes of the world are.
enum class WorldAxes {
    File,   ///< the file's own; lengths in the unit that it gives
    Patient ///< to the patient's left, back and head (LPS); millimetres where a file says so
};

/// Where the voxels lie (docs/method.md, "Volume and intensity"): centre of voxel v at origin + A·v, world units; A, of
/// columns spacing[a]·directions[a], turns, mirrors, stretches and shears. The *box* of the volume, half a voxel beyond
/// the outer centres on every side, is a parallelepiped in the world and [−½, dims − ½] in voxel coordinates: straight
/// lines are straight in both, so that geometry is done in voxel coordinates and only lengths are the world's.
struct Geometry {
    Int3 dims{0, 0, 0};
    Vec3 spacing{1, 1, 1}; ///< lengths of A's columns
    Vec3 origin{0, 0, 0};
    Mat3 directions{1}; ///< unit columns: where the axes i, j, k point in the world; need not be at right angles
    WorldAxes worldAxes = WorldAxes::File;
    LengthUnit lengthUnit = LengthUnit::Unknown; ///< see unitOf(): a patient's are millimetres without a word
    /// World units; 0: the smallest spacing. A coarser copy of a volume keeps the length of the volume that it was made
    /// from, so that opacities and saliency mean the same in both.
    double referenceLength = 0;

    Mat3 worldFromIndex() const; ///< A, for differences of voxel coordinates
    Mat3 indexFromWorld() const; ///< its inverse
    Vec3 worldFromVoxel(const Vec3& voxel) const { return origin + directions * (voxel * spacing); }
    Vec3 voxelFromWorld(const Vec3& world) const;

    Vec3 voxelBoxMin() const { return Vec3(-0.5); }       ///< of the box, voxel coordinates
    Vec3 voxelBoxMax() const { return Vec3(dims) - 0.5; } ///< of the box, voxel coordinates
    Vec3 corner(int n) const;                             ///< of the box, world; bits 0, 1, 2 of n: far along i, j, k
    Vec3 boxCenter() const;                               ///< world
    double radius() const;                                ///< of the sphere around the box, world units
    Vec3 boundsMin() const;                               ///< of the box along the world's axes
    Vec3 boundsMax() const;                               ///< likewise
    bool contains(const Vec3& world) const;               ///< strictly inside the box
    /// The reference length: one unit of path for opacity, world units.
    double d0() const {
        return referenceLength > 0 ? referenceLength : std::min(spacing.x, std::min(spacing.y, spacing.z));
    }
};

/// Voxels lo … hi − 1 along each axis.
struct VoxelRegion {
    Int3 lo{0, 0, 0}, hi{0, 0, 0};
    bool operator==(const VoxelRegion&) const = default;
};

/// Which part of its data a volume is, and how fine: where it is not all of them.
struct Excerpt {
    Int3 fullDims{0, 0, 0};
    VoxelRegion region;     ///< in voxels of the data
    int factor = 1;         ///< each voxel is the mean over so many of the data along each axis
    bool forMemory = false; ///< the factor was chosen because memory has no room for more
    bool operator==(const Excerpt&) const = default;
};

/// What a process has of a volume that no process holds as a whole, and how it learns of the rest. Calls of gather()
/// and sum() are collective: all processes make the same ones in the same order.
class VoxelsElsewhere {
public:
    virtual ~VoxelsElsewhere() = default;
    virtual VoxelRegion own() const = 0;    ///< the voxels that this process answers for; each has one that does
    virtual VoxelRegion stored() const = 0; ///< these, and voxels around them
    /// The bytes of each process, in an order that is the same for all.
    virtual std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) const = 0;
    /// The elements of all processes added up: the same bits for all.
    virtual void sum(std::span<double> values) const = 0;
};

struct IntensityGrid;

/// Where the holders of a volume's intensity codes find each other, see sharedIntensityGrid().
struct SharedCodes {
    std::mutex mutex;
    std::weak_ptr<const IntensityGrid> grid;
};

/// Immutable once made; cheap to share by std::shared_ptr<const Volume>.
/// Invalid voxels (NaN, infinite, or the declared missing value) count nowhere and are never drawn (docs/method.md,
/// "Volume and intensity").
class Volume {
public:
    /// Throws Error where sizes and samples disagree, geometryProblem() finds one, or the axes lie in a plane.
    Volume(const Geometry& geometry, Samples samples, std::optional<double> missing = {});

    /// What is known of a volume whose voxels lie in several processes; m_here and so on.
    struct Distributed {
        SampleType type = SampleType::U8;
        ValueRange dataRange;
        std::size_t invalidCount = 0;
        std::optional<double> missing;
        std::shared_ptr<const Volume> here; ///< the voxels of elsewhere->stored(), in the window dataRange; null: none
        std::shared_ptr<const VoxelsElsewhere> elsewhere;
    };
    /// Samples and values of single voxels are not there: who asks for them gets an Error. What can be found out block
    /// by block asks elsewhere() first.
    Volume(const Geometry& geometry, Distributed parts);

    const VoxelsElsewhere* elsewhere() const noexcept { return m_elsewhere.get(); } ///< null: all voxels are here
    /// The part of a volume that is in this process, in the same window; null where it has none.
    const std::shared_ptr<const Volume>& here() const noexcept { return m_here; }
    /// Voxels that this process holds.
    Int3 dimsHere() const { return !m_elsewhere ? dims() : m_here ? m_here->dims() : Int3(0); }

    const Geometry& geometry() const noexcept { return m_geometry; }
    const Int3& dims() const noexcept { return m_geometry.dims; }
    std::size_t size() const noexcept { return voxelCount(m_geometry.dims); }
    SampleType sampleType() const noexcept { return m_type; }
    const Samples& samples() const; ///< throws Error where the voxels lie in several processes
    std::optional<double> missing() const noexcept { return m_missing; }

    /// Smallest and largest valid value; {0, 0} where no voxel is valid.
    const ValueRange& dataRange() const noexcept { return m_dataRange; }
    /// The window that intensities refer to: dataRange() or the user's.
    const ValueRange& range() const noexcept { return m_range; }
    /// The same samples (shared, not copied) seen through another window. Throws Error unless lo < hi, both finite.
    Volume withRange(const ValueRange& range) const;
    /// The same samples (shared, not copied) at another place of the world; `geometry` has the dims of this volume.
    Volume withGeometry(const Geometry& geometry) const;

    std::size_t invalidCount() const noexcept { return m_invalidCount; }
    bool isConstant() const noexcept { return m_dataRange.lo == m_dataRange.hi; }
    bool hasValidVoxels() const noexcept { return m_invalidCount < size(); }

    double value(std::size_t index) const; ///< data units; what the file says, NaN included
    bool isValid(std::size_t index) const;
    /// Intensity in [0,1] (docs/method.md, "Volume and intensity"); NaN where invalid. In a constant volume every
    /// intensity is 0.
    double intensity(std::size_t index) const;
    /// intensity() of a value in data units; NaN where not finite or missing.
    double intensityOfValue(double value) const;
    double valueOfIntensity(double s) const { return m_range.lo + s * (m_range.hi - m_range.lo); }

    SharedCodes& sharedCodes() const noexcept { return *m_codes; }
    std::size_t memoryBytes() const { return voxelCount(dimsHere()) * bytesPerSample(sampleType()); }
    /// The samples lie in their file, which the system reads as they are looked at.
    bool isMapped() const {
        return m_samples && std::visit([](const auto& values) { return values.isMapped(); }, *m_samples);
    }

    /// Free text for people, set by readers and generators.
    std::string title;              ///< file name or sample name
    std::string format;             ///< "NRRD", "MetaImage", "NIfTI", "raw", "sample"
    std::optional<Excerpt> excerpt; ///< empty: all voxels of the data
    std::optional<Geometry>
        inFile; ///< as the file has it, where the user said how axes run or how far voxels are apart
    /// Remarks the user should see once, e.g. "the first of 25 time steps is shown".
    std::vector<std::string> notices;

private:
    Geometry m_geometry;
    SampleType m_type = SampleType::U8;
    std::shared_ptr<const Samples> m_samples;
    std::shared_ptr<const Volume> m_here;
    std::shared_ptr<const VoxelsElsewhere> m_elsewhere;
    std::optional<double> m_missing;
    ValueRange m_dataRange, m_range;
    std::size_t m_invalidCount = 0;
    std::shared_ptr<SharedCodes> m_codes = std::make_shared<SharedCodes>(); // of this window
};

} // namespace pellucid
