#include "volume/formats/file_check.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/file_watch.h"

namespace pellucid {

namespace fs = std::filesystem;

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

std::string fileHead(const std::string& path, std::size_t limit) {
    const std::uint64_t bytes = std::min<std::uint64_t>(readableFileBytes(path), limit);
    std::string head(static_cast<std::size_t>(bytes), '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (!in) throw FileError("cannot read the file", path, "check the disk and its permissions");
    return head;
}

std::string describeContent(std::string_view head) {
    using namespace std::string_view_literals;
    static constexpr std::pair<std::string_view, const char*> kSignatures[] = {
        {"\x89PNG"sv, "a PNG image"},
        {"\xff\xd8\xff"sv, "a JPEG image"},
        {"GIF8"sv, "a GIF image"},
        {"II*\0"sv, "a TIFF image"},
        {"MM\0*"sv, "a TIFF image"},
        {"BM"sv, "a BMP image"},
        {"%PDF"sv, "a PDF document"},
        {"\x1f\x8b"sv, "gzip-compressed data"},
        {"BZh"sv, "bzip2-compressed data"},
        {"PK\x03\x04"sv, "a ZIP archive"},
        {"\x89HDF"sv, "an HDF5 file"},
        {"NRRD000"sv, "an NRRD file"},
        {"ObjectType"sv, "a MetaImage header"},
        {"# vtk"sv, "a VTK file"},
        {"<"sv, "an XML or HTML text"},
    };
    for (const auto& [signature, description] : kSignatures)
        if (head.substr(0, signature.size()) == signature) return description;
    if (head.size() >= 132 && head.substr(128, 4) == "DICM") return "a DICOM file";
    const auto looksLikeText = [](char c) {
        const auto u = static_cast<unsigned char>(c);
        return u >= 0x20 || u == '\n' || u == '\r' || u == '\t';
    };
    return std::all_of(head.begin(), head.end(), looksLikeText) ? "text" : "binary data";
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
            throw FileError("the header gives dimensions " + product + ", more than any memory holds", path,
                            "correct the header");
        count *= factor;
    }
    return count;
}

void requireStored(const std::string& where, Encoding encoding, std::uint64_t values, std::uint64_t bytesPerValue,
                   std::uint64_t stored, const std::string& toDo) {
    // Deflate turns at most 1032 bytes into one (a match of 258 bytes costs at least two bits); a text needs a digit
    // and a separator per value.
    constexpr std::uint64_t kMostDeflate = 1040;
    const std::uint64_t bytes = values * bytesPerValue;
    switch (encoding) {
    case Encoding::Raw:
        if (stored < bytes)
            throw FileError("the data has " + std::to_string(stored) + " of " + std::to_string(bytes) + " bytes", where,
                            toDo);
        break;
    case Encoding::Deflate:
        if (stored < bytes / kMostDeflate)
            throw FileError("the header claims " + describeBytes(bytes) + ", which " + describeBytes(stored) +
                                " of compressed data cannot hold",
                            where, toDo);
        break;
    case Encoding::Hex:
        if (stored / 2 < bytes)
            throw FileError("the data has " + std::to_string(stored / 2) + " of " + std::to_string(bytes) + " bytes",
                            where, toDo);
        break;
    case Encoding::Text:
        if (stored / 2 + 1 < values)
            throw FileError("the header claims " + std::to_string(values) + " values, which " + describeBytes(stored) +
                                " of text cannot hold",
                            where, toDo);
        break;
    }
}

std::uint64_t requireInflates(const std::string& path, std::uint64_t start, bool zlib, std::uint64_t wanted,
                              const JobControl& job, bool toTheEnd) {
    using End = InflatedBytes::End;
    InflatedBytes bytes(path, start, zlib, job);
    std::vector<char> unpacked(1u << 20);
    std::uint64_t yield = 0;
    // Beyond what is wanted nothing matters, so that a stream which never ends cannot hold us up.
    while ((yield <= wanted || toTheEnd) && bytes.end() == End::None)
        yield += bytes.read(unpacked.data(), unpacked.size());
    if (yield <= wanted || toTheEnd) requireYield(path, yield, wanted, bytes.end());
    return yield;
}

void requireYield(const std::string& path, std::uint64_t yield, std::uint64_t wanted, InflatedBytes::End end) {
    using End = InflatedBytes::End;
    if (yield >= wanted && end == End::Whole) return;
    const bool damaged = end == End::Damaged;
    if (yield >= wanted && damaged)
        throw FileError("the checksum of the compressed data is wrong", path, "copy or write the file again");
    if (yield >= wanted) throw FileError("the compressed data is cut off at its end", path, "copy the file again");
    throw FileError("the compressed data " + std::string(damaged ? "is damaged" : "ends") + " after " +
                        std::to_string(yield) + " of " + std::to_string(wanted) + " bytes",
                    path, "copy or write the file again");
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
