// What `bench` opens as DICOM.
#pragma once

#include <string>

#include "volume/volume.h"

namespace pellucid {

/// Whether the samples can be pixels of DICOM as they are: whole numbers of at most 16 bits.
bool fitsDicom(const Volume& volume);

/// The slices of a volume that fits, each as an uncompressed DICOM file in `folder`, which is there. Throws FileError.
void writeDicomSlices(const Volume& volume, const std::string& folder);

} // namespace pellucid
