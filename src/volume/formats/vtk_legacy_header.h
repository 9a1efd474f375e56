// What VTK's legacy files (.vtk) say: all but the values of their arrays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "volume/formats/samples.h"

namespace pellucid {

/// An array of a legacy file, or a list of coordinates.
struct LegacyArray {
    std::string name, typeName;    ///< typeName as the file has it
    std::optional<ValueType> type; ///< none: it can be passed over, but not be read
    std::int64_t components = 1;
    std::uint64_t tuples = 0; ///< of so many components each
    std::uint64_t start = 0;  ///< byte of the file
    bool ofCells = false, isScalars = false;
    bool areFractions = false; ///< numbers from 0 to 1 stand there for bytes from 0 to 255
};

/// A whole file of a regular grid.
struct LegacyVtk {
    std::string path;
    bool isBinary = false;
    std::array<std::int64_t, 3> dims{0, 0, 0}; ///< points; 0: the file does not say
    Vec3 spacing{1, 1, 1}, origin{0, 0, 0};
    std::vector<LegacyArray> arrays; ///< those with as many tuples as there are points, or cells
    std::optional<double> time;
};

/// Goes through a file once, past the values of its arrays. Throws FileError; where it holds no regular grid, it says
/// what it holds.
LegacyVtk readLegacyVtk(const std::string& path, const JobControl& job);

/// Cells along an axis of so many points: an axis of one point has one layer of cells, which have no extent along it.
std::int64_t cellsAlong(std::int64_t points);

} // namespace pellucid
