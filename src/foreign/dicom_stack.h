// Pictures of one series put in order: slices side by side, steps one after the other, on a regular grid.
#pragma once

#include <string>
#include <vector>

#include "foreign/dicom_header.h"
#include "volume/volume.h"

namespace pellucid {

/// A layer of the grid: a picture, or what lies between two.
struct DicomLayer {
    std::size_t before = 0, after = 0; ///< pictures; the same one where the layer is a picture
    double toAfter = 0;                ///< in [0,1): how far the layer is from `before` to `after`
};

struct DicomStack {
    Geometry geometry;                          ///< of each step
    std::vector<std::vector<DicomLayer>> steps; ///< from first to last; each has geometry.dims.z layers
    std::vector<double> times;                  ///< of the steps, in timeUnit; empty: not known
    std::string timeUnit;
    std::vector<std::string> notices;
};

/// Of pictures of one size and direction. Where slices are missing or not equally far from each other, layers between
/// them are interpolated, and a notice says so; pictures that are there twice, and steps that are not complete, are
/// left out, and a notice says so. Throws FileError, with `where`, where the slices lie on no grid.
DicomStack stackOf(const std::vector<DicomFrame>& frames, const std::string& where);

} // namespace pellucid
