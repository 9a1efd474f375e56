// What an optimization did, for people who were not there: pictures, bars, curves, settings, and the command that
// repeats it (docs/guide.md, "Reports").
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "report/page_parts.h"
#include "report/plot.h"
#include "saliency/vws.h"
#include "session/scene.h"
#include "session/workspace.h"

namespace pellucid {

/// A state of the search as it looks.
struct ReportState {
    std::size_t move = 0;  ///< index into the run's history
    double ssim = 1;       ///< of its picture and that of the answer, see ssim()
    ReportPicture picture; ///< small
};

/// §5.4: "for values of the energy function below 0.03, the SSIM scores settled consistently at over 0.99".
struct ThresholdCheck {
    static constexpr double kObjective = 0.03, kAlike = 0.99;
    int below = 0;         ///< states with F < kObjective beside the answer
    int alike = 0;         ///< those of them with SSIM > kAlike
    double least = 1;      ///< SSIM of the one least alike
    std::size_t worst = 0; ///< its move
    bool holds() const { return alike == below; }
};
ThresholdCheck thresholdCheck(const Run& run, const std::vector<ReportState>& states);
/// In a sentence.
std::string wordsOf(const ThresholdCheck& check);

struct Report {
    std::string title; ///< of the volume
    Run run;           ///< with a start and a history
    ReportPicture before, after;
    TransferFunction tfBefore, tfAfter;                         ///< written for `window`
    ValueRange window;                                          ///< data units of intensity 0 and 1
    std::string unit;                                           ///< of the data; may be empty
    std::vector<FeatureMeasures> measuresBefore, measuresAfter; ///< per feature
    std::vector<double> fsBefore, fsAfter;                      ///< 2D feature saliency of both pictures
    std::string captionBefore, captionAfter;                    ///< of both pictures, see caption(); may be empty
    std::string altBefore, altAfter;                            ///< likewise, see altText()
    std::vector<ReportState> states;                            ///< in the order of the history
    std::vector<std::pair<std::string, std::string>> settings;  ///< what, and how it was set
    std::vector<std::string> remarks;                           ///< sentences about the answer
    std::string command;                                        ///< what repeats it, as typed into a shell
    std::string program;                                        ///< and its version
    std::optional<Session> session;                             ///< that `command` opens, as kStartFile beside the page
};

struct ReportRequest {
    Run run;
    Scene scene;                   ///< as it was at the start: see sceneAtStart()
    int width = 512, height = 512; ///< of the two large pictures, pixels
    std::size_t mostStates = 40;   ///< pictures of states; of a longer run evenly chosen ones
    std::vector<std::string> remarks = {};
    std::string command = {}, program = {};
    std::optional<Session> session = {}; ///< see Report
};

/// The session that `run` began in, with the data and looks of `now`; `run` has a start.
Session sessionAtStart(const Run& run, const Session& now);
/// Its scene.
Scene sceneAtStart(const Run& run, const Scene& now, const JobControl& job = {});
/// The moves that get a picture: the start, the answer, the last, and evenly chosen ones between, at most `most` ≥ 3.
std::vector<std::size_t> chosenStates(const Run& run, std::size_t most);

/// Draws and measures. Throws as renderers and Workspace::measure() do, and Cancelled.
Report makeReport(const ReportRequest& request, Workspace& workspace, const JobControl& job = {});

inline constexpr const char *kCurvesFile = "curves.csv", *kStartFile = "start.pellucid.json";
/// Writes kReportFile, kCurvesFile and, where there is a session, kStartFile into `folder`, which is made where it is
/// missing; each is whole or as it was.
/// Throws FileError.
void writeReport(const Report& report, const std::string& folder);

} // namespace pellucid
