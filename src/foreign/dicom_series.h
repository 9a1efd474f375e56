// DICOM: files, folders and DICOMDIRs, by GDCM. Runs in pellucid-reader only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foreign/dicom_stack.h"
#include "foreign/foreign_volume.h"

namespace pellucid {

/// One of the series that a path names, as a volume.
class DicomSeries final : public ForeignVolume {
public:
    /// `path`: a folder, with all that lies in it and in folders below; a DICOMDIR; or a file, which stands for all of
    /// its series in the same folder. `wanted`: a name of contents().arrays, a number of a series, its description or
    /// UID; empty: the series with the most pictures. Throws FileError where there is none that can be shown,
    /// UsageError where there is not the one that is wanted.
    DicomSeries(const std::string& path, const std::string& wanted, const BeforeFile& before);

    FileContents contents() const override;
    std::vector<std::string> files() const override;
    ReaderLayout layout(int step) const override;
    std::uint64_t largestImageBytes() const override;
    void read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
              const JobControl& job) const override;

private:
    /// Sets m_type to the smallest type that holds all values, or floats, and m_missing.
    void chooseType();

    std::string m_path, m_name;
    std::vector<std::string> m_names, m_details; ///< of all series
    std::vector<DicomFrame> m_frames;            ///< of this one
    ValueType m_type = ValueType::U8;
    std::optional<double> m_missing; ///< stands for none among whole numbers; among floats NaN does
    DicomStack m_stack;
    std::vector<std::string> m_notices;
};

} // namespace pellucid
