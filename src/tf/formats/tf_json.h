// *.tf.json, Pellucid's own transfer-function file.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/json_value.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// Whether features carry their identities ("identity"): inside a session they do, in a file of their own they do not.
enum class Identities { Keep, Drop };

/// Throws Error naming the place (`/points/3/x`) and the reason: wrong JSON, unknown `format`, newer `version`, x
/// outside [0,1], unsorted points, NaN, a missing key. A file without features gets deriveFeatures().
TransferFunction tfFromJson(const JsonValue& json, Identities identities = Identities::Drop);
/// A whole document; `where` is the file's name for messages.
inline TransferFunction tfFromJson(const nlohmann::json& json, const std::string& where) {
    return tfFromJson(JsonValue(json, where));
}
/// Read back it is equal to `tf`.
nlohmann::json jsonFromTf(const TransferFunction& tf, Identities identities = Identities::Drop);

TransferFunction readTf(const std::string& path);
/// Through a temporary file beside `path` that is renamed.
void writeTf(const TransferFunction& tf, const std::string& path);

} // namespace pellucid
