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
        const auto fewest = text.indexOf(point) + (m_isMeasuring ? 1 + kMeasured : 0);
        while (text.endsWith('0') && text.size() > fewest) text.chop(1);
        if (text.endsWith(point)) text.chop(static_cast<int>(point.size()));
        return text;
    }
    QSize sizeHint() const override {
        return measured([this] { return QDoubleSpinBox::sizeHint(); });
    }
    QSize minimumSizeHint() const override {
        return measured([this] { return QDoubleSpinBox::minimumSizeHint(); });
    }

private:
    static constexpr int kMeasured = 2; ///< decimals that there is room for
    template <class Hint>
    QSize measured(const Hint& hint) const {
        m_isMeasuring = true;
        const QSize size = hint();
        m_isMeasuring = false;
        return size;
    }
    mutable bool m_isMeasuring = false;
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
