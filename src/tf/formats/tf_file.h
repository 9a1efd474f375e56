// Transfer functions by name: which reader a file gets, and what else a user may name.
#pragma once

#include <span>
#include <string>

#include "tf/transfer_function.h"

namespace pellucid {

/// Suffixes by which a file is known to be a transfer function, ".tf.json" first.
std::span<const char* const> tfSuffixes();
/// Whether `path` ends in one of them, in any case.
bool hasTfSuffix(const std::string& path);

/// Whether it is the file of another program, which can be read and not written.
bool isForeignTf(const std::string& path);

/// By suffix: *.tfi as Voreen writes it (voreen_tfi.h), anything else as *.tf.json (tf_json.h). Throws Error.
TransferFunction readTfFile(const std::string& path);

/// By suffix: *.paraview.json as a preset for ParaView (paraview_preset.h), in the data units of `window`, which the
/// intensities of `tf` refer to; anything else as *.tf.json. Through a temporary file beside `path` that is renamed.
void writeTfFile(const TransferFunction& tf, const ValueRange& window, const std::string& path);
/// Whether writeTfFile() writes what only another program reads.
bool isWrittenForOthers(const std::string& path);

/// What a user may name: "tents:N[:PEAK]", "ramp:N", "preset:NAME" (see presets.h) or a file. Throws Error.
TransferFunction loadTf(const std::string& specOrPath);

} // namespace pellucid
