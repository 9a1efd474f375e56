// PVM, the format of the program V^3: a short text header and the voxels, plain or packed as DDS.
#include <algorithm>
#include <array>
#include <memory>

#include "volume/formats/dds_bytes.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

constexpr const char* kToDo = "check the sizes in the header, or copy the file again";

/// What stands before the voxels.
struct PvmHeader {
    int version = 1;
    std::array<std::int64_t, 3> dims{};
    Vec3 spacing{1, 1, 1};
    std::int64_t bytesPerVoxel = 1;
    std::uint64_t bytes = 0; ///< of the header itself
};

/// The first bytes of the file, unpacked where it is packed.
std::string unpackedHead(const std::string& path, const JobControl& job) {
    constexpr std::size_t kMost = 4096;
    std::string head = fileHead(path, kMost);
    if (!isDds(head)) return head;
    head.resize(kMost);
    DdsStream stream(path, job);
    if (stream.planes() == 1)
        head.resize(stream.read(head.data(), kMost));
    else
        head.resize(DdsBytes(path, ddsLength(path, job), job).read(head.data(), kMost));
    return head;
}

/// Reads the lines of a header.
class PvmLines {
public:
    PvmLines(const std::string& path, const std::string& head) : m_path(path), m_head(head) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw FileError(what, m_path, "correct the header, or copy the file again");
    }
    std::string next() {
        const std::size_t end = m_head.find('\n', m_at);
        if (end == std::string::npos) fail("the header ends before its lines are complete");
        std::string line = trimmed(std::string_view(m_head).substr(m_at, end - m_at));
        m_at = end + 1;
        return line.starts_with('#') ? next() : line;
    }
    std::vector<std::string> words(std::size_t count, const std::string& what) {
        const std::string line = next();
        std::vector<std::string> words = splitWords(line);
        if (words.size() != count) fail("the header has " + inQuotes(line) + " where " + what + " should stand");
        return words;
    }
    std::int64_t wholeNumber(const std::string& word, const std::string& what) const {
        std::int64_t value = 0;
        if (!parseNumber(word, value)) fail("the header has " + inQuotes(word) + " where " + what + " should stand");
        return value;
    }
    std::uint64_t passed() const { return m_at; }

private:
    std::string m_path;
    const std::string& m_head;
    std::size_t m_at = 0;
};

PvmHeader headerIn(const std::string& path, const JobControl& job) {
    const std::string head = unpackedHead(path, job);
    PvmHeader header;
    if (head.starts_with("PVM2\n"))
        header.version = 2;
    else if (head.starts_with("PVM3\n"))
        header.version = 3;
    else if (!head.starts_with("PVM\n"))
        throw notOfFormat("a PVM file", path, head);
    PvmLines lines(path, head);
    lines.next();
    const std::vector<std::string> sizes = lines.words(3, "three sizes");
    for (std::size_t a = 0; a < 3; ++a) header.dims[a] = lines.wholeNumber(sizes[a], "a size");
    if (header.version > 1) {
        const std::vector<std::string> scales = lines.words(3, "three distances of voxels");
        for (std::size_t a = 0; a < 3; ++a) {
            double& spacing = header.spacing[static_cast<int>(a)];
            spacing = numberIn(scales[a]);
            requireSpacing(spacing, a, scales[a], path);
        }
    }
    const std::string count = lines.words(1, "a number of components").front();
    header.bytesPerVoxel = lines.wholeNumber(count, "a number of components");
    header.bytes = lines.passed();
    return header;
}

/// One byte is a value, two are one of 16 bits, three and four are colours.
void setVoxels(FileLayout& layout, const PvmHeader& header, const std::string& path) {
    if (header.bytesPerVoxel < 1 || header.bytesPerVoxel > 4)
        throw FileError("the header gives " + std::to_string(header.bytesPerVoxel) + " components, not 1 to 4", path,
                        "correct the header, or copy the file again");
    layout.type = header.bytesPerVoxel == 2 ? ValueType::U16 : ValueType::U8;
    layout.bigEndian = true;
    if (header.bytesPerVoxel > 2) layout.axes.push_back({header.bytesPerVoxel, true});
    for (const std::int64_t size : header.dims) layout.axes.push_back({size});
    layout.spacing = header.spacing;
}

/// Where the voxels lie, all of which have to be there.
void placeData(FileLayout& layout, const PvmHeader& header, const JobControl& job) {
    const std::string& path = layout.dataPath;
    const std::uint64_t values = valuesIn(layout, path), needed = values * bytesPerValue(layout.type);
    std::uint64_t length = readableFileBytes(path);
    if (isDds(fileHead(path, kDdsStart))) {
        requirePacked(path, needed, length, kMostDds, kToDo);
        length = ddsLength(path, job);
        layout.open = [path, length](const JobControl& control) {
            return std::make_unique<DdsBytes>(path, length, control);
        };
        layout.skip = header.bytes;
    } else {
        layout.start = header.bytes;
    }
    std::uint64_t stored = length - std::min(length, header.bytes);
    if (header.version == 3) stored = std::min(stored, needed); // texts about the data follow
    requireStored(path, Encoding::Raw, values, bytesPerValue(layout.type), stored, kToDo);
    if (stored > needed)
        layout.notices.push_back("the data has " + std::to_string(stored - needed) +
                                 " bytes more than the header says");
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const PvmHeader header = headerIn(source.path, job);
    FileLayout layout;
    layout.dataPath = source.path;
    setVoxels(layout, header, source.path);
    valuesIn(layout, source.path); // throws where they are too many to count
    if (step) placeData(layout, header, job);
    return layout;
}

} // namespace

VolumeFormat pvmFormat() {
    return {"PVM", {".pvm"}, describeLayout<layoutOf>, readLayout<layoutOf>, nullptr, kPvmContent};
}

} // namespace pellucid
