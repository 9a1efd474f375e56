// What a volume says of how it was read.
#pragma once

#include <algorithm>
#include <string>

#include "volume/volume.h"

namespace pellucid::test {

inline bool hasNotice(const Volume& volume, const std::string& text) {
    return std::ranges::any_of(volume.notices,
                               [&](const std::string& notice) { return notice.find(text) != std::string::npos; });
}

} // namespace pellucid::test
