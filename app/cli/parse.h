// Texts of options → values. Everything here throws UsageError with the option's name as the place.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::cli {

/// The parts of `text` between separators, empty ones too: one at least.
std::vector<std::string> split(const std::string& text, char separator);
/// A finite decimal number in [lo, hi].
double parseReal(const std::string& text, const std::string& option);
double parseReal(const std::string& text, const std::string& option, double lo, double hi);
/// The same, > lo.
double parseRealAbove(const std::string& text, const std::string& option, double lo, double hi);
/// A whole number in [lo, hi].
long long parseInteger(const std::string& text, const std::string& option, long long lo, long long hi);
/// Numbers with commas between; `what` says in the message what is expected ("LO,HI").
std::vector<double> parseReals(const std::string& text, const std::string& option);
std::vector<double> parseReals(const std::string& text, const std::string& option, std::size_t count,
                               const std::string& what);
/// "LO,HI" with LO < HI.
ValueRange parseRange(const std::string& text, const std::string& option);

/// Shares that features are wanted to have: what can be told of them before the features are known. Numbers ≥ 0, not
/// all 0.
std::vector<double> parseTargets(const std::string& text, const std::string& option);

/// The index of the feature of this name. Throws UsageError that lists all there are.
std::size_t parseFeature(const std::string& text, const std::string& option, const TransferFunction& tf);

struct ImageSize {
    int width = 512, height = 512; ///< pixels, each in [1, 16384]
};
/// "WxH".
ImageSize parseImageSize(const std::string& text, const std::string& option);
/// "#rrggbb", "#rgb" or "R,G,B" with components in [0,1].
Rgb parseColor(const std::string& text, const std::string& option);

/// Two colours for a picture's background, bottom and top.
struct Gradient {
    Rgb bottom;
    std::optional<Rgb> top; ///< empty: one colour
};
/// "COLOUR", or "TOP/BOTTOM" of two.
Gradient parseBackground(const std::string& text, const std::string& option);

struct ClipAxis {
    int axis = 0; ///< 0 x, 1 y, 2 z
    double lo = 0, hi = 1;
};
using Clip = std::variant<ClipAxis, ClipPlane>;
/// "x:a:b", 0 ≤ a < b ≤ 1, or "nx,ny,nz,d" with a normal that is not 0.
Clip parseClip(const std::string& text, const std::string& option);
/// Whether `text` means to be one: it starts with an axis and a colon, or is four numbers.
bool looksLikeClip(const std::string& text);
bool looksLikeNumber(const std::string& text);

/// What `parse()` returns; a UsageError of it gets the option as its place.
template <class Parse>
auto atOption(const std::string& option, const Parse& parse) {
    try {
        return parse();
    } catch (const UsageError& e) {
        throw UsageError(e.problem(), option, e.whatToDo(), e.remedy());
    }
}

/// Adds an option with one value, which `take(text, option name)` checks and stores. A throw inside ends the parsing.
CLI::Option* addValue(CLI::App& app, const std::string& names, const std::string& valueName,
                      const std::function<void(const std::string& text, const std::string& option)>& take,
                      const std::string& help, const std::string& group = "Options");
/// The same, may be given several times.
CLI::Option* addRepeated(CLI::App& app, const std::string& names, const std::string& valueName,
                         const std::function<void(const std::string& text, const std::string& option)>& take,
                         const std::string& help, const std::string& group = "Options");

} // namespace pellucid::cli
