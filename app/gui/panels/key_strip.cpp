#include "panels/key_strip.h"

#include <algorithm>
#include <cmath>

#include <QApplication>
#include <QMouseEvent>
#include <QPainter>

#include "widgets/controls.h"
#include "widgets/input_habits.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kMargin = 8, kScale = 24, kFoot = 10; ///< pixels: at the sides, the scale above, the marks below
constexpr double kHandle = 9;                          ///< pixels, of the playhead, below the labels of the scale
constexpr double kShape = 4.0 / 3;                     ///< width of a picture over its height
constexpr double kGap = 4;                             ///< pixels between pictures, at least
constexpr double kStep = 0.1, kLongStep = 1;           ///< s, of a key of the keyboard
constexpr double kLeastSpan = 4;                       ///< s
constexpr double kMark = 5;                            ///< pixels, of half a diamond

/// Times as they are dragged: hundredths of a second.
double rounded(double seconds) { return std::round(100 * seconds) / 100; }

QString secondsText(double seconds) {
    QString text = QString::number(seconds, 'f', 2);
    while (text.endsWith('0')) text.chop(1);
    if (text.endsWith('.')) text.chop(1);
    return text;
}

} // namespace

QString easingText(Easing easing) {
    switch (easing) {
    case Easing::Linear:
        return QObject::tr("evenly");
    case Easing::Smooth:
        return QObject::tr("from rest to rest");
    case Easing::EaseIn:
        return QObject::tr("start slowly");
    case Easing::EaseOut:
        return QObject::tr("end slowly");
    case Easing::Hold:
        return QObject::tr("stay, then jump");
    }
    return {};
}

QString keyText(const Keyframes& keys, int key) {
    const Keyframe& k = keys.at(static_cast<std::size_t>(key));
    const QString text = QObject::tr("Key %1 at %2 s").arg(key + 1).arg(secondsText(k.time));
    return k.name.empty() ? text : QStringLiteral("%1: %2").arg(text, QString::fromStdString(k.name));
}

