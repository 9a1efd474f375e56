// One slice beside the picture, and the hands that move through it.
#pragma once

#include <optional>

#include <QImage>
#include <QWidget>

#include "jobs/job.h"
#include "session/slice_input.h"
#include "store/session_store.h"
#include "view/ruler_layer.h"
#include "widgets/spoken_value.h"

class QToolButton;

namespace pellucid::gui {

class FieldController;
class Services;

/// Of the crosshair's lines, the titles and the planes in the volume: one for each world axis that a slice is
/// perpendicular to. Colour-blind eyes can tell them apart.
QColor slicePlaneColor(int worldAxis);

/// The slice of the store's volume, or of the field in its place, that is perpendicular to one world axis (nearly,
/// where the volume lies obliquely), through the crosshair. Zoom and pan are its own and no part of the session. Drawn
/// off the window's thread; coarse while it changes where that takes long.
class SlicePane : public QWidget, public Spoken {
    Q_OBJECT
public:
    /// `fields` says what is drawn in the place of the data, `rulers` what is measured. `lane` draws the slices of all
    /// panes, one after the other; all outlive this.
    SlicePane(Services& services, const FieldController& fields, RulerController& rulers, int worldAxis, Lane& lane,
              QWidget* parent = nullptr);

    int worldAxis() const { return m_worldAxis; }
    int axis() const; ///< the index axis; there is a volume
    /// What is shown, in logical pixels of this widget.
    SlicePlane plane() const;
    /// What is drawn is of the present state, and as good as it gets; or nothing is wanted.
    bool isComplete() const { return isHidden() || m_complete; }

    /// What lies under the mouse.
    struct Hovered {
        Vec3 voxel{0}, world{0};            ///< voxel coordinates, and the same in the world
        std::optional<double> value;        ///< of the nearest voxel, data units; empty where it is invalid
        std::optional<double> field;        ///< of the nearest voxel, where a field is drawn
        std::optional<double> overlay = {}; ///< of the place, where it has one
    };
    const std::optional<Hovered>& hovered() const { return m_hovered; }
    QString hoverText() const; ///< value of the field, value, feature, place; empty where nothing is
    QString titleText() const; ///< a line for the plane; where a field is wanted, one for it and one for its state

    /// Where the right, left, upper and lower edge lie: in the patient (L R A P S I), else along the file's axes.
    QStringList edgeLetters() const;

    void fit();
    void setMaximized(bool on); ///< how the button looks
    QSize minimumSizeHint() const override { return {110, 90}; }
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

Q_SIGNALS:
    void pictureShown();   ///< isComplete() may have changed
    void maximizeWanted(); ///< alone, or back

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

private:
    enum class Motion { None, Crosshair, Pan, Window, Ruler };
    struct Request {
        SliceInput input;
        SlicePlane plane;    ///< in device pixels
        bool coarse = false; ///< at half the resolution
        bool operator==(const Request&) const = default;
    };
    struct Drawn {
        QImage image;
        double seconds = 0;
    };
    static Drawn drawn(const Request& request);

    void follow(const Scene& before, const Scene& after);
    void request();
    void show(const Request& request, const Drawn& drawn);
    SlicePlane planeOfSize(int width, int height) const;
    void zoomAbout(const QPointF& point, double factor);
    void pan(const QPointF& way);
    void step(int slices);
    Vec3 voxelAt(const QPointF& point) const;
    Vec3 worldAt(const QPointF& point) const;
    void moveCrosshairTo(const QPointF& point);
    void dragWindow(const QPointF& way);
    void hover(const std::optional<QPointF>& point);
    void cancelDrag();
    bool onTitle(const QPointF& point) const;
    void paintTitle(QPainter& painter) const;
    void paintLegend(QPainter& painter) const;
    std::vector<RulerHandle> rulerHandles() const;
    void pressLeft(const QMouseEvent& event);
    void paintRulers(QPainter& painter, const SlicePlane& plane) const;
    void paintCrosshair(QPainter& painter, const SlicePlane& plane) const;
    void paintLetters(QPainter& painter) const;
    void paintScale(QPainter& painter, const SlicePlane& plane) const;

    Services& m_services;
    const FieldController& m_fields;
    RulerController& m_rulers;
    RulerHand m_rulerHand;
    const int m_worldAxis;
    QToolButton* m_maximize;
    double m_zoom = 1;            ///< 1: the whole plane
    std::optional<Vec2> m_center; ///< of what is shown, as SliceRect counts; empty: of the plane
    Request m_wanted;
    bool m_complete = false, m_slow = false;
    QImage m_image;
    Motion m_motion = Motion::None;
    Qt::MouseButton m_button = Qt::NoButton;
    bool m_moved = false;
    QPointF m_pressed, m_last;
    std::optional<Vec3> m_crosshairBefore; ///< of the drag, or of the first click of two
    std::optional<ValueRange> m_windowBefore;
    int m_wheel = 0; ///< eighths of degrees that are no whole notch yet
    std::optional<QPointF> m_mouse;
    std::optional<Hovered> m_hovered;
    Job<Request, Drawn> m_job; // last: it ends before the rest goes
};

} // namespace pellucid::gui
