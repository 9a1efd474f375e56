// Plots of the window in the words of the window.
#pragma once

#include "report/plot.h"

namespace pellucid::gui {

/// The plot with title and axis as terms() call the figures; by their scientific names as it is.
Plot inWords(Plot plot);

} // namespace pellucid::gui
