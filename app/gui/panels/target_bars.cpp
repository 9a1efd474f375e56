#include "panels/target_bars.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QLineEdit>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QScopedValueRollback>
#include <QToolTip>

#include "store/edits.h"
#include "widgets/controls.h"
#include "widgets/lock_mark.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kRow = 42, kLowRow = 34;               // height of a feature, pixels; of many features
constexpr int kMany = 8;                                // features that have the room of kRow each
constexpr int kHead = 20;                               // height of the legend
constexpr double kNow = 42, kTarget = 44, kLock = 22;   // widths right of the bars
constexpr double kNumbers = kNow + kTarget + kLock + 8; // together
constexpr double kName = 100, kNameLine = 17;           // its width left of the bars, its height above them
constexpr double kSwatch = 10, kSwatchLeft = 10, kNameLeft = 26;
constexpr int kWide = 340; // narrower widgets have the names above the bars, and others where a name needs it
constexpr double kVisibilityBar = 6;
constexpr double kStep = 0.01, kFarStep = 0.1; // of targets, by keys

QString share(double value) { return QString::number(value, 'f', 3); }

/// What of a VWS is that of brightness, from 0 to 1.
double brightnessPart(const FeatureMeasures& m, const VwsOptions& options) {
    double b = options.u1 * m.vwsBrightness, s = options.u2 * m.vwsSaturation;
    // An attribute that is nowhere salient has no say, the other one all of it.
    if (std::abs(b + s - m.vws) > 1e-9 && m.vwsSaturation == 0 && m.vwsBrightness > 0) s = 0;
    return b + s > 0 ? b / (b + s) : 1;
}

/// Colours that are hardly told from what is behind them have an outline.
void paintOutline(QPainter& painter, const QColor& ground, const QColor& color, const QRectF& box) {
    if (contrast(ground, color) >= kMarkContrast || box.width() < 1) return;
    painter.setPen(QPen(seenOn(ground, color), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 2, 2);
}

} // namespace

std::optional<double> shareFromText(const QString& text) {
    QString number = text.trimmed();
    const bool percent = number.endsWith('%');
    if (percent) number.chop(1);
    bool good = false;
    const double value = number.trimmed().replace(',', '.').toDouble(&good) / (percent ? 100 : 1);
    if (!good || !(value >= 0 && value <= 1)) return {};
    return value;
}

TargetBars::TargetBars(SessionStore& store, Results& results, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Slider), m_store(store), m_results(results),
      m_box(named(new QLineEdit(this), "targetBox",
                  tr("Share of attention from 0 to 1, or in per cent (\"30 %\").\nEnter sets it, Escape does not"))) {
    setObjectName("targetBars");
    setAccessibleName(tr("Attention on the features and their targets"));
    setWhatsThis(
        tr("How much of the attention each feature gets, and the target. Up and Down choose the feature, Left and "
           "Right change its target by 0.01."));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Minimum);
    m_box->setAlignment(Qt::AlignRight);
    m_box->hide();
    m_box->installEventFilter(this);
    connect(m_box, &QLineEdit::textEdited, this, [this](const QString& text) {
        m_box->setStyleSheet(shareFromText(text) ? QString() : QStringLiteral("color: %1").arg(theme::kFalls.name()));
    });
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        m_current = std::clamp(m_current, 0, std::max(0, count() - 1));
        // A change that this drag did not make ends it.
        if (m_dragged >= count() || !m_store.isPreviewing()) m_dragged = m_pressed ? m_dragged : -1;
        if (before.tf.features.size() != after.tf.features.size()) {
            m_hovered = m_dragged = -1;
            endTyping();
            updateGeometry();
        }
        update();
    });
    connect(&results, &Results::changed, this, qOverload<>(&TargetBars::update));
}

void TargetBars::setReadOnly(bool on) {
    m_readOnly = on;
    m_dragged = -1;
    if (on) endTyping();
    update();
}

int TargetBars::count() const { return static_cast<int>(m_store.scene().tf.features.size()); }
bool TargetBars::hasNamesAbove() const {
    if (width() < kWide) return true;
    const QFontMetricsF metrics(font());
    return std::ranges::any_of(m_store.scene().tf.features, [&](const Feature& feature) {
        return metrics.horizontalAdvance(QString::fromStdString(feature.name)) > kName - kNameLeft - 6;
    });
}
double TargetBars::trackLeft() const { return hasNamesAbove() ? kSwatchLeft : kName; }
double TargetBars::rowHeight() const { return count() > kMany ? kLowRow : kRow; }

