#include "base/length_unit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"

namespace pellucid {

namespace {

/// A unit is `factor`·10^`exponent` millimetres.
struct Known {
    LengthUnit unit;
    double factor;
    int exponent;
    const char *sign, *plainSign, *name;
};

constexpr std::array kUnits{Known{LengthUnit::Unknown, 1, 0, "units", "", ""},
                            Known{LengthUnit::Femtometre, 1, -12, "fm", "fm", "femtometer"},
                            Known{LengthUnit::Picometre, 1, -9, "pm", "pm", "picometer"},
                            Known{LengthUnit::Angstrom, 1, -7, "\u00c5", "angstrom", "angstrom"},
                            Known{LengthUnit::Nanometre, 1, -6, "nm", "nm", "nanometer"},
                            Known{LengthUnit::Micrometre, 1, -3, "\u00b5m", "um", "micrometer"},
                            Known{LengthUnit::Millimetre, 1, 0, "mm", "mm", "millimeter"},
                            Known{LengthUnit::Centimetre, 1, 1, "cm", "cm", "centimeter"},
                            Known{LengthUnit::Decimetre, 1, 2, "dm", "dm", "decimeter"},
                            Known{LengthUnit::Metre, 1, 3, "m", "m", "meter"},
                            Known{LengthUnit::Kilometre, 1, 6, "km", "km", "kilometer"},
                            Known{LengthUnit::Megametre, 1, 9, "Mm", "Mm", "megameter"},
                            Known{LengthUnit::Thou, 25.4, -3, "thou", "thou", "thou"},
                            Known{LengthUnit::Inch, 25.4, 0, "in", "in", "inch"},
                            Known{LengthUnit::Foot, 304.8, 0, "ft", "ft", "foot"}};

const Known& known(LengthUnit unit) { return kUnits[static_cast<std::size_t>(unit)]; }
static_assert(kUnits.back().unit == LengthUnit::Foot &&
              kUnits.size() == static_cast<std::size_t>(LengthUnit::Foot) + 1);

} // namespace

std::string withMicroSign(const std::string& unit) {
    std::string word = trimmed(unit);
    // A Greek letter, ImageJ's escapes, and the byte of old files.
    for (const char* micro : {"\u03bc", "\\u00B5", "\\u00b5", "\xb5"})
        if (word.starts_with(micro)) word.replace(0, std::string(micro).size(), "\u00b5");
    return word;
}

std::optional<LengthUnit> lengthUnitNamed(const std::string& name) {
    std::string word = withMicroSign(name);
    if (word == "\u212b") word = "\u00c5"; // the sign of the unit, or the letter
    if (word.empty()) return {};
    const auto find = [](const auto& isMeant) -> std::optional<LengthUnit> {
        const auto it = std::ranges::find_if(kUnits.begin() + 1, kUnits.end(), isMeant);
        return it == kUnits.end() ? std::nullopt : std::optional(it->unit);
    };
    const auto signedSo = [&](const Known& k) { return word == k.sign || word == k.plainSign; };
    if (const auto unit = find(signedSo)) return unit;
    word = lowerCase(word);
    if (const auto unit = find(signedSo)) return unit;
    if (word == "feet" || word == "foot") return LengthUnit::Foot;
    if (word.size() > 2 && word.ends_with('s')) word.pop_back();
    if (word.ends_with("metre")) word.replace(word.size() - 2, 2, "er");
    if (word == "micron") return LengthUnit::Micrometre;
    if (word == "inche") return LengthUnit::Inch;
    return find([&](const Known& k) { return word == k.name; });
}

double converted(double length, LengthUnit from, LengthUnit to) {
    if (from == to || from == LengthUnit::Unknown || to == LengthUnit::Unknown) return length;
    const Known &a = known(from), &b = known(to);
    // Powers of ten are exact upward.
    const double power = std::pow(10.0, std::abs(a.exponent - b.exponent));
    const double factor = a.factor == b.factor ? 1 : a.factor / b.factor;
    return a.exponent >= b.exponent ? length * factor * power : length * factor / power;
}
const char* sign(LengthUnit unit) { return known(unit).sign; }
const char* plainSign(LengthUnit unit) { return known(unit).plainSign; }
const char* standardName(LengthUnit unit) { return known(unit).name; }

} // namespace pellucid
