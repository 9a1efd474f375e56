// --field, --field-colormap, --field-strength, --field-threshold, --field-top: a field in the place of the data.
#pragma once

#include "options/setting_options.h"
#include "session/scene.h"

namespace pellucid::cli {

struct FieldOptions {
    SettingOptions<FieldView> given;

    void add(CLI::App& app);
    void applyTo(SceneInputs& inputs) const;
    bool isGiven() const { return given.values().kind.has_value(); }
};

} // namespace pellucid::cli
