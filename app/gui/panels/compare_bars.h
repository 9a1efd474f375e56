// A figure of each feature in both states of a comparison, as bars below each other.
#pragma once

#include <optional>
#include <vector>

#include <QWidget>

#include "session/comparison.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

/// What the window calls a figure, see Terms.
QString nameOf(const ComparedFigure& figure);

/// Per feature the bar of A over that of B, both numbers and their difference. All bars have one scale.
class CompareBars : public QWidget, public Spoken {
    Q_OBJECT
public:
    explicit CompareBars(QWidget* parent);

    /// One of comparedFigures().
    void setFigure(std::size_t figure);
    /// `current`: else they are of an older state, and pale.
    void setPairs(std::vector<FeaturePair> pairs, bool current);
    void setCurrent(bool current);

    struct Values {
        std::optional<double> a, b; ///< empty: that side has none
    };
    std::vector<Values> values() const;
    bool isCurrent() const { return m_current; }
    QRectF barRect(std::size_t row, bool isB) const; ///< widget pixels; empty without a value

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override;
    QString spokenValue() const override;

protected:
    void paintEvent(QPaintEvent* event) override;
    bool event(QEvent* event) override; ///< tool tips

private:
    double rowHeight() const;
    QRectF trackRect(std::size_t row, bool isB) const;
    void paintRow(QPainter& painter, std::size_t row) const;

    std::vector<FeaturePair> m_pairs;
    std::size_t m_figure = 0;
    double m_top = 1; ///< value at the end of the bars
    bool m_current = false;
};

} // namespace pellucid::gui
