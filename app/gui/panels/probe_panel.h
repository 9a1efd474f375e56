// What a click on the picture shows: a plot of the ray, and each feature's share of the pixel.
#pragma once

namespace pellucid::gui {

class ProbeController;
class Services;
class VolumeView;

/// The panel, and the mark over the picture.
void addProbe(Services& services, ProbeController& probe, VolumeView& view);

} // namespace pellucid::gui
