// Values on the grid of a volume into a file.
#pragma once

#include <string>

#include "volume/volume.h"

namespace pellucid {

/// Writes values on the volume's grid as NRRD of float32: gzip-compressed, as writeNrrd() does. Of a volume whose
/// voxels lie in several processes `values` has the shape of here(), and each process writes its own voxels into the
/// one file, which is not compressed; collective. Throws FileError.
void writeField(const Volume& volume, const Grid<float>& values, const std::string& path);

} // namespace pellucid
