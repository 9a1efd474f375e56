#include "foreign/images/picture_file.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include <tiffio.h>
#include <zlib.h>

#include "base/text.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

/// What libtiff said last.
std::string& tiffComplaint() {
    static std::string complaint;
    return complaint;
}

void keepComplaint(const char*, const char* format, va_list values) {
    std::array<char, 400> text{};
    std::vsnprintf(text.data(), text.size(), format, values);
    tiffComplaint() = text.data();
}

class TiffFile final : public PictureFile {
public:
    explicit TiffFile(const std::string& path) : m_path(path) {
        TIFFSetErrorHandler(keepComplaint);
        TIFFSetWarningHandler(nullptr);
        m_file = TIFFOpen(path.c_str(), "rm"); // not mapped: a page beyond the end would end the process
        if (m_file == nullptr) throw pictureFailure(path, "this TIFF file cannot be read", tiffComplaint());
    }
    ~TiffFile() override { TIFFClose(m_file); }
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;

    bool goTo(int page) override {
        if (page == m_page && m_isAtPage) return true;
        // One after the other: a search from the beginning for each takes long, and a chain may lead back.
        if (page == m_page + 1 && page > 0 ? TIFFReadDirectory(m_file) == 0
                                           : TIFFSetDirectory(m_file, static_cast<tdir_t>(page)) == 0)
            return m_isAtPage = false;
        m_page = page;
        m_isAtPage = true;
        return true;
    }

