#include "window/status_line.h"

#include <algorithm>

#include <QStatusBar>

#include "base/memory.h"
#include "jobs/background_work.h"
#include "render/camera_motion.h"
#include "services/services.h"
#include "view/volume_view.h"
#include "volume/orientation.h"
#include "widgets/controls.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kMessageTime = 8000, kMemoryTime = 2000; // milliseconds
constexpr double kMostMemory = 1e6;                    // GiB: what is more stands for "not known"

} // namespace

StatusLine::StatusLine(Services& services, std::vector<BackgroundWork*> works, VolumeView& view, QStatusBar& bar)
    : QObject(&bar), m_services(services), m_works(std::move(works)), m_view(view), m_bar(bar),
      m_volume(named(new QLabel(&bar), "volumeLabel")),
      m_camera(named(new QLabel(&bar), "cameraLabel",
                     tr("Direction of the eye: azimuth, elevation; magnification (at 1 the sphere around the\n"
                        "volume fits): what pellucid-cli takes as --view"))),
      m_renderer(named(new QLabel(&bar), "rendererLabel")), m_engine(named(new QLabel(&bar), "engineLabel")),
      m_background(named(new QLabel(&bar), "backgroundLabel")), m_hint(named(new QLabel(&bar), "hintLabel")),
      m_memory(named(new QLabel(&bar), "memoryLabel")), m_progress(progressBar("backgroundProgress", &bar)),
      m_cancel(
          named(toolButton(tr("Cancel"), &bar), "backgroundCancel", tr("Stop what is under way in the background"))) {
    m_progress->setMaximumSize(160, 14);
    m_cancel->setMaximumHeight(bar.fontMetrics().height()); // no higher than the texts
    bar.setSizeGripEnabled(false);
    m_hint->setText(tr("Click: what is seen there  ·  drag: turn  ·  wheel: zoom  ·  middle drag: move"));
    m_hint->setTextFormat(Qt::PlainText);
    m_hint->setMinimumWidth(1); // figures and sizes come before it
    makeFaint(*m_hint);
    bar.addWidget(m_hint, 1);
    bar.addWidget(m_background);
    bar.addWidget(m_progress);
    bar.addWidget(m_cancel);
    for (QLabel* label : {m_volume, m_camera, m_renderer, m_engine, m_memory}) bar.addPermanentWidget(label);
    m_memory->hide();
    connect(&m_watch, &QTimer::timeout, this, &StatusLine::followMemory);

    connect(m_cancel, &QToolButton::clicked, this, [this] {
        for (BackgroundWork* work : m_works) work->cancel();
    });
    for (BackgroundWork* work : m_works) {
        connect(work, &BackgroundWork::progress, this, [this](double fraction) {
            m_progress->setRange(0, 100);
            m_progress->setValue(static_cast<int>(100 * fraction));
        });
        connect(work, &BackgroundWork::cancelled, this, [this] { m_bar.showMessage(tr("Cancelled"), kMessageTime); });
        connect(work, &BackgroundWork::busyChanged, this, &StatusLine::followBackground);
    }
    connect(&services, &Services::message, this,
            [this](const QString& text) { m_bar.showMessage(text, kMessageTime); });
    connect(&bar, &QStatusBar::messageChanged, this, [this](const QString& text) {
        if (text.isEmpty()) followBackground();
    });
    connect(&services.store(), &SessionStore::changed, this, &StatusLine::followScene);
    connect(&services.results(), &Results::changed, this, &StatusLine::followFigures);
    connect(&services, &Services::readOnlyChanged, this, &StatusLine::followFigures);
    connect(&view, &VolumeView::pictureShown, this, &StatusLine::followView);
    followBackground();
    followScene();
}

