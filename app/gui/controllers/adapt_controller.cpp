#include "controllers/adapt_controller.h"

#include <algorithm>

#include "controllers/player_controller.h"
#include "services/services.h"
#include "session/track_keys.h"

namespace pellucid::gui {
namespace {

using Mode = AdaptSettings::Mode;

constexpr int kRest = 60; // milliseconds without a change before what is missing is looked for

} // namespace

AdaptController::AdaptController(Services& services, PlayerController& player)
    : m_services(services), m_player(player),
      m_job(
          [this](const Scene& basis, const JobControl& job) {
              const AdaptProgress before = adaptProgress(basis.session, *basis.series);
              return Answer{before, m_maker.next(basis, {job.stop, {}}, &job)};
          },
          [this](const Scene& basis, Answer& answer) { finish(basis, answer); }, WhenBusy::StopOld, &m_lane) {
    m_timer.setSingleShot(true);
    m_timer.setInterval(kRest);
    connect(&m_timer, &QTimer::timeout, this, &AdaptController::look);
    connect(&services.store(), &SessionStore::changed, this, &AdaptController::follow);
    connect(&services, &Services::readOnlyChanged, this, [this] {
        if (m_services.isReadOnly()) m_job.cancel();
        if (isWanted()) m_timer.start();
    });
    connect(&m_job, &JobBase::busyChanged, this, &AdaptController::changed);
    connect(&m_job, &JobBase::progress, this, [this](double fraction) {
        m_smoothing = fraction;
        Q_EMIT changed();
    });
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_stopped = true;
        m_services.notices().add(
            {tr("Transfer functions of other frames are not made: %1").arg(QString::fromUtf8(error.what())), {}});
        Q_EMIT changed();
    });
}

void AdaptController::addActions() {
    const QString menu = tr("T&ime");
    Actions& actions = m_services.actions();
    const auto open = [this] { return m_player.hasSeries() && !m_services.isReadOnly(); };
    const auto mode = [&](const char* id, const QString& text, const QString& tip, Mode which, bool separator) {
        actions.add(menu, id, text, {}, tip, [this, which] { setMode(which); }, open,
                    {.checked = [this, which] { return m_services.store().session().adapt->mode == which; },
                     .separatorBefore = separator});
    };
    mode("adaptStaticAction", tr("&Static transfer function"), tr("The keys alone, and what lies between them"),
         Mode::Static, true);
    mode("adaptRefineAction", tr("&Refine from frame to frame"),
         tr("Each frame's transfer function is that of the frame before, refined by entropy of its own values"),
         Mode::Refine, false);
    mode("adaptOptimizeAction", tr("&Optimize every frame"),
         tr("Each frame's opacities bring VWS to the targets, from those of the frame before"), Mode::Optimize, false);
    m_keyActions << actions.add(
        menu, "tfKeyAction", tr("Transfer function &key here"), "K",
        tr("This frame's transfer function is made by hand; what is made for frames begins at keys"),
        [this] { hasTfKey() ? removeTfKey() : setTfKey(); }, open,
        {.checked = [this] { return hasTfKey(); }, .separatorBefore = true});
    m_keyActions << actions.add(
        menu, "targetKeyAction", tr("&Target key here"), "Shift+K",
        tr("The targets are those of this frame; between keys they go from the one to the other"),
        [this] { hasTargetKey() ? removeTargetKey() : setTargetKey(); }, open,
        {.checked = [this] { return hasTargetKey(); }});
    const auto go = [&](const char* id, const QString& text, const char* keys, int direction) {
        m_keyActions << actions.add(
            menu, id, text, keys, {}, [this, direction] { goToKey(direction); },
            [this] { return m_player.hasSeries(); });
    };
    go("previousKeyAction", tr("Pre&vious key"), "Ctrl+,", -1);
    go("nextKeyAction", tr("Ne&xt key"), "Ctrl+.", 1);
    m_keyActions << actions.add(
        menu, "fromHereAction", tr("From this frame o&n"), {},
        tr("This frame's transfer function is where those of all frames after it begin: later keys go"),
        [this] { fromHereOn(); }, open);
}

// ---- edits

void AdaptController::setMode(Mode mode) {
    m_stopped = false;
    m_services.store().edit(mode == Mode::Static   ? tr("Static transfer function")
                            : mode == Mode::Refine ? tr("Refine from frame to frame")
                                                   : tr("Optimize every frame"),
                            {}, [mode](Session& session) {
                                session.adapt.edit([mode](AdaptSettings& a) { a.mode = mode; });
                                if (mode != Mode::Static) session.holdTargets = false; // both set opacities
                            });
}

void AdaptController::setCoherence(double coherence) {
    m_stopped = false;
    m_services.store().edit(tr("Coherence"), "coherence", [coherence](Session& session) {
        session.adapt.edit([coherence](AdaptSettings& a) { a.coherence = coherence; });
    });
}

