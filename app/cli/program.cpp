#include "program.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command_line.h"
#include "interrupt.h"
#include "output_files.h"
#include "parse.h"
#include "ranks/communicator.h"
#include "stop_note.h"
#include "volume/file_contents.h"
#include "volume/raw_guess.h"

namespace pellucid::cli {

namespace {

/// The options that every command has.
struct CommonOptions {
    bool json = false;
    bool progress = false;
    int threads = 0; ///< 0: all that the machine has
    std::optional<double> memoryGiB;
};

void addCommonOptions(CLI::App& app, CommonOptions& common) {
    const char* const group = "General";
    app.add_flag("--json", common.json, "print one JSON object")->group(group);
    app.add_flag("--progress", common.progress, "show progress on stderr even if that is not a terminal")->group(group);
    addValue(app, "--threads", "N", common.threads, wholeFrom(1, 1024), "threads to use (default: all cores)", group);
    addValue(
        app, "--memory", "GIB", common.memoryGiB, realAbove(0, 1e6),
        "memory that the program may use, in GiB; what needs more is refused before it starts (default: what is free)",
        group);
    app.get_help_ptr()->group(group);
}

/// Column of the descriptions in --help, and where its lines end.
constexpr std::size_t kHelpIndent = 34, kHelpWidth = 100;

/// Help as CLI11 lays it out, with long descriptions broken between words and without double blank lines.
std::string wrapped(const std::string& help) {
    std::string result, line;
    std::istringstream lines(help);
    while (std::getline(lines, line)) {
        if (line.empty() && result.ends_with("\n\n")) continue;
        for (std::size_t end; line.size() > kHelpWidth && (end = line.rfind(' ', kHelpWidth)) > kHelpIndent;) {
            result += line.substr(0, end) + "\n";
            line = std::string(kHelpIndent, ' ') + line.substr(end + 1);
        }
        result += line + "\n";
    }
    return result;
}

/// `--clip x:0:.5 y:0:.5` → `--clip x:0:.5 --clip y:0:.5`. A list ends where something else begins, so VOLUME may
/// follow it.
std::vector<std::string> withListsExpanded(const std::vector<std::string>& arguments) {
    std::vector<std::string> expanded;
    std::string list; // the option whose list is going on
    for (const std::string& argument : arguments) {
        const bool belongs =
            (list == "--clip" && looksLikeClip(argument)) || (list == "--fix" && looksLikeNumber(argument));
        if (belongs && expanded.back() != list) expanded.push_back(list);
        expanded.push_back(argument);
        if (!belongs) list = argument == "--clip" || argument == "--fix" ? argument : std::string();
    }
    return expanded;
}

/// The program, then the commands that were recognized, the last of them the one that is meant.
std::vector<const CLI::App*> parsedApps(const CLI::App& program) {
    std::vector<const CLI::App*> apps{&program};
    for (auto parsed = program.get_subcommands(); !parsed.empty(); parsed = apps.back()->get_subcommands())
        apps.push_back(parsed.front());
    return apps;
}

/// "pellucid-cli measure", "pellucid-cli study run", or the program alone where no command was recognized.
std::string place(const CLI::App& program) { return joined(parsedApps(program), " ", &CLI::App::get_name); }

std::string problem(const CLI::App& program, const CLI::ParseError& error) {
    const CLI::App& app = *parsedApps(program).back();
    const bool hasCommands = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
    const auto unknown = program.remaining(true);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !unknown.empty()) {
        const std::string& first = unknown.front();
        if (first.starts_with("-")) return "unknown option '" + first + "'";
        return (hasCommands ? "unknown command '" : "unexpected argument '") + first + "'";
    }
    if (hasCommands && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        if (unknown.empty()) return "no command is given";
        return (unknown.front().starts_with("-") ? "unknown option '" : "unknown command '") + unknown.front() + "'";
    }
    std::string text = error.what();
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && text.starts_with("--"))
        return text.substr(0, text.find(':')) +
               (text.find("At Most") != std::string::npos ? " is given more than once" : " has no value");
    const auto isLower = [](char c) { return std::islower(static_cast<unsigned char>(c)) != 0; };
    if (text.size() > 1 && isLower(text[1])) // not NAME
        text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
    return text;
}

