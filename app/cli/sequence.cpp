// `sequence`: the frames of a series, each under its transfer function: pictures, figures, curves.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <thread>

#include <unistd.h>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "commands.h"
#include "engines/engines.h"
#include "film/movie_file.h"
#include "image_io/image_file.h"
#include "interrupt.h"
#include "optimize/answer/visibility_words.h"
#include "options/priority_options.h"
#include "options/target_input.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "ranks/process_ranks.h"
#include "render/feature_pictures.h"
#include "render/memory_needs.h"
#include "report/image_plot.h"
#include "report/svg_plot.h"
#include "report/temporal_curves.h"
#include "resolve.h"
#include "session/frame_figures.h"
#include "session/refine_priority.h"
#include "session/scene_data.h"
#include "session/sequence.h"
#include "tf/formats/tf_json.h"
#include "tf/shown_tf.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

using Mode = AdaptSettings::Mode;

struct SequenceArguments {
    SceneOptions scene;
    SettingOptions<AdaptSettings> adapt;
    SettingOptions<OptimizeOptions> search;
    SettingOptions<RefineSteps> steps;
    PriorityOptions priority;
    std::optional<TargetInput> targets;
    std::optional<int> from;
    bool compare = false, requireConverged = false, noPictures = false, overGaps = false;
    bool pictured = false; ///< --2dfs
    std::string out;
    std::optional<double> framesPerSecond;
    std::optional<std::string> movie;
};

constexpr double kFramesPerSecond = 10;

constexpr std::array kCurves{"curves.csv", "curves.svg", "curves.png"};
constexpr const char *kTfSuffix = ".tf.json", *kPictureSuffix = ".png", *kStaticSuffix = "_static.png"; // of a frame

std::string frameName(int frame, const char* suffix) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "frame_%04d", frame);
    return std::string(name.data()) + suffix;
}
std::string inFolder(const SequenceArguments& o, const std::string& name) { return (fs::path(o.out) / name).string(); }
std::string fileOf(const SequenceArguments& o, int frame, const char* suffix) {
    return inFolder(o, frameName(frame, suffix));
}

/// Before the first of them is written, or worked for.
void announceFrames(const SequenceArguments& o, int from, int size) {
    for (int frame = from; frame < size; ++frame) {
        addOutputFile(o.out, frameName(frame, kTfSuffix), "--out");
        if (!o.noPictures) addOutputFile(o.out, frameName(frame, kPictureSuffix), "--out");
        if (!o.noPictures && o.compare) addOutputFile(o.out, frameName(frame, kStaticSuffix), "--out");
    }
}

void checkMovieSuffix(const std::string& path) {
    if (!isMovie(path))
        throw UsageError("'" + path + "' does not end in .mp4", "--mp4", "give a name such as film.mp4");
}

/// What can be told before the volume is read.
void check(const SequenceArguments& o) {
    for (const char* name : kCurves) addOutputFile(o.out, name, "--out");
    refuse({{o.scene.picture.transparent, "flicker cannot be measured on a transparent background",
             "--background transparent", "give a colour"},
            {o.framesPerSecond && !o.movie, "--fps needs --mp4", "--fps", "add --mp4 FILE, or leave out --fps"},
            {o.movie && o.noPictures, "--mp4 needs the pictures", "--no-pictures", "leave out one of the two"},
            {o.movie && ranksOfProcess() != nullptr, "ranks write no film", "--mp4",
             "leave it out: the pictures of all frames are written without it, too"}});
    o.priority.check(o.scene.picture.size);
    if (o.movie && !hasMovieWriter())
        throw Error("ffmpeg is not installed", "--mp4",
                    "install it, or leave the option out: the pictures of all frames are written without it, too");
}

/// Refuses options of refinement in another mode.
void checkRefining(const SequenceArguments& o, const Session& session) {
    const char* priority = o.priority.given();
    if (session.adapt->mode == Mode::Refine) return requireOwnSteps(session.measure->profile, o.steps);
    const std::string of = priority != nullptr        ? priority
                           : !o.steps.given().empty() ? o.steps.given().front()->optionName()
                                                      : std::string();
    if (!of.empty())
        throw UsageError("transfer functions are refined only in the mode refine", of,
                         "add --mode refine, or leave it out");
}

/// Of ranks all read the same at the same time, or each its own: nothing is read ahead.
bool isOneOfSeveral() { return ranksOfProcess() != nullptr; }

/// The frame that is read while others are computed.
class ReadAhead {
public:
    ReadAhead(std::shared_ptr<TimeSeries> series, ValueRange window) : m_series(std::move(series)), m_window(window) {}

