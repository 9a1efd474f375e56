#include "widgets/theme.h"

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

struct Colors {
    QRgb window, panel, raised, title, line, text, faint, accent, track, histogram, curve, knob, hover, falls, disabled,
        shadow;
    QRgb notice, noticeLine, noticeText;
};

constexpr Colors kDark{.window = 0xff262729,
                       .panel = 0xff1c1d1f,
                       .raised = 0xff35373a,
                       .title = 0xff2e3033,
                       .line = 0xff45474b,
                       .text = 0xffe4e5e7,
                       .faint = 0xffa3a6ac,
                       .accent = 0xff4c9aff,
                       .track = 0xff1c1d1f,
                       .histogram = 0xff44474c,
                       .curve = 0xffd8dade,
                       .knob = 0xffffffff,
                       .hover = 0x0effffff,
                       .falls = 0xffd97a2b,
                       .disabled = 0xff74767a,
                       .shadow = 0xff0a0a0b,
                       .notice = 0xff4a3f22,
                       .noticeLine = 0xff6b5a2d,
                       .noticeText = 0xfff2e3b8};

constexpr Colors kLight{.window = 0xfff1f2f3,
                        .panel = 0xffffffff,
                        .raised = 0xffe6e8ea,
                        .title = 0xffe0e2e5,
                        .line = 0xffb4b8be,
                        .text = 0xff1b1d20,
                        .faint = 0xff585c62,
                        .accent = 0xff1667c9,
                        .track = 0xffcdd0d5, // white features are seen on it
                        .histogram = 0xffcdd1d6,
                        .curve = 0xff2b2e33,
                        .knob = 0xff3a3d42,
                        .hover = 0x10000000,
                        .falls = 0xffb8651b,
                        .disabled = 0xff83868c,
                        .shadow = 0xff8a8d92,
                        .notice = 0xfffff3cf,
                        .noticeLine = 0xffdfc878,
                        .noticeText = 0xff4d3c05};

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
        if (const auto* button = qstyleoption_cast<const QStyleOptionToolButton*>(option);
            on && button != nullptr && element == CE_ToolButtonLabel) {
            QStyleOptionToolButton lit(*button);
            lit.palette.setColor(QPalette::ButtonText, theme::kPanel);
            return QProxyStyle::drawControl(element, &lit, painter, widget);
        }
        if (const auto* button = qstyleoption_cast<const QStyleOptionButton*>(option);
            on && button != nullptr && element == CE_PushButtonLabel) {
            QStyleOptionButton lit(*button);
            lit.palette.setColor(QPalette::ButtonText, theme::kPanel);
            return QProxyStyle::drawControl(element, &lit, painter, widget);
        }
        QProxyStyle::drawControl(element, option, painter, widget);
    }
};

} // namespace

