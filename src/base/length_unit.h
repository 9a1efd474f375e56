// Units of length, as files name them and as they are shown.
#pragma once

#include <optional>
#include <string>

namespace pellucid {

enum class LengthUnit {
    Unknown, ///< lengths are numbers, of what is not said
    Femtometre,
    Picometre,
    Angstrom,
    Nanometre,
    Micrometre,
    Millimetre,
    Centimetre,
    Decimetre,
    Metre,
    Kilometre,
    Megametre,
    Thou,
    Inch,
    Foot
};

/// Without blanks around it and with one sign of micro, U+00B5, where files have another or escape it.
std::string withMicroSign(const std::string& unit);

/// The unit that a file calls so, by its sign or by its name in English: "µm", "um", "microns", "Micrometre", "inches".
/// Letters may be large or small where no sign is meant otherwise ("mm" and "Mm"). Empty: no unit of length is called
/// so.
std::optional<LengthUnit> lengthUnitNamed(const std::string& name);

/// A length in another unit, exact but for rounding; as it is where either is Unknown.
double converted(double length, LengthUnit from, LengthUnit to);

/// "µm", in UTF-8; "units" for Unknown.
const char* sign(LengthUnit unit);
/// The same in ASCII, "um"; empty for Unknown.
const char* plainSign(LengthUnit unit);
/// The American name, as standards have it: "micrometer". Empty for Unknown.
const char* standardName(LengthUnit unit);

} // namespace pellucid