bool TargetBars::isHidden(int feature) const {
    return m_store.scene().tf.features.at(static_cast<std::size_t>(feature)).hidden;
}

bool TargetBars::hasTarget(int feature) const {
    return !isHidden(feature) && !m_store.scene().isEmpty(static_cast<std::size_t>(feature));
}

bool TargetBars::isLocked(int feature) const {
    const FeatureGoals& goals = *m_store.session().goals;
    const auto goal = goals.find(m_store.scene().tf.features.at(static_cast<std::size_t>(feature)).id);
    return goal != goals.end() && goal->second.targetLocked;
}

bool TargetBars::canEdit(int feature) const {
    return !m_readOnly && feature >= 0 && feature < count() && hasTarget(feature);
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

QSize TargetBars::sizeHint() const { return {320, kHead + static_cast<int>(rowHeight()) * std::max(1, count()) + 4}; }
QSize TargetBars::minimumSizeHint() const { return {240, sizeHint().height()}; }

QRectF TargetBars::rowRect(int feature) const {
    return {0, kHead + feature * rowHeight(), static_cast<double>(width()), rowHeight()};
}

QRectF TargetBars::trackRect(int feature) const {
    const double gap = count() > kMany || hasNamesAbove() ? 4 : 8;
    return rowRect(feature).adjusted(trackLeft(), hasNamesAbove() ? kNameLine : gap, -kNumbers, -gap);
}

QRectF TargetBars::nameRect(int feature) const {
    const QRectF row = rowRect(feature), track = trackRect(feature);
    return hasNamesAbove() ? QRectF(kNameLeft, row.top() + 1, track.right() - kNameLeft, kNameLine - 1)
                           : QRectF(kNameLeft, row.top(), kName - kNameLeft - 6, row.height());
}

QRectF TargetBars::vwsRect(int feature) const {
    const QRectF track = trackRect(feature);
    return {track.left(), track.top() + 1, track.width(), track.height() - kVisibilityBar - 5};
}

QRectF TargetBars::visibilityRect(int feature) const {
    const QRectF track = trackRect(feature);
    return {track.left(), track.bottom() - kVisibilityBar - 1, track.width(), kVisibilityBar};
}

QRectF TargetBars::lockRect(int feature) const {
    const QRectF row = rowRect(feature);
    return {row.right() - kLock - 2, row.center().y() - kLock / 2, kLock, kLock};
}

QRectF TargetBars::targetRect(int feature) const {
    const QRectF row = rowRect(feature);
    return {row.right() - kLock - 2 - kTarget, row.center().y() - 11, kTarget, 22};
}

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
    const int row = static_cast<int>(std::floor((position.y() - kHead) / rowHeight()));
    return row >= 0 && row < count() ? row : -1;
}

void TargetBars::toggleLock(int feature) {
    if (!canEdit(feature)) return;
    setTargetLocked(m_store, feature, !isLocked(feature));
}

void TargetBars::typeTarget(int feature, const QString& text) {
    if (!m_readOnly && !isHidden(feature) && !hasTarget(feature)) {
        const QPoint below = targetRect(feature).bottomLeft().toPoint();
        QToolTip::showText(mapToGlobal(below), emptyFeatureText(m_store.scene(), feature), this);
    }
    if (!canEdit(feature)) return;
    m_store.commit();
    choose(feature);
    m_typed = feature;
    m_box->setStyleSheet({});
    m_box->setGeometry(targetRect(feature).adjusted(-8, -1, 4, 1).toRect());
    m_box->setText(text.isEmpty() ? share(m_store.scene().targets().at(static_cast<std::size_t>(feature))) : text);
    m_box->show();
    m_box->setFocus();
    if (text.isEmpty()) m_box->selectAll();
}

void TargetBars::takeTyped() {
    const std::optional<double> value = shareFromText(m_box->text());
    if (!value) {
        QToolTip::showText(m_box->mapToGlobal(QPoint(0, m_box->height())), m_box->toolTip(), m_box);
        return; // it stays open
    }
    const int feature = m_typed;
    const bool edited = m_box->text() != share(m_store.scene().targets().at(static_cast<std::size_t>(feature)));
    endTyping();
    if (edited) editTarget(m_store, feature, *value, tr("Target of feature"));
}

void TargetBars::endTyping() {
    if (m_typed < 0) return;
    m_typed = -1;
    const bool hadFocus = m_box->hasFocus();
    m_box->hide();
    if (hadFocus) setFocus();
    update();
}

