#include "controllers/view_search_controller.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "controllers/optimize_controller.h"
#include "optimize/answer/visibility_words.h"
#include "optimize/objective.h"
#include "render/view_direction.h"
#include "services/services.h"
#include "tf/shown_tf.h"
#include "widgets/terms.h"

namespace pellucid::gui {

bool ViewSearchController::Question::operator==(const Question& other) const {
    const Camera &a = input.view.camera, &b = other.input.view.camera;
    if (input.volume != other.input.volume || a.projection != b.projection) return false;
    // The eye goes round on a sphere, but for rounding. Of a parallel view no distance counts, of none the zoom.
    const double rounding = 1e-6 * input.volume->geometry().radius();
    const double way = a.projection == Projection::Orthographic ? 0 : glm::length(a.eye - b.eye);
    return glm::length(a.center - b.center) < rounding && way < rounding && input.tf == other.input.tf &&
           input.view.clipping == other.input.view.clipping && input.settings == other.input.settings &&
           metric == other.metric;
}

ViewSearchController::ViewSearchController(Services& services, OptimizeController& optimizing)
    : m_services(services), m_optimizing(optimizing),
      m_judging(
          [this, &workspace = services.workspace()](const Judgement& task, const JobControl& job) {
              return m_views.best(workspace, task.input, task.search, {job.stop, {}});
          },
          [this](const Judgement&, BestView& best) {
              m_map = best.map;
              m_best = best;
          },
          WhenBusy::StopOld, &services.compute()),
      m_joint(
          [&workspace = services.workspace()](const JointTask& task, const JobControl& job) {
              ViewWorkspace views;
              return optimizeViewAndOpacities(workspace, views, task.input, task.question.metric.targets, task.limits,
                                              task.options, job);
          },
          [this](const JointTask& task, ViewAndOpacities& found) { finish(task, found); }, WhenBusy::StopOld,
          &services.compute()),
      m_search(
          [this](const Task& task, const JobControl& job) {
              const auto watch = [&](const ViewMap& map) {
                  if (!job.stop.stop_requested())
                      m_search.post([this, map, number = task.number] { grow(number, map); });
              };
              return m_views.search(task.question.input, task.question.metric, kSphereViews, job, watch);
          },
          [this](const Task& task, ViewSearch& search) {
              if (task.number != m_number) return;
              m_map = search.map;
              m_whole = true;
              if (!isCurrent()) return;
              MeasureInput input = task.question.input;
              input.view.camera = m_services.scene().camera;
              m_judging.start({std::move(input), std::move(search)}, tr("the best view"));
          },
          WhenBusy::StopOld, &m_lane) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_search, &m_judging, &m_joint}) {
        connect(job, &JobBase::busyChanged, this, &ViewSearchController::changed);
        connect(job, &JobBase::failed, this, [this](const Error& error) {
            m_stopped = true;
            m_services.showError(tr("No best view was found"), error);
        });
    }
    for (JobBase* job : std::initializer_list<JobBase*>{&m_search, &m_joint})
        connect(job, &JobBase::progress, this, [this](double fraction) {
            m_progress = fraction;
            Q_EMIT changed();
        });
    connect(&services.store(), &SessionStore::changed, this, &ViewSearchController::follow);
}

ViewSearchController::~ViewSearchController() { ++m_number; }

void ViewSearchController::addActions() {
    const auto ready = [this] { return m_services.store().hasVolume() && !m_services.scene().tf.features.empty(); };
    m_services.actions().add(
        tr("&View") + "/" + tr("&Look from"), "goToBestViewAction", tr("Go to the &best view"), "Shift+B",
        tr("The view that the panel Best view has found; where it has found none, it is looked for first"),
        [this] { goToBest(); }, ready);
    m_services.actions().add(
        tr("&Transfer function"), "optimizeViewAction", tr("Optimize &view and opacities"), "Ctrl+Shift+Return",
        tr("Finds the view and the opacities that together come nearest to the targets"), [this] { optimize(); },
        [this, ready] { return ready() && !m_services.isReadOnly() && !isOptimizing(); });
}

void ViewSearchController::startAtRest() {
    // Not while a hand or an optimization is at it.
    m_services.store().isPreviewing() || m_services.isReadOnly() ? m_wait.start() : start();
}

std::optional<ViewSearchController::Question> ViewSearchController::questionOf(FeatureId feature) const {
    const Scene& scene = m_services.scene();
    const auto& features = scene.tf.features;
    const bool allHidden = std::all_of(features.begin(), features.end(), [](const Feature& f) { return f.hidden; });
    if (!m_services.store().hasVolume() || allHidden || scene.session.measure->profile == Profile::Published) return {};
    Question question{measureInput(scene), {}};
    Camera& camera = question.input.view.camera;
    camera = lookingFrom(camera, scene.volume->geometry(), {0, -1, 0});
    const auto judged = std::find_if(features.begin(), features.end(),
                                     [feature](const Feature& f) { return feature != 0 && f.id == feature; });
    if (judged != features.end()) {
        question.metric.figure = ViewMetric::Figure::Vws;
        question.metric.feature = static_cast<std::size_t>(judged - features.begin());
    } else {
        question.metric.targets = scene.targets();
    }
    return question;
}

FeatureId ViewSearchController::feature() const {
    return m_present && m_present->metric.figure != ViewMetric::Figure::Objective ? m_feature : 0;
}

void ViewSearchController::setFeature(FeatureId feature) {
    if (feature == m_feature) return;
    m_feature = feature;
    follow();
    if (m_wanted && !isCurrent()) start(); // somebody has asked for it: no need to wait
}

