// pellucid-reader: the program that holds the libraries of file formats that are not ours. What a file does to them, it
// does to a process that has no other files and may be ended at any time; voxels come back through shared memory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/job.h"
#include "volume/process/reader_messages.h"

namespace pellucid {

/// The reader was ended since the file takes it too long: so it would the next time.
class TakesTooLong : public FileError {
public:
    using FileError::FileError;
};

/// All throw FileError or UsageError as the reader says it, or FileError where it crashes, falls silent or cannot be
/// started; Cancelled, and the process has been ended then.
ReaderDescription describeInProcess(const ReaderRequest& request, const JobControl& job);
/// The volume that the reader has read, as readSamples() makes it of `source`.
Volume readInProcess(const VolumeSource& source, const ReaderRequest& request, const JobControl& job);

/// The layer across the middle of its z axis.
Volume readMiddleInProcess(const VolumeSource& source, const ReaderRequest& request, const JobControl& job);

/// The program that is started; empty: pellucid-reader beside this program, or where it is installed. For tests.
void setReaderProgram(const std::filesystem::path& program);

} // namespace pellucid
