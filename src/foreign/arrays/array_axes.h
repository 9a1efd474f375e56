// What the axes of an array mean: places, time steps or components; and where its places are.
#pragma once

#include "foreign/arrays/array_file.h"

namespace pellucid {

struct ArrayAxes {
    std::vector<std::size_t> places;       ///< slowest first, at most 3
    std::vector<std::size_t> steps;        ///< along these are time steps, slowest first
    std::optional<std::size_t> components; ///< along this are the components of a voxel
    Vec3 spacing{1, 1, 1}, origin{0, 0, 0};
    LengthUnit lengthUnit = LengthUnit::Unknown; ///< of spacing and origin
    Mat3 directions{1};
    std::vector<double> times; ///< of the steps, in timeUnit; empty: not known
    std::string timeUnit;
    std::vector<std::string> notices;
};

/// By dimensions and their coordinates (CF Conventions 1.10, chapter 4), or by what programs write beside arrays.
/// Throws FileError.
ArrayAxes axesOf(const ArrayFile& file, const ArrayVariable& variable);

} // namespace pellucid