    void begin(int frame) {
        if (frame < 0 || frame >= m_series->size() || m_series->roomFor() < 2 || isOneOfSeveral()) return;
        if (m_reading.joinable()) m_reading.join();
        m_reading = std::jthread([series = m_series, window = m_window, frame](const std::stop_token& stop) {
            try {
                series->show(frame, window, {stop, {}});
            } catch (...) { // whoever needs the frame meets the same error
            }
        });
    }

private:
    std::shared_ptr<TimeSeries> m_series;
    ValueRange m_window;
    std::jthread m_reading; ///< stopped when this goes
};

/// One frame on its way.
struct Frame {
    int number = 0;
    std::string problem; ///< why it cannot be read
    TransferFunction tf;
    std::optional<AdaptedFrame> made;
    Scene scene, asStatic;                  ///< of the process whose frame this is; the second one with --compare
    std::optional<TransferFunction> before; ///< of the frame that flicker compares it with
    FrameFigures figures, staticFigures;
};

/// Of consecutive frames.
Frame& frameOf(std::vector<Frame>& batch, int number) {
    return batch.at(static_cast<std::size_t>(number - batch.front().number));
}

/// What is found out where a frame is drawn, for other processes.
Json told(const FrameFigures& f) {
    Json json{{"vws", f.vws},         {"visibility", f.visibility}, {"opacity", f.opacity},    {"fs", f.fs},
              {"targets", f.targets}, {"empty", f.empty},           {"objective", f.objective}};
    if (f.flicker) json["flicker"] = *f.flicker;
    return json;
}
void take(const Json& json, FrameFigures& f) {
    json["vws"].get_to(f.vws);
    json["visibility"].get_to(f.visibility);
    json["opacity"].get_to(f.opacity);
    json["fs"].get_to(f.fs);
    json["targets"].get_to(f.targets);
    f.empty = json["empty"].get<std::vector<bool>>();
    json["objective"].get_to(f.objective);
    if (json.contains("flicker")) f.flicker = json["flicker"].get<double>();
}

class Sequence {
public:
    Sequence(const SequenceArguments& o, Scene scene, Progress& progress)
        : m_o(o), m_scene(std::move(scene)), m_progress(progress) {}

    Answer run(const Opened& opened);

private:
    void prepareKey();
    void plan(ReadAhead& ahead);
    std::vector<Json> gatherAll(const Json& mine) const;
    void read(int frame) const;
    void readTogether(int frame) const;
    void requireSharedFolder() const;
    bool isMine(const Frame& frame) const { return m_work.isMine(static_cast<std::size_t>(frame.number - m_start)); }
    void open(Frame& frame) const;
    void follow(Frame& frame);
    void followRead(Frame& frame);
    Frame next(int number);
    void agree(std::vector<Frame>& batch) const;
    void draw(Frame& frame, Workspace& workspace) const;
    void gather(std::vector<Frame>& batch) const;
    Json jsonOf(const Frame& frame) const;
    void finish(std::vector<Frame>& batch);
    void tellMissed(const SequenceFigures& figures);
    TemporalCurves curves() const;
    std::string text(const SequenceFigures& dynamic, const std::optional<SequenceFigures>& asStatic) const;
    Json json(const SequenceFigures& dynamic, const std::optional<SequenceFigures>& asStatic) const;

    const AdaptSettings& settings() const { return *m_scene.session.adapt; }
    /// Whether transfer functions are there before frames are read.
    bool knowsTfs() const { return settings().mode == Mode::Static || smooths(settings()); }
    SharedWork divided() const;
    /// While one of these lives other ranks have frames of their own, where frames are divided.
    std::unique_ptr<WorkAlone> apart() const { return m_work.parts > 1 ? std::make_unique<WorkAlone>() : nullptr; }

    const SequenceArguments& m_o;
    Scene m_scene; ///< of the start frame; its session has all transfer functions that there are so far
    Progress& m_progress;
    int m_start = 0;
    double m_keySeconds = 0;
    SequenceMaker m_maker;
    SharedWork m_work; ///< what of the frames this process draws and measures
    std::vector<Workspace> m_sideBySide;
    TransferFunction m_fixed;                          ///< of the start frame, as static
    std::optional<TransferFunction> m_before, m_chain; ///< of the frame before; what the next one starts from
    int m_beforeNumber = -1;                           ///< of m_before
    std::map<int, AdaptedFrame> m_planned;             ///< of plan(), by frame: the session has what is drawn
    std::vector<FrameFigures> m_figures, m_static;
    std::vector<int> m_afterGaps; ///< frames whose flicker is not told
    Json m_priority;              ///< that of the first frame that was refined
    std::vector<std::string> m_notices;
    std::vector<Json> m_frames;
    std::vector<std::string> m_pictures;
};

