// What the layout of a headerless file may be: told by its name, its size, and by how well neighbouring voxels agree.
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "volume/loader.h"

namespace pellucid {

struct RawGuess {
    RawLayout layout;
    double agreement = 0; ///< of neighbours along the three axes: 1 where they are equal, 0 as for voxels drawn by lot
};

/// The layout that a name speaks of, "head_256x256x109_uint16": dims and type, as far as they are in it. `bytes` of the
/// file settle the type where only its dims are named; without dims, a cube.
RawLayout rawLayoutInName(const std::string& path, std::uint64_t bytes);

/// What a headerless file may be.
struct RawLook {
    std::uint64_t bytes = 0;       ///< that are laid out: of a file packed by gzip, what it unpacks to
    std::vector<RawGuess> guesses; ///< that fit these to the byte, the most likely ones first
};
/// `most` guesses at most, those with the dims in the file's name first. Looks at some ten thousand voxels; a file
/// packed by gzip is unpacked for that. Throws FileError, Cancelled.
RawLook lookAtRaw(const std::string& path, std::size_t most = 6, const JobControl& job = {});

/// "256,256,109,u16,big": what parseRawLayout() takes.
std::string rawLayoutText(const RawLayout& layout);

} // namespace pellucid
