#include "main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QProgressBar>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>

#include "axis_ticks.h"
#include "render/camera_motion.h"
#include "error_dialog.h"
#include "optimize/refine.h"
#include "raw_dialog.h"
#include "engines/engines.h"
#include "render/memory_needs.h"
#include "tf/formats/tf_json.h"
#include "tf/sample_tf.h"
#include "theme.h"
#include "volume/procedural.h"

namespace pellucid::gui {
namespace {

constexpr int kRecentFiles = 8;
constexpr auto kRecentKey = "recentFiles";

bool looksLikeTf(const QString& path) { return path.endsWith(".tf.json", Qt::CaseInsensitive); }

QString counted(int n, const QString& one, const QString& many) {
    return QStringLiteral("%1 %2").arg(n).arg(n == 1 ? one : many);
}

QString rangeText(const ValueRange& range) {
    const double span = range.hi - range.lo;
    return QStringLiteral("%1 – %2").arg(numberText(range.lo, span), numberText(range.hi, span));
}

// Opens the volume, and measures what the window needs of it, off the window's thread.
LoadedVolume loadForWindow(const VolumeSource& source, const JobControl& job) {
    LoadedVolume loaded;
    loaded.source = source;
    VolumeSource shown = source;
    shown.then = {"showing", kViewBytesPerVoxel};
    loaded.volume = std::make_shared<const Volume>(loadVolume(shown, job));
    job.throwIfStopped();
    loaded.histogram = makeHistogram(*loaded.volume);
    loaded.defaultTf = defaultTf(*loaded.volume);
    return loaded;
}

} // namespace

MainWindow::MainWindow(ViewRenderer renderer, QWidget* parent)
    : QMainWindow(parent), m_view(nullptr), m_notices(nullptr), m_compute(std::make_unique<ComputeThread>()),
      m_load(std::make_unique<BackgroundTask>()), m_save(std::make_unique<BackgroundTask>()) {
    setObjectName("mainWindow");
    setAcceptDrops(true);
    setDockNestingEnabled(true);

    auto* middle = new QWidget(this);
    m_notices = new NoticeBar(middle);
    m_view = new VolumeView(m_document, renderer, middle);
    auto* column = new QVBoxLayout(middle);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(m_notices);
    column->addWidget(m_view, 1);
    setCentralWidget(middle);

    m_measure = new MeasureJob(m_document, *m_compute, this);
    m_optimizer = new OptimizerJob(*m_compute, this);
    makeDocks();
    makeMenus();
    connectJobs();
    updateRecentFiles();
    updateActions();
    updateTitle();
    updateStatus();

    resize(1280, 800);
}

void MainWindow::restoreLayout() {
    const QSettings settings;
    restoreGeometry(settings.value("geometry").toByteArray());
    restoreState(settings.value("windowState").toByteArray());
}

MainWindow::~MainWindow() {
    // First the threads, since they post to objects of this window; then the widgets, since they refer to the document;
    // and nothing may hear the document's own end.
    m_optimizer->cancel();
    m_measure->setPaused(true);
    m_load.reset();
    m_save.reset();
    m_compute.reset();
    m_document.undoStack().disconnect();
    m_document.disconnect();
    delete takeCentralWidget();
    delete m_tfDock;
    delete m_featuresDock;
    delete m_influenceDock;
    delete m_measure;
    delete m_optimizer;
}

void MainWindow::makeDocks() {
    m_featuresDock = new QDockWidget(tr("Features"), this);
    m_featuresDock->setObjectName("featuresDock");
    m_features = new FeaturesPanel(m_document, m_featuresDock);
    m_features->setMinimumWidth(340);
    m_featuresDock->setWidget(m_features);
    addDockWidget(Qt::RightDockWidgetArea, m_featuresDock);
    m_influenceDock = new QDockWidget(tr("Influence"), this);
    m_influenceDock->setObjectName("influenceDock");
    m_influenceDock->setWidget(new InfluencePanel(m_document, m_influenceDock));
    addDockWidget(Qt::RightDockWidgetArea, m_influenceDock);
    m_influenceDock->hide(); // costs a sweep more
    m_tfDock = new QDockWidget(tr("Transfer function"), this);
    m_tfDock->setObjectName("tfDock");
    m_tfEditor = new TfEditorWidget(m_document, m_tfDock);
    m_tfDock->setWidget(m_tfEditor);
    addDockWidget(Qt::BottomDockWidgetArea, m_tfDock);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    resizeDocks({m_featuresDock}, {380}, Qt::Horizontal);
    resizeDocks({m_tfDock}, {250}, Qt::Vertical);

    m_volumeLabel = new QLabel(this);
    m_cameraLabel = new QLabel(this);
    m_rendererLabel = new QLabel(this);
    m_engineLabel = new QLabel(this);
    m_volumeLabel->setObjectName("volumeLabel");
    m_cameraLabel->setObjectName("cameraLabel");
    m_rendererLabel->setObjectName("rendererLabel");
    m_engineLabel->setObjectName("engineLabel");
    m_cameraLabel->setToolTip(tr("Direction of the eye: azimuth, elevation; magnification (at 1 the sphere around the\n"
                                 "volume fits): what pellucid-cli takes as --view"));
    m_rendererLabel->setToolTip(
        tr("What draws the picture, and how well: pixels, distance of the samples along a ray"));
    m_engineLabel->setToolTip(tr("What computes visibility and VWS"));
    m_backgroundLabel = new QLabel(this);
    m_backgroundLabel->setObjectName("backgroundLabel");
    m_backgroundProgress = new QProgressBar(this);
    m_backgroundProgress->setObjectName("backgroundProgress");
    m_backgroundProgress->setRange(0, 0);
    m_backgroundProgress->setMaximumSize(160, 14);
    m_backgroundProgress->setTextVisible(false);
    m_backgroundCancel = new QToolButton(this);
    m_backgroundCancel->setObjectName("backgroundCancel");
    m_backgroundCancel->setText(tr("Cancel"));
    connect(m_backgroundCancel, &QToolButton::clicked, this, [this] {
        m_load->cancel();
        m_save->cancel();
    });
    statusBar()->addWidget(m_backgroundLabel);
    statusBar()->addWidget(m_backgroundProgress);
    statusBar()->addWidget(m_backgroundCancel);
    statusBar()->addPermanentWidget(m_volumeLabel);
    statusBar()->addPermanentWidget(m_cameraLabel);
    statusBar()->addPermanentWidget(m_rendererLabel);
    statusBar()->addPermanentWidget(m_engineLabel);
    endBackground();
}

void MainWindow::makeMenus() {
    const auto action = [this](QMenu* menu, const QString& text, const char* name, const QKeySequence& keys,
                               auto slot) {
        QAction* a = menu->addAction(text, this, slot);
        a->setObjectName(name);
        a->setShortcut(keys);
        return a;
    };

    QMenu* file = menuBar()->addMenu(tr("&File"));
    QAction* open = action(file, tr("&Open…"), "openAction", QKeySequence::Open, [this] { chooseVolume(); });
    m_recentMenu = file->addMenu(tr("Open &recent"));
    m_recentMenu->setObjectName("recentMenu");
    QMenu* sampleMenu = file->addMenu(tr("&Samples"));
    sampleMenu->setObjectName("samplesMenu");
    for (const SampleInfo& sample : samples()) {
        const QString name = QString::fromStdString(sample.name);
        QAction* a = sampleMenu->addAction(
            QStringLiteral("%1 – %2").arg(name, QString::fromStdString(sample.description)), this, [this, name] {
                VolumeSource source;
                source.path = "sample:" + name.toStdString();
                if (maybeSave()) openVolume(source);
            });
        a->setObjectName("sample_" + name);
    }
    file->addSeparator();
    QAction* openTfAction = action(file, tr("Open &transfer function…"), "openTfAction", QKeySequence("Ctrl+Shift+O"),
                                   [this] { chooseTf(); });
    QAction* save = action(file, tr("&Save transfer function"), "saveTfAction", QKeySequence::Save,
                           [this] { chooseSaveTf(false); });
    QAction* saveAs = action(file, tr("Save transfer function &as…"), "saveTfAsAction", QKeySequence("Ctrl+Shift+S"),
                             [this] { chooseSaveTf(true); });
    file->addSeparator();
    QAction* saveImageAction =
        action(file, tr("Save &image…"), "saveImageAction", QKeySequence("Ctrl+E"), [this] { chooseSaveImage(); });
    file->addSeparator();
    action(file, tr("&Quit"), "quitAction", QKeySequence("Ctrl+Q"), [] { QApplication::closeAllWindows(); });

    QMenu* edit = menuBar()->addMenu(tr("&Edit"));
    m_undoAction = action(edit, tr("&Undo"), "undoAction", QKeySequence::Undo, [this] {
        if (m_document.isPreviewing()) { // a drag under way is what is undone
            m_document.cancelPreview();
        } else {
            m_document.undoStack().undo();
        }
    });
    m_redoAction = action(edit, tr("&Redo"), "redoAction", QKeySequence("Ctrl+Shift+Z"),
                          [this] { m_document.undoStack().redo(); });
    m_redoAction->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});

    QMenu* tfMenu = menuBar()->addMenu(tr("&Transfer function"));
    QMenu* presets = tfMenu->addMenu(tr("&Presets"));
    presets->setObjectName("presetsMenu");
    action(presets, tr("Default of this volume"), "presetDefault", {},
           [this] { m_document.setTf(m_document.loaded().defaultTf, tr("Default")); });
    presets->addSeparator();
    for (const char* spec : {"tents:1", "tents:2", "tents:3", "tents:4", "tents:6", "tents:8", "ramp:6", "ramp:12"}) {
        const QString name = QString::fromLatin1(spec);
        const QString number = name.section(':', 1);
        action(presets,
               name.startsWith("tents")
                   ? (number == "1" ? tr("One tent, one feature") : tr("%1 tents, one feature each").arg(number))
                   : tr("Ramp of %1 points, one feature").arg(number),
               spec, {}, [this, name] { m_document.setTf(*tfFromSpec(name.toStdString()), name); });
    }
    tfMenu->addSeparator();
    m_refineAction =
        action(tfMenu, tr("&Refine by entropy"), "refineAction", QKeySequence("Ctrl+R"), [this] { refineTf(); });
    m_optimizeAction = action(tfMenu, tr("&Optimize to the targets"), "optimizeAction", QKeySequence("Ctrl+Return"),
                              [this] { startOptimization(); });
    tfMenu->addSeparator();
    QAction* derive = action(tfMenu, tr("&Features from the curve"), "deriveFeaturesAction", {}, [this] {
        TransferFunction tf = m_document.tf();
        tf.features = deriveFeatures(tf);
        m_document.setTf(tf, tr("Features from the curve"));
    });
    derive->setStatusTip(tr("One feature for each interval of the curve between two points of opacity 0"));

    QMenu* viewMenu = menuBar()->addMenu(tr("&View"));
    QList<QAction*> viewActions;
    viewActions << action(viewMenu, tr("&Fit"), "fitAction", QKeySequence("R"), [this] {
        m_view->fit();
    }) << action(viewMenu, tr("&Reset"), "resetViewAction", QKeySequence("Home"), [this] { m_view->resetView(); });
    viewActions[0]->setShortcuts({QKeySequence("R"), QKeySequence("F")});
    viewActions[0]->setToolTip(tr("The whole volume from the same direction (R, F or double-click)"));
    viewActions[1]->setToolTip(tr("The view that the volume opened with (Home)"));
    viewMenu->addSeparator();
    const std::pair<QString, StandardView> views[] = {
        {tr("Front"), StandardView::Front}, {tr("Back"), StandardView::Back}, {tr("Left"), StandardView::Left},
        {tr("Right"), StandardView::Right}, {tr("Top"), StandardView::Top},   {tr("Bottom"), StandardView::Bottom}};
    int key = 1;
    for (const auto& [text, standard] : views) {
        const QByteArray name = "view" + QByteArray::number(key);
        QAction* a = action(viewMenu, text, name.constData(), QKeySequence(QString::number(key)),
                            [this, view = standard] { m_view->setStandardView(view); });
        a->setToolTip(tr("Look from this side (%1)").arg(key));
        viewActions << a;
        ++key;
    }
    viewMenu->addSeparator();
    m_perspectiveAction = action(viewMenu, tr("&Perspective"), "perspectiveAction", QKeySequence("P"), [this] {
        m_view->setProjection(m_perspectiveAction->isChecked() ? Projection::Perspective : Projection::Orthographic);
    });
    m_perspectiveAction->setCheckable(true);
    m_perspectiveAction->setChecked(true);
    m_perspectiveAction->setToolTip(tr("Perspective or parallel projection (P)"));
    viewActions << m_perspectiveAction;
    viewMenu->addSeparator();
    viewMenu->addAction(m_tfDock->toggleViewAction());
    viewMenu->addAction(m_featuresDock->toggleViewAction());
    viewMenu->addAction(m_influenceDock->toggleViewAction());
    m_influenceDock->toggleViewAction()->setObjectName("influenceAction");
    m_influenceDock->toggleViewAction()->setShortcut(QKeySequence("Ctrl+I"));
    m_influenceDock->toggleViewAction()->setStatusTip(tr("How each feature's VWS follows each opacity"));

    QMenu* help = menuBar()->addMenu(tr("&Help"));
    action(help, tr("&Mouse and keys"), "keysAction", QKeySequence::HelpContents, [this] {
        QMessageBox::information(
            this, tr("Mouse and keys"),
            tr("<table cellpadding=3>"
               "<tr><td><b>Volume</b></td><td></td></tr>"
               "<tr><td>Left drag, arrow keys</td><td>rotate</td></tr>"
               "<tr><td>Middle drag, Shift + left drag</td><td>pan</td></tr>"
               "<tr><td>Wheel, right drag, + and −</td><td>zoom</td></tr>"
               "<tr><td>Double-click, F</td><td>fit</td></tr>"
               "<tr><td>R</td><td>back to the first view</td></tr>"
               "<tr><td>1 … 6, P</td><td>standard views, perspective</td></tr>"
               "<tr><td><b>Transfer function</b></td><td></td></tr>"
               "<tr><td>Drag a point (Shift: along one axis)</td><td>change value and opacity</td></tr>"
               "<tr><td>Double-click</td><td>add a point; on a point: its colour</td></tr>"
               "<tr><td>Enter, Space, Delete</td><td>colour, fix, remove the point</td></tr>"
               "<tr><td>Arrow keys (Shift: finer), Page Up/Down</td><td>move the point, choose another</td></tr>"
               "</table>"));
    });
    action(help, tr("&About Pellucid"), "aboutAction", {}, [this] {
        QMessageBox::about(this, tr("About Pellucid"),
                           tr("<b>Pellucid %1</b><br>The volume explorer that finds the transfer function for you.")
                               .arg(QApplication::applicationVersion()));
    });

    QToolBar* bar = addToolBar(tr("View"));
    bar->setObjectName("viewToolBar");
    bar->setMovable(false);
    bar->addAction(open);
    bar->addAction(saveImageAction);
    bar->addSeparator();
    bar->addAction(m_undoAction);
    bar->addAction(m_redoAction);
    bar->addSeparator();
    bar->addActions(viewActions);
    open->setToolTip(tr("Open a volume (Ctrl+O)"));
    saveImageAction->setToolTip(tr("Save the picture (Ctrl+E)"));

    m_tfActions << presets->actions() << m_refineAction << derive << openTfAction;
    m_volumeActions << save << saveAs << saveImageAction << viewActions;
}

