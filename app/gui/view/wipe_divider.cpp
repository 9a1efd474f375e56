#include "view/wipe_divider.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "controllers/comparison_controller.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kStep = 0.01, kFarStep = 0.1; // of the width

} // namespace

WipeDivider::WipeDivider(ComparisonController& comparing, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Slider), m_comparing(comparing) {
    setObjectName("wipeDivider");
    setAccessibleName(tr("Border between A and B"));
    setToolTip(tr("Drag it, or move it by the arrow keys"));
    setAttribute(Qt::WA_NoSystemBackground);
    setFocusPolicy(Qt::StrongFocus);
    setCursor(Qt::SplitHCursor);
    hide();
}

int WipeDivider::columnOf(int width) const { return static_cast<int>(std::lround(m_comparing.view().divider * width)); }

void WipeDivider::place(const QRect& picture) {
    m_picture = picture;
    setGeometry(picture.left() + columnOf(picture.width()) - kWidth / 2, picture.top(), kWidth, picture.height());
}

void WipeDivider::moveTo(double share) {
    m_comparing.change([share](ComparisonView& view) { view.divider = std::clamp(share, 0.0, 1.0); });
}

QString WipeDivider::spokenValue() const {
    return tr("A in the left %1 % of the picture, B in the rest").arg(100 * m_comparing.view().divider, 0, 'f', 0);
}

std::optional<SpokenNumber> WipeDivider::spokenNumber() {
    return SpokenNumber{100 * m_comparing.view().divider, 0, 100, 100 * kStep,
                        [this](double percent) { moveTo(percent / 100); }};
}

void WipeDivider::paintEvent(QPaintEvent*) {
    constexpr double kRadius = 6.5;
    QPainter painter(this);
    const double x = kWidth / 2;
    painter.fillRect(QRectF(x - 1, 0, 3, height()), QColor(0, 0, 0, 110));
    painter.fillRect(QRectF(x, 0, 1, height()), theme::kMark);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(QColor(0, 0, 0, 160), 1.5));
    painter.setBrush(hasFocus() ? theme::kMarkAccent : theme::kMark);
    painter.drawEllipse(QPointF(x + 0.5, height() / 2.0), kRadius, kRadius);
}

void WipeDivider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    m_held = true;
    m_grip = event->position().x() - kWidth / 2;
}

void WipeDivider::mouseMoveEvent(QMouseEvent* event) {
    if (!m_held || m_picture.width() <= 0) return;
    const double column = mapToParent(event->position()).x() - m_grip - m_picture.left();
    moveTo(column / m_picture.width());
}

void WipeDivider::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) m_held = false;
}

void WipeDivider::mouseDoubleClickEvent(QMouseEvent*) { moveTo(0.5); }

void WipeDivider::keyPressEvent(QKeyEvent* event) {
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? kFarStep : kStep;
    const double now = m_comparing.view().divider;
    switch (event->key()) {
    case Qt::Key_Left:
        return moveTo(now - step);
    case Qt::Key_Right:
        return moveTo(now + step);
    case Qt::Key_Home:
        return moveTo(0);
    case Qt::Key_End:
        return moveTo(1);
    default:
        QWidget::keyPressEvent(event);
    }
}

} // namespace pellucid::gui
