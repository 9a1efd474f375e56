// What every voxel contributes, as values on the volume's grid (docs/method.md, "Fields"; thesis figs 4.1–4.4, 4.8).
#pragma once

#include <array>
#include <string>

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

struct FieldKindInfo {
    FieldKind kind;
    const char* name;     ///< as one types it: "saliency-brightness"
    const char* fileStem; ///< of a file with all of it: "saliency_brightness"
    const char* title;    ///< for people
};
inline constexpr std::array<FieldKindInfo, 5> kFieldKinds{
    {{FieldKind::Visibility, "visibility", "visibility", "Visibility"},
     {FieldKind::SaliencyBrightness, "saliency-brightness", "saliency_brightness", "Saliency of brightness"},
     {FieldKind::SaliencySaturation, "saliency-saturation", "saliency_saturation", "Saliency of saturation"},
     {FieldKind::Saliency, "saliency", "saliency", "Saliency"},
     {FieldKind::Vws, "vws", "vws", "Visibility-weighted saliency"}}};

constexpr const FieldKindInfo& infoOf(FieldKind kind) { return kFieldKinds[static_cast<std::size_t>(kind)]; }
inline const char* name(FieldKind kind) { return infoOf(kind).name; }
/// Throws UsageError that lists them all.
FieldKind fieldKindFromName(const std::string& name);
/// Whether it is another one from another side, or under other opacities. Saliency is neither.
constexpr bool dependsOnView(FieldKind kind) { return kind == FieldKind::Visibility || kind == FieldKind::Vws; }

/// One of the three of saliency, over all voxels. Where an attribute is salient nowhere, the other one alone makes the
/// combined field (attributeWeights()).
Grid<float> saliencyGrid(const WeightFields& weights, FieldKind kind, const VwsOptions& options,
                         const JobControl& job = {});

/// In place, v becomes u1·v·L_b / Σ v·L_b + u2·v·L_s / Σ v·L_s, sums over all voxels, so that its sum over a feature
/// is the feature's W_F (4.12, 4.13), with the rule of attributeWeights().
void visibilityToVws(Grid<float>& visibility, const WeightFields& weights, const VwsOptions& options,
                     const JobControl& job = {});

/// In place: 0 at every voxel that is not in feature `feature` of `tf`; −1: nothing changes.
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
