#include "base/length_unit.h"

#include <algorithm>
#include <array>

#include "base/text.h"

namespace pellucid {

namespace {

struct Known {
    LengthUnit unit;
    double millimetres;
    const char *sign, *plainSign, *name;
};

constexpr std::array kUnits{Known{LengthUnit::Unknown, 1, "units", "", ""},
                            Known{LengthUnit::Femtometre, 1e-12, "fm", "fm", "femtometer"},
                            Known{LengthUnit::Picometre, 1e-9, "pm", "pm", "picometer"},
                            Known{LengthUnit::Angstrom, 1e-7, "\u00c5", "angstrom", "angstrom"},
                            Known{LengthUnit::Nanometre, 1e-6, "nm", "nm", "nanometer"},
                            Known{LengthUnit::Micrometre, 1e-3, "\u00b5m", "um", "micrometer"},
                            Known{LengthUnit::Millimetre, 1, "mm", "mm", "millimeter"},
                            Known{LengthUnit::Centimetre, 10, "cm", "cm", "centimeter"},
                            Known{LengthUnit::Decimetre, 100, "dm", "dm", "decimeter"},
                            Known{LengthUnit::Metre, 1e3, "m", "m", "meter"},
                            Known{LengthUnit::Kilometre, 1e6, "km", "km", "kilometer"},
                            Known{LengthUnit::Megametre, 1e9, "Mm", "Mm", "megameter"},
                            Known{LengthUnit::Thou, 0.0254, "thou", "thou", "thou"},
                            Known{LengthUnit::Inch, 25.4, "in", "in", "inch"},
                            Known{LengthUnit::Foot, 304.8, "ft", "ft", "foot"}};

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

double millimetresIn(LengthUnit unit) { return known(unit).millimetres; }
const char* sign(LengthUnit unit) { return known(unit).sign; }
const char* plainSign(LengthUnit unit) { return known(unit).plainSign; }
const char* standardName(LengthUnit unit) { return known(unit).name; }

} // namespace pellucid
