// The switches of the frame of reference.
#pragma once

namespace pellucid::gui {

class Workbench;

void addAnnotationActions(Workbench& bench);

} // namespace pellucid::gui
