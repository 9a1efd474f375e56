#include "controllers/save_controller.h"

#include "services/recent_files.h"

#include <algorithm>
#include <filesystem>

#include <QApplication>
#include <QClipboard>
#include <QMessageBox>

#include "base/memory.h"
#include "base/text.h"
#include "controllers/field_controller.h"
#include "controllers/picture_saliency_controller.h"
#include "controllers/ruler_controller.h"
#include "dialogs/ask_file.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "image_io/layer_files.h"
#include "render/annotation_raster.h"
#include "render/picture_layers.h"
#include "report/drawing_file.h"
#include "report/report.h"
#include "report/session_picture.h"
#include "report/share_bars.h"
#include "report/tf_plot.h"
#include "services/services.h"
#include "session/caption.h"
#include "session/scene_data.h"
#include "session/session_json.h"
#include "tf/formats/tf_file.h"
#include "version.h"
#include "volume/excerpt.h"
#include "volume/volume_writer.h"

namespace pellucid::gui {
namespace {

QString baseName(const Scene& scene) {
    return QFileInfo(QString::fromStdString(scene.volume->title)).completeBaseName();
}

/// Throws Error where they are not there yet.
const Measures& presentMeasures(Services& services) {
    const Results& results = services.results();
    if (results.failure()) throw *results.failure();
    if (!results.measures() || !results.measuresAreCurrent())
        throw Error("the bars are still being measured", services.scene().volume->title,
                    "try again when they are there");
    return *results.measures();
}

/// As the panel shows them. Throws likewise.
std::vector<ShareBar> presentBars(Services& services, const PictureSaliencyController& pictureSaliency) {
    const Scene& scene = services.scene();
    std::vector<ShareBar> bars = shareBarsOf(scene.tf, presentMeasures(services).features);
    const std::vector<double> targets = scene.targets();
    for (std::size_t f = 0; f < bars.size(); ++f) {
        bars[f].target = targets.at(f);
        if (pictureSaliency.state() == PictureSaliencyController::State::Current) bars[f].fs = pictureSaliency.share(f);
    }
    return bars;
}

} // namespace

SaveController::SaveController(Services& services, FieldController& fields,
                               const PictureSaliencyController& pictureSaliency, const RulerController& rulers)
    : m_services(services), m_fields(fields), m_pictureSaliency(pictureSaliency), m_rulers(rulers),
      m_images(
          [](const Picture& picture, const JobControl& job) {
              write(picture, job);
              return picture.path;
          },
          [this](const Picture&, const QString& path) {
              m_services.saySaved(path);
              Q_EMIT imageSaved(path);
          },
          WhenBusy::Queue),
      m_reports(
          [&workspace = services.workspace()](const ReportTask& task, const JobControl& job) {
              ReportRequest request{.run = task.run, .scene = sceneAtStart(task.run, task.now, job)};
              request.session = sessionAtStart(task.run, task.now.session);
              request.command = std::string("pellucid-cli optimize --session ") + kStartFile;
              request.program = std::string("Pellucid ") + kVersion;
              writeReport(makeReport(request, workspace, job), task.folder.toStdString());
              return task.folder;
          },
          [this](const ReportTask&, const QString& folder) { m_services.saySaved(folder, tr("with the report")); },
          WhenBusy::Queue, &services.compute()),
      m_volumes(
          [](const VolumeTask& task, const JobControl& job) {
              const std::string path = task.path.toStdString();
              std::vector<std::string> lost = task.notices;
              for (std::string& notice : task.volume ? writeVolume(*task.volume, path, task.part, job)
                                                     : writeSeries(*task.series, path, task.part, job, task.notices))
                  lost.push_back(std::move(notice));
              return lost;
          },
          [this](const VolumeTask& task, const std::vector<std::string>& lost) {
              m_services.saySaved(task.path);
              for (const std::string& notice : lost) m_services.notices().add({QString::fromStdString(notice)});
              Q_EMIT volumeSaved(task.path);
          },
          WhenBusy::Queue) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_images, &m_reports, &m_volumes}) follow(*job);
    services.showFailuresOf(m_reports, tr("Cannot save the report"));
    services.showFailuresOf(m_images, tr("Cannot save the image"));
    services.showFailuresOf(m_volumes, tr("Cannot save the volume"));
}

