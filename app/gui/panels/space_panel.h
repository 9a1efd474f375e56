// The panel of the parameter space: which opacities, how many samples, and what is shown of it.
#pragma once

#include <array>
#include <memory>

#include <QPushButton>
#include <QSpinBox>

#include "jobs/job.h"
#include "panels/space_canvas.h"
#include "session/scene.h"
#include "widgets/controls.h"

namespace pellucid::gui {

class Services;

/// Computes VWS and F on a grid of opacities where asked to, off this thread, and shows them with the session's
/// optimizations as paths. What was computed stays true while the opacities of its axes and the targets change; when
/// anything else does it is pale, and says so, until it is computed anew.
class SpacePanel : public QWidget {
    Q_OBJECT
public:
    explicit SpacePanel(Services& services, QWidget* parent = nullptr);

    /// Null before anything was computed of this volume.
    const std::shared_ptr<const ParameterSpace>& space() const { return m_space; }
    bool isComputing() const { return m_job.isRunning(); }
    /// There is one and it is of the present state and of what the controls say.
    bool isCurrent() const;
    bool isPictureComplete() const;

    /// A picture, or a table where `path` ends in .csv; in the background.
    void saveTo(const QString& path);
    void compute();
    void cancel() { m_job.cancel(); }

protected:
    void showEvent(QShowEvent* event) override;

private:
    /// Everything that the samples depend on.
    struct Inputs {
        MeasureInput measured;      ///< opacities and what things are called apart
        std::vector<double> others; ///< opacities of the features without an axis
        ParameterAxes axes;
        int factor = 0; ///< as the control says, 0: automatic
        bool operator==(const Inputs&) const = default;
    };
    struct Task {
        MeasureInput measured;
        std::vector<double> targets;
        ParameterAxes axes;
        int factor = 1;
        Inputs inputs;
        std::vector<Feature> features;
    };
    struct Saving {
        std::shared_ptr<const ParameterSpace> space;
        SpaceView view;
        std::string path;
    };

    static ParameterSpace sampled(const Task& task, const JobControl& job);
    static bool written(const Saving& task, const JobControl& job);
    void takeSpace(const Task& task, ParameterSpace& space);
    ParameterAxes axes() const;
    Inputs inputs() const;
    void follow(const Scene& before, const Scene& after);
    void fillFeatures();
    void chooseAxes(std::size_t changed);
    void keepChosen();
    SpaceView view() const;
    QString words(bool hasTwo, bool running, bool current) const;
    void refresh();
    void apply(const std::vector<double>& opacities, const QString& text);
    void save();

    Services& m_services;
    std::array<QComboBox*, 3> m_features{new QComboBox(this), new QComboBox(this), new QComboBox(this)};
    QSpinBox* m_samples = named(new QSpinBox(this), "spaceSamples",
                                tr("Samples along each axis, its ends included; 11 are steps of 0.1"));
    QComboBox* m_scale =
        named(new QComboBox(this), "spaceScale",
              tr("Opacities along an axis: from 0 to 1 in equal steps, or from 0.001 to 1 in equal factors"));
    QComboBox* m_factor = named(new QComboBox(this), "spaceFactor",
                                tr("What is sampled: the volume, or a copy that is coarser along each axis.\n"
                                   "Automatic: coarser where the whole would take long"));
    QComboBox* m_shown =
        named(new QComboBox(this), "spaceShown",
              tr("The distance from the targets (F; 0 is on target), or the attention on a feature (VWS, 0 to 1)"));
    QPushButton* m_compute = named(new QPushButton(tr("&Compute"), this), "spaceCompute",
                                   tr("Samples attention (VWS) and distance from the targets (F), from this camera"));
    QPushButton* m_cancel =
        named(new QPushButton(tr("Cancel"), this), "spaceCancel", tr("Stop measuring; what has been measured stays"));
    QPushButton* m_least = named(new QPushButton(tr("&Go to the nearest"), this), "spaceLeast",
                                 tr("Sets the opacities of the sample that is nearest to the targets (least F)"));
    QToolButton* m_save =
        named(toolButton(tr("Save…"), this), "spaceSave", tr("Saves the picture, or all samples as a table (.csv)"));
    QProgressBar* m_progress = progressBar("spaceProgress", this, 1000);
    QLabel* m_words = wrappedLabel("spaceWords", this);
    QLabel* m_reading = wrappedLabel("spaceReading", this);
    SpaceCanvas* m_canvas = new SpaceCanvas(this);
    std::shared_ptr<const ParameterSpace> m_space;
    std::vector<double> m_targets;           ///< shares that its F is of
    Inputs m_inputs;                         ///< of m_space
    std::vector<Feature> m_computedFeatures; ///< likewise
    int m_usedFactor = 1;
    std::array<int, 3> m_chosen{-1, -1, -1}; ///< features of the axes, before the latest choice
    Job<Task, ParameterSpace> m_job;         // last: they end before the rest goes
    Job<Saving, bool> m_saving;
};

} // namespace pellucid::gui
