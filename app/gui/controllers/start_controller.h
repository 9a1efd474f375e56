// The automatic start: what the data propose, the opacities that follow, and what is said about both.
#pragma once

#include <QObject>

#include "jobs/job.h"
#include "session/scene.h"

namespace pellucid::gui {

class OpenController;
class Services;

/// After a volume has been opened with a proposed transfer function, its opacities are tuned while the first picture is
/// drawn. They come as one step, "Automatic opacities", unless the transfer function has been edited meanwhile.
class StartController : public QObject {
    Q_OBJECT
public:
    StartController(Services& services, OpenController& opening);

    void addActions();
    /// Once more, from the present data and view: one step.
    void startAgain();

    bool isBusy() const { return m_tuning.isRunning() || m_again.isRunning(); }
    void cancel();

Q_SIGNALS:
    void busyChanged();

private:
    struct Request {
        Scene scene;
        View view; ///< of startAgain()
    };
    /// A scene has just been opened: says what was recognised where it has a proposal, and tunes its opacities.
    void follow();
    void say(const Proposal& proposal);
    void showTuned(const Scene& scene, const FirstSight& start);

    Services& m_services;
    OpenController& m_opening;
    QString m_said; ///< of what was recognised, as long as it stands
    Job<Scene, FirstSight> m_tuning;
    Job<Request, AutomaticStart> m_again;
};

/// What was recognised in the data, a sentence; empty where there is nothing to say.
QString recognisedText(const Proposal& proposal);
/// That values lie beyond the window of a proposal; empty where none do. `data`: smallest and largest value.
QString beyondText(const Proposal& proposal, const ValueRange& data);

} // namespace pellucid::gui