bool TargetBars::eventFilter(QObject* watched, QEvent* event) {
    if (watched == m_box && m_typed >= 0) {
        if (event->type() == QEvent::KeyPress) {
            switch (static_cast<QKeyEvent*>(event)->key()) {
            case Qt::Key_Return:
            case Qt::Key_Enter:
                takeTyped();
                return true;
            case Qt::Key_Escape:
                endTyping();
                return true;
            case Qt::Key_Up: // of another feature
            case Qt::Key_Down:
                return true;
            default:
                break;
            }
        }
        if (event->type() == QEvent::FocusOut && static_cast<QFocusEvent*>(event)->reason() != Qt::PopupFocusReason) {
            if (shareFromText(m_box->text()))
                takeTyped();
            else
                endTyping();
        }
    }
    return QWidget::eventFilter(watched, event);
}

void TargetBars::mousePressEvent(QMouseEvent* event) {
    const int feature = featureAtPosition(event->position());
    if (feature < 0 || event->button() != Qt::LeftButton) return event->ignore();
    choose(feature);
    if (lockRect(feature).contains(event->position())) return toggleLock(feature);
    const QRectF reach = trackRect(feature).adjusted(-10, -8, 10, 8);
    if (!canEdit(feature) || !reach.contains(event->position())) return;
    m_dragged = feature;
    // A press beside the handle brings it there, as a press on a slider's groove does in most people's hands.
    if (std::abs(event->position().x() - handlePosition(feature).x()) > 8) dragTo(event->position().x());
}

void TargetBars::dragTo(double pixelX) {
    const QScopedValueRollback pressed(m_pressed, true);
    previewTarget(m_store, m_dragged, shareAt(pixelX), tr("Target of feature"));
}

void TargetBars::mouseDoubleClickEvent(QMouseEvent* event) {
    const int feature = featureAtPosition(event->position());
    if (feature < 0 || event->button() != Qt::LeftButton) return event->ignore();
    if (lockRect(feature).contains(event->position())) return mousePressEvent(event);
    if (event->position().x() > trackRect(feature).right() + 10) return typeTarget(feature);
    mousePressEvent(event);
}

void TargetBars::mouseMoveEvent(QMouseEvent* event) {
    if (m_dragged >= 0) return dragTo(event->position().x());
    const int row = featureAtPosition(event->position());
    const int hovered =
        row >= 0 && canEdit(row) && std::abs(event->position().x() - handlePosition(row).x()) < 8 ? row : -1;
    const bool onLock = row >= 0 && canEdit(row) && lockRect(row).contains(event->position());
    const bool onNumber = row >= 0 && canEdit(row) && targetRect(row).contains(event->position());
    setCursor(hovered >= 0 ? Qt::SizeHorCursor
              : onLock     ? Qt::PointingHandCursor
              : onNumber   ? Qt::IBeamCursor
                           : Qt::ArrowCursor);
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
    const double step = event->modifiers().testFlag(Qt::ShiftModifier) ? kFarStep : kStep;
    const double target = m_store.scene().targets().at(static_cast<std::size_t>(m_current));
    const auto move = [&](double by) {
        if (canEdit(m_current))
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
    case Qt::Key_Return:
    case Qt::Key_Enter:
        return typeTarget(m_current);
    case Qt::Key_L:
        return toggleLock(m_current);
    default:
        break;
    }
    const QString text = event->text();
    if (text.size() == 1 && (text[0].isDigit() || text[0] == '.' || text[0] == ',')) return typeTarget(m_current, text);
    QWidget::keyPressEvent(event);
}

bool TargetBars::event(QEvent* event) {
    // Where the bars have the focus, L is theirs and not the light's.
    if (event->type() == QEvent::ShortcutOverride) {
        const auto* key = static_cast<QKeyEvent*>(event);
        if (key->modifiers() != Qt::NoModifier || key->key() != Qt::Key_L || count() == 0) return QWidget::event(event);
        event->accept();
        return true;
    }
    const auto textAt = [this](const QPoint& at) {
        const int feature = featureAtPosition(at);
        if (feature < 0) return QString();
        return lockRect(feature).contains(at)
                   ? tr("Lock: this target stays where others are set (L). An optimization still moves the\n"
                        "feature's opacity; to hold that, lock the opacity in the feature's menu")
                   : tip(feature);
    };
    return showsTip(*event, *this, textAt) || QWidget::event(event);
}

