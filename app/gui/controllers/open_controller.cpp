#include "controllers/open_controller.h"

#include <QApplication>
#include <QClipboard>
#include <QMenu>
#include <QMessageBox>
#include <QMimeData>
#include <QUrl>

#include "controllers/save_controller.h"
#include "dialogs/ask_file.h"
#include "dialogs/ask_preset.h"
#include "dialogs/raw_dialog.h"
#include "dialogs/series_choice_dialog.h"
#include "dialogs/series_dialog.h"
#include "dialogs/series_files.h"
#include "render/memory_needs.h"
#include "report/session_picture.h"
#include "services/recent_files.h"
#include "services/services.h"
#include "session/scene_data.h"
#include "session/variable_edits.h"
#include "store/edits.h"
#include "tf/formats/tf_file.h"
#include "tf/presets.h"
#include "volume/excerpt.h"
#include "volume/file_contents.h"
#include "volume/file_names.h"
#include "volume/outside_files.h"
#include "volume/procedural.h"
#include "volume/series.h"
#include "widgets/menu_icons.h"
#include "widgets/number_text.h"

namespace pellucid::gui {
namespace {

constexpr auto kFolder = "volumeFolder";
constexpr QSize kMenuPicture{64, 48}; // logical pixels

QString recentMenuName() { return QObject::tr("&File") + "/" + QObject::tr("Open &recent"); }

bool isTf(const QString& path) { return pellucid::isTfFile(path.toStdString()); }
bool isSessionFile(const QString& path) { return path.endsWith(".pellucid.json", Qt::CaseInsensitive); }
/// A session file, or a picture that carries one.
bool isSession(const QString& path) { return isSessionFile(path) || carriesSession(path.toStdString()); }

VolumeSource sourceAt(const QString& path) {
    VolumeSource source;
    source.path = path.toStdString();
    return source;
}

// What a file of another program has that is not drawn here, and what was made of its opacities.
void noteForeign(Services& services, const ReadTf& read) {
    for (const std::string& notice : openingNoticesIn(services.scene(), read))
        services.notices().add({QString::fromStdString(notice)});
}

/// Whether what names a transfer function names a file.
bool namesTfFile(const QString& specOrPath) {
    return specOrPath != kAutomaticTf && !tfFromSpec(specOrPath.toStdString()) &&
           !tfFromPresetSpec(specOrPath.toStdString());
}

} // namespace

OpenController::OpenController(Services& services, SaveController& saving)
    : m_services(services), m_saving(saving),
      m_open(&OpenController::load, [this](const Request& r, Opened& o) { show(r, o); }),
      m_data(
          [](const DataChange& change, const JobControl& job) {
              Session session = change.basis.session;
              change.change(session);
              const MemoryUse then = toPreview("showing");
              Scene scene = resolve(std::move(session), change.basis, then, job);
              if (scene.proposal) { // a variable that has not been drawn yet comes to the front
                  session = scene.session;
                  setStart(session, tunedStart(scene, job));
                  scene = resolve(std::move(session), scene, then, job);
              }
              openNewVariables(scene, change.basis, then, job);
              prepareToShow(scene, job);
              return scene;
          },
          [this](const DataChange& change, Scene& scene) { showChanged(change, scene); }),
      m_look([](const Look& look, const JobControl& job) { return contentsOf(look.source, job); },
             [this](const Look& look, FileContents& contents) {
                 // The looking has come to its end before somebody is asked.
                 QMetaObject::invokeMethod(
                     this, [this, look, contents] { openSeries(look, contents); }, Qt::QueuedConnection);
             }) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_open, &m_data, &m_look}) follow(*job);
    connect(&saving, &SaveController::sessionPathChanged, this, &OpenController::updateRecentFiles);
    services.showFailuresOf(m_data, tr("Cannot change the data"));
    services.showFailuresOf(m_look, tr("Cannot open the file"));
    connect(&m_open, &JobBase::failed, this, &OpenController::showFailure);
    connect(&m_look, &JobBase::failed, this, &OpenController::failed);
    connect(&m_data, &JobBase::failed, this, &OpenController::nextChange);
}

