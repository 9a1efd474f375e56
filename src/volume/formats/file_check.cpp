#include "volume/formats/file_check.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include <zlib.h>

#include "base/check.h"
#include "base/error.h"

namespace pellucid {

namespace fs = std::filesystem;

std::uint64_t readableFileBytes(const std::string& path) {
    std::error_code ec;
    const fs::file_status status = fs::status(path, ec);
    if (status.type() == fs::file_type::not_found) throw FileError("no such file", path, "check the name");
    if (status.type() == fs::file_type::directory)
        throw FileError("this is a folder, not a file", path, "name a file in it");
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

void requireInflates(const std::string& path, std::uint64_t start, bool zlib, std::uint64_t wanted,
                     const JobControl& job) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(start));
    z_stream stream{};
    PELLUCID_CHECK(inflateInit2(&stream, zlib ? MAX_WBITS + 32 : MAX_WBITS + 16) == Z_OK);
    const struct End {
        z_stream& stream;
        ~End() { inflateEnd(&stream); }
    } end{stream};
    std::vector<unsigned char> packed(1u << 18), unpacked(1u << 20);
    std::uint64_t yield = 0;
    int status = Z_OK;
    // Beyond what is wanted nothing matters, so that a stream which never ends cannot hold us up.
    while (yield <= wanted) {
        if (stream.avail_in == 0) {
            job.throwIfStopped();
            in.read(reinterpret_cast<char*>(packed.data()), static_cast<std::streamsize>(packed.size()));
            stream.next_in = packed.data();
            stream.avail_in = static_cast<uInt>(in.gcount());
            if (stream.avail_in == 0) break;
        }
        // Only another gzip member may follow a finished one; other bytes are left alone.
        if (status == Z_STREAM_END && (zlib || *stream.next_in != 0x1f || inflateReset(&stream) != Z_OK)) break;
        stream.next_out = unpacked.data();
        stream.avail_out = static_cast<uInt>(unpacked.size());
        status = inflate(&stream, Z_NO_FLUSH);
        yield += unpacked.size() - stream.avail_out;
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) break;
    }
    const bool whole = status == Z_STREAM_END || yield > wanted;
    if (yield >= wanted && whole) return;
    if (yield >= wanted && status != Z_OK && status != Z_BUF_ERROR)
        throw FileError("the checksum of the compressed data is wrong", path, "copy or write the file again");
    if (yield >= wanted) throw FileError("the compressed data is cut off at its end", path, "copy the file again");
    const bool ended = status == Z_OK || status == Z_BUF_ERROR || status == Z_STREAM_END;
    throw FileError("the compressed data " + std::string(ended ? "ends" : "is damaged") + " after " +
                        std::to_string(yield) + " of " + std::to_string(wanted) + " bytes",
                    path, "copy or write the file again");
}

void requireNumbers(const std::string& path, std::uint64_t start, std::uint64_t wanted, const JobControl& job) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(start));
    std::string word;
    std::uint64_t count = 0;
    const auto take = [&] {
        double value = 0;
        if (!word.empty() && !parseNumber(word, value))
            throw FileError("there is " + inQuotes(word) + " where a number belongs", path,
                            "copy or write the file again");
        if (!word.empty()) ++count;
        word.clear();
    };
    std::vector<char> piece(1u << 18);
    while (count < wanted && in) {
        job.throwIfStopped();
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        for (std::streamsize i = 0; i < in.gcount() && count < wanted; ++i) {
            const char c = piece[static_cast<std::size_t>(i)];
            const bool separates = c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0;
            if (separates || word.size() > 400) take();
            if (!separates) word += c;
        }
    }
    if (count < wanted) take();
    if (count < wanted)
        throw FileError("the data has " + std::to_string(count) + " of " + std::to_string(wanted) + " values", path,
                        "check the sizes in the header, or copy the file again");
}

} // namespace pellucid
