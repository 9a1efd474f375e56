#pragma once

#include <nlohmann/json.hpp>

namespace pellucid::gpu_check {

using Json = nlohmann::ordered_json; // keys in the order in which docs/gpu-check.md lists them

} // namespace pellucid::gpu_check