/// The start frame's transfer function becomes a key; with targets it is optimized first.
void Sequence::prepareKey() {
    const Stopwatch watch;
    Session& session = m_scene.session;
    m_start = session.frame;
    session.adapt.edit([&](AdaptSettings& a) { m_o.adapt.applyTo(a); });
    session.optimize.edit([&](OptimizeOptions& options) { m_o.search.applyTo(options); });
    checkRefining(m_o, session);
    session.refine.edit([&](RefineSettings& settings) {
        m_o.steps.applyTo(settings);
        m_o.priority.applyTo(settings, m_o.scene.picture.size);
    });
    if (m_o.targets) {
        const std::vector<double> targets = atOption(
            "--target", [&] { return normalizedTargets(m_o.targets->of(m_scene), m_scene.tf.features.size()); });
        session.targetKeys.set({});
        // A number for a feature that is empty here is for later frames; words say nothing of it.
        const TransferFunction named = m_o.targets->numbers.empty() ? m_scene.wantedTf() : m_scene.tf;
        session.goals.set(withTargets(*session.goals, named, targets));
        const OptimizeResult result = m_maker.workspace().optimize(
            measureInput(m_scene), shownShares(m_scene.wantedTf(), targets), limitsOf(m_scene.tf, *session.goals),
            *session.optimize, m_progress.openPhase("optimizing"), movesTold(m_progress));
        if (result.reason == StopReason::Cancelled) throw Cancelled{};
        m_scene.tf = withShownOpacities(m_scene.tf, result.history[result.best].opacity);
        if (const std::string kept = keptText(result); !kept.empty())
            m_notices.push_back("frame " + std::to_string(m_start) + ": " + kept);
    }
    m_fixed = m_scene.tf;
    session = beginningHere(std::move(session), m_fixed, m_o.scene.sessionFile.value_or("the session"));
    m_keySeconds = watch.seconds();
}

/// What coherence asks for: all frames forward, then smoothed together.
void Sequence::plan(ReadAhead& ahead) {
    Session& session = m_scene.session;
    const TimeSeries& series = *m_scene.series;
    const JobControl job = m_progress.phase("following");
    const auto begins = [&](int frame) { ahead.begin(frame + 1); };
    for (SequenceMaker::Step step; (step = m_maker.next(m_scene, job, nullptr, begins)).goesOn();) {
        job.throwIfStopped();
        session = withStep(std::move(session), step);
        job.report((step.firstStale - m_start) / static_cast<double>(series.size() - m_start));
        if (step.made) m_planned[step.made->frame] = std::move(*step.made);
    }
    const JobControl smoothing = m_progress.phase("smoothing");
    for (SequenceMaker::Step step; (step = m_maker.next(m_scene, job, &smoothing, begins)).goesOn();) {
        session = withStep(std::move(session), step);
        if (!step.smoothed) continue;
        for (const auto& [frame, tf] : step.smoothed->tfs) {
            AdaptedFrame& made = m_planned[frame];
            if (settings().mode == Mode::Optimize) ++made.moves;
            made.seconds += step.smoothed->seconds / static_cast<double>(step.smoothed->tfs.size());
        }
    }
}

/// Whoever has read a frame of his own may have forgotten others that his neighbours still have, so that ranks that go
/// on together may read none but the next one.
SharedWork Sequence::divided() const {
    const Session& session = m_scene.session;
    const bool needsOthers = session.variables->size() > 1 || session.variable().derivation || session.hsb->on ||
                             (settings().mode == Mode::Refine && session.refine->region);
    const SharedWork work = workOfProcess();
    const auto frames = static_cast<std::size_t>(m_scene.series->size() - m_start);
    if (m_scene.volume->elsewhere() != nullptr || (needsOthers && !knowsTfs()) || frames < work.parts) return {};
    return work;
}

/// The elements of the lists of all processes.
std::vector<Json> Sequence::gatherAll(const Json& mine) const {
    const std::vector<std::uint8_t> bytes = Json::to_cbor(mine);
    std::vector<Json> all;
    for (const auto& other : m_work.gather(std::as_bytes(std::span(bytes)))) {
        const auto* const data = reinterpret_cast<const std::uint8_t*>(other.data());
        for (Json& json : Json::from_cbor(data, data + other.size())) all.push_back(std::move(json));
    }
    return all;
}

/// The frame's own data, of which a rank has no block.
void Sequence::read(int frame) const {
    if (m_scene.series->load(frame, {interruptToken(), {}})->elsewhere() != nullptr)
        throw Error(
            "the frames of the series take different amounts of memory, so that some fit a rank and some do not",
            m_scene.series->listing().fileOf(frame), "use fewer ranks on each machine, or pellucid-cli");
}

