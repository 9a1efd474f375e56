// The line below the picture: what is open, from where it is seen, what draws and what measures, and what is under way.
#pragma once

#include <vector>

#include <QObject>
#include <QTimer>

class QLabel;
class QProgressBar;
class QStatusBar;
class QToolButton;

namespace pellucid::gui {

class BackgroundWork;
class Services;
class VolumeView;

class StatusLine : public QObject {
    Q_OBJECT
public:
    /// `works`: of several that are busy the first one is named. All outlive this.
    StatusLine(Services& services, std::vector<BackgroundWork*> works, VolumeView& view, QStatusBar& bar);

    /// Says how much memory is in use, from now on.
    void watchMemory();
    void followMemory();

private:
    void followScene();
    void followView();
    void followFigures();
    void followBackground();

    Services& m_services;
    const std::vector<BackgroundWork*> m_works;
    VolumeView& m_view;
    QStatusBar& m_bar;
    QLabel *m_volume, *m_camera, *m_renderer, *m_engine, *m_background, *m_hint, *m_memory;
    QProgressBar* m_progress;
    QToolButton* m_cancel;
    QTimer m_watch;
};

} // namespace pellucid::gui
