// --field, --field-colormap, --field-strength, --field-threshold, --field-top: a field in the place of the data.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "session/scene.h"

namespace pellucid::cli {

inline constexpr const char* kFieldNames = "visibility|saliency|saliency-brightness|saliency-saturation|vws";
FieldKind parseField(const std::string& text, const std::string& option);

struct FieldOptions {
    std::optional<std::optional<FieldKind>> kind; ///< an empty one inside: the data, whatever the session says
    std::optional<std::string> colorMap;
    std::optional<double> strength, threshold, top;

    void add(CLI::App& app);
    void applyTo(SceneInputs& inputs) const;
    bool isGiven() const { return kind && *kind; }
};

} // namespace pellucid::cli
