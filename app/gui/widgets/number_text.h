// Numbers as the window writes them.
#pragma once

#include <QString>

#include "base/round_numbers.h"
#include "volume/orientation.h"

namespace pellucid::gui {

/// As pellucid::numberText().
QString numberText(double value, double span);

/// With three digits that count: "0.0123".
QString shortNumber(double value);

/// "-1024 – 2986": both ends with as many digits as the range needs.
QString rangeText(const ValueRange& range);

/// A place of the world in the coordinates that people have chosen: "12.5, -3.0, 88.1 mm (RAS)"; without letters where
/// the world is no patient's.
QString placeText(const Geometry& geometry, PatientAxes axes, const Vec3& world);

/// Of a step along rays, in d0: "1/64", "0.3", "2".
QString stepText(double inD0);

} // namespace pellucid::gui
