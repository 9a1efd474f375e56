#include "foreign/arrays/array_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

namespace {

/// Coordinates of more places are passed over.
constexpr std::int64_t kMostCoordinates = 1'000'000;

enum class AxisKind { Unknown, X, Y, Z, Time, Components };

/// An axis of the file, and what is known of it.
struct Axis {
    std::int64_t size = 1;
    std::string name;
    AxisKind kind = AxisKind::Unknown;
    const ArrayVariable* coordinates = nullptr;
    std::string unit;        ///< of the coordinates
    bool isDownward = false; ///< coordinates grow downwards, as depth does
    double step = 0;         ///< from place to place, in `unit`; 0: not known
    double first = 0;        ///< where the first place is
};

bool isOneOf(const std::string& text, std::initializer_list<const char*> words) {
    return std::ranges::any_of(words, [&](const char* word) { return text == word; });
}

bool isPressure(const std::string& unit) {
    return isOneOf(unit, {"Pa", "hPa", "kPa", "bar", "mbar", "millibar", "millibars", "decibar", "dbar"});
}

/// The kind that a name tells, where nothing better does.
AxisKind kindOfName(const std::string& name) {
    if (isOneOf(name, {"time", "t", "times"})) return AxisKind::Time;
    if (isOneOf(name, {"x", "lon", "longitude", "easting", "xc", "rlon"})) return AxisKind::X;
    if (isOneOf(name, {"y", "lat", "latitude", "northing", "yc", "rlat"})) return AxisKind::Y;
    if (isOneOf(name, {"z", "lev", "level", "depth", "height", "altitude", "alt", "plev", "pressure", "zc"}))
        return AxisKind::Z;
    return AxisKind::Unknown;
}

/// CF Conventions 1.10, chapter 4.
AxisKind kindOfCoordinates(const ArrayFile& file, const ArrayVariable& coordinates, const std::string& unit) {
    const std::string axis = file.text(coordinates, "axis"), meaning = file.text(coordinates, "standard_name");
    if (axis == "X") return AxisKind::X;
    if (axis == "Y") return AxisKind::Y;
    if (axis == "Z") return AxisKind::Z;
    if (axis == "T" || meaning == "time" || unit.find(" since ") != std::string::npos) return AxisKind::Time;
    if (isOneOf(unit, {"degrees_east", "degree_east", "degree_E", "degrees_E", "degreeE", "degreesE"}) ||
        isOneOf(meaning, {"longitude", "grid_longitude", "projection_x_coordinate"}))
        return AxisKind::X;
    if (isOneOf(unit, {"degrees_north", "degree_north", "degree_N", "degrees_N", "degreeN", "degreesN"}) ||
        isOneOf(meaning, {"latitude", "grid_latitude", "projection_y_coordinate"}))
        return AxisKind::Y;
    if (!file.text(coordinates, "positive").empty() || isPressure(unit) ||
        isOneOf(meaning, {"height", "altitude", "depth", "air_pressure", "model_level_number"}))
        return AxisKind::Z;
    return AxisKind::Unknown;
}

/// `axistags` of vigra and ilastik: JSON with a key for each axis.
void readAxisTags(const std::string& text, std::vector<Axis>& axes) {
    const nlohmann::json tags = nlohmann::json::parse(text, nullptr, false);
    if (!tags.is_object() || !tags.contains("axes") || !tags["axes"].is_array() || tags["axes"].size() != axes.size())
        return;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const nlohmann::json& tag = tags["axes"][a];
        if (!tag.is_object() || !tag.contains("key") || !tag["key"].is_string()) continue;
        const auto key = tag["key"].get<std::string>();
        axes[a].name = key;
        axes[a].kind = key == "c" ? AxisKind::Components : kindOfName(key);
        const bool hasStep = tag.contains("resolution") && tag["resolution"].is_number();
        if (const double step = hasStep ? tag["resolution"].get<double>() : 0; std::isfinite(step) && step > 0)
            axes[a].step = step;
    }
}

/// Colours as the HDF5 Image Specification has them.
void readImageClass(const ArrayFile& file, const ArrayVariable& variable, std::vector<Axis>& axes) {
    if (axes.size() < 3 || file.text(variable, "IMAGE_SUBCLASS") != "IMAGE_TRUECOLOR") return;
    const bool byPlane = file.text(variable, "INTERLACE_MODE") == "INTERLACE_PLANE";
    (byPlane ? axes[axes.size() - 3] : axes.back()).kind = AxisKind::Components;
}

