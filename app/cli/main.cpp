// pellucid-cli: everything without a display.
#include <algorithm>
#include <iterator>

#include "program.h"

namespace pellucid::cli {

namespace {

std::vector<Command> addCommands(CLI::App& program) {
    std::vector<Command> commands{
        addInfo(program),     addSamples(program), addPresets(program),     addGenerate(program), addRender(program),
        addMeasure(program),  addFields(program),  addRefine(program),      addOptimize(program), addDensity(program),
        addSequence(program), addSpace(program),   addPlot(program),        addPropose(program),  addProbe(program),
        addRulers(program),   addViews(program),   addSaliencyMap(program), addCompare(program),  addReproduce(program),
        addBench(program),    addFilm(program),    addConvert(program),     addDescribe(program), addShare(program),
        addColors(program),   addFigure(program)};
    std::ranges::move(addStudy(program), std::back_inserter(commands));
    commands.push_back(addThumbnail(program));
    commands.push_back(addCompletions(program));
    return commands;
}

} // namespace

} // namespace pellucid::cli

int main(int argc, char** argv) {
    namespace cli = pellucid::cli;
    cli::beginProgram();
    const cli::Program program{"pellucid-cli",
                               "Pellucid on the command line: measures and shapes what a volume rendering shows.",
                               cli::addCommands};
    return cli::tell(program, cli::run(program, {argv + 1, argv + argc}));
}
