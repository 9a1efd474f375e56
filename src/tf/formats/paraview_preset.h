// *.paraview.json, colour maps with opacities as ParaView imports them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tf/formats/tf_curves.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// The suffix by which a file is known to be one.
inline constexpr const char* kParaViewSuffix = ".paraview.json";

/// A list of one preset, called `name`: control points as RGBPoints and Points, in data units, x = 0 and x = 1 at the
/// ends of `window` (lo < hi); what an eye hides has opacity 0. A step is two points that lie 1e-6 of the window apart.
/// ParaView draws the same where its ScalarOpacityUnitDistance is d0, but for opacities up to 1e-4, which it takes for
/// 0. Features are not part of it.
nlohmann::json paraViewPreset(const TransferFunction& tf, const ValueRange& window, const std::string& name);
/// A preset of these points, each at its own x.
nlohmann::json presetOfPoints(const std::vector<ControlPoint>& points, const ValueRange& range,
                              const std::string& name);

/// The colour space that presets and older colour maps call so, in lower case, as far as both have it: without HSV,
/// which they tell to wrap in ways of their own; empty for others.
std::optional<ColorSpace> paraViewSpace(const std::string& name);
/// Where the points are no data values but parts of whatever the range is.
std::optional<ValueRange> paraViewPositions(const TfCurves& curves);

} // namespace pellucid
