// The rows of `pellucid-cli bench` on built-in volumes, for one engine.
#pragma once

#include <string>
#include <vector>

#include "json.h"
#include "render/engine_choice.h"

namespace pellucid::gpu_check {

struct RowsOptions {
    EngineChoice engine = EngineChoice::Gl; ///< Gl or Cpu
    std::string volumes;                    ///< one of rowVolumes()
    int size = 0;                           ///< voxels along the longest side; 0: those of docs/performance.md
    bool once = false;                      ///< each row runs once after a warm-up; one picture
    std::vector<double> memcpyGbPerS;       ///< with each of benchThreads()
};

/// What is measured in one go: "knee/tents:3", "knee/dense", "knee/sparse", "cubes/dense".
const std::vector<std::string>& rowVolumes();

/// 1, and all that the machine has.
std::vector<int> benchThreads();

/// {"rows": as `bench --json`, "notices": of rows that are left out}.
Json measureRows(const RowsOptions& options);

} // namespace pellucid::gpu_check