void MainWindow::connectJobs() {
    connect(&m_document.undoStack(), &QUndoStack::cleanChanged, this, &MainWindow::updateTitle);
    connect(&m_document.undoStack(), &QUndoStack::indexChanged, this, &MainWindow::updateActions);
    connect(&m_document, &Document::volumeChanged, this, &MainWindow::updateTitle);
    connect(&m_document, &Document::volumeChanged, this, &MainWindow::updateActions);
    connect(&m_document, &Document::cameraChanged, this, &MainWindow::updateStatus);
    connect(&m_document, &Document::featuresChanged, this, &MainWindow::updateActions);
    connect(m_view, &VolumeView::frameShown, this, [this] {
        updateStatus();
        Q_EMIT settledChanged();
    });
    connect(m_view, &VolumeView::rendererFailed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                m_notices->addNotice(QStringList{what, where, whatToDo}.join(", "));
            });
    connect(m_measure, &MeasureJob::busyChanged, this, [this] {
        updateStatus();
        Q_EMIT settledChanged();
    });
    connect(&m_document, &Document::measuresChanged, this, [this] {
        updateStatus();
        Q_EMIT settledChanged();
    });
    connect(m_measure, &MeasureJob::failed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                m_notices->addNotice(
                    tr("The figures could not be computed: %1").arg(QStringList{what, where, whatToDo}.join(", ")));
            });

    connect(m_influenceDock, &QDockWidget::visibilityChanged, m_measure, &MeasureJob::setInfluenceWanted);

    connect(m_features, &FeaturesPanel::refineRequested, this, &MainWindow::refineTf);
    connect(m_features, &FeaturesPanel::optimizeRequested, this, &MainWindow::startOptimization);
    connect(m_features, &FeaturesPanel::cancelRequested, this, &MainWindow::cancelOptimization);
    connect(m_optimizer, &OptimizerJob::moved, this, [this](int move, const OptimizeState& state) {
        m_document.previewTf(withFeatureOpacities(m_document.committedTf(), state.opacity));
        m_document.setVws(state.vws);
        m_features->showMove(move, state.objective);
    });
    connect(m_optimizer, &OptimizerJob::finished, this, [this](const OptimizeResult& result) {
        m_document.previewTf(result.tf);
        m_document.commitPreview(tr("Optimize"));
        const OptimizeState& best = result.history[result.best];
        m_document.setVws(best.vws);
        const QString figures = tr("F = %1, from %2, in %3")
                                    .arg(best.objective, 0, 'f', 4)
                                    .arg(result.history.front().objective, 0, 'f', 4)
                                    .arg(counted(result.iterations(), tr("move"), tr("moves")));
        switch (result.reason) {
        case StopReason::Converged:
            m_features->setMessage(tr("On target: %1.").arg(figures));
            break;
        case StopReason::NoProgress:
            m_features->setMessage(tr("As near as it gets from this camera: %1.").arg(figures));
            break;
        default:
            m_features->setMessage(tr("Stopped at the most moves allowed: %1.").arg(figures));
            break;
        }
        optimizationEnded();
    });
    connect(m_optimizer, &OptimizerJob::cancelled, this, [this] {
        m_document.cancelPreview();
        m_features->setMessage(tr("Cancelled; nothing was changed."));
        optimizationEnded();
    });
    connect(m_optimizer, &OptimizerJob::failed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                m_document.cancelPreview();
                optimizationEnded();
                error(tr("Optimization failed"), what, where, whatToDo);
            });

    const auto showProgress = [this](double fraction) {
        m_backgroundProgress->setRange(0, 100);
        m_backgroundProgress->setValue(static_cast<int>(100 * fraction));
    };
    for (BackgroundTask* task : {m_load.get(), m_save.get()}) {
        connect(task, &BackgroundTask::progress, this, showProgress);
        connect(task, &BackgroundTask::finished, this, &MainWindow::endBackground);
        connect(task, &BackgroundTask::cancelled, this, [this] {
            endBackground();
            statusBar()->showMessage(tr("Cancelled"), 4000);
        });
    }
    connect(m_load.get(), &BackgroundTask::failed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                endBackground();
                error(tr("Cannot open the volume"), what, where, whatToDo);
                Q_EMIT openFailed();
            });
    connect(m_save.get(), &BackgroundTask::failed, this,
            [this](const QString& what, const QString& where, const QString& whatToDo) {
                endBackground();
                error(tr("Cannot save the image"), what, where, whatToDo);
            });
}

