#include "foreign/dicom_header.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gdcmItem.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include "base/text.h"
#include "volume/formats/content.h"
#include "volume/formats/file_check.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;
using gdcm::DataSet;
using gdcm::Tag;

const Tag kPixels(0x7fe0, 0x0010);

/// The bytes of an element; nothing where it is not there, or has items instead.
std::string bytesOf(const DataSet& set, const Tag& tag) {
    if (!set.FindDataElement(tag)) return {};
    const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
    return value == nullptr || value->GetPointer() == nullptr ? std::string()
                                                              : std::string(value->GetPointer(), value->GetLength());
}

std::string textOf(const DataSet& set, const Tag& tag) {
    std::string text = bytesOf(set, tag);
    std::erase(text, '\0');
    return trimmed(text);
}

/// A text for people, in UTF-8: from Latin-1 where the file says that (ISO_IR 100) or says nothing. Texts in other sets
/// of characters stay as they are.
std::string wordsOf(const DataSet& set, const Tag& tag) {
    const std::string charset = textOf(set, Tag(0x0008, 0x0005)), text = textOf(set, tag);
    if (!charset.empty() && charset.find("ISO_IR 100") == std::string::npos) return text;
    std::string words;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x80)
            words += c;
        else
            words += {static_cast<char>(0xc0 | code >> 6), static_cast<char>(0x80 | (code & 0x3f))};
    }
    return words;
}

/// The numbers of a decimal or integer string.
std::vector<double> numbersOf(const DataSet& set, const Tag& tag) {
    std::vector<double> numbers;
    for (const std::string& part : splitAt('\\', textOf(set, tag))) numbers.push_back(numberIn(trimmed(part)));
    if (std::ranges::any_of(numbers, [](double v) { return !std::isfinite(v); })) numbers.clear();
    return numbers;
}

