// --report, --report-size and --curves of `optimize`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "parse.h"
#include "resolve.h"
#include "session/workspace.h"

namespace pellucid::cli {

struct ReportOptions {
    std::optional<std::string> folder, curves;
    std::optional<ImageSize> size; ///< of the two large pictures

    void add(CLI::App& app);
    /// What can be told before the work, and announces the files of the folder: throws UsageError and FileError.
    void check() const;
    /// Draws, measures and writes what was asked for, and tells of it in `answer`. `scene` is that of the start,
    /// `seconds` those of the search, `remarks` sentences about the result.
    void write(const Scene& scene, RunStart start, const OptimizeResult& result, double seconds,
               std::vector<std::string> remarks, Workspace& workspace, Progress& progress, Answer& answer) const;
};

} // namespace pellucid::cli