void SaveController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.separate();
    menu.add("saveSessionAction", tr("&Save session"), "Ctrl+S",
             tr("All your settings and the name of the data, so that you can continue later"),
             [this] { chooseSession(false); });
    menu.add("saveSessionAsAction", tr("Save session &as…"), "Ctrl+Shift+S", {}, [this] { chooseSession(true); });
    menu.separate();
    menu.add("saveTfAction", tr("Sa&ve transfer function"), "Ctrl+T", {}, [this] { chooseTf(false); });
    menu.add("saveTfAsAction", tr("Save transfer f&unction as…"), "Ctrl+Shift+T", {}, [this] { chooseTf(true); });
    menu.add("saveTfDrawingAction", tr("Save transfer function as &drawing…"), {},
             tr("The curve in its colours, over the histogram"), [this] { chooseTfDrawing(); });
    menu.separate();
    menu.add("saveVolumeAction", tr("Save vo&lume as…"), {},
             tr("The data or the field that is drawn, one frame or all, as NRRD, MetaImage, NIfTI, VTK image data, "
                "TIFF or OME-Zarr"),
             [this] { chooseVolume(); });
    menu.separate();
    menu.add("saveImageAction", tr("Save &image…"), "Ctrl+E", tr("Save the picture, or its layers"),
             [this] { chooseImage(); }, {.inToolBar = true});
    m_barsAction =
        menu.add("saveBarsAction", tr("Save &bars…"), {},
                 tr("How much of each feature is seen and catches the eye, as bar charts in the features' colours"),
                 [this] { chooseBars(); }, {.enabled = [this] { return !m_services.scene().tf.features.empty(); }});
    menu.add("copyCaptionAction", tr("&Copy caption"), "Ctrl+Alt+Shift+C",
             tr("What the picture shows, in words: the view, and each feature's measured shares"),
             [this] { copyCaption(); }, {.enabled = [this] { return !m_services.scene().tf.features.empty(); }});
    menu.add("saveReportAction", tr("Save &report of the last run…"), {},
             tr("One page about the latest optimization: pictures, bars, curves, settings"),
             [this] { chooseReport(*latestRun()); },
             {.enabled = [this] { return latestRun() != nullptr && !m_services.isReadOnly(); }});
}

void SaveController::setSessionPath(const QString& path) {
    m_sessionPath = path;
    Q_EMIT sessionPathChanged();
}

bool SaveController::saveSession(const QString& path) {
    return m_services.store().hasVolume() && m_services.attempt(tr("Cannot save the session"), [&] {
        writeSession(m_services.store().committed().session, path.toStdString());
        noteRecent(QFileInfo(path).absoluteFilePath());
        setSessionPath(path);
        keepRecentPicture(m_services, path);
        m_services.store().setClean();
        m_services.saySaved(path);
    });
}

bool SaveController::saveTf(const QString& path) {
    return m_services.store().hasVolume() && m_services.attempt(tr("Cannot save the transfer function"), [&] {
        const Scene& scene = m_services.store().committed();
        const std::string file = path.toStdString();
        const bool whole = !isWrittenForOthers(file); // else what another program knows of it
        const std::vector<std::string> lost =
            writeTfFile(toWrite(whole ? *scene.session.tf() : scene.tf, scene, file), file);
        for (const std::string& loss : lost) m_services.notices().add({QString::fromStdString(loss)});
        if (whole) {
            setTfPath(path);
            m_services.store().setTfSaved();
        }
        m_services.saySaved(path);
    });
}

bool SaveController::saveBars(const QString& path) {
    return m_services.store().hasVolume() && m_services.attempt(tr("Cannot save the bars"), [&] {
        writeShareCharts(presentBars(m_services, m_pictureSaliency), path.toStdString());
        m_services.saySaved(path);
    });
}

void SaveController::copyCaption() {
    if (!m_services.store().hasVolume()) return;
    m_services.attempt(tr("Cannot make a caption"), [&] {
        const Results& results = m_services.results();
        const Measures& measures = presentMeasures(m_services);
        const OcclusionMatrix* hides = results.influenceIsCurrent() ? results.occlusion() : nullptr;
        const CaptionFacts facts = captionFacts(m_services.scene(), measures, hides ? *hides : OcclusionMatrix{});
        QApplication::clipboard()->setText(QString::fromStdString(caption(facts)));
    });
}

