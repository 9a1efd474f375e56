// --engine, --quality: what computes, and how carefully.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "session/scene.h"

namespace pellucid::cli {

struct EngineOptions {
    std::optional<EngineChoice> choice;
    std::optional<Quality> quality;

    void add(CLI::App& app, const std::string& qualityHelp);
    void applyTo(SceneInputs& inputs) const;
};

} // namespace pellucid::cli
