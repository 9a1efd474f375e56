// The height field under the volume: its file, scale, relief and colours.
#pragma once

class QWidget;

namespace pellucid::gui {

class OpenController;
class Services;

QWidget* makeGroundBox(Services& services, OpenController& opening);

} // namespace pellucid::gui
