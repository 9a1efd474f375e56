// What the headers of DICOM files say of the pictures in them; their pixels are not looked at.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// What tells apart pictures of one place, in the order in which it is asked. Numbers in the unit beside.
enum class DicomTime {
    TemporalPosition, ///< its number
    BValue,           ///< of diffusion, s/mm²
    TriggerTime,      ///< ms after the heart beat
    FrameTime,        ///< ms after the first frame
    EchoTime,         ///< ms
    AcquisitionNumber,
    AcquisitionTime, ///< s since midnight
    ContentTime      ///< s since midnight
};
inline constexpr std::size_t kDicomTimes = 8;

/// How the numbers of a picture are stored.
struct DicomPixels {
    int columns = 0, rows = 0;
    int samples = 1;       ///< for each pixel
    int bitsAllocated = 0; ///< 8, 16 or 32
    int bitsStored = 0;
    int lowestBit = 0; ///< of those that are stored, in those that are allocated
    bool isSigned = false;
    bool areBits = false; ///< eight to a byte; bitsAllocated is 8, as they come out
    bool operator==(const DicomPixels&) const = default;
};

/// The range of the numbers that may be stored.
ValueRange storedRange(const DicomPixels& pixels);

/// The values of stored numbers, from `first` on (Modality LUT). Those below have the first value, those above the
/// last.
struct DicomTable {
    int first = 0;
    std::vector<std::uint16_t> values;     ///< never empty
    std::uint16_t least = 0, greatest = 0; ///< of these
    bool operator==(const DicomTable&) const = default;
};

/// One picture: a file, or a frame of one. Lengths in mm; directions and places to the patient's left, back and head.
struct DicomFrame {
    std::string file;
    int frame = 0; ///< in the file, from 0
    int framesInFile = 1;
    std::string seriesUid, instanceUid, description, modality;
    std::int64_t seriesNumber = 0, instanceNumber = 0;
    DicomPixels pixels;
    std::string photometric; ///< "MONOCHROME2", …
    /// How they lie in the file, whose pictures begin at byte `pixelsAt`: as they are, packed one by one
    /// (Encapsulated), or with the whole file (Deflated).
    enum class Storage { Plain, Encapsulated, Deflated } storage = Storage::Plain;
    std::uint64_t pixelsAt = 0;
    bool isPlanar = false;                        ///< of several samples, all of the first come first
    bool isBigEndian = false, areWords = false;   ///< of Plain; words: bytes are swapped as of numbers of 16 bits
    std::optional<Vec3> position;                 ///< of the first pixel's centre
    std::optional<std::array<Vec3, 2>> axes;      ///< unit vectors: where columns count up, where rows do
    std::optional<std::array<double, 2>> spacing; ///< from column to column, from row to row
    double thickness = 0;                         ///< from slice to slice, where the header says it; 0: it does not
    double slope = 1, intercept = 0;              ///< value = slope · stored + intercept
    std::shared_ptr<const DicomTable> table;      ///< where given, the values are those of it instead
    /// The stored numbers that stand for none, from the first to the last one, within storedRange(); never of several
    /// samples.
    std::optional<std::array<double, 2>> padding;
    std::array<std::optional<double>, kDicomTimes> times;
};

/// The pictures in a file; none where it has no pixels, as reports and settings of viewers. Throws FileError for a file
/// that is no DICOM, or whose pictures cannot be read.
std::vector<DicomFrame> readDicomHeader(const std::string& path);

/// The files that a DICOMDIR names, as paths. Empty where the file is none. Throws FileError.
std::vector<std::string> filesOfDirectory(const std::string& path);

} // namespace pellucid
