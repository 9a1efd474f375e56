// Number boxes that follow the state without getting in the way of who types into them.
#pragma once

#include <cmath>

#include <QDoubleSpinBox>

namespace pellucid::gui {

/// Shows `value`. A box that shows it already is left alone, text, cursor and all: somebody may be typing.
inline void showNumber(QDoubleSpinBox& box, double value) {
    const bool shown = std::abs(box.value() - value) <= 0.5 * std::pow(10.0, -box.decimals());
    if (shown && !box.text().isEmpty()) return;
    if (shown) box.setValue(value == box.minimum() ? box.maximum() : box.minimum()); // it has been cleared
    box.setValue(value);
}

} // namespace pellucid::gui