/// Reads the frame where ranks go on together: all, or none.
void Sequence::readTogether(int frame) const {
    if (m_work.parts == 1) return;
    TimeSeries& series = *m_scene.series;
    std::string problem;
    try {
        const WorkAlone alone;
        read(frame);
    } catch (const FileError& error) {
        passOver(series, frame, error);
        problem = series.summary(frame).problem;
    }
    for (const Json& said : gatherAll(Json::array({problem}))) {
        if (said == "") continue;
        series.noteProblem(frame, said.get<std::string>());
        throw FileError("some rank cannot read it", series.listing().fileOf(frame), "check the file");
    }
}

/// Whether all processes see the folder: those that write into another one of the same name would lose their frames.
void Sequence::requireSharedFolder() const {
    if (m_work.parts == 1) return;
    const std::string mine = ".pellucid-" + std::to_string(getpid()) + ".part";
    const auto name = gatherAll(Json::array({mine})).front().get<std::string>(); // the first one's, for all
    const std::string path = inFolder(m_o, name);
    std::string problem;
    try {
        if (m_work.part == 0) writeTextAtomically(path, name);
    } catch (const FileError& error) {
        problem = error.problem();
    }
    m_work.gather({});
    std::error_code failure;
    if (problem.empty() && !fs::exists(path, failure)) problem = "not all processes see this folder";
    const std::vector<Json> problems = gatherAll(Json::array({problem}));
    if (m_work.part == 0) fs::remove(path, failure);
    for (const Json& said : problems)
        if (said != "")
            throw FileError(said.get<std::string>(), m_o.out,
                            "name a folder that all machines share, and can write to");
}

/// Reads the frame, ready to be drawn and measured.
void Sequence::open(Frame& frame) const {
    const JobControl job{interruptToken(), {}};
    if (m_work.parts > 1) read(frame.number);
    frame.scene = sceneAt(m_scene, frame.number, frame.tf, job);
    if (m_o.compare) frame.asStatic = sceneAt(frame.scene, frame.number, m_fixed, job);
}

/// Gives the frame its transfer function, which comes from that of the frame before. All processes go along.
void Sequence::follow(Frame& frame) {
    const TfTrack& track = m_scene.session.variable().track;
    const int number = frame.number;
    // Broken or not, what follows a key begins there.
    if (track.keys.contains(number) || !m_chain) m_chain = *track.keys.at(track.keyBefore(number));
    readTogether(number);
    try {
        followRead(frame);
    } catch (const FileError& e) { // of one rank, perhaps: others are amid a sweep
        if (m_work.parts == 1) throw;
        throw Error(e);
    }
}

void Sequence::followRead(Frame& frame) {
    const TfTrack& track = m_scene.session.variable().track;
    const int number = frame.number;
    AdaptTask task{number, track.keyBefore(number), *m_chain, {}};
    task.basis = frameFingerprint(m_scene.session, *m_scene.series, number, *m_chain);
    const auto known = track.adapted.find(number); // a session brings some
    if (known != track.adapted.end() && known->second.basis == task.basis) {
        frame.tf = *known->second.tf;
    } else {
        frame.made = m_maker.adapter().adapt(m_scene, task, m_maker.workspace(), {interruptToken(), {}});
        frame.tf = frame.made->tf;
    }
    open(frame);
    m_chain = frame.scene.tf;
    if (!isMine(frame)) frame.scene = frame.asStatic = {};
}

/// The frame with its transfer function, ready to be drawn and measured if it is this process's.
Frame Sequence::next(int number) {
    Frame frame;
    frame.number = number;
    try {
        if (!knowsTfs()) {
            follow(frame);
            return frame;
        }
        frame.tf = *m_scene.session.tfAt(number);
        if (const auto planned = m_planned.find(number); planned != m_planned.end()) frame.made = planned->second;
        if (!isMine(frame)) return frame;
        const auto alone = apart();
        open(frame);
    } catch (const FileError& error) {
        passOver(*m_scene.series, number, error);
        frame.problem = brokenFigures(*m_scene.series, number).problem;
    }
    return frame;
}

/// On which frames are broken, and what flicker compares the others with.
void Sequence::agree(std::vector<Frame>& batch) const {
    if (m_work.parts == 1) return;
    Json mine = Json::array();
    for (const Frame& frame : batch)
        if (isMine(frame)) mine.push_back({frame.number, frame.problem});
    for (const Json& found : gatherAll(mine)) {
        Frame& frame = frameOf(batch, found[0]);
        frame.problem = found[1].get<std::string>();
        if (m_scene.series->summary(frame.number).problem != frame.problem) // files come and go
            m_scene.series->noteProblem(frame.number, frame.problem);
    }
}

