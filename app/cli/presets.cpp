// `presets`: the transfer functions that come with the program.
#include "tf/presets.h"

#include "commands.h"

namespace pellucid::cli {

Command addPresets(CLI::App& program) {
    CLI::App* app = program.add_subcommand("presets", "The transfer functions that come with the program");
    return {app, [](Progress&) {
                std::vector<std::pair<std::string, std::string>> lines;
                Json list = Json::array();
                for (const TfPreset& p : tfPresets()) {
                    lines.emplace_back("preset:" + p.name, p.group + "  " + p.about);
                    Json one{{"name", p.name}, {"title", p.title}, {"group", p.group}, {"about", p.about}};
                    if (p.tf.range) one["range"] = {p.tf.range->lo, p.tf.range->hi};
                    list.push_back(std::move(one));
                }
                return Answer{listing(lines), {{"command", "presets"}, {"presets", list}}};
            }};
}

} // namespace pellucid::cli
