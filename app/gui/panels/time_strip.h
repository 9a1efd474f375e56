// Intensities over time: a histogram of each frame, one beside the other, to be taken hold of.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QWidget>

#include "volume/time_series.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

/// What stands at a frame.
struct FrameMark {
    bool tfKey = false, targetKey = false;
    bool adapted = false; ///< a transfer function was made for it
    bool stale = false;   ///< of other inputs than the present ones
    bool held = false;    ///< it would be shown at once
    QString problem;      ///< why it cannot be shown; empty: it can
    bool operator==(const FrameMark&) const = default;
};

/// Frames from left to right, intensities from below (0) to above (1); how many voxels of a frame have an intensity is
/// told by brightness, logarithmically. Frames that are not known yet are empty. A press or drag asks for a frame.
class TimeStrip : public QWidget, public Spoken {
    Q_OBJECT
public:
    explicit TimeStrip(QWidget* parent = nullptr);

    /// `window`: values of intensity 0 and 1. Null: nothing.
    void setSeries(std::shared_ptr<const TimeSeries> series, const ValueRange& window);
    void setFrame(int frame, std::optional<int> awaited);
    void setMarks(std::vector<FrameMark> marks);
    void refresh(); ///< more frames may be known

    int frameAt(double x) const;                        ///< the nearest one
    QRectF rectOf(int frame) const;                     ///< its column, in pixels of the widget
    const QImage& histogram() const { return m_image; } ///< a pixel per frame and bin, intensity 0 below

    QSize sizeHint() const override { return {600, 84}; }
    QSize minimumSizeHint() const override { return {160, 48}; }
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

Q_SIGNALS:
    void frameWanted(int frame);
    void stepWanted(int frames);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    QRectF plot() const;
    int count() const { return m_series ? m_series->size() : 0; }
    void draw();
    QString tipAt(const QPointF& at) const;
    QStringList marksOf(int frame) const; ///< in words
    void paintState(QPainter& painter, int frame) const;
    void paintKeys(QPainter& painter, int frame) const;

    std::shared_ptr<const TimeSeries> m_series;
    ValueRange m_window;
    std::vector<std::vector<double>> m_counts; ///< by frame; empty: not known yet
    std::vector<FrameMark> m_marks;
    QImage m_image;
    int m_frame = 0, m_hovered = -1;
    std::optional<int> m_awaited;
    bool m_dragging = false;
};

} // namespace pellucid::gui
