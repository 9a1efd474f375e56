#include "controllers/field_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QSettings>

#include "services/services.h"
#include "volume/loader.h"

namespace pellucid::gui {
namespace {

constexpr int kRest = 150; ///< milliseconds without a change before a field is computed

} // namespace

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
          [](const File& file, const JobControl&) {
              writeNrrd(*file.volume, file.path.toStdString());
              return file.path;
          },
          [this](const File&, const QString& path) {
              Q_EMIT m_services.message(tr("Saved %1").arg(QFileInfo(path).fileName()));
              Q_EMIT saved(path);
          },
          WhenBusy::Queue) {
    m_rest.setSingleShot(true);
    m_rest.setInterval(kRest);
    connect(&m_rest, &QTimer::timeout, this, &FieldController::begin);
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
    connect(&m_saving, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("Cannot save the field"), error); });
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
    if (before.volume != after.volume) { // nothing of it may be seen any more
        m_computing.cancel();
        m_field.reset();
        m_codes.reset();
        m_wanted = m_shown = {};
    }
    if (!after.volume || !after.session.field->kind) {
        m_rest.stop();
        if (m_state == State::Off) return;
        m_computing.cancel();
        m_field.reset();
        m_codes.reset();
        m_wanted = m_shown = {};
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

void FieldController::begin() { m_computing.start(m_wanted, QString::fromStdString(m_wanted.input.volume->title)); }

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

AnnotationInput FieldController::annotation(const PictureInput& picture, const FrameOfReference& show,
                                            double density) const {
    const Scene& scene = m_services.scene();
    if (m_state == State::Off) return annotationInput(picture, show, density);
    AnnotationInput input = field() ? fieldAnnotationInput(picture, scene, *m_field, show, density)
                                    : annotationInput(picture, show, density);
    if (!show.on) input.show = FrameOfReference::none();
    input.show.on = input.show.title = true;
    input.show.legend = input.show.legend || field() != nullptr;
    if (m_state == State::Current) {
        if (dependsOnView(m_shown.kind) && !(picture.camera == scene.camera))
            input.title += tr(" of another view").toStdString();
        return input;
    }
    const std::string why = (m_state == State::Computing ? tr("being computed")
                             : m_state == State::Failed  ? tr("cannot be computed")
                                                         : tr("stopped"))
                                .toStdString();
    const std::string present = title(m_wanted.kind);
    input.title =
        field() ? input.title + " " +
                      tr("of an earlier state; the present one: %1").arg(QString::fromStdString(why)).toStdString()
                : present + ": " + why;
    return input;
}

void FieldController::show(std::optional<FieldKind> kind) {
    m_services.store().edit(kind ? tr("Field: %1").arg(QString::fromLatin1(title(*kind))) : tr("No field"), {},
                            [&](Session& session) { session.field.edit([&](FieldView& f) { f.kind = kind; }); });
}

void FieldController::save(const QString& path) {
    if (m_state != State::Current) return;
    m_saving.start({m_field->volume, path}, path);
    Q_EMIT busyChanged();
}

void FieldController::chooseFile() {
    if (m_state != State::Current) return;
    const QString folder = QSettings().value("fieldFolder").toString();
    const QString offered = QString::fromStdString(fileStem(m_shown.kind)) + ".nrrd";
    QString path = QFileDialog::getSaveFileName(m_services.window(), tr("Save field"), QDir(folder).filePath(offered),
                                                tr("NRRD volumes (*.nrrd)"));
    if (path.isEmpty()) return;
    if (!path.endsWith(".nrrd", Qt::CaseInsensitive)) path += ".nrrd";
    QSettings().setValue("fieldFolder", QFileInfo(path).absolutePath());
    save(path);
}

void FieldController::addActions() {
    Actions& actions = m_services.actions();
    SessionStore& store = m_services.store();
    const auto open = [this, &store] { return m_services.isEditable(); };
    const QString menu = tr("&View") + "/" + tr("F&ield");
    actions.add(menu, "fieldAction", tr("&Show a field"), "V",
                tr("What each voxel contributes in the place of the data, and back"),
                [this, &store] { show(store.session().field->kind ? std::nullopt : std::optional(m_lastKind)); }, open,
                {.checked = [&store] { return store.session().field->kind.has_value(); }});
    bool first = true;
    for (const FieldKind kind : allOf<FieldKind>())
        actions.add(menu, QStringLiteral("field_%1").arg(QString::fromStdString(fileStem(kind))),
                    QString::fromLatin1(title(kind)), {}, {}, [this, kind] { show(kind); }, open,
                    {.checked = [&store, kind] { return store.session().field->kind == kind; },
                     .separatorBefore = std::exchange(first, false)});
    actions.add(
        menu, "saveFieldAction", tr("Save &field…"), {},
        tr("The values of the field that is shown, as NRRD file on the grid of the data"), [this] { chooseFile(); },
        [this] { return m_state == State::Current; }, {.separatorBefore = true});
}

} // namespace pellucid::gui
