// 2D feature saliency of the picture that is shown: followed when the hand rests.
#pragma once

#include <optional>

#include <QObject>
#include <QSize>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "saliency/image_saliency.h"
#include "session/scene.h"
#include "widgets/kept_renderer.h"

namespace pellucid::gui {

class Services;

/// Draws the picture and those of its features by the CPU, off the window's thread, in the size of the view, and tells
/// what each feature has of its saliency: where the session asks for it and no field is drawn. What is told belongs to
/// one picture; of another one it is out of date until the next comes.
class PictureSaliencyController : public QObject {
    Q_OBJECT
public:
    enum class State {
        Off,
        Field,     ///< off as long as a field is drawn, which has no features
        Computing, ///< also while it waits for the scene to rest
        Current,
        Failed ///< failure() tells why
    };

    explicit PictureSaliencyController(Services& services);

    void addActions();
    /// Of the view, pixels of the screen.
    void setPictureSize(const QSize& pixels);

    State state() const { return m_state; }
    bool isBusy() const { return m_state == State::Computing || m_saving.isRunning(); }
    const std::optional<Error>& failure() const { return m_failure; }
    double progress() const { return m_progress; } ///< of what is being computed, [0,1]
    /// FS of a feature of the scene, of an older picture unless current; empty: there is none.
    std::optional<double> share(std::size_t feature) const;
    const PictureInput& picture() const { return m_shown; } ///< what that is of
    /// What the session lays over the picture; empty where it lays nothing, or the figures are not current.
    std::optional<Plane> map() const;
    quint64 version() const { return m_version; } ///< another one where map() may have become another one

    void save(const QString& path); ///< of the map, or of S where none is laid over the picture; in the background
    void chooseFile();

Q_SIGNALS:
    void changed(); ///< state, figures, map or progress
    void busyChanged();
    void saved(const QString& path);

private:
    struct File {
        Plane plane;
        QString path;
    };
    void follow();
    void setState(State state);

    Services& m_services;
    State m_state = State::Off;
    QSize m_size;
    PictureInput m_wanted, m_shown;
    std::optional<FeatureSaliency> m_saliency; ///< of m_shown
    std::optional<Error> m_failure;
    double m_progress = 0;
    quint64 m_version = 0;
    std::shared_ptr<KeptRenderer> m_renderer = std::make_shared<KeptRenderer>();
    RestTimer m_rest{250, [this] { m_looking.start(m_wanted, QString::fromStdString(m_wanted.volume->title)); }};
    Job<PictureInput, FeatureSaliency> m_looking;
    Job<File, QString> m_saving;
};

} // namespace pellucid::gui
