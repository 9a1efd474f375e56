// Figures for print of what the window shows.
#pragma once

#include <memory>

#include <QImage>
#include <QObject>
#include <QPointer>
#include <QSize>

#include "jobs/job.h"

namespace pellucid {
class Workspace;
struct FigureFile;
struct FigureTask;
} // namespace pellucid

namespace pellucid::gui {

class FigureDialog;
class Services;

class FigureController : public QObject {
    Q_OBJECT
public:
    explicit FigureController(Services& services);
    ~FigureController() override;

    void addActions();
    void setSeenSize(const QSize& pixels) { m_seen = pixels; } ///< of the view

    void cancel() { m_job.cancel(); }
    bool isBusy() const { return m_job.isRunning(); }
    QString busyText() const;

Q_SIGNALS:
    void busyChanged();
    void progress(double fraction);
    void cancelled();
    void saved(const QString& path);

private:
    /// A figure to be looked at, with what previews before it have left.
    struct Sketch {
        std::shared_ptr<const FigureTask> task;
        std::shared_ptr<Workspace> workspace;
        int width = 0; ///< pixels
    };
    struct Preview {
        QImage picture;
        double height = 0; ///< mm
    };
    static Preview previewOf(const Sketch& sketch, const JobControl& job);
    void choose();

    Services& m_services;
    QString m_name; ///< of the file that is being written
    QSize m_seen{4, 3};
    QPointer<FigureDialog> m_dialog; ///< the one that is open
    Job<Sketch, Preview> m_preview;
    Job<std::shared_ptr<const FigureTask>, std::shared_ptr<const FigureFile>> m_job;
};

} // namespace pellucid::gui