std::optional<double> numberOf(const DataSet& set, const Tag& tag) {
    const std::vector<double> numbers = numbersOf(set, tag);
    return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

/// The binary numbers of an element; the library has turned their bytes as they are here.
template <class T>
std::vector<T> binariesOf(const DataSet& set, const Tag& tag) {
    const std::string bytes = bytesOf(set, tag);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

template <class T>
std::optional<T> binaryOf(const DataSet& set, const Tag& tag) {
    const std::vector<T> values = binariesOf<T>(set, tag);
    return values.empty() ? std::nullopt : std::optional(values.front());
}

/// Where a maker of scanners has put an element of its own: behind one that names it.
std::optional<Tag> privateTag(const DataSet& set, std::uint16_t group, const char* maker, std::uint16_t element) {
    for (std::uint16_t from = 0x10;;) {
        const Tag found = set.FindNextDataElement(Tag(group, from)).GetTag();
        const std::uint16_t block = found.GetElement();
        if (found.GetGroup() != group || block > 0xff) return {};
        if (textOf(set, found) == maker) return Tag(group, static_cast<std::uint16_t>(block << 8 | element));
        from = static_cast<std::uint16_t>(block + 1);
    }
}

/// Of diffusion; many scanners have it in elements of their makers alone.
std::optional<double> bValueOf(const DataSet& set) {
    if (const auto value = binaryOf<double>(set, Tag(0x0018, 0x9087))) return value;
    if (const auto tag = privateTag(set, 0x0019, "SIEMENS MR HEADER", 0x0c))
        if (const auto value = numberOf(set, *tag)) return value;
    if (const auto tag = privateTag(set, 0x0043, "GEMS_PARM_01", 0x39))
        if (const auto value = numberOf(set, *tag)) return std::fmod(*value, 1e9); // which newer scanners add
    if (const auto tag = privateTag(set, 0x2001, "Philips Imaging DD 001", 0x03))
        if (const auto value = binaryOf<float>(set, *tag)) return *value;
    return {};
}

std::int64_t wholeOf(const DataSet& set, const Tag& tag) {
    const auto number = numberOf(set, tag);
    constexpr double kMost = 1e15;
    return number && std::abs(*number) < kMost ? static_cast<std::int64_t>(*number) : 0;
}

/// Seconds of "HHMMSS.FRAC".
std::optional<double> secondsOf(const DataSet& set, const Tag& tag) {
    const std::string text = textOf(set, tag);
    if (text.size() < 6) return {};
    const double hours = numberIn(text.substr(0, 2)), minutes = numberIn(text.substr(2, 2)),
                 seconds = numberIn(text.substr(4));
    const double all = hours * 3600 + minutes * 60 + seconds;
    return std::isfinite(all) ? std::optional(all) : std::nullopt;
}

/// The items of a sequence; none where there is no such sequence.
std::vector<DataSet> itemsOf(const DataSet& set, const Tag& tag, std::size_t most) {
    std::vector<DataSet> items;
    if (!set.FindDataElement(tag)) return items;
    const auto sequence = set.GetDataElement(tag).GetValueAsSQ();
    if (!sequence) return items;
    for (std::size_t i = 1; i <= std::min<std::size_t>(sequence->GetNumberOfItems(), most); ++i)
        items.push_back(sequence->GetItem(i).GetNestedDataSet());
    return items;
}

DataSet firstItem(const DataSet& set, const Tag& tag) {
    const std::vector<DataSet> items = itemsOf(set, tag, 1);
    return items.empty() ? DataSet() : items.front();
}

std::optional<Vec3> placeIn(const DataSet& set) {
    const std::vector<double> numbers = numbersOf(set, Tag(0x0020, 0x0032));
    if (numbers.size() != 3) return {};
    return Vec3(numbers[0], numbers[1], numbers[2]);
}

std::optional<std::array<Vec3, 2>> axesIn(const DataSet& set) {
    const std::vector<double> n = numbersOf(set, Tag(0x0020, 0x0037));
    if (n.size() != 6) return {};
    const Vec3 columns(n[0], n[1], n[2]), rows(n[3], n[4], n[5]);
    const double area = glm::length(glm::cross(columns, rows));
    if (!(area > 1e-3)) return {};
    return std::array{glm::normalize(columns), glm::normalize(rows)};
}

std::optional<std::array<double, 2>> spacingIn(const DataSet& set) {
    // In the patient; on the detector, which is what radiographs know; where a phantom was.
    for (const Tag& tag : {Tag(0x0028, 0x0030), Tag(0x0018, 0x1164), Tag(0x0018, 0x2010)}) {
        const std::vector<double> numbers = numbersOf(set, tag);
        if (numbers.size() == 2 && numbers[0] > 0 && numbers[1] > 0) return std::array{numbers[1], numbers[0]};
    }
    return {};
}

double thicknessIn(const DataSet& set) {
    for (const Tag& tag : {Tag(0x0018, 0x0088), Tag(0x0018, 0x0050)})
        if (const auto number = numberOf(set, tag); number && *number > 0) return *number;
    return 0;
}

void takeScaling(DicomFrame& frame, const DataSet& set) {
    if (const auto slope = numberOf(set, Tag(0x0028, 0x1053)); slope && *slope != 0) frame.slope = *slope;
    if (const auto intercept = numberOf(set, Tag(0x0028, 0x1052))) frame.intercept = *intercept;
}

/// What the Modality LUT of a file says; nothing where there is none.
std::shared_ptr<const DicomTable> tableIn(const DataSet& set, bool isSigned, const std::string& path) {
    const std::vector<DataSet> items = itemsOf(set, Tag(0x0028, 0x3000), 1);
    if (items.empty()) return {};
    // How many values there are (0: 65536), the number of the first one, and the bits of each.
    const auto described = binariesOf<std::uint16_t>(items.front(), Tag(0x0028, 0x3002));
    const std::string bytes = bytesOf(items.front(), Tag(0x0028, 0x3006));
    const std::size_t count = described.empty() || described[0] == 0 ? 65536 : described[0];
    if (described.size() < 3 || bytes.size() < count)
        throw FileError("the table of its values (Modality LUT) is damaged, or cut off", path,
                        "copy the file again, or export the series again");
    DicomTable table;
    table.first = isSigned ? static_cast<std::int16_t>(described[1]) : described[1];
    if (bytes.size() >= 2 * count) {
        table.values = binariesOf<std::uint16_t>(items.front(), Tag(0x0028, 0x3006));
    } else if (described[2] <= 8) { // two in a word
        for (const char byte : bytes) table.values.push_back(static_cast<unsigned char>(byte));
    } else {
        throw FileError("the table of its values (Modality LUT) has " + std::to_string(bytes.size()) + " of " +
                            std::to_string(2 * count) + " bytes",
                        path, "copy the file again, or export the series again");
    }
    table.values.resize(count);
    const auto [least, greatest] = std::ranges::minmax(table.values);
    table.least = least;
    table.greatest = greatest;
    return std::make_shared<const DicomTable>(std::move(table));
}

/// The stored numbers that stand for none (Pixel Padding Value, Pixel Padding Range Limit).
std::optional<std::array<double, 2>> paddingIn(const DataSet& set, const DicomPixels& pixels) {
    const auto number = [&](std::uint16_t element) -> std::optional<double> {
        const auto value = binaryOf<std::uint16_t>(set, Tag(0x0028, element));
        if (!value) return {};
        return pixels.isSigned ? static_cast<double>(static_cast<std::int16_t>(*value)) : *value;
    };
    const std::optional<double> value = number(0x0120);
    if (!value) return {};
    const double limit = number(0x0121).value_or(*value);
    const ValueRange stored = storedRange(pixels);
    const double first = std::max(std::min(*value, limit), stored.lo),
                 last = std::min(std::max(*value, limit), stored.hi);
    return first <= last ? std::optional(std::array{first, last}) : std::nullopt;
}

void setTime(DicomFrame& frame, DicomTime time, std::optional<double> value) {
    if (value && std::isfinite(*value)) frame.times[static_cast<std::size_t>(time)] = value;
}

void takeTimes(DicomFrame& frame, const DataSet& set) {
    setTime(frame, DicomTime::TemporalPosition, numberOf(set, Tag(0x0020, 0x0100)));
    setTime(frame, DicomTime::BValue, bValueOf(set));
    setTime(frame, DicomTime::TriggerTime, numberOf(set, Tag(0x0018, 0x1060)));
    setTime(frame, DicomTime::EchoTime, numberOf(set, Tag(0x0018, 0x0081)));
    setTime(frame, DicomTime::AcquisitionNumber, numberOf(set, Tag(0x0020, 0x0012)));
    setTime(frame, DicomTime::AcquisitionTime, secondsOf(set, Tag(0x0008, 0x0032)));
    setTime(frame, DicomTime::ContentTime, secondsOf(set, Tag(0x0008, 0x0033)));
}

/// What the functional groups of an enhanced file say: those of one frame, or those of all.
void takeGroups(DicomFrame& frame, const DataSet& groups) {
    if (const auto place = placeIn(firstItem(groups, Tag(0x0020, 0x9113)))) frame.position = place;
    if (const auto axes = axesIn(firstItem(groups, Tag(0x0020, 0x9116)))) frame.axes = axes;
    const DataSet measures = firstItem(groups, Tag(0x0028, 0x9110));
    if (const auto spacing = spacingIn(measures)) frame.spacing = spacing;
    if (const double thickness = thicknessIn(measures); thickness > 0) frame.thickness = thickness;
    takeScaling(frame, firstItem(groups, Tag(0x0028, 0x9145)));
    const DataSet content = firstItem(groups, Tag(0x0020, 0x9111));
    if (const auto index = binaryOf<std::uint32_t>(content, Tag(0x0020, 0x9128)))
        setTime(frame, DicomTime::TemporalPosition, *index);
    const DataSet diffusion = firstItem(groups, Tag(0x0018, 0x9117));
    setTime(frame, DicomTime::BValue, binaryOf<double>(diffusion, Tag(0x0018, 0x9087)));
    setTime(frame, DicomTime::EchoTime, binaryOf<double>(firstItem(groups, Tag(0x0018, 0x9114)), Tag(0x0018, 0x9082)));
    setTime(frame, DicomTime::TriggerTime,
            binaryOf<double>(firstItem(groups, Tag(0x0018, 0x9118)), Tag(0x0020, 0x9153)));
}

DicomPixels pixelsIn(const DataSet& set, const std::string& path) {
    const auto number = [&](std::uint16_t element, int otherwise) {
        const auto value = binaryOf<std::uint16_t>(set, Tag(0x0028, element));
        return value ? static_cast<int>(*value) : otherwise;
    };
    DicomPixels pixels;
    pixels.rows = number(0x0010, 0);
    pixels.columns = number(0x0011, 0);
    pixels.samples = number(0x0002, 1);
    pixels.bitsAllocated = number(0x0100, 0);
    pixels.bitsStored = number(0x0101, pixels.bitsAllocated);
    pixels.isSigned = number(0x0103, 0) == 1;
    if (pixels.rows < 1 || pixels.columns < 1)
        throw FileError("the header gives a picture of " + std::to_string(pixels.columns) + " x " +
                            std::to_string(pixels.rows) + " pixels",
                        path, "copy the file again");
    if (pixels.bitsAllocated == 1 && pixels.samples == 1) { // a segmentation
        pixels.areBits = true;
        pixels.bitsAllocated = 8;
    }
    if (pixels.bitsAllocated != 8 && pixels.bitsAllocated != 16 && pixels.bitsAllocated != 32)
        throw FileError("pixels of " + std::to_string(pixels.bitsAllocated) + " bits are not supported", path,
                        "convert the file to 8, 16 or 32 bits");
    if (pixels.bitsStored < 1 || pixels.bitsStored > pixels.bitsAllocated)
        throw FileError("the header says that " + std::to_string(pixels.bitsStored) + " of " +
                            std::to_string(pixels.bitsAllocated) + " bits are used",
                        path, "correct the header, or export the series again");
    const int highBit = number(0x0102, pixels.bitsStored - 1);
    pixels.lowestBit = highBit + 1 - pixels.bitsStored;
    if (pixels.lowestBit < 0 || highBit >= pixels.bitsAllocated)
        throw FileError("the header says that the " + std::to_string(pixels.bitsStored) + " bits in use of " +
                            std::to_string(pixels.bitsAllocated) + " end with bit " + std::to_string(highBit) +
                            " (HighBit)",
                        path, "correct the header, or export the series again");
    if (pixels.samples < 1 || pixels.samples > 4)
        throw FileError("the header gives " + std::to_string(pixels.samples) + " samples for each pixel", path,
                        "copy the file again");
    return pixels;
}

/// Places of frames that the header gives all together: their distances from the first one, or steps of a film.
void placeFrames(std::vector<DicomFrame>& frames, const DataSet& set) {
    const DicomFrame first = frames.front();
    const std::string pointer = bytesOf(set, Tag(0x0028, 0x0009));
    const auto pointsTo = [&](std::uint16_t group, std::uint16_t element) {
        const std::array<std::uint16_t, 2> tag{group, element};
        for (std::size_t at = 0; at + sizeof tag <= pointer.size(); at += sizeof tag)
            if (std::memcmp(pointer.data() + at, tag.data(), sizeof tag) == 0) return true;
        return false;
    };
    const std::vector<double> offsets = numbersOf(set, Tag(0x3004, 0x000c));
    const double frameTime = numberOf(set, Tag(0x0018, 0x1063)).value_or(0);
    const bool isFilm = pointsTo(0x0018, 0x1063) || pointsTo(0x0018, 0x1065);
    const bool hasOffsets = offsets.size() == frames.size() && first.axes && first.position;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        DicomFrame& frame = frames[i];
        if (isFilm) {
            if (!frame.position) frame.position = Vec3(0);
            frame.times = {};
            setTime(frame, DicomTime::FrameTime, static_cast<double>(i) * (frameTime > 0 ? frameTime : 1));
        } else if (hasOffsets) { // the first may be the place itself, along the axis of the patient
            const Vec3 normal = glm::cross((*first.axes)[0], (*first.axes)[1]);
            frame.position = *first.position + normal * (offsets[i] - offsets[0]);
        } else if (first.axes && first.position && first.thickness > 0) {
            const Vec3 normal = glm::cross((*first.axes)[0], (*first.axes)[1]);
            frame.position = *first.position + normal * (first.thickness * static_cast<double>(i));
        } else {
            frame.position.reset();
        }
    }
}

/// All elements before the pixels, whose bytes are passed over.
bool readUpToPixels(gdcm::Reader& reader, const std::string& path) {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    reader.SetFileName(path.c_str());
    return reader.ReadUpToTag(kPixels, {kPixels});
}

/// `count` bytes of a file, fewer where it is shorter.
std::string fileBytes(const std::string& path, std::uint64_t at, std::size_t count) {
    std::string bytes(count, '\0');
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(at));
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

void takeStorage(DicomFrame& frame, const gdcm::Reader& reader) {
    const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    frame.pixelsAt = reader.GetStreamCurrentPosition();
    frame.isBigEndian = syntax == gdcm::TransferSyntax::ExplicitVRBigEndian ||
                        syntax == gdcm::TransferSyntax::ImplicitVRBigEndianPrivateGE;
    frame.areWords = frame.isBigEndian && fileBytes(frame.file, frame.pixelsAt - 8, 2) != "OB";
    if (syntax.IsEncapsulated()) frame.storage = DicomFrame::Storage::Encapsulated;
    if (syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) frame.storage = DicomFrame::Storage::Deflated;
}

} // namespace

