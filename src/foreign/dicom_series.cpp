#include "foreign/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "base/text.h"
#include "foreign/dicom_pixels.h"
#include "volume/file_names.h"
#include "volume/formats/content.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 100'000;

/// All files in a folder and below, in the order of their names.
std::vector<std::string> filesBelow(const std::string& folder) {
    std::vector<std::string> files;
    anyFileBelow(folder, [&](const fs::directory_entry& file) {
        files.push_back(file.path().string());
        return files.size() > kMostFiles;
    });
    if (files.size() > kMostFiles)
        throw FileError("there are more than " + std::to_string(kMostFiles) + " files in this folder", folder,
                        "name the folder of one study");
    std::ranges::sort(files, countsBefore);
    return files;
}

/// The pictures of these files. Files that are no DICOM or have no pictures are passed over; one that cannot be read is
/// told of in `faults`.
std::vector<DicomFrame> framesIn(const std::vector<std::string>& files, const BeforeFile& before,
                                 std::vector<FileError>& faults) {
    std::vector<DicomFrame> frames;
    for (const std::string& file : files) {
        before(bytesOfFile(file));
        if (contentOf(file) != kDicomContent) continue;
        try {
            std::vector<DicomFrame> more = readDicomHeader(file);
            const auto table = frames.empty() ? nullptr : frames.back().table;
            for (DicomFrame& frame : more) // most files of a series have the same one, which may be large
                if (table && frame.table && (frame.table == table || *frame.table == *table)) frame.table = table;
            frames.insert(frames.end(), more.begin(), more.end());
        } catch (const FileError& fault) {
            faults.push_back(fault);
        }
    }
    return frames;
}

/// Pictures that can be in one volume have the same key, and directions that isAlong() takes for the same.
std::string keyOf(const DicomFrame& frame) {
    return frame.seriesUid + "|" + std::to_string(frame.pixels.columns) + "x" + std::to_string(frame.pixels.rows) +
           "x" + std::to_string(frame.pixels.samples) + "|" + std::to_string(frame.pixels.bitsAllocated) +
           (frame.pixels.isSigned ? "s" : "u");
}

/// Whether the slices of two pictures have the same directions, within about a third of a degree: headers round them.
bool isAlong(const DicomFrame& one, const DicomFrame& other) {
    constexpr double kSame = 0.005;
    if (!one.axes || !other.axes) return one.axes.has_value() == other.axes.has_value();
    return glm::distance((*one.axes)[0], (*other.axes)[0]) <= kSame &&
           glm::distance((*one.axes)[1], (*other.axes)[1]) <= kSame;
}

struct Series {
    std::string name;
    std::vector<DicomFrame> frames;
};

std::string nameOf(const DicomFrame& frame) {
    const std::string text = frame.description.empty() ? frame.modality : frame.description;
    return std::to_string(frame.seriesNumber) + (text.empty() ? "" : ": " + printable(text.substr(0, 100)));
}

/// By their numbers; names that several have get numbers behind.
std::vector<Series> seriesOf(const std::vector<DicomFrame>& frames) {
    std::map<std::string, std::vector<Series>> byKey;
    for (const DicomFrame& frame : frames) {
        std::vector<Series>& alike = byKey[keyOf(frame)];
        auto series = std::ranges::find_if(alike, [&](const Series& s) { return isAlong(s.frames.front(), frame); });
        if (series == alike.end()) series = alike.insert(alike.end(), Series());
        series->frames.push_back(frame);
    }
    std::vector<Series> all;
    for (auto& [key, alike] : byKey) std::ranges::move(alike, std::back_inserter(all));
    std::ranges::stable_sort(all, {}, [](const Series& series) { return series.frames.front().seriesNumber; });
    std::set<std::string> taken;
    for (Series& series : all) {
        const std::string name = nameOf(series.frames.front());
        series.name = name;
        for (int n = 2; !taken.insert(series.name).second; ++n) series.name = name + " (" + std::to_string(n) + ")";
    }
    return all;
}

/// "512 × 512 pixels, 24 pictures".
std::string detailsOf(const Series& series) {
    const DicomFrame& first = series.frames.front();
    const std::size_t count = series.frames.size();
    return std::to_string(first.pixels.columns) + " × " + std::to_string(first.pixels.rows) + " pixels, " +
           std::to_string(count) + (count == 1 ? " picture" : " pictures");
}