KeyStrip::KeyStrip(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Slider) {
    setObjectName("keyStrip");
    setAccessibleName(tr("Keyframes along time"));
    setWhatsThis(
        tr("The keys of a film along time, with pictures of them and of what lies between. Drag the scale to see the "
           "film in the view; click a key to select it, drag it to give it another time.\n"
           "← and → move the playhead by 0.1 s, with Shift by 1 s; Home and End go to the first and the last key, Page "
           "up and Page down from key to key; Ctrl+← and Ctrl+→ move the selected key by 0.1 s; Insert adds a key, "
           "Delete removes the selected one; the space bar plays; Esc while it plays goes back to what was shown "
           "before."));
    setProperty(kKeepsSpace, true);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

// ---- where what is

QRectF KeyStrip::scaleRect() const { return {kMargin, 0, std::max(1.0, width() - 2 * kMargin), kScale}; }

QRectF KeyStrip::band() const {
    return {kMargin, kScale + 2, std::max(1.0, width() - 2 * kMargin), std::max(8.0, height() - kScale - 2 - kFoot)};
}

double KeyStrip::xOf(double time) const { return kMargin + time / m_span * band().width(); }

double KeyStrip::timeAt(double x) const { return std::clamp((x - kMargin) / band().width(), 0.0, 1.0) * m_span; }

void KeyStrip::place() {
    if (m_hold == Hold::None) // what is held stays under the mouse
        m_span = std::min(std::max(kLeastSpan, m_keys.empty() ? 0 : 1.2 * m_keys.back().time), kMostFilmSeconds);
    const QRectF all = band();
    const double width = std::min(all.height() * kShape, all.width());
    std::vector<Slot> slots;
    for (std::size_t n = 0; n < m_keys.size(); ++n) {
        const double left = std::clamp(xOf(m_keys[n].time) - width / 2, all.left(), all.right() - width);
        slots.push_back({m_keys[n].time, {left, all.top(), width, all.height()}, static_cast<int>(n)});
    }
    for (std::size_t n = 0; n + 1 < m_keys.size(); ++n) {
        const double from = slots[n].rect.right(), room = slots[n + 1].rect.left() - from;
        const int count = static_cast<int>((room - kGap) / (width + kGap));
        const double rest = (room - count * width) / (count + 1);
        for (int i = 0; i < count; ++i) {
            const double left = from + rest + i * (width + rest);
            slots.push_back({timeAt(left + width / 2), {left, all.top(), width, all.height()}});
        }
    }
    // A key's picture goes where the key goes; the others are of what they were.
    for (Slot& slot : slots)
        for (const Slot& old : m_slots)
            if (std::abs(old.time - slot.time) < kSameKeyTime && (old.key < 0) == (slot.key < 0)) {
                slot.picture = old.picture;
                break;
            }
    m_slots = std::move(slots);
    update();
    if (std::ranges::any_of(m_slots, [](const Slot& slot) { return slot.picture.isNull(); })) Q_EMIT picturesWanted();
}

void KeyStrip::setKeys(const Keyframes& keys, int selected) {
    if (selected != m_selected) update();
    m_selected = selected;
    if (keys == m_keys) return;
    // Pictures of keys that are as they were stay with them; what lies between is another one.
    std::vector<Slot> kept;
    for (std::size_t n = 0; n < keys.size(); ++n)
        for (std::size_t old = 0; old < m_keys.size(); ++old)
            if (m_keys[old].state == keys[n].state) {
                kept.push_back({keys[n].time, {}, static_cast<int>(n), m_slots[old].picture});
                break;
            }
    m_keys = keys;
    m_slots = std::move(kept);
    place();
}

void KeyStrip::setPlayhead(double time) {
    if (time == m_playhead) return;
    m_playhead = time;
    update();
}

void KeyStrip::setEditable(bool editable) { m_editable = editable; }

void KeyStrip::setPicture(double time, const QImage& picture) {
    for (Slot& slot : m_slots)
        if (std::abs(slot.time - time) < kSameKeyTime) slot.picture = picture;
    update();
}

void KeyStrip::forgetPictures() {
    for (Slot& slot : m_slots) slot.picture = {};
    if (!m_slots.empty()) Q_EMIT picturesWanted();
}

int KeyStrip::keyAt(const QPointF& at) const {
    const auto near = [&](std::size_t n) {
        const double x = xOf(m_keys[n].time);
        return m_slots[n].rect.contains(at) || (at.y() > band().bottom() && std::abs(at.x() - x) <= kMark + 1);
    };
    if (m_selected >= 0 && near(static_cast<std::size_t>(m_selected))) return m_selected; // it lies on top
    for (std::size_t n = m_keys.size(); n-- > 0;)
        if (near(n)) return static_cast<int>(n);
    return -1;
}

// ---- how it looks

void KeyStrip::paintScale(QPainter& painter) const {
    const QRectF r = scaleRect();
    painter.setPen(QPen(theme::kLine, 1));
    painter.drawLine(r.bottomLeft(), r.bottomRight());
    double step = 0.5; // s between two labels
    for (const double next : {1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0})
        if (xOf(step) - xOf(0) < 52) step = next;
    const QFontMetrics metrics = painter.fontMetrics();
    for (int n = 0; n * step <= m_span + 1e-9; ++n) {
        const double x = xOf(n * step);
        painter.setPen(QPen(theme::kLine, 1));
        painter.drawLine(QPointF(x, r.bottom() - 4), QPointF(x, r.bottom()));
        const QString text = n == 0 ? QStringLiteral("0 s") : secondsText(n * step);
        const double wide = metrics.horizontalAdvance(text);
        const double left = std::clamp(x - wide / 2, 0.0, width() - wide);
        painter.setPen(theme::kFaint);
        painter.drawText(QPointF(left, r.top() + metrics.ascent()), text);
    }
}

void KeyStrip::paintPicture(QPainter& painter, const Slot& slot) const {
    if (slot.picture.isNull())
        painter.fillRect(slot.rect, theme::kTrack);
    else
        painter.drawImage(slot.rect, slot.picture);
    if (slot.key < 0) return;
    const bool chosen = slot.key == m_selected;
    painter.setPen(QPen(chosen ? theme::kAccent : theme::kText, chosen ? 2 : 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(slot.rect.adjusted(0.5, 0.5, -0.5, -0.5));
}

void KeyStrip::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    QFont small = font();
    if (small.pixelSize() > 0)
        small.setPixelSize(std::max(9, small.pixelSize() - 2));
    else
        small.setPointSizeF(small.pointSizeF() - 1.5);
    painter.setFont(small);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const QRectF all = band();
    painter.fillRect(all, theme::kPanel);
    paintScale(painter);
    if (m_keys.empty()) {
        painter.setFont(font());
        painter.setPen(theme::kFaint);
        painter.drawText(all.adjusted(6, 0, -6, 0), Qt::AlignCenter | Qt::TextWordWrap,
                         tr("No keys yet. Add key keeps what is shown now; turn the view or change anything, and add "
                            "the next one."));
    }
    for (const Slot& slot : m_slots)
        if (slot.key < 0) paintPicture(painter, slot);
    for (const Slot& slot : m_slots)
        if (slot.key >= 0 && slot.key != m_selected) paintPicture(painter, slot);
    if (m_selected >= 0 && m_selected < static_cast<int>(m_keys.size()))
        paintPicture(painter, m_slots[static_cast<std::size_t>(m_selected)]);
    painter.setRenderHint(QPainter::Antialiasing);
    const double y = all.bottom() + kFoot / 2;
    for (int n = 0; n < static_cast<int>(m_keys.size()); ++n) {
        const double x = xOf(m_keys[static_cast<std::size_t>(n)].time);
        painter.setPen(QPen(theme::kKnob, 1.2));
        painter.setBrush(n == m_selected ? theme::kAccent : theme::kPanel);
        painter.drawPolygon(QPolygonF{{x - kMark, y}, {x, y - kMark}, {x + kMark, y}, {x, y + kMark}});
    }
    const double x = xOf(std::min(m_playhead, m_span));
    painter.setPen(QPen(theme::kAccent, 2));
    painter.drawLine(QPointF(x, kScale - 4), QPointF(x, all.bottom()));
    painter.setPen(QPen(theme::kKnob, 1));
    painter.setBrush(theme::kAccent);
    painter.drawPolygon(QPolygonF{{x - 5, kScale - kHandle}, {x + 5, kScale - kHandle}, {x, kScale}});
    if (hasFocus()) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(theme::kAccent, 1));
        painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    }
}

