// The one way from a volume, or from the frames of a series, to a file.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

class TimeSeries;

/// What is written of a volume, and how.
struct WrittenPart {
    std::optional<SampleType> type{};    ///< of the samples in the file; empty: their own
    std::optional<VoxelRegion> region{}; ///< of the volume's voxels; empty: all
    int coarser = 1;                     ///< ≥ 1; so many of them along each axis become one, their mean
};

/// Writes the samples of a volume with their geometry as NRRD, MetaImage, NIfTI, VTK image data, TIFF or OME-Zarr, by
/// the suffix of `path`. Read back they are the same, but for what the answer says, each a sentence without a full
/// stop: values that are rounded or cut to the type, missing values, what the format cannot say. Throws UsageError for
/// an unknown suffix, FileError, Cancelled; then nothing is left.
std::vector<std::string> writeVolume(const Volume& volume, const std::string& path, const WrittenPart& part = {},
                                     const JobControl& job = {});

/// Writes all frames of a series into one file likewise, with their times; as VTK image data a file each, beside a
/// collection (.pvd) that names them. Without a type they get that of the first frame. One frame is in memory at a
/// time. The answer has what reading a frame lost, too, except for what has been `told`. Throws UsageError, too, where
/// the format has no steps; FileError where a frame cannot be read.
std::vector<std::string> writeSeries(TimeSeries& series, const std::string& path, const WrittenPart& part = {},
                                     const JobControl& job = {}, const std::vector<std::string>& told = {});

/// The files that writing so many frames replaces: `path`, and those beside it. Throws as checkVolumeSuffix() does.
std::vector<std::string> writtenFiles(const std::string& path, int frames = 1);

/// Throws UsageError where writeVolume() knows no format for this suffix.
void checkVolumeSuffix(const std::string& path);

/// Name and pattern of each suffix, for dialogs: {"NRRD", "*.nrrd"}, {"MetaImage", "*.mha"}, {"MetaImage", "*.mhd"}, …
std::vector<std::pair<std::string, std::string>> writtenVolumePatterns();

} // namespace pellucid
