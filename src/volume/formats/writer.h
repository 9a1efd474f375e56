// The file formats that volumes are written in, each in a file of its own; volume_writer.cpp chooses among them by
// suffix.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/job.h"
#include "volume/step_times.h"
#include "volume/volume.h"

namespace pellucid {

/// What goes into one file: frames of one grid and type.
struct FramesToWrite {
    Geometry geometry{};
    SampleType type = SampleType::U8;
    int count = 1;                    ///< > 0
    std::optional<StepTimes> times{}; ///< of several frames, where they follow each other at one step
    std::vector<double> frameTimes{}; ///< of each frame, in times->unit; empty: not known
    /// The samples of a frame. Writers ask for each once, in their order; the answer holds until the next one.
    std::function<const Volume&(int frame, const JobControl& job)> frame{};

    /// The part of the whole work that is one frame's.
    JobControl part(int n, const JobControl& job) const {
        return job.part(static_cast<std::size_t>(n), static_cast<std::size_t>(count));
    }
};

struct VolumeWriter {
    const char* name;                  ///< "NRRD", …
    std::vector<std::string> suffixes; ///< lower case, with the dot: ".nrrd"
    /// Writes the samples in their own type, with where and when they lie. Throws FileError, Cancelled; then nothing is
    /// left.
    void (*write)(const FramesToWrite& frames, const std::string& path, const JobControl& job);
    /// What of where and when these are a file cannot say, each as a sentence without a full stop. Throws UsageError
    /// where the format cannot hold them at all.
    std::vector<std::string> (*losses)(const FramesToWrite& frames, const std::string& path);
    /// Files that are written beside `path`; null: none are.
    std::vector<std::string> (*filesBeside)(const std::string& path, int frames) = nullptr;
};

VolumeWriter nrrdWriter();
VolumeWriter metaImageWriter();
VolumeWriter niftiWriter();
VolumeWriter vtiWriter(); ///< vtk_image_writer.cpp
VolumeWriter tiffWriter();
VolumeWriter omeZarrWriter(); ///< of folders

/// The samples as they lie in memory, whose byte order the header has to name.
std::span<const std::byte> sampleBytes(const Volume& volume);
/// Bytes in pieces, so that writing can be watched and stopped.
void writePieces(OutputFile& out, std::span<const std::byte> bytes, const JobControl& job);
/// The samples of all frames, one after the other.
void writeFrames(OutputFile& out, const FramesToWrite& frames, const JobControl& job);
/// The same as one gzip stream, `head` before them.
void deflateFrames(OutputFile& out, std::span<const std::byte> head, const FramesToWrite& frames,
                   const JobControl& job);

/// One gzip stream in the making.
class GzipOutput {
public:
    explicit GzipOutput(OutputFile& out); ///< throws std::bad_alloc
    ~GzipOutput();
    GzipOutput(const GzipOutput&) = delete;
    GzipOutput& operator=(const GzipOutput&) = delete;
    /// In pieces, so that writing can be watched and stopped. Throws FileError, Cancelled.
    void write(std::span<const std::byte> bytes, const JobControl& job);
    void finish(); ///< behind the last bytes; throws FileError

private:
    struct Stream; // of zlib
    OutputFile& m_out;
    std::unique_ptr<Stream> m_stream;
};

} // namespace pellucid
