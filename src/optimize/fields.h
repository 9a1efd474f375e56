// What every voxel contributes, as values on the volume's grid (docs/method.md, "Fields"; thesis figs 4.1–4.4, 4.8).
#pragma once

#include <string>

#include "base/enum_names.h"
#include "base/job.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"

namespace pellucid {

enum class FieldKind {
    Visibility,         ///< v = T·α (4.2–4.4), [0,1]
    SaliencyBrightness, ///< L(O_b) (4.8), ≥ 0, no unit
    SaliencySaturation, ///< L(O_s), likewise
    Saliency,           ///< u1·L(O_b) + u2·L(O_s), likewise
    Vws                 ///< the voxel's share of the visibility-weighted saliency; those of a feature sum to its W_F
};

template <>
inline constexpr auto kNamesOf<FieldKind> = enumNames("field", "visibility", "saliency-brightness",
                                                      "saliency-saturation", "saliency", "vws");
/// For people: "Saliency of brightness".
const char* title(FieldKind kind);
/// Of a file with all of it: "saliency_brightness".
std::string fileStem(FieldKind kind);
/// Whether the field depends on the view and the opacities. Saliency depends on neither.
constexpr bool dependsOnView(FieldKind kind) { return kind == FieldKind::Visibility || kind == FieldKind::Vws; }

/// One of the three of saliency, over all voxels. Where an attribute is salient nowhere, the other one alone makes the
/// combined field (attributeWeights()).
/// `elsewhere`: of a volume of which `weights` are a part (Volume::elsewhere()); then it is collective.
Grid<float> saliencyGrid(const WeightFields& weights, FieldKind kind, const VwsOptions& options,
                         const JobControl& job = {}, const VoxelsElsewhere* elsewhere = nullptr);

/// In place, v becomes u1·v·L_b / Σ v·L_b + u2·v·L_s / Σ v·L_s, sums over all voxels, so that its sum over a feature
/// is the feature's W_F (4.12, 4.13), with the rule of attributeWeights(). `elsewhere`: as above; the visibility of
/// voxels that are another process's is 0.
void visibilityToVws(Grid<float>& visibility, const WeightFields& weights, const VwsOptions& options,
                     const JobControl& job = {}, const VoxelsElsewhere* elsewhere = nullptr);

/// In place: 0 at every voxel that is not in feature `feature` of `tf`; −1: nothing changes. The field has the shape of
/// what is here of the volume.
void keepFeature(Grid<float>& field, const Volume& volume, const TransferFunction& tf, int feature,
                 const JobControl& job = {});

/// The value that the colours of a field reach to unless someone says otherwise: below it lie 99.9 % of the values
/// above 0, found among a million at most that lie evenly in the grid. 1 where no value is above 0.
double usualTop(const Grid<float>& field);

/// A field as a volume, to be drawn like any other and with its own colours.
struct Field {
    std::shared_ptr<const Volume>
        volume;     ///< on the grid of the data; its window is 0 … largest value (0 … 1: all are 0)
    double top = 1; ///< usualTop() of the field over all features, so that features compare
    bool operator==(const Field&) const = default;
};
/// `top` is usualTop() before keepFeature().
Field fieldVolume(const Geometry& geometry, const Grid<float>& values, double top, std::string title);

} // namespace pellucid