Json Sequence::jsonOf(const Frame& frame) const {
    const FrameFigures& f = frame.figures;
    Json json{{"frame", f.frame},           {"time", f.time},       {"vws", f.vws},
              {"visibility", f.visibility}, {"opacity", f.opacity}, {"target", f.targets},
              {"empty", f.empty},           {"file", f.file},       {"objective", f.objective}};
    if (m_o.pictured) json["fs"] = f.fs;
    if (f.flicker) json["flicker"] = *f.flicker;
    if (f.moves) {
        json["moves"] = *f.moves;
        json["seconds"] = f.seconds;
    }
    if (frame.made && frame.made->energy) {
        const RefineEnergies& energy = *frame.made->energy;
        json["energy_before"] = energy.before;
        json["energy_after"] = energy.after;
        json["energy_movable_before"] = energy.movableBefore;
        json["energy_movable_after"] = energy.movableAfter;
        if (m_scene.session.refine->hue) // whose intensity may be another one where voxels have colours of their own
            json["priority"] = m_o.priority.told(*m_scene.session.refine, frame.made->priority);
    }
    if (m_o.compare)
        json["static"] = {{"vws", frame.staticFigures.vws},
                          {"visibility", frame.staticFigures.visibility},
                          {"objective", frame.staticFigures.objective}};
    if (m_o.compare && m_o.pictured) json["static"]["fs"] = frame.staticFigures.fs;
    json["tf"] = Json(jsonFromTf(frame.tf));
    return json;
}

/// Figures and pictures.
void Sequence::draw(Frame& frame, Workspace& workspace) const {
    const JobControl job{interruptToken(), {}};
    std::optional<TransferFunction> before;
    if (frame.before) before = writtenFor(*frame.before, frame.scene.volume->range());
    frame.figures = figuresOf(frame.scene, before ? &*before : nullptr, workspace, job);
    if (m_o.compare) {
        frame.staticFigures = figuresOf(frame.asStatic, nullptr, workspace, job);
        if (before) frame.staticFigures.flicker = 0; // the same transfer function
    }
    writeTf(frame.scene.tf, fileOf(m_o, frame.number, kTfSuffix));
    const auto drawAs = [&](const Scene& scene, const char* suffix, FrameFigures& figures) {
        if (m_o.noPictures && !m_o.pictured) return;
        const PictureInput picture = m_o.scene.picture.pictureOf(scene);
        const auto renderer = makeRenderer(scene.session.measure->engine, picture.volume);
        Image image;
        if (m_o.pictured) {
            FeaturePictures pictures = featurePictures(*renderer, picture.camera, picture.tf, picture.settings, job);
            figures.fs = featureSaliency(pictures, job).shares;
            image = std::move(pictures.whole);
        } else {
            image = renderer->render(picture.camera, picture.tf, picture.settings, job);
        }
        if (!m_o.noPictures) writeImage(image, fileOf(m_o, frame.number, suffix));
    };
    drawAs(frame.scene, kPictureSuffix, frame.figures);
    if (m_o.compare) drawAs(frame.asStatic, kStaticSuffix, frame.staticFigures);
    frame.tf = frame.scene.tf;
}

/// What the processes have found out of their frames, for all.
void Sequence::gather(std::vector<Frame>& batch) const {
    if (m_work.parts == 1) return;
    Json mine = Json::array();
    for (const Frame& frame : batch)
        if (isMine(frame) && frame.problem.empty())
            mine.push_back({{"frame", frame.number},
                            {"figures", told(frame.figures)},
                            {"static", told(frame.staticFigures)},
                            {"tf", jsonFromTf(frame.tf)}});
    for (const Json& made : gatherAll(mine)) {
        Frame& frame = frameOf(batch, made["frame"]);
        if (isMine(frame)) continue;
        frame.figures = brokenFigures(*m_scene.series, frame.number);
        frame.figures.problem.clear();
        frame.staticFigures = frame.figures;
        take(made["figures"], frame.figures);
        take(made["static"], frame.staticFigures);
        frame.tf = tfFromJson(made["tf"], fileOf(m_o, frame.number, kTfSuffix));
    }
}

