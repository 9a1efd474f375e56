#include "foreign/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "base/error.h"
#include "base/round_numbers.h"
#include "volume/formats/samples.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

/// Slices that are off their places by less than this part of the distance between them are on the grid: headers round.
constexpr double kOffGrid = 0.1;

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Pictures of one place, or of one step: indices of frames.
using Pictures = std::vector<std::size_t>;

/// How far along the normal of the slices each picture lies; where they have no place, as they are numbered.
struct Places {
    std::vector<double> along;
    Vec3 normal{0, 0, 1};
    bool areKnown = false;
};

Places placesOf(const std::vector<DicomFrame>& frames) {
    Places places;
    if (frames.front().axes) places.normal = glm::cross((*frames.front().axes)[0], (*frames.front().axes)[1]);
    places.areKnown = std::ranges::all_of(frames, [](const DicomFrame& frame) { return frame.position.has_value(); });
    if (places.areKnown) {
        for (const DicomFrame& frame : frames) places.along.push_back(glm::dot(*frame.position, places.normal));
        return places;
    }
    std::vector<std::size_t> order(frames.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        return std::tuple(frames[i].instanceNumber, frames[i].file, frames[i].frame);
    });
    places.along.resize(frames.size());
    const double width = frames.front().thickness > 0 ? frames.front().thickness : 1;
    for (std::size_t i = 0; i < order.size(); ++i) places.along[order[i]] = width * static_cast<double>(i);
    return places;
}

/// Pictures of one place together, places ascending.
std::vector<Pictures> byPlace(const Places& places, double tolerance) {
    Pictures order(places.along.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return places.along[i]; });
    std::vector<Pictures> groups;
    for (const std::size_t i : order) {
        if (groups.empty() || places.along[i] - places.along[groups.back().front()] > tolerance) groups.emplace_back();
        groups.back().push_back(i);
    }
    return groups;
}

/// Leaves one of pictures that are the same object.
void dropCopies(const std::vector<DicomFrame>& frames, std::vector<Pictures>& groups,
                std::vector<std::string>& notices) {
    std::size_t dropped = 0;
    for (Pictures& group : groups) {
        std::set<std::pair<std::string, int>> seen;
        dropped += std::erase_if(group, [&](std::size_t i) {
            return !frames[i].instanceUid.empty() && !seen.emplace(frames[i].instanceUid, frames[i].frame).second;
        });
    }
    if (dropped > 0) notices.push_back(counted(dropped, "slice is", "slices are") + " there twice, and counted once");
}

/// Whether each place has pictures with different values of this.
bool tellsApart(const std::vector<DicomFrame>& frames, const std::vector<Pictures>& groups, std::size_t time) {
    return std::ranges::all_of(groups, [&](const Pictures& group) {
        std::set<double> values;
        return std::ranges::all_of(group, [&](std::size_t i) {
            return frames[i].times[time] && values.insert(*frames[i].times[time]).second;
        });
    });
}

const char* unitOf(DicomTime time) {
    switch (time) {
    case DicomTime::BValue:
        return "s/mm²";
    case DicomTime::TriggerTime:
    case DicomTime::FrameTime:
    case DicomTime::EchoTime:
        return "ms";
    case DicomTime::AcquisitionTime:
    case DicomTime::ContentTime:
        return "s";
    case DicomTime::TemporalPosition:
    case DicomTime::AcquisitionNumber:
        break;
    }
    return "";
}

/// Steps of which each has one picture of each place, by the values of `time`.
std::vector<Pictures> stepsByValue(const std::vector<DicomFrame>& frames, const std::vector<Pictures>& groups,
                                   std::size_t time) {
    std::map<double, Pictures> byValue;
    for (const Pictures& group : groups)
        for (const std::size_t i : group) byValue[*frames[i].times[time]].push_back(i);
    std::vector<Pictures> steps;
    for (auto& [value, pictures] : byValue) steps.push_back(std::move(pictures));
    return steps;
}

/// The n-th picture of each place is of step n.
std::vector<Pictures> stepsByRank(std::vector<Pictures> groups, const auto& rank) {
    std::vector<Pictures> steps;
    for (Pictures& group : groups) {
        std::ranges::stable_sort(group, {}, rank);
        for (std::size_t n = 0; n < group.size(); ++n) {
            if (steps.size() <= n) steps.emplace_back();
            steps[n].push_back(group[n]);
        }
    }
    return steps;
}

