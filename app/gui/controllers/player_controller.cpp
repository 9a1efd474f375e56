#include "controllers/player_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/open_controller.h"
#include "jobs/rest_timer.h"
#include "render/memory_needs.h"
#include "services/services.h"
#include "session/scene_data.h"

namespace pellucid::gui {
namespace {

constexpr int kMostReady = 3;           // scenes that are made before they are wanted
constexpr int kAheadAtRest = 2;         // frames that are read ahead while nothing plays
constexpr qint64 kRateOver = 2000;      // milliseconds over which the rate is told
constexpr qint64 kPatience = 1000;      // milliseconds that a frame waits for the picture of the one before
constexpr std::size_t kMostNotices = 3; // of frames that cannot be read, each with a notice of its own

/// In [0, count): after the last frame comes the first, and the reverse.
int wrapped(int frame, int count) { return (frame % count + count) % count; }

} // namespace

PlayerController::PlayerController(Services& services, OpenController& opening)
    : m_services(services), m_opening(opening),
      m_reading(&PlayerController::read, [this](const Ask& ask, Got& got) { deliver(ask, got); }) {
    m_timer.setTimerType(Qt::PreciseTimer);
    connect(&m_timer, &QTimer::timeout, this, &PlayerController::tick);
    connect(&services.store(), &SessionStore::changed, this, &PlayerController::follow);
    connect(&opening, &OpenController::busyChanged, this, &PlayerController::next);
    connect(&services, &Services::readOnlyChanged, this, &PlayerController::next);
    connect(&m_reading, &JobBase::failed, this, [this](const Error& error) { // memory, for example
        pause();
        m_wanted.reset();
        m_surveyStopped = true;
        m_services.notices().add({tr("Frames cannot be read ahead: %1").arg(error.what())});
        Q_EMIT changed();
    });
    m_sinceStart.start();
}

void PlayerController::addActions() {
    Actions& actions = m_services.actions();
    ActionMenu menu(actions, tr("T&ime"), [this] { return hasSeries(); });
    m_actions.play = menu.add("playAction", tr("&Play"), "Space", tr("Play the frames of the series, or pause"),
                              [this] { m_playing ? pause() : play(); },
                              {.caption = [this] { return m_playing ? tr("&Pause") : tr("&Play"); }});
    m_actions.next = menu.add("nextFrameAction", tr("&Next frame"), ".", tr("One frame forward"), [this] { step(1); });
    m_actions.previous =
        menu.add("previousFrameAction", tr("P&revious frame"), ",", tr("One frame back"), [this] { step(-1); });
    m_actions.first =
        menu.add("firstFrameAction", tr("&First frame"), "Ctrl+Home", {}, [this] { goTo(goodFrame(0, 1)); });
    m_actions.last = menu.add("lastFrameAction", tr("&Last frame"), "Ctrl+End", {},
                              [this] { goTo(goodFrame(frameCount() - 1, -1)); });
    menu.separate();
    m_actions.loops = menu.addCheck(
        "loopAction", tr("L&oop"), {}, tr("After the last frame the first one plays again"), [this] { return m_loops; },
        [this] { setLoops(!m_loops); });
    m_actions.backward = menu.addCheck(
        "backwardAction", tr("Play &backward"), {}, {}, [this] { return m_backward; },
        [this] { setBackward(!m_backward); });
    connect(this, &PlayerController::changed, &actions, [this, was = false]() mutable {
        if (std::exchange(was, m_playing) != m_playing) m_services.actions().refresh();
    });
}

// ---- what there is

bool PlayerController::hasSeries() const {
    return m_services.store().hasVolume() && m_services.scene().series->varies();
}

int PlayerController::frameCount() const {
    return m_services.store().hasVolume() ? m_services.scene().series->size() : 0;
}

int PlayerController::frame() const { return m_services.store().session().frame; }

QString PlayerController::label(int frame) const {
    return QString::fromStdString(m_services.scene().series->listing().label(frame));
}

QString PlayerController::problemOf(int frame) const {
    const auto found = m_broken.find(frame);
    return found == m_broken.end() ? QString() : found->second.what;
}

bool PlayerController::isHeld(int frame) const {
    const Scene& scene = m_services.scene();
    return scene.series->isShown(frame, scene.session.variable().window);
}

/// The frame itself, or the next one in the direction that is not known to be broken; `from` where there is none.
int PlayerController::goodFrame(int from, int direction) const {
    for (int f = from; f >= 0 && f < frameCount(); f += direction) {
        if (!m_broken.contains(f)) return f;
        if (direction == 0) break;
    }
    return from;
}

bool PlayerController::isHeldUp() const { return m_services.isReadOnly() || m_opening.isBusy(); }

// ---- what is wanted

void PlayerController::play() {
    if (!hasSeries() || m_playing) return;
    const int last = m_backward ? 0 : frameCount() - 1;
    m_playing = m_hasPlayed = true;
    m_dropped = 0;
    m_shownAt.clear();
    if (!m_loops && frame() == goodFrame(last, m_backward ? 1 : -1)) { // once more
        const int first = frameCount() - 1 - last;
        m_wanted = goodFrame(first, m_backward ? -1 : 1);
        m_wantedBy = m_backward ? -1 : 1;
    }
    restartClock();
    startTimer();
    next();
    Q_EMIT changed();
}

void PlayerController::pause() {
    if (!m_playing) return;
    m_playing = false;
    m_timer.stop();
    m_wanted.reset(); // what is on its way stays for later
    Q_EMIT changed();
    next();
}

void PlayerController::goTo(int frame) {
    if (!hasSeries()) return;
    frame = std::clamp(frame, 0, frameCount() - 1);
    if (const QString problem = problemOf(frame); !problem.isEmpty())
        return Q_EMIT m_services.message(tr("%1 cannot be shown: %2").arg(label(frame), problem));
    m_wanted.reset();
    m_wantedBy = 0;
    if (frame != this->frame()) m_wanted = frame;
    if (m_playing) {
        m_clockFrom = frame;
        m_clock.restart();
    }
    next();
    Q_EMIT changed();
}

void PlayerController::step(int by) {
    if (!hasSeries() || by == 0) return;
    const int count = frameCount(), direction = by > 0 ? 1 : -1;
    int to = m_wanted.value_or(frame());
    for (int i = 0; i < std::abs(by); ++i) {
        int candidate = to + direction;
        while (candidate >= 0 && candidate < count && m_broken.contains(candidate)) candidate += direction;
        if (candidate < 0 || candidate >= count) {
            if (!m_loops) break;
            candidate = goodFrame(direction > 0 ? 0 : count - 1, direction);
        }
        to = candidate;
    }
    pause();
    goTo(to);
    m_wantedBy = direction;
}

void PlayerController::setLoops(bool loops) {
    m_loops = loops;
    if (m_playing) restartClock();
    Q_EMIT changed();
    m_services.actions().refresh();
}

void PlayerController::setBackward(bool backward) {
    m_backward = backward;
    if (m_playing) restartClock();
    m_services.actions().refresh();
    next();
    Q_EMIT changed();
}

void PlayerController::setSpeed(double framesPerSecond) {
    const double speed = std::clamp(framesPerSecond, kSlowest, kFastest);
    if (speed == m_speed) return;
    m_speed = speed;
    if (m_playing) {
        restartClock();
        startTimer();
    }
    Q_EMIT changed();
}

/// To look twice as often as frames are due.
void PlayerController::startTimer() { m_timer.start(static_cast<int>(std::clamp(500 / m_speed, 4.0, 100.0))); }

void PlayerController::restartClock() {
    m_clockFrom = m_wanted.value_or(frame());
    m_clock.start();
    m_shownAt.clear();
}

double PlayerController::rate() const {
    if (m_shownAt.size() < 2) return 0;
    return 1000.0 * static_cast<double>(m_shownAt.size() - 1) /
           std::max<double>(1, static_cast<double>(m_shownAt.back() - m_shownAt.front()));
}

QString PlayerController::rateText() const {
    if (!m_hasPlayed) return {};
    const QString drops = m_dropped == 0 ? tr("none dropped") : tr("%L1 dropped").arg(m_dropped);
    return tr("%1 of %2 frames a second, %3")
        .arg(QString::number(std::min(rate(), m_speed), 'f', m_speed < 10 ? 1 : 0), QString::number(m_speed), drops);
}

// ---- the clock

void PlayerController::tick() {
    if (!m_playing) return;
    if (isHeldUp()) return restartClock();
    if (m_wanted) return; // it is waited for
    if (!m_pictureSeen && m_sinceShown.elapsed() < kPatience) return;
    const int count = frameCount(), direction = m_backward ? -1 : 1;
    const auto passed = static_cast<int>(static_cast<double>(m_clock.elapsed()) * m_speed / 1000);
    // Where the clock is on the way from the frame that it began with.
    int due = m_clockFrom + direction * passed;
    const bool ended = due < 0 || due >= count;
    if (ended) due = m_loops ? wrapped(due, count) : std::clamp(due, 0, count - 1);
    const int now = frame();
    int skipped = 0;
    if (due != now) {
        const int way = m_loops ? wrapped(direction * (due - now), count) : direction * (due - now);
        for (int f = 1; f < way; ++f) // broken ones are not late
            if (!m_broken.contains(wrapped(now + direction * f, count))) ++skipped;
        const int good = goodFrame(due, direction);
        due = m_broken.contains(good) ? (m_loops ? goodFrame(m_backward ? count - 1 : 0, direction) : now) : good;
    }
    if (due == now) {
        if (ended && !m_loops) pause();
        return;
    }
    m_dropped += skipped;
    m_wanted = due;
    m_wantedBy = direction;
    next();
    if (skipped > 0) Q_EMIT changed();
}

void PlayerController::pictureShown(const Volume* volume) {
    if (volume != m_services.scene().volume.get()) return;
    m_pictureSeen = true;
    if (m_playing) later(this, [this] { tick(); });
}

// ---- reading

PlayerController::Got PlayerController::read(const Ask& ask, const JobControl& job) {
    const JobControl quiet{job.stop, {}};
    Got got;
    try {
        for (const int f : ask.touched)
            if (ask.basis.series->isShown(f, ask.basis.session.variable().window)) ask.basis.series->load(f, quiet);
        if (!ask.whole) {
            ask.basis.series->load(ask.frame, quiet);
            return got;
        }
        Session session = ask.basis.session;
        session.frame = ask.frame;
        // What is shown of it is kept with the frame.
        ask.basis.series->show(ask.frame, session.variable().window, quiet);
        got.scene = resolve(std::move(session), ask.basis, toPreview("showing"), quiet);
        prepareToShow(*got.scene, quiet);
    } catch (const Error& error) {
        got.error = error;
    }
    return got;
}

/// Frames to be read before they are wanted, the next one first.
std::vector<int> PlayerController::ahead() const {
    const TimeSeries& series = *m_services.scene().series;
    const int count = series.size(), direction = m_backward ? -1 : 1;
    // The present one is held too, and there is room for one that is looked at in passing.
    const int most = std::min(m_playing ? count - 1 : kAheadAtRest, series.roomFor() - 2);
    std::vector<int> frames;
    for (int i = 1; i < count && static_cast<int>(frames.size()) < most; ++i) {
        int f = frame() + direction * i;
        if (f < 0 || f >= count) {
            if (!m_loops) break;
            f = wrapped(f, count);
        }
        if (!m_broken.contains(f)) frames.push_back(f);
    }
    return frames;
}

void PlayerController::next() {
    if (!hasSeries() || m_reading.isRunning()) return;
    const Scene& scene = m_services.scene();
    TimeSeries& series = *scene.series;
    if (m_wanted) {
        if (isHeldUp()) return;
        if (show(*m_wanted)) return next();
        m_reading.start({scene, *m_wanted, true, {}}, label(*m_wanted));
        return;
    }
    const std::vector<int> frames = ahead();
    const std::size_t ready = std::min<std::size_t>(kMostReady, frames.size());
    const std::set<int> soon(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(ready));
    std::erase_if(m_ready, [&](const auto& entry) {
        return !soon.contains(entry.first) || !m_services.store().isShownBy(entry.second);
    });
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const int f = frames[i];
        const bool isThere = i < ready ? m_ready.contains(f) : isHeld(f);
        if (isThere) continue;
        // What is read ahead shall not push out what is wanted sooner.
        m_reading.start({scene, f, true, {frames.rend() - static_cast<std::ptrdiff_t>(i), frames.rend()}}, label(f));
        return;
    }
    if (!isSurveying() || m_playing) return;
    for (int i = 0; i < series.size(); ++i)
        if (!series.summary(i).isKnown) {
            m_reading.start({scene, i, false, {frames.rbegin(), frames.rend()}}, label(i));
            return;
        }
}

