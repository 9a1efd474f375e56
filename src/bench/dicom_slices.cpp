#include "bench/dicom_slices.h"

#include <bit>
#include <fstream>
#include <type_traits>
#include <variant>

#include "base/error.h"
#include "base/round_numbers.h"

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
    if (std::endian::native != std::endian::little) return false; // pixels are written as they lie
    return std::visit(
        [](const auto& samples) {
            using T = typename std::decay_t<decltype(samples)>::value_type;
            return std::is_integral_v<T> && sizeof(T) <= 2;
        },
        volume.samples());
}

void writeDicomSlices(const Volume& volume, const std::string& folder) {
    const Int3 dims = volume.dims();
    const auto pixels = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
    std::visit(
        [&](const auto& samples) {
            using T = typename std::decay_t<decltype(samples)>::value_type;
            for (int z = 0; z < dims.z; ++z) {
                const auto* from = reinterpret_cast<const char*>(samples.data() + static_cast<std::size_t>(z) * pixels);
                const std::string path = folder + "/" + std::to_string(z) + ".dcm";
                std::ofstream out(path, std::ios::binary); // hundreds of files need not each be on the disk
                out << headOf(volume, z, 8 * sizeof(T), std::is_signed_v<T>)
                    << element(0x7fe00010, "OW", std::string(from, pixels * sizeof(T)));
                if (!out.flush()) throw FileError("it cannot be written", path, "make room");
            }
        },
        volume.samples());
}

} // namespace pellucid
