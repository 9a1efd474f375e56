// Time: the frames of a series over their histograms, and what plays them.
#pragma once

#include <QWidget>

class QAction;
class QComboBox;
class QDoubleSpinBox;
class QHBoxLayout;
class QLabel;
class QProgressBar;
class QSlider;
class QToolButton;

namespace pellucid {
struct Scene;
}

namespace pellucid::gui {

class AdaptController;
class PlayerController;
class Services;
class TimeStrip;

/// Comes up by itself where a series is opened, and goes with it.
class PlayerPanel : public QWidget {
    Q_OBJECT
public:
    PlayerPanel(Services& services, PlayerController& player, AdaptController& adapting, QWidget* parent);

private:
    void follow(const Scene& before, const Scene& after);
    void followPlayer();
    void followSurvey();
    void followMarks();
    void followAdapting();
    QWidget* adaptRow();
    QToolButton* button(QAction& action, const char* name, const QIcon& icon, const QString& text = {});
    void showDock(bool shown);

    Services& m_services;
    PlayerController& m_player;
    AdaptController& m_adapting;
    TimeStrip* m_strip;
    QLabel *m_frame, *m_rate, *m_surveyText;
    QToolButton *m_play = nullptr, *m_stopSurvey;
    QDoubleSpinBox* m_speed;
    QProgressBar* m_survey;
    QComboBox* m_mode = nullptr;
    QSlider* m_coherence = nullptr;
    QLabel *m_coherenceText = nullptr, *m_adaptText = nullptr;
    QProgressBar* m_adapt = nullptr;
    QToolButton* m_stopAdapt = nullptr;
    bool m_shownByItself = false;
};

} // namespace pellucid::gui
