#include "controllers/optimize_controller.h"

#include <QDateTime>

#include "tf/shown_tf.h"
#include "workbench.h"

namespace pellucid::gui {
namespace {

QString counted(int n, const QString& one, const QString& many) {
    return QStringLiteral("%1 %2").arg(n).arg(n == 1 ? one : many);
}

QString fixed4(double value) { return QString::number(value, 'f', 4); }

} // namespace

OptimizeController::OptimizeController(Workbench& bench)
    : m_bench(bench),
      m_job(
          [this, &workspace = bench.workspace()](const Task& task, const JobControl& job) {
              int move = 0;
              const auto watch = [&](const OptimizeState& state) {
                  if (job.stop.stop_requested()) return;
                  QMetaObject::invokeMethod(this,
                                            [this, task, state, number = move++] { showMove(task, number, state); });
              };
              OptimizeResult result =
                  workspace.optimize(task.input, task.targets, task.limits, task.options, {job.stop, {}}, watch);
              if (result.reason == StopReason::Cancelled) throw Cancelled{};
              return result;
          },
          [this](const Task& task, OptimizeResult& result) { finish(task, result); }, WhenBusy::StopOld,
          &bench.compute()) {
    connect(&m_job, &JobBase::busyChanged, this, [this] {
        m_bench.results().setPaused(isRunning());
        Q_EMIT runningChanged();
    });
    connect(&m_job, &JobBase::cancelled, this, [this] {
        m_bench.store().cancel();
        say(tr("Cancelled; nothing was changed."));
    });
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_bench.store().cancel();
        m_bench.showError(tr("Optimization failed"), error);
    });
    connect(&bench.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.data != after.data) cancel();
        if (!m_message.isEmpty() && !isRunning() && !(present() == m_about)) say({});
    });
}

OptimizeController::~OptimizeController() { ++m_number; }

void OptimizeController::addActions() {
    m_bench.actions().add(
        {.id = "optimizeAction",
         .menu = tr("&Transfer function"),
         .text = tr("&Optimize to the targets"),
         .keys = {QKeySequence("Ctrl+Return")},
         .tip = tr("Opacities until the features' saliency (VWS) meets the targets, from this camera"),
         .trigger = [this] { start(); },
         .enabled =
             [this] { return m_bench.store().hasVolume() && !isRunning() && !m_bench.scene().tf.features.empty(); }});
}

OptimizeController::About OptimizeController::present() const {
    return {measureInput(m_bench.scene()), m_bench.scene().targets()};
}

void OptimizeController::say(const QString& text) {
    m_about = present();
    if (text == m_message) return;
    m_message = text;
    Q_EMIT messageChanged();
}

void OptimizeController::start() {
    SessionStore& store = m_bench.store();
    if (!store.hasVolume() || isRunning() || m_bench.scene().tf.features.empty()) return;
    store.commit();
    say({});
    m_move = -1;
    m_firstObjective = m_objective = 0;
    const About about = present();
    m_job.start({about.input, m_bench.scene().tf, about.targets, limitsOf(m_bench.scene().tf, *store.session().goals),
                 *store.session().optimize, ++m_number},
                tr("the optimization"));
    m_run = runOf({.tf = {}, .targets = about.targets, .history = {}},
                  runStartOf(m_bench.scene(), *store.session().optimize));
    m_run.started = QDateTime::currentDateTime().toString(Qt::ISODate).toStdString();
    m_since.start();
    Q_EMIT moved();
}

void OptimizeController::cancel() { m_job.cancel(); }

void OptimizeController::showMove(const Task& task, int move, const OptimizeState& state) {
    if (task.number != m_number || !isRunning()) return;
    m_move = move;
    m_objective = state.objective;
    if (move == 0) m_firstObjective = m_run.before = state.objective;
    m_run.history.push_back(state);
    m_run.after = state.objective;
    const TransferFunction tf = withShownOpacities(task.tf, state.opacity);
    m_bench.store().preview(tr("Optimize"), [&](Session& session) { session.setTf(tf); });
    if (!isRunning()) return;        // whoever saw it has stopped it
    MeasureInput input = task.input; // of the camera that it began with, wherever the eye is now
    input.tf = shownTf(tf);
    m_bench.results().addVws(input, state.vws);
    Q_EMIT moved();
}

void OptimizeController::finish(const Task& task, const OptimizeResult& result) {
    SessionStore& store = m_bench.store();
    const OptimizeState& best = result.history[result.best];
    const TransferFunction tf = withShownOpacities(task.tf, best.opacity);
    Run run = runOf(result, task.start());
    run.started = m_run.started;
    run.seconds = static_cast<double>(m_since.elapsed()) / 1000;
    // The start, where a run ends before its first move was shown.
    if (!store.isPreviewing()) store.preview(tr("Optimize"), [](Session&) {});
    store.record([&](Session& session) { session.addRun(run); }); // undo takes back what came of it
    store.preview(tr("Optimize"), [&](Session& session) { session.setTf(tf); });
    store.commit();
    MeasureInput input = task.input;
    input.tf = shownTf(tf);
    m_bench.results().addVws(input, best.vws);
    const QString figures = tr("F = %1, from %2, in %3")
                                .arg(fixed4(best.objective), fixed4(result.history.front().objective),
                                     counted(result.iterations(), tr("move"), tr("moves")));
    // It is true of what it was computed from; where the eye has moved meanwhile, nothing is known of now.
    if (!(present() == About{input, task.targets})) {
        say(tr("The view or the targets have changed since it began; where it began: %1.").arg(figures));
        return;
    }
    switch (result.reason) {
    case StopReason::Converged:
        return say(tr("On target: %1.").arg(figures));
    case StopReason::NoProgress:
        return say(tr("As near as it gets from this camera: %1.").arg(figures));
    default:
        return say(tr("Stopped at the most moves allowed: %1.").arg(figures));
    }
}

} // namespace pellucid::gui