void MainWindow::openVolume(const VolumeSource& source, const QString& tfSpec) {
    const QString path = QString::fromStdString(source.path);
    beginBackground(tr("Opening %1…").arg(QFileInfo(path).fileName()));
    m_load->start(path, [this, source, tfSpec](const JobControl& job) -> BackgroundTask::Delivery {
        LoadedVolume loaded = loadForWindow(source, job);
        std::shared_ptr<TransferFunction> tf;
        std::optional<Error> tfError; // no reason not to show the volume
        try {
            if (!tfSpec.isEmpty()) tf = std::make_shared<TransferFunction>(loadTf(tfSpec.toStdString()));
        } catch (const Error& e) {
            tfError = e;
        }
        return [this, loaded = std::move(loaded), tf, tfError, tfSpec] {
            volumeLoaded(loaded, tf.get(), tf && !tfFromSpec(tfSpec.toStdString()) ? tfSpec : QString());
            if (tf) noteRange(*tf);
            if (tfError) error(tr("Cannot open the transfer function"), *tfError);
        };
    });
}

void MainWindow::volumeLoaded(const LoadedVolume& loaded, const TransferFunction* tf, const QString& tfPath) {
    if (m_optimizer->isRunning()) {
        m_optimizer->cancel();
        m_document.cancelPreview();
    }
    QStringList notices;
    for (const std::string& notice : loaded.volume->notices) notices << QString::fromStdString(notice);
    m_tfPath = tfPath;
    m_notices->setNotices(notices);
    m_document.setVolume(loaded, tf);
    const QString path = QString::fromStdString(loaded.source.path);
    if (!path.startsWith("sample:") && !loaded.source.raw) addRecentFile(path);
    updateStatus();
    Q_EMIT volumeOpened();
}

