// The switches of the frame of reference.
#pragma once

namespace pellucid::gui {

class Services;

void addAnnotationActions(Services& services);

} // namespace pellucid::gui