bool SaveController::saveTfDrawing(const QString& path) {
    return m_services.store().hasVolume() && m_services.attempt(tr("Cannot save the drawing"), [&] {
        const Scene& scene = m_services.scene();
        const Plot plot = tfPlot(scene.tf, {scene.volume->range(), scene.unit.value_or(""), scene.histogram.get()});
        writeDrawing([&](const PlotPage& page) { return drawingOf(plot, page); }, {}, path.toStdString());
        m_services.saySaved(path);
    });
}

void SaveController::write(const Picture& picture, const JobControl& job) {
    const std::string path = picture.path.toStdString();
    PictureText text = picture.text;
    const PictureInput& input = picture.input;
    if (picture.layers) {
        if (picture.carries) text.session = sessionText(picture.scene, path);
        const PictureLayers layers =
            pictureLayers(input.volume, input.camera, input.tf, input.settings, job.part(0, 2));
        return writeLayers(layers, input.tf.features, path, text, job.part(1, 2));
    }
    const auto renderer = makeRenderer(EngineChoice::Auto, input.volume);
    Image image = renderer->render(input.camera, input.tf, input.settings, job);
    job.throwIfStopped();
    if (picture.around.show.any()) drawMarks(image, annotationMarks(picture.around));
    if (picture.carries) text.session = sessionText(picture.scene, path);
    if (text.session.empty()) text.command.clear(); // it is about the session in the file
    writeImage(image, path, text);
}

PictureText SaveController::describe(const SaveImageOptions& options) const {
    if (!options.described) return {};
    const Results& results = m_services.results();
    const Measures* const current = results.measures() && results.measuresAreCurrent() ? results.measures() : nullptr;
    const OcclusionMatrix* const hides = current && results.influenceIsCurrent() ? results.occlusion() : nullptr;
    const CaptionFacts facts =
        captionFacts(m_services.scene(), current ? *current : Measures{}, hides ? *hides : OcclusionMatrix{});
    PictureText text{std::string("Pellucid ") + kVersion, caption(facts), {}, {}};
    if (m_fields.field() != nullptr) text.description += " Field: " + m_fields.name().toStdString() + ".";
    const QFileInfo file(options.path);
    if (options.layers || file.suffix().compare("png", Qt::CaseInsensitive) != 0) return text;
    QString command = QStringLiteral("pellucid-cli render --session '%1' --size %2x%3")
                          .arg(file.fileName().replace('\'', QStringLiteral("'\\''")))
                          .arg(options.size.width())
                          .arg(options.size.height());
    if (options.transparent) command += QStringLiteral(" --background transparent");
    if (options.annotated) {
        QStringList parts;
        for (const AnnotationPartInfo& part : kAnnotationParts)
            if (const AnnotationChoice& shown = *m_services.scene().session.reference; shown.on && shown.*part.shown)
                parts << QString::fromUtf8(part.name);
        if (!parts.isEmpty()) command += QStringLiteral(" --annotate ") + parts.join(',');
    }
    text.command = printable((command + QStringLiteral(" --out picture.png")).toStdString());
    return text;
}

void SaveController::saveImage(const SaveImageOptions& options) {
    if (!m_services.store().hasVolume()) return;
    Picture picture{m_fields.picture(options.size.width(), options.size.height(), options.transparent),
                    {},
                    options.path,
                    describe(options),
                    m_services.scene(),
                    options.described,
                    options.layers};
    if (options.annotated) {
        picture.around = m_fields.annotation(picture.input, *m_services.scene().session.reference);
        addMeasures(picture.around, m_services.scene(), m_rulers.readings());
    } else {
        picture.around.show = AnnotationChoice::none();
    }
    const bool good = m_services.attempt(tr("Cannot save the image"), [&] {
        picture.input.settings.validate();
        const std::string path = options.path.toStdString();
        if (!options.layers) return checkImageSuffix(path);
        if (m_fields.field() != nullptr)
            throw UsageError("a field has no layers", "the picture", "draw the data, or save the picture");
        checkLayersPath(path);
        checkLayers(picture.input.tf, picture.input.settings);
        requireMemory("layers of this size", path,
                      static_cast<std::uint64_t>(2 * bytesOfLayers(options.size.width(), options.size.height(),
                                                                   picture.input.tf.features.size())));
    });
    if (!good) return;
    m_busyText = tr("Saving %1…").arg(QFileInfo(options.path).fileName());
    m_images.start(picture, options.path);
    Q_EMIT busyChanged();
}

