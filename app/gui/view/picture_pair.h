// The picture before and after the latest refinement, beside each other.
#pragma once

#include <array>
#include <memory>

#include <QDialog>
#include <QImage>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/scene.h"
#include "widgets/kept_renderer.h"

class QLabel;

namespace pellucid::gui {

class RefineController;
class Services;

/// Both are drawn by the CPU off this thread, from the present camera and in the present light, and follow camera,
/// display and refinement while the window is open.
class PicturePair : public QDialog {
    Q_OBJECT
public:
    PicturePair(Services& services, RefineController& refining, QWidget* parent);

    bool isComplete() const { return !m_wait.isActive() && !m_job.isRunning() && !m_pictures[0].isNull(); }
    const QImage& picture(int which) const { return m_pictures.at(static_cast<std::size_t>(which)); } ///< 0 before

protected:
    void resizeEvent(QResizeEvent* event) override;

private:
    using Inputs = std::array<PictureInput, 2>;
    using Pictures = std::array<QImage, 2>;
    void start();
    void showPictures();

    Services& m_services;
    RefineController& m_refining;
    std::array<QLabel*, 2> m_labels, m_captions;
    QLabel* m_words;
    Pictures m_pictures;
    RestTimer m_wait{150, [this] { start(); }}; ///< milliseconds without a change before both are drawn anew
    std::shared_ptr<KeptRenderer> m_renderer;
    Job<Inputs, Pictures> m_job; // last: it ends before the rest goes
};

} // namespace pellucid::gui
