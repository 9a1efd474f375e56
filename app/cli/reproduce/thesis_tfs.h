// Transfer functions of figures of the thesis: data/tf, compiled in.
#pragma once

#include <vector>

namespace pellucid::cli {

/// One file of data/tf.
struct ThesisTf {
    const char* name; ///< of the file, "disks.tf.json"
    const char* text;
};
const std::vector<ThesisTf>& thesisTfs();

} // namespace pellucid::cli