void PlayerController::deliver(const Ask& ask, Got& got) {
    const bool isPresent = hasSeries() && m_services.scene().series == ask.basis.series;
    if (!isPresent) return next();
    if (got.error) {
        m_broken[ask.frame] = {QString::fromStdString(got.error->problem()),
                               QString::fromStdString(got.error->where())};
        if (m_wanted == ask.frame) {
            m_wanted = goodFrame(ask.frame, m_wantedBy);
            if (m_broken.contains(*m_wanted)) m_wanted.reset(); // there is none: what is shown stays
        }
        reportProblems();
    }
    if (got.scene && m_services.store().isShownBy(*got.scene)) m_ready[ask.frame] = std::move(*got.scene);
    // While a hand scrubs faster than frames can be read, it sees those that came.
    if (m_wanted && *m_wanted != ask.frame && got.scene && !m_playing && !isHeldUp()) {
        const int goal = *m_wanted;
        show(ask.frame);
        m_wanted = goal;
    }
    reportProblems();
    next();
    Q_EMIT surveyed();
    Q_EMIT heldChanged();
    Q_EMIT changed();
}

/// Whether it could be shown now.
bool PlayerController::show(int frame) {
    if (m_wanted == frame && frame == this->frame()) {
        m_wanted.reset();
        return true;
    }
    const auto found = m_ready.find(frame);
    if (found == m_ready.end()) return false;
    const Scene scene = found->second;
    if (!m_services.store().isShownBy(scene)) {
        m_ready.erase(found);
        return false;
    }
    m_wanted.reset();
    m_pictureSeen = false;
    m_sinceShown.start();
    m_shownAt.push_back(m_sinceStart.elapsed());
    while (m_shownAt.back() - m_shownAt.front() > kRateOver) m_shownAt.pop_front();
    m_services.store().setFrame(scene);
    Q_EMIT changed();
    return true;
}

