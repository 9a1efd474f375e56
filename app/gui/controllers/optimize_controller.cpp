#include "controllers/optimize_controller.h"

#include <QDateTime>

#include <algorithm>
#include <iterator>

#include "optimize/answer/visibility_words.h"
#include "services/services.h"
#include "services/verdict_choices.h"
#include "tf/shown_tf.h"
#include "widgets/terms.h"

namespace pellucid::gui {
namespace {

constexpr double kLeastStart = 1e-4; ///< opacity of a restart

} // namespace

QString sayOf(const OptimizeResult& result, int restarts) {
    const OptimizeState& best = result.history[result.best];
    QString way = (result.iterations() == 1 ? QObject::tr("from %1, in %2 move") : QObject::tr("from %1, in %2 moves"))
                      .arg(terms().distanceText(result.history.front().objective))
                      .arg(result.iterations());
    if (restarts > 0) way += QObject::tr("; restarted from the new view");
    const QString figures = QObject::tr("%1, %2").arg(terms().offTarget(best.objective), way);
    const std::string kept = keptText(result), faint = faintText(result);
    if (!kept.empty()) return QString::fromStdString(faint.empty() ? kept : kept + " " + faint) + " (" + figures + ")";
    if (!faint.empty()) // not without what makes it visible
        return QObject::tr("%1: %2 (%3)")
            .arg(result.converged() ? QObject::tr("On target, but faint") : QObject::tr("Faint"),
                 QString::fromStdString(faint), figures);
    if (result.reason == StopReason::Converged) return QObject::tr("On target, %1.").arg(way);
    return (result.reason == StopReason::NoProgress
                ? QObject::tr("Not on target: no move came nearer; %1. Looking for the reason…")
                : QObject::tr("Stopped at the limit of moves: %1."))
        .arg(figures);
}

OptimizeController::OptimizeController(Services& services)
    : m_services(services),
      m_job(
          [this, &workspace = services.workspace()](const Task& task, const JobControl& job) {
              int move = 0;
              const auto watch = [&](const OptimizeState& state) {
                  if (job.stop.stop_requested()) return;
                  m_job.post([this, task, state, number = move++] { showMove(task, number, state); });
              };
              OptimizeResult result = workspace.optimize(task.input, task.targets, task.limits, task.options,
                                                         {job.stop, {}}, watch, task.known);
              if (result.reason == StopReason::Cancelled) throw Cancelled{};
              return result;
          },
          [this](const Task& task, OptimizeResult& result) { finish(task, result); }, WhenBusy::StopOld,
          &services.compute()),
      m_explaining(
          [&workspace = services.workspace()](const Question& q, const JobControl& job) {
              return workspace.explain(q.task.input, q.task.targets, q.task.limits, q.task.options, q.found,
                                       {job.stop, {}}, q.task.known);
          },
          [this](const Question& q, Verdict& verdict) {
              QStringList sentences;
              if (const std::string kept = keptText(q.found); !kept.empty()) sentences << QString::fromStdString(kept);
              for (const std::string& sentence : verdict.sentences) sentences << QString::fromStdString(sentence);
              const bool isReached = verdict.objective < q.task.options.tolerance;
              std::vector<Notice::Choice> choices = exactShares(q.found);
              if (!isReached)
                  std::ranges::move(choicesOf(m_services, verdict, [this] { start(); }), std::back_inserter(choices));
              say(sentences.join(' '), std::move(choices));
          },
          WhenBusy::StopOld, &services.compute()) {
    connect(&m_job, &JobBase::busyChanged, this, [this] {
        m_services.results().setPaused(isRunning());
        Q_EMIT runningChanged();
    });
    connect(&m_job, &JobBase::cancelled, this, [this] {
        m_services.store().cancel();
        say(tr("Cancelled; nothing was changed."));
    });
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_services.store().cancel();
        m_services.showError(tr("Optimization failed"), error);
    });
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.data != after.data) cancel();
        if (isRunning() && !(measureInput(after).view == m_task.input.view)) restart(measureInput(after).view);
        if (!m_message.isEmpty() && !isRunning() && !(present() == m_about)) {
            m_question.reset();
            m_explaining.cancel();
            say({});
        }
    });
    connect(&services.results(), &Results::changed, this, &OptimizeController::askWhy);
    connect(&m_explaining, &JobBase::busyChanged, this, &OptimizeController::messageChanged);
    connect(&m_explaining, &JobBase::failed, this, [this](const Error& error) {
        say(tr("Not on target; the reason could not be found: %1.").arg(QString(error.what())));
    });
}

OptimizeController::~OptimizeController() { ++m_number; }

void OptimizeController::addActions() {
    m_services.actions().add(
        tr("&Transfer function"), "optimizeAction", tr("&Optimize to the targets"), "Ctrl+Return",
        tr("Finds opacities with which each feature has the attention that its target asks for, from this view"),
        [this] { start(); },
        [this] { return m_services.store().hasVolume() && !isRunning() && !m_services.scene().tf.features.empty(); });
}

