// How the camera is set: what the View menu and the hands on the picture share.
#pragma once

#include "render/standard_view.h"
#include "store/session_store.h"

namespace pellucid::gui {

class Services;

void fitView(SessionStore& store);   ///< the same direction, the whole box
void resetView(SessionStore& store); ///< as a volume opens
void setStandardView(SessionStore& store, StandardView view);
void setProjection(SessionStore& store, Projection projection);
void zoomView(SessionStore& store, double factor, int gesture = 0);

void addViewActions(Services& services);

} // namespace pellucid::gui
