// The look of the window: dark and neutral, so that only the data has colour.
#pragma once

#include <QColor>

#include "tf/color.h"

class QApplication;

namespace pellucid::gui {

namespace theme {
inline const QColor kWindow{0x26, 0x27, 0x29};
inline const QColor kPanel{0x1c, 0x1d, 0x1f};
inline const QColor kRaised{0x35, 0x37, 0x3a};
inline const QColor kLine{0x45, 0x47, 0x4b};
inline const QColor kText{0xe4, 0xe5, 0xe7};
inline const QColor kFaint{0x9a, 0x9d, 0xa3};
inline const QColor kAccent{0x4c, 0x9a, 0xff};
} // namespace theme

void applyTheme(QApplication& application);
QColor colorFromRgb(const Rgb& rgb);
Rgb rgbFromColor(const QColor& color);

} // namespace pellucid::gui