void MainWindow::openPath(const QString& path) {
    if (looksLikeTf(path)) return openTf(path);
    VolumeSource source;
    source.path = path.toStdString();
    if (askRawLayout(source) && maybeSave()) openVolume(source);
}

void MainWindow::openAtStart(const QString& path, const QString& tfSpec) {
    VolumeSource source;
    source.path = path.toStdString();
    if (askRawLayout(source)) openVolume(source, tfSpec);
}

bool MainWindow::askRawLayout(VolumeSource& source) {
    const QString path = QString::fromStdString(source.path);
    if (path.startsWith("sample:") || !isHeaderless(path) || !QFileInfo(path).isFile()) return true;
    RawDialog dialog(path, this);
    if (dialog.exec() != QDialog::Accepted) return false;
    source.raw = dialog.layoutOfFile();
    return true;
}

void MainWindow::openTf(const QString& specOrPath) {
    if (m_optimizer->isRunning() || !m_document.hasVolume()) return;
    try {
        const TransferFunction tf = loadTf(specOrPath.toStdString());
        const bool isFile = !tfFromSpec(specOrPath.toStdString());
        m_document.setTf(tf, tr("Open transfer function"));
        if (isFile) {
            m_tfPath = specOrPath;
            m_document.undoStack().setClean();
        }
        noteRange(tf);
    } catch (const Error& e) {
        error(tr("Cannot open the transfer function"), e);
    }
}