void SaveController::saveVolume(const SaveVolumeOptions& options) {
    if (m_services.store().hasVolume()) saveVolume(options, nowSavable());
}

void SaveController::saveVolume(const SaveVolumeOptions& options, const Savable& from) {
    const std::string path = options.path.toStdString();
    if (!m_services.attempt(tr("Cannot save the volume"), [&] { requireNotOpen(path, options, from); })) return;
    VolumeTask task{from.scene.volume, from.scene.series, options.path, options.part, {}};
    if (!options.isField) task.notices = from.scene.volume->notices;
    if (options.allFrames) task.volume.reset();
    if (options.isField) task.volume = from.field;
    m_busyText = tr("Saving %1…").arg(QFileInfo(options.path).fileName());
    m_volumes.start(std::move(task), options.path);
    Q_EMIT busyChanged();
}

void SaveController::requireNotOpen(const std::string& path, const SaveVolumeOptions& options, const Savable& from) {
    if (options.isField && !from.field)
        throw Error("the field is not there yet", from.scene.volume->title, "save it once it has been computed");
    const std::vector<std::string> written = writtenFiles(path, options.allFrames ? from.scene.series->size() : 1);
    for (const Variable& variable : *from.scene.session.variables)
        for (const std::string& open : filesOf(variable.source))
            for (const std::string& file : written) {
                std::error_code ec;
                if (std::filesystem::equivalent(open, file, ec))
                    throw FileError("the volume that is open comes from this file", file, "choose another name");
            }
}

SaveController::Savable SaveController::nowSavable() const {
    Savable from{m_services.scene(), nullptr};
    if (m_fields.state() == FieldController::State::Current) from.field = m_fields.field()->volume;
    return from;
}

SavableVolume SaveController::described(const Savable& from) const {
    const Scene& scene = from.scene;
    const Int3 dims = scene.volume->dims();
    SavableVolume there{dims, scene.volume->sampleType(), scene.series->size()};
    there.frameName = QString::fromStdString(scene.series->listing().label(scene.session.frame));
    if (from.field) there.fieldName = m_fields.name();
    const Clipping& clip = *scene.session.clipping;
    if (clip.lo == Vec3(0) && clip.hi == Vec3(1)) return there;
    Volume own = *scene.volume; // in its voxels, not those of the data that it may be an excerpt of
    own.excerpt.reset();
    there.clipped = regionBetween(own, clip.lo, clip.hi);
    return there;
}

void SaveController::chooseVolume() {
    if (!m_services.store().hasVolume()) return;
    const Savable from = nowSavable(); // what is saved is what was there, however long the dialog is open
    const QString folder = keptFolder("savedVolumeFolder", QDir::homePath());
    SaveVolumeDialog dialog(QDir(folder).filePath(baseName(from.scene) + ".nrrd"), described(from),
                            m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        SaveVolumeOptions options = dialog.options();
        if (options.path.isEmpty()) continue;
        if (QFileInfo(options.path).suffix().isEmpty()) options.path += ".nrrd";
        QStringList there;
        if (!m_services.attempt(tr("Cannot save the volume"), [&] {
                const int frames = options.allFrames ? from.scene.series->size() : 1;
                for (const std::string& file : writtenFiles(options.path.toStdString(), frames))
                    if (const QFileInfo info(QString::fromStdString(file)); info.exists()) there << info.fileName();
            }))
            continue;
        const QString question = there.size() == 1 ? tr("%1 exists. Replace it?").arg(there.front())
                                                   : tr("%1 and %n other file(s) exist. Replace them?", nullptr,
                                                        static_cast<int>(there.size()) - 1)
                                                         .arg(there.value(0));
        if (!there.isEmpty() &&
            QMessageBox::question(m_services.window(), tr("Save volume"), question) != QMessageBox::Yes)
            continue;
        keepFolderOf("savedVolumeFolder", options.path);
        return saveVolume(options, from);
    }
}

const Run* SaveController::latestRun() const {
    const std::vector<Run>& runs = *m_services.scene().session.runs;
    const auto latest =
        std::find_if(runs.rbegin(), runs.rend(), [](const Run& run) { return run.hasStart() && !run.history.empty(); });
    return latest == runs.rend() ? nullptr : &*latest;
}

