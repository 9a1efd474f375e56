// Entropy refinement: on a button, live, for an intensity of the palette, for a region of the picture.
#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <QObject>
#include <QSize>

#include "jobs/job.h"
#include "optimize/refine/refine_outcome.h"
#include "session/scene.h"
#include "widgets/kept_renderer.h"

class QAction;

namespace pellucid::gui {

class OptimizeController;
class Services;

/// One refinement, with all that is told of it.
struct Refinement {
    std::shared_ptr<const Volume> volume;
    TransferFunction before, after; ///< written for the volume's window
    TransferFunction start; ///< `before`; of a live one with what the edit holds fixed, and the others given way
    RefineOptions options;  ///< with what was prioritized
    RefineResult result;
    QString words;     ///< "air −40 %, enamel × 3"
    QString shortfall; ///< why what was prioritized did not gain on all others, and what helps; empty where it did
    std::optional<Darkening> dark; ///< looked for after the edit is done
};

struct RefineActions {
    QAction *refine, *live, *rectangle, *lasso, *nothing, *ghost, *pair;
};

/// Settings and priority are those of Session::refine. Every refinement is one undo step; a live one is part of the
/// step that it follows.
///
/// One priority after the other (clicks, drags) starts from the transfer function before the first of them, as long as
/// nothing else changes it: what comes of a choice does not depend on the choices before.
class RefineController : public QObject {
    Q_OBJECT
public:
    RefineController(Services& services, OptimizeController& optimizing);
    ~RefineController() override;

    void addActions();
    const RefineActions& actions() const { return m_actions; }

    void refine(); ///< with the present settings and priority
    /// In place of current(), whose picture is dark: what Darkening::help says, from the same start.
    void takeHelp();

    /// Prioritizes intensity x, [0,1], and refines for it. Steps with the same `mergeKey` in a row become one.
    void prioritize(double x, const QString& mergeKey = {});
    /// The same while the mouse is down: previews, until one of the last two.
    void dragPriority(double x);
    void endDrag();
    void cancelDrag();
    /// Looks, off this thread, what colours the region has in the present picture, then prioritizes them and refines.
    /// Where nothing is seen in it, says so and changes nothing. `text` names the step.
    void prioritize(const ImageRegion& region, const QString& text);
    void prioritizeNothing(); ///< opacities stay
    /// The region that is being looked at, else the session's.
    std::optional<ImageRegion> region() const;
    bool isBusy() const { return m_look.isRunning(); }

    enum class Selecting { Nothing, Rectangle, Lasso };
    /// What a drag in the picture is going to draw.
    Selecting selecting() const { return m_selecting; }
    void setSelecting(Selecting what);
    void setViewSize(const QSize& pixels) { m_viewSize = pixels; } ///< of the picture that regions refer to

    /// The one that the present transfer function came of; null: none did.
    const Refinement* current() const;
    /// That, else the latest of this volume; null: there was none.
    const Refinement* latest() const;
    /// What counts at present; the colours of a region are known once somebody has looked.
    RefineOptions options() const;

    bool isGhostShown() const { return m_ghost; }
    void setGhostShown(bool shown);

Q_SIGNALS:
    void refined();     ///< current() and latest() have changed
    void busyChanged(); ///< isBusy() or region() may have changed
    void selectingChanged();
    void ghostChanged();
    void pairWanted(); ///< both pictures, side by side

private:
    struct Look {
        PictureInput picture;
        ImageRegion region;
        QString text;
    };
    /// A refinement, and all that tells whether its picture is dark.
    struct Examined {
        Scene scene;
        Refinement refinement;
    };

    /// What a hue was last found to be.
    struct FoundHue {
        std::optional<double> hue;
        TransferFunction tf;
        std::weak_ptr<const Volume> volume;
        std::weak_ptr<const VoxelColors> colors;
        RefinePriority priority;
    };

    QString follow(const Scene& before, const Scene& after, Session& session);
    TransferFunction startOfPriority() const;
    const std::vector<RegionColor>* colorsOf(const ImageRegion& region) const;
    /// Empty: the colours of the region are not known yet.
    std::optional<RefinePriority> priorityOf(const Scene& scene) const;
    /// Refines `start`, which is `before` but for what an edit holds fixed and makes give way.
    Refinement refineFrom(const TransferFunction& before, const TransferFunction& start, const Scene& scene,
                          RefineOptions options) const;
    void keep(Refinement refinement);
    /// One step of the history, in which `change` (may be empty) changes the settings too.
    void apply(const Refinement& refinement, const QString& text, const std::function<void(RefineSettings&)>& change);
    static void put(const Refinement& refinement, const std::function<void(RefineSettings&)>& change, Session& session);
    void look(const ImageRegion& region, const QString& text);
    void refineForRegion(const Look& look);
    void sayRefined(const Refinement& refinement);
    void say(const QString& text);
    void examine(); ///< whether the picture of current() is dark

    Services& m_services;
    OptimizeController& m_optimizing;
    RefineActions m_actions;
    std::deque<Refinement> m_kept;  ///< the latest last
    bool m_latestIsPreview = false; ///< the next one of the same preview takes its place
    bool m_quiet = false;           ///< what happens is refinement: nothing follows of it
    std::optional<TransferFunction> m_dragStart;
    std::deque<std::pair<ImageRegion, std::vector<RegionColor>>> m_colors; ///< the latest last
    mutable FoundHue m_hue;
    std::optional<ImageRegion> m_pending;
    Selecting m_selecting = Selecting::Nothing;
    QSize m_viewSize{4, 3};
    bool m_ghost = true;
    std::shared_ptr<KeptRenderer> m_renderer;
    std::optional<TransferFunction> m_examined; ///< what examine() has looked at last
    Job<Look, std::vector<RegionColor>> m_look; // last: they end before the rest goes
    Job<Examined, std::optional<Darkening>> m_examine;
};

/// How much smaller the variance of the edge weights (3.4) has become, in words.
QString evennessText(double energyBefore, double energyAfter);

} // namespace pellucid::gui
