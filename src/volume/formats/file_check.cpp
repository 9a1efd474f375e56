#include "volume/formats/file_check.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/file_watch.h"
#include "volume/formats/content.h"

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

void requirePacked(const std::string& where, std::uint64_t bytes, std::uint64_t stored, std::uint64_t most,
                   const std::string& toDo) {
    if (stored < bytes / most)
        throw FileError("the header claims " + describeBytes(bytes) + ", which " + describeBytes(stored) +
                            " of compressed data cannot hold",
                        where, toDo);
}

void requireStored(const std::string& where, Encoding encoding, std::uint64_t values, std::uint64_t bytesPerValue,
                   std::uint64_t stored, const std::string& toDo) {
    // Deflate turns at most 1032 bytes into one (a match of 258 bytes costs at least two bits); a text needs a digit
    // and a separator per value. A block of bzip2 holds 900 000 bytes, five of which may stand for 259 alike, and costs
    // more than 16 bytes.
    constexpr std::uint64_t kMostDeflate = 1040, kMostBzip2 = 900'000 / 5 * 259 / 16;
    const std::uint64_t bytes = values * bytesPerValue, there = encoding == Encoding::Hex ? stored / 2 : stored;
    if (encoding == Encoding::Deflate) requirePacked(where, bytes, stored, kMostDeflate, toDo);
    if (encoding == Encoding::Bzip2) requirePacked(where, bytes, stored, kMostBzip2, toDo);
    std::string problem;
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