bool AdaptController::hasTfKey() const {
    const Session& session = m_services.store().session();
    return m_player.hasSeries() && session.variable().track.keys.contains(session.frame);
}

bool AdaptController::hasTargetKey() const {
    const Session& session = m_services.store().session();
    return session.targetKeys->contains(session.frame);
}

void AdaptController::setTfKey() {
    if (hasTfKey()) return;
    m_services.store().edit(tr("Set key"), {}, [](Session& session) { pellucid::setTfKey(session); });
}

void AdaptController::removeTfKey() {
    if (!hasTfKey()) return;
    if (m_services.store().session().variable().track.keys.size() == 1) {
        Q_EMIT m_services.message(tr("The only key stays: it is the transfer function of all frames."));
        return;
    }
    m_services.store().edit(tr("Remove key"), {}, [](Session& session) { pellucid::removeTfKey(session); });
}

void AdaptController::setTargetKey() {
    m_services.store().edit(tr("Set target key"), {}, [](Session& session) { pellucid::setTargetKey(session); });
}

void AdaptController::removeTargetKey() {
    m_services.store().edit(tr("Remove target key"), {}, [](Session& session) {
        session.targetKeys.edit([&](TargetKeys& keys) { keys.erase(session.frame); });
    });
}

void AdaptController::fromHereOn() {
    m_services.store().edit(tr("From this frame on"), {}, [](Session& session) { beginTracksHere(session); });
}

void AdaptController::goToKey(int direction) {
    if (!m_player.hasSeries()) return;
    const Session& session = m_services.store().session();
    if (const auto key = keyBeside(session, m_player.awaited().value_or(session.frame), direction))
        return m_player.goTo(*key);
    Q_EMIT m_services.message(direction > 0 ? tr("There is no key after this frame.")
                                            : tr("There is no key before this frame."));
}

// ---- what is made by itself

bool AdaptController::isStale(int frame) const {
    return m_firstStale >= 0 && frame >= m_firstStale &&
           m_services.store().session().variable().track.keyBefore(frame) == m_staleKey;
}

bool AdaptController::isWanted() const {
    return !m_stopped && m_player.hasSeries() && !m_services.isReadOnly() &&
           m_services.store().session().adapt->mode != Mode::Static;
}

void AdaptController::stop() {
    m_stopped = true;
    m_timer.stop();
    m_job.cancel();
    Q_EMIT changed();
}

void AdaptController::goOn() {
    m_stopped = false;
    if (isWanted()) m_timer.start();
    Q_EMIT changed();
}

void AdaptController::follow(const Scene& before, const Scene& after) {
    const bool other = before.series != after.series;
    if (other) {
        m_job.cancel();
        m_stopped = false;
        m_progress = {};
        m_firstStale = -1;
    }
    if (!isWanted()) {
        m_timer.stop();
        m_job.cancel();
        if (m_progress.all > 0) {
            m_progress = {};
            m_firstStale = -1;
            Q_EMIT changed();
        }
    } else if (other || adaptsOtherwise(before.session, after.session)) {
        // What is under way may be stale: its fingerprint tells. Smoothing takes too long to wait for that.
        if (m_smoothing > 0 && before.session.frame == after.session.frame) m_job.cancel();
        m_timer.start();
    }
    if (before.session.frame != after.session.frame || other || !before.session.adapt.isSame(after.session.adapt) ||
        !before.session.targetKeys.isSame(after.session.targetKeys) ||
        !before.session.variables.isSame(after.session.variables))
        m_services.actions().refresh();
}

void AdaptController::look() {
    if (!isWanted()) return;
    if (m_job.isRunning()) return; // its end looks again
    // What the hand holds is not committed: no frame needs it yet.
    if (m_player.isHeldUp() || m_services.store().isPreviewing()) return m_timer.start();
    m_smoothing = 0;
    m_job.start(m_services.store().committed(), tr("the frames"));
}

void AdaptController::finish(const Scene& basis, const Answer& answer) {
    const SequenceMaker::Step& step = answer.step;
    SessionStore& store = m_services.store();
    if (!isWanted() || store.scene().series != basis.series) return;
    m_progress = answer.before;
    m_firstStale = step.firstStale;
    m_staleKey = m_firstStale < 0 ? -1 : basis.session.variable().track.keyBefore(m_firstStale);
    if ((step.made || step.smoothed) && !store.isPreviewing()) {
        // Where something has changed meanwhile its fingerprint is another one, and it will be made again.
        store.amend([&](Session& session) { session = withStep(std::move(session), step); });
        if (step.smoothed)
            m_progress = adaptProgress(store.session(), *store.scene().series);
        else
            ++m_progress.done;
    }
    if (step.goesOn() && !store.isPreviewing()) {
        m_timer.stop();
        look();
    } else if (step.goesOn()) {
        m_timer.start();
    }
    Q_EMIT changed();
}

} // namespace pellucid::gui
