#include "tf/volume_counts.h"

#include <algorithm>

namespace pellucid::gui {
namespace {

constexpr int kJointBins = 512, kGradientBins = 128;

int jointBinsOf(const Volume& volume) {
    const double step = VolumeCounts::valueStep(volume);
    return step > 0 ? static_cast<int>(std::min<double>(kJointBins, 1 + 1 / step)) : kJointBins; // no bin without value
}

} // namespace

VolumeCounts::VolumeCounts(QObject* parent)
    : QObject(parent),
      m_fineJob([](const Data& volume, const JobControl&) { return makeHistogram(*volume, kFineBins); },
                [this](const Data& volume, Histogram& counted) {
                    if (volume == m_volume) m_fine = std::move(counted);
                }),
      m_jointJob(
          [](const Data& volume, const JobControl& job) {
              return makeJointHistogram(*volume, jointBinsOf(*volume), kGradientBins, job);
          },
          [this](const Data& volume, JointHistogram& counted) {
              if (volume == m_volume) m_joint = std::move(counted);
          }) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_fineJob, &m_jointJob})
        connect(job, &JobBase::busyChanged, this, &VolumeCounts::changed);
}

void VolumeCounts::setVolume(std::shared_ptr<const Volume> volume) {
    if (volume == m_volume) return;
    m_volume = std::move(volume);
    m_fine.reset();
    m_joint.reset();
    m_fineAsked = m_jointAsked = false;
    if (m_fineJob.isRunning()) m_fineJob.cancel();
    if (m_jointJob.isRunning()) m_jointJob.cancel();
    Q_EMIT changed();
}

const Histogram* VolumeCounts::fine(bool wanted) {
    if (wanted && m_volume && !std::exchange(m_fineAsked, true)) m_fineJob.start(m_volume);
    return m_fine ? &*m_fine : nullptr;
}

const JointHistogram* VolumeCounts::joint(bool wanted) {
    if (wanted && m_volume && !std::exchange(m_jointAsked, true)) m_jointJob.start(m_volume);
    return m_joint ? &*m_joint : nullptr;
}

double VolumeCounts::valueStep(const Volume& volume) {
    const double span = volume.range().hi - volume.range().lo;
    const SampleType type = volume.sampleType();
    return type == SampleType::F32 || type == SampleType::F64 || !(span > 0) ? 0.0 : 1.0 / span;
}

} // namespace pellucid::gui
