// The colours of the transfer function along the intensity axis: a click prioritizes an intensity.
#pragma once

#include <optional>

#include <QWidget>

#include "tf/tf_canvas.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

class RefineController;
class Services;

/// A click refines for the intensity under the mouse (thesis 3.4.3), a drag goes on doing so. The marker shows what is
/// prioritized.
class PaletteBar : public QWidget, public Spoken {
    Q_OBJECT
public:
    /// Lies in the canvas, in its strip(), and follows its axis.
    PaletteBar(Services& services, RefineController& refining, TfCanvas& canvas);

    /// The middle of the place of an intensity, widget pixels.
    QPointF positionOf(double intensity) const;
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    bool event(QEvent* event) override;

private:
    void place();
    QRectF strip() const; ///< of the colours
    double intensityAt(const QPointF& position) const;
    QString valueText(double intensity) const;
    std::optional<double> marked() const;

    Services& m_services;
    RefineController& m_refining;
    TfCanvas& m_canvas;
    bool m_dragging = false;
    std::optional<double> m_hovered;
};

} // namespace pellucid::gui