void SaveController::saveReport(const Run& run, const QString& folder) {
    m_busyText = tr("Saving the report…");
    m_reports.start({run, m_services.scene(), folder}, folder);
    Q_EMIT busyChanged();
}

void SaveController::chooseReport(const Run& run) {
    const Run kept = run; // a dialog is open for long
    const QString folder = QFileDialog::getExistingDirectory(m_services.window(), tr("Folder for the report"),
                                                             keptFolder("reportFolder", QDir::homePath()));
    if (folder.isEmpty()) return;
    const QString question = tr("There is a report in %1. Replace it?").arg(QFileInfo(folder).fileName());
    if (!mayReplace(QDir(folder).filePath(kReportFile), tr("Save report"), question)) return;
    QSettings().setValue("reportFolder", folder);
    saveReport(kept, folder);
}

bool SaveController::mayReplace(const QString& file, const QString& title, const QString& question) {
    return !QFileInfo::exists(file) || QMessageBox::question(m_services.window(), title, question) == QMessageBox::Yes;
}

bool SaveController::chooseSession(bool askForName) {
    if (!m_services.store().hasVolume()) return false;
    const QString offered = m_sessionPath.isEmpty() ? baseName(m_services.scene()) + ".pellucid.json" : m_sessionPath;
    const QString path = askForName || m_sessionPath.isEmpty()
                             ? askSavePath(m_services.window(), tr("Save session"), "sessionFolder", offered,
                                           tr("Sessions (*.pellucid.json)"), ".pellucid.json", ".pellucid.json")
                             : m_sessionPath;
    return !path.isEmpty() && saveSession(path);
}

bool SaveController::chooseTf(bool askForName) {
    if (!m_services.store().hasVolume()) return false;
    const QString offered = m_tfPath.isEmpty() ? baseName(m_services.scene()) + ".tf.json" : m_tfPath;
    const QString path = askForName || m_tfPath.isEmpty()
                             ? askSavePath(m_services.window(), tr("Save transfer function"), "tfFolder", offered,
                                           tr("Transfer functions (*.tf.json);;Presets of ParaView (*.paraview.json)"),
                                           ".json", ".tf.json")
                             : m_tfPath;
    return !path.isEmpty() && saveTf(path);
}

void SaveController::chooseImage() {
    if (!m_services.store().hasVolume()) return;
    const QString folder = keptFolder("imageFolder", QDir::homePath());
    SaveImageDialog dialog(QDir(folder).filePath(baseName(m_services.scene()) + ".png"), m_seen,
                           m_services.scene().session.reference->any() || m_fields.field() != nullptr,
                           m_fields.field() == nullptr, m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        const SaveImageOptions options = dialog.options();
        if (options.path.isEmpty()) continue;
        if (!mayReplaceFile(m_services.window(), options.path, tr("Save image"))) continue;
        keepFolderOf("imageFolder", options.path);
        return saveImage(options);
    }
}

QString SaveController::askDrawing(const QString& title, const QString& ending) {
    if (!m_services.store().hasVolume()) return {};
    const QString path =
        askSavePath(m_services.window(), title, "imageFolder", baseName(m_services.scene()) + ending + ".svg",
                    tr("Drawing (*.svg);;Picture (*.png)"), ".png", {});
    return path.isEmpty() || !QFileInfo(path).suffix().isEmpty() ? path : path + ".svg";
}

void SaveController::chooseBars() {
    if (const QString path = askDrawing(tr("Save bars"), "_bars"); !path.isEmpty()) saveBars(path);
}

void SaveController::chooseTfDrawing() {
    if (const QString path = askDrawing(tr("Save transfer function as drawing"), "_tf"); !path.isEmpty())
        saveTfDrawing(path);
}

bool SaveController::maybeSave() {
    if (!m_services.store().hasVolume() || m_services.store().isClean()) return true;
    QMessageBox box(QMessageBox::Question, tr("Unsaved changes"), tr("You have unsaved changes."),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, m_services.window());
    box.setObjectName("askSave");
    box.setInformativeText(tr("Do you want to save the session?"));
    box.setDefaultButton(QMessageBox::Save);
    switch (box.exec()) {
    case QMessageBox::Save:
        return chooseSession(false);
    case QMessageBox::Discard:
        return true;
    default:
        return false;
    }
}

} // namespace pellucid::gui
