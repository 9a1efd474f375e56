// The visibility of every voxel, and what features gather of it (docs/method.md, "Visibility"): the interface that all
// engines share.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "render/view.h"
#include "saliency/vws.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// How much each voxel contributes to the image of one view.
///   shape   the volume's own grid, x fastest
///   range   [0, 1], no unit; 0 means hidden, transparent, clipped away or invalid
///   source  docs/method.md, "Visibility": v = T·α, T the transmittance toward the eye
struct VisibilityField {
    Grid<float> values;
};

/// High: about half the error for about twice the time and more (docs/method.md, "Tolerances").
enum class Quality { Normal, High };

/// Anything that can tell visibility. One call takes many transfer functions, so that a line search is
/// parallel inside: SIMD lanes and threads on the CPU, render targets on GL. Order is kept.
/// An engine is made for one volume and is used by one thread at a time.
class VisibilityEngine {
public:
    virtual ~VisibilityEngine() = default;
    virtual std::string name() const = 0; ///< as the setting `engine` names it, or "published"
    virtual const Volume& volume() const = 0;

    /// Sums per feature of each of `tfs`, which share the features of the first (checked). `weights` may be null.
    /// Throws Cancelled where `job` was asked to stop, Error where the camera is inside the volume, and where the
    /// device fails. The same holds for the other calls.
    virtual std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs,
                                          const WeightFields* weights, const JobControl& job = {}) = 0;
    /// The sums of `tf` and their exact derivatives with respect to the features' peak opacities, in one sweep
    /// (docs/method.md, "Derivatives").
    virtual SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                                  const JobControl& job = {}) = 0;
    /// The field itself, for those who want to look at it.
    virtual VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job = {}) = 0;
};

/// docs/method.md, "The reference engine": double precision, one straight line per voxel, steps of at most
/// d0/`stepsPerD0` (≥ 1; 16 is what tolerances refer to). Slow and obvious; the oracle of the others.
std::unique_ptr<VisibilityEngine> makeReferenceEngine(std::shared_ptr<const Volume> volume, int stepsPerD0 = 16);

/// Threads and SIMD, no GL. Same bits for any thread count.
std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume,
                                                Quality quality = Quality::Normal);

} // namespace pellucid