bool ViewSearchController::isCurrent() const { return m_whole && m_present && m_asked && *m_present == *m_asked; }

void ViewSearchController::follow() {
    std::optional<Question> now = questionOf(m_feature);
    const bool same = now && m_present && *now == *m_present;
    const bool otherVolume = m_asked && (!now || now->input.volume != m_asked->input.volume);
    m_present = std::move(now);
    if (m_joint.isRunning()) {
        const std::optional<Question> about = questionOf(0);
        if (!about || !(*about == *m_jointQuestion)) m_joint.cancel();
    }
    if (otherVolume) { // a map of it says nothing here, and its memory is wanted
        cancel();
        ask({});
        m_lane.submit([this] { m_views.release(); });
    }
    if (!same) {
        m_stopped = false;
        // What is under way answers a question that nobody asks any more.
        if (isRunning() && !(m_present && m_asked && *m_present == *m_asked)) cancelSearch();
    }
    if (m_wanted && m_present && !m_stopped && !isRunning() && !isCurrent()) m_wait.start();
    if (!same) Q_EMIT changed();
}

void ViewSearchController::setWanted(bool wanted) {
    m_wanted = wanted;
    if (!wanted) {
        m_wait.stop();
        setGlimpse({});
    }
    follow();
}

void ViewSearchController::start() {
    m_wait.stop();
    m_present = questionOf(m_feature);
    if (!m_present || isRunning() || (isCurrent() && m_best)) return;
    m_stopped = false;
    ask(m_present);
    m_progress = 0;
    m_search.start({*m_present, ++m_number}, tr("the best view"));
    Q_EMIT changed();
}

void ViewSearchController::ask(const std::optional<Question>& question) {
    m_asked = question;
    m_map = {};
    m_best.reset();
    m_whole = false;
}

void ViewSearchController::cancel() {
    m_wait.stop();
    m_stopped = true;
    cancelSearch();
}

void ViewSearchController::cancelSearch() {
    m_search.cancel();
    m_judging.cancel();
}

void ViewSearchController::grow(int number, const ViewMap& map) {
    if (number != m_number || m_whole || !m_search.isRunning()) return;
    m_map = map;
    Q_EMIT changed();
}

Camera ViewSearchController::cameraFor(const Vec3& towardEye) const {
    const Scene& scene = m_services.scene();
    return lookingFrom(scene.camera, scene.volume->geometry(), towardEye);
}

void ViewSearchController::goTo(const Camera& camera) {
    setGlimpse({});
    m_services.store().setCamera(camera);
}

void ViewSearchController::goToBest() {
    if (!m_services.store().hasVolume()) return;
    if (isCurrent() && m_best) return goTo(m_best->best.camera);
    // It is looked for first, and gone to when it is known; whoever changes something meanwhile wants something else.
    start();
    const int number = m_number;
    auto* once = new QObject(this);
    connect(this, &ViewSearchController::changed, once, [this, once, number] {
        if (isRunning()) return;
        once->deleteLater();
        disconnect(this, nullptr, once, nullptr);
        if (number == m_number && isCurrent() && m_best) goTo(m_best->best.camera);
    });
}

void ViewSearchController::optimize() {
    SessionStore& store = m_services.store();
    if (isOptimizing() || m_services.isReadOnly()) return;
    store.commit();
    m_jointQuestion = questionOf(0);
    if (!m_jointQuestion) return;
    m_wait.stop();
    cancelSearch(); // it would only take time from this
    m_progress = 0;
    const Scene& scene = m_services.scene();
    m_joint.start({*m_jointQuestion, measureInput(scene), scene.tf, limitsOf(scene.tf, *scene.session.goals),
                   *scene.session.optimize, runStartOf(scene, *scene.session.optimize), QDateTime::currentDateTime()},
                  tr("the best view"));
    Q_EMIT changed();
}

void ViewSearchController::finish(const JointTask& task, const ViewAndOpacities& found) {
    SessionStore& store = m_services.store();
    const OptimizeState &start = found.result.history.front(), &best = found.result.history[found.result.best];
    const TransferFunction tf = withShownOpacities(task.tf, best.opacity);
    RunStart began = task.start;
    began.camera = found.input.view.camera;
    Run run = runOf(found.result, std::move(began));
    run.started = task.started.toString(Qt::ISODate).toStdString();
    run.seconds = static_cast<double>(task.started.msecsTo(QDateTime::currentDateTime())) / 1000;
    m_jointQuestion.reset();
    setGlimpse({});
    store.edit(tr("Optimize view and opacities"), {}, [&](Session& session) {
        session.setTf(tf);
        session.addRun(run);
    });
    store.setCamera(found.input.view.camera);
    m_services.results().addVws(found.input, tf, best.vws);
    const ViewAngles angles = viewAngles(found.input.view.camera, task.input.volume->geometry());
    const auto degrees = [](double value) { return QString::number(value, 'f', 0); };
    const std::string kept = keptText(found.result);
    m_optimizing.say((kept.empty() ? QString() : QString::fromStdString(kept) + ' ') +
                     (found.result.converged()
                          ? tr("On target from azimuth %1°, elevation %2°: %3, from %4.")
                          : tr("Not on target; the nearest view found is azimuth %1°, elevation %2°: %3, from %4."))
                         .arg(degrees(angles.azimuth), degrees(angles.elevation), terms().offTarget(best.objective),
                              terms().distanceText(start.objective)));
}

} // namespace pellucid::gui
