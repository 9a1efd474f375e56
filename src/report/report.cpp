#include "report/report.h"
#include "base/round_numbers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/atomic_file.h"
#include "base/check.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "render/camera_motion.h"
#include "render/feature_pictures.h"
#include "render/ssim.h"
#include "report/csv.h"
#include "report/html_report.h"
#include "report/page_parts.h"
#include "session/caption.h"
#include "session/session_json.h"
#include "tf/shown_tf.h"
#include "volume/orientation.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr int kWidthOfStates = 192; ///< at most, pixels

std::string lengths(const Vec3& v) { return shortText(v.x) + " × " + shortText(v.y) + " × " + shortText(v.z); }

/// Those that count beside the others.
template <class T>
void addSettings(std::vector<std::pair<std::string, std::string>>& rows, const T& settings) {
    for (const Setting& setting : settingsOf<T>())
        if (setting.isUsed(&settings)) rows.emplace_back(setting.name(), shownText(setting, &settings));
}

std::vector<std::pair<std::string, std::string>> settingsOf(const ReportRequest& request, const std::string& engine) {
    const Scene& scene = request.scene;
    const Volume& volume = *scene.volume;
    const OptimizeOptions& o = request.run.start->options;
    const MeasureSettings& m = *scene.session.measure;
    const ViewAngles view = viewAngles(scene.camera, volume.geometry());
    const std::string unit = scene.unit.value_or("");
    const Int3 d = volume.dims();
    std::vector<std::pair<std::string, std::string>> rows{
        {"Volume", volume.title},
        {"Voxels", std::to_string(d.x) + " × " + std::to_string(d.y) + " × " + std::to_string(d.z) + ", " +
                       name(volume.sampleType())},
        {"Spacing", lengths(volume.geometry().spacing) + " " + lengthUnit(volume.geometry())},
        {"Values of intensity 0 and 1",
         shortText(volume.range().lo) + " to " + shortText(volume.range().hi) + (unit.empty() ? "" : " " + unit)},
        {"View", shortText(view.azimuth) + "°, " + shortText(view.elevation) + "°, zoom " + shortText(view.zoom) +
                     (scene.camera.projection == Projection::Orthographic ? ", orthographic" : ", perspective")}};
    if (!(*scene.session.clipping == Clipping{})) rows.emplace_back("Clipped", "yes");
    addSettings(rows, m);
    if (m.profile == Profile::Default) {
        rows.emplace_back("Engine that measured", engine);
        addSettings(rows, m.saliency);
        addSettings(rows, m.vws);
    }
    addSettings(rows, o);
    if (request.run.evaluations > 0) rows.emplace_back("Evaluations of W", std::to_string(request.run.evaluations));
    if (request.run.seconds > 0) rows.emplace_back("Time", shortText(request.run.seconds) + " s");
    if (!request.run.started.empty()) rows.emplace_back("Begun", request.run.started);
    return rows;
}

} // namespace

ThresholdCheck thresholdCheck(const Run& run, const std::vector<ReportState>& states) {
    ThresholdCheck check;
    for (const ReportState& state : states) {
        if (state.move == run.best || !(run.history[state.move].objective < ThresholdCheck::kObjective)) continue;
        ++check.below;
        if (state.ssim > ThresholdCheck::kAlike) ++check.alike;
        if (state.ssim < check.least || check.below == 1) {
            check.least = state.ssim;
            check.worst = state.move;
        }
    }
    return check;
}

std::string wordsOf(const ThresholdCheck& check) {
    if (check.below == 0)
        return "No state but the answer has F below 0.03, so that this run says nothing about the threshold of §5.4.";
    const std::string states = check.below == 1
                                   ? "One state beside the answer has F below 0.03"
                                   : std::to_string(check.below) + " states beside the answer have F below 0.03";
    const std::string least = "SSIM " + fixedText(check.least, 4) + " at move " + std::to_string(check.worst);
    if (check.holds())
        return states + ", and each looks like it: SSIM above 0.99, as §5.4 found (lowest: " + least + ").";
    return states + ", but only " + std::to_string(check.alike) + " of them with SSIM above 0.99 (lowest: " + least +
           "): what §5.4 found does not hold here.";
}

Session sessionAtStart(const Run& run, const Session& now) {
    PELLUCID_CHECK(run.hasStart());
    const RunStart& start = *run.start;
    Session session = now;
    session.setTf(start.tf);
    session.camera = start.camera;
    session.clipping = start.clipping;
    session.measure = start.measure;
    session.optimize = start.options;
    session.runs = {};
    const auto held = session.tf();
    const TransferFunction& tf = *held; // with identities
    session.goals.set(withTargets(*session.goals, tf, run.targets));
    session.goals.edit([&](FeatureGoals& goals) {
        for (std::size_t f = 0; f < start.limits.size(); ++f) {
            FeatureGoal& goal = goals[tf.features[f].id];
            goal.lowest = start.limits[f].lowest;
            goal.highest = start.limits[f].highest;
            goal.locked = start.limits[f].locked && !tf.features[f].hidden; // hidden ones are locked anyhow
        }
    });
    return session;
}

