#include "options/field_options.h"

#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kGroup = "Field";

/// What `parse` makes of the text; what it says against it is said of this option.
template <class Parse>
auto ofOption(const std::string& option, const Parse& parse) {
    try {
        return parse();
    } catch (const UsageError& e) {
        throw UsageError(e.problem(), option, e.whatToDo());
    }
}

} // namespace

FieldKind parseField(const std::string& text, const std::string& option) {
    return ofOption(option, [&] { return fieldKindFromName(text); });
}

void FieldOptions::add(CLI::App& app) {
    addValue(
        app, "--field", std::string(kFieldNames) + "|none",
        [this](const std::string& text, const std::string& option) {
            kind.emplace();
            if (text != "none") *kind = parseField(text, option);
        },
        "draw what each voxel contributes in the place of the data, in the same view; with --feature its voxels alone "
        "(default: the session's, else none)",
        kGroup);
    addValue(
        app, "--field-colormap", "NAME",
        [this](const std::string& text, const std::string& option) {
            ofOption(option, [&] {
                checkFieldColorMap(text);
                return 0;
            });
            colorMap = text;
        },
        "colours of the field: a colour map, or feature for black over the feature's colour to white (default: the "
        "session's, else ember)",
        kGroup);
    addValue(
        app, "--field-strength", "S",
        [this](const std::string& text, const std::string& option) { strength = parseRealAbove(text, option, 0, 1); },
        "opacity of one reference length at the top of the field (default: the session's, else 0.3)", kGroup);
    addValue(
        app, "--field-threshold", "T",
        [this](const std::string& text, const std::string& option) {
            threshold = parseReal(text, option, 0, 1);
            if (*threshold == 1) throw UsageError("nothing lies above all", option, "give a number below 1");
        },
        "values up to this fraction of the top are not drawn (default: the session's, else 0)", kGroup);
    addValue(
        app, "--field-top", "V",
        [this](const std::string& text, const std::string& option) { top = parseRealAbove(text, option, 0, 1e300); },
        "value that the colours reach to (default: the session's, else below it lie 99.9 % of those above 0)", kGroup);
}

void FieldOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.field.edit([this](FieldView& f) {
        f.kind = kind.value_or(f.kind);
        f.colorMap = colorMap.value_or(f.colorMap);
        f.strength = strength.value_or(f.strength);
        f.threshold = threshold.value_or(f.threshold);
        if (top) f.top = top;
    });
}

} // namespace pellucid::cli
