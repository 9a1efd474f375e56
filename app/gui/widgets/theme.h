// The look of the window: neutral, dark or light, so that only the data has colour.
#pragma once

#include <QColor>

#include "base/color.h"
#include "base/enum_names.h"

class QApplication;
class QLabel;

namespace pellucid::gui {

enum class Theme { Dark, Light, System }; ///< the last: what the desktop is set to
} // namespace pellucid::gui
template <>
inline constexpr auto pellucid::kNamesOf<pellucid::gui::Theme> = pellucid::enumNames("theme", "dark", "light",
                                                                                     "system");
namespace pellucid::gui {

/// The colours of the present theme, to be read at each painting. Marks over the picture have the same in every theme,
/// since the background of the picture is the user's.
namespace theme {
inline QColor kWindow, kPanel; ///< behind controls; behind what is painted or typed
inline QColor kRaised;         ///< buttons
inline QColor kTitle;          ///< bars of docks and tables
inline QColor kLine, kText, kFaint, kAccent;
inline QColor kTrack;     ///< under bars of any colour
inline QColor kHistogram; ///< the area of a histogram on kPanel
inline QColor kCurve;     ///< a line that stands out from kPanel and kHistogram
inline QColor kKnob;      ///< what can be taken hold of: rings of points, handles
inline QColor kHover;     ///< translucent, over a row that has the focus
inline QColor kFalls;     ///< with kAccent a pair that everyone can tell apart
inline const QColor kMark{0xe4, 0xe5, 0xe7}, kMarkAccent{0x4c, 0x9a, 0xff}; ///< over the picture, with dark edges
} // namespace theme

/// Style, palette and colours. At any time again: every widget is painted anew, with QEvent::PaletteChange before.
void applyTheme(QApplication& application, Theme theme = Theme::Dark);
Theme appliedTheme();

/// Of relative luminances, WCAG 2.1: from 1 (the same) to 21.
double contrast(const QColor& a, const QColor& b);
inline constexpr double kTextContrast = 4.5, kMarkContrast = 3; ///< least of texts, of lines and other marks (WCAG AA)
/// `color`, or the nearest darker or lighter one of its hue that has `least` of contrast to `ground`: for colours that
/// the user or the data choose, such as those of features.
QColor seenOn(const QColor& ground, const QColor& color, double least = kMarkContrast);

/// From `a`, where `share` is 0, to `b`, where it is 1; as translucent as `a`.
QColor between(const QColor& a, const QColor& b, double share);

inline QColor translucent(QColor color, double alpha) {
    color.setAlphaF(static_cast<float>(alpha));
    return color;
}

/// For a remark beside what matters: the label's text is kFaint in every theme.
void makeFaint(QLabel& label);

QColor colorFromRgb(const Rgb& rgb);
Rgb rgbFromColor(const QColor& color);

} // namespace pellucid::gui
