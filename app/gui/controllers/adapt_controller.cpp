#include "controllers/adapt_controller.h"

#include "controllers/player_controller.h"
#include "services/services.h"
#include "session/track_keys.h"
#include "store/edits.h"

namespace pellucid::gui {
namespace {

using Mode = AdaptSettings::Mode;

struct ModeText {
    Mode mode;
    const char *id, *text, *tip;
};
constexpr ModeText kModes[] = {
    // in the order of Mode
    {Mode::Static, "adaptStaticAction", QT_TR_NOOP("&Static transfer function"),
     QT_TR_NOOP("Keys only, and what lies between them")},
    {Mode::Refine, "adaptRefineAction", QT_TR_NOOP("&Refine from frame to frame"),
     QT_TR_NOOP(
         "Each frame's transfer function is that of the frame before, refined by the entropy of its own values")},
    {Mode::Optimize, "adaptOptimizeAction", QT_TR_NOOP("&Optimize every frame"),
     QT_TR_NOOP("Each frame's opacities bring attention to the targets, starting from those of the frame before")},
};

} // namespace

AdaptController::AdaptController(Services& services, PlayerController& player)
    : m_services(services), m_player(player),
      m_job(
          [this](const Scene& basis, const JobControl& job) {
              const AdaptProgress before = adaptProgress(basis.session, *basis.series);
              return Answer{before, m_maker.next(basis, {job.stop, {}}, &job)};
          },
          [this](const Scene& basis, Answer& answer) { finish(basis, answer); }, WhenBusy::StopOld, &m_lane) {
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
        m_services.notices().add({tr("Transfer functions of other frames are not made: %1").arg(error.what())});
        Q_EMIT changed();
    });
}

void AdaptController::addActions() {
    ActionMenu menu(m_services.actions(), tr("T&ime"),
                    [this] { return m_player.hasSeries() && !m_services.isReadOnly(); });
    menu.separate();
    for (const ModeText& m : kModes)
        menu.addCheck(
            m.id, tr(m.text), {}, tr(m.tip),
            [this, mode = m.mode] { return m_services.store().session().adapt->mode == mode; },
            [this, mode = m.mode] { setMode(mode); });
    menu.separate();
    m_keyActions << menu.addCheck(
        "tfKeyAction", tr("Transfer function &key here"), "K",
        tr("This frame's transfer function is made by hand; what is made for the frames after it begins here"),
        [this] { return hasTfKey(); }, [this] { hasTfKey() ? removeTfKey() : setTfKey(); });
    m_keyActions << menu.addCheck(
        "targetKeyAction", tr("&Target key here"), "Shift+K",
        tr("The targets are those of this frame; between two keys they change evenly"),
        [this] { return hasTargetKey(); }, [this] { hasTargetKey() ? removeTargetKey() : setTargetKey(); });
    const ActionMore always{.enabled = [this] { return m_player.hasSeries(); }};
    m_keyActions << menu.add(
        "previousKeyAction", tr("Pre&vious key"), "Ctrl+,", {}, [this] { goToKey(-1); }, always);
    m_keyActions << menu.add(
        "nextKeyAction", tr("Ne&xt key"), "Ctrl+.", {}, [this] { goToKey(1); }, always);
    m_keyActions << menu.add(
        "fromHereAction", tr("Start from this f&rame"), {},
        tr("The transfer functions of all later frames begin with that of this frame: later keys are removed"),
        [this] { fromHereOn(); });
}

// ---- edits

void AdaptController::setMode(Mode mode) {
    m_stopped = false;
    m_services.store().edit(tr(kModes[static_cast<std::size_t>(mode)].text).remove('&'), {}, [mode](Session& session) {
        session.adapt.edit([mode](AdaptSettings& a) { a.mode = mode; });
        if (mode != Mode::Static) session.holdTargets = false; // both set opacities
    });
}

void AdaptController::setCoherence(double coherence) {
    m_stopped = false;
    editPart(m_services.store(), &Session::adapt, tr("Coherence"), "coherence",
             [coherence](AdaptSettings& a) { a.coherence = coherence; });
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
        Q_EMIT m_services.message(tr("The only key cannot be removed: it is the transfer function of all frames."));
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
