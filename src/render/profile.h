// Which set of definitions figures are computed by.
#pragma once

#include <string>

namespace pellucid {

enum class Profile {
    Default,  ///< docs/method.md
    Published ///< as the programs behind the thesis's printed figures compute (docs/method.md, "The published profile")
};
const char* name(Profile profile);                ///< "default", "published"
Profile profileFromName(const std::string& name); ///< throws UsageError

/// The face of the grid that the published profile looks at, and from which on it goes through the planes of voxels.
enum class Along { Top, Bottom, Front, Back, Left, Right };
const char* name(Along along);                ///< "top", "bottom", "front", "back", "left", "right"
Along alongFromName(const std::string& name); ///< throws UsageError

} // namespace pellucid