Scene sceneAtStart(const Run& run, const Scene& now, const JobControl& job) {
    Scene scene = resolve(sessionAtStart(run, now.session), now, {}, job);
    scene.unit = now.unit;
    return scene;
}

std::vector<std::size_t> chosenStates(const Run& run, std::size_t most) {
    PELLUCID_CHECK(most >= 3);
    const std::size_t count = run.history.size();
    std::set<std::size_t> chosen;
    if (count <= most) {
        for (std::size_t i = 0; i < count; ++i) chosen.insert(i);
    } else {
        // One place is the answer's, wherever it is.
        for (std::size_t i = 0; i + 1 < most; ++i)
            chosen.insert(static_cast<std::size_t>(
                std::lround(static_cast<double>(i * (count - 1)) / static_cast<double>(most - 2))));
        chosen.insert(run.best);
    }
    return {chosen.begin(), chosen.end()};
}

Report makeReport(const ReportRequest& request, Workspace& workspace, const JobControl& job) {
    const Run& run = request.run;
    PELLUCID_CHECK(!run.history.empty() && run.best < run.history.size());
    const std::vector<std::size_t> chosen = chosenStates(run, request.mostStates);
    const std::size_t pieces = chosen.size() + 3; // the answer's picture, all pictures, two measurements
    std::size_t piece = 0;
    const auto sceneOf = [&](std::size_t move) {
        Scene scene = request.scene;
        scene.tf = withShownOpacities(request.scene.tf, run.history[move].opacity);
        return scene;
    };

    Report report;
    report.title = request.scene.volume->title;
    report.run = run;
    report.tfBefore = sceneOf(0).tf;
    report.tfAfter = sceneOf(run.best).tf;
    report.window = request.scene.volume->range();
    report.unit = request.scene.unit.value_or("");
    report.remarks = request.remarks;
    report.command = request.command;
    report.program = request.program;
    report.session = request.session;
    const auto measured = [&](std::size_t move, std::string& words, std::string& alt) {
        const Scene scene = sceneOf(move);
        const Measures measures = workspace.measure(measureInput(scene), job.part(piece++, pieces));
        const CaptionFacts facts = captionFacts(scene, measures);
        words = caption(facts);
        alt = altText(facts);
        return measures.features;
    };
    report.measuresBefore = measured(0, report.captionBefore, report.altBefore);
    report.measuresAfter = measured(run.best, report.captionAfter, report.altAfter);
    const MeasureInput input = measureInput(sceneOf(run.best));
    report.settings = settingsOf(request, workspace.engine(input).name());

    const auto renderer = makeRenderer(request.scene.session.measure->engine, request.scene.volume);
    const auto inputOf = [&](std::size_t move) { return pictureInput(sceneOf(move), request.width, request.height); };
    const auto picture = [&](std::size_t move) {
        const PictureInput p = inputOf(move);
        const JobControl part = job.part(piece++, pieces);
        Image image = renderer->render(p.camera, p.tf, p.settings, part);
        job.throwIfStopped();
        return image;
    };
    const auto looked = [&](std::size_t move, std::vector<double>& fs) {
        const PictureInput p = inputOf(move);
        const JobControl part = job.part(piece++, pieces);
        FeaturePictures pictures = featurePictures(*renderer, p.camera, p.tf, p.settings, part);
        fs = featureSaliency(pictures, {job.stop, {}}).shares;
        job.throwIfStopped();
        return std::move(pictures.whole);
    };
    const Image answer = looked(run.best, report.fsAfter);
    report.after = encoded(answer);
    for (const std::size_t move : chosen) {
        const Image image = move == run.best ? answer : move == 0 ? looked(0, report.fsBefore) : picture(move);
        if (move == 0) report.before = encoded(image);
        if (move == 0 && move == run.best) report.fsBefore = report.fsAfter;
        report.states.push_back({move, ssim(image, answer), encoded(reduced(image, kWidthOfStates))});
        job.throwIfStopped();
    }
    job.report(1);
    return report;
}

void writeReport(const Report& report, const std::string& folder) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec && !fs::is_directory(folder))
        throw FileError("the folder cannot be created (" + ec.message() + ")", folder, "choose another name");
    const Run* const run = &report.run;
    const std::string html = htmlOf(report), csv = csvOf(std::span(&run, 1));
    writeTextAtomically((fs::path(folder) / kCurvesFile).string(), csv);
    if (report.session) writeSession(*report.session, (fs::path(folder) / kStartFile).string());
    writeTextAtomically((fs::path(folder) / kReportFile).string(), html);
}

} // namespace pellucid