bool isMeant(const Series& series, const std::string& wanted) {
    const DicomFrame& first = series.frames.front();
    return wanted == series.name || wanted == std::to_string(first.seriesNumber) || wanted == first.description ||
           wanted == first.seriesUid;
}

/// The range of the values that a picture without a slope may have.
ValueRange valueRange(const DicomFrame& frame) {
    if (frame.table) return {static_cast<double>(frame.table->least), static_cast<double>(frame.table->greatest)};
    const ValueRange stored = storedRange(frame.pixels);
    return {stored.lo + frame.intercept, stored.hi + frame.intercept};
}

template <class T>
bool holds(const ValueRange& range) {
    return range.lo >= static_cast<double>(std::numeric_limits<T>::min()) &&
           range.hi <= static_cast<double>(std::numeric_limits<T>::max());
}

double valueIn(const DicomTable& table, double stored) {
    const double last = static_cast<double>(table.values.size() - 1);
    return table.values[static_cast<std::size_t>(std::clamp(stored - table.first, 0.0, last))];
}

/// The values of pictures, file by file as they are asked for.
class PictureReader {
public:
    PictureReader(const std::vector<DicomFrame>& frames, const BeforeFile& before)
        : m_frames(frames), m_before(before) {}

    /// value = slope · stored + intercept of picture n, or that of its table; NaN for padding.
    void read(std::size_t n, std::span<double> values) {
        const DicomFrame& frame = m_frames[n];
        if (m_file != frame.file) {
            m_before(bytesOfFile(frame.file));
            m_bytes = {}; // its memory is wanted
            m_bytes = unpackDicom(frame);
            m_file = frame.file;
        }
        const std::size_t bytesPer = static_cast<std::size_t>(frame.pixels.bitsAllocated / 8);
        const char* from = m_bytes.data() + static_cast<std::size_t>(frame.frame) * values.size() * bytesPer;
        const int unused = 64 - frame.pixels.bitsStored, above = unused - frame.pixels.lowestBit;
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        const auto [firstPadding, lastPadding] = frame.padding.value_or(std::array{kNone, kNone});
        for (double& value : values) {
            std::uint64_t bits = 0;
            if constexpr (std::endian::native == std::endian::little)
                std::memcpy(&bits, from, bytesPer);
            else
                std::memcpy(reinterpret_cast<char*>(&bits) + (8 - bytesPer), from, bytesPer);
            from += bytesPer;
            const std::uint64_t high = bits << above; // some writers put overlays into bits that are not used
            const double stored = frame.pixels.isSigned ? static_cast<double>(static_cast<std::int64_t>(high) >> unused)
                                                        : static_cast<double>(high >> unused);
            if (stored >= firstPadding && stored <= lastPadding)
                value = kNone;
            else
                value = frame.table ? valueIn(*frame.table, stored) : frame.slope * stored + frame.intercept;
        }
    }

private:
    const std::vector<DicomFrame>& m_frames;
    const BeforeFile& m_before;
    std::string m_file;
    std::vector<char> m_bytes;
};

} // namespace

