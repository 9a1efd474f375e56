// The commands of pellucid-cli, one file each.
#pragma once

#include <functional>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/stopwatch.h"
#include "output.h"
#include "progress.h"

namespace pellucid::cli {

/// A command as main() knows it: its options (already added to the program) and its work.
struct Command {
    CLI::App* app = nullptr;
    /// Throws UsageError, Error or Cancelled; prints nothing on stdout itself.
    std::function<Answer(Progress&)> run;
};

Command addInfo(CLI::App& program);
Command addSamples(CLI::App& program);
Command addPresets(CLI::App& program);
Command addFilm(CLI::App& program);
Command addGenerate(CLI::App& program);
Command addConvert(CLI::App& program);
Command addRender(CLI::App& program);
Command addMeasure(CLI::App& program);
Command addFields(CLI::App& program);
Command addColors(CLI::App& program);
Command addDescribe(CLI::App& program);
Command addPlot(CLI::App& program);
Command addPropose(CLI::App& program);
Command addRefine(CLI::App& program);
Command addOptimize(CLI::App& program);
Command addDensity(CLI::App& program);
Command addSequence(CLI::App& program);
Command addFigure(CLI::App& program);
Command addShare(CLI::App& program);
Command addSpace(CLI::App& program);
Command addSaliencyMap(CLI::App& program);
Command addCompare(CLI::App& program);
Command addProbe(CLI::App& program);
Command addRulers(CLI::App& program);
Command addViews(CLI::App& program);
Command addReproduce(CLI::App& program);
Command addBench(CLI::App& program);
Command addThumbnail(CLI::App& program);
/// Of all commands that `program` has when it runs.
Command addCompletions(CLI::App& program);
Command addStudyPrepare(CLI::App& study);
Command addStudyRun(CLI::App& study);
Command addStudyAnalyze(CLI::App& study);
/// `study` with commands of its own.
std::vector<Command> addStudy(CLI::App& program);

} // namespace pellucid::cli
