#include "controllers/keyframes_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/film_controller.h"
#include "controllers/player_controller.h"
#include "dialogs/ask_file.h"
#include "jobs/rest_timer.h"
#include "services/services.h"
#include "session/keyframes_file.h"
#include "store/edits.h"
#include "tf/tf_range.h"

namespace pellucid::gui {
namespace {

constexpr int kTick = 25;            ///< milliseconds between two pictures of a preview, at best
constexpr double kSamePlace = 0.005; ///< s: as near as times are written

QString filmFilter() { return QObject::tr("Keyframes (*.film.json)"); }

} // namespace

KeyframesController::KeyframesController(Services& services, PlayerController& player, FilmController& films)
    : m_services(services), m_player(player), m_films(films) {
    m_timer.setInterval(kTick);
    connect(&m_timer, &QTimer::timeout, this, [this] {
        const double time = m_playedFrom + 1e-3 * static_cast<double>(m_clock.elapsed());
        moveTo(std::min(time, length()));
        if (time >= length()) pause();
    });
    connect(&services.store(), &SessionStore::changed, this, &KeyframesController::follow);
    connect(&services, &Services::readOnlyChanged, this, [this] {
        if (!m_services.isReadOnly()) return;
        m_timer.stop(); // what shows its moves now has ended the preview
        m_before.reset();
        m_dragged.reset();
        m_awaited.reset();
        Q_EMIT changed();
    });
    connect(this, &KeyframesController::changed, &services.actions(),
            [this, wasPlaying = false, had = std::size_t{0}, was = -1]() mutable {
                const bool same = wasPlaying == isPlaying() && had == keys().size() && was == selected();
                wasPlaying = isPlaying();
                had = keys().size();
                was = selected();
                if (!same) m_services.actions().refresh();
            });
}

void KeyframesController::addActions() {
    ActionMenu menu(m_services.actions(), tr("T&ime") + "/" + tr("Ke&yframes"),
                    [this] { return m_services.isEditable() && !keys().empty(); });
    const auto editable = [this] { return m_services.isEditable(); };
    m_actions.add = menu.add(
        "addKeyframeAction", tr("&Add key"), "Ctrl+Alt+A",
        tr("Keeps the view, transfer function, clipping, light and frame that are shown as a key of a film"),
        [this] { add(); }, {.enabled = [this] { return m_services.isEditable() && keys().size() < kMostKeyframes; }});
    m_actions.replace = menu.add("replaceKeyframeAction", tr("&Replace key"), {},
                                 tr("The selected key gets what is shown now"), [this] { replace(); });
    m_actions.remove = menu.add("removeKeyframeAction", tr("Re&move key"), {},
                                tr("Takes the selected key out of the film"), [this] { remove(); });
    menu.separate();
    m_actions.previous = menu.add("previousKeyframeAction", tr("&Previous key of the film"), {},
                                  tr("Selects the key before, and shows what it has"), [this] { selectBeside(-1); },
                                  {.enabled = [this] { return m_services.isEditable() && selected() > 0; }});
    m_actions.next = menu.add(
        "nextKeyframeAction", tr("&Next key of the film"), {}, tr("Selects the key after, and shows what it has"),
        [this] { selectBeside(1); },
        {.enabled = [this] { return m_services.isEditable() && selected() + 1 < static_cast<int>(keys().size()); }});
    m_actions.play =
        menu.add("playKeyframesAction", tr("P&lay keyframes"), {},
                 tr("Shows the film in the view, in real time; pictures that would be late are left out"),
                 [this] { isPlaying() ? pause() : play(); },
                 {.enabled = [this] { return m_services.isEditable() && keys().size() > 1; },
                  .caption = [this] { return isPlaying() ? tr("Pause keyframes") : tr("P&lay keyframes"); }});
    menu.separate();
    m_actions.open = menu.add("openKeyframesAction", tr("&Open keyframes…"), {},
                              tr("Keys from a file (*.film.json), in the place of those that there are"),
                              [this] {
                                  const QString path =
                                      QFileDialog::getOpenFileName(m_services.window(), tr("Open keyframes"),
                                                                   keptFolder("filmFolder"), filmFilter());
                                  if (path.isEmpty()) return;
                                  keepFolderOf("filmFolder", path);
                                  open(path);
                              },
                              {.enabled = editable});
    m_actions.save = menu.add(
        "saveKeyframesAction", tr("&Save keyframes as…"), {},
        tr("Writes the keys to a file (*.film.json), which pellucid-cli film takes, too; a session has them anyway"),
        [this] {
            const QString name = QFileInfo(QString::fromStdString(m_services.scene().volume->title)).baseName();
            const QString path = askSavePath(m_services.window(), tr("Save keyframes"), "filmFolder",
                                             name + kFilmSuffix, filmFilter(), kFilmSuffix, kFilmSuffix);
            if (!path.isEmpty()) save(path);
        });
    m_actions.film =
        menu.add("saveKeyframeFilmAction", tr("Save &film of keyframes…"), {},
                 tr("A film that goes from key to key, or its pictures"), [this] { m_films.choose(FilmKind::Keys); });
}

// ---- keys

const Keyframes& KeyframesController::keys() const { return *m_services.store().session().keyframes; }

int KeyframesController::selected() const { return std::min(m_selected, static_cast<int>(keys().size()) - 1); }

double KeyframesController::length() const { return keys().empty() ? 0 : keys().back().time; }

bool KeyframesController::isAtKey(int key) const {
    return std::abs(keys().at(static_cast<std::size_t>(key)).time - m_playhead) < kSamePlace;
}

double KeyframesController::timeOfNext() const {
    for (int n = 0; n < static_cast<int>(keys().size()); ++n)
        if (isAtKey(n)) return length() + kUsualWay;
    return m_playhead;
}

void KeyframesController::edit(const QString& text, const QString& mergeKey,
                               const std::function<void(Keyframes&)>& change) {
    if (!m_services.isEditable()) return;
    pause();
    rest();
    editPart(m_services.store(), &Session::keyframes, text, mergeKey, change);
    Q_EMIT changed();
}

void KeyframesController::add() {
    if (!m_services.isEditable() || keys().size() >= kMostKeyframes) return;
    pause();
    rest();
    Keyframe key{timeOfNext()};
    key.state = keyStateOf(m_services.scene());
    std::size_t place = 0;
    edit(tr("Add key"), {}, [&](Keyframes& all) {
        place = putKey(all, key);
        const std::size_t last = all.size() - 1;
        if (all[last].time > kMostFilmSeconds) place = moveKey(all, last, kMostFilmSeconds);
        if (place > 0) all[place].easing = all[place - 1].easing; // as the way was that it divides, or goes on from
    });
    m_selected = static_cast<int>(place);
    m_playhead = keys()[place].time;
    Q_EMIT changed();
    Q_EMIT m_services.message(tr("Key %1 at %2 s").arg(m_selected + 1).arg(m_playhead, 0, 'f', 2));
}

void KeyframesController::replace() {
    const int key = selected();
    if (key < 0 || !m_services.isEditable()) return;
    pause();
    rest();
    edit(tr("Replace key"), {}, [&, state = keyStateOf(m_services.scene())](Keyframes& all) {
        all[static_cast<std::size_t>(key)].state = state;
    });
    m_playhead = keys()[static_cast<std::size_t>(key)].time; // what is shown is what it has
    Q_EMIT changed();
}

void KeyframesController::remove() {
    const int key = selected();
    if (key >= 0) edit(tr("Remove key"), {}, [&](Keyframes& all) { all.erase(all.begin() + key); });
}

void KeyframesController::setTime(double seconds) {
    const int key = selected();
    if (key < 0 || !m_services.isEditable()) return;
    const bool follows = isAtKey(key);
    edit(tr("Time of key"), "keyframes.time",
         [&](Keyframes& all) { m_selected = static_cast<int>(moveKey(all, static_cast<std::size_t>(key), seconds)); });
    if (follows) m_playhead = keys()[static_cast<std::size_t>(m_selected)].time;
    Q_EMIT changed();
}

void KeyframesController::rename(const QString& name) {
    const int key = selected();
    if (key >= 0)
        edit(tr("Name of key"), {},
             [&](Keyframes& all) { all[static_cast<std::size_t>(key)].name = name.toStdString(); });
}

void KeyframesController::setEasing(Easing easing) {
    const int key = selected();
    if (key >= 0)
        edit(tr("Way to the next key"), {},
             [&](Keyframes& all) { all[static_cast<std::size_t>(key)].easing = easing; });
}

void KeyframesController::select(int key) {
    if (key < 0 || key >= static_cast<int>(keys().size())) return;
    pause();
    m_selected = key;
    goTo(keys()[static_cast<std::size_t>(key)].time);
}

void KeyframesController::selectBeside(int by) {
    if (!keys().empty()) select(std::clamp(selected() + by, 0, static_cast<int>(keys().size()) - 1));
}

void KeyframesController::dragKey(int key, double time) {
    if (!m_services.isEditable()) return;
    if (!m_dragged) {
        pause();
        rest();
        m_dragged = key;
    }
    Keyframes moved = *m_services.store().committed().session.keyframes;
    m_selected = static_cast<int>(moveKey(moved, static_cast<std::size_t>(*m_dragged), time));
    m_services.store().preview(tr("Time of key"), changing(&Session::keyframes, [&](Keyframes& all) { all = moved; }));
    Q_EMIT changed();
}

void KeyframesController::endDrag(bool keeps) {
    if (!m_dragged) return;
    if (!keeps) m_selected = *m_dragged;
    m_dragged.reset();
    keeps ? m_services.store().commit() : m_services.store().cancel();
    Q_EMIT changed();
}

// ---- the playhead

void KeyframesController::moveTo(double time) {
    if (!m_services.isEditable()) return;
    if (!m_before)
        m_before =
            Before{m_services.scene().camera, m_services.scene().session.frame, m_playhead, SessionStore::newGesture()};
    m_playhead = std::clamp(time, 0.0, kMostFilmSeconds);
    for (int n = 0; n < static_cast<int>(keys().size()); ++n)
        if (isAtKey(n)) m_selected = n;
    show();
    Q_EMIT changed();
}

void KeyframesController::show() {
    if (keys().empty()) return;
    SessionStore& store = m_services.store();
    const Scene& scene = store.scene();
    const KeyState state = stateAt(keys(), m_playhead, scene.volume->geometry());
    m_awaited.reset();
    if (m_player.hasSeries() && state.frame != m_player.awaited().value_or(scene.session.frame))
        m_player.goTo(state.frame);
    if (m_player.awaited() == state.frame) m_awaited = state.frame;
    const TransferFunction tf = inRange(state.tf, scene.volume->range());
    store.preview(tr("Show keyframes"), [=](Session& session) {
        session.holdTargets = false; // both set opacities
        session.setTf(tf);
        session.clipping.set(state.clipping);
        session.display.edit([&](DisplaySettings& d) { d.light = state.light; });
    });
    store.setCamera(state.camera, m_before ? m_before->gesture : 0);
}

void KeyframesController::rest() {
    if (!m_before) return;
    m_before.reset();
    if (!keys().empty()) m_services.store().commit("keyframes.show");
    Q_EMIT changed();
}

void KeyframesController::giveUp() {
    m_timer.stop();
    if (m_before) {
        const Before before = *std::exchange(m_before, std::nullopt);
        m_awaited.reset();
        m_playhead = before.playhead;
        if (!keys().empty()) {
            m_services.store().cancel();
            m_services.store().setCamera(before.camera, before.gesture);
            if (m_player.hasSeries()) m_player.goTo(before.frame);
        }
    }
    Q_EMIT changed();
}

void KeyframesController::goTo(double time) {
    moveTo(time);
    rest();
}

void KeyframesController::play() {
    if (!m_services.isEditable() || keys().size() < 2 || isPlaying()) return;
    m_player.pause();
    m_playedFrom = m_playhead < length() - kSamePlace ? m_playhead : keys().front().time;
    m_clock.start();
    m_timer.start();
    moveTo(m_playedFrom);
}

void KeyframesController::pause() {
    if (!isPlaying()) return;
    m_timer.stop();
    rest();
}

void KeyframesController::follow(const Scene& before, const Scene& after) {
    if (before.series != after.series || after.volume == nullptr) {
        m_timer.stop();
        m_before.reset();
        m_dragged.reset();
        m_awaited.reset();
        m_playhead = 0;
        m_selected = 0;
    }
    if (before.session.frame != after.session.frame && m_awaited) {
        // The key's transfer function belongs to the frame that has come.
        if (std::exchange(m_awaited, std::nullopt) == after.session.frame)
            later(this, [this, time = m_playhead] {
                if (time != m_playhead || !m_services.isEditable()) return;
                m_before ? show() : goTo(time);
            });
    }
    if (!before.session.keyframes.isSame(after.session.keyframes) || before.volume != after.volume) Q_EMIT changed();
}

// ---- files

void KeyframesController::open(const QString& path) {
    if (!m_services.isEditable()) return;
    m_services.attempt(tr("Cannot open the keyframes"), [&] {
        Keyframes keys = readKeyframes(path.toStdString(), m_services.scene());
        for (Keyframe& key : keys) // identities are those of the session that the file is of
            for (Feature& feature : key.state.tf.features) feature.id = 0;
        edit(tr("Open keyframes"), {}, [&](Keyframes& all) { all = keys; });
        m_selected = 0;
        m_playhead = keys.front().time;
        Q_EMIT changed();
        const QString file = QFileInfo(path).fileName();
        Q_EMIT m_services.message(keys.size() == 1 ? tr("One key from %1").arg(file)
                                                   : tr("%L1 keys from %2").arg(keys.size()).arg(file));
    });
}

void KeyframesController::save(const QString& path) {
    if (m_services.attempt(tr("Cannot save the keyframes"), [&] { writeKeyframes(keys(), path.toStdString()); }))
        m_services.saySaved(path);
}

} // namespace pellucid::gui
