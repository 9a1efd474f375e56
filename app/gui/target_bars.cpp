#include "target_bars.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "store/edits.h"
#include "theme.h"

namespace pellucid::gui {
namespace {

constexpr int kRow = 42;                           // height of a feature, pixels
constexpr int kHead = 20;                          // height of the legend
constexpr double kName = 104, kNumbers = 100;      // width left and right of the bars
constexpr double kVwsBar = 13, kVisibilityBar = 6; // heights

QString share(double value) { return QString::number(value, 'f', 3); }

} // namespace

TargetBars::TargetBars(SessionStore& store, Results& results, QWidget* parent)
    : QWidget(parent), m_store(store), m_results(results) {
    setObjectName("targetBars");
    setAccessibleName(tr("Saliency of the features and their targets"));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Minimum);
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        m_current = std::clamp(m_current, 0, std::max(0, count() - 1));
        // A change that this drag did not make ends it.
        if (m_dragged >= count() || !m_store.isPreviewing()) m_dragged = m_pressed ? m_dragged : -1;
        if (before.tf.features.size() != after.tf.features.size()) {
            m_hovered = m_dragged = -1;
            updateGeometry();
        }
        update();
    });
    connect(&results, &Results::changed, this, qOverload<>(&TargetBars::update));
}

void TargetBars::setReadOnly(bool on) {
    m_readOnly = on;
    m_dragged = -1;
    update();
}

int TargetBars::count() const { return static_cast<int>(m_store.scene().tf.features.size()); }

bool TargetBars::isHidden(int feature) const {
    return m_store.scene().tf.features.at(static_cast<std::size_t>(feature)).hidden;
}

void TargetBars::setCurrentFeature(int feature) {
    m_marked = feature >= 0;
    if (m_marked) m_current = std::min(feature, std::max(0, count() - 1));
    update();
}

void TargetBars::choose(int feature) {
    m_current = feature;
    m_marked = true;
    update();
    Q_EMIT currentChanged(feature);
}

QSize TargetBars::sizeHint() const { return {320, kHead + kRow * std::max(1, count()) + 4}; }
QSize TargetBars::minimumSizeHint() const { return {280, kHead + kRow * std::max(1, count()) + 4}; }

QRectF TargetBars::rowRect(int feature) const {
    return {0, static_cast<double>(kHead + feature * kRow), static_cast<double>(width()), static_cast<double>(kRow)};
}

QRectF TargetBars::trackRect(int feature) const { return rowRect(feature).adjusted(kName, 8, -kNumbers, -8); }

double TargetBars::pixelOfShare(double value) const {
    const QRectF track = trackRect(0);
    return track.left() + value * track.width();
}

double TargetBars::shareAt(double pixelX) const {
    const QRectF track = trackRect(0);
    return std::clamp((pixelX - track.left()) / std::max(1.0, track.width()), 0.0, 1.0);
}

QPointF TargetBars::handlePosition(int feature) const {
    const QRectF track = trackRect(feature);
    return {pixelOfShare(m_store.scene().targets().at(static_cast<std::size_t>(feature))), track.center().y()};
}

int TargetBars::featureAtPosition(const QPointF& position) const {
    const int row = static_cast<int>(std::floor((position.y() - kHead) / kRow));
    return row >= 0 && row < count() ? row : -1;
}

void TargetBars::mousePressEvent(QMouseEvent* event) {
    const int feature = featureAtPosition(event->position());
    if (feature < 0 || event->button() != Qt::LeftButton) return event->ignore();
    choose(feature);
    const QRectF reach = trackRect(feature).adjusted(-10, -8, 10, 8);
    if (m_readOnly || isHidden(feature) || !reach.contains(event->position())) return;
    m_dragged = feature;
    m_pressed = true;
    // A press beside the handle brings it there, as a press on a slider's groove does in most people's hands.
    if (std::abs(event->position().x() - handlePosition(feature).x()) > 8)
        previewTarget(m_store, feature, shareAt(event->position().x()), tr("Target of feature"));
    m_pressed = false;
}

void TargetBars::mouseMoveEvent(QMouseEvent* event) {
    if (m_dragged >= 0) {
        m_pressed = true;
        previewTarget(m_store, m_dragged, shareAt(event->position().x()), tr("Target of feature"));
        m_pressed = false;
        return;
    }
    const int row = featureAtPosition(event->position());
    const int hovered =
        row >= 0 && !m_readOnly && !isHidden(row) && std::abs(event->position().x() - handlePosition(row).x()) < 8 ? row
                                                                                                                   : -1;
    setCursor(hovered >= 0 ? Qt::SizeHorCursor : Qt::ArrowCursor);
    if (hovered != m_hovered) {
        m_hovered = hovered;
        update();
    }
}

void TargetBars::mouseReleaseEvent(QMouseEvent*) {
    if (m_dragged >= 0) m_store.commit();
    m_dragged = -1;
    update();
}

void TargetBars::leaveEvent(QEvent*) {
    m_hovered = -1;
    update();
}

void TargetBars::keyPressEvent(QKeyEvent* event) {
    if (count() == 0) return QWidget::keyPressEvent(event);
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? 0.1 : 0.01;
    const double target = m_store.scene().targets().at(static_cast<std::size_t>(m_current));
    const auto move = [&](double by) {
        if (!m_readOnly && !isHidden(m_current))
            editTarget(m_store, m_current, target + by, tr("Target of feature"),
                       QStringLiteral("target-%1").arg(m_current));
    };
    switch (event->key()) {
    case Qt::Key_Up:
        return choose(std::max(0, m_current - 1));
    case Qt::Key_Down:
        return choose(std::min(count() - 1, m_current + 1));
    case Qt::Key_Left:
        return move(-step);
    case Qt::Key_Right:
        return move(step);
    default:
        QWidget::keyPressEvent(event);
    }
}

