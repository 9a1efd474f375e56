// The best view: what is looked for, the map that is found, and going there.
#pragma once

#include <optional>

#include <QDateTime>
#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/view_workspace.h"
#include "tf/transfer_function.h"

namespace pellucid::gui {

class OptimizeController;
class Services;

/// Judges views from all over the sphere, off the window's thread, and keeps the map until something that it depends on
/// changes. While the panel is open, an outdated map is made anew as soon as the user rests. Turning the view does not
/// change the map; moving nearer does. The camera never moves by itself.
class ViewSearchController : public QObject {
    Q_OBJECT
public:
    ViewSearchController(Services& services, OptimizeController& optimizing);
    ~ViewSearchController() override;

    void addActions();

    /// What is judged: 0 the distance from the targets, else the VWS of a feature. A feature that is gone counts as 0.
    FeatureId feature() const;
    void setFeature(FeatureId feature);

    const ViewMap& map() const { return m_map; } ///< may still be growing; empty before the first
    bool isCurrent() const;                      ///< the map is whole and of the present state
    /// The best view of the full volume, of the same state as the map; empty before it is known.
    const std::optional<BestView>& best() const { return m_best; }
    bool isRunning() const { return m_search.isRunning() || m_judging.isRunning(); }
    bool isBusy() const { return isRunning() || isOptimizing() || m_wait.isActive(); } ///< or about to be
    double progress() const { return m_progress; }                                     ///< of the search, [0,1]

    void setWanted(bool wanted);
    void start(); ///< now, whether it is wanted or not
    void cancel();
    /// The camera of a view toward which the eye lies in this direction of the center.
    Camera cameraFor(const Vec3& towardEye) const;
    void goTo(const Camera& camera); ///< one step of the camera's history
    void goToBest();

    /// View and opacities together: an undo step for the opacities, one of the camera's history for the view. It ends
    /// without a trace where it is cancelled, or where something changes that it began with.
    void optimize();
    bool isOptimizing() const { return m_joint.isRunning(); }
    void cancelOptimizing() { m_joint.cancel(); }

    /// A look from elsewhere, which ends as it came; the camera stays.
    void setGlimpse(const std::optional<Camera>& camera) { Q_EMIT glimpsed(camera); }

Q_SIGNALS:
    void changed(); ///< the map, the best view, whether they are current, or what is under way
    void glimpsed(const std::optional<pellucid::Camera>& camera);

private:
    /// What a map depends on. `input` looks from one and the same side, whatever the camera does.
    struct Question {
        MeasureInput input;
        ViewMetric metric;
        bool operator==(const Question& other) const;
    };
    struct Task {
        Question question;
        int number = 0;
    };
    struct JointTask {
        Question question;
        MeasureInput input;  ///< from the present view
        TransferFunction tf; ///< with what is hidden of it
        std::vector<OpacityLimits> limits;
        OptimizeOptions options;
        RunStart start; ///< for the record
        QDateTime started;
    };
    struct Judgement {
        MeasureInput input;
        ViewSearch search;
    };

    /// What is asked of the present scene; `feature` 0: about the targets. Empty where there is nothing to be asked.
    std::optional<Question> questionOf(FeatureId feature) const;
    void follow();
    void startAtRest();
    void ask(const std::optional<Question>& question); ///< the map is to answer it, and is empty so far
    void cancelSearch();
    void finish(const JointTask& task, const ViewAndOpacities& found);
    void grow(int number, const ViewMap& map);

    Services& m_services;
    OptimizeController& m_optimizing;
    FeatureId m_feature = 0;
    bool m_wanted = false;
    bool m_stopped = false;                     ///< by the user: it is not begun again before something changes
    std::optional<Question> m_present, m_asked; ///< of now, and that of `m_map`
    ViewMap m_map;
    bool m_whole = false;
    std::optional<BestView> m_best;
    double m_progress = 0;
    int m_number = 0; ///< of the latest search
    /// Milliseconds that everything must rest before a map is made by itself.
    RestTimer m_wait{500, [this] { startAtRest(); }};
    ViewWorkspace m_views;
    Lane m_lane;
    std::optional<Question> m_jointQuestion; ///< of the optimization under way
    Job<Judgement, BestView> m_judging;
    Job<JointTask, ViewAndOpacities> m_joint;
    Job<Task, ViewSearch> m_search;
};

} // namespace pellucid::gui