/// Figures and pictures of frames, side by side.
void Sequence::finish(std::vector<Frame>& batch) {
    agree(batch);
    std::vector<Frame*> mine;
    for (Frame& frame : batch) {
        if (!frame.problem.empty()) continue;
        if (m_before && (m_o.overGaps || neighbourBefore(*m_scene.series, frame.number, false) == m_beforeNumber))
            frame.before = m_before;
        else if (m_before)
            m_afterGaps.push_back(frame.number);
        m_before = frame.tf;
        m_beforeNumber = frame.number;
        if (isMine(frame)) mine.push_back(&frame);
    }
    {
        const auto alone = apart();
        // What the frames had their transfer functions from goes on with a single one, but not apart from other ranks.
        const bool goesOn = mine.size() == 1 && m_work.parts == 1;
        parallelFor(mine.size(),
                    [&](std::size_t i) { draw(*mine[i], goesOn ? m_maker.workspace() : m_sideBySide[i]); });
        if (m_work.parts > 1) m_sideBySide.front() = {}; // its memory is wanted for the frames to come
    }
    gather(batch);
    for (Frame& frame : batch) {
        if (!frame.problem.empty()) {
            m_figures.push_back(brokenFigures(*m_scene.series, frame.number));
            if (m_o.compare) m_static.push_back(m_figures.back());
            continue;
        }
        if (frame.made) {
            frame.figures.moves = frame.made->moves;
            frame.figures.seconds = frame.made->seconds;
            if (frame.made->energy) frame.figures.energy = frame.made->energy->movableAfter;
        }
        if (m_priority.is_null() && frame.made && frame.made->energy)
            m_priority = m_o.priority.told(*m_scene.session.refine, frame.made->priority);
        m_frames.push_back(jsonOf(frame));
        m_figures.push_back(frame.figures);
        if (m_o.compare) m_static.push_back(frame.staticFigures);
        if (!m_o.noPictures) m_pictures.push_back(fileOf(m_o, frame.number, kPictureSuffix));
    }
    batch.clear();
}

TemporalCurves Sequence::curves() const {
    TemporalCurves curves;
    for (const Feature& f : m_scene.tf.features) {
        curves.features.push_back(f.name);
        curves.colors.push_back(f.color);
    }
    curves.runs.push_back({name(settings().mode), m_figures});
    if (m_o.compare) curves.runs.push_back({"static", m_static});
    return curves;
}

std::string framesOf(int some, int all) {
    return std::to_string(some) + " of " + std::to_string(all) + (all == 1 ? " frame" : " frames");
}

/// Where targets were not reached, and why where that can be seen; what has no target; what has no flicker.
void Sequence::tellMissed(const SequenceFigures& figures) {
    const bool isAimed = settings().mode == Mode::Optimize || m_o.targets;
    const double tolerance = m_scene.session.optimize->tolerance;
    const std::vector<Feature>& features = m_scene.tf.features;
    std::vector<int> unseen(features.size(), 0), empty(features.size(), 0);
    for (const FrameFigures& f : m_figures)
        for (std::size_t i = 0; i < features.size() && f.problem.empty(); ++i) {
            unseen[i] += !(f.objective < tolerance) && f.targets[i] > 0 && f.vws[i] < 1e-6 ? 1 : 0;
            empty[i] += f.empty[i] ? 1 : 0;
        }
    if (isAimed && figures.above > 0)
        m_notices.push_back(framesOf(figures.above, figures.frames) + (figures.above == 1 ? " is" : " are") +
                            " not within " + percentText(tolerance) + " of the targets; the farthest, frame " +
                            std::to_string(figures.worst) + ", is " + offTargetText(figures.worstObjective) +
                            (settings().mode == Mode::Optimize && !m_scene.session.optimize->exactShares
                                 ? "; shares that can hardly be seen give way (--exact-shares meets them)"
                                 : ""));
    for (std::size_t i = 0; i < features.size(); ++i) {
        if (isAimed && unseen[i] > 0)
            m_notices.push_back("nothing of '" + features[i].name + "' is seen in " + std::to_string(unseen[i]) +
                                " of the frames that are not on target: choose a range (--range) or features that all "
                                "frames have");
        if (empty[i] > 0)
            m_notices.push_back("'" + features[i].name + "' is empty in " + framesOf(empty[i], figures.frames) +
                                ": no voxel has its values, and it has no target there");
    }
    if (!m_afterGaps.empty())
        m_notices.push_back(
            "frame " + std::to_string(m_afterGaps.front()) +
            (m_afterGaps.size() > 1 ? " and " + std::to_string(m_afterGaps.size() - 1) + " more follow" : " follows") +
            " a gap in the series, so " + (m_afterGaps.size() > 1 ? "their" : "its") +
            " flicker is not reported (--flicker-over-gaps compares with the frame before the gap)");
}

std::string coherenceText(double coherence) { return std::isinf(coherence) ? "infinite" : plainText(coherence); }

