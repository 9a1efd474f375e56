// What kind of data a volume holds, told from its values (docs/method.md, "The automatic start").
#pragma once

#include <vector>

#include "base/enum_names.h"
#include "base/job.h"
#include "volume/voxel_survey.h"

namespace pellucid {

enum class DataKind {
    Continuous, ///< intensities without further meaning
    Ct,         ///< Hounsfield units
    Signed,     ///< values of both signs about 0: differences, t-maps, components of vectors
    Labels,     ///< few whole numbers, each a thing of its own
    Binary,     ///< two values
    Constant,   ///< one value
    Empty       ///< no valid voxel
};
template <>
inline constexpr auto kNamesOf<DataKind> = enumNames("kind of data", "continuous", "ct", "signed", "labels", "binary",
                                                     "constant", "empty");

/// Of the values of such data: "HU" of CT, "" where nothing tells.
const char* unitOf(DataKind kind);

/// Density of air and of what scanners write beyond it, HU.
inline constexpr ValueRange kAirHounsfield{-1100, -900};

struct RecognisedKind {
    DataKind kind = DataKind::Continuous;
    std::vector<double> values; ///< of Labels and Binary: all that occur, ascending
    double sigma = 0;           ///< of Signed: robust spread about 0 of the values that are not 0
};

/// The kind of `data`, of which `survey` is a sample. A volume of more than 2²⁶ voxels may hide a rare label from it.
RecognisedKind recogniseKind(const Volume& data, const VoxelSurvey& survey, const JobControl& job = {});

} // namespace pellucid
