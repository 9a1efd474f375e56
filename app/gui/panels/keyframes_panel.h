// The panel of keyframes: a film of views, transfer functions, clipping, light and frames, put together key by key.
#pragma once

#include <memory>
#include <vector>

#include <QWidget>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/scene.h"
#include "widgets/kept_renderer.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QToolButton;

namespace pellucid::gui {

class KeyframesController;
class KeyStrip;
class Services;

class KeyframesPanel : public QWidget {
    Q_OBJECT
public:
    KeyframesPanel(Services& services, KeyframesController& keyframes, QWidget* parent = nullptr);

    /// Pictures are drawn while the panel can be seen, and then only.
    void setShown(bool shown);

private:
    struct Task {
        Scene scene;
        std::vector<double> times; ///< s, in the order in which they are drawn
        int width = 0, height = 0; ///< pixels
        int number = 0;
    };
    QLayout* buttonRow();
    QLayout* keyRow();
    void listen();
    void follow();
    void followScene(const Scene& before, const Scene& after);
    void drawSoon();
    void draw();
    static int drawAll(const Task& task, KeptRenderer& renderer, const JobControl& job,
                       const std::function<void(double time, const Image&)>& show);

    Services& m_services;
    KeyframesController& m_keyframes;
    KeyStrip* m_strip;
    QLabel* m_time;
    QComboBox *m_key, *m_easing;
    QDoubleSpinBox* m_at;
    QLineEdit* m_name;
    QToolButton* m_play = nullptr;
    RestTimer m_wait;
    bool m_shown = false, m_stale = true;
    int m_number = 0;
    std::shared_ptr<KeptRenderer> m_renderer;
    Job<Task, int> m_job; ///< last: it ends before the rest goes
};

} // namespace pellucid::gui