void MainWindow::noteRange(const TransferFunction& tf) {
    const ValueRange& range = m_document.volume()->range();
    if (!tf.range || *tf.range == range) return;
    m_notices->addNotice(tr("This transfer function was made for values %1; it has been stretched to %2.")
                             .arg(rangeText(*tf.range), rangeText(range)));
}

bool MainWindow::saveTf(const QString& path) {
    if (!m_document.hasVolume()) return false;
    try {
        TransferFunction tf = m_document.committedTf();
        tf.range = m_document.volume()->range();
        writeTf(tf, path.toStdString());
        m_tfPath = path;
        m_document.undoStack().setClean();
        statusBar()->showMessage(tr("Saved %1").arg(QFileInfo(path).fileName()), 4000);
        return true;
    } catch (const Error& e) {
        error(tr("Cannot save the transfer function"), e);
        return false;
    }
}

void MainWindow::saveImage(const SaveImageOptions& options) {
    if (!m_document.hasVolume()) return;
    RenderSettings settings;
    settings.width = options.size.width();
    settings.height = options.size.height();
    settings.background = options.transparent ? std::optional<Rgb>() : std::optional<Rgb>(kViewBackground);
    const std::string path = options.path.toStdString();
    try {
        settings.validate();
        checkImageSuffix(path);
    } catch (const Error& e) {
        return error(tr("Cannot save the image"), e);
    }
    beginBackground(tr("Saving %1…").arg(QFileInfo(options.path).fileName()));
    m_save->start(options.path,
                  [this, path, settings, volume = m_document.volume(), tf = m_document.tf(),
                   camera = m_document.camera()](const JobControl& job) -> BackgroundTask::Delivery {
                      const std::unique_ptr<ImageRenderer> renderer = makeRenderer(EngineChoice::Auto, volume);
                      const Image image = renderer->render(camera, tf, settings, job);
                      job.throwIfStopped();
                      writeImage(image, path);
                      return [this, path] {
                          const QString saved = QString::fromStdString(path);
                          statusBar()->showMessage(tr("Saved %1").arg(QFileInfo(saved).fileName()), 4000);
                          Q_EMIT imageSaved(saved);
                      };
                  });
}

