// The one way from a path (or a sample's name) to a volume. Nothing else in the program parses volume files, so that
// this call can move into a process of its own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "volume/grid_axes.h"
#include "volume/memory_use.h"
#include "volume/volume.h"

namespace pellucid {

/// How headerless data lies in its file (--raw NX,NY,NZ,TYPE[,ENDIAN] --skip).
struct RawLayout {
    Int3 dims{0, 0, 0};
    SampleType type = SampleType::U8;
    bool bigEndian = false;
    std::uint64_t skipBytes = 0;
    bool operator==(const RawLayout&) const = default;
};

/// "NX,NY,NZ,TYPE[,little|big]"; throws UsageError.
RawLayout parseRawLayout(const std::string& text);

/// Frames first, first + stride, … up to `last` of a series, counted from 0.
struct FrameRange {
    int first = 0;
    std::optional<int> last; ///< itself included; empty: to the end
    int stride = 1;          ///< ≥ 1
    bool operator==(const FrameRange&) const = default;
};

/// What to open: a path, or "sample:NAME". It may name more than one frame (series.h): by a printf pattern, a glob, a
/// folder, a file with several time steps, or several files.
struct VolumeSource {
    std::string path;
    std::vector<std::string> more;    ///< files of the frames after that of `path`, in their order
    std::optional<FrameRange> frames; ///< only these of all that are there
    int step = 0;                     ///< of a file (or sample) with several time steps, from 0: the one that is read
    std::string array;             ///< of a file with named arrays; empty: its active scalars, the largest or the first
    std::optional<RawLayout> raw;  ///< given: the file is headerless
    std::optional<double> missing; ///< this value is invalid (besides what the file declares)
    std::optional<ValueRange> range;    ///< the user's intensity window
    int component = 0;                  ///< of a multi-component file
    std::optional<GridAxes> axes;       ///< how i, j, k run, whatever the file says; empty: as it says
    std::optional<GridSpacing> spacing; ///< likewise their distances; empty: as it says, 1 if headerless
    int sampleSize = 0;                 ///< --size of a sample, 0 = its default
    std::uint32_t seed = 1;             ///< of a sample
    /// Each voxel is the mean of so many along each axis (see excerpt.h). 1: all voxels, or an error where memory has
    /// no room for them; 0: likewise, but by the smallest factor for which there is room.
    int downsample = 0;
    std::optional<VoxelRegion> region; ///< only these voxels, in voxels of the data, before `downsample`
    MemoryUse then;                    ///< what is done with it next; checked before anything is allocated

    bool isSample() const { return path.starts_with("sample:"); }
    /// Whether both name the same data, whatever is done with it.
    bool operator==(const VolumeSource& o) const {
        return path == o.path && more == o.more && frames == o.frames && step == o.step && array == o.array &&
               raw == o.raw && missing == o.missing && range == o.range && component == o.component && axes == o.axes &&
               spacing == o.spacing && sampleSize == o.sampleSize && seed == o.seed && downsample == o.downsample &&
               region == o.region;
    }
};

/// Reads the volume or throws Error (FileError for files), before any allocation the file's own size does not bear out.
/// Files: those of formats/, told by what is in them, else by suffix; headerless raw. Of a file with several time steps
/// VolumeSource::step is read.
Volume loadVolume(const VolumeSource& source, const JobControl& job = {});

/// In a process that is one of several, loadVolume() gives it its part by this. `load` may call loadHere(); empty:
/// loadVolume() is loadHere().
void setVolumeLoader(std::function<Volume(const VolumeSource&, const JobControl&)> load);
Volume loadHere(const VolumeSource& source, const JobControl& job = {});

/// The files of all frames: those named and, where headers name others, those of the data; none for a sample. A header
/// that cannot be read names none; one that alone takes its reader too long throws TakesTooLong (reader_process.h).
std::vector<std::string> filesOf(const VolumeSource& source);

/// Writes float32 or the volume's own type as NRRD (gzip), through a temporary file beside `path` that is renamed.
void writeNrrd(const Volume& volume, const std::string& path);
void writeNrrd(const Geometry& geometry, const Grid<float>& values, const std::string& path);

/// File name patterns of the formats loadVolume reads, for dialogs: "*.nrrd", "*.nhdr", …
const std::vector<std::string>& volumeFilePatterns();

} // namespace pellucid