/// ", perhaps --raw 256,256,109,u16" by the voxels of a headerless file; empty where these tell nothing.
std::string likelyLayout(const std::string& path) {
    constexpr double kLikely = 0.5;
    try {
        if (!mayBeHeaderless(path)) return {};
        const std::vector<RawGuess> guesses = lookAtRaw(path, 1).guesses;
        if (guesses.empty() || guesses.front().agreement < kLikely) return {};
        return ", perhaps --raw " + rawLayoutText(guesses.front().layout);
    } catch (const Error&) {
        return {};
    }
}

/// "WHAT, WHERE, WHAT TO DO": where a setting would help, by the name of its option.
std::string lineOf(const Error& e) {
    const auto advice = [&]() -> std::string {
        const std::string said = e.whatToDo().empty() ? "" : e.whatToDo() + ", or ";
        switch (e.remedy()) {
        case Remedy::AllowMoreMemory:
            return "allow more with --memory, or use a smaller volume";
        case Remedy::GiveRawLayout:
            return said + "give --raw NX,NY,NZ,TYPE for headerless data" + likelyLayout(e.where());
        case Remedy::CorrectRawLayout:
            return "correct --raw or --skip" + likelyLayout(e.where());
        case Remedy::GiveSpacing:
            return said + "give --spacing SX,SY,SZ[,UNIT]";
        case Remedy::NoComponent:
            return "leave out --component";
        case Remedy::AllowOutside:
            return said + "give --allow-outside if you trust this file";
        case Remedy::OtherEngine:
            return said + "use --engine cpu";
        case Remedy::AsSaid:
            break;
        }
        return e.whatToDo();
    };
    return Error(e.problem(), e.where(), advice()).what();
}

Outcome fail(int status, std::string message) { return {status, {}, std::move(message), {}}; }

Outcome failureOf(const std::exception_ptr& thrown, const std::string& where) {
    try {
        std::rethrow_exception(thrown);
    } catch (const RankLost&) {
        return fail(1, {}); // that rank says why
    } catch (const UsageError& e) {
        return fail(2, lineOf(e));
    } catch (const Error& e) {
        return fail(1, lineOf(e));
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory, " + where + ", use a smaller volume, --size or machine with more");
    } catch (const std::length_error&) {
        return fail(1, "out of memory, " + where + ", use a smaller volume, --size or machine with more");
    } catch (const std::filesystem::filesystem_error& e) {
        return fail(1, e.code().message() + ", " + e.path1().string() + ", check permissions and space");
    } catch (const std::exception& e) {
        const auto* system = dynamic_cast<const std::system_error*>(&e);
        // TBB has no exception of its own for this.
        if ((system != nullptr && system->code() == std::errc::resource_unavailable_try_again) ||
            std::string_view(e.what()).find("pthread_create") != std::string_view::npos)
            return fail(1, "the system starts no more threads for this program, " + where +
                               ", raise the limits on processes and memory (ulimit -u, -v), or give --threads 1");
        return fail(1, std::string("unexpected failure (") + e.what() + "), " + where +
                           ", please report it with the command line");
    } catch (...) {
        return fail(1, "unexpected failure, " + where + ", please report it with the command line");
    }
}

/// The status of a stopped command. Where both a signal and an error came, the signal is what the user did.
int stoppedStatus() { return interruptStatus() != 0 ? interruptStatus() : 130; }