void MainWindow::refineTf() {
    if (!m_document.hasVolume() || m_optimizer->isRunning()) return;
    try {
        // A few milliseconds, of the histogram alone: no reason to go to another thread.
        const RefineResult result = refine(m_document.histogram(), m_document.tf());
        const double before = result.energyMovableBefore, after = result.energyMovableAfter;
        if (result.tf == m_document.tf()) {
            m_features->setMessage(tr("Refinement found nothing to improve."));
            return;
        }
        m_document.setTf(result.tf, tr("Refine"));
        m_features->setMessage(tr("Refined in %1: energy %2, from %3.")
                                   .arg(counted(result.iterations, tr("step"), tr("steps")))
                                   .arg(QString::number(after, 'g', 3), QString::number(before, 'g', 3)));
    } catch (const Error& e) {
        error(tr("Refinement failed"), e);
    }
}

void MainWindow::startOptimization() {
    if (!m_document.hasVolume() || m_optimizer->isRunning() || m_document.tf().features.empty()) return;
    m_document.commitPreview(tr("Edit"));
    m_measure->setPaused(true);
    m_features->setMessage({});
    m_features->setOptimizing(true);
    m_tfEditor->setReadOnly(true);
    m_optimizer->start(m_document.volume(), m_document.tf(), m_document.camera(), m_document.targets(),
                       m_features->options());
    updateActions();
}

void MainWindow::cancelOptimization() { m_optimizer->cancel(); }

void MainWindow::optimizationEnded() {
    m_features->setOptimizing(false);
    m_tfEditor->setReadOnly(false);
    m_measure->setPaused(false);
    updateActions();
    Q_EMIT settledChanged();
}

bool MainWindow::isSettled() const {
    return m_document.hasVolume() && !m_load->isRunning() && !m_save->isRunning() && !m_optimizer->isRunning() &&
           !m_measure->isBusy() && m_view->isComplete();
}

