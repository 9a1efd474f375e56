#include "controllers/comparison_controller.h"

#include <algorithm>

#include <QTime>

#include "controllers/player_controller.h"
#include "controllers/refine_controller.h"
#include "dialogs/ask_file.h"
#include "dialogs/ask_preset.h"
#include "image_io/image_file.h"
#include "report/comparison_files.h"
#include "services/services.h"
#include "session/scene_data.h"
#include "session/session_json.h"
#include "store/edits.h"
#include "tf/formats/tf_file.h"

namespace pellucid::gui {
namespace {

/// Where features have no identities, they are found by their names.
TransferFunction withoutIdentities(TransferFunction tf) {
    for (Feature& feature : tf.features) feature.id = 0;
    return tf;
}

} // namespace

QString nameByClock(const QString& text) { return text.arg(QTime::currentTime().toString("HH:mm:ss")); }

/// What computes sides. Used on the lane of the figures alone.
class ComparisonController::Worker {
public:
    explicit Worker(Workspace& ofFigures) : m_ofFigures(ofFigures) {}

    std::array<Side, 2> compare(const Request& request, const JobControl& job) {
        std::array<Side, 2> sides = request.known;
        const auto& [a, b] = request.inputs;
        if (!sides[0]) {
            const Measures measures =
                request.measuresOfA ? *request.measuresOfA : m_ofFigures.measure(a.measure, job.part(0, 4));
            sides[0] = drawn(a, measures, *m_renderers[0], job.part(1, 4));
        }
        if (sides[1]) return sides;
        // Of the same colours both have the same weights, which are half of the memory.
        const bool alike = WeightsOf(a.measure) == WeightsOf(b.measure);
        if (alike) m_own.reset();
        if (!alike && !m_own) m_own = std::make_unique<Workspace>();
        const Measures measures = (alike ? m_ofFigures : *m_own).measure(b.measure, job.part(2, 4));
        KeptRenderer& renderer = *m_renderers[a.picture.volume == b.picture.volume ? 0 : 1];
        sides[1] = drawn(b, measures, renderer, job.part(3, 4));
        return sides;
    }
    void release() {
        m_own.reset();
        for (const auto& renderer : m_renderers) renderer->release();
    }

private:
    static Side drawn(const SideInput& input, const Measures& measures, KeptRenderer& renderer, const JobControl& job) {
        return renderer.use(input.picture.volume, job, [&](ImageRenderer& r) {
            return std::make_shared<const ComparedSide>(comparedSide(input, measures, r, job));
        });
    }

