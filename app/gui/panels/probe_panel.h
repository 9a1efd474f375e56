// What a click on the picture shows: a plot of the ray, and each feature's share of the pixel.
#pragma once

#include <QFrame>

class QLabel;
class QPushButton;
class QScrollArea;

namespace pellucid::gui {

class ProbeController;
class ProbePlot;
class ProbeShares;
class VolumeView;
class Services;

/// Lies over the view while the probe is active, in a corner away from the click; it can be dragged elsewhere.
class ProbePanel : public QFrame {
    Q_OBJECT
public:
    ProbePanel(Services& services, ProbeController& probe, VolumeView& view);

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void refresh();
    void refreshText();
    void keepInView();

    Services& m_services;
    ProbeController& m_probe;
    VolumeView& m_view;
    QLabel *m_title, *m_readout, *m_text, *m_hint;
    ProbePlot* m_plot;
    ProbeShares* m_shares;
    QScrollArea* m_scroll;
    QPushButton *m_more, *m_less;
    QPointF m_clicked; ///< in the view
    QPoint m_grip;     ///< where the hand has taken hold of it
    bool m_held = false;
};

/// The panel, and the mark over the picture.
void addProbe(Services& services, ProbeController& probe, VolumeView& view);

} // namespace pellucid::gui
