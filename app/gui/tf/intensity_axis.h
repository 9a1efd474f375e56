// Which part of the intensity axis is seen: one for all that is drawn along it, so that they stay above each other.
#pragma once

#include <algorithm>

#include <QObject>
#include <QRectF>

namespace pellucid::gui {

/// The visible part [lo, hi] of the intensities [0,1].
class IntensityAxis : public QObject {
    Q_OBJECT
public:
    static constexpr double kNarrowest = 1.0 / 4096; ///< of the visible part

    using QObject::QObject;

    double lo() const { return m_lo; }
    double hi() const { return m_hi; }
    double width() const { return m_hi - m_lo; }
    double middle() const { return (m_lo + m_hi) / 2; }
    bool contains(double intensity) const { return intensity >= m_lo && intensity <= m_hi; }
    bool isWhole() const { return m_lo == 0 && m_hi == 1; }

    double toPixel(double intensity, const QRectF& plot) const {
        return plot.left() + (intensity - m_lo) / (m_hi - m_lo) * plot.width();
    }
    double toIntensity(double pixel, const QRectF& plot) const { ///< within [0,1]
        return std::clamp(m_lo + (pixel - plot.left()) / std::max(1.0, plot.width()) * (m_hi - m_lo), 0.0, 1.0);
    }

    /// The nearest part that lies in [0,1] and is not too narrow.
    void setVisible(double lo, double hi) {
        const double width = std::clamp(hi - lo, kNarrowest, 1.0);
        lo = std::clamp(lo, 0.0, 1.0 - width);
        if (lo == m_lo && lo + width == m_hi) return;
        m_lo = lo;
        m_hi = lo + width;
        Q_EMIT changed();
    }
    /// Makes the visible part `factor` times as wide; `intensity` stays in its place.
    void zoomAbout(double intensity, double factor) {
        const double width = std::clamp((m_hi - m_lo) * factor, kNarrowest, 1.0);
        const double share = (intensity - m_lo) / (m_hi - m_lo);
        setVisible(intensity - share * width, intensity + (1 - share) * width);
    }
    void moveTo(double lo) { setVisible(lo, lo + width()); }
    void pan(double by) { setVisible(m_lo + by, m_hi + by); } ///< in intensities
    void reset() { setVisible(0, 1); }

Q_SIGNALS:
    void changed();

private:
    double m_lo = 0, m_hi = 1;
};

} // namespace pellucid::gui
