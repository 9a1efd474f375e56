// Texts that may be too long for their place: shortened in the middle, and whole in the tool tip.
#pragma once

#include <QLabel>

class QAbstractItemView;

namespace pellucid::gui {

/// A label of one line of plain text.
class ElidedLabel : public QLabel {
public:
    using QLabel::QLabel;
    bool isElided() const;
    QSize minimumSizeHint() const override { return {0, QLabel::minimumSizeHint().height()}; }

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
};

/// The names in a list or table lose their middle where the column is too narrow, since what tells them apart is often
/// at their ends. The tool tip of a cell that shows less than its text begins with all of it.
void elideInTheMiddle(QAbstractItemView& view);

} // namespace pellucid::gui
