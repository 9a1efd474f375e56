// `samples`: the built-in data sets.
#include "commands.h"
#include "volume/procedural.h"

namespace pellucid::cli {

Command addSamples(CLI::App& program) {
    CLI::App* app = program.add_subcommand("samples", "The built-in volumes");
    return {app, [](Progress&) {
                std::vector<std::pair<std::string, std::string>> lines;
                Json list = Json::array();
                for (const SampleInfo& s : samples()) {
                    lines.emplace_back("sample:" + s.name, dimsText(s.defaultDims) + "  " + s.description);
                    list.push_back({{"name", s.name},
                                    {"description", s.description},
                                    {"dims", jsonFromDims(s.defaultDims)},
                                    {"frames", s.frames}});
                }
                return Answer{listing(lines), {{"command", "samples"}, {"samples", list}}};
            }};
}

} // namespace pellucid::cli
