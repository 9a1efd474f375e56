// Writes DICOM files element by element, as DICOM PS3.5 describes them: what the reader is tested against.
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::test {

/// The elements of a data set, by group and element; each with the type that says how its value is written.
class DicomElements {
public:
    void text(std::uint16_t group, std::uint16_t element, const char* type, std::string value) {
        if (value.size() % 2 != 0) value += std::string(type) == "UI" ? '\0' : ' ';
        m_elements[{group, element}] = {type, std::move(value)};
    }
    void number(std::uint16_t group, std::uint16_t element, std::uint16_t value) {
        m_elements[{group, element}] = {"US", {static_cast<char>(value & 255), static_cast<char>(value >> 8)}};
    }
    void real(std::uint16_t group, std::uint16_t element, double value) {
        std::string bytes(sizeof value, '\0');
        std::memcpy(bytes.data(), &value, sizeof value);
        m_elements[{group, element}] = {"FD", bytes};
    }
    void bytes(std::uint16_t group, std::uint16_t element, const char* type, const std::string& value) {
        m_elements[{group, element}] = {type, value.size() % 2 == 0 ? value : value + '\0'};
    }
    /// Pixels that are packed, in parts of an even number of bytes behind a table of where pictures begin.
    void packedPixels(const std::vector<std::string>& parts, const std::string& table = "") {
        std::string value;
        const auto add = [&](const std::string& part) { value += item(part.size()) + part; };
        add(table);
        for (const std::string& part : parts) add(part);
        m_elements[{0x7fe0, 0x0010}] = {"OB", value + std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8), true};
    }
    void items(std::uint16_t group, std::uint16_t element, const std::vector<DicomElements>& items) {
        std::string value;
        for (const DicomElements& item : items) {
            const std::string inside = item.encoded();
            value += DicomElements::item(inside.size()) + inside;
        }
        m_elements[{group, element}] = {"SQ", value};
    }
    void remove(std::uint16_t group, std::uint16_t element) { m_elements.erase({group, element}); }

    /// Explicit types, little endian.
    std::string encoded() const {
        std::string all;
        for (const auto& [tag, element] : m_elements) {
            const auto& [type, value, isOpen] = element;
            for (const std::uint16_t part : {tag.first, tag.second})
                all += {static_cast<char>(part & 255), static_cast<char>(part >> 8)};
            all += type;
            const bool isLong = type == "OB" || type == "OW" || type == "OV" || type == "SQ" || type == "UN";
            if (isLong)
                all += std::string(2, '\0') + (isOpen ? std::string(4, '\xff') : length(value.size()));
            else
                all += {static_cast<char>(value.size() & 255), static_cast<char>(value.size() >> 8)};
            all += value;
        }
        return all;
    }

private:
    struct Element {
        std::string type, value;
        bool isOpen = false; ///< has no length, but an end of its own
    };
    static std::string item(std::size_t bytes) { return std::string("\xfe\xff\x00\xe0", 4) + length(bytes); }
    static std::string length(std::size_t bytes) {
        std::string four(4, '\0');
        for (int i = 0; i < 4; ++i) four[static_cast<std::size_t>(i)] = static_cast<char>(bytes >> (8 * i) & 255);
        return four;
    }
    std::map<std::pair<std::uint16_t, std::uint16_t>, Element> m_elements;
};

/// One slice; what is empty or 0 is not written.
struct DicomSlice {
    int columns = 3, rows = 2, number = 1;
    std::string series = "1.2.3", description = "head", seriesNumber = "1", instance, modality = "CT";
    std::string position = "0\\0\\0", axes = "1\\0\\0\\0\\1\\0", spacing = "2\\1", slope, intercept;
    std::uint16_t bitsAllocated = 16, bitsStored = 12, isSigned = 0, samples = 1;
    std::string photometric = "MONOCHROME2";
    std::string pixels; ///< bytes, little endian
    std::string syntax = "1.2.840.10008.1.2.1";
    DicomElements more; ///< besides these
};

/// Numbers of 16 bits as bytes.
inline std::string words(const std::vector<int>& values) {
    std::string bytes;
    for (const int value : values) bytes += {static_cast<char>(value & 255), static_cast<char>(value >> 8 & 255)};
    return bytes;
}

inline DicomElements elementsOf(const DicomSlice& slice) {
    DicomElements set = slice.more;
    const auto text = [&](std::uint16_t group, std::uint16_t element, const char* type, const std::string& value) {
        if (!value.empty()) set.text(group, element, type, value);
    };
    text(0x0008, 0x0018, "UI",
         slice.instance.empty() ? slice.series + "." + std::to_string(slice.number) : slice.instance);
    text(0x0008, 0x0060, "CS", slice.modality);
    text(0x0008, 0x103e, "LO", slice.description);
    text(0x0020, 0x000e, "UI", slice.series);
    text(0x0020, 0x0011, "IS", slice.seriesNumber);
    text(0x0020, 0x0013, "IS", std::to_string(slice.number));
    text(0x0020, 0x0032, "DS", slice.position);
    text(0x0020, 0x0037, "DS", slice.axes);
    set.number(0x0028, 0x0002, slice.samples);
    text(0x0028, 0x0004, "CS", slice.photometric);
    if (slice.samples > 1) set.number(0x0028, 0x0006, 0);
    set.number(0x0028, 0x0010, static_cast<std::uint16_t>(slice.rows));
    set.number(0x0028, 0x0011, static_cast<std::uint16_t>(slice.columns));
    text(0x0028, 0x0030, "DS", slice.spacing);
    set.number(0x0028, 0x0100, slice.bitsAllocated);
    set.number(0x0028, 0x0101, slice.bitsStored);
    set.number(0x0028, 0x0102, static_cast<std::uint16_t>(slice.bitsStored - 1));
    set.number(0x0028, 0x0103, slice.isSigned);
    text(0x0028, 0x1052, "DS", slice.intercept);
    text(0x0028, 0x1053, "DS", slice.slope);
    if (!slice.pixels.empty()) set.bytes(0x7fe0, 0x0010, slice.bitsAllocated == 16 ? "OW" : "OB", slice.pixels);
    return set;
}

inline std::string dicomFile(const DicomElements& set, const std::string& syntax = "1.2.840.10008.1.2.1") {
    DicomElements meta;
    meta.text(0x0002, 0x0010, "UI", syntax);
    return std::string(128, '\0') + "DICM" + meta.encoded() + set.encoded();
}
inline std::string dicomFile(const DicomSlice& slice) { return dicomFile(elementsOf(slice), slice.syntax); }

} // namespace pellucid::test
