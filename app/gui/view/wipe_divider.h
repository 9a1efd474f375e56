// The border between A and B of a wipe, which mouse and keys move.
#pragma once

#include <QWidget>

#include "widgets/spoken_value.h"

namespace pellucid::gui {

class ComparisonController;

/// A drag, Left and Right (ten times as far with Shift), Home and End move it; a double click puts it in the middle.
class WipeDivider : public QWidget, public Spoken {
    Q_OBJECT
public:
    static constexpr int kWidth = 17; ///< of what can be taken hold of, pixels

    /// `comparing` outlives this.
    WipeDivider(ComparisonController& comparing, QWidget* parent);
    /// Over the border of a picture that lies there, in the parent's pixels.
    void place(const QRect& picture);
    /// First column of B in a picture so wide.
    int columnOf(int width) const;
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    void moveTo(double share);

    ComparisonController& m_comparing;
    QRect m_picture;
    double m_grip = 0; ///< where it was taken hold of, from the border
    bool m_held = false;
};

} // namespace pellucid::gui