    PageShape shape() override {
        std::uint32_t width = 0, height = 0;
        TIFFGetField(m_file, TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(m_file, TIFFTAG_IMAGELENGTH, &height);
        constexpr std::uint32_t kMost = 1u << 30;
        if (width < 1 || height < 1 || width > kMost || height > kMost)
            throw pictureFailure(m_path,
                                 "a page has " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
        std::uint32_t depth = 1, tileDepth = 1;
        TIFFGetFieldDefaulted(m_file, TIFFTAG_IMAGEDEPTH, &depth);
        TIFFGetFieldDefaulted(m_file, TIFFTAG_TILEDEPTH, &tileDepth);
        if (depth > 1 || tileDepth > 1)
            throw pictureFailure(m_path,
                                 "a page has several slices (ImageDepth " + std::to_string(depth) + ", TileDepth " +
                                     std::to_string(tileDepth) + "), which is not supported",
                                 "", "write each slice as a page of its own, without tiles that have a depth");
        PageShape shape;
        shape.width = static_cast<int>(width);
        shape.height = static_cast<int>(height);
        shape.samples = number(TIFFTAG_SAMPLESPERPIXEL, 1);
        const int bits = number(TIFFTAG_BITSPERSAMPLE, 1), format = number(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        const int photometric = number(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        if (photometric == PHOTOMETRIC_YCBCR) TIFFSetField(m_file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        static const std::map<std::pair<int, int>, ValueType> kTypes{
            {{8, SAMPLEFORMAT_UINT}, ValueType::U8},     {{16, SAMPLEFORMAT_UINT}, ValueType::U16},
            {{32, SAMPLEFORMAT_UINT}, ValueType::U32},   {{64, SAMPLEFORMAT_UINT}, ValueType::U64},
            {{8, SAMPLEFORMAT_VOID}, ValueType::U8},     {{16, SAMPLEFORMAT_VOID}, ValueType::U16},
            {{8, SAMPLEFORMAT_INT}, ValueType::I8},      {{16, SAMPLEFORMAT_INT}, ValueType::I16},
            {{32, SAMPLEFORMAT_INT}, ValueType::I32},    {{64, SAMPLEFORMAT_INT}, ValueType::I64},
            {{32, SAMPLEFORMAT_IEEEFP}, ValueType::F32}, {{64, SAMPLEFORMAT_IEEEFP}, ValueType::F64}};
        const auto type = kTypes.find({bits, format});
        if (shape.samples < 1 || shape.samples > 1000)
            throw pictureFailure(m_path, "pixels of " + std::to_string(shape.samples) + " samples are not supported");
        const bool isCount = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
        shape.isBilevel = bits == 1 && shape.samples == 1 && isCount;
        if (type == kTypes.end() && !shape.isBilevel) throw unsupported(bits, format);
        shape.type = shape.isBilevel ? ValueType::U8 : type->second;
        return shape;
    }

    void read(std::span<std::byte> to) override {
        const PageShape page = shape();
        const std::size_t sample = bytesPerValue(page.type);
        const int planes = isPlanar() ? page.samples : 1, inPlane = isPlanar() ? 1 : page.samples;
        std::uint32_t width = static_cast<std::uint32_t>(page.width), height = static_cast<std::uint32_t>(page.height);
        const bool isTiled = TIFFIsTiled(m_file) != 0;
        std::uint32_t tileWidth = width, tileHeight = height;
        if (isTiled) {
            TIFFGetField(m_file, TIFFTAG_TILEWIDTH, &tileWidth);
            TIFFGetField(m_file, TIFFTAG_TILELENGTH, &tileHeight);
        } else {
            TIFFGetFieldDefaulted(m_file, TIFFTAG_ROWSPERSTRIP, &tileHeight);
            tileHeight = std::min(tileHeight, height);
        }
        if (tileWidth < 1 || tileHeight < 1) throw pictureFailure(m_path, "a page has tiles without pixels");
        const std::size_t pixel = sample * static_cast<std::size_t>(inPlane);
        const auto rowBytes = [&](std::size_t columns) { return page.isBilevel ? (columns + 7) / 8 : pixel * columns; };
        const auto tileBytes = static_cast<std::size_t>(isTiled ? TIFFTileSize64(m_file) : TIFFStripSize64(m_file));
        if (tileBytes < rowBytes(tileWidth) * tileHeight)
            throw pictureFailure(m_path, "a page has tiles of a wrong size");
        const bool isInPlace =
            !isTiled && planes == 1 && !page.isBilevel; // strips are rows of whole pixels, as they are wanted
        std::vector<char> tile(isInPlace ? 0 : tileBytes);
        std::uint32_t number = 0;
        for (int plane = 0; plane < planes; ++plane)
            for (std::uint32_t y = 0; y < height; y += tileHeight)
                for (std::uint32_t x = 0; x < width; x += tileWidth, ++number) {
                    const std::uint32_t rows = std::min(tileHeight, height - y),
                                        columns = std::min(tileWidth, width - x);
                    const auto wanted = static_cast<tmsize_t>(rowBytes(tileWidth) * (isTiled ? tileHeight : rows));
                    if (isDeflated()) requireSound(number, isTiled);
                    void* const into = isInPlace ? static_cast<void*>(to.data() + pixel * width * y) : tile.data();
                    const tmsize_t got = isTiled ? TIFFReadEncodedTile(m_file, number, into, wanted)
                                                 : TIFFReadEncodedStrip(m_file, number, into, wanted);
                    if (got < wanted)
                        throw pictureFailure(m_path, "page " + std::to_string(m_page) + " cannot be read",
                                             tiffComplaint());
                    for (std::uint32_t row = 0; row < rows && !isInPlace; ++row) {
                        const char* from = tile.data() + rowBytes(tileWidth) * row;
                        if (page.isBilevel)
                            putBits(to.subspan(std::size_t{width} * (y + row) + x, columns), from);
                        else
                            put(to, {x, y + row}, columns, from, page, plane, pixel);
                    }
                }
    }

    std::optional<PlainValues> plainPixels() override {
        const PageShape page = shape();
        const auto is = [&](ttag_t tag, std::uint16_t wanted, std::uint16_t otherwise) {
            std::uint16_t value = otherwise;
            TIFFGetFieldDefaulted(m_file, tag, &value);
            return value == wanted;
        };
        if (page.isBilevel || TIFFIsTiled(m_file) != 0 || (isPlanar() && page.samples > 1) ||
            !is(TIFFTAG_COMPRESSION, COMPRESSION_NONE, COMPRESSION_NONE) ||
            !is(TIFFTAG_FILLORDER, FILLORDER_MSB2LSB, FILLORDER_MSB2LSB) ||
            is(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_YCBCR, PHOTOMETRIC_MINISBLACK))
            return {};
        const auto height = static_cast<std::uint32_t>(page.height);
        std::uint32_t rows = height;
        TIFFGetFieldDefaulted(m_file, TIFFTAG_ROWSPERSTRIP, &rows);
        rows = std::min(rows, height);
        if (rows < 1 || TIFFNumberOfStrips(m_file) != (height - 1) / rows + 1) return {};
        const std::uint64_t row = bytesOf(page) / height, start = TIFFGetStrileOffset(m_file, 0);
        std::uint64_t next = start;
        for (std::uint32_t y = 0, strip = 0; y < height; y += rows, ++strip) {
            const std::uint64_t bytes = row * std::min(rows, height - y);
            if (TIFFGetStrileOffset(m_file, strip) != next || TIFFGetStrileByteCount(m_file, strip) != bytes) return {};
            next += bytes;
        }
        if (start == 0 || next < start || next > readableFileBytes(m_path)) return {}; // read() says what is wrong
        return PlainValues{start, TIFFIsBigEndian(m_file) != 0};
    }

    std::string description() override {
        const char* text = nullptr;
        return TIFFGetField(m_file, TIFFTAG_IMAGEDESCRIPTION, &text) != 0 && text != nullptr ? text : "";
    }
    std::vector<std::string> notices() override {
        std::vector<std::string> all;
        const int photometric = number(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        if (photometric == PHOTOMETRIC_MINISWHITE)
            all.emplace_back("small values are meant to be bright (MINISWHITE): values are kept as they are");
        if (photometric == PHOTOMETRIC_PALETTE) all.emplace_back("colours of a palette are shown as their numbers");
        if (std::string text = orientationNotice(number(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT)); !text.empty())
            all.push_back(std::move(text));
        return all;
    }
    double pixelsPerUnit(int axis) override {
        float number = 0;
        TIFFGetField(m_file, axis == 0 ? TIFFTAG_XRESOLUTION : TIFFTAG_YRESOLUTION, &number);
        return static_cast<double>(number);
    }

private:
    int number(ttag_t tag, std::uint16_t otherwise) const {
        std::uint16_t value = otherwise;
        TIFFGetFieldDefaulted(m_file, tag, &value);
        return value;
    }
    /// Of pixels that are such numbers.
    FileError unsupported(int bits, int format) const {
        const std::string kind = std::to_string(bits) + "-bit ";
        if (format == SAMPLEFORMAT_IEEEFP)
            return pictureFailure(m_path, "pixels that are " + kind + "floating-point numbers are not supported", "",
                                  "save them as 32-bit floating point");
        if (format == SAMPLEFORMAT_COMPLEXINT || format == SAMPLEFORMAT_COMPLEXIEEEFP)
            return pictureFailure(m_path, "pixels that are complex numbers are not supported", "",
                                  "save their real parts, or their magnitudes, as 32-bit floating point");
        return pictureFailure(m_path, "pixels that are " + kind + "integers are not supported", "",
                              "save them with 8, 16 or 32 bits");
    }
    bool isPlanar() const {
        std::uint16_t planar = PLANARCONFIG_CONTIG;
        TIFFGetFieldDefaulted(m_file, TIFFTAG_PLANARCONFIG, &planar);
        return planar == PLANARCONFIG_SEPARATE;
    }
    bool isDeflated() const {
        std::uint16_t compression = COMPRESSION_NONE;
        TIFFGetFieldDefaulted(m_file, TIFFTAG_COMPRESSION, &compression);
        return compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE;
    }
    /// Throws FileError unless the packed bytes of a tile or strip have the right checksum, which libtiff leaves
    /// unread.
    void requireSound(std::uint32_t number, bool isTiled) {
        const std::uint64_t packed = TIFFGetStrileByteCount(m_file, number);
        if (packed == 0 || packed > readableFileBytes(m_path)) return; // read on: it says what is wrong
        std::vector<unsigned char> bytes(packed), out(1u << 16);
        const auto size = static_cast<tmsize_t>(packed);
        const tmsize_t got = isTiled ? TIFFReadRawTile(m_file, number, bytes.data(), size)
                                     : TIFFReadRawStrip(m_file, number, bytes.data(), size);
        z_stream stream{};
        if (got < size || inflateInit(&stream) != Z_OK) return;
        stream.next_in = bytes.data();
        stream.avail_in = static_cast<uInt>(packed);
        int status = Z_OK;
        while (status == Z_OK) {
            stream.next_out = out.data();
            stream.avail_out = static_cast<uInt>(out.size());
            status = inflate(&stream, Z_NO_FLUSH);
        }
        inflateEnd(&stream);
        if (status != Z_STREAM_END) throw pictureFailure(m_path, "page " + std::to_string(m_page) + " is damaged");
    }
    /// A part of a row, of all samples or of those of one plane.
    static void put(std::span<std::byte> to, std::array<std::uint32_t, 2> at, std::uint32_t columns, const char* from,
                    const PageShape& page, int plane, std::size_t pixel) {
        const std::size_t sample = bytesPerValue(page.type), whole = sample * static_cast<std::size_t>(page.samples);
        std::byte* out =
            to.data() + (static_cast<std::size_t>(at[1]) * static_cast<std::size_t>(page.width) + at[0]) * whole;
        if (pixel == whole) {
            std::memcpy(out, from, columns * pixel);
            return;
        }
        out += static_cast<std::size_t>(plane) * sample;
        for (std::uint32_t i = 0; i < columns; ++i) std::memcpy(out + i * whole, from + i * sample, sample);
    }

    /// A row, or a part of it: the first pixel is the highest bit.
    static void putBits(std::span<std::byte> to, const char* from) {
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = static_cast<std::byte>(static_cast<unsigned char>(from[i / 8]) >> (7 - i % 8) & 1);
    }

    std::string m_path;
    TIFF* m_file = nullptr;
    int m_page = 0;
    bool m_isAtPage = false;
};

} // namespace

FileError pictureFailure(const std::string& path, const std::string& what, const std::string& why,
                         const std::string& toDo) {
    return {what + (why.empty() ? "" : " (" + why.substr(0, 300) + ")"), path, toDo};
}

std::string orientationNotice(int orientation) {
    static constexpr const char* kShown[] = {"mirrored from left to right",   "turned by 180°",
                                             "mirrored from top to bottom",   "mirrored along the diagonal",
                                             "turned by 90° clockwise",       "mirrored along the other diagonal",
                                             "turned by 90° counterclockwise"};
    if (orientation < 2 || orientation > 8) return {};
    return "the file says that pictures are to be shown " + std::string(kShown[orientation - 2]) + " (Orientation " +
           std::to_string(orientation) + "): they stay as they are stored";
}

std::uint64_t bytesOf(const PageShape& shape) {
    return static_cast<std::uint64_t>(shape.width) * static_cast<std::uint64_t>(shape.height) *
           static_cast<std::uint64_t>(shape.samples) * bytesPerValue(shape.type);
}

std::string textOf(const PageShape& shape) {
    return std::to_string(shape.width) + " x " + std::to_string(shape.height) + " pixels, " +
           std::to_string(shape.samples) + (shape.samples == 1 ? " sample of " : " samples of ") +
           (shape.isBilevel ? "1 bit" : std::to_string(8 * bytesPerValue(shape.type)) + " bits");
}

std::unique_ptr<PictureFile> openTiff(const std::string& path) { return std::make_unique<TiffFile>(path); }

} // namespace pellucid
