#include "optimize_report.h"

#include <filesystem>

#include "base/atomic_file.h"
#include "command_line.h"
#include "output_files.h"
#include "report/convergence.h"
#include "report/csv.h"
#include "report/report.h"
#include "report/svg_plot.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

bool isSvg(const std::string& path) { return fs::path(path).extension() == ".svg"; }

void writeCurves(const Run& run, const std::string& path) {
    const Run* const only = &run;
    writeTextAtomically(path, isSvg(path) ? svgOf(convergencePlots(run)) : csvOf(std::span(&only, 1)));
}

} // namespace

void ReportOptions::add(CLI::App& app) {
    addOutputFolder(
        app, "--report", folder,
        "write report.html, one self-contained page (pictures before and after, bars, curves, how alike the moves "
        "look, "
        "settings, this command), and curves.csv");
    addValue(app, "--report-size", "WxH", size, parseImageSize, "pixels of the report's pictures (default 512x512)");
    addOutputFile(app, "--curves", curves, "write distance, VWS and opacities over the moves: .csv or .svg",
                  [](const std::string& path) {
                      const std::string suffix = fs::path(path).extension().string();
                      if (suffix != ".csv" && suffix != ".svg")
                          throw UsageError("curves are written as .csv or .svg", path, "give one of these suffixes");
                  });
}

void ReportOptions::check() const {
    if (size && !folder)
        throw UsageError("--report-size is the size of a report's pictures", "--report-size", "give --report DIR too");
    if (!folder) return;
    for (const char* file : {kReportFile, kCurvesFile}) addOutputFile(*folder, file, "--report");
}

void ReportOptions::write(const Scene& scene, RunStart start, const OptimizeResult& result, double seconds,
                          std::vector<std::string> remarks, Workspace& workspace, Progress& progress,
                          Answer& answer) const {
    if (!folder && !curves) return;
    Run run = runOf(result, std::move(start));
    run.seconds = seconds;
    if (curves) {
        writeCurves(run, *curves);
        answer.text += "wrote " + *curves + "\n";
        answer.json["curves"] = *curves;
    }
    if (!folder) return;
    ReportRequest request{.run = run, .scene = scene, .remarks = std::move(remarks), .command = commandLine()};
    request.width = size.value_or(ImageSize{}).width;
    request.height = size.value_or(ImageSize{}).height;
    request.program = std::string("Pellucid ") + PELLUCID_VERSION;
    const Report report = makeReport(request, workspace, progress.phase("drawing the report"));
    const ThresholdCheck check = thresholdCheck(run, report.states);
    progress.phase("writing");
    writeReport(report, *folder);
    const std::string file = (fs::path(*folder) / kReportFile).string();
    answer.text += "wrote " + file + "\n";
    Json states = Json::array();
    for (const ReportState& s : report.states) states.push_back({{"move", s.move}, {"ssim", s.ssim}});
    Json threshold{{"objective", ThresholdCheck::kObjective},
                   {"ssim", ThresholdCheck::kAlike},
                   {"states", check.below},
                   {"alike", check.alike}};
    if (check.below > 0) threshold["least"] = check.least;
    answer.json["report"] = {{"file", file},
                             {"size", {request.width, request.height}},
                             {"states", states},
                             {"threshold", std::move(threshold)}};
}

} // namespace pellucid::cli
