// Transfer functions that come with the program: data/tf/presets, compiled in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

/// One file of data/tf/presets.
struct EmbeddedPreset {
    const char* name; ///< of the file, "ct-bone.tf.json"
    const char* text;
};
const std::vector<EmbeddedPreset>& embeddedPresets();

/// A transfer function with what people should know of it. What a file says as "title", "group" and "about".
struct TfPreset {
    std::string name;    ///< "ct-bone", in `preset:ct-bone`
    std::string title;   ///< "Bone"; of a file without one, its name
    std::string group;   ///< "CT", "MR", "Simulation"; of a file without one, ""
    std::string about;   ///< a sentence
    TransferFunction tf; ///< in data units (Hounsfield) where it has a range, else relative to the window
};

/// All that come with the program, by group.
const std::vector<TfPreset>& tfPresets();
/// The one that `preset:NAME` means; empty where `text` does not begin so. Throws UsageError, which lists the names.
std::optional<TransferFunction> tfFromPresetSpec(const std::string& text);

/// A file that people keep as a preset of their own. Throws what readTf() does.
TfPreset readPreset(const std::string& path);
/// `tf` as such a file, with its title. Throws FileError.
void writePreset(const TransferFunction& tf, const std::string& title, const std::string& path);

/// What is taken of another transfer function.
enum class Take {
    All,
    Colors,   ///< opacities and features stay, with the colours that the other one has there
    Opacities ///< points and features of the other one, in the present colours
};
/// `other`, written for the same window as `present`, or what is taken of it.
TransferFunction taken(const TransferFunction& present, const TransferFunction& other, Take what);

} // namespace pellucid
