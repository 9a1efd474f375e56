// Views in words, as options and files name them.
#pragma once

#include <string>
#include <variant>

#include "render/standard_view.h"

namespace pellucid {

/// What a view's words say before the volume is known.
using WordedView = std::variant<ViewAngles, NamedView>;

/// "AZIMUTH,ELEVATION[,ZOOM]" in degrees, or "NAME[,ZOOM]" as namedView() knows names; zoom 1 fits the volume. Throws
/// UsageError without a place.
WordedView viewFromText(const std::string& text);

} // namespace pellucid