QString KeyStrip::tipAt(const QPointF& at) const {
    const int key = keyAt(at);
    if (key < 0) return tr("%1 s").arg(secondsText(timeAt(at.x())));
    return wordsOf(key).join('\n');
}

QStringList KeyStrip::wordsOf(int key) const {
    QStringList words{keyText(m_keys, key)};
    if (key + 1 < static_cast<int>(m_keys.size()))
        words << tr("to the next key: %1").arg(easingText(m_keys[static_cast<std::size_t>(key)].easing));
    return words;
}

QString KeyStrip::spokenValue() const {
    const int count = static_cast<int>(m_keys.size());
    QStringList parts{count == 0   ? tr("no keys yet")
                      : count == 1 ? tr("1 key")
                                   : tr("%1 keys").arg(count),
                      tr("playhead at %1 s").arg(secondsText(m_playhead))};
    if (m_selected >= 0 && m_selected < count) parts << tr("selected: %1").arg(wordsOf(m_selected).join(", "));
    return parts.join("; ");
}

std::optional<SpokenNumber> KeyStrip::spokenNumber() {
    if (!m_editable || m_keys.empty()) return {};
    return SpokenNumber{m_playhead, 0, m_span, kStep, [this](double time) { Q_EMIT stepWanted(time - m_playhead); }};
}

