// The middle of the window: the volume and the slices beside it.
#pragma once

#include <array>

#include <QWidget>

#include "jobs/job.h"
#include "session/session.h"
#include "view/slice_pane.h"
#include "view/volume_view.h"

namespace pellucid::gui {

class ComparedView;
class ComparisonController;
class RulerController;
class SliceBar;
class WipeDivider;

/// Arranges the volume and the three slices as the session's layout says. The gaps between them can be dragged; one
/// view can be made to fill all of it for a while, which is no part of the session. Views never change their parent:
/// OpenGL would have to begin anew.
class ViewGrid : public QWidget {
    Q_OBJECT
    Lane m_lane; // draws slices; outlives the panes, which are children
public:
    /// `fields` says what slices show in the place of the data, `rulers` what is measured in them. All outlive this.
    ViewGrid(Services& services, const FieldController& fields, RulerController& rulers, VolumeView& volume,
             ComparisonController& comparing, QWidget* parent = nullptr);
    ~ViewGrid() override;

    VolumeView& volume() { return m_volume; }
    ComparedView& compared() { return *m_compared; } ///< beside the volume, or over a part of it
    SlicePane& pane(int worldAxis) { return *m_panes.at(static_cast<std::size_t>(worldAxis)); }
    /// Every view that is shown is of the present state, and as good as it gets.
    bool isComplete() const;
    void maximize(SlicePane* pane); ///< null: none

    QSize sizeHint() const override { return m_volume.sizeHint(); }
    QSize minimumSizeHint() const override { return m_volume.minimumSizeHint(); }

Q_SIGNALS:
    void slicesShown(); ///< isComplete() may have changed

protected:
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

private:
    enum Gap { Upright = 1, Level = 2, SecondLevel = 4 }; ///< bits: where two cross both are taken
    void arrange();
    void placeVolume(const QRect& place); ///< with B, where there is something to compare with
    void followComparison();
    QRect area() const; ///< of the views, below the bar
    int gapsAt(const QPoint& point) const;
    SliceViews::Layout layoutNow() const;

    Services& m_services;
    VolumeView& m_volume;
    ComparisonController& m_comparing;
    ComparedView* m_compared;
    WipeDivider* m_divider;
    CompareMode m_compareMode = CompareMode::Off; ///< that is arranged
    double m_arrangedDivider = 0;
    SliceBar* m_bar;
    std::array<SlicePane*, 3> m_panes; // by world axis
    SlicePane* m_alone = nullptr;
    SliceViews::Layout m_arranged = SliceViews::Layout::Volume;
    // Where the gaps are, as shares of the area.
    double m_fourX = 0.5, m_fourY = 0.5, m_largeX = 0.7;
    std::array<double, 2> m_largeY{1 / 3.0, 2 / 3.0};
    int m_dragged = 0; ///< bits of Gap
};

} // namespace pellucid::gui