OptimizeController::About OptimizeController::present() const {
    return {measureInput(m_services.scene()), m_services.scene().targets()};
}

void OptimizeController::say(const QString& text, std::vector<Notice::Choice> choices) {
    m_about = present();
    if (text == m_message && choices.empty() && m_choices.empty()) return;
    m_message = text;
    m_choices = std::move(choices);
    Q_EMIT messageChanged();
}

void OptimizeController::take(std::size_t choice) {
    if (isRunning() || choice >= m_choices.size()) return;
    const auto act = m_choices[choice].act; // which takes the message away, and the choice with it
    act();
}

void OptimizeController::start() {
    SessionStore& store = m_services.store();
    if (!store.hasVolume() || isRunning() || m_services.scene().tf.features.empty()) return;
    store.commit();
    say({});
    m_restarts = 0;
    m_question.reset();
    m_explaining.cancel();
    const About about = present();
    Task task{about.input, m_services.scene().tf, about.targets,
              limitsOf(m_services.scene().tf, *store.session().goals), *store.session().optimize};
    if (isAimed(task.targets))
        task.known = knownAnswers(*store.session().runs, normalizedTargets(task.targets, task.targets.size()));
    begin(std::move(task));
}

std::vector<Notice::Choice> OptimizeController::exactShares(const OptimizeResult& result) {
    if (!result.seen || !result.seen->exact) return {};
    return {{tr("Use the exact shares"), [this, opacity = result.seen->exact->opacity] {
                 const TransferFunction tf = withShownOpacities(m_services.scene().tf, opacity);
                 m_services.store().edit(tr("Exact shares"), {}, [&](Session& session) { session.setTf(tf); });
             }}};
}

void OptimizeController::begin(Task task) {
    m_move = -1;
    m_firstObjective = m_objective = 0;
    m_opacity.clear();
    task.number = ++m_number;
    m_task = task;
    m_job.start(std::move(task), tr("the optimization"));
    m_run = runOf({.tf = {}, .targets = m_task.targets, .history = {}}, m_task.start());
    m_run.started = QDateTime::currentDateTime().toString(Qt::ISODate).toStdString();
    m_since.start();
    Q_EMIT moved();
}

// What it has found so far is the start of what is looked for now.
void OptimizeController::restart(const View& view) {
    Task task = m_task;
    task.input.view = view;
    if (!m_opacity.empty()) {
        task.tf = withShownOpacities(task.tf, withShapesKept(m_opacity, featureOpacities(task.tf), kLeastStart));
        task.input.tf = shownTf(task.tf);
    }
    ++m_restarts;
    begin(std::move(task));
}

void OptimizeController::showMove(const Task& task, int move, const OptimizeState& state) {
    if (task.number != m_number || !isRunning()) return;
    m_move = move;
    m_opacity = state.opacity;
    m_objective = state.objective;
    if (move == 0) m_firstObjective = m_run.before = state.objective;
    m_run.history.push_back(state);
    m_run.after = state.objective;
    const TransferFunction tf = withShownOpacities(task.tf, state.opacity);
    m_services.store().preview(tr("Optimize"), [&](Session& session) { session.setTf(tf); });
    if (!isRunning()) return;                               // whoever saw it has stopped it
    m_services.results().addVws(task.input, tf, state.vws); // of the camera that it began with, wherever the eye is now
    Q_EMIT moved();
}

void OptimizeController::finish(const Task& task, const OptimizeResult& result) {
    SessionStore& store = m_services.store();
    const OptimizeState& best = result.history[result.best];
    const TransferFunction tf = withShownOpacities(task.tf, best.opacity);
    Run run = runOf(result, task.start());
    run.started = m_run.started;
    run.seconds = static_cast<double>(m_since.elapsed()) / 1000;
    // The start, where a run ends before its first move was shown.
    if (!store.isPreviewing()) store.preview(tr("Optimize"), [](Session&) {});
    store.record([&](Session& session) { session.addRun(run); }); // undo takes back what came of it
    m_answering = true;
    store.preview(tr("Optimize"), [&](Session& session) { session.setTf(tf); });
    store.commit();
    m_answering = false;
    const MeasureInput input = m_services.results().addVws(task.input, tf, best.vws);
    // It is true of what it was computed from.
    if (!(present() == About{input, task.targets}))
        return say(tr("Something has changed since the optimization began; nothing is known about the present state."));
    say(sayOf(result, m_restarts), exactShares(result));
    if (best.objective < task.options.tolerance || result.reason == StopReason::Visible) return;
    m_question = Question{task, result};
    m_question->task.input = input;
    askWhy();
}

// The figures of what is shown come first: both need the same engine.
void OptimizeController::askWhy() {
    if (!m_question || isRunning() || !m_services.results().measuresAreCurrent()) return;
    Question question = std::move(*m_question);
    m_question.reset();
    if (!(present() == m_about)) return;
    m_explaining.start(std::move(question), tr("the reason"));
}

} // namespace pellucid::gui
