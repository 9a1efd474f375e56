// A plot of src/report as a widget and as a picture.
#pragma once

#include <span>

#include <QColor>
#include <QImage>
#include <QWidget>

#include "report/plot_drawing.h"
#include "widgets/spoken_value.h"

class QPainter;

namespace pellucid::gui {

/// What a plot is drawn in.
struct PlotColors {
    QColor text, faint, grid, shade, rim, ground;
};
PlotColors themePlotColors();
PlotColors paperPlotColors(); ///< dark on white, for files

void paintPlot(QPainter& painter, const Plot& plot, const PlotPage& page, const PlotColors& colors);
/// Plots below each other, each of `size` logical pixels, on white; `density` pixels for each.
QImage imageOf(std::span<const Plot> plots, const QSize& size, double density);
/// The same as a file, a PNG or SVG by its suffix. Throws UsageError for another one (a .csv is of who has the
/// numbers), FileError.
void writePlots(const std::string& file, std::span<const Plot> plots);

/// Draws a plot in the colours of the theme. The mouse reads values, and finds dots.
class PlotView : public QWidget, public Spoken {
    Q_OBJECT
public:
    explicit PlotView(QWidget* parent);

    void setPlot(Plot plot);
    const Plot& plot() const { return m_plot; }
    PlotBox box() const; ///< where its axes are, in the widget's pixels

    QSize sizeHint() const override { return {320, 200}; }
    QSize minimumSizeHint() const override { return {160, 110}; }
    QString spokenValue() const override;

Q_SIGNALS:
    void readOut(const QString& text); ///< the values under the mouse; empty where it has left
    void dotClicked(int series, int point);
    void exportWanted(); ///< a double click

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    PlotPage page() const;
    void readAt(double pixel);

    Plot m_plot;
    std::optional<double> m_hovered; ///< on the x axis
};

} // namespace pellucid::gui
