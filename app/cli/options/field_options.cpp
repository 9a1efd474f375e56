#include "options/field_options.h"

namespace pellucid::cli {

void FieldOptions::add(CLI::App& app) { given.add(app, "Field"); }

void FieldOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.field.edit([this](FieldView& f) { given.applyTo(f); });
}

} // namespace pellucid::cli