void takeTimes(DicomStack& stack, const std::vector<DicomFrame>& frames, const std::vector<Pictures>& steps,
               std::size_t time) {
    stack.timeUnit = unitOf(static_cast<DicomTime>(time));
    for (const Pictures& step : steps) {
        double sum = 0;
        for (const std::size_t i : step) sum += *frames[i].times[time];
        stack.times.push_back(sum / static_cast<double>(step.size()));
    }
    if (static_cast<DicomTime>(time) < DicomTime::AcquisitionTime) return;
    for (double& t : stack.times) t -= *std::ranges::min_element(stack.times); // time of day is nobody's business
}

/// The steps, all with a picture of each place in their order.
std::vector<Pictures> stepsOf(DicomStack& stack, const std::vector<DicomFrame>& frames, std::vector<Pictures> groups) {
    std::size_t most = 0, least = frames.size();
    for (const Pictures& group : groups) {
        most = std::max(most, group.size());
        least = std::min(least, group.size());
    }
    std::vector<Pictures> steps;
    if (most == 1) {
        steps.emplace_back();
        for (const Pictures& group : groups) steps.back().push_back(group.front());
        return steps;
    }
    for (std::size_t time = 0; time < kDicomTimes; ++time) {
        if (!tellsApart(frames, groups, time)) continue;
        steps = stepsByValue(frames, groups, time);
        if (steps.size() > 2 * most) // of each place its own
            steps = stepsByRank(groups, [&](std::size_t i) { return *frames[i].times[time]; });
        const std::size_t all = steps.size();
        std::erase_if(steps, [&](const Pictures& step) { return step.size() < groups.size(); });
        if (steps.empty()) continue;
        if (steps.size() < all)
            stack.notices.push_back(counted(all - steps.size(), "time step lacks", "time steps lack") + " slices and " +
                                    (all - steps.size() == 1 ? "is" : "are") + " left out");
        takeTimes(stack, frames, steps, time);
        return steps;
    }
    const auto byNumber = [&](std::size_t i) { return frames[i].instanceNumber; };
    if (least == most) {
        stack.notices.emplace_back(
            "several slices lie in each place: they are shown as time steps, as they are numbered");
        return stepsByRank(groups, byNumber);
    }
    std::size_t dropped = 0;
    steps.emplace_back();
    for (Pictures& group : groups) {
        dropped += group.size() - 1;
        steps.back().push_back(*std::ranges::min_element(group, {}, byNumber));
    }
    stack.notices.push_back(counted(dropped, "slice lies", "slices lie") + " where another one does and " +
                            (dropped == 1 ? "is" : "are") + " left out");
    return steps;
}

double medianGap(const std::vector<double>& along) {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < along.size(); ++i) gaps.push_back(along[i] - along[i - 1]);
    std::ranges::nth_element(gaps, gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2));
    return gaps[gaps.size() / 2];
}

/// Where the layers of a grid are, by the places of the slices along their normal: each slice where it is, others
/// between.
struct Layers {
    std::vector<DicomLayer> layers; ///< of slices by their order
    double spacing = 1;
    std::size_t interpolated = 0;
};

Layers layersOf(const std::vector<double>& along, const std::string& where) {
    Layers grid;
    const std::size_t count = along.size();
    const auto place = [&](std::size_t layers) {
        grid.spacing = layers > 1 ? (along.back() - along.front()) / static_cast<double>(layers - 1) : 1;
        grid.layers.clear();
        grid.interpolated = 0;
        std::size_t below = 0;
        for (std::size_t k = 0; k < layers; ++k) {
            const double at = along.front() + grid.spacing * static_cast<double>(k);
            while (below + 2 < count && along[below + 1] <= at) ++below;
            const double gap = along[below + 1] - along[below], from = at - along[below];
            if (std::abs(from) <= kOffGrid * grid.spacing) {
                grid.layers.push_back({below, below, 0});
            } else if (std::abs(gap - from) <= kOffGrid * grid.spacing) {
                grid.layers.push_back({below + 1, below + 1, 0});
            } else {
                grid.layers.push_back({below, below + 1, from / gap});
                ++grid.interpolated;
            }
        }
    };
    if (count == 1) {
        grid.layers = {{0, 0, 0}};
        return grid;
    }
    place(count);
    if (grid.interpolated == 0) return grid;
    const double layers = std::round((along.back() - along.front()) / medianGap(along)) + 1;
    constexpr double kMostLayers = 8; // for each slice
    if (!(layers <= kMostLayers * static_cast<double>(count)))
        throw FileError("the slices are so unequally far from each other that they lie on no grid", where,
                        "leave only those of one stack in the folder");
    place(static_cast<std::size_t>(std::max(2.0, layers)));
    return grid;
}

