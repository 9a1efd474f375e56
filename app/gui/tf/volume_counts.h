// Histograms of the present volume that take time: counted when they are wanted, off the window's thread.
#pragma once

#include <memory>
#include <optional>

#include <QObject>

#include "jobs/job.h"
#include "volume/histogram.h"
#include "volume/joint_histogram.h"

namespace pellucid::gui {

class VolumeCounts : public QObject {
    Q_OBJECT
public:
    explicit VolumeCounts(QObject* parent = nullptr);

    static constexpr int kFineBins = 65536;

    /// What was counted of another volume, or through another window, is forgotten.
    void setVolume(std::shared_ptr<const Volume> volume);

    /// Of kFineBins; null until it has been counted, which the first call with `wanted` starts.
    const Histogram* fine(bool wanted);
    const JointHistogram* joint(bool wanted);
    bool isBusy() const { return m_fineJob.isRunning() || m_jointJob.isRunning(); }

    /// Intensities from one value of the samples to the next; 0: they may lie anywhere.
    static double valueStep(const Volume& volume);

Q_SIGNALS:
    void changed();

private:
    using Data = std::shared_ptr<const Volume>;
    Data m_volume;
    std::optional<Histogram> m_fine;
    std::optional<JointHistogram> m_joint;
    bool m_fineAsked = false, m_jointAsked = false; // once: what failed is not tried again for this volume
    Job<Data, Histogram> m_fineJob;
    Job<Data, JointHistogram> m_jointJob;
};

} // namespace pellucid::gui
