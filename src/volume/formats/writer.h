// The file formats that volumes are written in, each in a file of its own; volume_writer.cpp chooses among them by
// suffix.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

struct VolumeWriter {
    const char* name;                  ///< "NRRD", …
    std::vector<std::string> suffixes; ///< lower case, with the dot: ".nrrd"
    /// Writes the samples in their own type, with where they lie. Throws FileError, Cancelled; then nothing is left.
    void (*write)(const Volume& volume, const std::string& path, const JobControl& job);
    /// What of this geometry a file cannot say, each as a sentence without a full stop.
    std::vector<std::string> (*losses)(const Geometry& geometry);
};

VolumeWriter nrrdWriter();
VolumeWriter metaImageWriter();
VolumeWriter niftiWriter();
VolumeWriter vtiWriter(); ///< vtk_image_writer.cpp
VolumeWriter tiffWriter();
VolumeWriter omeZarrWriter(); ///< of folders

/// The samples as they lie in memory, whose byte order the header has to name.
std::span<const std::byte> sampleBytes(const Volume& volume);
/// Bytes in pieces, so that writing can be watched and stopped; as they are, or several parts as one gzip stream.
void writePieces(OutputFile& out, std::span<const std::byte> bytes, const JobControl& job);
void deflatePieces(OutputFile& out, std::initializer_list<std::span<const std::byte>> parts, const JobControl& job);

} // namespace pellucid
