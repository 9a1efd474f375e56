#include "bench/dicom_slices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <span>

#include "base/error.h"
#include "base/round_numbers.h"
#include "volume/formats/writer.h"

namespace pellucid {

namespace {

std::string littleEndian(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 255);
    return text;
}

/// An element with its type, as DICOM PS3.5 writes it.
std::string element(std::uint32_t tag, const std::string& type, std::string value) {
    if (value.size() % 2 != 0) value += type == "UI" ? '\0' : ' ';
    const std::string head = littleEndian(tag >> 16, 2) + littleEndian(tag & 0xffff, 2) + type;
    return head + (type == "OW" ? littleEndian(0, 2) + littleEndian(value.size(), 4) : littleEndian(value.size(), 2)) +
           value;
}
std::string element(std::uint32_t tag, int value) {
    return element(tag, "US", littleEndian(static_cast<std::uint64_t>(value), 2));
}

/// All of a slice but its pixels.
std::string headOf(const Volume& volume, int slice, int bits, bool isSigned) {
    const Geometry& g = volume.geometry();
    return std::string(128, '\0') + "DICM" + element(0x00020010, "UI", "1.2.840.10008.1.2.1") +
           element(0x00080018, "UI", "1.2.3." + std::to_string(slice + 1)) + element(0x00080060, "CS", "OT") +
           element(0x0020000e, "UI", "1.2.3") + element(0x00200013, "IS", std::to_string(slice + 1)) +
           element(0x00200032, "DS", "0\\0\\" + exactText(slice * g.spacing.z)) +
           element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + element(0x00280002, 1) +
           element(0x00280004, "CS", "MONOCHROME2") + element(0x00280010, g.dims.y) + element(0x00280011, g.dims.x) +
           element(0x00280030, "DS", exactText(g.spacing.y) + "\\" + exactText(g.spacing.x)) +
           element(0x00280100, bits) + element(0x00280101, bits) + element(0x00280102, bits - 1) +
           element(0x00280103, isSigned ? 1 : 0);
}

} // namespace

bool fitsDicom(const Volume& volume) {
    constexpr std::array kFit{SampleType::U8, SampleType::I8, SampleType::U16, SampleType::I16};
    return std::endian::native == std::endian::little && // pixels are written as they lie
           std::ranges::find(kFit, volume.sampleType()) != kFit.end();
}

void writeDicomSlices(const Volume& volume, const std::string& folder) {
    const SampleType type = volume.sampleType();
    const bool isSigned = type == SampleType::I8 || type == SampleType::I16;
    const int slices = volume.dims().z, bits = 8 * static_cast<int>(bytesPerSample(type));
    const std::span<const std::byte> all = sampleBytes(volume);
    const std::size_t each = all.size() / static_cast<std::size_t>(slices);
    for (int z = 0; z < slices; ++z) {
        const auto pixels = all.subspan(static_cast<std::size_t>(z) * each, each);
        const std::string path = folder + "/" + std::to_string(z) + ".dcm";
        std::ofstream out(path, std::ios::binary); // hundreds of files need not each be on the disk
        out << headOf(volume, z, bits, isSigned)
            << element(0x7fe00010, "OW", std::string(reinterpret_cast<const char*>(pixels.data()), pixels.size()));
        if (!out.flush()) throw FileError("it cannot be written", path, "make room");
    }
}

} // namespace pellucid
