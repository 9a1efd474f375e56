// What each feature shows and what it should show: bars beside a target handle.
#pragma once

#include <optional>

#include <QWidget>

#include "services/results.h"
#include "store/session_store.h"
#include "widgets/spoken_value.h"

class QLineEdit;

namespace pellucid::gui {

/// A share as people type it: "0.3", "0,3", "30 %". Empty: it is none from 0 to 1.
std::optional<double> shareFromText(const QString& text);

/// Per feature a bar of its VWS, its part by brightness plain and that by saturation striped, and one of its
/// visibility, with numbers; a handle at its target that is dragged, moved by keys (Up/Down choose the feature,
/// Left/Right change its target) or typed (double click on the number, Enter, a digit); and a lock (L) that holds the
/// target where others are set.
class TargetBars : public QWidget, public Spoken {
    Q_OBJECT
public:
    TargetBars(SessionStore& store, Results& results, QWidget* parent = nullptr);

    /// Centre of a feature's handle, and where on its bar a share in [0,1] lies; widget pixels.
    QPointF handlePosition(int feature) const;
    double pixelOfShare(double share) const;
    QRectF targetRect(int feature) const; ///< where the number of its target stands
    QRectF lockRect(int feature) const;
    QRectF vwsRect(int feature) const; ///< the track of its VWS
    QRectF rowRect(int feature) const;
    void setReadOnly(bool on);
    int currentFeature() const { return m_current; }
    void setCurrentFeature(int feature); ///< −1: none is marked; emits nothing

    /// Opens the box in which a target is typed, with `text` in it, or the present share where that is empty.
    void typeTarget(int feature, const QString& text = {});
    void toggleLock(int feature);

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override;
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

Q_SIGNALS:
    void currentChanged(int feature); ///< by mouse or keys

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override; ///< Escape and the focus of the box

private:
    int count() const;
    bool hasNamesAbove() const; ///< in a narrow panel, or where a name is long; else left of the bars
    double trackLeft() const;
    QRectF nameRect(int feature) const;
    double rowHeight() const;
    QRectF trackRect(int feature) const; ///< where the bars lie
    int featureAtPosition(const QPointF& position) const;
    double shareAt(double pixelX) const;
    bool isHidden(int feature) const;
    bool hasTarget(int feature) const; ///< it is neither hidden nor empty
    bool isLocked(int feature) const;
    bool canEdit(int feature) const;
    void choose(int feature);
    void takeTyped();
    void endTyping();
    QString tip(int feature) const;
    QRectF visibilityRect(int feature) const; ///< the track of its visibility
    void dragTo(double pixelX);
    void paintRow(QPainter& painter, int feature, const QFont& small, double target);
    void paintMeasures(QPainter& painter, int feature, const FeatureMeasures& measures, const QColor& color);
    void paintTarget(QPainter& painter, int feature, double target);

    SessionStore& m_store;
    Results& m_results;
    QLineEdit* m_box;      ///< shown while a target is typed
    int m_typed = -1;      ///< its feature
    bool m_marked = false; ///< the current feature is one that was chosen
    int m_current = 0, m_dragged = -1, m_hovered = -1;
    bool m_readOnly = false;
    bool m_pressed = false; // this widget is making a change itself
};

} // namespace pellucid::gui