/// Says of the slices what people should know who look at them.
void addNotices(DicomStack& stack, const std::vector<double>& along, const Layers& grid) {
    if (grid.interpolated == 0) return;
    std::vector<double> gaps;
    for (std::size_t i = 1; i < along.size(); ++i) gaps.push_back(along[i] - along[i - 1]);
    const auto [least, most] = std::ranges::minmax(gaps);
    stack.notices.push_back(
        "slices are missing or not equally spaced (" + plainText(std::round(least * 1000) / 1000) + " to " +
        plainText(std::round(most * 1000) / 1000) + " mm apart): " + std::to_string(grid.interpolated) + " of " +
        std::to_string(grid.layers.size()) + " layers are interpolated between those that are there");
}

/// Where the grid lies, by the first and the last slice.
void placeGrid(DicomStack& stack, const std::vector<DicomFrame>& frames, const Pictures& slices, const Places& places,
               const Layers& grid) {
    const DicomFrame& first = frames[slices.front()];
    Geometry& geometry = stack.geometry;
    geometry.dims = {first.pixels.columns, first.pixels.rows, static_cast<int>(grid.layers.size())};
    const auto spacing = first.spacing.value_or(std::array{1.0, 1.0});
    geometry.spacing = {spacing[0], spacing[1], slices.size() > 1 ? grid.spacing : std::max(first.thickness, 0.0)};
    if (!(geometry.spacing.z > 0)) geometry.spacing.z = 1;
    const bool isPlaced = first.axes && places.areKnown;
    geometry.worldAxes = isPlaced ? WorldAxes::Patient : WorldAxes::File;
    if (!isPlaced) geometry.lengthUnit = LengthUnit::Millimetre; // as DICOM has it, wherever that is
    if (!first.spacing)
        stack.notices.emplace_back(
            std::string("the files do not say how far pixels are from each other: 1 mm is taken") + kUnlessSet);
    if (slices.size() > 1 && !places.areKnown)
        stack.notices.emplace_back(
            "the files do not say where slices lie: they are shown in the order of their numbers, " +
            plainText(geometry.spacing.z) + " mm apart");
    if (!isPlaced) return;
    geometry.origin = *first.position;
    const Vec3 columns = (*first.axes)[0], rows = (*first.axes)[1];
    Vec3 across = places.normal;
    if (slices.size() > 1) {
        const Vec3 way = *frames[slices.back()].position - *first.position;
        across = glm::normalize(way);
        geometry.spacing.z = glm::length(way) / static_cast<double>(grid.layers.size() - 1);
        double off = 0; // from the line through the first and the last slice
        for (const std::size_t i : slices) {
            const Vec3 from = *frames[i].position - *first.position;
            off = std::max(off, glm::length(from - across * glm::dot(from, across)));
        }
        if (off > 0.5 * geometry.spacing.z)
            stack.notices.push_back("the slices are up to " + plainText(std::round(off * 100) / 100) +
                                    " mm beside a straight line, and are shown on it");
    }
    geometry.directions = Mat3(cleanDirection(columns), cleanDirection(rows), cleanDirection(across));
    const double tilt = std::acos(std::clamp(glm::dot(across, places.normal), -1.0, 1.0)) * 180 / std::numbers::pi;
    constexpr double kTilted = 0.1; // degrees
    if (tilt > kTilted)
        stack.notices.push_back("the slices are tilted by " + plainText(std::round(tilt * 10) / 10) +
                                "° against the way from one to the next (a tilted gantry), and shown where they were");
}

} // namespace

DicomStack stackOf(const std::vector<DicomFrame>& frames, const std::string& where) {
    DicomStack stack;
    const Places places = placesOf(frames);
    const auto spacing = frames.front().spacing.value_or(std::array{1.0, 1.0});
    constexpr double kSamePlace = 1e-3; // of a pixel
    std::vector<Pictures> groups = byPlace(places, kSamePlace * std::min(spacing[0], spacing[1]));
    dropCopies(frames, groups, stack.notices);
    const std::vector<Pictures> steps = stepsOf(stack, frames, std::move(groups));
    std::vector<double> along;
    for (const std::size_t i : steps.front()) along.push_back(places.along[i]);
    const Layers grid = layersOf(along, where);
    addNotices(stack, along, grid);
    placeGrid(stack, frames, steps.front(), places, grid);
    for (const Pictures& step : steps) {
        std::vector<DicomLayer>& layers = stack.steps.emplace_back();
        for (const DicomLayer& layer : grid.layers)
            layers.push_back({step[layer.before], step[layer.after], layer.toAfter});
    }
    return stack;
}

} // namespace pellucid
