#include "controllers/live_controller.h"

#include <algorithm>

#include <QScopedValueRollback>

#include "controllers/optimize_controller.h"
#include "services/services.h"
#include "tf/shown_tf.h"
#include "widgets/terms.h"

namespace pellucid::gui {
namespace {

constexpr double kLeastOpacity = 1e-5; ///< of features that the hand does not hold

} // namespace

LiveController::LiveController(Services& services, OptimizeController& optimizing)
    : m_services(services), m_optimizing(optimizing),
      m_job(
          [&workspace = services.workspace()](const Task& task, const JobControl& job) {
              const JobControl quiet{job.stop, {}};
              return task.settles ? settleTargets(workspace, task.held, quiet)
                                  : followTargets(workspace, task.held, quiet);
          },
          [this](const Task& task, LiveUpdate& update) { finish(task, update); }, WhenBusy::StopOld,
          &services.compute()) {
    connect(&services.store(), &SessionStore::changed, this, &LiveController::follow);
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_settled = present().held; // not again and again
        stop();
        m_optimizing.say(tr("The targets are not held: %1 (%2).")
                             .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.whatToDo())));
    });
    connect(&m_job, &JobBase::busyChanged, this, &LiveController::busyChanged);
}

void LiveController::addActions() {
    const auto toggle = [this] {
        const bool on = !isOn();
        m_services.store().edit(on ? tr("Live targets") : tr("Live targets off"), {}, [on](Session& session) {
            session.holdTargets = on;
            if (!on) return;
            session.refine.edit([](RefineSettings& r) { r.live = false; }); // all of them set opacities
            session.adapt.edit([](AdaptSettings& a) { a.mode = AdaptSettings::Mode::Static; });
        });
    };
    m_action = m_services.actions().add(
        tr("&Transfer function"), "liveTargetsAction", tr("&Keep targets while rotating"), "Ctrl+Shift+L",
        tr("Opacities follow while the view turns or a colour changes, so that attention stays on the targets"), toggle,
        [this] { return m_services.isEditable(); }, {.checked = [this] { return isOn(); }});
    connect(&m_optimizing, &OptimizeController::runningChanged, this, [this] {
        if (m_optimizing.isRunning())
            stop();
        else
            follow(m_services.scene(), m_services.scene());
    });
}

bool LiveController::isOn() const {
    const Session& session = m_services.store().session();
    return session.holdTargets && session.adapt->mode == AdaptSettings::Mode::Static; // frames have theirs made
}

LiveController::Task LiveController::present() const {
    const Scene& scene = m_services.scene();
    Task task{{measureInput(scene), scene.targets(), limitsOf(scene.tf, *scene.session.goals), *scene.session.optimize},
              scene.tf,
              false};
    for (std::size_t i = 0; i < task.held.limits.size(); ++i)
        if (m_pinned.contains(scene.tf.features[i].id)) task.held.limits[i].locked = true;
    return task;
}

// The opacity that was set stays.
void LiveController::pinWhatWasSet(const Scene& before, const Scene& after) {
    if (before.volume != after.volume || !sameFeatures(before.tf, after.tf)) return m_pinned.clear();
    const Scene& from = m_services.store().isPreviewing() ? m_services.store().committed() : before;
    if (!sameFeatures(from.tf, after.tf) || from.tf == after.tf) return m_pinned.clear();
    m_pinned = setByHand(from.tf, after.tf, m_wanted);
}

void LiveController::follow(const Scene& before, const Scene& after) {
    if (m_applying) return;
    if (!isOn() || !m_services.store().hasVolume() || after.tf.features.empty() || m_optimizing.isRunning()) {
        m_settled.reset();
        m_pinned.clear();
        return stop();
    }
    if (before.data != after.data) stop();
    pinWhatWasSet(before, after);
    if (m_settled && present().held == *m_settled) return;
    m_services.results().setPaused(true); // updates tell VWS, and need the engine
    m_rest.start();
    if (m_job.isRunning() && !m_settling)
        m_dirty = true; // its answer is waited for: a hand that never rests would see none
    else
        begin(false);
}

void LiveController::begin(bool settles) {
    m_dirty = false;
    m_settling = settles;
    Task task = present();
    task.settles = settles;
    const bool was = m_job.isRunning();
    m_job.start(std::move(task), tr("the live targets"));
    if (!was) Q_EMIT busyChanged();
}

void LiveController::stop() {
    const bool was = isBusy();
    m_dirty = false;
    m_rest.stop();
    m_job.cancel();
    if (!was) return;
    m_services.results().setPaused(m_optimizing.isRunning());
    Q_EMIT busyChanged();
}

void LiveController::finish(const Task& task, const LiveUpdate& update) {
    SessionStore& store = m_services.store();
    if (!isOn() || !sameFeatures(task.tf, m_services.scene().tf) || task.held.input.volume != m_services.scene().volume)
        return stop();
    {
        const QScopedValueRollback applying(m_applying, true);
        // Of the present state, which may be another one than it was found for; what the hand holds stays as it is.
        m_wanted.clear();
        for (std::size_t i = 0; i < update.opacity.size(); ++i) m_wanted[task.tf.features[i].id] = update.opacity[i];
        store.amend([ids = task.tf.features, pinned = m_pinned, wanted = update.opacity](Session& session) {
            if (session.tf() == nullptr || session.tf()->features.size() != ids.size()) return;
            const std::vector<double> was = featureOpacities(*session.tf());
            std::vector<double> x = withShapesKept(wanted, was, kLeastOpacity);
            for (std::size_t i = 0; i < x.size(); ++i)
                if (pinned.contains(ids[i].id)) x[i] = was[i];
            const TransferFunction tf = withShownOpacities(*session.tf(), x);
            if (featureOpacities(tf) != featureOpacities(*session.tf())) session.setTf(tf);
        });
    }
    if (!update.approximate) // bars show figures of the volume
        m_services.results().addVws(task.held.input, withShownOpacities(task.tf, update.opacity), update.vws);
    Q_EMIT updated(update.objective);
    if (m_dirty) return begin(false);
    if (!task.settles) return; // the rest does the last moves
    m_settled = present().held;
    m_services.results().setPaused(false);
    if (update.objective >= task.held.options.tolerance)
        m_optimizing.say(tr("The targets cannot be kept from this view: %1.").arg(terms().offTarget(update.objective)));
    Q_EMIT busyChanged();
}

} // namespace pellucid::gui
