// Studies: views are added to them, they are prepared, and shown to participants.
#pragma once

#include <QObject>
#include <QPointer>

#include "jobs/background_work.h"
#include "runner/study_window.h"
#include "study/add_view.h"
#include "study/analysis.h"
#include "study/preparation.h"

namespace pellucid::gui {

class Services;

class StudyController : public BackgroundWork {
    Q_OBJECT
public:
    explicit StudyController(Services& services);

    void addActions();

    /// The view that is shown, into the study of this file, which is the present one from now on. Whether it was.
    bool addView(const QString& study, const AskedFeature& asked);
    /// In the background; nobody is asked.
    void prepare(const QString& study, const QString& folder);
    /// Writes kReportFile into the folder of a prepared study, in the background, and opens it.
    void analyze(const QString& folder, const StudyAnalysisOptions& options = {});
    /// Opens the window for a participant, "" for a new one; null where it cannot be, and a dialog says why.
    StudyWindow* run(const QString& folder, const QString& participant);

    QString study() const; ///< file of the present study; "" where there is none
    void setStudy(const QString& path);
    QString preparedFolder() const; ///< where the latest study was prepared, or run

    bool isBusy() const override { return m_preparing.isRunning() || m_analyzing.isRunning(); }
    QString busyText() const override {
        return m_preparing.isRunning() ? tr("Preparing the study…") : tr("Analyzing the study…");
    }
    void cancel() override {
        m_preparing.cancel();
        m_analyzing.cancel();
    }

Q_SIGNALS:
    void prepared(const QString& folder);
    void analyzed(const QString& report); ///< a file

private:
    struct Preparation {
        std::string study, folder;
    };
    struct Analysis {
        QString folder;
        StudyAnalysisOptions options;
    };
    void chooseView();
    void edit();
    void choosePrepared();
    void chooseRun();
    void chooseAnalysis();
    QString chooseStudy(const QString& title); ///< the file of one that is there; "": the user gave up
    void keepPreparedFolder(const QString& folder);

    Services& m_services;
    QPointer<StudyWindow> m_window;
    Job<Preparation, PreparedStudy> m_preparing;
    Job<Analysis, QString> m_analyzing; ///< the file of the report
};

} // namespace pellucid::gui
