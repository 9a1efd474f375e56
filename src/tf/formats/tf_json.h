// *.tf.json, Pellucid's own transfer-function file (CLI.md, "Files").
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tf/transfer_function.h"

namespace pellucid {

/// Throws Error naming the place (`/points/3/x`) and the reason: wrong JSON, unknown `format`, newer `version`, x
/// outside [0,1], unsorted points, NaN, a missing key. `where` is the file's name for the message. A file without
/// features gets deriveFeatures().
TransferFunction tfFromJson(const nlohmann::json& json, const std::string& where);
nlohmann::json jsonFromTf(const TransferFunction& tf);

TransferFunction readTf(const std::string& path);
/// Through a temporary file beside `path` that is renamed.
void writeTf(const TransferFunction& tf, const std::string& path);

/// What --tf takes: "tents:N[:PEAK]", "ramp:N" or a file.
TransferFunction loadTf(const std::string& specOrPath);

} // namespace pellucid
