// Saving: sessions, transfer functions, pictures, bars and reports.
#pragma once

#include <QObject>

#include "dialogs/save_image_dialog.h"
#include "dialogs/save_volume_dialog.h"
#include "image_io/picture_text.h"
#include "jobs/background_work.h"
#include "session/scene.h"

namespace pellucid::gui {

class FieldController;
class PictureSaliencyController;
class RulerController;
class Services;

class SaveController : public BackgroundWork {
    Q_OBJECT
public:
    SaveController(Services& services, FieldController& fields, const PictureSaliencyController& pictureSaliency,
                   const RulerController& rulers);

    void addActions();

    bool saveSession(const QString& path); ///< false: it could not be written, and a dialog says why
    bool saveTf(const QString& path);
    /// As seen by the present camera, in the background; several one after the other.
    void saveImage(const SaveImageOptions& options);
    /// What each feature shows now, as bar charts, with the targets; .svg or .png. False: it could not be written, and
    /// a dialog says why.
    bool saveBars(const QString& path);
    /// What the picture shows, in words, onto the clipboard: with the shares of features, once they are measured, and
    /// what hides what, where the influence is.
    void copyCaption();
    /// The transfer function over the histogram, as a drawing; .svg or .png. Likewise.
    bool saveTfDrawing(const QString& path);
    /// The data, or the field that is drawn, in the format of the suffix; in the background.
    void saveVolume(const SaveVolumeOptions& options);
    /// Of a run with a start: the folder gets report.html, curves.csv, and the session that the run began with; in the
    /// background.
    void saveReport(const Run& run, const QString& folder);
    void chooseReport(const Run& run); ///< asks for the folder
    /// Asks about unsaved work; false: the user wants to stay.
    bool maybeSave();
    /// Pixels of the view on the screen, which are offered first for pictures.
    void setSeenSize(const QSize& pixels) { m_seen = pixels; }

    const QString& tfPath() const { return m_tfPath; } ///< of the transfer function that is open; empty: of no file
    void setTfPath(const QString& path) { m_tfPath = path; }
    const QString& sessionPath() const { return m_sessionPath; }
    void setSessionPath(const QString& path);

    QAction* barsAction() const { return m_barsAction; }

    bool isBusy() const override { return m_images.isRunning() || m_reports.isRunning() || m_volumes.isRunning(); }
    QString busyText() const override { return m_busyText; }
    void cancel() override {
        m_images.cancel();
        m_reports.cancel();
        m_volumes.cancel();
    }

Q_SIGNALS:
    void imageSaved(const QString& path);
    void volumeSaved(const QString& path);
    void sessionPathChanged();

private:
    struct Picture {
        PictureInput input;
        AnnotationInput around; ///< shows nothing where nothing is wanted
        QString path;
        PictureText text; ///< but for the session
        Scene scene;      ///< whose session the file carries, where `carries`
        bool carries = false, layers = false;
    };
    /// What the file says of the picture of the present scene.
    PictureText describe(const SaveImageOptions& options) const;
    static void write(const Picture& picture, const JobControl& job);
    struct ReportTask {
        Run run;
        Scene now;
        QString folder;
    };
    struct VolumeTask {
        std::shared_ptr<const Volume> volume; ///< null: all frames of the series
        std::shared_ptr<TimeSeries> series;
        QString path;
        WrittenPart part;
        std::vector<std::string> notices; ///< what reading the data lost
    };
    const Run* latestRun() const; ///< that a report can be made of; null: none
    bool mayReplace(const QString& file, const QString& title, const QString& question); ///< asks where it is there
    bool chooseSession(bool askForName);
    bool chooseTf(bool askForName);
    void chooseImage();
    void chooseVolume();
    /// What was there when saving was asked for.
    struct Savable {
        Scene scene;
        std::shared_ptr<const Volume> field; ///< that is drawn; null: none is, or not of this scene
    };
    Savable nowSavable() const;
    SavableVolume described(const Savable& from) const;
    void saveVolume(const SaveVolumeOptions& options, const Savable& from);
    /// Throws Error where there is no field to save, and where a file would be replaced that an open volume comes from.
    static void requireNotOpen(const std::string& path, const SaveVolumeOptions& options, const Savable& from);
    void chooseBars();
    void chooseTfDrawing();
    /// Asks where a drawing is to go; empty: nowhere.
    QString askDrawing(const QString& title, const QString& ending);

    Services& m_services;
    FieldController& m_fields;
    const PictureSaliencyController& m_pictureSaliency;
    const RulerController& m_rulers;
    QString m_tfPath, m_sessionPath, m_busyText;
    QSize m_seen;
    QAction* m_barsAction = nullptr;
    Job<Picture, QString> m_images;
    Job<ReportTask, QString> m_reports;
    Job<VolumeTask, std::vector<std::string>> m_volumes; ///< makes what the file does not have
};

} // namespace pellucid::gui
