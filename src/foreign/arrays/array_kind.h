// Which format for arrays of numbers a path is of, by what is in it.
#pragma once

#include <string>

namespace pellucid {

enum class ArrayKind {
    None,
    Hdf5,  ///< HDF5, which NetCDF-4 and MATLAB's files of version 7.3 are, too
    NetCdf ///< the classic form of NetCDF, with offsets of 32 or 64 bits or sizes of 64
};

ArrayKind arrayKindOf(const std::string& path);

} // namespace pellucid