void applyTheme(QApplication& application, Theme theme) {
    const bool systemLight = systemIsLight(); // before the first palette of ours
    s_applied = theme;
    const bool light = theme == Theme::Light || (theme == Theme::System && systemLight);
    const Colors& c = light ? kLight : kDark;
    using Pair = std::pair<QColor&, QRgb>;
    for (const auto& [color, value] : {Pair{theme::kWindow, c.window},
                                       {theme::kPanel, c.panel},
                                       {theme::kRaised, c.raised},
                                       {theme::kTitle, c.title},
                                       {theme::kLine, c.line},
                                       {theme::kText, c.text},
                                       {theme::kFaint, c.faint},
                                       {theme::kAccent, c.accent},
                                       {theme::kTrack, c.track},
                                       {theme::kHistogram, c.histogram},
                                       {theme::kCurve, c.curve},
                                       {theme::kKnob, c.knob},
                                       {theme::kHover, c.hover},
                                       {theme::kFalls, c.falls}})
        color = QColor::fromRgba(value);

    static bool s_styled = false;
    if (!std::exchange(s_styled, true)) {
        QApplication::setStyle(new PlainFusion); // the application owns it
#if QT_VERSION >= QT_VERSION_CHECK(6, 5, 0)
        QObject::connect(QGuiApplication::styleHints(), &QStyleHints::colorSchemeChanged, &application, [&application] {
            if (s_applied == Theme::System) applyTheme(application, Theme::System);
        });
#endif
    }
    const QColor highlight = light ? theme::kAccent : theme::kAccent.darker(130); // under white
    QPalette p;
    p.setColor(QPalette::Window, theme::kWindow);
    p.setColor(QPalette::WindowText, theme::kText);
    p.setColor(QPalette::Base, theme::kPanel);
    p.setColor(QPalette::AlternateBase, theme::kWindow);
    p.setColor(QPalette::ToolTipBase, theme::kRaised);
    p.setColor(QPalette::ToolTipText, theme::kText);
    p.setColor(QPalette::PlaceholderText, theme::kFaint);
    p.setColor(QPalette::Text, theme::kText);
    p.setColor(QPalette::Button, theme::kRaised);
    p.setColor(QPalette::ButtonText, theme::kText);
    p.setColor(QPalette::BrightText, Qt::white);
    p.setColor(QPalette::Link, theme::kAccent);
    p.setColor(QPalette::Highlight, highlight);
    p.setColor(QPalette::HighlightedText, Qt::white);
    p.setColor(QPalette::Light, theme::kRaised.lighter(light ? 106 : 115));
    p.setColor(QPalette::Midlight, theme::kRaised);
    p.setColor(QPalette::Mid, theme::kLine);
    p.setColor(QPalette::Dark, light ? theme::kLine.darker(115) : theme::kPanel.darker(130));
    p.setColor(QPalette::Shadow, QColor::fromRgba(c.shadow));
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
        p.setColor(QPalette::Disabled, role, QColor::fromRgba(c.disabled));
    }
    p.setColor(QPalette::Disabled, QPalette::Highlight, theme::kLine);
    QApplication::setPalette(p);
    const auto hex = [](QRgb value) { return QColor::fromRgb(value).name(); };
    application.setStyleSheet(
        QStringLiteral("QToolTip { color: %1; background: %2; border: 1px solid %3; padding: 3px; }"
                       "QDockWidget::title { background: %4; padding: 5px 8px; }"
                       "QMainWindow::separator { background: %5; width: 4px; height: 4px; }"
                       "QMainWindow::separator:hover { background: %6; }")
            .arg(hex(c.text), hex(c.raised), hex(c.line), hex(c.title), hex(light ? c.title : c.panel), hex(c.accent)) +
        QStringLiteral("QStatusBar::item { border: none; }"
                       "QStatusBar QLabel { color: %1; padding: 0 6px; }"
                       "#noticeBar { background: %2; border: none; border-bottom: 1px solid %3; }"
                       "#noticeBar QLabel { color: %4; }"
                       "QHeaderView::section { background: %5; color: %1; border: none; padding: 3px 6px; }"
                       "QTableView { border: none; gridline-color: %5; }")
            .arg(hex(c.faint), hex(c.notice), hex(c.noticeLine), hex(c.noticeText), hex(c.title)));
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
    const auto toward = [&](float t) {
        return QColor::fromRgbF(color.redF() + t * (end.redF() - color.redF()),
                                color.greenF() + t * (end.greenF() - color.greenF()),
                                color.blueF() + t * (end.blueF() - color.blueF()), color.alphaF());
    };
    float low = 0, high = 1;
    for (int i = 0; i < 12; ++i) {
        const float middle = (low + high) / 2;
        (contrast(toward(middle), ground) >= least ? high : low) = middle;
    }
    return toward(high);
}

void makeFaint(QLabel& label) { label.setForegroundRole(QPalette::PlaceholderText); }

QColor colorFromRgb(const Rgb& rgb) {
    const auto component = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return QColor::fromRgbF(component(rgb.r), component(rgb.g), component(rgb.b));
}

Rgb rgbFromColor(const QColor& color) { return {color.red() / 255.0, color.green() / 255.0, color.blue() / 255.0}; }

} // namespace pellucid::gui