// ---- what else happens

void PlayerController::follow(const Scene& before, const Scene& after) {
    if (before.series != after.series) {
        m_reading.cancel();
        m_ready.clear();
        m_broken.clear();
        m_reported.clear();
        m_summary.clear();
        m_wanted.reset();
        m_hasPlayed = m_surveyStopped = false;
        m_pictureSeen = true;
        pause();
        const bool sameFrames = before.series && after.series && before.series->size() == after.series->size();
        if (sameFrames && after.series->varies() && before.session.frame != after.session.frame) {
            m_wanted = before.session.frame; // an undo of other data is no way to another frame
            m_wantedBy = 1;
        }
        if (hasSeries())
            for (const std::string& notice : after.series->listing().notices)
                m_services.notices().add({QString::fromStdString(notice)});
        reportProblems();
        Q_EMIT changed();
        Q_EMIT surveyed();
    }
    // Another mapping may do without the frame of another variable that could not be read.
    const bool others = !before.session.hsb->isKeptBy(*after.session.hsb) ||
                        !sameData(*before.session.variables, *after.session.variables) ||
                        !before.session.ground.isSame(after.session.ground) ||
                        !before.session.overlay.isSame(after.session.overlay);
    if (others && after.series)
        std::erase_if(m_broken,
                      [&](const auto& broken) { return after.series->summary(broken.first).problem.empty(); });
    // In a later turn: what has changed is being told to others.
    later(this, [this] { next(); });
}

