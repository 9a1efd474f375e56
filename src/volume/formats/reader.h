// One file format behind one small interface; loader.cpp chooses among them by suffix.
#pragma once

#include <string>
#include <vector>

#include "volume/file_contents.h"
#include "volume/loader.h"

namespace pellucid {

/// A reader has no state. It checks what the header claims against the file's own size and the memory that is free
/// before it allocates anything, and tells every fault of the file by a FileError.
class VolumeReader {
public:
    virtual ~VolumeReader() = default;
    /// "NRRD", "MetaImage", …: Volume::format.
    virtual const char* name() const = 0;
    /// Lower case, with the dot: ".nrrd".
    virtual const std::vector<std::string>& suffixes() const = 0;
    /// The files that hold the samples: `path`, or those that its header names. Throws FileError.
    virtual std::vector<std::string> dataFiles(const std::string& path) const { return {path}; }
    /// What source.path holds, by its header alone. Throws FileError.
    virtual FileContents describe(const VolumeSource& source, const JobControl& job) const = 0;
    /// Reads source.path (an existing file that is not empty): samples of source.step and source.array, geometry,
    /// source.missing and source.component. The window, title and format are left to the caller. Of a file with several
    /// steps, nothing behind the one that is read need be there, unless it is compressed: the checksum stands at the
    /// end.
    virtual Volume read(const VolumeSource& source, const JobControl& job) const = 0;
};

const VolumeReader& nrrdReader();
const VolumeReader& metaImageReader();
const VolumeReader& niftiReader();
const VolumeReader& vtiReader(); ///< vtk_image.cpp
const VolumeReader& pvdReader();

/// Time steps of source.path as *source.raw says, see contentsOf(). Throws FileError.
int rawSteps(const VolumeSource& source);
/// Headerless data, laid out as *source.raw says.
Volume readRaw(const VolumeSource& source, const JobControl& job);

} // namespace pellucid
