// The window: one volume, its docks, its menus, and the jobs behind them.
#pragma once

#include <memory>

#include <QMainWindow>

#include "background_task.h"
#include "compute_thread.h"
#include "features_panel.h"
#include "influence_panel.h"
#include "measure_job.h"
#include "models/document.h"
#include "notice_bar.h"
#include "optimizer_job.h"
#include "save_image_dialog.h"
#include "tf_editor_widget.h"
#include "volume_view.h"

class QLabel;
class QProgressBar;
class QToolButton;

namespace pellucid::gui {

class MainWindow : public QMainWindow {
    Q_OBJECT
public:
    explicit MainWindow(ViewRenderer renderer = ViewRenderer::Auto, QWidget* parent = nullptr);
    ~MainWindow() override;

    Document& document() { return m_document; }
    VolumeView& view() { return *m_view; }
    TfEditorWidget& tfEditor() { return *m_tfEditor; }
    FeaturesPanel& featuresPanel() { return *m_features; }

    /// Size, place and docks as the last window was closed with.
    void restoreLayout();
    /// Opens a volume in the background; an error shows a dialog and leaves everything as it is. `tfSpec` (a file,
    /// tents:N[:PEAK], ramp:N) replaces the volume's default transfer function; empty: keep the default.
    void openVolume(const VolumeSource& source, const QString& tfSpec = {});
    /// A path from the user: a transfer function by its name, else a volume; headerless data asks for its layout.
    void openPath(const QString& path);
    /// The same, of the first volume and with its transfer function.
    void openAtStart(const QString& path, const QString& tfSpec);
    void openTf(const QString& specOrPath);
    bool saveTf(const QString& path);
    /// As seen by the present camera, in the background.
    void saveImage(const SaveImageOptions& options);

    void refineTf();
    void startOptimization();
    void cancelOptimization();
    bool isOptimizing() const { return m_optimizer->isRunning(); }

    /// The picture is as good as it gets, the figures are of the present state, and nothing is under way.
    bool isSettled() const;

Q_SIGNALS:
    void settledChanged(); ///< isSettled() may have changed
    void imageSaved(const QString& path);
    void volumeOpened();
    void openFailed();

protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

private:
    void makeDocks();
    void makeMenus();
    void connectJobs();
    void chooseVolume();
    void chooseTf();
    bool chooseSaveTf(bool askForName);
    void chooseSaveImage();
    bool maybeSave();                        ///< false: the user wants to stay
    bool askRawLayout(VolumeSource& source); ///< false: the user gave up
    void volumeLoaded(const LoadedVolume& loaded, const TransferFunction* tf, const QString& tfPath);
    void noteRange(const TransferFunction& tf); ///< a notice where it was made for other values
    void optimizationEnded();
    void addRecentFile(const QString& path);
    void updateRecentFiles();
    void updateActions();
    void updateTitle();
    void updateStatus();
    void beginBackground(const QString& text);
    void endBackground();
    void error(const QString& title, const QString& what, const QString& where, const QString& whatToDo);
    void error(const QString& title, const Error& error);

    Document m_document;
    VolumeView* m_view;
    NoticeBar* m_notices;
    TfEditorWidget* m_tfEditor = nullptr;
    FeaturesPanel* m_features = nullptr;
    QDockWidget *m_tfDock = nullptr, *m_featuresDock = nullptr, *m_influenceDock = nullptr;
    QMenu* m_recentMenu = nullptr;
    QAction *m_undoAction = nullptr, *m_redoAction = nullptr, *m_perspectiveAction = nullptr;
    QAction *m_refineAction = nullptr, *m_optimizeAction = nullptr;
    QList<QAction*> m_tfActions;     ///< change the transfer function: not while an optimization runs
    QList<QAction*> m_volumeActions; ///< need a volume
    QLabel *m_volumeLabel = nullptr, *m_cameraLabel = nullptr, *m_rendererLabel = nullptr, *m_engineLabel = nullptr;
    QLabel* m_backgroundLabel = nullptr;
    QProgressBar* m_backgroundProgress = nullptr;
    QToolButton* m_backgroundCancel = nullptr;
    QString m_tfPath; ///< where Save writes; empty: asks

    // The jobs post to their objects, which therefore must outlive the threads: see the destructor.
    std::unique_ptr<ComputeThread> m_compute;
    MeasureJob* m_measure = nullptr;
    OptimizerJob* m_optimizer = nullptr;
    std::unique_ptr<BackgroundTask> m_load, m_save;
};

} // namespace pellucid::gui
