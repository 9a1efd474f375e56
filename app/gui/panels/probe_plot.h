// The two drawings of the probe's panel.
#pragma once

#include <optional>

#include <QWidget>

#include "render/probe.h"
#include "widgets/spoken_value.h"

namespace pellucid {
struct Scene;
}

namespace pellucid::gui {

class ProbeController;
class Services;

/// Along the ray: values as an area in the colours of the transfer function, the opacity that has accumulated as a line
/// from 0 to 1, and below which feature it is in. Depth is in world units from where the ray enters.
class ProbePlot : public QWidget, public Spoken {
    Q_OBJECT
public:
    ProbePlot(Services& services, ProbeController& probe, QWidget* parent);

    /// A value of the scene's volume with as many digits as its range asks for, and its unit.
    static QString valueText(const Scene& scene, double value);

    QRectF plot() const; ///< where the curves are
    double depthAt(double x) const;
    double xOf(double depth) const;

    QSize sizeHint() const override { return {300, 150}; }
    QSize minimumSizeHint() const override { return {200, 120}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void readOut(const QString& text); ///< under the mouse; empty where it has left

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    const ProbeSample& sampleAt(double depth) const;
    double length() const;
    void paintValues(QPainter& painter) const;
    void paintAxes(QPainter& painter) const;

    Services& m_services;
    ProbeController& m_probe;
    std::optional<double> m_hovered; ///< depth
};

/// A row per feature that the ray meets: its name, its share of the pixel as a bar and in percent. A click selects it.
class ProbeShares : public QWidget, public Spoken {
    Q_OBJECT
public:
    ProbeShares(Services& services, ProbeController& probe, QWidget* parent);

    struct Row {
        int feature = -1; ///< −1: what is in no feature
        double share = 0; ///< of the pixel
        QString text;     ///< "12.3 %"
    };
    std::vector<Row> rows() const;
    QRect rowRect(int row) const;

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override { return {120, sizeHint().height()}; }
    QString spokenValue() const override;

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    bool event(QEvent* event) override;

private:
    int rowAt(const QPoint& point) const;
    Services& m_services;
    ProbeController& m_probe;
};

} // namespace pellucid::gui
