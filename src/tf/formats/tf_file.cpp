#include "tf/formats/tf_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/text.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/tf_json.h"
#include "tf/formats/voreen_tfi.h"
#include "tf/presets.h"

namespace pellucid {

namespace {

constexpr const char* kVoreenSuffix = ".tfi";
constexpr std::array<const char*, 2> kSuffixes{".tf.json", kVoreenSuffix};

bool endsWith(const std::string& path, const char* suffix) { return lowerCase(path).ends_with(suffix); }

} // namespace

std::span<const char* const> tfSuffixes() { return kSuffixes; }

bool hasTfSuffix(const std::string& path) {
    return std::any_of(kSuffixes.begin(), kSuffixes.end(), [&](const char* suffix) { return endsWith(path, suffix); });
}

bool isForeignTf(const std::string& path) { return endsWith(path, kVoreenSuffix); }

TransferFunction readTfFile(const std::string& path) { return isForeignTf(path) ? readVoreenTf(path) : readTf(path); }

bool isWrittenForOthers(const std::string& path) { return endsWith(path, kParaViewSuffix); }

void writeTfFile(const TransferFunction& tf, const ValueRange& window, const std::string& path) {
    if (!isWrittenForOthers(path)) return writeTf(tf, path);
    std::string name = std::filesystem::path(path).filename().string();
    name.resize(name.size() - std::string(kParaViewSuffix).size());
    writeTextAtomically(
        path, paraViewPreset(tf, window, name).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

TransferFunction loadTf(const std::string& specOrPath) {
    if (auto tf = tfFromSpec(specOrPath)) return *tf;
    if (auto tf = tfFromPresetSpec(specOrPath)) return *tf;
    std::error_code failure;
    if (!std::filesystem::exists(specOrPath, failure))
        throw FileError("no such file", specOrPath, "check the name, or give auto, tents:N, ramp:N or preset:NAME");
    return readTfFile(specOrPath);
}

} // namespace pellucid
