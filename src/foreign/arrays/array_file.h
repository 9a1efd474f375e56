// A file of named arrays of numbers, whatever its format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "foreign/foreign_volume.h"

namespace pellucid {

/// What is said of an array under one name.
struct ArrayAttribute {
    std::string text;            ///< where it is no numbers
    std::vector<double> numbers; ///< of integers of 64 bits the nearest
    bool areFloats = false;
};

struct ArrayVariable {
    std::string name;               ///< with the groups that it is in: "/group/name"
    std::vector<std::int64_t> dims; ///< slowest first
    std::optional<ValueType> type;  ///< as it is read; empty: not numbers
    std::string typeName;           ///< "i16", "texts", …
};

/// What is known of an axis of an array.
struct ArrayDimension {
    std::string name;        ///< empty: it has none
    std::string coordinates; ///< the variable that says where its places are; empty: there is none
};

/// A part of an array: along each axis `size` places from `first` on.
struct ArrayBox {
    std::vector<std::int64_t> first, size; ///< slowest first
};

class ArrayFile {
public:
    virtual ~ArrayFile() = default;
    /// Whether NetCDF's rules hold for what attributes mean.
    virtual bool isNetCdf() const = 0;
    virtual const std::vector<ArrayVariable>& variables() const = 0;
    virtual std::vector<std::string> files() const = 0;
    virtual std::vector<std::string> notices() const { return {}; }
    virtual std::optional<ArrayAttribute> attribute(const ArrayVariable& variable, const std::string& name) const = 0;
    virtual std::vector<ArrayDimension> dimensions(const ArrayVariable& variable) const = 0;
    /// Throws FileError where the values cannot be read, or are not in the file; what is odd becomes a notice.
    virtual std::vector<std::string> check(const ArrayVariable& variable) const = 0;
    /// The box by which it is stored, along each axis; 1 where any will do.
    virtual std::vector<std::int64_t> blockSize(const ArrayVariable& variable) const = 0;
    /// Where the values of a box need no library to be read. Empty where they do, or where that is not known.
    virtual std::optional<PlainValues> plainValues(const ArrayVariable& variable, const ArrayBox& box) const = 0;
    /// Reads values of variable.type in this machine's byte order, the last axis fastest. Throws FileError.
    virtual void read(const ArrayVariable& variable, const ArrayBox& box, std::span<std::byte> to) const = 0;

    /// Null where there is none.
    const ArrayVariable* find(const std::string& name) const;
    /// The first number under that name.
    std::optional<double> number(const ArrayVariable& variable, const std::string& name) const;
    /// Empty where there is no text under that name.
    std::string text(const ArrayVariable& variable, const std::string& name) const;
    /// All values, unpacked as attributes say. Throws FileError.
    std::vector<double> values(const ArrayVariable& variable) const;
};

/// Whether the values of a box follow each other in all of an array.
bool isRun(const ArrayVariable& variable, const ArrayBox& box);
/// "u8", "i64", …
std::string nameOf(ValueType type);
std::uint64_t valuesIn(const ArrayVariable& variable); ///< 0 where they are too many to count

/// hdf5_file.cpp. Throws FileError.
std::unique_ptr<ArrayFile> openHdf5(const std::string& path, const BeforeFile& before);
/// netcdf_file.cpp: the classic form. Throws FileError.
std::unique_ptr<ArrayFile> openNetCdf(const std::string& path, const BeforeFile& before);

} // namespace pellucid
