// One file format behind one small interface; loader.cpp chooses among them by suffix.
#pragma once

#include <string>
#include <vector>

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
    /// The file that holds the samples: `path`, or the one that its header names. Throws FileError.
    virtual std::string dataFile(const std::string& path) const { return path; }
    /// Reads source.path (an existing file that is not empty): samples, geometry, source.missing and
    /// source.component. The window, title and format are left to the caller.
    virtual Volume read(const VolumeSource& source, const JobControl& job) const = 0;
};

const VolumeReader& nrrdReader();
const VolumeReader& metaImageReader();
const VolumeReader& niftiReader();

/// Headerless data, laid out as *source.raw says.
Volume readRaw(const VolumeSource& source, const JobControl& job);

} // namespace pellucid
