#include "volume/formats/file_check.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/file_watch.h"

namespace pellucid {

namespace fs = std::filesystem;

bool isFolder(const std::string& path) {
    std::error_code ec;
    return fs::is_directory(path, ec);
}

std::uint64_t readableFileBytes(const std::string& path) {
    tellOfReading(path);
    std::error_code ec;
    const fs::file_status status = fs::status(path, ec);
    if (status.type() == fs::file_type::not_found) throw FileError("no such file", path, "check the name");
    if (status.type() == fs::file_type::directory)
        throw FileError("this is a folder, not a file", path, "name a file in it");
    if (status.type() == fs::file_type::none)
        throw FileError("cannot read the file", path, "check its name and its permissions");
    if (status.type() != fs::file_type::regular)
        throw FileError("this is not a regular file", path, "copy the data into a file first");
    const std::uintmax_t bytes = fs::file_size(path, ec);
    std::ifstream in(path, std::ios::binary);
    if (ec || !in) throw FileError("cannot read the file", path, "check its permissions");
    return bytes;
}

std::uint64_t dataFileBytes(const std::string& data, const std::string& header) {
    std::error_code ec;
    if (data == header || fs::status(data, ec).type() != fs::file_type::not_found) return readableFileBytes(data);
    constexpr std::size_t kShown = 40;
    const fs::path path(data);
    std::string name = path.lexically_proximate(fs::path(header).parent_path()).string();
    if (name.size() > kShown) name = path.filename().string();
    throw FileError("the data file " + inQuotes(name) + " that the header names is missing", header,
                    "put the data file there, or correct the header");
}

void requireIndex(const std::string& what, int index, std::uint64_t count, const std::string& path) {
    if (index < 0 || static_cast<std::uint64_t>(index) >= count)
        throw UsageError("there is no " + what + " " + std::to_string(index), path,
                         count == 1 ? "there is one, number 0" : "give 0 to " + std::to_string(count - 1));
}

std::string fileHead(const std::string& path, std::size_t limit) {
    const std::uint64_t bytes = std::min<std::uint64_t>(readableFileBytes(path), limit);
    std::string head(static_cast<std::size_t>(bytes), '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (!in) throw FileError("cannot read the file", path, "check the disk and its permissions");
    return head;
}

namespace {

bool isTiff(std::string_view head) {
    using namespace std::string_view_literals;
    const std::string_view begin = head.substr(0, 4); // the last two are those of large files
    return begin == "II*\0"sv || begin == "MM\0*"sv || begin == "II+\0"sv || begin == "MM\0+"sv;
}

/// With a preamble, or as older files without: then three elements of the first groups have to follow each other.
bool isDicom(std::string_view head) {
    if (head.size() >= 132 && head.substr(128, 4) == "DICM") return true;
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::size_t value = 0;
        for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(head[at + i]);
        return value;
    };
    const auto isLetter = [&](std::size_t at) { return head[at] >= 'A' && head[at] <= 'Z'; };
    constexpr std::size_t kElements = 3, kHeader = 12, kMostBytes = 256;
    std::size_t at = 0, before = 0;
    for (std::size_t n = 0; n < kElements; ++n) {
        if (at + kHeader > head.size()) return false;
        const std::size_t group = number(at, 2), tag = group << 16 | number(at + 2, 2);
        const bool first = n == 0 && (group == 2 || group == 8) && (tag & 0xffff) <= 0x18;
        if (n == 0 ? !first : tag <= before || group > 0x10) return false;
        before = tag;
        const std::string_view type = head.substr(at + 4, 2);
        const bool named = isLetter(at + 4) && isLetter(at + 5);
        const bool wide = type == "OB" || type == "OW" || type == "SQ" || type == "UN" || type == "UT";
        const std::size_t bytes = !named ? number(at + 4, 4) : wide ? number(at + 8, 4) : number(at + 6, 2);
        if (bytes > kMostBytes || bytes % 2 != 0) return false;
        at += bytes + (named && wide ? 12 : 8);
    }
    return true;
}

} // namespace

std::string describeContent(std::string_view head) {
    using namespace std::string_view_literals;
    static constexpr std::pair<std::string_view, const char*> kSignatures[] = {
        {"\x89PNG"sv, "a PNG image"},
        {"\xff\xd8\xff"sv, "a JPEG image"},
        {"GIF8"sv, "a GIF image"},
        {"BM"sv, "a BMP image"},
        {"%PDF"sv, "a PDF document"},
        {"\x1f\x8b"sv, "gzip-compressed data"},
        {"BZh"sv, "bzip2-compressed data"},
        {"PK\x03\x04"sv, "a ZIP archive"},
        {"\x89HDF"sv, "an HDF5 file"},
        {"\x0e\x03\x13\x01"sv, "an HDF4 file"},
        {"CDF\x01"sv, "a NetCDF file"},
        {"CDF\x02"sv, "a NetCDF file"},
        {"CDF\x05"sv, "a NetCDF file"},
        {"NRRD000"sv, "an NRRD file"},
        {"ObjectType"sv, "a MetaImage header"},
        {"# vtk"sv, "a VTK file"},
        {"<"sv, "an XML or HTML text"},
    };
    for (const auto& [signature, description] : kSignatures)
        if (head.substr(0, signature.size()) == signature) return description;
    if (isDicom(head)) return "a DICOM file"; // which may begin like a TIFF image, to be both
    if (isTiff(head)) return "a TIFF image";
    if (head.size() > 512 && head.substr(512).starts_with("\x89HDF\r\n")) return "an HDF5 file"; // MATLAB 7.3
    const auto looksLikeText = [](char c) {
        const auto u = static_cast<unsigned char>(c);
        return u >= 0x20 || u == '\n' || u == '\r' || u == '\t';
    };
    return std::all_of(head.begin(), head.end(), looksLikeText) ? "text" : "binary data";
}

std::string contentOf(const std::string& path) {
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) return {};
    try {
        return describeContent(fileHead(path, 1024));
    } catch (const FileError&) {
        return {};
    }
}

