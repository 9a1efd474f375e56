// All that a format can say, combined: files made by the tests, with the values that they hold.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace pellucid::test {

/// A type of numbers, as each format calls it.
struct MatrixType {
    const char *nrrd, *meta, *vtk;
    int nifti;
    int components = 1;                               ///< of a voxel in NIfTI
    bool isColour = false;                            ///< which NIfTI does not scale
    std::size_t bytes = 1;                            ///< of one number
    std::vector<double> (*values)(std::size_t count); ///< that it can hold, its ends among them
    std::string (*stored)(const std::vector<double>& values);
    bool isFloat = false;
};

/// The ends of the type, then numbers of both signs where it has them.
template <class T>
std::vector<double> valuesFor(std::size_t count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        double value = 0;
        if constexpr (std::is_floating_point_v<T>) {
            value =
                static_cast<double>(static_cast<T>((i % 3 == 0 ? -1.0 : 1.0) * (0.1 + static_cast<double>(i) * 1.7)));
        } else {
            value = static_cast<double>(static_cast<T>(static_cast<std::uint64_t>(i) * 37u));
            // Of 64 bits what a double holds: rounding is another matter.
            if (i == 0) value = static_cast<double>(std::numeric_limits<T>::lowest());
            if (i == 1 && sizeof(T) < 8) value = static_cast<double>(std::numeric_limits<T>::max());
        }
        values.push_back(value);
    }
    return values;
}

template <class T>
std::string storedAs(const std::vector<double>& values) {
    std::string bytes;
    for (const double value : values) {
        const T one = static_cast<T>(value);
        char piece[sizeof one];
        std::memcpy(piece, &one, sizeof one);
        bytes.append(piece, sizeof one);
    }
    return bytes;
}

template <class T>
MatrixType matrixType(const char* nrrd, const char* meta, const char* vtk, int nifti, int components = 1,
                      bool isColour = false) {
    return {nrrd,     meta,      vtk,          nifti,       components,
            isColour, sizeof(T), valuesFor<T>, storedAs<T>, std::is_floating_point_v<T>};
}

/// All fourteen of NIfTI that are read; the first ten are those of the other formats.
inline std::vector<MatrixType> matrixTypes() {
    return {matrixType<std::uint8_t>("uchar", "MET_UCHAR", "UInt8", 2),
            matrixType<std::int8_t>("signed char", "MET_CHAR", "Int8", 256),
            matrixType<std::uint16_t>("ushort", "MET_USHORT", "UInt16", 512),
            matrixType<std::int16_t>("short", "MET_SHORT", "Int16", 4),
            matrixType<std::uint32_t>("uint", "MET_UINT", "UInt32", 768),
            matrixType<std::int32_t>("int", "MET_INT", "Int32", 8),
            matrixType<std::uint64_t>("ulonglong", "MET_ULONG_LONG", "UInt64", 1280),
            matrixType<std::int64_t>("longlong", "MET_LONG_LONG", "Int64", 1024),
            matrixType<float>("float", "MET_FLOAT", "Float32", 16),
            matrixType<double>("double", "MET_DOUBLE", "Float64", 64),
            matrixType<float>("", "", "", 32, 2),
            matrixType<double>("", "", "", 1792, 2),
            matrixType<std::uint8_t>("", "", "", 128, 3, true),
            matrixType<std::uint8_t>("", "", "", 2304, 4, true)};
}

/// The bytes of numbers of `size` bytes in the other order.
inline std::string swapped(std::string bytes, std::size_t size) {
    for (std::size_t at = 0; at + size <= bytes.size(); at += size)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
    return bytes;
}

/// `bytes` as they stand in a file of this order.
inline std::string inOrder(const std::string& bytes, std::size_t size, bool bigEndian) {
    return bigEndian == (std::endian::native == std::endian::big) ? bytes : swapped(bytes, size);
}

/// A NIfTI-1 header with its fields in the other byte order.
inline std::string swappedNifti(std::string header) {
    struct Field {
        std::size_t at, size, count;
    };
    for (const Field& field :
         {Field{0, 4, 1}, {40, 2, 8}, {68, 2, 3}, {76, 4, 8}, {108, 4, 3}, {252, 2, 2}, {256, 4, 18}})
        header.replace(field.at, field.size * field.count,
                       swapped(header.substr(field.at, field.size * field.count), field.size));
    return header;
}

} // namespace pellucid::test
