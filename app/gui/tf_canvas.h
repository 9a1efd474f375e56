// The curve of the transfer function over the histogram, edited with the mouse.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QWidget>

#include "intensity_axis.h"
#include "results.h"
#include "store/session_store.h"

namespace pellucid::gui {

/// Where things of the plane (intensity, opacity) are drawn, widget pixels.
class CanvasGeometry {
public:
    virtual ~CanvasGeometry() = default;
    virtual QRectF plot() const = 0;
    virtual QPointF positionOf(double x, double opacity) const = 0;
};

/// Something drawn behind the curve and over the histogram, by whoever knows of it.
class CanvasLayer {
public:
    virtual ~CanvasLayer() = default;
    virtual void paint(QPainter& painter, const CanvasGeometry& where) = 0;
};

/// Every finished drag is one undo step; while the mouse is down the store previews.
class TfCanvas : public QWidget, public CanvasGeometry {
    Q_OBJECT
public:
    TfCanvas(SessionStore& store, Results& results, QWidget* parent = nullptr);

    void setLogHistogram(bool on);
    /// The opacity axis shows √α: room for the small opacities that matter most in a volume.
    void setRootOpacityAxis(bool on);
    void setReadOnly(bool on);

    int selectedPoint() const { return m_selected; } ///< −1: none
    void selectPoint(int index);
    void addPoint(double x, double opacity);
    void removeSelected();
    void toggleFixed();
    void chooseColor();

    /// Where a point of the plane (intensity, opacity) is drawn, widget pixels.
    QPointF positionOf(double x, double opacity) const override;
    QRectF plot() const override;
    IntensityAxis& axis() { return m_axis; }
    /// In the order of adding; who adds calls update() when it looks different.
    void addLayer(std::unique_ptr<CanvasLayer> layer) { m_layers.push_back(std::move(layer)); }

    QSize sizeHint() const override { return {640, 190}; }
    QSize minimumSizeHint() const override { return {300, 130}; }

Q_SIGNALS:
    void selectionChanged(int index);

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    bool event(QEvent* event) override;

private:
    struct Drag {
        TransferFunction start;
        int index = 0;
        QPointF pressed, grip; ///< grip: from the mouse to the point's centre
        bool moved = false;
    };

    double heightOfOpacity(double opacity) const; ///< [0,1] up the axis
    double opacityOfHeight(double height) const;
    double intensityAt(double pixelX) const;
    double opacityAt(double pixelY) const;
    int pointAt(const QPointF& position) const; ///< −1: none
    int featureBarAt(const QPointF& position) const;
    QString valueText(double x) const;
    void follow(const Scene& before, const Scene& after);
    const TransferFunction& tf() const { return m_store.scene().tf; }
    void nudge(double dx, double dHeight);

    void paintHistogram(QPainter& painter) const;
    void paintVisibility(QPainter& painter) const;
    void paintCurve(QPainter& painter) const;
    void paintFeatures(QPainter& painter) const;
    void paintAxes(QPainter& painter) const;
    void paintPoints(QPainter& painter) const;

    SessionStore& m_store;
    Results& m_results;
    IntensityAxis m_axis;
    std::vector<std::unique_ptr<CanvasLayer>> m_layers;
    bool m_logHistogram = true, m_rootOpacity = false, m_readOnly = false;
    int m_selected = -1, m_hovered = -1;
    std::optional<Drag> m_drag;
};

} // namespace pellucid::gui
