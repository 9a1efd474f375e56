#include "optimize/measure.h"

#include <chrono>

namespace pellucid {

Measures measure(VisibilityEngine& engine, const Camera& camera, const TransferFunction& tf,
                 const WeightFields& weights, const VwsOptions& options, const JobControl& job) {
    const auto start = std::chrono::steady_clock::now();
    Measures measures;
    const VisibilityField field = engine.field(camera, tf, job);
    const JobControl after{job.stop, {}}; // the job is at its end, and done
    measures.features =
        featureMeasures(sumsOfField(engine.volume(), tf.features, field.values, &weights, after), options);
    measures.visibilityHistogram = visibilityHistogram(engine.volume(), field.values, 256, after);
    measures.opacities = featureOpacities(tf);
    measures.visibilitySeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return measures;
}

} // namespace pellucid
