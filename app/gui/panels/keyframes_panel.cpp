#include "panels/keyframes_panel.h"

#include <QAction>
#include <QLineEdit>
#include <QMenu>

#include "controllers/controllers.h"
#include "panels/key_strip.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "widgets/controls.h"
#include "widgets/image_convert.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kWait = 250; ///< milliseconds after the last change, so that a hand is not slowed

constexpr Easing kEasings[] = {Easing::Linear, Easing::Smooth, Easing::EaseIn, Easing::EaseOut, Easing::Hold};

QString tipOf(Easing easing) {
    switch (easing) {
    case Easing::Linear:
        return QObject::tr("At an even speed; a key between two such ways is passed without a stop");
    case Easing::Smooth:
        return QObject::tr("Starts slowly and ends slowly");
    case Easing::EaseIn:
        return QObject::tr("Starts slowly, and passes the next key at full speed");
    case Easing::EaseOut:
        return QObject::tr("Goes on at full speed, and ends slowly");
    case Easing::Hold:
        return QObject::tr("Stays as the key is until the next key's time");
    }
    return {};
}

/// What the pictures depend on beside the keys; of a series not which frame is shown, since keys say that.
struct Look {
    std::shared_ptr<const Volume> volume;
    std::shared_ptr<TimeSeries> series;
    PictureInput input;
    bool operator==(const Look&) const = default;
};
Look lookOf(const Scene& scene, const KeyState& any) {
    Look look{scene.volume, scene.series, pictureInput(withKeyState(scene, any), 1, 1)};
    if (!scene.series->varies()) return look;
    look.volume = look.input.volume = nullptr;
    look.input.settings.colors = nullptr; // of a frame
    return look;
}

} // namespace

PanelInfo keyframesPanel() {
    return {
        .id = "keyframes",
        .title = QObject::tr("Keyframes"),
        .group = PanelGroup::Time,
        .area = Qt::BottomDockWidgetArea,
        .visible = false,
        .tabOf = "tf",
        .keys = QKeySequence("Ctrl+Alt+K"),
        .tip = QObject::tr("Put a film together: keep what is shown as keys along time, see the way between them, save "
                           "it"),
        .make = [](Services& services, Controllers& controllers, QWidget* parent) {
            const QString place = QObject::tr("Keyframes");
            services.actions().addGestures(
                {{place, QObject::tr("Drag over the scale"), QObject::tr("show the film at that time")},
                 {place, QObject::tr("Click a key"), QObject::tr("select it")},
                 {place, QObject::tr("Drag a key"), QObject::tr("give it another time")},
                 {place, QObject::tr("← and →, with Shift"), QObject::tr("0.1 s back, on; 1 s")},
                 {place, QObject::tr("Page up, page down"), QObject::tr("from key to key")},
                 {place, QObject::tr("Ctrl+← and Ctrl+→"), QObject::tr("give the key another time")},
                 {place, QObject::tr("Insert, Delete"), QObject::tr("add, remove a key")},
                 {place, QObject::tr("Space, Esc"), QObject::tr("play, go back to what was shown before")}});
            return new KeyframesPanel(services, controllers.keyframes, parent);
        }};
}

KeyframesPanel::KeyframesPanel(Services& services, KeyframesController& keyframes, QWidget* parent)
    : QWidget(parent), m_services(services), m_keyframes(keyframes), m_strip(new KeyStrip(this)),
      m_time(named(new QLabel(this), "keyframesTime", tr("Where the playhead is, and how long the film is, s"))),
      m_key(named(new QComboBox(this), "keyframesKey", tr("The keys, and which one is selected"))),
      m_easing(named(new QComboBox(this), "keyframesEasing", tr("How the film goes from this key to the next one"))),
      m_at(named(new NumberBox(this), "keyframesAt", tr("The time of the selected key in the film, s, 0 to 3600"))),
      m_name(named(new QLineEdit(this), "keyframesName", tr("What you call the selected key"))),
      m_wait(kWait, [this] { draw(); }), m_renderer(std::make_shared<KeptRenderer>()),
      m_job(
          [this, renderer = m_renderer](const Task& task, const JobControl& job) {
              return drawAll(task, *renderer, job, [&](double time, const Image& image) {
                  m_job.post([this, number = task.number, time, picture = qImageFromImage(image)] {
                      if (number == m_number) m_strip->setPicture(time, picture);
                  });
              });
          },
          [](const Task&, int&) {}) {
    setObjectName("keyframesPanel");
    setLayout(inset(columnOf({buttonRow(), {m_strip, 1}, keyRow()}, 4), {6, 4, 6, 6}));
    listen();
    follow();
}