bool KeyStrip::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride) { // keys of the strip are no other's while it has the focus
        constexpr int kOwn[] = {Qt::Key_Left, Qt::Key_Right,  Qt::Key_PageUp, Qt::Key_PageDown, Qt::Key_Home,
                                Qt::Key_End,  Qt::Key_Insert, Qt::Key_Delete, Qt::Key_Escape};
        const auto* const key = static_cast<QKeyEvent*>(event);
        if (!key->modifiers().testFlag(Qt::AltModifier) && std::ranges::find(kOwn, key->key()) != std::end(kOwn))
            event->accept();
    }
    return showsTip(*event, *this, [this](const QPoint& at) { return tipAt(at); }) || QWidget::event(event);
}

void KeyStrip::resizeEvent(QResizeEvent*) {
    const QSizeF before = m_slots.empty() ? QSizeF() : m_slots.front().rect.size();
    place();
    // Pictures are drawn for their size.
    if (!m_slots.empty() && m_slots.front().rect.size() != before) Q_EMIT picturesWanted();
}

// ---- what the hand does

void KeyStrip::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !m_editable) return event->ignore();
    m_pressed = event->position();
    m_held = m_pressed.y() < band().top() ? -1 : keyAt(m_pressed);
    m_hold = m_held >= 0 ? Hold::Key : Hold::Playhead;
    if (m_held >= 0) {
        m_grip = timeAt(m_pressed.x()) - m_keys[static_cast<std::size_t>(m_held)].time;
        Q_EMIT keySelected(m_held);
    } else {
        Q_EMIT playheadMoved(rounded(timeAt(m_pressed.x())));
    }
}

void KeyStrip::mouseMoveEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    if (m_hold == Hold::Key && std::abs(at.x() - m_pressed.x()) >= QApplication::startDragDistance() / 2.0)
        m_hold = Hold::MovingKey;
    if (m_hold == Hold::MovingKey) Q_EMIT keyDragged(m_held, rounded(timeAt(at.x()) - m_grip));
    if (m_hold == Hold::Playhead) Q_EMIT playheadMoved(rounded(timeAt(at.x())));
}

void KeyStrip::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    const Hold was = std::exchange(m_hold, Hold::None);
    if (was == Hold::MovingKey) Q_EMIT keyDropped();
    if (was == Hold::Playhead) Q_EMIT playheadRested();
    place();
}

void KeyStrip::keyPressEvent(QKeyEvent* event) {
    const bool moves = event->modifiers().testFlag(Qt::ControlModifier);
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? kLongStep : kStep;
    const auto aside = [&](double by) {
        if (!moves) return Q_EMIT stepWanted(by);
        if (m_selected >= 0) Q_EMIT keyTimeWanted(m_keys[static_cast<std::size_t>(m_selected)].time + by);
    };
    if (event->key() == Qt::Key_Escape) {
        m_hold = Hold::None;
        return Q_EMIT givenUp();
    }
    if (!m_editable) return QWidget::keyPressEvent(event);
    switch (event->key()) {
    case Qt::Key_Left:
        return aside(-step);
    case Qt::Key_Right:
        return aside(step);
    case Qt::Key_PageUp:
        return Q_EMIT keyStepWanted(-1);
    case Qt::Key_PageDown:
        return Q_EMIT keyStepWanted(1);
    case Qt::Key_Home:
        return Q_EMIT keyStepWanted(-static_cast<int>(kMostKeyframes));
    case Qt::Key_End:
        return Q_EMIT keyStepWanted(static_cast<int>(kMostKeyframes));
    case Qt::Key_Insert:
        return Q_EMIT addWanted();
    case Qt::Key_Delete:
        return Q_EMIT removeWanted();
    case Qt::Key_Space:
        return Q_EMIT playWanted();
    default:
        return QWidget::keyPressEvent(event);
    }
}

} // namespace pellucid::gui
