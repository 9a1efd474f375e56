#include "render/standard_view.h"

#include "base/error.h"

namespace pellucid {

namespace {

constexpr std::array<const char*, 6> kSides{"front", "back", "left", "right", "top", "bottom"};
constexpr std::array<const char*, 6> kAnatomy{"anterior", "posterior", "left", "right", "superior", "inferior"};

} // namespace

ViewAngles anglesOf(StandardView view, WorldAxes axes) {
    // The patient's left is at +x. Up is +y at azimuth 0 from the top, which is posterior, and −y from the bottom.
    constexpr ViewAngles kOfFile[] = {{0, 0}, {180, 0}, {-90, 0}, {90, 0}, {0, 90}, {0, -90}};
    constexpr ViewAngles kOfPatient[] = {{0, 0}, {180, 0}, {90, 0}, {-90, 0}, {180, 90}, {0, -90}};
    return (axes == WorldAxes::Patient ? kOfPatient : kOfFile)[static_cast<std::size_t>(view)];
}

const char* name(StandardView view, WorldAxes axes) {
    return (axes == WorldAxes::Patient ? kAnatomy : kSides)[static_cast<std::size_t>(view)];
}

std::optional<NamedView> namedView(const std::string& name) {
    for (const StandardView view : kStandardViews) {
        const auto i = static_cast<std::size_t>(view);
        if (name == kSides[i]) return NamedView{view, false, 1};
        if (name == kAnatomy[i]) return NamedView{view, true, 1};
    }
    return {};
}

ViewAngles anglesOf(const NamedView& view, WorldAxes axes) {
    if (view.ofPatient && axes != WorldAxes::Patient)
        throw UsageError("the file does not say how the patient lies in it, so it has no such view", "view",
                         std::string("use ") + kSides[static_cast<std::size_t>(view.view)]);
    ViewAngles angles = anglesOf(view.view, axes);
    angles.zoom = view.zoom;
    return angles;
}

} // namespace pellucid
