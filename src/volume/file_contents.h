// What a volume file holds, told by its header.
#pragma once

#include <string>
#include <vector>

#include "volume/loader.h"

namespace pellucid {

/// What can be chosen of a file, and how large it is.
struct FileContents {
    Int3 dims{0, 0, 0};
    SampleType type = SampleType::U8;   ///< as loadVolume() keeps it
    int components = 1;                 ///< of each voxel
    int steps = 1;                      ///< time steps
    std::vector<double> times;          ///< of the steps, in timeUnit; empty: not known
    std::string timeUnit;               ///< "s", "ms", …; empty: not known
    std::vector<std::string> stepFiles; ///< of a collection, the file of each step; empty: they are in this one
    std::vector<std::string> arrays;    ///< by name, in their order; empty: there is one, without a name
    std::string array;                  ///< the one that all this is said of; empty: it has no name
    std::vector<std::string> details;   ///< of each array how large it is; empty where all are of one grid
};

/// Reads the header of source.path, which is one file; of VTK files with inline data it has to pass over those, too.
/// A headerless file (source.raw) holds one step, or where source.frames asks for some, as many as its size is a
/// multiple of. Throws FileError for a header that cannot be read, UsageError for source.array that is not there.
FileContents contentsOf(const VolumeSource& source, const JobControl& job = {});

/// Whether the files of a folder are together one volume, or several series of slices: DICOM, or pictures.
bool isVolumeFolder(const std::string& path);

/// Whether several volumes tend to be found under a path, which FileContents::arrays names: DICOM, OME-Zarr, HDF5, …
bool mayHoldSeveral(const std::string& path);

/// The slice across the middle of a volume, for a picture of what can be opened. Throws
/// Error as loadVolume() does.
Volume loadMiddleSlice(const VolumeSource& source, const JobControl& job = {});

/// Whether a reader takes files of this name, whatever is in them; or what is in them, under a name that tells nothing.
/// Not the part of a pair that has no header.
bool hasVolumeSuffix(const std::string& path);

/// Whether `path` is a file of which only its user can tell how its bytes lie: neither name nor content says what it
/// is.
bool mayBeHeaderless(const std::string& path);

} // namespace pellucid