void PlayerController::reportProblems() {
    if (!hasSeries()) return;
    const TimeSeries& series = *m_services.scene().series;
    for (int f = 0; f < series.size(); ++f) {
        const FrameSummary summary = series.summary(f);
        if (!summary.problem.empty())
            m_broken.try_emplace(
                f, Problem{QString::fromStdString(summary.problem),
                           QString::fromStdString(series.listing().frames[static_cast<std::size_t>(f)].source.path)});
    }
    for (const auto& [f, problem] : m_broken) {
        if (!m_reported.insert(f).second) continue;
        if (m_reported.size() <= kMostNotices) {
            m_services.notices().add(
                {tr("The frame %1 is left out: %2 (%3).").arg(label(f), problem.what, problem.where)});
            continue;
        }
        if (!m_summary.isEmpty()) m_services.notices().remove(m_summary);
        m_summary = tr("%L1 frames in all are left out because they cannot be read.").arg(m_reported.size());
        m_services.notices().add({m_summary});
    }
}

int PlayerController::knownCount() const {
    if (!hasSeries()) return 0;
    const TimeSeries& series = *m_services.scene().series;
    int known = 0;
    for (int f = 0; f < series.size(); ++f)
        if (series.summary(f).isKnown) ++known;
    return known;
}

bool PlayerController::isSurveying() const {
    return hasSeries() && !m_surveyStopped && !m_services.scene().series->isSurveyed();
}

void PlayerController::stopSurvey() {
    m_surveyStopped = true;
    Q_EMIT surveyed();
}

void PlayerController::goOnSurveying() {
    m_surveyStopped = false;
    next();
    Q_EMIT surveyed();
}

} // namespace pellucid::gui
