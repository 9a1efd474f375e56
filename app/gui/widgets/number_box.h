// Number boxes that follow the state without getting in the way of who types into them.
#pragma once

#include <cmath>

#include <QDoubleSpinBox>
#include <QSignalBlocker>

namespace pellucid::gui {

/// Shows no zeros at the end, so that it may have decimals for small numbers.
class NumberBox : public QDoubleSpinBox {
public:
    using QDoubleSpinBox::QDoubleSpinBox;
    QString textFromValue(double value) const override {
        QString text = QDoubleSpinBox::textFromValue(value);
        const QString point = locale().decimalPoint();
        if (!text.contains(point)) return text;
        while (text.endsWith('0')) text.chop(1);
        if (text.endsWith(point)) text.chop(static_cast<int>(point.size()));
        return text;
    }
};

/// Shows `value`, without a signal. A box that shows it already is left alone, text, cursor and all: somebody may be
/// typing.
inline void showNumber(QDoubleSpinBox& box, double value) {
    const bool shown = std::abs(box.value() - value) <= 0.5 * std::pow(10.0, -box.decimals());
    if (shown && !box.text().isEmpty()) return;
    const QSignalBlocker quiet(box);
    if (shown) box.setValue(value == box.minimum() ? box.maximum() : box.minimum()); // it has been cleared
    box.setValue(value);
}

} // namespace pellucid::gui