void StatusLine::followScene() {
    if (!m_services.store().hasVolume()) return;
    followBackground(); // the hint comes with the first volume
    const Scene& scene = m_services.scene();
    const Volume& volume = *scene.volume;
    QString text = QStringLiteral("%1×%2×%3 %4")
                       .arg(volume.dims().x)
                       .arg(volume.dims().y)
                       .arg(volume.dims().z)
                       .arg(QString::fromLatin1(name(volume.sampleType())));
    if (scene.series->varies())
        text += tr(", %1 (%L2 of %L3)")
                    .arg(QString::fromStdString(scene.series->listing().label(scene.session.frame)))
                    .arg(scene.session.frame + 1)
                    .arg(scene.series->size());
    m_volume->setText(text);
    m_volume->setToolTip(tr("%1, values %2, spacing %3 × %4 × %5 %8, %L6 invalid voxels\naxes: %7")
                             .arg(QString::fromStdString(volume.format), rangeText(volume.dataRange()))
                             .arg(volume.geometry().spacing.x)
                             .arg(volume.geometry().spacing.y)
                             .arg(volume.geometry().spacing.z)
                             .arg(volume.invalidCount())
                             .arg(QString::fromStdString(axesText(volume.geometry())),
                                  QString::fromUtf8(lengthUnit(volume.geometry()))));
    const ViewAngles angles = viewAngles(scene.camera, volume.geometry());
    m_camera->setText(QStringLiteral("%1°, %2°  ×%3")
                          .arg(angles.azimuth, 0, 'f', 0)
                          .arg(angles.elevation, 0, 'f', 0)
                          .arg(angles.zoom, 0, 'f', 2));
    followView();
    followFigures();
}

void StatusLine::followView() {
    const PictureInfo& picture = m_view.picture();
    m_renderer->setToolTip(tr("What draws the picture, its size in pixels, and whether it gets any better.\n"
                              "Samples along a ray are %1 d0 apart or more (d0: the smallest distance of voxels).\n%2")
                               .arg(stepText(picture.stepInD0), m_view.rendererReason()));
    const QString quality = picture.complete              ? tr("complete")
                            : picture.resolutionScale < 1 ? tr("coarse")
                                                          : tr("being refined");
    m_renderer->setText(
        QStringLiteral("%1  %2×%3  %4").arg(m_view.rendererName()).arg(picture.width).arg(picture.height).arg(quality));
}

void StatusLine::followFigures() {
    const Results& results = m_services.results();
    const Results::State state = results.state();
    m_engine->setToolTip(
        tr("Whether the figures are those of the picture: how much of each feature is seen\n"
           "(visibility) and how much attention it gets (VWS).") +
        (results.engineName().isEmpty() ? QString() : tr("\nComputed by: %1").arg(results.engineName())));
    m_engine->setText(m_services.isReadOnly()              ? tr("optimizing")
                      : state == Results::State::Measuring ? tr("measuring")
                      : state == Results::State::Current   ? tr("measured")
                      : state == Results::State::Failed    ? tr("not measured")
                                                           : QString());
}

void StatusLine::watchMemory() {
    m_memory->show();
    followMemory();
    m_watch.start(kMemoryTime);
}

void StatusLine::followMemory() {
    constexpr double kGiB = 1u << 30;
    const double used = static_cast<double>(usedMemoryBytes()) / kGiB,
                 free = static_cast<double>(availableMemoryBytes()) / kGiB;
    const bool knowsFree = free < kMostMemory;
    const QString taken = QString::number(used, 'f', 1);
    m_memory->setText(knowsFree ? tr("%1 of %2 GiB").arg(taken, QString::number(used + free, 'f', 1))
                                : tr("%1 GiB").arg(taken));
    m_memory->setToolTip(tr("Memory that the program has taken, of what it may take: what is free now, or the limit\n"
                            "of Edit ▸ Preferences, in GiB. Files that are only looked into do not count."));
}

void StatusLine::followBackground() {
    const auto work = std::ranges::find_if(m_works, &BackgroundWork::isBusy);
    const bool busy = work != m_works.end();
    const QString text = busy ? (*work)->busyText() : QString();
    if (busy && (m_cancel->isHidden() || text != m_background->text())) m_progress->setRange(0, 0);
    m_background->setText(text);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_background, m_progress, m_cancel})
        widget->setVisible(busy);
    // A message takes the place of the hint, and goes for work that is under way.
    if (busy) m_bar.clearMessage();
    m_hint->setVisible(!busy && m_services.store().hasVolume() && m_bar.currentMessage().isEmpty());
}

} // namespace pellucid::gui