DicomSeries::DicomSeries(const std::string& path, const std::string& wanted, const BeforeFile& before) : m_path(path) {
    std::error_code ec;
    std::vector<FileError> faults;
    std::vector<DicomFrame> frames;
    std::string ownUid;
    if (isFolder(path)) {
        frames = framesIn(filesBelow(path), before, faults);
    } else {
        before(bytesOfFile(path));
        if (const auto named = filesOfDirectory(path); !named.empty()) {
            std::vector<std::string> there;
            std::ranges::copy_if(named, std::back_inserter(there),
                                 [&](const auto& file) { return fs::exists(file, ec); });
            if (there.size() < named.size())
                m_notices.push_back(std::to_string(named.size() - there.size()) + " of " +
                                    std::to_string(named.size()) + " files that the DICOMDIR names are missing");
            frames = framesIn(there, before, faults);
        } else {
            frames = readDicomHeader(path);
            if (frames.empty() && contentOf(path) != kDicomContent) // the library takes much for DICOM
                throw notOfFormat("a DICOM file", path, fileHead(path, 1024));
            if (frames.empty()) throw FileError("this DICOM file has no pictures", path, "name another file");
            if (frames.size() == 1) { // a slice: its series lies around it
                ownUid = frames.front().seriesUid;
                const DicomFrame own = frames.front();
                std::vector<FileError> others; // of files that nobody has named
                std::vector<DicomFrame> around = framesIn(pellucid::filesIn(folderToRead(path)), before, others);
                std::erase_if(around, [&](const DicomFrame& frame) {
                    return keyOf(frame) != keyOf(own) || !isAlong(frame, own);
                });
                if (around.size() > 1 && !ownUid.empty()) frames = std::move(around);
            }
        }
    }
    if (frames.empty()) {
        if (!faults.empty()) throw faults.front();
        throw FileError("no DICOM file here has pictures", path, "name another folder");
    }
    std::vector<Series> all = seriesOf(frames);
    for (const Series& series : all) {
        m_names.push_back(series.name);
        m_details.push_back(detailsOf(series));
    }
    auto chosen = std::ranges::max_element(all, {}, [](const Series& series) { return series.frames.size(); });
    if (!wanted.empty()) {
        chosen = std::ranges::find_if(all, [&](const Series& series) { return isMeant(series, wanted); });
        if (chosen == all.end())
            throw UsageError(
                "there is no series " + inQuotes(wanted), path,
                "there " + std::string(all.size() == 1 ? "is " : "are ") +
                    joined(std::span(m_names).first(std::min<std::size_t>(m_names.size(), 20)), ", ", inQuotes));
    }
    m_name = chosen->name;
    m_frames = std::move(chosen->frames);
    chooseType();
    if (all.size() > 1 && wanted.empty())
        m_notices.push_back("series " + inQuotes(m_name) + " of " + std::to_string(all.size()) + " is shown");
    if (!faults.empty())
        m_notices.push_back(std::to_string(faults.size()) + (faults.size() == 1 ? " file" : " files") +
                            " cannot be read and " + (faults.size() == 1 ? "is" : "are") + " left out: " +
                            faults.front().problem() + ", " + fs::path(faults.front().where()).filename().string());
    if (m_frames.front().photometric == "MONOCHROME1")
        m_notices.emplace_back("small values are meant to be bright (MONOCHROME1): values are kept as they are");
    if (m_frames.front().photometric == "PALETTE COLOR")
        m_notices.emplace_back("colours of a palette are shown as their numbers");
    const auto isScaled = [](const DicomFrame& frame) { return frame.slope != 1 || frame.intercept != 0; };
    if (m_frames.front().table && isScaled(m_frames.front()))
        m_notices.emplace_back("the files have both a table of values (Modality LUT) and a rescale: the table is used");
    m_stack = stackOf(m_frames, path);
}

void DicomSeries::chooseType() {
    const DicomFrame& first = m_frames.front();
    ValueRange range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    bool isWhole = true, isPadded = false,
         isSame = !first.table; // isSame: padding is one value, which nothing else has
    for (const DicomFrame& frame : m_frames) {
        isWhole = isWhole && (frame.table || (frame.slope == 1 && frame.intercept == std::floor(frame.intercept)));
        isPadded = isPadded || frame.padding;
        isSame = isSame && !frame.table && frame.padding == first.padding && frame.intercept == first.intercept;
        const ValueRange values = valueRange(frame);
        range.lo = std::min(range.lo, values.lo);
        range.hi = std::max(range.hi, values.hi);
    }
    if (!isWhole) { // floats hold the numbers of 24 bits
        m_type = first.pixels.bitsStored <= 24 ? ValueType::F32 : ValueType::F64;
        return;
    }
    if (isPadded) m_missing = isSame ? (*first.padding)[0] + first.intercept : range.lo -= 1;
    m_type = ValueType::F64;
    if (holds<std::int32_t>(range)) m_type = ValueType::I32;
    if (holds<std::uint32_t>(range)) m_type = ValueType::U32;
    if (holds<std::int16_t>(range)) m_type = ValueType::I16;
    if (holds<std::uint16_t>(range)) m_type = ValueType::U16;
    if (holds<std::int8_t>(range)) m_type = ValueType::I8;
    if (holds<std::uint8_t>(range)) m_type = ValueType::U8;
}

