// The switches of the frame of reference.
#pragma once

namespace pellucid::gui {

class Workbench;

void addFrameActions(Workbench& bench);

} // namespace pellucid::gui
