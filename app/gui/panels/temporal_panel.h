// What the frames of a series show: VWS and FV of the features, distance and flicker over time, under the transfer
// functions that follow the frames and under the static one.
#pragma once

#include <array>
#include <map>

#include <QCheckBox>

#include "jobs/job.h"
#include "report/temporal_curves.h"
#include "widgets/controls.h"
#include "widgets/elided.h"

namespace pellucid::gui {

class AdaptController;
class PlayerController;
class PlotView;
class Services;

/// Measures where asked to, frame by frame on a thread of its own, and draws what is known so far. What was measured
/// stays true until camera, settings or the frame's transfer function are others; then it is measured anew when asked.
class TemporalPanel : public QWidget {
    Q_OBJECT
public:
    TemporalPanel(Services& services, PlayerController& player, AdaptController& adapting, QWidget* parent);

    void measure(); ///< all frames that are not known as they are now
    void cancel();
    bool isMeasuring() const { return m_job.isRunning(); }
    /// Of all frames that are known as they are now.
    TemporalCurves curves() const;
    int knownCount() const;  ///< frames that curves() has
    bool isOverGaps() const; ///< flicker is told after missing or broken frames, too

    /// Writes what is known, by the suffix: .csv, .png or .svg. Errors are shown.
    void exportTo(const QString& path);

protected:
    void showEvent(QShowEvent* event) override;

private:
    /// The figures of a frame, and what they are of.
    struct Known {
        MeasureSettings measure;
        Camera camera;
        Clipping clipping;
        HsbMapping hsb;
        Part<std::vector<Variable>> variables;
        GroundView ground;
        DisplaySettings display;
        ValueRange window;
        bool pictured = false; ///< 2D feature saliency is known, too
        std::vector<double> targets;
        std::shared_ptr<const TransferFunction> tf, before; ///< of the frame, and of neighbourBefore(); null: none
        std::shared_ptr<const TransferFunction> fixedTf, fixedBefore; ///< likewise, by the keys alone
        FrameFigures dynamic, fixed;
    };
    struct Task {
        Scene basis;
        int frame = 0;
        Known known;
    };
    Task taskOf(int frame) const;
    Known figuresFor(const Task& task, const JobControl& job);
    static bool isCurrent(const Known& known, const Known& wanted);
    bool isKnown(int frame) const;
    void next();
    void follow(const Scene& before, const Scene& after);
    void refresh();
    QLayout* makePlots();
    QString words(int known) const;
    std::vector<Plot> plots() const;
    void chooseFile();

    Services& m_services;
    PlayerController& m_player;
    AdaptController& m_adapting;
    std::array<PlotView*, 4> m_plots{};
    QComboBox* m_shown =
        named(new QComboBox(this), "temporalShown",
              tr("What the first two plots show of each feature: share of saliency (VWS), visibility (FV),\n"
                 "the opacity of its peak, of a path of one reference length d0, or 2D feature saliency (2DFS),\n"
                 "its share of what catches the eye in a picture of 512 × 512 pixels, which is measured when chosen"));
    QCheckBox* m_overGaps = named(new QCheckBox(tr("Flicker over gaps"), this), "temporalOverGaps",
                                  tr("After missing or broken frames, compare with the frame before the gap;\n"
                                     "otherwise no flicker is reported there"));
    QLabel* m_words =
        withAnyWidth(named(new ElidedLabel(this), "temporalWords",
                           tr("Over the frames that are known: root mean square of F, the largest F and its\n"
                              "frame, how many frames are not on target, and mean flicker")));
    QLabel* m_readOut = withAnyWidth(named(new QLabel(this), "temporalReadOut"));
    QToolButton* m_measure = named(new QToolButton(this), "temporalMeasure");
    QToolButton* m_export = named(toolButton(tr("Export…"), this), "temporalExport",
                                  tr("The curves as a table (CSV), the plots as a picture (PNG) or drawing (SVG)"));
    QProgressBar* m_progress = progressBar("temporalProgress", this);
    std::map<int, Known> m_known;
    bool m_asked = false;  ///< frames that are not known are measured
    Workspace m_workspace; // used in m_job alone
    Lane m_lane;
    Job<Task, Known> m_job; // last: it ends before the rest goes
};

} // namespace pellucid::gui
