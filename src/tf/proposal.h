// The automatic start: what a volume holds, told from its voxels, and a transfer function that shows it
// (docs/method.md, "The automatic start").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "tf/data_kind.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

struct ProposedFeature {
    std::string name;
    double lo = 0, hi = 0; ///< data values
    double mode = 0;       ///< its most typical value
    double share = 0;      ///< of the valid voxels, [0,1]
    double inside = 0;     ///< how deep it lies among the features: 0 the outermost, 1 the innermost
};

struct Proposal {
    DataKind kind = DataKind::Empty;
    std::string unit;                     ///< "HU" for CT, else empty
    ValueRange window;                    ///< data units, lo < hi
    double outside = 0;                   ///< share of the valid voxels beyond the window
    std::optional<ValueRange> background; ///< values left out, of opacity 0; empty: none found
    /// Ascending; neighbours meet, except about the background. 1 to 5, of labels up to 12.
    std::vector<ProposedFeature> features;
    TransferFunction tf;          ///< written for `window` (its range); one Feature for each of `features`
    std::vector<std::string> why; ///< sentences: what was recognised, and by what
};

/// Looks at `data` in the range of its values (a range that somebody has chosen becomes the window). The same answer
/// for any number of threads. Constant, invalid and odd data have an answer too; throws Cancelled only.
Proposal propose(const Volume& data, const JobControl& job = {});

} // namespace pellucid
