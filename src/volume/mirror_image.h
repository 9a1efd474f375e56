// Whether data are shown as in a mirror: left for right.
#pragma once

#include <glm/matrix.hpp>

#include "volume/volume.h"

namespace pellucid {

/// Whether the user has made a mirror image of what the file has.
inline bool isMirrorImage(const Volume& volume) {
    const auto isLeftHanded = [](const Geometry& geometry) { return glm::determinant(geometry.directions) < 0; };
    return volume.inFile && isLeftHanded(volume.geometry()) != isLeftHanded(*volume.inFile);
}

} // namespace pellucid
