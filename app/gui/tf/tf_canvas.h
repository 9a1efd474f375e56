// The curve of the transfer function over the histogram, edited with the mouse.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <QImage>
#include <QPainterPath>
#include <QWidget>

#include "services/results.h"
#include "services/selection.h"
#include "store/session_store.h"
#include "tf/histogram_bars.h"
#include "tf/intensity_axis.h"
#include "tf/point_selection.h"
#include "tf/volume_counts.h"
#include "widgets/opacity_axis.h"
#include "widgets/spoken_value.h"

class QMenu;

namespace pellucid::gui {

namespace layout { // pixels
// Around the plot. Above it: the features' bars. Below it: colours, labels, what part is seen.
inline constexpr double kLeft = 46, kRight = 14, kTop = 18, kBottom = 36;
inline constexpr double kGradientAxis = 56; ///< right of the plot, in place of kRight
inline constexpr double kTopLine = 15;      ///< height of the line of words at the top of the plot
inline constexpr double kBar = 14;          ///< of the features' bars
inline constexpr double kStrip = 15;        ///< of the colours
inline constexpr double kOverview = 4;      ///< of the bar that shows which part is seen

} // namespace layout

/// Every finished drag is one undo step; while the mouse is down the store previews.
class TfCanvas : public QWidget, public Spoken {
    Q_OBJECT
public:
    TfCanvas(SessionStore& store, Results& results, Selection& selection, QWidget* parent = nullptr);

    void setHistogramScale(HistogramScale scale);
    HistogramScale histogramScale() const { return m_scale; }
    /// Behind the curve: how often intensities meet gradient magnitudes.
    void setJointHistogramShown(bool on);
    /// See OpacityAxis; on at first.
    void setFineOpacityAxis(bool on);
    void setReadOnly(bool on);
    /// What values are in, such as "HU"; empty: not known.
    void setUnit(const QString& unit);

    const PointSelection& selectedPoints() const { return m_points; }
    void selectPoints(const PointSelection& points);
    int selectedPoint() const { return m_points.current(); } ///< −1: none
    void selectPoint(int index);                             ///< alone
    void addPoint(double x, double opacity);
    void removeSelected();
    void toggleFixed();
    void chooseColor();

    // Where things of the plane (intensity, opacity) are drawn, widget pixels.
    QPointF positionOf(double x, double opacity) const;
    QRectF plot() const;
    QRectF strip() const; ///< for the colours along the axis, below the plot
    IntensityAxis& axis() { return m_axis; }
    /// A curve behind the curve, null: none; asked whenever the canvas is painted. Who sets it calls update() when it
    /// is another one.
    void setGhost(std::function<const TransferFunction*()> ghost) { m_ghost = std::move(ghost); }
    QRectF barOf(const Feature& feature) const; ///< above the plot, as far as it is seen; empty: not at all

    /// What is at the hovered intensity: value, opacity, voxels, feature. Empty where nothing is hovered.
    QString readout() const;
    /// A histogram is being counted that will be shown.
    bool isCounting() const { return m_counts.isBusy(); }

    QSize sizeHint() const override { return {640, 180}; }
    QSize minimumSizeHint() const override { return {300, 110}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void arranged(); ///< plot() and strip() may be others
    /// The selected points, or which of them is the current one.
    void selectionChanged(int current);
    /// A context menu is about to open at an intensity, which is the hovered one while it is open; `feature` 0: none
    /// is there. Others may add to it; on a feature's bar it is empty so far.
    void menuOpening(QMenu& menu, double intensity, pellucid::FeatureId feature);

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void changeEvent(QEvent* event) override;
    bool event(QEvent* event) override;

private:
    enum class Zone { None, Plot, Bars, Axis, Overview };
    enum class Part { Middle, Lower, Upper }; // of a feature's bar
    struct BarHit {
        int feature = 0;
        Part part = Part::Middle;
        bool operator==(const BarHit&) const = default;
    };
    struct Drag {
        enum class Kind { Points, Band, Pan, Overview, Feature };
        Kind kind = Kind::Points;
        QPointF pressed, last; // the mouse
        QPointF at;            // the mouse, had it moved as slowly as Ctrl makes it
        bool moved = false;
        TransferFunction start = {};
        int index = 0;              // of the point or feature
        Part part = Part::Middle;   // of the feature's bar
        PointSelection before = {}; // of Band: what was selected; of Points: what a click without motion selects
        double lo = 0;              // of Pan, Overview: the axis then

        bool edits() const { return kind == Kind::Points || kind == Kind::Feature; }
    };

    Zone zoneAt(const QPointF& position) const;
    QRectF overviewTrack() const;
    double intensityAt(double pixelX) const;
    double opacityAt(double pixelY) const;
    std::vector<int> pointsAt(const QPointF& position) const; ///< the nearest first
    int pointAt(const QPointF& position) const;               ///< −1: none
    std::optional<BarHit> barAt(const QPointF& position) const;
    QString valueText(double x) const; ///< with its unit
    QString pointText(int index) const;
    QString toolTipAt(const QPointF& position) const;
    SeenBins seenHistogram() const;
    void follow(const Scene& before, const Scene& after);
    const TransferFunction& tf() const { return m_store.scene().tf; }
    const ControlPoint& point(int index) const { return tf().points[static_cast<std::size_t>(index)]; }
    const Feature& feature(int index) const { return tf().features[static_cast<std::size_t>(index)]; }
    QPointF positionOf(int index) const; ///< of a point
    bool areFixed() const;               ///< all selected points
    void selectAll(int current);
    void zoomTo(const Feature& feature);
    /// Opacities higher by a part of the plot's height.
    std::function<double(double)> raisedBy(double height) const;
    /// The curve of a transfer function: what is straight in opacity is bent where the axis is.
    QPainterPath curveOf(const TransferFunction& tf) const;
    void nudge(double dx, double dHeight);
    void hover(const QPointF& position);
    void dragPoints(const QPointF& to, bool alongAxis);
    void dragFeature(const QPointF& to);
    void selectBand(const QRectF& band);
    void fillMenu(QMenu& menu, const QPointF& position);

    QFont smallFont() const; ///< of all words but the features' names
    void paintJointHistogram(QPainter& painter);
    void paintHistogram(QPainter& painter) const;
    void paintVisibility(QPainter& painter) const;
    void paintGradientAxis(QPainter& painter) const;
    void paintAxes(QPainter& painter) const;
    void paintOverview(QPainter& painter) const;
    void paintFeatures(QPainter& painter) const;
    void paintGhost(QPainter& painter) const;
    void paintCurve(QPainter& painter) const;
    void paintHair(QPainter& painter) const;
    void paintPoints(QPainter& painter) const;
    void paintTopLine(QPainter& painter) const;

    SessionStore& m_store;
    Results& m_results;
    Selection& m_selection;
    IntensityAxis m_axis;
    OpacityAxis m_opacityAxis;
    mutable VolumeCounts m_counts; // counts when asked
    std::function<const TransferFunction*()> m_ghost;
    HistogramScale m_scale = HistogramScale::Log;
    bool m_showJoint = false, m_readOnly = false, m_menuOpen = false;
    QString m_unit;
    PointSelection m_points;
    int m_hovered = -1;                 // a point
    std::optional<BarHit> m_hoveredBar; // a feature's
    std::optional<Drag> m_drag;
    QImage m_jointImage; // null: to be made
};

} // namespace pellucid::gui