    Workspace& m_ofFigures;
    std::unique_ptr<Workspace> m_own; ///< of B, where its colours are others
    std::array<std::shared_ptr<KeptRenderer>, 2> m_renderers{std::make_shared<KeptRenderer>(),
                                                             std::make_shared<KeptRenderer>()};
};

ComparisonController::ComparisonController(Services& services, PlayerController& player, RefineController& refining)
    : m_services(services), m_player(player), m_refining(refining),
      m_worker(std::make_shared<Worker>(services.workspace())),
      m_fetching(
          [](const Fetch& fetch, const JobControl& job) {
              Scene scene = resolve(fetch.session, fetch.basis, {}, job);
              prepareToShow(scene, job);
              return scene;
          },
          [this](const Fetch&, Scene& scene) {
              showB(std::move(scene));
              followFigures();
          }),
      m_comparing(
          [worker = m_worker](const Request& request, const JobControl& job) { return worker->compare(request, job); },
          [this](const Request& request, std::array<Side, 2>& sides) { keep(request, sides); }, WhenBusy::StopOld,
          &services.compute()),
      m_saving(
          [](const Task& task, const JobControl&) {
              const std::string path = task.path.toStdString();
              if (task.file == File::SideBySide)
                  writeImage(sideBySide(task.comparison.imageA, task.comparison.imageB), path);
              else if (task.file == File::Difference)
                  writeDifference(task.comparison.difference, path);
              else
                  writeFigures(task.comparison, path);
              return task.path;
          },
          [this](const Task&, const QString& path) {
              m_services.saySaved(path);
              Q_EMIT saved(path);
          },
          WhenBusy::Queue) {
    connect(&services.store(), &SessionStore::changed, this, &ComparisonController::follow);
    connect(&m_comparing, &JobBase::failed, this, &ComparisonController::fail);
    connect(&m_fetching, &JobBase::failed, this, [this](const Error& error) {
        m_sceneB.reset();
        fail(error);
        Q_EMIT sceneChanged();
    });
    connect(&m_comparing, &JobBase::progress, this, [this](double fraction) {
        m_progress = fraction;
        Q_EMIT changed();
    });
    connect(&m_saving, &JobBase::busyChanged, this, &ComparisonController::busyChanged);
    services.showFailuresOf(m_saving, tr("Cannot save the comparison"));
}

const ComparisonView& ComparisonController::view() const { return *m_services.store().session().comparison; }

// ---- which state B is

ComparedState ComparisonController::present(const QString& name) const {
    return comparedState(m_services.scene(), name.toStdString());
}

void ComparisonController::compareWith(ComparedState b, const std::function<void(ComparisonView&)>& how) {
    change([&](ComparisonView& view) {
        const CompareMode mode = view.mode == CompareMode::Off ? CompareMode::SideBySide : view.mode;
        view.b = std::move(b);
        view.mode = mode;
        view.sameView = view.sameFrame = view.sameLook = true;
        if (how) how(view);
    });
    m_services.panels().show("compare");
}

void ComparisonController::pin() {
    if (m_services.store().hasVolume()) compareWith(present(nameByClock(tr("Pinned at %1"))));
}

void ComparisonController::compareWithTf(const QString& spec, const QString& name) {
    m_services.attempt(tr("Cannot compare with the transfer function"), [&] {
        const ReadTf read = readTfNamed(spec.toStdString());
        TransferFunction tf = withoutIdentities(forScene(read, m_services.scene()));
        placeAsPublished(m_services.scene().session, *m_services.scene().data, tf);
        ComparedState b = present(name);
        b.tf = std::move(tf);
        compareWith(std::move(b));
    });
}

void ComparisonController::compareWithSession(const QString& path) {
    m_services.attempt(tr("Cannot compare with the session"), [&] {
        const Session session = readSession(path.toStdString()).session;
        if (session.isEmpty() || session.tf() == nullptr)
            throw Error("the session has no transfer function", path.toStdString(),
                        "open it and save it with one, or choose another session");
        ComparedState b = comparedState(session, QFileInfo(path).fileName().toStdString());
        b.tf = withoutIdentities(*b.tf);
        b.display.edit([](DisplaySettings& d) { d.onlyFeature = 0; }); // a number of that session
        if (!b.camera) b.camera = m_services.scene().camera;
        if (!sameData(*session.variables, *m_services.scene().session.variables))
            m_services.notices().add(
                {tr("%1 was saved with other data. Its transfer function and view are compared on the data that are "
                    "open.")
                     .arg(QFileInfo(path).fileName())});
        const bool otherFrame = b.frame != m_services.scene().session.frame;
        compareWith(std::move(b), [&](ComparisonView& view) {
            view.sameLook = false;
            view.sameFrame = !otherFrame;
        });
    });
}

void ComparisonController::compareWithStep(int step) {
    const SessionStore& store = m_services.store();
    if (step < 0 || step >= store.stepCount() || store.sessionBefore(step).tf() == nullptr) return;
    ComparedState b = present(tr("Before: %1").arg(store.textOf(step)));
    const Session& before = store.sessionBefore(step);
    b.tf = *before.tf();
    b.display = before.display;
    b.clipping = before.clipping;
    compareWith(std::move(b), [](ComparisonView& view) { view.sameLook = false; });
}

const Run* ComparisonController::latestRun() const {
    const std::vector<Run>& runs = *m_services.store().session().runs;
    const auto run =
        std::find_if(runs.rbegin(), runs.rend(), [](const Run& r) { return r.kind == "optimize" && r.hasStart(); });
    return run == runs.rend() ? nullptr : &*run;
}

void ComparisonController::compareWithRun() {
    const Run* const run = latestRun();
    if (run == nullptr) return;
    ComparedState b = present(tr("Before the optimization"));
    b.tf = run->start->tf;
    compareWith(std::move(b));
}

bool ComparisonController::hasRefinement() const { return m_refining.latest() != nullptr; }

void ComparisonController::compareWithRefinement() {
    const Refinement* const refinement = m_refining.latest();
    if (refinement == nullptr) return;
    ComparedState b = present(tr("Before the refinement"));
    b.tf = refinement->before;
    compareWith(std::move(b));
}

void ComparisonController::compareWithFrame(int frame) {
    ComparedState b = present(tr("Frame %1").arg(frame));
    b.frame = frame;
    compareWith(std::move(b), [](ComparisonView& view) { view.sameFrame = false; });
}

void ComparisonController::compareWithView(StandardView standard) {
    const Scene& scene = m_services.scene();
    const Geometry& geometry = scene.volume->geometry();
    const ViewAngles angles = anglesOf(standard, geometry.worldAxes);
    ComparedState b = present(tr("View: %1").arg(name(standard, geometry.worldAxes)));
    b.camera = standardCamera(geometry, angles.azimuth, angles.elevation, scene.camera.projection);
    compareWith(std::move(b), [](ComparisonView& view) { view.sameView = false; });
}

void ComparisonController::change(const std::function<void(ComparisonView&)>& change) {
    m_services.store().setComparison(change);
}

void ComparisonController::setMode(CompareMode mode) {
    change([mode](ComparisonView& view) { view.mode = view.mode == mode ? CompareMode::Off : mode; });
}

void ComparisonController::turnB(const Camera& camera, int gesture) {
    if (view().sameView) return m_services.store().setCamera(camera, gesture);
    change([&](ComparisonView& view) {
        if (view.b) view.b->camera = camera;
    });
}

void ComparisonController::useB() {
    if (!hasB() || !m_services.isEditable()) return;
    m_services.store().edit(tr("Use the transfer function of B"), {},
                            [tf = *view().b->tf](Session& session) { session.setTf(tf); });
}

void ComparisonController::swap() {
    if (!hasB() || !m_services.isEditable()) return;
    const ComparisonView old = view();
    const ComparedState b = *old.b;
    ComparedState a = present(nameByClock(tr("A until %1")));
    if (old.sameView) a.camera = b.camera;
    if (old.sameFrame) a.frame = b.frame;
    m_services.store().edit(tr("Swap A and B"), {}, [&](Session& session) {
        session.comparison.edit([&](ComparisonView& view) { view.b = a; });
        session.setTf(*b.tf);
        if (old.sameLook) return;
        session.display = b.display;
        session.clipping = b.clipping;
    });
    if (!old.sameView && b.camera) m_services.store().setCamera(*b.camera);
    if (!old.sameFrame) m_player.goTo(b.frame);
}

void ComparisonController::clear() {
    change([](ComparisonView& view) {
        view.b.reset();
        view.mode = CompareMode::Off;
    });
}

// ---- following

void ComparisonController::setPictureSize(const QSize& pixels) {
    if (pixels == m_size) return;
    m_size = pixels;
    if (m_state != State::Off) follow();
}

void ComparisonController::reset() {
    m_rest.stop();
    m_fetching.cancel();
    m_comparing.cancel();
    if (m_state != State::Off) // on the lane, where nobody else uses it
        m_services.compute().submit([worker = m_worker] { worker->release(); });
    m_sceneB.reset();
    m_wantedB = {};
    m_comparison.reset();
    m_sides = {};
    m_wanted = m_compared = {};
    m_failure.reset();
}

void ComparisonController::follow() {
    const Scene& scene = m_services.scene();
    const bool field = scene.volume && scene.session.field->kind.has_value();
    if (!scene.volume || !view().isOn() || field) {
        const State state = scene.volume && view().isOn() && field ? State::Field : State::Off;
        if (m_state != State::Off && m_state != State::Field) reset();
        setState(state);
        Q_EMIT sceneChanged();
        return;
    }
    if (followB()) followFigures();
    Q_EMIT sceneChanged();
}

/// Its scene, of the data at hand where these suffice. False: there is none.
bool ComparisonController::followB() {
    const Scene& scene = m_services.scene();
    Session wanted = comparedSession(scene.session);
    const bool hasData = m_sceneB && (m_sceneB->volume == scene.volume || !view().sameFrame);
    if (hasData && wanted == m_wantedB) return true;
    m_wantedB = wanted;
    m_fetching.cancel();
    try {
        if (!needsData(wanted, scene))
            showB(resolve(std::move(wanted), scene));
        else if (m_sceneB && m_sceneB->series == scene.series && !needsData(wanted, *m_sceneB))
            showB(resolve(std::move(wanted), Scene(*m_sceneB)));
        else
            m_fetching.start({std::move(wanted), scene}, tr("the frame of B"));
        return true;
    } catch (const Error& error) {
        m_sceneB.reset();
        fail(error);
        return false;
    }
}

void ComparisonController::showB(Scene scene) {
    m_sceneB = std::move(scene);
    Q_EMIT sceneChanged();
}

void ComparisonController::followFigures() {
    if (!m_sceneB || m_size.isEmpty() || m_fetching.isRunning()) {
        m_rest.stop();
        m_comparing.cancel();
        m_wanted = {};
        return setState(State::Computing);
    }
    const Scene& a = m_services.scene();
    const bool saliency = a.session.pictureSaliency->on;
    const auto inputOf = [&](const Scene& scene) {
        return sideInput(scene, pictureInput(scene, m_size.width(), m_size.height()), saliency);
    };
    Inputs wanted{inputOf(a), inputOf(*m_sceneB)};
    if (m_comparison && wanted == m_compared && m_comparison->b != view().b->name) {
        m_comparison->b = view().b->name; // pinned again, as it was
        ++m_version;
        Q_EMIT changed();
    }
    if (wanted == m_wanted && (m_state == State::Computing || m_state == State::Current)) return;
    m_wanted = std::move(wanted);
    m_failure.reset();
    m_comparing.cancel();
    m_rest.stop();
    if (m_comparison && m_wanted == m_compared) {
        ++m_version;
        return setState(State::Current);
    }
    m_progress = 0;
    m_rest.start();
    setState(State::Computing);
}

void ComparisonController::begin() {
    const Results& results = m_services.results();
    Request request{m_wanted, {}, {}};
    if (results.measuresAreCurrent()) request.measuresOfA = *results.measures();
    if (m_comparison && m_wanted.a == m_compared.a) request.known[0] = m_sides[0];
    if (m_comparison && m_wanted.b == m_compared.b) request.known[1] = m_sides[1];
    m_comparing.start(std::move(request), tr("the comparison"));
}

void ComparisonController::keep(const Request& request, std::array<Side, 2>& sides) {
    m_compared = request.inputs;
    m_sides = sides;
    try {
        m_comparison = comparisonOf(tr("now").toStdString(), *sides[0], view().b->name, *sides[1]);
    } catch (const Error& error) {
        return fail(error);
    }
    ++m_version;
    setState(State::Current);
}

void ComparisonController::fail(const Error& error) {
    m_failure = error;
    setState(State::Failed);
}

void ComparisonController::setState(State state) {
    if (m_state == State::Off && state == State::Off) return;
    m_state = state;
    Q_EMIT changed();
    Q_EMIT busyChanged();
    m_services.actions().refresh();
}

// ---- files

void ComparisonController::save(File file, const QString& path) {
    if (m_state != State::Current) return;
    m_saving.start({file, *m_comparison, path}, path);
    Q_EMIT busyChanged();
}

void ComparisonController::chooseFile(File file) {
    if (m_state != State::Current) return;
    struct Kind {
        QString title, name, filter;
        QStringList suffixes; ///< the first where none of them is given
    };
    const Kind kind = file == File::SideBySide ? Kind{tr("Save both pictures"),
                                                      "comparison.png",
                                                      tr("Pictures (*.png *.tif *.tiff *.exr *.jpg *.jpeg)"),
                                                      {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"}}
                      : file == File::Difference
                          ? Kind{tr("Save the difference"),
                                 "difference.exr",
                                 tr("Maps: OpenEXR with floats (*.exr), PNG with 16 bits (*.png)"),
                                 {".exr", ".png"}}
                          : Kind{tr("Save the figures"),
                                 "comparison.csv",
                                 tr("Figures: a table (*.csv), JSON (*.json)"),
                                 {".csv", ".json"}};
    const QString path = askSavePath(m_services.window(), kind.title, "imageFolder", kind.name, kind.filter, "", "");
    if (path.isEmpty()) return;
    const bool known = std::ranges::any_of(
        kind.suffixes, [&](const QString& suffix) { return path.endsWith(suffix, Qt::CaseInsensitive); });
    save(file, known ? path : path + kind.suffixes.front());
}

// ---- menus

void ComparisonController::addModes(ActionMenu& menu) {
    const auto add = [&](const char* id, const QString& text, const char* keys, const QString& tip, CompareMode mode) {
        menu.addCheck(
            id, text, keys, tip, [this, mode] { return hasB() && view().mode == mode; },
            [this, mode] {
                if (mode != CompareMode::Off && !hasB()) pin();
                change([mode](ComparisonView& view) { view.mode = mode; });
            });
    };
    add("compareSideBySideAction", tr("&Side by side"), "Ctrl+Alt+S",
        tr("The present state A on the left, B on the right; turning one turns the other"), CompareMode::SideBySide);
    add("compareWipeAction", tr("&Wipe"), "Ctrl+Alt+W",
        tr("A and B in one picture, with a border between them that the mouse or the arrow keys move"),
        CompareMode::Wipe);
    add("compareDifferenceAction", tr("&Difference"), "Ctrl+Alt+E",
        tr("How much the colours of A and B differ at each pixel, over the picture of A"), CompareMode::Difference);
    add("compareOffAction", tr("&A alone"), {}, tr("B is kept, but not shown"), CompareMode::Off);
}

void ComparisonController::addChoices(ActionMenu& menu) {
    m_actions.run = menu.add("compareRunAction", tr("Before the latest &optimization"), {},
                             tr("Compare with what the latest optimization began with"), [this] { compareWithRun(); },
                             {.enabled = [this] { return m_services.store().hasVolume() && latestRun() != nullptr; }});
    m_actions.refinement =
        menu.add("compareRefinementAction", tr("Before the latest &refinement"), {},
                 tr("Compare with what the latest refinement began with"), [this] { compareWithRefinement(); },
                 {.enabled = [this] { return m_services.store().hasVolume() && hasRefinement(); }});
    m_actions.tf = menu.add("compareTfAction", tr("&Transfer function file…"), {},
                            tr("Compare with the present state under the transfer function of a file"), [this] {
                                const QStringList paths = askOpenPaths(
                                    m_services.window(), tr("Compare with a transfer function"), "tfFolder",
                                    tr("Transfer functions (%1 *.json);;All files (*)").arg(tfPatterns()));
                                if (paths.isEmpty()) return;
                                const QString one = askPreset(paths.front(), m_services.window());
                                if (!one.isEmpty()) compareWithTf(one, nameOfPreset(one));
                            });
    m_actions.session =
        menu.add("compareSessionAction", tr("Sess&ion file…"), {},
                 tr("Compare with the transfer function, view, frame, light and clipping of a saved session"), [this] {
                     const QStringList paths = askOpenPaths(m_services.window(), tr("Compare with a session"),
                                                            "sessionFolder", tr("Sessions (*.pellucid.json)"));
                     if (!paths.isEmpty()) compareWithSession(paths.front());
                 });
}

void ComparisonController::addFiles(ActionMenu& menu) {
    const auto isCurrent = [this] { return m_state == State::Current; };
    menu.separate();
    m_actions.savePictures =
        menu.add("saveSideBySideAction", tr("Save &both pictures…"), {}, tr("A and B as one picture, side by side"),
                 [this] { chooseFile(File::SideBySide); }, {.enabled = isCurrent});
    m_actions.saveDifference = menu.add("saveDifferenceAction", tr("Save di&fference…"), {},
                                        tr("The colour difference of each pixel, as OpenEXR or PNG"),
                                        [this] { chooseFile(File::Difference); }, {.enabled = isCurrent});
    m_actions.saveFigures =
        menu.add("saveComparedAction", tr("Save fi&gures…"), {}, tr("The figures of A and B as a table or as JSON"),
                 [this] { chooseFile(File::Figures); }, {.enabled = isCurrent});
}

void ComparisonController::addActions() {
    const auto hasVolume = [this] { return m_services.store().hasVolume(); };
    ActionMenu menu(m_services.actions(), tr("&View") + "/" + tr("&Compare"), hasVolume);
    m_actions.pin = menu.add("comparePinAction", tr("&Pin as B"), "Ctrl+Alt+B",
                             tr("Keep transfer function, view and frame as they are now, to compare with what comes"),
                             [this] { pin(); });
    addChoices(menu);
    menu.separate();
    addModes(menu);
    menu.separate();
    const auto canTake = [this] { return m_services.isEditable() && hasB(); };
    m_actions.swap = menu.add("compareSwapAction", tr("S&wap A and B"), {},
                              tr("B becomes what is edited, and A what it is compared with"), [this] { swap(); },
                              {.enabled = canTake});
    m_actions.use =
        menu.add("compareUseAction", tr("&Use B"), {}, tr("The transfer function of B becomes the present one"),
                 [this] { useB(); }, {.enabled = canTake});
    m_actions.clear =
        menu.add("compareClearAction", tr("&Clear"), {}, tr("Forget B, and show A alone"), [this] { clear(); },
                 {.enabled = [this] { return m_services.store().hasVolume() && hasB(); }});
    addFiles(menu);
    connect(&m_refining, &RefineController::refined, &m_services.actions(), &Actions::refresh);
    const QString border = tr("Border of a wipe");
    m_services.actions().addGestures({{border, tr("Left drag, Left, Right, Home, End"), tr("move it")},
                                      {border, tr("Double-click"), tr("put it in the middle")}});
}

} // namespace pellucid::gui
