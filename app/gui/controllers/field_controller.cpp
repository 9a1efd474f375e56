#include "controllers/field_controller.h"

#include <array>

#include "dialogs/ask_file.h"
#include "dialogs/save_volume_dialog.h"
#include "services/services.h"
#include "store/edits.h"
#include "volume/volume_writer.h"

namespace pellucid::gui {

FieldController::FieldController(Services& services)
    : m_services(services), m_computing(
                                [&workspace = services.workspace()](const Request& request, const JobControl& job) {
                                    Made made{workspace.field(request.input, request.kind, request.feature, job), {}};
                                    job.throwIfStopped();
                                    made.codes = sharedIntensityGrid(*made.field.volume);
                                    return made;
                                },
                                [this](const Request& request, Made& made) {
                                    m_field = std::move(made.field);
                                    m_codes = std::move(made.codes);
                                    m_shown = request;
                                    setState(State::Current);
                                },
                                WhenBusy::StopOld, &services.compute()),
      m_saving(
          [](const File& file, const JobControl& job) {
              writeVolume(*file.volume, file.path.toStdString(), {}, job);
              return file.path;
          },
          [this](const File&, const QString& path) {
              m_services.saySaved(path);
              Q_EMIT saved(path);
          },
          WhenBusy::Queue) {
    connect(&services.store(), &SessionStore::changed, this, &FieldController::follow);
    connect(&m_computing, &JobBase::progress, this, [this](double fraction) {
        m_progress = fraction;
        Q_EMIT changed();
    });
    connect(&m_computing, &JobBase::failed, this, [this](const Error& error) {
        m_failure = error;
        setState(State::Failed);
    });
    connect(&m_saving, &JobBase::busyChanged, this, &FieldController::busyChanged);
    services.showFailuresOf(m_saving, tr("Cannot save the field"));
}

FieldController::Request FieldController::requestOf(const Scene& scene) {
    return {fieldInput(scene), *scene.session.field->kind, scene.fieldFeature()};
}

void FieldController::setState(State state) {
    m_state = state;
    Q_EMIT changed();
    Q_EMIT busyChanged();
    m_services.actions().refresh();
}

void FieldController::follow(const Scene& before, const Scene& after) {
    const bool off = !after.volume || !after.session.field->kind;
    if (before.volume != after.volume || (off && m_state != State::Off)) { // nothing of it may be seen any more
        m_computing.cancel();
        m_field.reset();
        m_codes.reset();
        m_wanted = m_shown = {};
    }
    if (off) {
        m_rest.stop();
        if (m_state == State::Off) return;
        m_failure.reset();
        return setState(State::Off);
    }
    m_lastKind = *after.session.field->kind;
    Request wanted = requestOf(after);
    if (wanted == m_wanted && m_state != State::Off) return;
    m_wanted = std::move(wanted);
    m_failure.reset();
    m_computing.cancel();
    if (m_field && m_wanted == m_shown) {
        m_rest.stop();
        return setState(State::Current);
    }
    compute();
}

void FieldController::compute() {
    if (!m_wanted.input.volume) return;
    m_progress = 0;
    m_failure.reset();
    m_rest.start();
    setState(State::Computing);
}

void FieldController::cancel() {
    if (m_state != State::Computing) return;
    m_rest.stop();
    m_computing.cancel();
    setState(State::Stopped);
}

PictureInput FieldController::picture(int width, int height, bool transparent) const {
    const Scene& scene = m_services.scene();
    return field() ? fieldPictureInput(scene, *m_field, width, height, transparent)
                   : pictureInput(scene, width, height, transparent);
}

QString FieldController::name() const {
    if (m_state == State::Off) return {};
    return field() ? QString::fromStdString(m_field->volume->title) : QString::fromLatin1(title(m_wanted.kind));
}

QString FieldController::stateText() const {
    if (m_state == State::Off || m_state == State::Current) return {};
    const QString why = m_state == State::Computing ? tr("being computed")
                        : m_state == State::Failed  ? tr("cannot be computed")
                                                    : tr("stopped");
    return field() ? tr("of an earlier state; the present one: %1").arg(why) : why;
}

QString FieldController::valueText(double value) const {
    /// By FieldKind; what values are measured in (docs/method.md, "Fields").
    static const std::array kUnits{QT_TR_NOOP("(0 to 1)"), QT_TR_NOOP("(L*/100)"), QT_TR_NOOP("(C*/100)"),
                                   QT_TR_NOOP("(u1·L*/100 + u2·C*/100)"), QT_TR_NOOP("(of 1 over all voxels)")};
    return QStringLiteral("%1 %2 %3")
        .arg(QString::fromLatin1(title(m_shown.kind)), QString::number(value, 'g', 4),
             tr(kUnits.at(static_cast<std::size_t>(m_shown.kind))));
}

AnnotationInput FieldController::annotation(const PictureInput& picture, const AnnotationChoice& show,
                                            double density) const {
    const Scene& scene = m_services.scene();
    if (m_state == State::Off) return annotationInput(picture, show, density);
    AnnotationInput input = field() ? fieldAnnotationInput(picture, scene, *m_field, show, density)
                                    : annotationInput(picture, show, density);
    if (!show.on) input.show = AnnotationChoice::none();
    input.show.on = input.show.title = true;
    input.show.legend = input.show.legend || field() != nullptr;
    input.title = name().toStdString();
    if (m_state != State::Current)
        input.title += (field() ? " " : ": ") + stateText().toStdString();
    else if (dependsOnView(m_shown.kind) && !(picture.camera == scene.camera))
        input.title += tr(" of another view").toStdString();
    return input;
}

void FieldController::show(std::optional<FieldKind> kind) {
    const QString text = kind ? tr("Field: %1").arg(QString::fromLatin1(title(*kind))) : tr("No field");
    editPart(m_services.store(), &Session::field, text, {}, [&](FieldView& f) { f.kind = kind; });
}

void FieldController::save(const QString& path) {
    if (m_state != State::Current) return;
    m_saving.start({m_field->volume, path}, path);
    Q_EMIT busyChanged();
}

void FieldController::chooseFile() {
    if (m_state != State::Current) return;
    const QString path =
        askSavePath(m_services.window(), tr("Save field"), "fieldFolder",
                    QString::fromStdString(fileStem(m_shown.kind)) + ".nrrd", savedVolumeFilters(), {}, {});
    if (!path.isEmpty()) save(QFileInfo(path).suffix().isEmpty() ? path + ".nrrd" : path);
}

void FieldController::addActions() {
    SessionStore& store = m_services.store();
    ActionMenu menu(m_services.actions(), tr("&View") + "/" + tr("F&ield"), [this] { return m_services.isEditable(); });
    menu.addCheck(
        "fieldAction", tr("&Show a field"), "V", tr("Shows what each voxel contributes in place of the data, and back"),
        [&store] { return store.session().field->kind.has_value(); },
        [this, &store] { show(store.session().field->kind ? std::nullopt : std::optional(m_lastKind)); });
    menu.separate();
    for (const FieldKind kind : allOf<FieldKind>())
        menu.addCheck(
            "field_" + QString::fromStdString(fileStem(kind)), QString::fromLatin1(title(kind)), {}, {},
            [&store, kind] { return store.session().field->kind == kind; }, [this, kind] { show(kind); });
    menu.separate();
    menu.add("saveFieldAction", tr("Save &field…"), {},
             tr("The values of the field that is shown, as an NRRD file on the grid of the data"),
             [this] { chooseFile(); }, {.enabled = [this] { return m_state == State::Current; }});
}

} // namespace pellucid::gui
