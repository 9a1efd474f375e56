// The line below the picture: what is open, from where it is seen, what draws and what measures, and what is under way.
#pragma once

#include <QObject>
#include <QTimer>

class QLabel;
class QProgressBar;
class QStatusBar;
class QToolButton;

namespace pellucid::gui {

class VolumeView;
class OpenController;
class FigureController;
class FilmController;
class SaveController;
class Services;
class ShareController;
class StudyController;

class StatusLine : public QObject {
    Q_OBJECT
public:
    StatusLine(Services& services, OpenController& opening, SaveController& saving, FigureController& figures,
               FilmController& films, ShareController& sharing, StudyController& studies, VolumeView& view,
               QStatusBar& bar);

    /// Says how much memory is in use, from now on.
    void watchMemory();
    void followMemory();

private:
    void followScene();
    void followView();
    void followFigures();
    void followBackground();

    Services& m_services;
    OpenController& m_opening;
    SaveController& m_saving;
    FigureController& m_figures;
    FilmController& m_films;
    ShareController& m_sharing;
    StudyController& m_studies;
    VolumeView& m_view;
    QStatusBar& m_bar;
    QLabel *m_volume, *m_camera, *m_renderer, *m_engine, *m_background, *m_hint, *m_memory;
    QProgressBar* m_progress;
    QToolButton* m_cancel;
    QTimer m_watch;
};

} // namespace pellucid::gui