void MainWindow::chooseVolume() {
    QStringList patterns;
    for (const std::string& pattern : volumeFilePatterns()) patterns << QString::fromStdString(pattern);
    for (const char* raw : {"*.raw", "*.dat", "*.bin", "*.vol"}) {
        if (!patterns.contains(raw)) patterns << raw;
    }
    const QString path =
        QFileDialog::getOpenFileName(this, tr("Open volume"), QSettings().value("volumeFolder").toString(),
                                     tr("Volumes (%1);;All files (*)").arg(patterns.join(' ')));
    if (path.isEmpty()) return;
    QSettings().setValue("volumeFolder", QFileInfo(path).absolutePath());
    openPath(path);
}

void MainWindow::chooseTf() {
    const QString path =
        QFileDialog::getOpenFileName(this, tr("Open transfer function"), QSettings().value("tfFolder").toString(),
                                     tr("Transfer functions (*.tf.json *.json);;All files (*)"));
    if (path.isEmpty()) return;
    QSettings().setValue("tfFolder", QFileInfo(path).absolutePath());
    openTf(path);
}

bool MainWindow::chooseSaveTf(bool askForName) {
    if (!m_document.hasVolume()) return false;
    QString path = m_tfPath;
    if (askForName || path.isEmpty()) {
        const QString folder = QSettings().value("tfFolder").toString();
        const QString offered =
            path.isEmpty()
                ? QFileInfo(QDir(folder), QFileInfo(m_document.title()).completeBaseName() + ".tf.json").filePath()
                : path;
        path = QFileDialog::getSaveFileName(this, tr("Save transfer function"), offered,
                                            tr("Transfer functions (*.tf.json)"));
        if (path.isEmpty()) return false;
        if (!path.endsWith(".json", Qt::CaseInsensitive)) path += ".tf.json";
        QSettings().setValue("tfFolder", QFileInfo(path).absolutePath());
    }
    return saveTf(path);
}

void MainWindow::chooseSaveImage() {
    if (!m_document.hasVolume()) return;
    const QString folder = QSettings().value("imageFolder", QDir::homePath()).toString();
    const QString name = QFileInfo(m_document.title()).completeBaseName() + ".png";
    const QSize seen(m_view->frame().width, m_view->frame().height);
    SaveImageDialog dialog(QDir(folder).filePath(name), seen.isEmpty() ? m_view->size() : seen, this);
    while (dialog.exec() == QDialog::Accepted) {
        const SaveImageOptions options = dialog.options();
        if (options.path.isEmpty()) continue;
        if (QFileInfo::exists(options.path) &&
            QMessageBox::question(this, tr("Save image"),
                                  tr("%1 exists. Replace it?").arg(QFileInfo(options.path).fileName())) !=
                QMessageBox::Yes)
            continue;
        QSettings().setValue("imageFolder", QFileInfo(options.path).absolutePath());
        return saveImage(options);
    }
}