void OpenController::addActions() {
    Actions& actions = m_services.actions();
    ActionMenu file(actions, tr("&File")), recent(actions, recentMenuName()),
        sampleMenu(actions, tr("&File") + "/" + tr("&Samples"));
    file.add("openAction", tr("&Open…"), "Ctrl+O", tr("Open a volume, a session or a transfer function"),
             [this] { chooseVolume(); }, {.inToolBar = true});
    file.add("openSeriesAction", tr("Open s&eries…"), "Ctrl+Alt+O",
             tr("Time steps: a folder, files that match a pattern, or files that you choose"),
             [this] { chooseSeries(); });
    file.add("openRawAction", tr("Open ra&w data…"), {},
             tr("A file without a header: you say how its bytes are laid out"), [this] { chooseRaw(); });
    file.add("openFolderAction", tr("Open &folder…"), "Ctrl+Alt+F",
             tr("A folder of DICOM files or pictures, an OME-Zarr folder, or one of time steps"),
             [this] { chooseFolder(); });
    file.add("pasteAction", tr("Open from the clip&board"), "Ctrl+V",
             tr("Paths, one a line, or files that another program has copied"), [this] { openCopied(); });
    m_clearRecent = recent.add("clearRecentAction", tr("&Clear this list"), {},
                               tr("Forgets these files, and removes their pictures"), [this] {
                                   clearRecent();
                                   updateRecentFiles();
                               });
    for (const SampleInfo& sample : samples()) {
        const QString name = QString::fromStdString(sample.name);
        QString text = QStringLiteral("%1 – %2").arg(name, QString::fromStdString(sample.description));
        if (sample.frames > 1) text += tr(", %L1 frames").arg(sample.frames);
        sampleMenu.add("sample_" + name, text, {}, {}, [this, name] {
            if (m_saving.maybeSave()) openVolume(sourceAt("sample:" + name));
        });
    }
    file.separate();
    file.add("openTfAction", tr("Open &transfer function…"), "Ctrl+Shift+O", {}, [this] { chooseTf(); },
             {.enabled = [this] { return m_services.isEditable(); }});
    file.separate();
    file.add(
        "regionAction", tr("Re&gion at full resolution"), {},
        tr("Opens the part inside the clipping box with all its voxels, where the volume was too large for memory"),
        [this] { openRegion(); }, {.enabled = [this] {
            if (!m_services.isEditable()) return false;
            const Clipping& clipping = *m_services.scene().session.clipping;
            const auto& excerpt = m_services.scene().volume->excerpt;
            return excerpt && excerpt->factor > 1 && (clipping.lo != Vec3(0) || clipping.hi != Vec3(1));
        }});
    file.add("wholeVolumeAction", tr("W&hole volume"), {}, tr("Opens all the data, as fine as memory allows"),
             [this] { openWhole(); }, {.enabled = [this] {
                 return m_services.isEditable() && dataVariable(m_services.scene().session).source.region;
             }});
}

// ---- opening

void OpenController::openVolume(const VolumeSource& source, const QString& tfSpec) {
    Request request;
    request.inputs.session = sessionOf(source);
    editVariable(request.inputs.session, [&](Variable& v) { v.name = freeVariableName({}, nameOfSource(source)); });
    request.inputs.session.display.edit([](DisplaySettings& d) { d.light.on = true; }); // shapes at the first look
    request.inputs.range = source.range;
    if (!tfSpec.isEmpty()) {
        request.inputs.tf = tfSpec.toStdString();
        request.tfIsOptional = true;
        request.tfPath = tfSpec;
    }
    m_busyText = tr("Opening %1…").arg(titleOf(source));
    begin(std::move(request), QString::fromStdString(source.path));
}

