// Figures for print of what the window shows.
#pragma once

#include <memory>

#include <QImage>
#include <QObject>
#include <QPointer>
#include <QSize>

#include "jobs/background_work.h"

namespace pellucid {
class Workspace;
struct FigureFile;
struct FigureTask;
} // namespace pellucid

namespace pellucid::gui {

class FigureDialog;
class Services;

class FigureController : public FileWork<FigureTask, FigureFile> {
    Q_OBJECT
public:
    explicit FigureController(Services& services);
    ~FigureController() override;

    void addActions();
    void setSeenSize(const QSize& pixels) { m_seen = pixels; } ///< of the view

Q_SIGNALS:
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
    QSize m_seen{4, 3};
    QPointer<FigureDialog> m_dialog; ///< the one that is open
    Job<Sketch, Preview> m_preview;
};

} // namespace pellucid::gui