/// Distances that programs write beside an array, as many as it has axes or as there are in space, slowest first.
void readSpacing(const ArrayFile& file, const ArrayVariable& variable, std::vector<Axis>& axes,
                 const std::vector<std::size_t>& places) {
    for (const char* name : {"element_size_um", "spacing", "voxel_size", "resolution"}) {
        const auto found = file.attribute(variable, name);
        if (!found) continue;
        const std::vector<double>& numbers = found->numbers;
        const bool areAll = numbers.size() == axes.size(), areOfPlaces = numbers.size() == places.size();
        if (numbers.size() != 1 && !areAll && !areOfPlaces) continue;
        if (!std::ranges::all_of(numbers, [](double d) { return std::isfinite(d) && d > 0; })) continue;
        for (std::size_t n = 0; n < places.size(); ++n) {
            axes[places[n]].step = numbers.size() == 1 ? numbers[0] : areOfPlaces ? numbers[n] : numbers[places[n]];
            if (std::string_view(name).ends_with("_um")) axes[places[n]].unit = "um";
        }
        return;
    }
}

std::vector<Axis> axesIn(const ArrayFile& file, const ArrayVariable& variable) {
    const std::vector<ArrayDimension> dimensions = file.dimensions(variable);
    std::vector<Axis> axes(variable.dims.size());
    for (std::size_t a = 0; a < axes.size(); ++a) {
        Axis& axis = axes[a];
        axis.size = variable.dims[a];
        axis.name = dimensions[a].name;
        axis.kind = kindOfName(lowerCase(axis.name));
        if (dimensions[a].coordinates.empty()) continue;
        const ArrayVariable* const coordinates = file.find(dimensions[a].coordinates);
        if (coordinates == nullptr || !coordinates->type || coordinates->dims != std::vector{axis.size}) continue;
        axis.coordinates = coordinates;
        axis.unit = trimmed(file.text(*coordinates, "units"));
        const AxisKind kind = kindOfCoordinates(file, *coordinates, axis.unit);
        if (kind != AxisKind::Unknown) axis.kind = kind;
        const std::string positive = lowerCase(file.text(*coordinates, "positive"));
        const bool isDepth = isPressure(axis.unit) || file.text(*coordinates, "standard_name") == "depth";
        axis.isDownward = positive == "down" || (positive.empty() && isDepth);
    }
    readAxisTags(file.text(variable, "axistags"), axes);
    readImageClass(file, variable, axes);
    for (std::size_t a = 0; a < axes.size(); ++a) // one of each
        for (std::size_t b = 0; b < a; ++b)
            if (axes[a].kind == axes[b].kind && axes[a].kind != AxisKind::Time) axes[a].kind = AxisKind::Unknown;
    return axes;
}

std::string nameOf(const Axis& axis, std::size_t number) {
    return axis.name.empty() ? "axis " + std::to_string(number) : inQuotes(axis.name);
}

/// Which axes are places; the others are time steps, or have one entry.
void chooseAxes(const std::vector<Axis>& axes, ArrayAxes& chosen) {
    std::vector<std::size_t> times;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (axes[a].kind == AxisKind::Components)
            chosen.components = a;
        else
            (axes[a].kind == AxisKind::Time ? times : chosen.places).push_back(a);
    }
    std::vector<std::size_t>& places = chosen.places;
    const auto wide = std::ranges::count_if(places, [&](std::size_t a) { return axes[a].size > 1; });
    const auto longest = std::ranges::max_element(times, {}, [&](std::size_t a) { return axes[a].size; });
    if (wide < 3 && longest != times.end() && axes[*longest].size > 1) {
        chosen.notices.push_back(nameOf(axes[*longest], *longest) +
                                 " is shown as an axis in space: only two others have several places");
        places.insert(std::ranges::upper_bound(places, *longest), *longest);
        times.erase(longest);
    }
    const auto takeOut = [&](auto isMeant) {
        const auto found = std::ranges::find_if(places, isMeant);
        if (places.size() <= 3 || found == places.end()) return false;
        if (axes[*found].size > 1) times.push_back(*found);
        places.erase(found);
        return true;
    };
    while (takeOut([&](std::size_t a) { return axes[a].size == 1; })) {
    }
    while (takeOut([&](std::size_t a) { return axes[a].kind == AxisKind::Unknown; })) {
    }
    while (takeOut([](std::size_t) { return true; })) {
    }
    if (times.size() > 1) std::erase_if(times, [&](std::size_t a) { return axes[a].size == 1; });
    std::ranges::sort(times);
    chosen.steps = times;
    if (times.size() < 2) return;
    const auto name = [&](std::size_t a) { return nameOf(axes[a], a); };
    chosen.notices.push_back("time steps are those along " + joined(times, " and ", name) + ", one after the other");
}