void OpenController::openSession(const QString& path) {
    attempt(tr("Cannot open the session"), [&] {
        SessionFile file = readSessionOrPicture(path.toStdString());
        Request request;
        request.inputs.session = std::move(file.session);
        request.notices = std::move(file.notices);
        request.sessionPath = path;
        m_busyText = tr("Opening %1…").arg(QFileInfo(path).fileName());
        begin(std::move(request), path);
    });
}

void OpenController::attempt(const QString& title, const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        m_services.showError(title, error);
        Q_EMIT failed(error);
    }
}

void OpenController::openRecovered(const SessionFile& file, const std::function<void()>& then) {
    Request request;
    request.inputs.session = file.session;
    request.notices = file.notices;
    request.unsaved = true;
    request.then = then;
    m_busyText = tr("Restoring…");
    begin(std::move(request), tr("the unsaved work"));
}

void OpenController::begin(Request request, const QString& where) {
    m_request = request;
    m_open.start(std::move(request), where);
}

void OpenController::showFailure(const Error& error) {
    if (error.remedy() == Remedy::AllowOutside) {
        QMessageBox box(QMessageBox::Warning, tr("A file outside the folder"),
                        tr("%1: %2.").arg(QFileInfo(QString::fromStdString(error.where())).fileName(),
                                          QString::fromStdString(error.problem())),
                        QMessageBox::Open | QMessageBox::Cancel, m_services.window());
        box.setObjectName("askOutside");
        box.setTextFormat(Qt::PlainText);
        box.setInformativeText(tr("Open it only if you trust this file."));
        box.setDefaultButton(QMessageBox::Cancel);
        if (box.exec() == QMessageBox::Open) {
            allowOutsideFiles(error.where());
            return begin(m_request, QString::fromStdString(error.where()));
        }
    } else {
        m_services.showError(tr("Cannot open the file"), error);
    }
    Q_EMIT failed(error);
}

OpenController::Opened OpenController::load(const Request& request, const JobControl& job) {
    Opened opened;
    SceneInputs inputs = request.inputs;
    inputs.then = toPreview("showing");
    inputs.start = SceneInputs::Start::Proposed; // the first picture does not wait for opacities
    if (request.tfIsOptional && inputs.tf != kAutomaticTf) {
        try {
            static_cast<void>(loadTf(*inputs.tf));
        } catch (const Error& error) {
            opened.tfError = error;
            inputs.tf.reset();
        }
    }
    opened.scene = openScene(inputs, job);
    prepareToShow(opened.scene, job);
    return opened;
}

void OpenController::show(const Request& request, Opened& opened) {
    m_edits.clear(); // they were of what was open
    m_data.cancel();
    const bool tfFromFile = !opened.tfError && !request.tfPath.isEmpty() && namesTfFile(request.tfPath);
    m_saving.setTfPath(tfFromFile && !isForeignTf(request.tfPath.toStdString()) ? request.tfPath : QString());
    std::vector<std::string> notices = opened.scene.volume->notices;
    notices.insert(notices.end(), request.notices.begin(), request.notices.end());
    showNotices(notices);
    const VolumeSource source = dataVariable(opened.scene.session).source;
    keepRecentPicture(m_services, m_saving.sessionPath()); // of what is open until now
    m_services.store().open(std::move(opened.scene));
    if (request.unsaved) m_services.store().setUnsaved();
    // What is saved later does not go into the picture that it came with.
    m_saving.setSessionPath(isSessionFile(request.sessionPath) ? request.sessionPath : QString());
    if (!request.sessionPath.isEmpty()) {
        addRecent(QFileInfo(request.sessionPath).absoluteFilePath());
    } else if (!source.isSample() && !request.unsaved) {
        addRecent(recentEntry(source));
    }
    if (tfFromFile) {
        noteWindow(*m_services.store().session().tf());
        m_services.attempt(tr("Cannot open the transfer function"), [&] { // it may be gone by now
            if (isForeignTf(request.tfPath.toStdString()))
                noteForeign(m_services, readTfNamed(request.tfPath.toStdString()));
        });
    }
    Q_EMIT this->opened();
    if (request.then) request.then();
    if (opened.tfError) {
        m_services.showError(tr("Cannot open the transfer function"), *opened.tfError);
        Q_EMIT tfFailed(*opened.tfError);
    }
}

