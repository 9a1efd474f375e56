// Transfer functions by name: which reader a file gets, and what else a user may name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tf/formats/tf_format.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// Suffixes by which a file is known to be a transfer function, ".tf.json" first: those that nothing else has.
const std::vector<std::string>& tfSuffixes();
/// Whether `path` ends in one of them, in any case.
bool hasTfSuffix(const std::string& path);
/// The same, or it ends in .json, .xml or .csv, is there, and its content is that of a transfer function.
bool isTfFile(const std::string& path);

/// Whether it is the file of another program, by suffix or else by content: saving again writes no such file.
bool isForeignTf(const std::string& path);

/// A file of any format (tf_format.h), told by its suffix or its content. "FILE#NAME" names one of several in it.
/// Throws Error.
ReadTf openTfFile(const std::string& path);
/// Names of the transfer functions in a file that holds several; none where it holds one. Throws Error.
std::vector<std::string> tfNamesIn(const std::string& path);
/// FILE of "FILE#NAME", or `path` itself.
std::string fileOfTf(const std::string& path);
/// The same as openTfFile() with opacities as the file has them, whatever length they hold for.
TransferFunction readTfFile(const std::string& path);

/// What a user may name: "tents:N[:PEAK]", "ramp:N", "preset:NAME" (see presets.h) or a file. Throws Error.
ReadTf readTfNamed(const std::string& specOrPath);
/// The same with opacities as the file has them.
TransferFunction loadTf(const std::string& specOrPath);

/// What was read, with opacities of the reference length of a volume that lies like this.
TransferFunction forVolume(const ReadTf& read, const Geometry& geometry);
/// The same for the present data; what spans them (ReadTf::spansData) gets their range.
TransferFunction forVolume(const ReadTf& read, const Volume& data);
/// The notices of what was read, which `values` a file without a range is put on, and what is done with its opacities
/// for such a volume.
std::vector<std::string> openingNotices(const ReadTf& read, const Geometry& geometry,
                                        const std::optional<ValueRange>& values = {});

/// By suffix: for another program (tf_format.h); anything else as *.tf.json. Through a temporary file beside `path`
/// that is renamed. Returns what the format cannot say, each a sentence without a full stop.
std::vector<std::string> writeTfFile(const TfToWrite& tf, const std::string& path);
/// Whether writeTfFile() writes what is made for another program.
bool isWrittenForOthers(const std::string& path);

/// The name of a preset in a file of this name: without folders and suffixes.
std::string presetNameOf(const std::string& path);

} // namespace pellucid
