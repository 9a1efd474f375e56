// The panel of the parameter space: which opacities, how many samples, and what is shown of it.
#pragma once

#include <array>
#include <memory>

#include <QWidget>

#include "jobs/job.h"
#include "report/space_picture.h"
#include "session/scene.h"

class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace pellucid::gui {

class SpaceCanvas;
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

    ParameterAxes axes() const;
    Inputs inputs() const;
    std::vector<double> targets() const;
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
    std::array<QComboBox*, 3> m_features;
    QSpinBox* m_samples;
    QComboBox *m_scale, *m_factor, *m_shown;
    QPushButton *m_compute, *m_cancel, *m_least;
    QToolButton* m_save;
    QProgressBar* m_progress;
    QLabel *m_words, *m_reading;
    SpaceCanvas* m_canvas;
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