void OpenController::showNotices(const std::vector<std::string>& notices) {
    m_services.notices().clear();
    for (const std::string& notice : notices) m_services.notices().add({QString::fromStdString(notice)});
}

// ---- parts of large volumes

void OpenController::openRegion() {
    const Scene& scene = m_services.store().scene();
    const Clipping& clipping = *scene.session.clipping;
    openPart(tr("Region at full resolution"), regionBetween(*scene.volume, clipping.lo, clipping.hi));
}

void OpenController::openWhole() { openPart(tr("Whole volume"), {}); }

void OpenController::openPart(const QString& text, const std::optional<VoxelRegion>& region) {
    editData(text, [region, window = m_services.scene().volume->range()](Session& session) {
        VolumeSource source = dataVariable(session).source;
        source.region = region;
        source.downsample = 0;
        setDataSource(session, source);
        editVariable(session, [&](Variable& v) {
            if (region && !v.window && window.lo < window.hi) v.window = window; // not that of the region
        });
        session.clipping.edit([](Clipping& c) {
            c.lo = Vec3(0), c.hi = Vec3(1);
            c.rest = {}; // of another box
        });
    });
}

void OpenController::openTf(const QString& specOrPath) {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable()) return;
    if (specOrPath == kAutomaticTf) return automaticStartWanted();
    m_services.attempt(tr("Cannot open the transfer function"), [&] {
        const ReadTf read = readTfNamed(specOrPath.toStdString());
        const TransferFunction tf = forScene(read, store.scene());
        const bool isFile = namesTfFile(specOrPath);
        const auto change = [tf, data = store.scene().data](Session& session) {
            TransferFunction placed = tf;
            placeAsPublished(session, *data, placed);
            if (placed.range) editVariable(session, [&](Variable& v) { v.window = placed.range; }); // made for it
            session.setTf(std::move(placed));
        };
        editData(tr("Open transfer function"), change, [this, tf, read, isFile, specOrPath] {
            if (isFile) {
                m_saving.setTfPath(isForeignTf(specOrPath.toStdString()) ? QString() : specOrPath);
                m_services.store().setTfSaved();
            }
            noteWindow(tf);
            noteForeign(m_services, read);
        });
    });
}

void OpenController::editData(const QString& text, const SessionStore::Change& change,
                              const std::function<void()>& then) {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable()) return;
    Session next = store.session();
    change(next);
    if (!needsData(next, store.scene())) {
        store.edit(text, {}, change);
        if (then) then();
        return;
    }
    editInJob(text, change, then);
}

void OpenController::editInJob(const QString& text, const SessionStore::Change& change,
                               const std::function<void()>& then) {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable()) return;
    store.commit();
    Session next = store.session();
    change(next);
    if (next == store.session() && !m_data.isRunning()) return;
    // A change of the same kind takes the place of one under way, others wait in line.
    Edit edit{text, change, then};
    if (!m_data.isRunning() || m_edit.text == text) return start(std::move(edit));
    if (!m_edits.empty() && m_edits.back().text == text) m_edits.pop_back();
    m_edits.push_back(std::move(edit));
}

void OpenController::start(Edit edit) {
    const Scene& scene = m_services.scene();
    m_edit = std::move(edit);
    m_busyText = m_edit.text + QChar(0x2026);
    m_data.start({m_edit.text, m_edit.change, scene}, QString::fromStdString(scene.volume->title));
}