QLayout* KeyframesPanel::buttonRow() {
    const KeyframeActions& does = m_keyframes.actions();
    m_play = actionButton(*does.play, "keyframesPlay", tr("Play"), this);
    auto* const files = menuButton(tr("File"), this);
    named(files, "keyframesFile", tr("Opens keyframes from a file (*.film.json), or writes them to one"));
    files->menu()->addActions({does.open, does.save});
    makeFaint(*withAnyWidth(m_time));
    return rowOf({actionButton(*does.add, "keyframesAdd", tr("Add key"), this),
                  actionButton(*does.replace, "keyframesReplace", tr("Replace"), this),
                  actionButton(*does.remove, "keyframesRemove", tr("Remove"), this),
                  Cell::gap(6),
                  actionButton(*does.previous, "keyframesPrevious", tr("‹ key"), this),
                  m_play,
                  actionButton(*does.next, "keyframesNext", tr("key ›"), this),
                  Cell::gap(6),
                  {m_time, 1},
                  files,
                  actionButton(*does.film, "keyframesFilm", tr("Save film…"), this)},
                 3);
}

QLayout* KeyframesPanel::keyRow() {
    withLook(m_at, {.lo = 0, .hi = kMostFilmSeconds, .decimals = 2, .step = 0.1, .suffix = tr(" s")});
    for (const Easing easing : kEasings)
        addItem(*m_easing, easingText(easing), static_cast<int>(easing), tipOf(easing));
    m_key->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_key->setMinimumContentsLength(8);
    m_name->setMinimumWidth(48);
    m_name->setPlaceholderText(tr("no name"));
    const auto label = [this](const QString& text, QWidget* buddy) {
        auto* const made = new QLabel(text, this);
        made->setBuddy(buddy);
        buddy->setAccessibleName(text);
        return made;
    };
    return rowOf({label(tr("Key"), m_key),
                  {m_key, 1},
                  label(tr("Time"), m_at),
                  m_at,
                  label(tr("Name"), m_name),
                  {m_name, 1},
                  label(tr("To the next"), m_easing),
                  m_easing},
                 5);
}

void KeyframesPanel::listen() {
    KeyframesController& keyframes = m_keyframes;
    connect(&keyframes, &KeyframesController::changed, this, &KeyframesPanel::follow);
    connect(&m_services, &Services::readOnlyChanged, this, &KeyframesPanel::follow);
    connect(&m_services.store(), &SessionStore::changed, this, &KeyframesPanel::followScene);
    connect(&m_services.panels(), &Panels::visibilityChanged, this, [this](const QString& id, bool visible) {
        if (id == "keyframes") setShown(visible);
    });
    connect(m_key, &QComboBox::activated, &keyframes, &KeyframesController::select);
    connect(m_at, &QDoubleSpinBox::valueChanged, &keyframes, &KeyframesController::setTime);
    connect(m_name, &QLineEdit::editingFinished, this, [this] { m_keyframes.rename(m_name->text().trimmed()); });
    connect(m_easing, &QComboBox::activated, this,
            [this](int index) { m_keyframes.setEasing(static_cast<Easing>(m_easing->itemData(index).toInt())); });

    connect(m_strip, &KeyStrip::picturesWanted, this, &KeyframesPanel::drawSoon);
    connect(m_strip, &KeyStrip::playheadMoved, this, [this](double time) {
        m_keyframes.pause();
        m_keyframes.moveTo(time);
    });
    connect(m_strip, &KeyStrip::playheadRested, &keyframes, &KeyframesController::rest);
    connect(m_strip, &KeyStrip::keySelected, &keyframes, &KeyframesController::select);
    connect(m_strip, &KeyStrip::keyDragged, &keyframes, &KeyframesController::dragKey);
    connect(m_strip, &KeyStrip::keyDropped, this, [this] { m_keyframes.endDrag(true); });
    connect(m_strip, &KeyStrip::givenUp, this, [this] {
        m_keyframes.endDrag(false);
        m_keyframes.giveUp();
    });
    connect(m_strip, &KeyStrip::stepWanted, this, [this](double by) {
        m_keyframes.pause();
        m_keyframes.goTo(m_keyframes.playhead() + by);
    });
    connect(m_strip, &KeyStrip::keyStepWanted, &keyframes, &KeyframesController::selectBeside);
    connect(m_strip, &KeyStrip::keyTimeWanted, &keyframes, &KeyframesController::setTime);
    connect(m_strip, &KeyStrip::addWanted, &keyframes, &KeyframesController::add);
    connect(m_strip, &KeyStrip::removeWanted, &keyframes, &KeyframesController::remove);
    connect(m_strip, &KeyStrip::playWanted, m_keyframes.actions().play, &QAction::trigger);
}