FileError notOfFormat(const std::string& expected, const std::string& path, std::string_view head) {
    return {"this is not " + expected + " but " + describeContent(head), path, "give it the suffix of its own format",
            Remedy::GiveRawLayout};
}

std::uint64_t valueCount(const std::string& path, std::span<const std::int64_t> sizes, std::uint64_t bytesPerValue) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
    std::string product;
    for (const std::int64_t size : sizes) product += (product.empty() ? "" : " x ") + std::to_string(size);
    std::uint64_t count = 1;
    for (const std::int64_t size : sizes) {
        if (size < 1)
            throw FileError("the header gives dimensions " + product + ", each must be at least 1", path,
                            "correct the header");
        const auto factor = static_cast<std::uint64_t>(size);
        if (size > std::numeric_limits<std::int32_t>::max() || count > kMost / bytesPerValue / factor)
            throw FileError("the header gives dimensions " + product + ", more than any memory can hold", path,
                            "correct the header");
        count *= factor;
    }
    return count;
}

void requireStored(const std::string& where, Encoding encoding, std::uint64_t values, std::uint64_t bytesPerValue,
                   std::uint64_t stored, const std::string& toDo) {
    // Deflate turns at most 1032 bytes into one (a match of 258 bytes costs at least two bits); a text needs a digit
    // and a separator per value. A block of bzip2 holds 900 000 bytes, five of which may stand for 259 alike, and costs
    // more than 16 bytes.
    constexpr std::uint64_t kMostDeflate = 1040, kMostBzip2 = 900'000 / 5 * 259 / 16;
    const std::uint64_t bytes = values * bytesPerValue, there = encoding == Encoding::Hex ? stored / 2 : stored;
    std::string problem;
    if ((encoding == Encoding::Deflate && stored < bytes / kMostDeflate) ||
        (encoding == Encoding::Bzip2 && stored < bytes / kMostBzip2))
        problem = "the header claims " + describeBytes(bytes) + ", which " + describeBytes(stored) +
                  " of compressed data cannot hold";
    if (encoding == Encoding::Text && stored / 2 + 1 < values)
        problem = "the header claims " + std::to_string(values) + " values, which " + describeBytes(stored) +
                  " of text cannot hold";
    if ((encoding == Encoding::Raw || encoding == Encoding::Hex) && there < bytes)
        problem = "the data has " + std::to_string(there) + " of " + std::to_string(bytes) + " bytes";
    if (!problem.empty()) throw FileError(problem, where, toDo);
}

namespace {

/// Reads on until `wanted` bytes are sound, or the stream ends.
void unpackUpTo(UnpackedBytes& bytes, std::uint64_t wanted) {
    std::vector<char> unpacked(1u << 20);
    while (bytes.soundBytes() < wanted && bytes.end() == UnpackedBytes::End::None)
        bytes.read(unpacked.data(), unpacked.size());
}

} // namespace

void requireSound(UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path) {
    unpackUpTo(bytes, wanted);
    if (bytes.soundBytes() < wanted) failToUnpack(bytes, wanted, path);
}

std::uint64_t requireSoundToEnd(UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path) {
    unpackUpTo(bytes, std::numeric_limits<std::uint64_t>::max());
    requireWhole(bytes, wanted, path);
    return bytes.soundBytes();
}

void requireWhole(const UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path) {
    // What is no member may once have been one: then the data would end elsewhere.
    if (bytes.end() == UnpackedBytes::End::Followed)
        throw FileError("the compressed data is followed by something else, so that the end of the data is not known",
                        path, "copy the file again, or give the header a byte skip from the beginning");
    if (bytes.soundBytes() < wanted || bytes.end() != UnpackedBytes::End::Whole) failToUnpack(bytes, wanted, path);
}

void failToUnpack(const UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path) {
    using End = UnpackedBytes::End;
    const std::uint64_t yield = bytes.decoded();
    const std::string after =
        " after " + std::to_string(yield) + (yield < wanted ? " of " + std::to_string(wanted) + " bytes" : " bytes");
    std::string what = "the compressed data ends" + after;
    if (bytes.end() == End::WrongSum) what = "the checksum of the compressed data is wrong";
    if (bytes.end() == End::Damaged) what = "the compressed data is damaged" + after;
    if (bytes.end() == End::CutOff && yield >= wanted)
        what = "the compressed data is cut off" + after + ", before its checksum";
    throw FileError(what, path, "copy or write the file again");
}

void requireNumbers(const std::string& path, std::uint64_t start, std::uint64_t wanted, const JobControl& job) {
    TextWords words(path, start, job);
    std::string word;
    std::uint64_t count = 0;
    for (; count < wanted && words.next(word); ++count) {
        double value = 0;
        if (!parseNumber(word, value))
            throw FileError("there is " + inQuotes(word) + " where a number belongs", path,
                            "copy or write the file again");
    }
    if (count < wanted)
        throw FileError("the data has " + std::to_string(count) + " of " + std::to_string(wanted) + " values", path,
                        "check the sizes in the header, or copy the file again");
}

} // namespace pellucid
