// Values on the grid of a volume into a file.
#pragma once

#include <string>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// Writes values on the volume's grid as float32, as writeVolume() does; answers likewise. Of a volume whose voxels lie
/// in several processes `values` has the shape of here(), and each process writes its own voxels into the one file,
/// which is NRRD that is not compressed; collective. Throws FileError; UsageError where that is not the format of
/// `path`.
std::vector<std::string> writeField(const Volume& volume, const Grid<float>& values, const std::string& path);

} // namespace pellucid