/// The numbers along an axis; empty where there are none that can be read.
std::vector<double> coordinatesOf(const ArrayFile& file, const Axis& axis, std::size_t number,
                                  std::vector<std::string>& notices) {
    if (axis.coordinates == nullptr || axis.size > kMostCoordinates) return {};
    try {
        file.check(*axis.coordinates);
        return file.values(*axis.coordinates);
    } catch (const FileError& fault) {
        notices.push_back("the coordinates along " + nameOf(axis, number) + " are passed over: " + fault.problem());
        return {};
    }
}

/// The step from place to place, where coordinates tell one.
void readCoordinates(const ArrayFile& file, Axis& axis, std::size_t number, std::vector<std::string>& notices) {
    const std::vector<double> at = coordinatesOf(file, axis, number, notices);
    if (at.empty()) return;
    const double step = axis.size > 1 ? (at.back() - at.front()) / static_cast<double>(axis.size - 1) : 0;
    bool isOrdered = std::isfinite(step) && std::isfinite(at.front()), isEqual = true;
    // Coordinates are rounded to their type.
    const bool areFloats = axis.coordinates->type == ValueType::F32;
    const double rounding = areFloats ? std::ldexp(std::max(std::abs(at.front()), std::abs(at.back())), -23) : 0;
    for (std::size_t i = 1; i < at.size(); ++i) {
        const double here = at[i] - at[i - 1];
        isOrdered = isOrdered && here * step > 0;
        isEqual = isEqual && std::abs(here - step) <= 1e-3 * std::abs(step) + rounding;
    }
    if (!isOrdered) {
        notices.push_back("the coordinates along " + nameOf(axis, number) + " are in no order, and are passed over");
        return;
    }
    if (!isEqual)
        notices.push_back("the spacing along " + nameOf(axis, number) + " is unequal: shown with the mean, " +
                          exactText(std::abs(step)) + (axis.unit.empty() ? "" : " " + axis.unit));
    axis.step = step;
    axis.first = at.front();
}

/// One unit for all lengths; what cannot be made one is told. Returned is that unit, where it is known of each axis.
LengthUnit unifyUnits(std::vector<Axis*>& places, std::vector<std::string>& notices) {
    std::vector<std::string> units;
    for (const Axis* axis : places)
        if (!axis->unit.empty() && std::ranges::find(units, axis->unit) == units.end()) units.push_back(axis->unit);
    const bool areKnown =
        std::ranges::none_of(places, [](const Axis* axis) { return axis->size > 1 && axis->unit.empty(); });
    if (units.empty()) return LengthUnit::Unknown;
    if (units.size() == 1)
        return areKnown ? lengthUnitNamed(units.front()).value_or(LengthUnit::Unknown) : LengthUnit::Unknown;
    const auto isLength = [](const std::string& unit) { return lengthUnitNamed(unit).has_value(); };
    const auto isAngle = [](const std::string& unit) { return unit.starts_with("degree"); };
    if (std::ranges::all_of(units, isAngle)) return LengthUnit::Unknown;
    if (!std::ranges::all_of(units, isLength)) {
        notices.push_back("the axes have different units (" + joined(units, ", ") +
                          "): their numbers are taken as they are");
        return LengthUnit::Unknown;
    }
    const std::string name = places.back()->unit.empty() ? units.front() : places.back()->unit; // the fastest one's
    const LengthUnit unit = *lengthUnitNamed(name);
    for (Axis* axis : places) {
        if (axis->unit.empty()) continue;
        const LengthUnit own = *lengthUnitNamed(axis->unit);
        axis->step = converted(axis->step, own, unit);
        axis->first = converted(axis->first, own, unit);
    }
    notices.push_back("lengths are given in " + joined(units, " and ") + ": shown in " + name);
    return areKnown ? unit : LengthUnit::Unknown;
}

