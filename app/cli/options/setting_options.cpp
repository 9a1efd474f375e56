#include "options/setting_options.h"

#include <cctype>

#include "base/round_numbers.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

std::string placeholderOf(const Setting& setting, const void* usual) {
    const SettingValue value = setting.at(const_cast<void*>(usual));
    std::string text = "X";
    if (const auto* choice = std::get_if<Choice>(&value)) {
        text = joined(choice->names, "|");
    } else if (std::holds_alternative<int*>(value)) {
        text = "N";
    } else if (std::holds_alternative<std::string*>(value)) {
        text = "NAME";
    } else if (std::holds_alternative<Rgb*>(value) || std::holds_alternative<std::optional<Rgb>*>(value)) {
        text = "R,G,B";
    }
    if (isNumber(value) && setting.range.holds(NumberRange::kInfinity)) text += "|inf";
    return setting.none == nullptr ? text : text + "|" + setting.none;
}

} // namespace

std::string helpOf(const Setting& setting, const void* usual) {
    std::string help = setting.help;
    help.pop_back(); // the full stop
    help[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(help[0])));
    const SettingValue value = setting.at(const_cast<void*>(usual));
    if (std::holds_alternative<bool*>(value))
        return setting.optionName().starts_with("--no-") ? "do not " + help : help;
    std::string notes;
    if (isNumber(value)) notes = setting.range.text() + setting.unitText();
    const auto* number = std::get_if<double*>(&value);
    if (const std::string text = number != nullptr ? plainText(**number) : textOf(setting, usual); !text.empty())
        notes += (notes.empty() ? "" : "; ") + ("default " + text);
    return notes.empty() ? help : help + " (" + notes + ")";
}

CLI::Option* addSetting(CLI::App& app, const Setting& setting, void* values, std::vector<const Setting*>& given,
                        const std::string& group) {
    const std::string name = setting.optionName();
    if (std::holds_alternative<bool*>(setting.at(values))) {
        const char* const text = name.starts_with("--no-") ? "false" : "true";
        return app
            .add_flag_callback(
                name,
                [&setting, values, &given, text] {
                    setText(setting, values, text);
                    given.push_back(&setting);
                },
                helpOf(setting, values))
            ->group(group);
    }
    return addValue(
        app, name, placeholderOf(setting, values),
        [&setting, values, &given](const std::string& text, const std::string& option) {
            atOption(option, [&] { setText(setting, values, text); });
            given.push_back(&setting);
        },
        helpOf(setting, values), group);
}

} // namespace pellucid::cli
