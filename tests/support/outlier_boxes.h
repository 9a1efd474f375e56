// A volume whose range one voxel spoils.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>

#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume/noise.h"

namespace pellucid::test {

/// Two nested boxes of values 90 and 200 in 0, with one voxel of 1e6, as f32 of 24³ in a file of the folder.
inline VolumeSource boxesWithOutlier(const TempFolder& folder) {
    std::string bytes;
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 24; ++i) {
                const int out = std::max({std::abs(2 * i - 23), std::abs(2 * j - 23), std::abs(2 * k - 23)});
                const auto noise = static_cast<float>(2 * whiteNoise(i, j, k, 1)); // else they would be labels
                const float v = i + j + k == 0 ? 1e6F : out < 8 ? 200 + noise : out < 18 ? 90 + noise : 0.0F;
                bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
            }
    VolumeSource source;
    source.path = folder.write("boxes.raw", bytes);
    source.raw = RawLayout{{24, 24, 24}, SampleType::F32, false, 0};
    return source;
}

} // namespace pellucid::test