/// Places in the world: x, y and z of the file along those of the world, whichever way they are stored.
void placeInWorld(const std::vector<Axis*>& places, ArrayAxes& chosen) {
    std::array<bool, 3> isTaken{};
    std::vector<int> world(places.size(), -1);
    for (std::size_t n = 0; n < places.size(); ++n) {
        const int kind = static_cast<int>(places[n]->kind) - static_cast<int>(AxisKind::X);
        if (kind < 0 || kind > 2) continue;
        world[n] = kind;
        isTaken[static_cast<std::size_t>(kind)] = true;
    }
    double smallest = 0;
    for (const Axis* axis : places)
        if (const double step = std::abs(axis->step); step > 0 && (smallest == 0 || step < smallest)) smallest = step;
    chosen.directions = Mat3(0);
    for (int a = 0; a < 3; ++a) {
        const std::size_t n = places.size() - 1 - static_cast<std::size_t>(a); // slowest first there, fastest here
        const bool isThere = static_cast<std::size_t>(a) < places.size();
        int to = isThere ? world[n] : -1;
        if (to < 0) {
            to = static_cast<int>(std::ranges::find(isTaken, false) - isTaken.begin());
            isTaken[static_cast<std::size_t>(to)] = true;
        }
        const double step = isThere ? places[n]->step : 0;
        const bool isOne = !isThere || places[n]->size == 1 || places[n]->kind == AxisKind::Time;
        const double up = isThere && places[n]->isDownward ? -1 : 1;
        chosen.spacing[a] = step != 0 ? std::abs(step) : isOne && smallest > 0 ? smallest : 1;
        chosen.directions[a][to] = up * (step < 0 ? -1 : 1);
        chosen.origin[to] = isThere ? up * places[n]->first : 0;
    }
}

/// "d" of "days since 2000-01-01"; what is not known stays.
std::string timeUnitOf(const std::string& text) {
    const std::string unit = trimmed(text.substr(0, text.find(" since ")));
    if (isOneOf(unit, {"seconds", "second", "sec", "secs"})) return "s";
    if (isOneOf(unit, {"milliseconds", "millisecond", "msec", "msecs"})) return "ms";
    if (isOneOf(unit, {"minutes", "minute", "mins"})) return "min";
    if (isOneOf(unit, {"hours", "hour", "hr", "hrs"})) return "h";
    if (isOneOf(unit, {"days", "day"})) return "d";
    return unit;
}

void readTimes(const ArrayFile& file, const std::vector<Axis>& axes, ArrayAxes& chosen) {
    if (chosen.steps.size() != 1) return;
    const Axis& axis = axes[chosen.steps.front()];
    std::vector<double> times = coordinatesOf(file, axis, chosen.steps.front(), chosen.notices);
    if (!std::ranges::all_of(times, [](double time) { return std::isfinite(time); })) return;
    chosen.times = std::move(times);
    chosen.timeUnit = timeUnitOf(axis.unit);
}

} // namespace

ArrayAxes axesOf(const ArrayFile& file, const ArrayVariable& variable) {
    ArrayAxes chosen;
    std::vector<Axis> axes = axesIn(file, variable);
    chooseAxes(axes, chosen);
    std::vector<Axis*> places;
    bool hasSteps = false;
    for (const std::size_t a : chosen.places) {
        if (axes[a].kind != AxisKind::Time) readCoordinates(file, axes[a], a, chosen.notices);
        if (axes[a].kind == AxisKind::Time) axes[a].unit.clear(); // no length
        hasSteps = hasSteps || axes[a].step != 0;
        places.push_back(&axes[a]);
    }
    if (!hasSteps) readSpacing(file, variable, axes, chosen.places);
    chosen.lengthUnit = unifyUnits(places, chosen.notices);
    placeInWorld(places, chosen);
    readTimes(file, axes, chosen);
    return chosen;
}

} // namespace pellucid