Outcome runCommand(const Program& info, const CLI::App& program, const Command& command, const CommonOptions& common) {
    Progress progress(info.shows ? Progress::styleFor(common.progress) : Progress::Style::None);
    const std::string where = place(program);
    try {
        if (common.threads > 0) setThreadCount(common.threads);
        if (common.memoryGiB) setMemoryLimit(static_cast<std::uint64_t>(*common.memoryGiB * (1u << 30)));
        Answer answer = command.run(progress);
        progress.finish();
        if (interruptStatus() != 0) return {stoppedStatus(), {}, {}, {}};
        Outcome outcome{0, common.json ? jsonText(answer.json) : printableLines(answer.text), {}, {}};
        if (answer.failure) {
            outcome.status = 1;
            outcome.error = lineOf(*answer.failure);
        } else {
            outcome.notices = std::move(answer.notices);
        }
        return outcome;
    } catch (const Cancelled&) {
        progress.finish();
        Outcome outcome{stoppedStatus(), {}, {}, {}};
        if (!stopNote().empty()) outcome.notices.push_back(stopNote());
        return outcome;
    } catch (...) {
        progress.finish();
        if (interruptStatus() != 0) return {stoppedStatus(), {}, {}, {}};
        return failureOf(std::current_exception(), where);
    }
}

Outcome parseAndRun(const Program& info, const std::vector<std::string>& arguments) {
    keepCommandLine(info.name, arguments);
    watchCallFiles();
    CLI::App program(info.purpose, info.name);
    program.set_version_flag("--version", info.name + " " + PELLUCID_VERSION, "print the version");
    program.require_subcommand(1);
    program.get_formatter()->column_width(kHelpIndent);
    program.footer("Exit status: 0 done, 1 the work failed, 2 wrong usage, 130 stopped by Ctrl-C.\n"
                   "`" +
                   info.name + " COMMAND --help` lists a command's options.");

    const std::vector<Command> commands = info.addCommands(program);
    CommonOptions common;
    for (const Command& command : commands) addCommonOptions(*command.app, common);

    try {
        std::vector<std::string> reversed = withListsExpanded(arguments);
        std::reverse(reversed.begin(), reversed.end()); // the order in which CLI11 takes them
        program.parse(std::move(reversed));
    } catch (const CLI::ParseError& e) {
        // Help and version are thrown too; they are answers.
        if (e.get_exit_code() == 0) {
            if (dynamic_cast<const CLI::CallForVersion*>(&e) != nullptr)
                return {0, std::string(e.what()) + "\n", {}, {}};
            if (const auto parsed = program.get_subcommands(); !parsed.empty())
                return {0, wrapped(parsed.front()->help(info.name)), {}, {}};
            return {0, wrapped(program.help()), {}, {}};
        }
        return fail(2, problem(program, e) + ", " + place(program) + ", see " + place(program) + " --help");
    }
    const auto chosen =
        std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.app->parsed(); });
    return runCommand(info, program, *chosen, common);
}

} // namespace

void beginProgram() {
    installInterrupt();
    // A file that must not grow further (`ulimit -f`) is told like a full disk, instead of ending the process.
    std::signal(SIGXFSZ, SIG_IGN);
}

Outcome run(const Program& info, const std::vector<std::string>& arguments) {
    try {
        return parseAndRun(info, arguments);
    } catch (...) {
        return failureOf(std::current_exception(), info.name);
    }
}

int tell(const Program& info, const Outcome& outcome) {
    const auto say = [&](const char* kind, const std::string& line) {
        std::fprintf(stderr, "%s: %s: %s\n", info.name.c_str(), kind, oneLine(line).c_str());
    };
    try {
        if (!outcome.answer.empty()) writeAnswer(outcome.answer);
    } catch (...) {
        const Outcome failure = failureOf(std::current_exception(), info.name);
        say("error", failure.error);
        return failure.status;
    }
    if (!outcome.error.empty()) say("error", outcome.error);
    for (const std::string& notice : outcome.notices) say("note", notice);
    return outcome.status;
}

} // namespace pellucid::cli