ReaderLayout DicomSeries::layout(int step) const {
    requireIndex("time step", step, m_stack.steps.size(), m_path);
    ReaderLayout answer;
    FileLayout& layout = answer.layout;
    const Geometry& g = m_stack.geometry;
    layout.type = m_type;
    const int samples = m_frames.front().pixels.samples;
    if (samples > 1) layout.axes.push_back({samples, true});
    for (int a = 0; a < 3; ++a) layout.axes.push_back({g.dims[a]});
    layout.spacing = g.spacing;
    layout.origin = g.origin;
    layout.directions = g.directions;
    layout.worldAxes = g.worldAxes;
    layout.lengthUnit = g.lengthUnit;
    layout.array = m_name;
    layout.notices = m_notices;
    layout.notices.insert(layout.notices.end(), m_stack.notices.begin(), m_stack.notices.end());
    // A file is unpacked as a whole; where layers lie between pictures, those at the ends are read once more.
    const auto isBetween = [](const DicomLayer& layer) { return layer.toAfter > 0; };
    if (std::ranges::any_of(m_stack.steps.at(static_cast<std::size_t>(step)), isBetween))
        answer.layersAtOnce = std::min(32, g.dims.z);
    for (const DicomFrame& frame : m_frames)
        answer.layersAtOnce = std::max(answer.layersAtOnce, std::min(frame.framesInFile, g.dims.z));
    answer.missing = m_missing;
    return answer;
}

FileContents DicomSeries::contents() const {
    FileContents contents = contentsOf(layout(0).layout);
    contents.steps = static_cast<int>(m_stack.steps.size());
    contents.times = m_stack.times;
    contents.timeUnit = m_stack.timeUnit;
    contents.arrays = m_names;
    contents.details = m_details;
    return contents;
}

std::vector<std::string> DicomSeries::files() const {
    std::set<std::string> files;
    for (const DicomFrame& frame : m_frames) files.insert(frame.file);
    return {files.begin(), files.end()};
}

std::uint64_t DicomSeries::largestImageBytes() const {
    std::uint64_t most = 0;
    for (const DicomFrame& frame : m_frames) {
        const DicomPixels& p = frame.pixels;
        most = std::max(most, static_cast<std::uint64_t>(p.columns) * static_cast<std::uint64_t>(p.rows) *
                                  static_cast<std::uint64_t>(p.samples * frame.framesInFile * (p.bitsAllocated / 8)));
    }
    return most;
}

void DicomSeries::read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
                       const JobControl& job) const {
    const DicomPixels& pixels = m_frames.front().pixels;
    const glm::ivec2 size(pixels.columns, pixels.rows);
    const auto perVoxel = static_cast<std::size_t>(pixels.samples);
    const std::size_t samples = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * perVoxel;
    const std::vector<DicomLayer>& layers = m_stack.steps.at(static_cast<std::size_t>(step));
    PictureReader pictures(m_frames, before);
    std::map<std::size_t, std::vector<double>> values; // the last two pictures
    const auto picture = [&](std::size_t n) -> const std::vector<double>& {
        if (const auto found = values.find(n); found != values.end()) return found->second;
        std::vector<double> read(samples);
        pictures.read(n, read);
        return values[n] = std::move(read);
    };
    withType(m_type, [&](auto zero) {
        using T = decltype(zero);
        const VoxelRegion& region = box.region;
        std::vector<T> slice;
        for (int z = region.lo.z; z < region.hi.z; ++z) {
            const DicomLayer& layer = layers.at(static_cast<std::size_t>(z));
            std::erase_if(values,
                          [&](const auto& entry) { return entry.first != layer.before && entry.first != layer.after; });
            const std::vector<double>& from = picture(layer.before);
            const std::vector<double>& other = picture(layer.after);
            slice.resize(samples);
            for (std::size_t i = 0; i < samples; ++i) {
                double value = from[i];
                if (layer.toAfter > 0) value += layer.toAfter * (other[i] - from[i]);
                if constexpr (std::is_integral_v<T>) value = std::round(value);
                // Between two pictures a value may come to lie where padding does.
                if (m_missing && layer.toAfter > 0 && value == *m_missing) value = from[i];
                if (m_missing && std::isnan(value)) value = *m_missing;
                slice[i] = static_cast<T>(value);
            }
            voxels = copyFromSlice(std::as_bytes(std::span(slice)), size, perVoxel * sizeof(T), region, voxels);
            job.throwIfStopped();
            job.report(static_cast<double>(z + 1 - region.lo.z) / static_cast<double>(region.hi.z - region.lo.z));
        }
    });
}

} // namespace pellucid
