// Types of numbers in HDF5 files, and attributes of them.
#pragma once

#include "foreign/arrays/array_file.h"
#include "foreign/arrays/hdf5_handle.h"

namespace pellucid {

/// How values of a type are read.
struct Hdf5Type {
    std::optional<ValueType> kept; ///< empty: they are no numbers
    Hdf5Handle inMemory;           ///< as libhdf5 hands them over
    std::string name;              ///< "i16", "texts", …
};

Hdf5Type typeOf(const Hdf5Handle& inFile);

/// Of a dataset or a group; empty where there is none, or it is neither numbers nor a text, or long.
std::optional<ArrayAttribute> hdf5Attribute(const Hdf5Handle& object, const std::string& name);

} // namespace pellucid
