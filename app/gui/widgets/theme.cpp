#include "widgets/theme.h"

#include "widgets/menu_icons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QApplication>
#include <QGuiApplication>
#include <QLabel>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QStyleFactory>
#include <QStyleHints>
#include <QStyleOption>

namespace pellucid::gui {
namespace {

// Those that only this file needs.
QColor s_disabled, s_shadow, s_notice, s_noticeLine, s_noticeText;

struct ThemeColor {
    QColor& color;
    QRgb dark, light;
};
const ThemeColor kColors[] = {{theme::kWindow, 0xff262729, 0xfff1f2f3},    {theme::kPanel, 0xff1c1d1f, 0xffffffff},
                              {theme::kRaised, 0xff35373a, 0xffe6e8ea},    {theme::kTitle, 0xff2e3033, 0xffe0e2e5},
                              {theme::kLine, 0xff45474b, 0xffb4b8be},      {theme::kText, 0xffe4e5e7, 0xff1b1d20},
                              {theme::kFaint, 0xffa3a6ac, 0xff585c62},     {theme::kAccent, 0xff4c9aff, 0xff1667c9},
                              {theme::kTrack, 0xff1c1d1f, 0xffcdd0d5}, // white features are seen on the light one
                              {theme::kHistogram, 0xff44474c, 0xffcdd1d6}, {theme::kCurve, 0xffd8dade, 0xff2b2e33},
                              {theme::kKnob, 0xffffffff, 0xff3a3d42},      {theme::kHover, 0x0effffff, 0x10000000},
                              {theme::kFalls, 0xffd97a2b, 0xffb8651b},     {s_disabled, 0xff74767a, 0xff83868c},
                              {s_shadow, 0xff0a0a0b, 0xff8a8d92},          {s_notice, 0xff4a3f22, 0xfffff3cf},
                              {s_noticeLine, 0xff6b5a2d, 0xffdfc878},      {s_noticeText, 0xfff2e3b8, 0xff4d3c05}};

Theme s_applied = Theme::Dark;

bool systemIsLight() {
#if QT_VERSION >= QT_VERSION_CHECK(6, 5, 0)
    const Qt::ColorScheme scheme = QGuiApplication::styleHints()->colorScheme();
    if (scheme != Qt::ColorScheme::Unknown) return scheme == Qt::ColorScheme::Light;
#endif
    // What the desktop gives a program before it has colours of its own.
    static const bool s_light = QGuiApplication::palette().color(QPalette::Window).lightness() >= 128;
    return s_light;
}

double luminance(const QColor& color) {
    const auto linear = [](double v) { return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

/// Fusion, with check boxes and buttons that are on which can be told from others on any ground.
class PlainFusion : public QProxyStyle {
public:
    PlainFusion() : QProxyStyle(QStyleFactory::create("Fusion")) {}

    int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                  QStyleHintReturn* returned) const override {
        if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
        return QProxyStyle::styleHint(hint, option, widget, returned);
    }

    /// Tool bars without a rim: their room is the picture's.
    int pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const override {
        if (metric == PM_ToolBarItemMargin || metric == PM_ToolBarFrameWidth) return 0;
        if (metric == PM_SmallIconSize && widget != nullptr)
            if (const QSize icons = widget->property(kMenuIconSize).toSize(); icons.isValid()) return icons.width();
        return QProxyStyle::pixelMetric(metric, option, widget);
    }

    void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                       const QWidget* widget) const override {
        if (element == PE_PanelButtonCommand && option->state.testFlag(State_On) &&
            option->state.testFlag(State_Enabled)) {
            painter->save();
            painter->setRenderHint(QPainter::Antialiasing);
            painter->setPen(Qt::NoPen);
            painter->setBrush(theme::kAccent);
            painter->drawRoundedRect(QRectF(option->rect).adjusted(0.5, 0.5, -0.5, -0.5), 2.5, 2.5);
            painter->restore();
            return;
        }
        if (element != PE_IndicatorCheckBox) return QProxyStyle::drawPrimitive(element, option, painter, widget);
        const bool enabled = option->state.testFlag(State_Enabled), on = option->state.testFlag(State_On);
        const QRectF box = QRectF(option->rect).adjusted(1.5, 1.5, -1.5, -1.5);
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        const QColor line =
            option->state.testFlag(State_MouseOver) ? theme::kAccent : QColor(0x7a, 0x7d, 0x83); // seen on both
        painter->setPen(QPen(enabled ? line : theme::kLine, 1));
        painter->setBrush(on && enabled ? theme::kAccent.darker(130) : theme::kPanel);
        painter->drawRoundedRect(box, 2.5, 2.5);
        if (on) {
            painter->setPen(QPen(enabled ? QColor(Qt::white) : theme::kFaint, 1.8));
            const auto at = [&](double x, double y) {
                return QPointF(box.left() + x * box.width(), box.top() + y * box.height());
            };
            painter->setBrush(Qt::NoBrush);
            painter->drawPolyline(QPolygonF{at(0.22, 0.52), at(0.43, 0.73), at(0.78, 0.28)});
        }
        painter->restore();
    }

    void drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
        const bool on = option->state.testFlag(State_On) && option->state.testFlag(State_Enabled);
        const auto drawLit = [&](auto lit) {
            lit.palette.setColor(QPalette::ButtonText, theme::kPanel);
            QProxyStyle::drawControl(element, &lit, painter, widget);
        };
        if (const auto* tool = qstyleoption_cast<const QStyleOptionToolButton*>(option);
            on && tool != nullptr && element == CE_ToolButtonLabel)
            return drawLit(*tool);
        if (const auto* push = qstyleoption_cast<const QStyleOptionButton*>(option);
            on && push != nullptr && element == CE_PushButtonLabel)
            return drawLit(*push);
        QProxyStyle::drawControl(element, option, painter, widget);
    }
};

QPalette paletteOf(bool light) {
    const QColor highlight = light ? theme::kAccent : theme::kAccent.darker(130); // under white
    const std::pair<QPalette::ColorRole, QColor> roles[] = {
        {QPalette::Window, theme::kWindow},
        {QPalette::WindowText, theme::kText},
        {QPalette::Base, theme::kPanel},
        {QPalette::AlternateBase, theme::kWindow},
        {QPalette::ToolTipBase, theme::kRaised},
        {QPalette::ToolTipText, theme::kText},
        {QPalette::PlaceholderText, theme::kFaint},
        {QPalette::Text, theme::kText},
        {QPalette::Button, theme::kRaised},
        {QPalette::ButtonText, theme::kText},
        {QPalette::BrightText, Qt::white},
        {QPalette::Link, theme::kAccent},
        {QPalette::Highlight, highlight},
        {QPalette::HighlightedText, Qt::white},
        {QPalette::Light, theme::kRaised.lighter(light ? 106 : 115)},
        {QPalette::Midlight, theme::kRaised},
        {QPalette::Mid, theme::kLine},
        {QPalette::Dark, light ? theme::kLine.darker(115) : theme::kPanel.darker(130)},
        {QPalette::Shadow, s_shadow}};
    QPalette palette;
    for (const auto& [role, color] : roles) palette.setColor(role, color);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, s_disabled);
    palette.setColor(QPalette::Disabled, QPalette::Highlight, theme::kLine);
    return palette;
}