bool TargetBars::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const int feature = featureAtPosition(help->pos());
    if (feature < 0) {
        QToolTip::hideText();
        return true;
    }
    QToolTip::showText(help->globalPos(),
                       tr("Thick bar: VWS, the feature's share of what catches the eye (0 to 1)\n"
                          "Thin bar: its visibility, the share of the picture that it makes (0 to 1)\n"
                          "Handle: the VWS that Optimize aims at; the targets add up to 1.\n"
                          "Drag it, or press Left and Right (Shift: larger steps)"),
                       this);
    return true;
}

void TargetBars::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.85);
    const QFontMetricsF metrics(small);
    painter.setFont(small);
    painter.setPen(theme::kFaint);
    const QRectF head(0, 2, width(), kHead - 4);
    const QRectF numbers(width() - kNumbers + 8, head.top(), (kNumbers - 14) / 2, head.height());
    painter.drawText(head.adjusted(kName, 0, -kNumbers, 0), Qt::AlignLeft | Qt::AlignVCenter,
                     metrics.elidedText(tr("VWS; thin: visibility"), Qt::ElideRight, width() - kName - kNumbers));
    painter.drawText(numbers, Qt::AlignRight | Qt::AlignVCenter, tr("now"));
    painter.drawText(numbers.translated(numbers.width(), 0), Qt::AlignRight | Qt::AlignVCenter, tr("target"));
    if (count() == 0) {
        painter.drawText(QRectF(0, kHead, width(), kRow), Qt::AlignCenter, tr("The curve has no features"));
        return;
    }

    const Measures* const measures = m_results.measures();
    const std::vector<double> targets = m_store.scene().targets();
    // Faint: of an older state, being measured anew.
    const double strength = m_results.vwsIsCurrent() ? 1.0 : 0.45;
    const double thinStrength = m_results.measuresAreCurrent() ? 0.55 : 0.25;
    for (int i = 0; i < count(); ++i) {
        const auto f = static_cast<std::size_t>(i);
        const Feature& feature = m_store.scene().tf.features[f];
        const QRectF row = rowRect(i), track = trackRect(i);
        if (i == m_current && (m_marked || hasFocus())) {
            painter.setPen(Qt::NoPen);
            painter.setBrush(theme::kHover);
            painter.drawRoundedRect(row.adjusted(3, 2, -3, -2), 4, 4);
        }
        QColor color = colorFromRgb(feature.color);
        if (feature.hidden) color.setAlphaF(0.35F);
        painter.setPen(Qt::NoPen);
        painter.setBrush(color);
        painter.drawRoundedRect(QRectF(10, track.center().y() - 5, 10, 10), 2, 2);
        painter.setFont(font());
        painter.setPen(feature.hidden ? theme::kFaint : theme::kText);
        painter.drawText(
            QRectF(26, row.top(), kName - 32, row.height()), Qt::AlignVCenter | Qt::AlignLeft,
            QFontMetricsF(font()).elidedText(QString::fromStdString(feature.name), Qt::ElideRight, kName - 32));
        painter.setPen(Qt::NoPen);
        const QRectF vwsTrack(track.left(), track.top() + 2, track.width(), kVwsBar);
        const QRectF visTrack(track.left(), vwsTrack.bottom() + 3, track.width(), kVisibilityBar);
        painter.setBrush(theme::kTrack);
        painter.drawRoundedRect(vwsTrack, 2, 2);
        painter.drawRoundedRect(visTrack, 2, 2);
        painter.setFont(small);
        if (measures && f < measures->features.size()) {
            const FeatureMeasures& m = measures->features[f];
            QColor fill = color;
            fill.setAlphaF(static_cast<float>(strength));
            painter.setBrush(fill);
            painter.drawRoundedRect(QRectF(vwsTrack.topLeft(), QSizeF(vwsTrack.width() * m.vws, kVwsBar)), 2, 2);
            fill.setAlphaF(static_cast<float>(thinStrength));
            painter.setBrush(fill);
            painter.drawRoundedRect(QRectF(visTrack.topLeft(), QSizeF(visTrack.width() * m.visibility, kVisibilityBar)),
                                    2, 2);
            painter.setPen(strength < 1 ? theme::kFaint : theme::kText);
            const double half = metrics.height() * 0.95;
            const QRectF now(numbers.left(), row.center().y() - half, numbers.width(), half);
            painter.drawText(now, Qt::AlignRight | Qt::AlignVCenter, share(m.vws));
            painter.setPen(theme::kFaint);
            painter.drawText(now.translated(0, half), Qt::AlignRight | Qt::AlignVCenter, share(m.visibility));
        }
        const QRectF target(numbers.left() + numbers.width(), row.top(), numbers.width(), row.height());
        if (feature.hidden) { // it is aimed at nothing
            painter.setPen(theme::kFaint);
            painter.drawText(target, Qt::AlignRight | Qt::AlignVCenter, QStringLiteral("–"));
            continue;
        }
        const QPointF handle = handlePosition(i);
        const bool active = i == m_dragged || i == m_hovered;
        painter.setPen(QPen(QColor(0, 0, 0, 160), 1));
        painter.setBrush(m_readOnly ? theme::kFaint : active ? theme::kAccent.lighter(130) : theme::kKnob);
        const double reach = track.height() / 2 + 1;
        painter.drawRoundedRect(QRectF(handle.x() - 2.5, handle.y() - reach, 5, 2 * reach), 2.5, 2.5);
        painter.setPen(theme::kText);
        painter.drawText(target, Qt::AlignRight | Qt::AlignVCenter, share(targets[f]));
    }
}

} // namespace pellucid::gui