void OpenController::nextChange() {
    if (m_edits.empty() || !m_services.store().hasVolume()) return;
    Edit edit = std::move(m_edits.front());
    m_edits.pop_front();
    start(std::move(edit));
}

// The picture has waited for the data, and shows everything at once.
void OpenController::showChanged(const DataChange& change, Scene& scene) {
    SessionStore& store = m_services.store();
    const auto andStart = [&](Session& session) {
        change.change(session);
        const Variable& made = scene.session.variable();
        if (!session.isEmpty() && session.variable().name == made.name && session.tf() == nullptr)
            editVariable(session, [&](Variable& v) {
                v.track = made.track;
                v.window = made.window;
            });
    };
    // Other edits may have come meanwhile: the change is made of what is there now, and anew where that is other data.
    Session present = store.session();
    andStart(present);
    if (needsData(present, scene)) return start(std::move(m_edit));
    const bool otherVoxels = scene.data != change.basis.data;
    const std::vector<std::string> notices = scene.volume->notices;
    const auto then = m_edit.then;
    store.edit(change.text, {}, andStart, &scene);
    if (otherVoxels) showNotices(notices);
    if (then) then();
    if (!m_data.isRunning()) nextChange();
}

void OpenController::openPath(const QString& path) {
    if (path.startsWith('{')) return openRecent(path); // a recent file that needs more than its path
    if (isTf(path)) return askAndOpenTf(path);
    if (isSession(path)) {
        if (m_saving.maybeSave()) openSession(path);
        return;
    }
    VolumeSource source = sourceAt(path);
    if (askRawLayout(source) && m_saving.maybeSave()) openChosen(source);
}

void OpenController::openPaths(QStringList paths) {
    if (paths.size() == 1) return openPath(paths.front());
    attempt(tr("Cannot open the files"), [&] {
        QString tf;
        QStringList volumes;
        for (const QString& path : paths) {
            if (isSessionFile(path)) // pictures, several, are the slices of a volume, whatever they carry
                throw UsageError("a session must be opened by itself", path.toStdString(), "choose one file");
            if (isTf(path)) {
                if (!tf.isEmpty())
                    throw UsageError("this is a second transfer function", path.toStdString(), "choose one of them");
                tf = path;
            } else if (QFileInfo(path).isDir()) {
                volumes << filesOfFrames(sourceAt(path));
            } else {
                volumes << path;
            }
        }
        if (volumes.isEmpty()) throw UsageError("there are no volumes here", paths.front().toStdString(), "");
        if (!tf.isEmpty()) {
            tf = askPreset(tf, m_services.window());
            if (tf.isEmpty()) return;
        }
        VolumeSource source = sourceOf(volumes);
        if (askRawLayout(source) && m_saving.maybeSave()) openChosen(source, tf);
    });
}

void OpenController::chooseFolder() {
    const QString folder =
        QFileDialog::getExistingDirectory(m_services.window(), tr("Open folder"), keptFolder("volumeFolder"));
    if (folder.isEmpty()) return;
    keepFolderOf("volumeFolder", folder);
    openPath(folder);
}

void OpenController::openCopied() {
    const QMimeData* copied = QApplication::clipboard()->mimeData();
    QStringList paths;
    for (const QUrl& url : copied->urls())
        if (url.isLocalFile()) paths << url.toLocalFile();
    if (paths.isEmpty())
        for (QString line : copied->text().split('\n', Qt::SkipEmptyParts)) {
            line = line.trimmed();
            if (line.size() > 1 && line.startsWith('"') && line.endsWith('"')) line = line.mid(1, line.size() - 2);
            if (!line.isEmpty()) paths << QString::fromStdString(pathOfUrl(line.toStdString()));
        }
    attempt(tr("Cannot open from the clipboard"), [&] {
        if (paths.isEmpty())
            throw UsageError("there is no path on the clipboard", "", "copy a file or its path in another program");
        for (const QString& path : paths)
            if (!QFileInfo::exists(path) && !path.startsWith("sample:") && !isSeriesPattern(path.toStdString()))
                throw FileError("there is no file of this name", path.left(200).toStdString(),
                                "copy a file or its path in another program");
        openPaths(paths);
    });
}