QString styleSheetOf(bool light) {
    const QColor& separator = light ? theme::kTitle : theme::kPanel;
    return QStringLiteral("QToolTip { color: %1; background: %2; border: 1px solid %3; padding: 3px; }"
                          "QMainWindow::separator { background: %4; width: 4px; height: 4px; }"
                          "QMainWindow::separator:hover { background: %5; }")
               .arg(theme::kText.name(), theme::kRaised.name(), theme::kLine.name(), separator.name(),
                    theme::kAccent.name()) +
           QStringLiteral("QStatusBar::item { border: none; }"
                          "QStatusBar QLabel { color: %1; padding: 0 6px; }"
                          "#noticeBar { background: %2; border: 1px solid %3; border-radius: 4px; }"
                          "#noticeBar QLabel { color: %4; }"
                          "QHeaderView::section { background: %5; color: %1; border: none; padding: 3px 6px; }"
                          "QTableView { border: none; gridline-color: %5; }")
               .arg(theme::kFaint.name(), s_notice.name(), s_noticeLine.name(), s_noticeText.name(),
                    theme::kTitle.name());
}

} // namespace

void applyTheme(QApplication& application, Theme theme) {
    const bool systemLight = systemIsLight(); // before the first palette of ours
    s_applied = theme;
    const bool light = theme == Theme::Light || (theme == Theme::System && systemLight);
    for (const ThemeColor& c : kColors) c.color = QColor::fromRgba(light ? c.light : c.dark);

    static bool s_styled = false;
    if (!std::exchange(s_styled, true)) {
        QApplication::setStyle(new PlainFusion); // the application owns it
#if QT_VERSION >= QT_VERSION_CHECK(6, 5, 0)
        QObject::connect(QGuiApplication::styleHints(), &QStyleHints::colorSchemeChanged, &application, [&application] {
            if (s_applied == Theme::System) applyTheme(application, Theme::System);
        });
#endif
    }
    QApplication::setPalette(paletteOf(light));
    application.setStyleSheet(styleSheetOf(light));
}

Theme appliedTheme() { return s_applied; }

double contrast(const QColor& a, const QColor& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

QColor seenOn(const QColor& ground, const QColor& color, double least) {
    if (contrast(color, ground) >= least) return color;
    // The shortest way to black or white, whichever stands out from the ground.
    const QColor end = luminance(ground) > 0.18 ? Qt::black : Qt::white;
    double low = 0, high = 1;
    for (int i = 0; i < 12; ++i) {
        const double middle = (low + high) / 2;
        (contrast(between(color, end, middle), ground) >= least ? high : low) = middle;
    }
    return between(color, end, high);
}

QColor between(const QColor& a, const QColor& b, double share) {
    const auto t = static_cast<float>(share);
    return QColor::fromRgbF(a.redF() + t * (b.redF() - a.redF()), a.greenF() + t * (b.greenF() - a.greenF()),
                            a.blueF() + t * (b.blueF() - a.blueF()), a.alphaF());
}

void makeFaint(QLabel& label) { label.setForegroundRole(QPalette::PlaceholderText); }

QColor colorFromRgb(const Rgb& rgb) {
    const auto component = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return QColor::fromRgbF(component(rgb.r), component(rgb.g), component(rgb.b));
}

Rgb rgbFromColor(const QColor& color) { return {color.red() / 255.0, color.green() / 255.0, color.blue() / 255.0}; }

} // namespace pellucid::gui
