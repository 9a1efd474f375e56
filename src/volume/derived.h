// Variables that are made of others: gradient magnitude, volatility, difference to a frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/enum_names.h"
#include "volume/time_series.h"

namespace pellucid {

/// What is made of a variable (docs/method.md, "Derived variables").
struct Derivation {
    enum class Kind {
        Gradient,   ///< |∇X|, of X normalised to [0,1] over the series, per d0
        Volatility, ///< population standard deviation of normalised X over the latest `frames` frames
        Difference  ///< X − X of frame `reference`, data units
    };
    Kind kind = Kind::Gradient;
    std::string of = "x"; ///< name of the variable
    int frames = 10;      ///< of Volatility, ≥ 1; at the start as many as there are
    int reference = 0;    ///< of Difference
    bool operator==(const Derivation&) const = default;

    /// "gradient:x", "volatility:x:10", "difference:x:0": how it is named wherever a variable can stand.
    std::string text() const;
};
/// Empty where `text` is the name of a plain variable. Throws UsageError where it begins like a derivation and is none.
std::optional<Derivation> parseDerivation(const std::string& text);

/// Which definition of volatility.
enum class VolatilityKind {
    Population, ///< of X normalised over the series, as it is (docs/method.md, "Derived variables")
    Published   ///< sample deviation of X normalised per frame, stretched to [0,1] (docs/method.md, "The published
                ///< profile")
};
template <>
inline constexpr auto kNamesOf<VolatilityKind> = enumNames("volatility", "population", "published");

/// The derived variable, frame by frame on the grid of `base`, as float. `base` is normalised by its range() over all
/// frames. A voxel that is invalid in any frame it is made of is invalid. Volatility keeps running sums, so that the
/// next frame costs one frame, in either direction; a frame that cannot be read is left out of it.
/// Throws UsageError for a reference frame that is not there.
std::shared_ptr<TimeSeries> derive(std::shared_ptr<TimeSeries> base, const Derivation& derivation,
                                   const JobControl& job = {}, VolatilityKind volatility = VolatilityKind::Population);

/// Trilinear samples of `volume` at the voxels of `grid`, in the world (where both say in which units, these are
/// converted); invalid beyond its box. Float.
Volume resampledTo(const Volume& volume, const Geometry& grid, const JobControl& job = {});
/// Whether that would change nothing but the type, lengths being in one unit.
bool onSameGrid(const Geometry& a, const Geometry& b);

} // namespace pellucid
