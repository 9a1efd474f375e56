// `completions`: what a shell needs to complete command lines of this program.
#include "base/atomic_file.h"
#include "commands.h"
#include "completions/completion_scripts.h"
#include "output_files.h"

namespace pellucid::cli {

namespace {

struct CompletionsArguments {
    std::string shell;
    std::optional<std::string> out;
};

Answer run(const CompletionsArguments& o, const CLI::App& program) {
    const std::string script = completionScript(o.shell, completionWords(program));
    Json json{{"command", "completions"}, {"shell", o.shell}};
    if (!o.out) {
        json["script"] = script;
        return {script, std::move(json)};
    }
    writeTextAtomically(*o.out, script);
    json["file"] = *o.out;
    return {"wrote " + *o.out + "\n", std::move(json)};
}

} // namespace

Command addCompletions(CLI::App& program) {
    CLI::App* app = program.add_subcommand("completions", "Writes what a shell needs to complete command lines");
    const auto o = std::make_shared<CompletionsArguments>();
    app->add_option("SHELL", o->shell, "bash, zsh or fish")->required()->type_name("");
    addOutputFile(*app, "--out", o->out, "write the script to this file (default: to standard output)");
    return {app, [o, &program](Progress&) { return run(*o, program); }};
}

} // namespace pellucid::cli
