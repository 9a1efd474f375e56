// Which set of definitions figures are computed by.
#pragma once

#include "base/enum_names.h"

namespace pellucid {

enum class Profile {
    Default,  ///< docs/method.md
    Published ///< as the programs behind the thesis's printed figures compute (docs/method.md, "The published profile")
};
template <>
inline constexpr auto kNamesOf<Profile> = enumNames("profile", "default", "published");

/// The face of the grid that the published profile looks at, and from which on it goes through the planes of voxels.
enum class Along { Top, Bottom, Front, Back, Left, Right };
template <>
inline constexpr auto kNamesOf<Along> = enumNames("side", "top", "bottom", "front", "back", "left", "right");

} // namespace pellucid
