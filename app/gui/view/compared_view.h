// B beside A: the picture of what the present state is compared with.
#pragma once

#include <memory>

#include <QWidget>

#include "view/camera_hand.h"
#include "view/view_surface.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

class ComparisonController;
class VolumeView;

/// Drawn as the view of A is, by OpenGL or the CPU, and live as it is. Of a wipe it is as large as A's picture, and
/// seen through this widget. Its hand turns A too where both share the view.
class ComparedView : public QWidget, public Spoken {
    Q_OBJECT
public:
    /// Both outlive this.
    ComparedView(ComparisonController& comparing, VolumeView& viewOfA, QWidget* parent);
    ~ComparedView() override;

    /// Where the whole picture lies, and how much of it is seen; both in the parent's pixels.
    void place(const QRect& picture, const QRect& seen);
    bool isComplete() const { return m_surface && m_surface->picture().complete; }
    /// Follows whether a picture is wanted, and which: from now on it is `shown`.
    void setShown(bool shown);

    QSize minimumSizeHint() const override { return {80, 50}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void pictureShown();

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    class Overlay;
    void follow();
    void makeSurface();

    ComparisonController& m_comparing;
    VolumeView& m_viewOfA;
    CameraHand m_hand;
    std::unique_ptr<ViewSurface> m_surface; ///< null while nothing is shown
    Overlay* m_overlay;
    QRect m_picture; ///< in this widget's pixels
    bool m_drawsByGl = false, m_failed = false;
};

/// What a side is called, in the middle of the upper edge of `area`.
void paintSideName(class QPainter& painter, const QRectF& area, const QString& name);

} // namespace pellucid::gui
