// pellucid-mpi: commands of pellucid-cli on volumes that no process holds as a whole. All ranks do the same; what they
// have of a volume differs. Rank 0 alone says anything and writes files, but for those that all write together
// (base/joint_file.h), and those of the frames that they divide.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "base/memory.h"
#include "program.h"
#include "ranks/mpi/mpi_communicator.h"
#include "ranks/process_ranks.h"
#include "ranks/rank_volume.h"
#include "volume/time_series.h"

namespace pellucid::cli {

namespace {

std::vector<Command> addCommands(CLI::App& program) {
    return {addInfo(program),     addMeasure(program), addFields(program), addRefine(program), addPropose(program),
            addOptimize(program), addDensity(program), addViews(program),  addRender(program), addSequence(program)};
}

constexpr std::uint64_t kMostForFrames = std::uint64_t{2} << 30; ///< bytes per rank, of frames that may be wanted again

Outcome runOnRanks(const Program& program, const std::vector<std::string>& arguments, MpiRanks& ranks) {
    try {
        ranks.requireSameProgram();
    } catch (const RankLost&) {
        return {1, {}, {}, {}};
    } catch (const Error& e) {
        return {1, {}, e.what(), {}};
    }
    setRanksOfProcess(&ranks);
    // Frames of a series that one rank forgets and another keeps could not be read together: all keep as many.
    static RankLayout layout;
    std::uint64_t budget = kMostForFrames;
    layout.roomForFrame = std::numeric_limits<std::uint64_t>::max();
    const auto beside = static_cast<std::uint64_t>(ranks.onThisMachine());
    for (const std::uint64_t free : gatherValues(ranks, availableMemoryBytes() / beside)) {
        budget = std::min(budget, free / 4);
        layout.roomForFrame = std::min(layout.roomForFrame, free / 2);
    }
    TimeSeries::setDefaultBudget(static_cast<std::size_t>(budget));
    setVolumeLoader([](const VolumeSource& source, const JobControl& job) {
        return loadOnRanks(*ranksOfProcess(), source, layout, job);
    });
    return run(program, arguments);
}

/// Adds to a JSON object what the ranks have sent: the most of any, so that it can be compared with docs/scale.md.
void addTraffic(Outcome& outcome, MpiRanks& ranks, const Traffic& sent) {
    std::uint64_t bytes = 0, messages = 0, rounds = 0;
    for (const Traffic& of : gatherValues(ranks, sent)) {
        bytes = std::max(bytes, of.bytes);
        messages = std::max(messages, of.messages);
        rounds = std::max(rounds, of.rounds);
    }
    if (!outcome.answer.starts_with("{")) return;
    Json json = Json::parse(outcome.answer);
    json["ranks"] = {{"count", ranks.size()}, {"bytes_sent", bytes}, {"messages", messages}, {"rounds", rounds}};
    outcome.answer = jsonText(json);
}

/// Where srun has started several processes and MPI knows of no other one, each would do all of the work, and they
/// would write the same files.
void requireThatAllAreKnown(const MpiRanks& ranks) {
    const char* const tasks = std::getenv("SLURM_STEP_NUM_TASKS");
    const bool byLauncher = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
    if (ranks.size() > 1 || byLauncher || tasks == nullptr || std::string_view(tasks) == "1") return;
    throw Error("srun has started " + std::string(tasks) + " processes, but MPI has not brought them together", "srun",
                "start them with srun --mpi=pmix or with mpirun");
}

/// Runs the command, and agrees with the other ranks on how that ended.
Outcome runTogether(const Program& program, const std::vector<std::string>& arguments, MpiRanks& ranks) {
    Outcome outcome = runOnRanks(program, arguments, ranks);
    if (outcome.status == 0) {
        try {
            addTraffic(outcome, ranks, ranks.traffic());
        } catch (const RankLost&) {
            outcome = {1, {}, {}, {}};
        }
    }
    const auto ending = ranks.leave({outcome.status, outcome.error});
    if (ending.status != 0 && outcome.status == 0) outcome = {ending.status, {}, {}, {}};
    outcome.error = ending.message;
    return outcome;
}

} // namespace

} // namespace pellucid::cli

#if defined(__SANITIZE_ADDRESS__)
/// Open MPI's modules stay: what they keep to the end of the process has their names (scripts/lsan-mpi.supp).
extern "C" int dlclose(void*) { return 0; }
#endif

int main(int argc, char** argv) {
    namespace cli = pellucid::cli;
    cli::beginProgram();
    cli::Program program{"pellucid-mpi",
                         "Pellucid on many ranks: measures and optimizes volumes that no process holds as a whole. "
                         "Start it with mpirun.",
                         cli::addCommands};
    try {
        pellucid::MpiRanks ranks(argc, argv);
        program.shows = ranks.rank() == 0;
        cli::requireThatAllAreKnown(ranks);
        const cli::Outcome outcome = cli::runTogether(program, {argv + 1, argv + argc}, ranks);
        return ranks.rank() == 0 ? cli::tell(program, outcome) : outcome.status;
    } catch (const pellucid::Error& e) {
        return cli::tell(program, {1, {}, e.what(), {}});
    }
}