void KeyframesPanel::follow() {
    const Keyframes& keys = m_keyframes.keys();
    const int selected = m_keyframes.selected();
    const bool editable = m_services.isEditable();
    m_strip->setEditable(editable);
    m_strip->setKeys(keys, selected);
    m_strip->setPlayhead(m_keyframes.playhead());
    m_play->setText(m_keyframes.isPlaying() ? tr("Pause") : tr("Play"));
    m_time->setText(
        keys.empty()
            ? QString()
            : tr("%L1 s of %L2 s").arg(m_keyframes.playhead(), 0, 'f', 2).arg(m_keyframes.length(), 0, 'f', 2));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_key, m_at, m_name})
        widget->setEnabled(editable && selected >= 0);
    m_easing->setEnabled(editable && selected >= 0 && selected + 1 < static_cast<int>(keys.size()));
    QStringList texts;
    for (int n = 0; n < static_cast<int>(keys.size()); ++n) texts << keyText(keys, n);
    bool same = texts.size() == m_key->count();
    for (int n = 0; same && n < texts.size(); ++n) same = m_key->itemText(n) == texts[n];
    if (!same) {
        m_key->clear();
        m_key->addItems(texts);
    }
    m_key->setCurrentIndex(selected);
    if (selected < 0) {
        const QSignalBlocker quiet(m_at);
        m_at->setValue(0);
        m_name->clear();
        return;
    }
    const Keyframe& key = keys[static_cast<std::size_t>(selected)];
    showNumber(*m_at, key.time);
    if (const QString name = QString::fromStdString(key.name); name != m_name->text()) m_name->setText(name);
    m_easing->setCurrentIndex(m_easing->findData(static_cast<int>(key.easing)));
}

void KeyframesPanel::followScene(const Scene& before, const Scene& after) {
    if (before.volume != after.volume) m_renderer->release();
    const Keyframes& keys = m_keyframes.keys();
    if (keys.empty() || after.volume == nullptr) return;
    const KeyState& any = keys.front().state;
    if (before.volume == nullptr || !(lookOf(before, any) == lookOf(after, any))) m_strip->forgetPictures();
}

void KeyframesPanel::setShown(bool shown) {
    m_shown = shown;
    if (!shown) m_renderer->release();
    if (shown && m_stale) draw();
}

void KeyframesPanel::drawSoon() {
    m_stale = true;
    ++m_number; // what is still being drawn is of other keys, or of another look
    m_job.cancel();
    if (m_shown) m_wait.start();
}

void KeyframesPanel::draw() {
    if (!m_shown || !m_services.store().hasVolume()) return;
    m_stale = false;
    const std::vector<KeyStrip::Slot>& places = m_strip->places();
    if (places.empty()) return;
    const double density = devicePixelRatioF();
    Task task{m_services.store().committed(),
              {},
              std::max(1, static_cast<int>(places.front().rect.width() * density)),
              std::max(1, static_cast<int>(places.front().rect.height() * density)),
              ++m_number};
    task.scene.session.keyframes = m_services.store().session().keyframes; // of a drag under way, too
    for (const KeyStrip::Slot& place : places)
        if (place.picture.width() != task.width || place.picture.height() != task.height)
            task.times.push_back(place.time);
    if (!task.times.empty()) m_job.start(std::move(task), tr("the keyframes"));
}

/// Coarser than the film, as the pictures are small.
int KeyframesPanel::drawAll(const Task& task, KeptRenderer& renderer, const JobControl& job,
                            const std::function<void(double time, const Image&)>& show) {
    int drawn = 0;
    const Keyframes& keys = *task.scene.session.keyframes;
    for (const double time : task.times) {
        job.throwIfStopped();
        try {
            const KeyState state = stateAt(keys, time, task.scene.volume->geometry());
            PictureInput picture = pictureInput(sceneAtKey(task.scene, state, {job.stop, {}}), task.width, task.height);
            picture.settings.stepInD0 = 1;
            picture.settings.finestInD0.reset();
            show(time, renderer.render(picture, {job.stop, {}}));
            ++drawn;
        } catch (const FileError&) { // a frame that cannot be read has no picture; the film leaves it out, too
        }
    }
    return drawn;
}

} // namespace pellucid::gui
