#include "foreign/dicom_pixels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string_view>

#include <gdcmImage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfFragments.h>

#include "base/text.h"
#include "foreign/foreign_volume.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

std::size_t bytesPerSampleOf(const DicomPixels& pixels) { return static_cast<std::size_t>(pixels.bitsAllocated / 8); }

std::size_t samplesOf(const DicomPixels& pixels) {
    return static_cast<std::size_t>(pixels.columns) * static_cast<std::size_t>(pixels.rows) *
           static_cast<std::size_t>(pixels.samples);
}

/// Planes of one sample each become pixels with all samples beside each other.
void interleave(std::vector<char>& bytes, const DicomPixels& pixels) {
    const std::size_t each = bytesPerSampleOf(pixels), samples = static_cast<std::size_t>(pixels.samples),
                      plane = samplesOf(pixels) / samples;
    std::vector<char> frame(plane * samples * each);
    for (std::size_t first = 0; first + frame.size() <= bytes.size(); first += frame.size()) {
        for (std::size_t s = 0; s < samples; ++s)
            for (std::size_t p = 0; p < plane; ++p)
                std::copy_n(bytes.data() + first + (s * plane + p) * each, each,
                            frame.data() + (p * samples + s) * each);
        std::ranges::copy(frame, bytes.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

/// Brightness and two hues of 8 bits to red, green and blue (DICOM PS3.3, C.7.6.3.1.2).
void toRgb(std::vector<char>& bytes) {
    const auto clamped = [](double value) {
        return static_cast<char>(static_cast<unsigned char>(std::clamp(std::round(value), 0.0, 255.0)));
    };
    for (std::size_t i = 0; i + 3 <= bytes.size(); i += 3) {
        const auto at = [&](std::size_t n) { return static_cast<double>(static_cast<unsigned char>(bytes[i + n])); };
        const double y = at(0), blue = at(1) - 128, red = at(2) - 128;
        bytes[i] = clamped(y + 1.402 * red);
        bytes[i + 1] = clamped(y - 0.344136 * blue - 0.714136 * red);
        bytes[i + 2] = clamped(y + 1.772 * blue);
    }
}

FileError failure(const DicomFrame& frame, const std::string& what) {
    return {what, frame.file, "copy the file again, or take it out of the folder to open the others"};
}

/// Of each two pixels their brightness and the hue that they share (blue, red): those of each.
std::vector<char> spreadHues(const std::vector<char>& shared) {
    std::vector<char> bytes;
    bytes.reserve(shared.size() / 2 * 3);
    for (std::size_t i = 0; i + 4 <= shared.size(); i += 4)
        for (const std::size_t brightness : {i, i + 1})
            bytes.insert(bytes.end(), {shared[brightness], shared[i + 2], shared[i + 3]});
    return bytes;
}

/// Bits, the lowest of each byte first, as bytes.
std::vector<char> spreadBits(const std::vector<char>& packed, std::size_t count) {
    std::vector<char> bytes(count);
    for (std::size_t i = 0; i < count; ++i)
        bytes[i] = static_cast<char>((static_cast<unsigned char>(packed[i / 8]) >> (i % 8)) & 1);
    return bytes;
}

/// Of pixels that lie in the file as they are.
std::vector<char> readPlain(const DicomFrame& frame) {
    const DicomPixels& pixels = frame.pixels;
    const std::size_t values = samplesOf(pixels) * static_cast<std::size_t>(frame.framesInFile);
    const bool areShared = frame.photometric == "YBR_FULL_422" && pixels.samples == 3 && pixels.bitsAllocated == 8;
    if (areShared && pixels.columns % 2 != 0)
        throw failure(frame, "colours that two pixels share need an even number of columns");
    const std::size_t bytes = areShared        ? values / 3 * 2
                              : pixels.areBits ? (values + 7) / 8
                                               : values * bytesPerSampleOf(pixels);
    const std::uint64_t fileBytes = readableFileBytes(frame.file);
    const std::uint64_t there = fileBytes - std::min(fileBytes, frame.pixelsAt);
    if (there < bytes)
        throw failure(frame, "the pixels have " + std::to_string(there) + " of " + std::to_string(bytes) + " bytes");
    std::vector<char> read(bytes);
    std::ifstream in(frame.file, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(frame.pixelsAt));
    in.read(read.data(), static_cast<std::streamsize>(bytes));
    if (!in) throw failure(frame, "the file cannot be read");
    if (frame.isBigEndian != (std::endian::native == std::endian::big)) {
        const std::size_t each = std::max<std::size_t>(bytesPerSampleOf(pixels), frame.areWords ? 2 : 1);
        swapBytes(std::as_writable_bytes(std::span(read)), each);
    }
    if (pixels.areBits) return spreadBits(read, values);
    return areShared ? spreadHues(read) : read;
}

/// Where the parts of the packed pictures begin, counted from the first one. Throws FileError unless they are whole:
/// decoders make up what is cut off.
std::vector<std::uint64_t> wholeParts(const DicomFrame& frame) {
    const std::uint64_t fileBytes = readableFileBytes(frame.file);
    std::ifstream in(frame.file, std::ios::binary);
    std::vector<std::uint64_t> parts;
    std::uint64_t first = frame.pixelsAt;
    for (std::uint64_t at = frame.pixelsAt; at < fileBytes;) {
        std::array<unsigned char, 8> head{};
        in.seekg(static_cast<std::streamoff>(at));
        in.read(reinterpret_cast<char*>(head.data()), head.size());
        const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(head[i] | head[i + 1] << 8); };
        const bool isEnd = number(2) == 0xe0dd;
        if (!in || number(0) != 0xfffe || (number(2) != 0xe000 && !isEnd))
            throw failure(frame, "the packed pixels are damaged, or cut off");
        if (isEnd) break;
        const std::uint64_t bytes = number(4) | static_cast<std::uint64_t>(number(6)) << 16;
        const std::uint64_t begin = at;
        at += head.size() + bytes;
        if (begin == frame.pixelsAt)
            first = at; // behind the table of where pictures begin, which may be empty
        else
            parts.push_back(begin - first);
        if (at > fileBytes) throw failure(frame, "the packed pixels are cut off");
    }
    if (parts.size() < static_cast<std::size_t>(frame.framesInFile))
        throw failure(frame, "there are " + std::to_string(parts.size()) + " of " + std::to_string(frame.framesInFile) +
                                 " packed pictures");
    return parts;
}

std::string_view bytesOf(const gdcm::DataElement& element) {
    const gdcm::ByteValue* value = element.GetByteValue();
    return value == nullptr || value->GetPointer() == nullptr
               ? std::string_view()
               : std::string_view(value->GetPointer(), value->GetLength());
}

/// Whether a part begins like a picture of JPEG, JPEG-LS or JPEG 2000.
bool beginsPicture(std::string_view part) {
    return part.starts_with("\xff\xd8\xff") || part.starts_with("\xff\x4f\xff\x51");
}

/// The parts, by their index, with which pictures begin: of one picture, by the tables of the file, by what parts begin
/// with. Throws FileError where none of these tells.
std::vector<std::size_t> firstParts(const DicomFrame& frame, const std::vector<std::uint64_t>& parts,
                                    const gdcm::SequenceOfFragments& packed, const gdcm::DataSet& set) {
    const auto frames = static_cast<std::size_t>(frame.framesInFile);
    if (frames == 1) return {0};
    const auto byTable = [&](std::string_view table, std::size_t width) {
        std::vector<std::size_t> found;
        for (std::size_t at = 0; table.size() == frames * width && at < table.size(); at += width) {
            std::uint64_t offset = 0;
            for (std::size_t i = width; i-- > 0;) offset = offset << 8 | static_cast<unsigned char>(table[at + i]);
            const auto part = std::ranges::lower_bound(parts, offset);
            if (part == parts.end() || *part != offset) return std::vector<std::size_t>{};
            found.push_back(static_cast<std::size_t>(part - parts.begin()));
        }
        return found;
    };
    std::vector<std::size_t> byContent;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (beginsPicture(bytesOf(packed.GetFragment(i)))) byContent.push_back(i);
    const gdcm::Tag extended(0x7fe0, 0x0001);
    const std::string_view offsets = set.FindDataElement(extended) ? bytesOf(set.GetDataElement(extended)) : "";
    for (const auto& first : {byTable(bytesOf(packed.GetTable()), 4), byTable(offsets, 8), byContent}) {
        const bool ascends = std::ranges::adjacent_find(first, std::greater_equal<>()) == first.end();
        if (first.size() == frames && first.front() == 0 && ascends) return first;
    }
    throw FileError("the packed pixels are in " + std::to_string(parts.size()) +
                        " parts, and the file does not say which of them belong to each of its " +
                        std::to_string(frames) + " pictures",
                    frame.file, "export the series again without compression, or with one part for each picture");
}

/// The packed pictures, each in one part, as decoders want them: writers may cut them into several.
gdcm::DataElement joinedParts(const DicomFrame& frame, const std::vector<std::uint64_t>& parts,
                              const gdcm::DataSet& set) {
    const gdcm::DataElement& data = set.GetDataElement(gdcm::Tag(0x7fe0, 0x0010));
    if (parts.size() == static_cast<std::size_t>(frame.framesInFile)) return data;
    const gdcm::SequenceOfFragments* packed = data.GetSequenceOfFragments();
    if (packed == nullptr || packed->GetNumberOfFragments() != parts.size())
        throw failure(frame, "the packed pixels are damaged");
    const std::vector<std::size_t> first = firstParts(frame, parts, *packed, set);
    const auto joined = gdcm::SequenceOfFragments::New();
    for (std::size_t n = 0; n < first.size(); ++n) {
        std::string picture;
        for (std::size_t i = first[n]; i < (n + 1 < first.size() ? first[n + 1] : parts.size()); ++i) {
            const std::string_view part = bytesOf(packed->GetFragment(i));
            if (i > first[n] && beginsPicture(part))
                throw failure(frame, "there are more packed pictures than the " + std::to_string(frame.framesInFile) +
                                         " that the header says");
            picture += part;
        }
        if (picture.size() >= std::numeric_limits<std::uint32_t>::max())
            throw failure(frame, "a packed picture has more than 4 GB");
        gdcm::Fragment fragment;
        fragment.SetByteValue(picture.data(), static_cast<std::uint32_t>(picture.size()));
        joined->AddFragment(fragment);
    }
    gdcm::DataElement element = data;
    element.SetValue(*joined);
    return element;
}

/// Of pixels that a library has to unpack.
std::vector<char> unpack(const DicomFrame& frame) {
    const DicomPixels& pixels = frame.pixels;
    const bool isEncapsulated = frame.storage == DicomFrame::Storage::Encapsulated;
    if (pixels.areBits) throw failure(frame, "packed pixels of one bit are not supported");
    const std::vector<std::uint64_t> parts = isEncapsulated ? wholeParts(frame) : std::vector<std::uint64_t>{};
    gdcm::Reader reader;
    reader.SetFileName(frame.file.c_str());
    if (!reader.Read()) throw failure(frame, "the pixels of this DICOM file cannot be read");
    const gdcm::DataSet& set = reader.GetFile().GetDataSet();
    const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    if (syntax == gdcm::TransferSyntax::RLELossless && pixels.samples > 1 && pixels.bitsAllocated > 8)
        throw failure(frame, "colours of more than 8 bits that are packed by RLE are not supported");
    if (syntax == gdcm::TransferSyntax::RLELossless && parts.size() > static_cast<std::size_t>(frame.framesInFile))
        throw failure(frame, "there are " + std::to_string(parts.size()) + " pictures packed by RLE instead of " +
                                 std::to_string(frame.framesInFile));
    if (isEncapsulated && syntax != gdcm::TransferSyntax::RLELossless && pixels.lowestBit > 0)
        throw FileError("packed pixels of which the lowest bits are not used (HighBit) are not supported", frame.file,
                        "export the series again without compression");
    const std::size_t wanted =
        samplesOf(pixels) * bytesPerSampleOf(pixels) * static_cast<std::size_t>(frame.framesInFile);
    // Not the library's own reader of images, which stops the program at odd values of elements that nobody needs.
    gdcm::Image image;
    image.SetNumberOfDimensions(3);
    image.SetDimension(0, static_cast<unsigned>(pixels.columns));
    image.SetDimension(1, static_cast<unsigned>(pixels.rows));
    image.SetDimension(2, static_cast<unsigned>(frame.framesInFile));
    image.SetPixelFormat(gdcm::PixelFormat(
        static_cast<unsigned short>(pixels.samples), static_cast<unsigned short>(pixels.bitsAllocated),
        static_cast<unsigned short>(pixels.bitsStored + pixels.lowestBit),
        static_cast<unsigned short>(pixels.bitsStored + pixels.lowestBit - 1), pixels.isSigned ? 1 : 0));
    const auto colors = gdcm::PhotometricInterpretation::GetPIType(frame.photometric.c_str());
    if (colors == gdcm::PhotometricInterpretation::PI_END)
        throw failure(frame, "the colours " + inQuotes(frame.photometric) + " are not known");
    image.SetPhotometricInterpretation(colors);
    image.SetPlanarConfiguration(pixels.samples > 1 && frame.isPlanar ? 1 : 0);
    image.SetTransferSyntax(syntax);
    image.SetDataElement(isEncapsulated ? joinedParts(frame, parts, set)
                                        : set.GetDataElement(gdcm::Tag(0x7fe0, 0x0010)));
    if (image.GetBufferLength() < wanted) throw failure(frame, "the pixels are not of the size that the header says");
    std::vector<char> bytes(image.GetBufferLength());
    if (!image.GetBuffer(bytes.data())) throw failure(frame, "the pixels of this DICOM file are damaged");
    bytes.resize(wanted);
    return bytes;
}

} // namespace

std::vector<char> unpackDicom(const DicomFrame& frame) {
    const DicomPixels& pixels = frame.pixels;
    std::vector<char> bytes = frame.storage == DicomFrame::Storage::Plain ? readPlain(frame) : unpack(frame);
    if (pixels.samples > 1 && frame.isPlanar) interleave(bytes, pixels);
    const bool isHue = frame.photometric == "YBR_FULL" || frame.photometric == "YBR_FULL_422";
    if (pixels.samples == 3 && pixels.bitsAllocated == 8 && isHue) toRgb(bytes);
    return bytes;
}

} // namespace pellucid