QString TargetBars::tip(int feature) const {
    const auto f = static_cast<std::size_t>(feature);
    QString text = QString::fromStdString(m_store.scene().tf.features[f].name);
    if (const Measures* m = m_results.measures(); m && f < m->features.size()) {
        const FeatureMeasures& now = m->features[f];
        const double b = brightnessPart(now, m_store.session().measure->vws);
        text += tr("\nattention (VWS) %1 = %2 by brightness + %3 by saturation\nseen (visibility) %4")
                    .arg(share(now.vws), share(now.vws * b), share(now.vws * (1 - b)), share(now.visibility));
    }
    if (m_store.scene().isEmpty(f)) return text + "\n" + emptyFeatureText(m_store.scene(), feature);
    if (hasTarget(feature)) text += tr(", target %1").arg(share(m_store.scene().targets()[f]));
    return text +
           tr("\n\nThick bar: attention, the feature's share of what catches the eye (VWS, 0 to 1); striped: by\n"
              "saturation\n"
              "Thin bar: seen, the share of the picture that the feature makes up (visibility, 0 to 1)\n"
              "Handle: the attention that Optimize aims at; the targets add up to 1.\n"
              "Drag it, press Left and Right (Shift: larger steps), or type it: double click, Enter, a digit");
}

QString TargetBars::spokenValue() const {
    if (count() == 0) return tr("The curve has no features");
    const auto f = static_cast<std::size_t>(m_current);
    QStringList parts;
    if (const Measures* m = m_results.measures(); m && f < m->features.size())
        parts << (m_results.vwsIsCurrent() ? tr("%1 of the attention now")
                                           : tr("%1 of the attention before the change"))
                     .arg(share(m->features[f].vws))
              << tr("%1 of what is seen").arg(share(m->features[f].visibility));
    if (hasTarget(m_current))
        parts << tr("target %1").arg(share(m_store.scene().targets()[f]));
    else
        parts << (isHidden(m_current) ? tr("hidden") : tr("empty"));
    if (hasTarget(m_current) && isLocked(m_current)) parts << tr("locked");
    return tr("%1: %2; feature %3 of %4")
        .arg(QString::fromStdString(m_store.scene().tf.features[f].name), parts.join(", "))
        .arg(m_current + 1)
        .arg(count());
}

std::optional<SpokenNumber> TargetBars::spokenNumber() {
    if (!canEdit(m_current)) return {};
    return SpokenNumber{
        .now = m_store.scene().targets()[static_cast<std::size_t>(m_current)],
        .step = kStep,
        .set = [this](double target) { editTarget(m_store, m_current, target, tr("Target of feature")); }};
}

void TargetBars::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * 0.85);
    const QFontMetricsF metrics(small);
    painter.setFont(small);
    painter.setPen(theme::kFaint);
    const double head = kHead - 4, room = width() - trackLeft() - kNumbers;
    painter.drawText(
        QRectF(trackLeft(), 2, room, head), Qt::AlignLeft | Qt::AlignVCenter,
        metrics.elidedText(terms().areScientific() ? tr("VWS · thin: visibility") : tr("attention · thin: seen"),
                           Qt::ElideRight, room));
    const double left = width() - 2 - kLock - kTarget;
    painter.drawText(QRectF(left - kNow, 2, kNow, head), Qt::AlignRight | Qt::AlignVCenter, tr("now"));
    painter.drawText(QRectF(left, 2, kTarget, head), Qt::AlignRight | Qt::AlignVCenter, tr("target"));
    if (count() == 0) {
        painter.drawText(QRectF(0, kHead, width(), kRow), Qt::AlignCenter, tr("The curve has no features"));
        return;
    }
    const std::vector<double> targets = m_store.scene().targets();
    for (int i = 0; i < count(); ++i) paintRow(painter, i, small, targets[static_cast<std::size_t>(i)]);
}

