// The six views along the world's axes, by name.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "render/camera_motion.h"

namespace pellucid {

/// Of a patient: anterior, posterior, left, right, superior, inferior, seen from there.
enum class StandardView { Front, Back, Left, Right, Top, Bottom };
inline constexpr std::array kStandardViews{StandardView::Front, StandardView::Back, StandardView::Left,
                                           StandardView::Right, StandardView::Top,  StandardView::Bottom};

/// From where it looks, zoom 1. In the file's own axes the front is the side of low y and left that of low x, as in
/// the picture from the front. In the patient's, left is the patient's left, and from above and below anterior is up:
/// from below, the patient's left is at the right, as radiologists are used to.
ViewAngles anglesOf(StandardView view, WorldAxes axes);

/// "front" …; in the patient's axes "anterior" ….
const char* name(StandardView view, WorldAxes axes);

/// A view as somebody asks for it, before the volume is known.
struct NamedView {
    StandardView view = StandardView::Front;
    bool ofPatient = false; ///< named in words of anatomy that need a patient
    double zoom = 1;
};
/// Empty where `name` is none of front, back, left, right, top, bottom, anterior, posterior, superior, inferior.
std::optional<NamedView> namedView(const std::string& name);

/// Throws UsageError where the name needs a patient and `axes` are the file's own.
ViewAngles anglesOf(const NamedView& view, WorldAxes axes);

} // namespace pellucid
