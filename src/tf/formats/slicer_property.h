// A volume property of 3D Slicer, in whichever of its three files: what they have in common.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

/// 1 mm, where a file says nothing else.
inline constexpr OpacityLength kMillimetre{OpacityLength::Kind::World, 1};

/// A list of numbers as Slicer's older files have it: how many there are, then these. Throws FileError naming `where`.
std::vector<double> countedNumbers(std::string_view text, const std::string& where);
/// The same the other way round.
std::string countedText(const std::vector<double>& numbers);

/// The curves of such lists: x, opacity; and x, r, g, b. Throws likewise.
TfCurves slicerCurves(std::string_view opacities, std::string_view colors, const std::string& where);
/// Such lists of control points, in data units.
std::string slicerOpacities(const std::vector<ControlPoint>& points, const TfToWrite& tf);
std::string slicerColors(const std::vector<ControlPoint>& points, const TfToWrite& tf);

/// Light and gradient opacity, which are kept and not drawn: in the terms of the newest schema.
struct SlicerLook {
    int interpolation = 1; ///< 0: nearest, 1: linear
    bool shade = false;
    double ambient = 0.1, diffuse = 0.9, specular = 0.2, specularPower = 10;
    std::vector<std::array<double, 2>> gradient; ///< gradient magnitude and opacity

    bool gradientMatters() const; ///< it is not 1 everywhere
};
/// Keeps it with `read`, and says what is not drawn.
void keepLook(ReadTf& read, const SlicerLook& look, nlohmann::json others = nlohmann::json::object());
SlicerLook keptLook(const TfToWrite& tf);
/// The keys that keepLook() was given besides.
nlohmann::json keptOthers(const TfToWrite& tf);
/// Of the lists of older files; empty where there is none.
std::vector<std::array<double, 2>> gradientOf(std::string_view text, const std::string& where);
std::string slicerGradient(const SlicerLook& look);

} // namespace pellucid
