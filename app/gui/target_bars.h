// What each feature shows and what it should show: bars beside a target handle.
#pragma once

#include <QWidget>

#include "results.h"
#include "store/session_store.h"

namespace pellucid::gui {

/// Per feature a bar of its VWS and one of its visibility, with numbers, and a handle at its target that is dragged or
/// moved by keys (Up/Down choose the feature, Left/Right change its target).
class TargetBars : public QWidget {
    Q_OBJECT
public:
    TargetBars(SessionStore& store, Results& results, QWidget* parent = nullptr);

    /// Centre of a feature's handle, and where on its bar a share in [0,1] lies; widget pixels.
    QPointF handlePosition(int feature) const;
    double pixelOfShare(double share) const;
    void setReadOnly(bool on);
    int currentFeature() const { return m_current; }
    void setCurrentFeature(int feature); ///< −1: none is marked; emits nothing

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override;

Q_SIGNALS:
    void currentChanged(int feature); ///< by mouse or keys

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

private:
    int count() const;
    QRectF rowRect(int feature) const;
    QRectF trackRect(int feature) const; ///< where the bars lie
    int featureAtPosition(const QPointF& position) const;
    double shareAt(double pixelX) const;
    bool isHidden(int feature) const;
    void choose(int feature);

    SessionStore& m_store;
    Results& m_results;
    bool m_marked = false; ///< the current feature is one that was chosen
    int m_current = 0, m_dragged = -1, m_hovered = -1;
    bool m_readOnly = false;
    bool m_pressed = false; // this widget is making a change itself
};

} // namespace pellucid::gui
