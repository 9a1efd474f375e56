// Built-in volumes, made by our own code: what the window opens on, and ground truth for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/job.h"
#include "volume/memory_use.h"
#include "volume/volume.h"

namespace pellucid {

/// One built-in data set.
struct SampleInfo {
    std::string name;        ///< after "sample:"
    std::string description; ///< one line
    Int3 defaultDims;
};

const std::vector<SampleInfo>& samples();

/// Makes the built-in volume `name`. `size` is the number of voxels along the longest axis (the others follow in
/// proportion; at least 8), 0 = the default. The same name, size and seed give the same bits.
/// Throws UsageError for an unknown name (the message lists the known ones) or an impossible size; Error where memory
/// will not do for it, and for what `then` will be done with it.
Volume makeSample(const std::string& name, int size = 0, std::uint32_t seed = 1, const JobControl& job = {},
                  const MemoryUse& then = {});

} // namespace pellucid
