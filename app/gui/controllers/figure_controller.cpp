#include "controllers/figure_controller.h"

#include <algorithm>

#include <QDir>
#include <QFileInfo>

#include "dialogs/ask_file.h"
#include "dialogs/error_dialog.h"
#include "dialogs/figure_dialog.h"
#include "figure/figure_file.h"
#include "figure/print.h"
#include "jobs/rest_timer.h"
#include "services/services.h"
#include "widgets/image_convert.h"

namespace pellucid::gui {
namespace {

constexpr int kRest = 250; // milliseconds that the dialog rests before it is drawn anew

} // namespace

FigureController::FigureController(Services& services)
    : FileWork(
          [](const FigureTask& task, const JobControl& job) { return makeFigure(task, job); },
          [this](const FigureTask& task, const FigureFile& figure) {
              for (const std::string& notice : figure.notices)
                  m_services.notices().add({QString::fromStdString(notice)});
              const QString path = QString::fromStdString(task.path);
              m_services.saySaved(
                  path,
                  tr("%1 × %2 mm").arg(QString::number(figure.width, 'f', 1), QString::number(figure.height, 'f', 1)));
              Q_EMIT saved(path);
          }),
      m_services(services), m_preview(
                                &FigureController::previewOf,
                                [this](const Sketch&, Preview& preview) {
                                    if (m_dialog) m_dialog->showPreview(preview.picture, preview.height);
                                },
                                WhenBusy::FinishOld) {
    connect(&m_preview, &JobBase::failed, this, [this](const Error& error) {
        if (m_dialog) m_dialog->showNoPreview(QString::fromStdString(error.what()));
    });
    services.showFailuresOf(job(), tr("Cannot save the figure"));
}

FigureController::~FigureController() = default;

void FigureController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.add("saveFigureAction", tr("Save figure for &print…"), {},
             tr("The picture with scale, legend and bars of shares, as PDF or SVG of a width in millimetres"),
             [this] { choose(); });
}

FigureController::Preview FigureController::previewOf(const Sketch& sketch, const JobControl& job) {
    FigureTask coarse = *sketch.task;
    checkFigure(coarse); // as it will be, not as it is drawn now
    coarse.settings.dpi = std::max(36.0, sketch.width * kMmPerInch / coarse.settings.widthMm);
    const Figure figure = layOut(figureContent(coarse, *sketch.workspace, job));
    return {qImageFromImage(rasterOf(figure, sketch.width)), figure.height};
}

void FigureController::choose() {
    const Scene scene = m_services.scene(); // the figure is of what is seen now, however long the dialog is open
    FigureTask task{scene, pictureInput(scene, 16, 16).settings};
    FigureOptions offered;
    offered.settings.heightMm = offered.settings.widthMm * m_seen.height() / std::max(1, m_seen.width());
    const QString title = QFileInfo(QString::fromStdString(scene.volume->title)).baseName();
    offered.path = QDir(keptFolder("figureFolder", QDir::homePath())).filePath(title + ".pdf");
    if (!m_services.attempt(tr("Cannot save the figure"), [&] { checkFigure(task); })) return;

    FigureDialog dialog(offered, m_services.window());
    m_dialog = &dialog;
    const auto workspace = std::make_shared<Workspace>();
    const auto sketch = [&] {
        auto sketched = std::make_shared<FigureTask>(task);
        sketched->settings = dialog.options().settings;
        m_preview.start({sketched, workspace, dialog.previewWidth()});
    };
    RestTimer rest(kRest, sketch);
    connect(&dialog, &FigureDialog::changed, &rest, [&rest] { rest.start(); });
    sketch();
    while (dialog.exec() == QDialog::Accepted) {
        const FigureOptions chosen = dialog.options();
        task.settings = chosen.settings;
        task.path = chosen.path.toStdString();
        try {
            checkFigureSuffix(task.path);
            checkFigure(task);
        } catch (const Error& error) { // read before the dialog comes back, which would cover it
            showErrorFirst(m_services.window(), tr("Cannot save the figure"), error);
            continue;
        }
        if (!mayReplaceFile(m_services.window(), chosen.path, tr("Save figure for print"))) continue;
        keepFolderOf("figureFolder", chosen.path);
        start(task);
        break;
    }
    m_preview.cancel();
}

} // namespace pellucid::gui