void OpenController::openAtStart(const QStringList& paths, const QString& tfSpec) {
    if (paths.size() == 1 && isSession(paths.front())) return openSession(paths.front());
    VolumeSource source = sourceOf(paths);
    if (!askRawLayout(source)) return;
    const bool isFile = !tfSpec.isEmpty() && namesTfFile(tfSpec);
    // Who gives up gets the automatic start.
    openChosen(source, isFile ? askPreset(tfSpec, m_services.window()) : tfSpec);
}

void OpenController::openSeries(const Look& look, const FileContents& contents) {
    VolumeSource source = look.source;
    if (contents.arrays.size() > 1) {
        SeriesChoiceDialog dialog(source, contents, m_services.window());
        if (dialog.exec() != QDialog::Accepted) return;
        source.array = dialog.series();
    }
    openVolume(source, look.tfSpec);
}

void OpenController::openChosen(const VolumeSource& source, const QString& tfSpec) {
    if (source.raw || source.isSample() || !source.array.empty() || !mayHoldSeveral(source.path))
        return openVolume(source, tfSpec);
    m_busyText = tr("Looking into %1…").arg(titleOf(source));
    m_look.start({source, tfSpec}, QString::fromStdString(source.path));
}

bool OpenController::askRawLayout(VolumeSource& source) {
    if (source.isSample() || source.raw) return true;
    const QStringList files = filesOfFrames(source);
    // What is not there, or of a format that cannot be read, opening tells.
    if (files.isEmpty() || !mayBeHeaderless(files.front().toStdString())) return true;
    return askLayout(source, files);
}

bool OpenController::askLayout(VolumeSource& source, const QStringList& files) {
    RawDialog dialog(files, m_services.window());
    if (dialog.exec() != QDialog::Accepted) return false;
    source.raw = dialog.layoutOfFile();
    source.spacing = dialog.spacing();
    source.missing = dialog.missing();
    return true;
}

std::optional<VolumeSource> OpenController::askSource(const QString& title) {
    const QStringList paths = askFiles(title, {});
    if (paths.isEmpty()) return {};
    VolumeSource source = sourceOf(paths);
    if (!askRawLayout(source)) return {};
    return source;
}

// A window other than that of the data is worth a word, and one click to the other.
void OpenController::noteWindow(const TransferFunction& tf) {
    const Scene& scene = m_services.scene();
    if (!tf.range || !scene.data || scene.volume->range() == scene.data->range()) return;
    const QString text =
        tr("This transfer function was made for values %1; the volume has %2. Its points stay at their "
           "values.")
            .arg(rangeText(scene.volume->range()), rangeText(scene.data->range()));
    m_services.notices().add({text, {{tr("Stretch to this volume instead"), [this] {
                                          editData(tr("Stretch transfer function"),
                                                   [data = m_services.scene().data](Session& s) {
                                                       TransferFunction stretched = *s.tf();
                                                       stretched.range = data->range();
                                                       editVariable(s, [](Variable& v) { v.window.reset(); });
                                                       s.setTf(std::move(stretched));
                                                   });
                                      }}}});
}

// ---- dialogs

QStringList OpenController::askFiles(const QString& title, const QString& others) {
    QStringList patterns;
    for (const std::string& pattern : volumeFilePatterns()) patterns << QString::fromStdString(pattern);
    for (const char* raw : {"*.raw", "*.dat", "*.bin", "*.vol"})
        if (!patterns.contains(raw)) patterns << raw;
    const QString all = patterns.join(' ');
    const QString filter = others.isEmpty() ? tr("Volumes (%1)").arg(all)
                                            : tr("Volumes, sessions, transfer functions (%1 %2)").arg(all, others);
    return askOpenPaths(m_services.window(), title, kFolder, filter + QStringLiteral(";;") + tr("All files (*)"));
}

