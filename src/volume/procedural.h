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
    int frames = 1;        ///< time steps, each made on its own
    ValueRange range = {}; ///< of the values of all frames, where there are several
};

/// What a maker of samples is asked for beside the grid.
struct SampleOrder {
    std::uint32_t seed = 1;
    int step = 0; ///< of SampleInfo::frames
};

const std::vector<SampleInfo>& samples();
/// Throws UsageError for an unknown name (the message lists the known ones).
const SampleInfo& sampleInfo(const std::string& name);

/// Makes the built-in volume `name`. `size` is the number of voxels along the longest axis (the others follow in
/// proportion; at least 8), 0 = the default; `step` one of its frames. The same name, size, seed and step give the same
/// bits, whatever was made before. Throws UsageError for an unknown name (the message lists the known ones), an
/// impossible size or a step that is not there; Error where memory will not do for it, and for what `then` will be done
/// with it.
Volume makeSample(const std::string& name, int size = 0, std::uint32_t seed = 1, const JobControl& job = {},
                  const MemoryUse& then = {}, int step = 0);

} // namespace pellucid
