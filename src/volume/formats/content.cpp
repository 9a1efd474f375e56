#include "volume/formats/content.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

#include <zlib.h>

#include "base/error.h"
#include "volume/formats/dds_bytes.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

using namespace std::string_view_literals;

bool isTiff(std::string_view head) {
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

bool isNifti(std::string_view head) {
    const auto has = [&](std::size_t at, char version) {
        const std::string_view mark = head.size() < at + 4 ? std::string_view() : head.substr(at, 4);
        return mark.size() == 4 && mark[0] == 'n' && (mark[1] == '+' || mark[1] == 'i') && mark[2] == version &&
               mark[3] == '\0';
    };
    return beginsLikeNifti(head) && (has(344, '1') || has(4, '2'));
}

/// The first bytes that the first bytes of a gzip file unpack to.
std::string unpackedHead(std::string_view head) {
    std::string packed(head), unpacked(kHeadBytes, '\0');
    z_stream stream{};
    if (inflateInit2(&stream, MAX_WBITS + 16) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
    stream.avail_out = static_cast<uInt>(unpacked.size());
    inflate(&stream, Z_SYNC_FLUSH);
    unpacked.resize(unpacked.size() - stream.avail_out);
    inflateEnd(&stream);
    return unpacked;
}

/// Names of the fields that the lines of a text begin with, in lower case; each with `sign`, which stands behind it. Up
/// to the first line that has none and is not empty nor a comment.
std::vector<std::string> fieldsIn(std::string_view head, char sign) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin < head.size();) {
        const std::size_t end = std::min(head.find('\n', begin), head.size());
        const std::string line = trimmed(head.substr(begin, end - begin));
        begin = end + 1;
        if (line.empty() || line[0] == '#' || line.starts_with("//")) continue;
        const std::size_t at = line.find(sign);
        const std::string name = lowerCase(trimmed(line.substr(0, at)));
        const auto isOfName = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
        if (at == std::string::npos || name.empty() || !std::ranges::all_of(name, isOfName)) break;
        names.push_back(name);
    }
    return names;
}

bool hasOneOf(const std::vector<std::string>& names, const std::vector<std::string>& wanted) {
    return std::ranges::find_first_of(names, wanted) != names.end();
}

std::string withoutComments(std::string text) {
    for (std::size_t begin = text.find("<!--"); begin != std::string::npos; begin = text.find("<!--", begin))
        text.erase(begin, text.find("-->", begin) - begin);
    return text;
}

/// The type of a VTKFile, and the like; empty where it is another XML text.
std::string ofXml(const std::string& text) {
    const std::string_view head = text;
    if (head.find("<VoreenData") != std::string_view::npos) return kVvdContent;
    if (head.find("<MRML") != std::string_view::npos) return kMrmlContent;
    const std::size_t begin = head.find("<VTKFile");
    if (begin == std::string_view::npos) return {};
    const std::string_view tag = head.substr(begin, head.find('>', begin) - begin);
    for (const auto& [type, content] : {std::pair{"ImageData"sv, kVtiContent}, std::pair{"PImageData"sv, kPvtiContent},
                                        std::pair{"Collection"sv, kPvdContent}})
        for (const std::string quote : {"\"", "'"})
            if (tag.find("type=" + quote + std::string(type) + quote) != std::string_view::npos) return content;
    return {};
}

/// A format of volumes that can be told by its first bytes; empty where there is none.
std::string ofVolume(std::string_view head) {
    if (head.starts_with("NRRD000")) return kNrrdContent;
    if (lowerCase(head.substr(0, 22)).starts_with("# vtk datafile version")) return kVtkLegacyContent;
    if (isDds(head) || head.starts_with("PVM\n") || head.starts_with("PVM2\n") || head.starts_with("PVM3\n"))
        return kPvmContent;
    if (head.starts_with("\x89HDF") || (head.size() > 512 && head.substr(512).starts_with("\x89HDF\r\n")))
        return kHdf5Content; // MATLAB 7.3 has a header of its own before it
    if (head.starts_with("CDF\x01") || head.starts_with("CDF\x02") || head.starts_with("CDF\x05"))
        return kNetCdfContent;
    if (isNifti(head) || (head.starts_with("\x1f\x8b") && isNifti(unpackedHead(head)))) return kNiftiContent;
    const std::size_t first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first != std::string_view::npos && head[first] == '<') return ofXml(withoutComments(std::string(head)));
    if (hasOneOf(fieldsIn(head, ':'), {"objectfilename", "rawfile", "datfile"})) return kDatContent;
    if (hasOneOf(fieldsIn(head, '='), {"ndims", "objecttype"})) return kMetaImageContent;
    if (isDicom(head)) return kDicomContent; // which may begin like a TIFF image, to be both
    return isTiff(head) ? kTiffContent : "";
}

} // namespace

bool isGzip(const std::string& path) { return fileHead(path, 3) == "\x1f\x8b\b"; }

bool beginsLikeNifti(std::string_view head) {
    const std::string_view size = head.substr(0, 4);
    return size == "\x5c\1\0\0"sv || size == "\0\0\1\x5c"sv || size == "\x1c\2\0\0"sv || size == "\0\0\2\x1c"sv;
}

std::string describeContent(std::string_view head) {
    static constexpr std::pair<std::string_view, const char*> kSignatures[] = {
        {"\x89PNG"sv, "a PNG image"},
        {"\xff\xd8\xff"sv, "a JPEG image"},
        {"GIF8"sv, "a GIF image"},
        {"BM"sv, "a BMP image"},
        {"%PDF"sv, "a PDF document"},
        {"\x1f\x8b"sv, "gzip-compressed data"},
        {"BZh"sv, "bzip2-compressed data"},
        {"PK\x03\x04"sv, "a ZIP archive"},
        {"\x0e\x03\x13\x01"sv, "an HDF4 file"},
        {"<"sv, "an XML or HTML text"},
    };
    if (const std::string volume = ofVolume(head); !volume.empty()) return volume;
    for (const auto& [signature, description] : kSignatures)
        if (head.substr(0, signature.size()) == signature) return description;
    const auto looksLikeText = [](char c) {
        const auto u = static_cast<unsigned char>(c);
        return u >= 0x20 || u == '\n' || u == '\r' || u == '\t';
    };
    return std::all_of(head.begin(), head.end(), looksLikeText) ? "text" : "binary data";
}

std::string contentOf(const std::string& path) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) return {};
    try {
        return describeContent(fileHead(path, kHeadBytes));
    } catch (const FileError&) {
        return {};
    }
}

} // namespace pellucid
