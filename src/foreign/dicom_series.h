// DICOM: files, folders and DICOMDIRs, by GDCM. Runs in pellucid-reader only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "foreign/dicom_stack.h"
#include "volume/process/reader_messages.h"

namespace pellucid {

/// Called before a file of so many bytes is looked at.
using BeforeFile = std::function<void(std::uint64_t bytes)>;

/// One of the series that a path names, as a volume.
class DicomSeries {
public:
    /// `path`: a folder, with all that lies in it and in folders below; a DICOMDIR; or a file, which stands for all of
    /// its series in the same folder. `wanted`: a name of names(), a number of a series, its description or UID; empty:
    /// the series with the most pictures. Throws FileError where there is none that can be shown, UsageError where
    /// there is not the one that is wanted.
    DicomSeries(const std::string& path, const std::string& wanted, const BeforeFile& before);

    /// Leaves of all slices the one in the middle.
    void keepMiddle();

    FileContents contents() const;
    std::vector<std::string> files() const;  ///< that hold its pixels
    ReaderLayout layout(int step) const;     ///< throws UsageError where there is no such step
    std::uint64_t largestFileBytes() const;  ///< of its files
    std::uint64_t largestImageBytes() const; ///< of what one of them unpacks to
    /// Writes the voxels of a step as layout() says. Throws FileError for a file that cannot be unpacked; Cancelled.
    void read(int step, std::span<std::byte> voxels, const BeforeFile& before, const JobControl& job) const;

    /// What has to be readable to open a path: the folder that its files are in.
    static std::string folderOf(const std::string& path);

private:
    struct Kept {
        ValueType type = ValueType::U8;
        bool exact = true; ///< stored numbers, with a whole number added
    };
    Kept keptAs() const;

    std::string m_path, m_name;
    std::vector<std::string> m_names, m_details; ///< of all series
    std::vector<DicomFrame> m_frames;            ///< of this one
    DicomStack m_stack;
    std::vector<std::string> m_notices;
};

} // namespace pellucid