std::string Sequence::text(const SequenceFigures& dynamic, const std::optional<SequenceFigures>& asStatic) const {
    const bool refines = settings().mode == Mode::Refine;
    std::vector<std::string> columns{"frame", "F", "flicker", "moves", "seconds"};
    if (refines) columns.emplace_back("energy");
    Table table(columns);
    for (const FrameFigures& f : m_figures) {
        std::vector<std::string> row{std::to_string(f.frame), f.problem.empty() ? fixedText(f.objective, 4) : "broken",
                                     f.flicker ? fixedText(*f.flicker, 3) : "-",
                                     f.moves ? std::to_string(*f.moves) : "-", f.moves ? fixedText(f.seconds, 3) : "-"};
        if (refines) row.push_back(f.energy ? plainText(*f.energy) : "-");
        table.add(row);
    }
    std::string text = table.text() + name(settings().mode);
    if (refines) text += ", priority " + textOfPriority(m_priority) + profileText(*m_scene.session.measure);
    if (settings().mode != Mode::Static) text += ", coherence " + coherenceText(settings().usedCoherence());
    text += ": RMS of F " + fixedText(dynamic.rms, 4) + " (largest " + fixedText(dynamic.worstObjective, 4) +
            ", frame " + std::to_string(dynamic.worst) + "), flicker " + fixedText(dynamic.flicker, 3) + " on average";
    if (settings().mode != Mode::Static)
        text += ", " + fixedText(dynamic.moves, 2) + " moves and " + secondsText(dynamic.seconds) + " a frame";
    text += "\n";
    if (asStatic) text += "static: RMS of F " + fixedText(asStatic->rms, 4) + "\n";
    return text + "wrote " + std::to_string(m_frames.size()) + (m_frames.size() == 1 ? " frame" : " frames") +
           " and curves.csv, curves.svg, curves.png to " + m_o.out + (m_o.movie ? ", and " + *m_o.movie : "") + "\n";
}

Json jsonFromFigures(const SequenceFigures& f) {
    return {{"rms", f.rms}, {"flicker", f.flicker}, {"moves", f.moves}, {"seconds", f.seconds}};
}

Json Sequence::json(const SequenceFigures& dynamic, const std::optional<SequenceFigures>& asStatic) const {
    Json json{{"command", "sequence"}, {"mode", name(settings().mode)}};
    if (settings().mode != Mode::Static) {
        const double coherence = settings().usedCoherence();
        json["coherence"] = std::isinf(coherence) ? Json("infinite") : Json(coherence);
    }
    if (settings().mode == Mode::Refine) json["priority"] = m_priority;
    addProfile(json, *m_scene.session.measure);
    json["volume"] = jsonFromVolume(*m_scene.volume);
    addMapping(json, m_scene);
    json["from"] = m_start;
    json["frames"] = m_frames;
    json["broken"] = Json::array();
    for (const FrameFigures& f : m_figures)
        if (!f.problem.empty()) json["broken"].push_back({{"frame", f.frame}, {"problem", f.problem}});
    json["mean"] = jsonFromFigures(dynamic);
    json["worst"] = {{"frame", dynamic.worst}, {"objective", dynamic.worstObjective}};
    json["above_tolerance"] = dynamic.above;
    if (asStatic) json["static"] = {{"rms", asStatic->rms}};
    for (const char* name : kCurves) json["files"].push_back(inFolder(m_o, name));
    if (m_o.movie) json["files"].push_back(*m_o.movie);
    return json;
}

