// The part that every format read through ITK shares. ITK's own headers, heavy and fit for one compiler only as Debian
// installs them, stay in itk_image.cpp.
#pragma once

#include <cstdint>

#include "volume/loader.h"

namespace pellucid {

enum class ItkFormat { Nrrd, MetaImage, Nifti };

/// What our own look at the header found; ITK has to agree before it may read.
struct HeaderClaim {
    std::uint64_t values = 0;        ///< all axes, components and time steps together
    std::uint64_t bytesPerValue = 0; ///< in the file
    std::string dataPath;            ///< the file that holds the samples
    std::vector<std::string> notices;
};

/// Reads the samples of source.path and where they lie. The first time step of a series, component source.component.
/// Throws FileError for everything that ITK refuses, UsageError for a component that is not there.
Volume readWithItk(ItkFormat format, const VolumeSource& source, const HeaderClaim& claim, const JobControl& job);

} // namespace pellucid
