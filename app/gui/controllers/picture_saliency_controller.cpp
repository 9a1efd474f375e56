#include "controllers/picture_saliency_controller.h"

#include "dialogs/ask_file.h"
#include "image_io/image_file.h"
#include "render/feature_pictures.h"
#include "services/services.h"
#include "session/live_targets.h"
#include "store/edits.h"

namespace pellucid::gui {

PictureSaliencyController::PictureSaliencyController(Services& services)
    : m_services(services),
      m_looking(
          [renderer = m_renderer](const PictureInput& input, const JobControl& job) {
              const JobControl drawing = job.part(0, 2), looking = job.part(1, 2);
              const FeaturePictures pictures = renderer->use(input.volume, job, [&](ImageRenderer& r) {
                  return featurePictures(r, input.camera, input.tf, input.settings, drawing);
              });
              return featureSaliency(pictures, looking);
          },
          [this](const PictureInput& input, FeatureSaliency& saliency) {
              m_saliency = std::move(saliency);
              m_shown = input;
              setState(State::Current);
          }),
      m_saving(
          [](const File& file, const JobControl&) {
              writePlane(file.plane, file.path.toStdString());
              return file.path;
          },
          [this](const File&, const QString& path) {
              m_services.saySaved(path);
              Q_EMIT saved(path);
          },
          WhenBusy::Queue) {
    connect(&services.store(), &SessionStore::changed, this, &PictureSaliencyController::follow);
    connect(&services.selection(), &Selection::featureChanged, this, [this] {
        ++m_version;
        Q_EMIT changed();
    });
    connect(&m_looking, &JobBase::progress, this, [this](double fraction) {
        m_progress = fraction;
        Q_EMIT changed();
    });
    connect(&m_looking, &JobBase::failed, this, [this](const Error& error) {
        m_failure = error;
        setState(State::Failed);
    });
    connect(&m_saving, &JobBase::busyChanged, this, &PictureSaliencyController::busyChanged);
    services.showFailuresOf(m_saving, tr("Cannot save the saliency map"));
}

void PictureSaliencyController::setState(State state) {
    m_state = state;
    ++m_version;
    Q_EMIT changed();
    Q_EMIT busyChanged();
    m_services.actions().refresh();
}

void PictureSaliencyController::setPictureSize(const QSize& pixels) {
    if (pixels == m_size) return;
    m_size = pixels;
    follow();
}

void PictureSaliencyController::follow() {
    const Scene& scene = m_services.scene();
    const bool field = scene.session.field->kind.has_value();
    if (!scene.volume || !scene.session.pictureSaliency->on || m_size.isEmpty() || field) {
        m_rest.stop();
        m_looking.cancel();
        m_renderer->release();
        m_saliency.reset();
        m_wanted = m_shown = {};
        const State state = scene.volume && scene.session.pictureSaliency->on && field ? State::Field : State::Off;
        if (m_state != state) setState(state);
        return;
    }
    PictureInput wanted = pictureInput(scene, m_size.width(), m_size.height());
    if (wanted == m_wanted && m_state != State::Off && m_state != State::Field) {
        ++m_version; // another map of the same picture
        Q_EMIT changed();
        return;
    }
    m_wanted = std::move(wanted);
    m_failure.reset();
    m_looking.cancel();
    if (m_saliency && m_wanted == m_shown) {
        m_rest.stop();
        return setState(State::Current);
    }
    m_progress = 0;
    m_rest.start();
    setState(State::Computing);
}

std::optional<double> PictureSaliencyController::share(std::size_t feature) const {
    if (!m_saliency || feature >= m_saliency->shares.size() || !sameFeatures(m_shown.tf, m_services.scene().tf))
        return {};
    return m_saliency->shares[feature];
}

std::optional<Plane> PictureSaliencyController::map() const {
    if (m_state != State::Current) return {};
    switch (m_services.scene().session.pictureSaliency->map) {
    case SaliencyMapShown::None:
        return {};
    case SaliencyMapShown::Picture:
        return m_saliency->map;
    case SaliencyMapShown::Feature:
        if (const int feature = m_services.selectedFeature(); feature >= 0)
            return totalOf(*m_saliency, static_cast<std::size_t>(feature));
        return {};
    case SaliencyMapShown::Rest:
        return m_saliency->rest;
    }
    return {};
}

void PictureSaliencyController::save(const QString& path) {
    if (m_state != State::Current) return;
    std::optional<Plane> plane = map();
    m_saving.start({plane ? std::move(*plane) : m_saliency->map, path}, path);
    Q_EMIT busyChanged();
}

void PictureSaliencyController::chooseFile() {
    if (m_state != State::Current) return;
    const QString path = askSavePath(m_services.window(), tr("Save saliency map"), "imageFolder", "saliency.exr",
                                     tr("Maps: OpenEXR with floats (*.exr), PNG with 16 bits (*.png)"), ".png", "");
    if (path.isEmpty()) return;
    const bool known = path.endsWith(".exr", Qt::CaseInsensitive) || path.endsWith(".png", Qt::CaseInsensitive);
    save(known ? path : path + ".exr");
}

void PictureSaliencyController::addActions() {
    SessionStore& store = m_services.store();
    ActionMenu menu(m_services.actions(), tr("&View") + "/" + tr("2&D saliency"),
                    [this] { return m_services.isEditable(); });
    menu.addCheck(
        "followPictureAction", tr("&Show 2D feature saliency"), "Shift+D",
        tr("How much of what catches the eye in this picture each feature has, whenever the picture rests"),
        [&store] { return store.session().pictureSaliency->on; },
        [this, &store] {
            const bool on = !store.session().pictureSaliency->on;
            editPart(store, &Session::pictureSaliency, on ? tr("2D feature saliency") : tr("No 2D feature saliency"),
                     {}, [on](PictureSaliencyView& view) {
                         view.on = on;
                         if (on && view.map == SaliencyMapShown::None) view.map = SaliencyMapShown::Picture;
                     });
            if (on) m_services.panels().show("pictureSaliency");
        });
    menu.separate();
    menu.add("saveSaliencyMapAction", tr("Save saliency &map…"), {},
             tr("The map that lies over the picture, else that of the whole picture, as OpenEXR or PNG"),
             [this] { chooseFile(); }, {.enabled = [this] { return m_state == State::Current; }});
}

} // namespace pellucid::gui