void TargetBars::paintRow(QPainter& painter, int i, const QFont& small, double target) {
    const auto f = static_cast<std::size_t>(i);
    const Feature& feature = m_store.scene().tf.features[f];
    const QRectF row = rowRect(i), name = nameRect(i);
    painter.setPen(Qt::NoPen);
    if (i == m_current && (m_marked || hasFocus())) {
        painter.setBrush(theme::kHover);
        painter.drawRoundedRect(row.adjusted(3, 1, -3, -1), 4, 4);
    }
    const QColor color = translucent(colorFromRgb(feature.color), hasTarget(i) ? 1 : 0.35);
    const QRectF swatch(kSwatchLeft, name.center().y() - kSwatch / 2, kSwatch, kSwatch);
    painter.setBrush(color);
    painter.drawRoundedRect(swatch, 2, 2);
    if (!feature.hidden) paintOutline(painter, theme::kWindow, color, swatch);
    painter.setFont(font());
    painter.setPen(hasTarget(i) ? theme::kText : theme::kFaint);
    painter.drawText(
        name, Qt::AlignVCenter | Qt::AlignLeft,
        QFontMetricsF(font()).elidedText(QString::fromStdString(feature.name), Qt::ElideMiddle, name.width()));
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme::kTrack);
    painter.drawRoundedRect(vwsRect(i), 2, 2);
    painter.drawRoundedRect(visibilityRect(i), 2, 2);
    painter.setFont(small);
    if (const Measures* const measures = m_results.measures(); measures && f < measures->features.size())
        paintMeasures(painter, i, measures->features[f], color);
    paintTarget(painter, i, target);
}

/// Its bars and numbers; faint where they are of an older state and being measured anew.
void TargetBars::paintMeasures(QPainter& painter, int i, const FeatureMeasures& m, const QColor& color) {
    const bool current = m_results.vwsIsCurrent();
    const double strength = current ? 1.0 : 0.45, thinStrength = m_results.measuresAreCurrent() ? 0.55 : 0.25;
    const QRectF row = rowRect(i), vws = vwsRect(i), visibility = visibilityRect(i);
    const QRectF bar(vws.topLeft(), QSizeF(vws.width() * std::clamp(m.vws, 0.0, 1.0), vws.height()));
    const double b = bar.width() * brightnessPart(m, m_store.session().measure->vws);
    const QColor fill = translucent(color, strength);
    QPainterPath shape;
    shape.addRoundedRect(bar, 2, 2);
    painter.save();
    painter.setClipPath(shape);
    painter.fillRect(QRectF(bar.left(), bar.top(), b, bar.height()), fill);
    const QRectF saturation(bar.left() + b, bar.top(), bar.width() - b, bar.height());
    painter.fillRect(saturation, translucent(color, 0.35 * strength));
    painter.setClipRect(saturation, Qt::IntersectClip);
    painter.setPen(QPen(fill, 2));
    for (double x = saturation.left() - bar.height(); x < saturation.right(); x += 5)
        painter.drawLine(QPointF(x, bar.bottom()), QPointF(x + bar.height(), bar.top()));
    painter.restore();
    paintOutline(painter, theme::kTrack, color, bar);
    painter.setPen(Qt::NoPen);
    painter.setBrush(translucent(color, thinStrength));
    painter.drawRoundedRect(QRectF(visibility.topLeft(), QSizeF(visibility.width() * m.visibility, kVisibilityBar)), 2,
                            2);
    painter.setPen(current ? theme::kText : theme::kFaint);
    const double half = std::min(QFontMetricsF(painter.font()).height() * 0.95, row.height() / 2);
    const QRectF now(targetRect(i).left() - kNow, row.center().y() - half, kNow, half);
    painter.drawText(now, Qt::AlignRight | Qt::AlignVCenter, share(m.vws));
    painter.setPen(theme::kFaint);
    painter.drawText(now.translated(0, half), Qt::AlignRight | Qt::AlignVCenter, share(m.visibility));
}

void TargetBars::paintTarget(QPainter& painter, int i, double target) {
    if (!hasTarget(i)) { // it is aimed at nothing
        painter.setPen(theme::kFaint);
        painter.drawText(targetRect(i), Qt::AlignRight | Qt::AlignVCenter, QStringLiteral("–"));
        return;
    }
    const QRectF track = trackRect(i);
    const bool locked = isLocked(i), active = i == m_dragged || i == m_hovered;
    painter.setPen(QPen(QColor(0, 0, 0, 160), 1));
    painter.setBrush(m_readOnly ? theme::kFaint : active ? theme::kAccent.lighter(130) : theme::kKnob);
    const double reach = track.height() / 2 + 1;
    painter.drawRoundedRect(QRectF(pixelOfShare(target) - 2.5, track.center().y() - reach, 5, 2 * reach), 2.5, 2.5);
    painter.setPen(theme::kText);
    painter.drawText(targetRect(i), Qt::AlignRight | Qt::AlignVCenter, share(target));
    paintLock(painter, lockRect(i).center(), locked, locked ? theme::kText : theme::kFaint);
}

} // namespace pellucid::gui
