// `convert TF --to NAME`: a transfer function as a file of another program.
#pragma once

#include <optional>
#include <string>

#include "output.h"
#include "progress.h"
#include "resolve.h"

namespace pellucid::cli {

/// What `convert` was asked for besides its options for volumes.
struct TfConversion {
    std::string format;                ///< --to: a name of tf_format.h, or one of tf_snippets.h with "-python"
    std::optional<std::string> volume; ///< --volume: what it is converted for
};

/// What --to may be, for its help.
std::string tfFormatNames();

/// The transfer function that options.volume.path names, written to `out`; the other options of the volume are those of
/// TfConversion::volume. Throws as resolve() does.
Answer convertTf(const TfConversion& conversion, const SceneOptions& options, const std::string& out,
                 Progress& progress);

} // namespace pellucid::cli
