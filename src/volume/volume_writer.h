// The one way from a volume to a file.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

/// Writes the samples of a volume with their geometry as NRRD, MetaImage, NIfTI or VTK image data, by the suffix of
/// `path`. `type`: of the samples in the file; empty: their own. Read back they are the same, but for what the answer
/// says, each a sentence without a full stop: values that are rounded or cut to the type, missing values, what the
/// format cannot say. Throws UsageError for an unknown suffix, FileError, Cancelled; then nothing is left.
std::vector<std::string> writeVolume(const Volume& volume, const std::string& path, std::optional<SampleType> type = {},
                                     const JobControl& job = {});

/// Throws UsageError where writeVolume() knows no format for this suffix.
void checkVolumeSuffix(const std::string& path);

/// Name and pattern of each suffix, for dialogs: {"NRRD", "*.nrrd"}, {"MetaImage", "*.mha"}, {"MetaImage", "*.mhd"}, …
std::vector<std::pair<std::string, std::string>> writtenVolumePatterns();

} // namespace pellucid
