// The file formats, each in a file of its own; loader.cpp chooses among them by content, and by suffix where that does
// not tell.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/content.h"
#include "volume/formats/samples.h"

namespace pellucid {

/// One file format. Its functions have no state. They check what the header claims against the file's own size and the
/// memory that is free before they allocate anything, and tell every fault of the file by a FileError.
struct VolumeFormat {
    const char* name;                  ///< "NRRD", "MetaImage", …: Volume::format
    std::vector<std::string> suffixes; ///< lower case, with the dot: ".nrrd"
    /// What source.path holds, by its header alone. Throws FileError.
    FileContents (*describe)(const VolumeSource& source, const JobControl& job);
    /// Reads source.path (an existing file that is not empty): samples of source.step, source.array and
    /// source.component, geometry, and source.missing. The caller sets window, title and format. What follows the step
    /// in the file need not be there, unless the data are compressed: their checksum stands at the end.
    Volume (*read)(const VolumeSource& source, const JobControl& job);
    /// The files that hold the samples, where the header names others. Throws FileError. Null: they are in the file.
    std::vector<std::string> (*dataFiles)(const std::string& path) = nullptr;
    const char* content = nullptr; ///< describeContent() of its files: that tells the format under any name
    std::vector<std::string> sharedSuffixes = {}; ///< other files have these, too: they do not tell the format
    /// Whether a file of such a suffix belongs to a file of this format that is beside it. Null: none does.
    bool (*isBeside)(const std::string& path) = nullptr;
    bool holdsSeveral = false; ///< its files tend to have several volumes, of which one is chosen
    /// The layer across the middle of the z axis. Null: described first, then read as a region.
    Volume (*readMiddle)(const VolumeSource& source, const JobControl& job) = nullptr;
};

/// The `describe` and `read` of a format whose header becomes a layout: layoutOf(source, step, job), where `step` is
/// the one to be read, for which everything is checked; empty: nothing but the header is looked at.
template <auto layoutOf>
FileContents describeLayout(const VolumeSource& source, const JobControl& job) {
    return contentsOf(layoutOf(source, std::nullopt, job));
}
template <auto layoutOf>
Volume readLayout(const VolumeSource& source, const JobControl& job) {
    return readSamples(source, layoutOf(source, source.step, job), job);
}

VolumeFormat nrrdFormat();
VolumeFormat metaImageFormat();
VolumeFormat niftiFormat();
VolumeFormat vtiFormat();  ///< vtk_image.cpp
VolumeFormat pvtiFormat(); ///< vtk_image.cpp
VolumeFormat pvdFormat();  ///< vtk_collection.cpp
VolumeFormat vtkLegacyFormat();
VolumeFormat pvmFormat();
VolumeFormat datFormat();
VolumeFormat vvdFormat();
VolumeFormat mrmlFormat();
VolumeFormat dicomFormat();  ///< foreign.cpp
VolumeFormat imageFormat();  ///< foreign.cpp
VolumeFormat hdf5Format();   ///< foreign.cpp
VolumeFormat netCdfFormat(); ///< foreign.cpp
VolumeFormat zarrFormat();   ///< foreign.cpp; of folders only

/// Whether a file is DICOM by its content.
bool isDicom(const std::string& path);
/// Whether a folder is to be opened as DICOM: the first files in it, or in folders below, are.
bool holdsDicom(const std::string& folder);
/// Whether a folder is one of Zarr.
bool holdsZarr(const std::string& folder);
/// Whether a folder is to be opened as a stack of pictures, one a file.
bool holdsImages(const std::string& folder);
/// The pictures in a folder that have the most frequent suffix, in the order in which people count.
std::vector<std::string> imagesIn(const std::string& folder);
/// Time steps of source.path as *source.raw says, see contentsOf(). Throws FileError.
int rawSteps(const VolumeSource& source, const JobControl& job = {});
/// Headerless data, laid out as *source.raw says; of a gzip file that has another size, what it unpacks to.
Volume readRaw(const VolumeSource& source, const JobControl& job);

} // namespace pellucid
