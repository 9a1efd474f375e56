// What a drag of the mouse over the volume does: as in Pellucid, or as in a program that people come from.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <QString>
#include <Qt>

#include "base/enum_names.h"

namespace pellucid::gui {

/// Whose habits the mouse follows.
enum class MouseScheme { Pellucid, ParaView, Slicer };
} // namespace pellucid::gui
template <>
inline constexpr auto pellucid::kNamesOf<pellucid::gui::MouseScheme> = pellucid::enumNames("mouse scheme", "pellucid",
                                                                                           "paraview", "slicer");
namespace pellucid::gui {

/// What a drag does to the view; the last one turns the light in its place.
enum class Motion { Rotate, Pan, Zoom, Roll, Light };

struct MouseDrag {
    Qt::MouseButton button;
    Qt::KeyboardModifiers keys;
    Motion motion;
};
/// All drags of a scheme, those without keys first.
std::span<const MouseDrag> dragsOf(MouseScheme scheme);
/// What this drag does. Keys that the scheme has no drag for count as none; empty: the button does nothing.
std::optional<Motion> motionOf(MouseScheme scheme, Qt::MouseButton button, Qt::KeyboardModifiers keys);
/// Whether a drag that zooms comes closer on the way down, else on the way up.
bool zoomsInDownward(MouseScheme scheme);

/// A row of a table for people: "Left drag, arrow keys", "rotate".
struct MotionText {
    QString how, what;
};
/// One row for each motion, with the wheel and the keys that do the same in every scheme.
std::vector<MotionText> motionTexts(MouseScheme scheme);

/// Of all windows, from now on.
void setMouseScheme(MouseScheme scheme);
MouseScheme mouseScheme();

} // namespace pellucid::gui