Answer Sequence::run(const Opened& opened) {
    const Stopwatch total;
    prepareKey();
    m_work = divided();
    std::error_code failure;
    fs::create_directories(m_o.out, failure);
    if (failure && !fs::is_directory(m_o.out))
        throw FileError("the folder cannot be created: " + failure.message(), m_o.out, "give another one to --out");
    requireSharedFolder();
    const TimeSeries& series = *m_scene.series;
    ReadAhead ahead(m_scene.series, windowOf(m_scene.session.variable(), *m_scene.series, {interruptToken(), {}}));
    if (smooths(settings())) plan(ahead); // all frames are looked at before one is drawn
    const JobControl job = m_progress.phase("frames");
    // Contexts of GL are not shared by threads; threads share a CPU well.
    const bool cpu = makeRenderer(m_scene.session.measure->engine, m_scene.volume)->name() == "cpu" &&
                     m_maker.workspace().engine(measureInput(m_scene)).name() != "gl";
    const int most = m_work.parts > 1           ? static_cast<int>(m_work.parts)
                     : cpu && !isOneOfSeveral() ? std::clamp(series.roomFor() - 1, 1, threadCount())
                                                : 1;
    m_sideBySide = std::vector<Workspace>(static_cast<std::size_t>(most));
    std::vector<Frame> batch;
    for (int number = m_start; number < series.size(); ++number) {
        job.throwIfStopped();
        ahead.begin(number + 1);
        batch.push_back(next(number));
        if (static_cast<int>(batch.size()) == most) finish(batch);
        job.report((number + 1.0 - m_start) / (series.size() - m_start));
    }
    finish(batch);
    if (m_priority.is_null() && settings().mode == Mode::Refine) { // all frames were refined before
        const auto alone = apart();
        m_priority = m_o.priority.told(*m_scene.session.refine, refinePriority(m_scene, {interruptToken(), {}}));
    }
    if (m_frames.empty()) throw Error("no frame can be read", series.listing().title, "check its files");

    m_progress.phase("writing");
    const TemporalCurves all = curves();
    const std::vector<Plot> plots = temporalPlots(all);
    const PlotPage page{.width = 640, .height = 260};
    writeTextAtomically(inFolder(m_o, kCurves[0]), csvOf(all));
    writeTextAtomically(inFolder(m_o, kCurves[1]), svgOf(plots, page));
    writeImage(imageOf(plots, page), inFolder(m_o, kCurves[2]));
    if (m_o.movie)
        writeMovie(m_pictures, m_o.framesPerSecond.value_or(kFramesPerSecond), *m_o.movie,
                   m_progress.phase("film").stop);

    const double tolerance = m_scene.session.optimize->tolerance;
    const SequenceFigures dynamic = summaryOf(m_figures, tolerance);
    std::optional<SequenceFigures> asStatic;
    if (m_o.compare) asStatic = summaryOf(m_static, tolerance);
    tellMissed(dynamic);
    Answer answer{text(dynamic, asStatic), json(dynamic, asStatic), opened.notices()};
    answer.notices.insert(answer.notices.end(), m_notices.begin(), m_notices.end());
    answer.json["seconds"] = {{"key", m_keySeconds}, {"total", total.seconds()}};
    if (m_o.requireConverged && dynamic.above > 0)
        answer.failure = Error("the targets were not reached in " + framesOf(dynamic.above, dynamic.frames) +
                                   " (objective up to " + plainText(dynamic.worstObjective) + " in frame " +
                                   std::to_string(dynamic.worst) + ", wanted below " + plainText(tolerance) + ")",
                               name(settings().mode), "lower --coherence, raise --tolerance, or choose other targets");
    return answer;
}

Answer run(const SequenceArguments& o, Progress& progress) {
    check(o);
    if (o.adapt.values().mode == Mode::Optimize && !o.targets && !o.scene.sessionFile)
        throw isRequired("--target", "sequence");
    Opened opened;
    divideFrames(true);
    SceneInputs inputs = inputsOf(o.scene, {toMeasureAndDrawField(), true}, opened.sessionNotices);
    if (o.from || !inputs.frame) inputs.frame = o.from.value_or(0); // wherever the session was left
    opened.scene = openScene(inputs, progress.phase("loading"));
    o.scene.tf.applyTo(opened.scene);
    o.scene.picture.applyTo(opened.scene);
    announceFrames(o, opened.scene.session.frame, opened.scene.series->size());
    return Sequence(o, opened.scene, progress).run(opened);
}

} // namespace

Command addSequence(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "sequence", "Draws and measures the frames of a series, each under a transfer function that may follow them");
    const auto o = std::make_shared<SequenceArguments>();
    o->scene.addForFigures(*app, VolumeOptions::SizeIs::ImageWithRegion);
    o->adapt.add(*app);
    o->priority.add(*app, o->scene.volume);
    o->steps.add(*app);
    addValue(
        *app, "--target", kTargetForms, o->targets, TargetInput::parse,
        "shares of attention, as in optimize; the first frame's transfer function is optimized to them, in every mode");
    o->search.add(*app, "Options", {"tolerance", "exact_shares"});
    addValue(*app, "--from", "FRAME", o->from, wholeFrom(0, 1'000'000'000),
             "begin with this frame of the series (default 0)");
    app->add_flag("--compare", o->compare,
                  "also measure and draw every frame under the transfer function of the first one");
    addOutputFolder(*app, "--out", o->out,
                    "write frame_0000.png and frame_0000.tf.json of each frame, curves.csv, curves.svg and curves.png")
        ->required();
    app->add_flag("--flicker-over-gaps", o->overGaps,
                  "report flicker after missing or broken frames, too, by comparing with the frame before the gap");
    app->add_flag(
        "--2dfs", o->pictured,
        "also tell each feature's 2D feature saliency, its share of what catches the eye in the picture of the "
        "frame, and draw its curves");
    app->add_flag("--no-pictures", o->noPictures, "do not write pictures of the frames");
    addOutputFile(*app, "--mp4", o->movie, "also write a film of the pictures; needs ffmpeg", checkMovieSuffix);
    addValue(*app, "--fps", "N", o->framesPerSecond, realAbove(0, 240), "frames per second of the film (default 10)");
    app->add_flag("--require-converged", o->requireConverged,
                  "exit with status 1 if a frame is not on target; everything is written all the same");
    o->scene.picture.add(*app, PictureOptions::Mode::OfSession);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