bool MainWindow::maybeSave() {
    if (m_document.undoStack().isClean() || !m_document.hasVolume()) return true;
    QMessageBox box(QMessageBox::Question, tr("Unsaved transfer function"),
                    tr("The transfer function has been changed and not been saved."),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName("askSave");
    box.setInformativeText(tr("Save it before it is lost?"));
    box.setDefaultButton(QMessageBox::Save);
    switch (box.exec()) {
    case QMessageBox::Save:
        return chooseSaveTf(false);
    case QMessageBox::Discard:
        return true;
    default:
        return false;
    }
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (m_optimizer->isRunning()) {
        m_optimizer->cancel();
        m_document.cancelPreview();
    }
    if (!maybeSave()) return event->ignore();
    m_load->cancel();
    m_save->cancel();
    QSettings settings;
    settings.setValue("geometry", saveGeometry());
    settings.setValue("windowState", saveState());
    event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    const QList<QUrl> urls = event->mimeData()->urls();
    if (!urls.isEmpty() && urls.front().isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    const QList<QUrl> urls = event->mimeData()->urls();
    if (urls.isEmpty() || !urls.front().isLocalFile()) return;
    event->acceptProposedAction();
    // In a later turn: a dialog must not keep the program waiting that the file was dragged from.
    QMetaObject::invokeMethod(
        this, [this, path = urls.front().toLocalFile()] { openPath(path); }, Qt::QueuedConnection);
}

void MainWindow::addRecentFile(const QString& path) {
    QSettings settings;
    QStringList files = settings.value(kRecentKey).toStringList();
    const QString absolute = QFileInfo(path).absoluteFilePath();
    files.removeAll(absolute);
    files.prepend(absolute);
    while (files.size() > kRecentFiles) files.removeLast();
    settings.setValue(kRecentKey, files);
    updateRecentFiles();
}

void MainWindow::updateRecentFiles() {
    m_recentMenu->clear();
    const QStringList files = QSettings().value(kRecentKey).toStringList();
    for (const QString& file : files) {
        QAction* a = m_recentMenu->addAction(QFileInfo(file).fileName(), this, [this, file] { openPath(file); });
        a->setToolTip(file);
        a->setStatusTip(file);
    }
    m_recentMenu->setEnabled(!files.isEmpty());
}

void MainWindow::updateActions() {
    const bool volume = m_document.hasVolume(), optimizing = m_optimizer->isRunning();
    for (QAction* a : m_volumeActions) a->setEnabled(volume);
    for (QAction* a : m_tfActions) a->setEnabled(volume && !optimizing);
    m_optimizeAction->setEnabled(volume && !optimizing && !m_document.tf().features.empty());
    const QUndoStack& stack = m_document.undoStack();
    m_undoAction->setEnabled(!optimizing && stack.canUndo());
    m_redoAction->setEnabled(!optimizing && stack.canRedo());
    m_undoAction->setToolTip(stack.canUndo() ? tr("Undo: %1 (Ctrl+Z)").arg(stack.undoText()) : tr("Undo (Ctrl+Z)"));
    m_redoAction->setToolTip(stack.canRedo() ? tr("Redo: %1 (Ctrl+Shift+Z)").arg(stack.redoText())
                                             : tr("Redo (Ctrl+Shift+Z)"));
}

void MainWindow::updateTitle() {
    setWindowTitle(m_document.hasVolume() ? tr("%1[*] – Pellucid").arg(m_document.title()) : tr("Pellucid"));
    setWindowModified(m_document.hasVolume() && !m_document.undoStack().isClean());
}

void MainWindow::updateStatus() {
    if (!m_document.hasVolume()) return;
    const Volume& volume = *m_document.volume();
    m_volumeLabel->setText(QStringLiteral("%1×%2×%3 %4")
                               .arg(volume.dims().x)
                               .arg(volume.dims().y)
                               .arg(volume.dims().z)
                               .arg(QString::fromLatin1(name(volume.sampleType()))));
    m_volumeLabel->setToolTip(tr("%1, values %2, spacing %3 × %4 × %5, %L6 invalid voxels")
                                  .arg(QString::fromStdString(volume.format), rangeText(volume.dataRange()))
                                  .arg(volume.geometry().spacing.x)
                                  .arg(volume.geometry().spacing.y)
                                  .arg(volume.geometry().spacing.z)
                                  .arg(volume.invalidCount()));
    const ViewAngles angles = viewAngles(m_document.camera(), volume.geometry());
    const bool perspective = m_document.camera().projection == Projection::Perspective;
    m_perspectiveAction->setChecked(perspective);
    m_cameraLabel->setText(QStringLiteral("%1°, %2°  ×%3")
                               .arg(angles.azimuth, 0, 'f', 0)
                               .arg(angles.elevation, 0, 'f', 0)
                               .arg(angles.zoom, 0, 'f', 2));
    const FrameInfo& frame = m_view->frame();
    const QString quality = frame.complete ? tr("step %1 d0").arg(frame.stepInD0) : tr("coarse");
    m_rendererLabel->setText(
        QStringLiteral("%1  %2×%3  %4").arg(m_view->rendererName()).arg(frame.width).arg(frame.height).arg(quality));
    if (m_optimizer->isRunning()) {
        m_engineLabel->setText(tr("optimizing"));
    } else if (m_measure->isBusy() || m_measure->engineName().isEmpty()) {
        m_engineLabel->setText(tr("measuring"));
    } else {
        m_engineLabel->setText(tr("measured: %1").arg(m_measure->engineName()));
    }
}

void MainWindow::beginBackground(const QString& text) {
    m_backgroundLabel->setText(text);
    m_backgroundProgress->setRange(0, 0);
    m_backgroundLabel->show();
    m_backgroundProgress->show();
    m_backgroundCancel->show();
}

void MainWindow::endBackground() {
    if (m_load->isRunning() || m_save->isRunning()) return;
    m_backgroundLabel->hide();
    m_backgroundProgress->hide();
    m_backgroundCancel->hide();
    Q_EMIT settledChanged();
}

void MainWindow::error(const QString& title, const QString& what, const QString& where, const QString& whatToDo) {
    showError(this, title, what, where, whatToDo);
}

void MainWindow::error(const QString& title, const Error& e) {
    error(title, QString::fromStdString(e.problem()), QString::fromStdString(e.where()),
          QString::fromStdString(e.whatToDo()));
}

} // namespace pellucid::gui
