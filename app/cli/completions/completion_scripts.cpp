#include "completions/completion_scripts.h"

#include <functional>
#include <map>

#include "base/error.h"
#include "base/text.h"

namespace pellucid::cli {

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// In single quotes, as bash and zsh read it.
std::string inQuotes(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }
/// The same as fish reads it.
std::string inFishQuotes(const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// Calls with each command that does something, "study run" and not "study".
void forEachWorking(const CompletionCommand& command, const std::function<void(const CompletionCommand&)>& call) {
    if (command.commands.empty()) return call(command);
    for (const CompletionCommand& own : command.commands) forEachWorking(own, call);
}

/// Calls with each command that has commands of its own, the program first.
void forEachParent(const CompletionCommand& command, const std::function<void(const CompletionCommand&)>& call) {
    if (command.commands.empty()) return;
    call(command);
    for (const CompletionCommand& own : command.commands) forEachParent(own, call);
}

std::string lastWord(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

std::string optionNames(const CompletionCommand& command) {
    return joined(command.options, " ", [](const CompletionOption& o) { return joined(o.names, " "); });
}

// bash: functions that set words, files and folders, for the frame to offer.

std::string bashValues(const CompletionValues& values) {
    std::string code;
    if (!values.words.empty()) code += " words=" + inQuotes(joined(values.words, " "));
    if (values.files) code += " files=1";
    if (values.folders) code += " folders=1";
    return code.empty() ? " :" : code;
}

std::string bashTables(const CompletionCommand& program) {
    std::map<std::string, std::string> places; // by what stands there, so that each list is there once
    std::string options = "_pellucid_cli_options() {\n    case $1 in\n", arguments;
    forEachParent(program, [&](const CompletionCommand& c) {
        options += "        " + inQuotes(c.name) + ") words=" +
                   inQuotes(joined(c.commands, " ", [](const auto& own) { return lastWord(own.name); }) + " " +
                            optionNames(c)) +
                   " parent=1 ;;\n";
    });
    forEachWorking(program, [&](const CompletionCommand& c) {
        options += "        " + inQuotes(c.name) + ") words=" + inQuotes(optionNames(c)) + " ;;\n";
        for (const CompletionOption& o : c.options)
            for (const std::string& name : o.names)
                if (o.takesValue) {
                    std::string& known = places[bashValues(o.values)];
                    known += (known.empty() ? "" : " | ") + inQuotes(c.name + " " + name);
                }
        CompletionValues all;
        for (const CompletionValues& a : c.arguments) {
            if (all.words.empty()) all.words = a.words;
            all.files = all.files || a.files;
            all.folders = all.folders || a.folders;
        }
        arguments += "        " + inQuotes(c.name) + ")" + bashValues(all) + " ;;\n";
    });
    options += "    esac\n}\n\n# Of an option of a command; fails where it takes no value.\n"
               "_pellucid_cli_values() {\n    case $1 in\n";
    for (const auto& [code, place] : places) options += "        " + place + ")" + code + " ;;\n";
    return options + "        *) return 1 ;;\n    esac\n}\n\n# What stands without an option.\n" +
           "_pellucid_cli_arguments() {\n    case $1 in\n" + arguments + "    esac\n}\n";
}

// fish: a line per command and per option.

std::string fishLine(const std::string& place, const std::string& rest, const std::string& about) {
    return "complete -c pellucid-cli -n " + inFishQuotes("__pellucid_cli_at " + place) + rest +
           (about.empty() ? "" : " -d " + inFishQuotes(about)) + "\n";
}

std::string fishValues(const CompletionValues& values) {
    std::string code;
    if (values.files) code += " -F";
    if (values.folders && !values.files) code += " -a '(__fish_complete_directories)'";
    if (!values.words.empty()) code += " -a " + inFishQuotes(joined(values.words, " "));
    return code;
}

std::string fishOption(const CompletionOption& option) {
    std::string code;
    for (const std::string& name : option.names)
        code += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.takesValue) return code;
    return code + (option.values.files ? " -r" : " -x") + fishValues(option.values);
}

std::string fishTables(const CompletionCommand& program) {
    std::string lines;
    forEachParent(program, [&](const CompletionCommand& c) {
        for (const CompletionCommand& own : c.commands)
            lines += fishLine(c.name, " -a " + lastWord(own.name), own.about);
        for (const CompletionOption& o : c.options) lines += fishLine(c.name, fishOption(o), o.about);
    });
    forEachWorking(program, [&](const CompletionCommand& c) {
        for (const CompletionOption& o : c.options) lines += fishLine(c.name, fishOption(o), o.about);
        for (const CompletionValues& a : c.arguments) lines += fishLine(c.name, fishValues(a), "");
    });
    return lines;
}

// zsh: a case per command, which hands its specifications to _arguments.

/// Within a specification, where brackets and colons have a meaning.
std::string zshEscaped(std::string text) {
    text = replaced(text, "\\", "\\\\");
    for (const char* c : {"[", "]", ":"}) text = replaced(text, c, std::string("\\") + c);
    return text;
}

std::string zshAction(const CompletionValues& values) {
    const char* const where = values.files ? "files" : values.folders ? "folders" : "none";
    std::string code = ": _pellucid_cli_offer " + std::string(where);
    for (const std::string& word : values.words) code += " " + zshEscaped(word);
    return code;
}

std::string zshOption(const CompletionOption& option, const std::string& name) {
    // '*': may be given again.
    std::string spec = "*" + name + "[" + zshEscaped(option.about) + "]";
    if (option.takesValue) spec += ":" + zshEscaped(option.values.name) + zshAction(option.values);
    return inQuotes(spec);
}

std::string zshTables(const CompletionCommand& program) {
    std::string code = "_pellucid_cli_commands() {\n    local -a commands\n    case $1 in\n";
    forEachParent(program, [&](const CompletionCommand& c) {
        code += "        " + inQuotes(c.name) + ") commands=(\n";
        for (const CompletionCommand& own : c.commands)
            code += "            " + inQuotes(lastWord(own.name) + ":" + replaced(own.about, ":", "\\:")) + "\n";
        code += "        )\n        _arguments \\\n";
        for (const CompletionOption& o : c.options)
            for (const std::string& name : o.names) code += "            " + zshOption(o, name) + " \\\n";
        code += "            '1: :{_describe command commands}' ;;\n";
    });
    code += "    esac\n}\n\n_pellucid_cli_options() {\n    case $1 in\n";
    forEachWorking(program, [&](const CompletionCommand& c) {
        code += "        " + inQuotes(c.name) + ") _arguments";
        for (const CompletionOption& o : c.options)
            for (const std::string& name : o.names) code += " \\\n            " + zshOption(o, name);
        for (const CompletionValues& a : c.arguments)
            code += " \\\n            " +
                    inQuotes((&a == &c.arguments.back() ? "*:" : ":") + zshEscaped(a.name) + zshAction(a));
        code += " ;;\n";
    });
    return code + "    esac\n}\n";
}

const std::map<std::string, std::string (*)(const CompletionCommand&)>& tables() {
    static const std::map<std::string, std::string (*)(const CompletionCommand&)> kTables{
        {"bash", bashTables}, {"fish", fishTables}, {"zsh", zshTables}};
    return kTables;
}

} // namespace

std::vector<std::string> completionShells() {
    std::vector<std::string> shells;
    for (const auto& [shell, made] : tables()) shells.push_back(shell);
    return shells;
}

std::string completionScript(const std::string& shell, const CompletionCommand& program) {
    const auto made = tables().find(shell);
    for (const CompletionFrame& frame : completionFrames())
        if (made != tables().end() && frame.name == "frame." + shell)
            return replaced(frame.text, "@TABLES@\n", made->second(program));
    throw UsageError("there are no completions for '" + shell + "'", "SHELL",
                     "give one of " + joined(completionShells(), " "));
}

} // namespace pellucid::cli