void OpenController::chooseVolume() {
    const QStringList paths = askFiles(tr("Open"), QStringLiteral("*.pellucid.json ") + tfPatterns());
    if (!paths.isEmpty()) openPaths(paths);
}

std::optional<VolumeSource> OpenController::askSeries() {
    SeriesDialog dialog(keptFolder(kFolder), m_services.window());
    if (dialog.exec() != QDialog::Accepted) return {};
    VolumeSource source = dialog.source();
    keepFolderOf(kFolder, QString::fromStdString(source.path));
    if (!askRawLayout(source)) return {};
    return source;
}

void OpenController::chooseSeries() {
    if (const auto source = askSeries(); source && m_saving.maybeSave()) openChosen(*source);
}

void OpenController::chooseRaw() {
    const QStringList paths = askOpenPaths(m_services.window(), tr("Open raw data"), kFolder, tr("All files (*)"));
    if (paths.isEmpty()) return;
    VolumeSource source = sourceOf(paths);
    if (askLayout(source, filesOfFrames(source)) && m_saving.maybeSave()) openVolume(source);
}

void OpenController::chooseTf() {
    const QString path =
        QFileDialog::getOpenFileName(m_services.window(), tr("Open transfer function"), keptFolder("tfFolder"),
                                     tr("Transfer functions (%1 *.json *.xml *.csv);;All files (*)").arg(tfPatterns()));
    if (path.isEmpty()) return;
    keepFolderOf("tfFolder", path);
    askAndOpenTf(path);
}

void OpenController::askAndOpenTf(const QString& path) {
    if (!m_services.isEditable()) return;
    if (const QString one = askPreset(path, m_services.window()); !one.isEmpty()) openTf(one);
}

// ---- recent files

void OpenController::addRecent(const QString& entry) {
    noteRecent(entry);
    updateRecentFiles();
}

void OpenController::updateRecentFiles() {
    QMenu* menu = m_services.actions().menu(recentMenuName());
    if (menu == nullptr) return;
    if (!menu->property(kMenuIconSize).isValid()) { // other windows, and the disk, change what it should show
        menu->setProperty(kMenuIconSize, kMenuPicture);
        connect(menu, &QMenu::aboutToShow, this, &OpenController::updateRecentFiles);
    }
    for (QAction* action : menu->actions())
        if (action != m_clearRecent) delete action;
    menu->removeAction(m_clearRecent);
    const std::vector<RecentFile> files = recentFiles();
    for (const RecentFile& file : files) {
        const bool isThere = file.missing.isEmpty();
        const QString name = QString(file.name).replace('&', "&&");
        QAction* action = menu->addAction(recentIcon(file), isThere ? name : tr("%1 – missing").arg(name), this,
                                          [this, entry = file.entry] { openRecent(entry); });
        action->setEnabled(isThere);
        const QString tip = isThere ? file.path : tr("%1: %2").arg(file.path, file.missing);
        action->setToolTip(tip);
        action->setStatusTip(tip);
    }
    if (!files.empty()) menu->addSeparator();
    menu->addAction(m_clearRecent);
    menu->setEnabled(!files.empty());
}

void OpenController::openRecent(const QString& entry) {
    if (!entry.startsWith('{')) return openPath(entry);
    m_services.attempt(tr("Cannot open the file"), [&] {
        const VolumeSource source = recentSource(entry);
        if (m_saving.maybeSave()) openVolume(source);
    });
}

// ---- state

void OpenController::cancel() {
    m_look.cancel();
    m_open.cancel();
    m_edits.clear();
    m_data.cancel();
}

} // namespace pellucid::gui
