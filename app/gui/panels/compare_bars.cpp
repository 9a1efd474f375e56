#include "panels/compare_bars.h"

#include <algorithm>
#include <string_view>

#include <QHelpEvent>
#include <QPainter>

#include "widgets/controls.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kGap = 8, kLetter = 12;
constexpr double kPale = 0.45; // of figures of an older state
constexpr int kBar = 10;

QString percent(double value) { return QObject::tr("%1 %").arg(100 * value, 0, 'f', 1); }
QString percent(const std::optional<double>& value) { return value ? percent(*value) : QStringLiteral("–"); }
QString signedPercent(double value) {
    const QString sign = value > 0 ? QStringLiteral("+") : value < 0 ? QString(QChar(0x2212)) : QString();
    return sign + QObject::tr("%1 points").arg(100 * std::abs(value), 0, 'f', 1);
}

} // namespace

QString nameOf(const ComparedFigure& figure) {
    const std::string_view key = figure.key;
    if (key == "vws") return terms().attention();
    if (key == "visibility") return terms().visibility();
    if (key == "fs") return terms().pictureSaliency();
    const QString words = QString::fromUtf8(figure.words);
    return words.left(1).toUpper() + words.mid(1);
}

CompareBars::CompareBars(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Chart) {
    setObjectName("compareBars");
    setAccessibleName(tr("Figures of A and B"));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void CompareBars::setFigure(std::size_t figure) {
    m_figure = figure;
    m_top = 0;
    for (const Values& v : values()) m_top = std::max({m_top, v.a.value_or(0), v.b.value_or(0)});
    m_top = std::max(m_top, 1e-3);
    update();
}

void CompareBars::setPairs(std::vector<FeaturePair> pairs, bool current) {
    m_pairs = std::move(pairs);
    m_current = current;
    setFigure(m_figure);
    updateGeometry();
}

void CompareBars::setCurrent(bool current) {
    if (current != m_current) update();
    m_current = current;
}

std::vector<CompareBars::Values> CompareBars::values() const {
    const ComparedFigure& figure = comparedFigures()[m_figure];
    const auto valueOf = [&](const std::optional<FeatureFigures>& of) {
        return of ? figure.of(*of) : std::optional<double>();
    };
    std::vector<Values> all;
    for (const FeaturePair& pair : m_pairs) all.push_back({valueOf(pair.a), valueOf(pair.b)});
    return all;
}

double CompareBars::rowHeight() const { return fontMetrics().height() * 3.1 + kGap; }

QRectF CompareBars::trackRect(std::size_t row, bool isB) const {
    const QFontMetricsF metrics(font());
    const double line = metrics.height(), numbers = metrics.horizontalAdvance(percent(1)) + 6;
    const double top = static_cast<double>(row) * rowHeight() + line * (isB ? 2.05 : 1.05) + (line - kBar) / 2;
    const double left = kGap + kLetter;
    return {left, top, std::max(10.0, width() - left - kGap - numbers), kBar};
}

QRectF CompareBars::barRect(std::size_t row, bool isB) const {
    const Values v = values().at(row);
    const std::optional<double> value = isB ? v.b : v.a;
    if (!value) return {};
    QRectF bar = trackRect(row, isB);
    bar.setWidth(bar.width() * std::clamp(*value / m_top, 0.0, 1.0));
    return bar;
}

QSize CompareBars::sizeHint() const {
    return {280, static_cast<int>(rowHeight() * static_cast<double>(m_pairs.size()) + kGap)};
}

QSize CompareBars::minimumSizeHint() const { return {170, sizeHint().height()}; }

void CompareBars::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    for (std::size_t row = 0; row < m_pairs.size(); ++row) paintRow(painter, row);
}

void CompareBars::paintRow(QPainter& painter, std::size_t row) const {
    const FeaturePair& pair = m_pairs[row];
    const Values v = values()[row];
    const double line = QFontMetricsF(font()).height(), top = static_cast<double>(row) * rowHeight();
    const QRectF head(kGap, top, width() - 2 * kGap, line);
    const QColor text = m_current ? theme::kText : theme::kFaint;
    double room = head.width();
    painter.setPen(text);
    if (v.a && v.b) {
        const QString change = signedPercent(*v.b - *v.a);
        painter.drawText(head, Qt::AlignRight | Qt::AlignVCenter, change);
        room -= QFontMetricsF(font()).horizontalAdvance(change) + kGap;
    }
    const QString name = QString::fromStdString(pair.name) + (pair.isEmpty() ? tr(" (empty)") : QString());
    painter.drawText(head, Qt::AlignLeft | Qt::AlignVCenter,
                     QFontMetricsF(font()).elidedText(name, Qt::ElideRight, room));
    for (const bool isB : {false, true}) {
        const QRectF track = trackRect(row, isB);
        const QRectF around(0, track.center().y() - line / 2, width(), line);
        const std::optional<double> value = isB ? v.b : v.a;
        painter.setPen(theme::kFaint);
        painter.drawText(around.adjusted(kGap, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, isB ? "B" : "A");
        painter.setPen(text);
        painter.drawText(around.adjusted(0, 0, -kGap, 0), Qt::AlignRight | Qt::AlignVCenter, percent(value));
        painter.setPen(Qt::NoPen);
        painter.setBrush(theme::kTrack);
        painter.drawRoundedRect(track, 2, 2);
        if (!value) continue;
        const QColor color = seenOn(theme::kTrack, colorFromRgb((isB ? pair.b : pair.a)->color));
        painter.setBrush(translucent(color, m_current ? 1 : kPale));
        painter.drawRoundedRect(barRect(row, isB), 2, 2);
    }
}

QString CompareBars::spokenValue() const {
    if (m_pairs.empty()) return tr("Nothing is compared");
    QStringList parts;
    const std::vector<Values> all = values();
    for (std::size_t row = 0; row < all.size(); ++row)
        parts << tr("%1: A %2, B %3")
                     .arg(QString::fromStdString(m_pairs[row].name), percent(all[row].a), percent(all[row].b));
    return tr("%1 – %2").arg(nameOf(comparedFigures()[m_figure]), parts.join("; "));
}

bool CompareBars::event(QEvent* event) {
    const bool shown = showsTip(*event, *this, [this](const QPoint& at) -> QString {
        const auto row = static_cast<std::size_t>(at.y() / rowHeight());
        if (at.y() < 0 || row >= m_pairs.size()) return {};
        QStringList lines{QString::fromStdString(m_pairs[row].name)};
        for (const ComparedFigure& figure : comparedFigures()) {
            const auto text = [&](const std::optional<FeatureFigures>& of) {
                return percent(of ? figure.of(*of) : std::optional<double>());
            };
            lines << tr("%1: A %2, B %3").arg(nameOf(figure), text(m_pairs[row].a), text(m_pairs[row].b));
        }
        return lines.join('\n');
    });
    return shown || QWidget::event(event);
}

} // namespace pellucid::gui
