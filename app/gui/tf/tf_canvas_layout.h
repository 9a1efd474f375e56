// Where the parts of the transfer function's canvas lie, in pixels.
#pragma once

namespace pellucid::gui::layout {

// Around the plot. Above it: the line of words, the features' bars. Below it: colours, labels, what part is seen.
inline constexpr double kLeft = 46, kRight = 14, kTop = 34, kBottom = 33;
inline constexpr double kGradientAxis = 56; ///< right of the plot, in place of kRight
inline constexpr double kTopLine = 15;      ///< height of the line of words
inline constexpr double kBar = 14;          ///< of the features' bars
inline constexpr double kStrip = 7;         ///< of the strip of colours
inline constexpr double kOverview = 4;      ///< of the bar that shows which part is seen

} // namespace pellucid::gui::layout