ValueRange storedRange(const DicomPixels& pixels) {
    const double half = std::ldexp(1.0, pixels.bitsStored - 1);
    return pixels.isSigned ? ValueRange{-half, half - 1} : ValueRange{0, 2 * half - 1};
}

std::vector<DicomFrame> readDicomHeader(const std::string& path) {
    gdcm::Reader reader;
    if (!readUpToPixels(reader, path)) {
        if (contentOf(path) != kDicomContent) throw notOfFormat("a DICOM file", path, fileHead(path, 1024));
        throw FileError("the header of this DICOM file cannot be read", path, "copy the file again");
    }
    const DataSet& set = reader.GetFile().GetDataSet();
    const bool hasPixels = reader.GetStreamCurrentPosition() != static_cast<std::size_t>(-1); // else it has met the end
    if (!hasPixels || !set.FindDataElement(Tag(0x0028, 0x0010)) || !set.FindDataElement(Tag(0x0028, 0x0011))) return {};
    DicomFrame frame;
    frame.file = path;
    frame.seriesUid = textOf(set, Tag(0x0020, 0x000e));
    frame.instanceUid = textOf(set, Tag(0x0008, 0x0018));
    frame.description = wordsOf(set, Tag(0x0008, 0x103e));
    frame.modality = textOf(set, Tag(0x0008, 0x0060));
    frame.seriesNumber = wholeOf(set, Tag(0x0020, 0x0011));
    frame.instanceNumber = wholeOf(set, Tag(0x0020, 0x0013));
    frame.photometric = textOf(set, Tag(0x0028, 0x0004));
    frame.pixels = pixelsIn(set, path);
    takeStorage(frame, reader);
    frame.isPlanar = binaryOf<std::uint16_t>(set, Tag(0x0028, 0x0006)).value_or(0) == 1;
    const DataSet detector = firstItem(set, Tag(0x0054, 0x0022)); // of a gamma camera
    frame.position = placeIn(set) ? placeIn(set) : placeIn(detector);
    frame.axes = axesIn(set) ? axesIn(set) : axesIn(detector);
    frame.spacing = spacingIn(set);
    frame.thickness = thicknessIn(set);
    takeScaling(frame, set);
    if (const auto dose = numberOf(set, Tag(0x3004, 0x000e)); dose && *dose > 0) frame.slope = *dose;
    if (frame.pixels.samples == 1) {
        frame.table = tableIn(set, frame.pixels.isSigned, path);
        frame.padding = paddingIn(set, frame.pixels);
    }
    takeTimes(frame, set);

    constexpr double kMostFrames = 1'000'000;
    const double count = numberOf(set, Tag(0x0028, 0x0008)).value_or(1);
    if (!(count >= 1) || count > kMostFrames)
        throw FileError("the header gives " + textOf(set, Tag(0x0028, 0x0008)) + " frames", path,
                        "copy the file again");
    frame.framesInFile = static_cast<int>(count);
    std::vector<DicomFrame> frames(static_cast<std::size_t>(frame.framesInFile), frame);
    for (int i = 0; i < frame.framesInFile; ++i) frames[static_cast<std::size_t>(i)].frame = i;
    if (frame.framesInFile == 1 && !set.FindDataElement(Tag(0x5200, 0x9230))) return frames;
    const DataSet shared = firstItem(set, Tag(0x5200, 0x9229));
    const std::vector<DataSet> own = itemsOf(set, Tag(0x5200, 0x9230), frames.size());
    if (own.size() != frames.size()) {
        placeFrames(frames, set);
        return frames;
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].position.reset();
        frames[i].times = {};
        takeGroups(frames[i], shared);
        takeGroups(frames[i], own[i]);
    }
    return frames;
}

std::vector<std::string> filesOfDirectory(const std::string& path) {
    gdcm::Reader reader;
    if (!readUpToPixels(reader, path)) return {};
    std::vector<std::string> files;
    constexpr std::size_t kMostRecords = 1'000'000;
    for (const DataSet& record : itemsOf(reader.GetFile().GetDataSet(), Tag(0x0004, 0x1220), kMostRecords)) {
        std::string name = textOf(record, Tag(0x0004, 0x1500));
        if (name.empty()) continue;
        std::ranges::replace(name, '\\', '/');
        const fs::path relative(name);
        const bool leaves = relative.is_absolute() || std::ranges::find(relative, fs::path("..")) != relative.end();
        if (!leaves) files.push_back((fs::path(path).parent_path() / relative).string());
    }
    return files;
}

} // namespace pellucid
