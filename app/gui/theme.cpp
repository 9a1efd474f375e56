#include "theme.h"

#include <algorithm>

#include <QApplication>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QStyleFactory>
#include <QStyleOption>

namespace pellucid::gui {
namespace {

/// Fusion, with check boxes that can be seen on a dark ground.
class DarkFusion : public QProxyStyle {
public:
    DarkFusion() : QProxyStyle(QStyleFactory::create("Fusion")) {}

    int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                  QStyleHintReturn* returned) const override {
        if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
        return QProxyStyle::styleHint(hint, option, widget, returned);
    }

    void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                       const QWidget* widget) const override {
        if (element != PE_IndicatorCheckBox) return QProxyStyle::drawPrimitive(element, option, painter, widget);
        const bool enabled = option->state.testFlag(State_Enabled), on = option->state.testFlag(State_On);
        const QRectF box = QRectF(option->rect).adjusted(1.5, 1.5, -1.5, -1.5);
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        const QColor line = option->state.testFlag(State_MouseOver) ? theme::kAccent : QColor(0x7a, 0x7d, 0x83);
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
};

} // namespace

void applyTheme(QApplication& application) {
    QApplication::setStyle(new DarkFusion); // the application owns it
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
    p.setColor(QPalette::Highlight, theme::kAccent.darker(130));
    p.setColor(QPalette::HighlightedText, Qt::white);
    p.setColor(QPalette::Light, theme::kRaised.lighter(115));
    p.setColor(QPalette::Midlight, theme::kRaised);
    p.setColor(QPalette::Mid, theme::kLine);
    p.setColor(QPalette::Dark, theme::kPanel.darker(130));
    p.setColor(QPalette::Shadow, QColor(10, 10, 11));
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
        p.setColor(QPalette::Disabled, role, QColor(0x74, 0x76, 0x7a));
    }
    p.setColor(QPalette::Disabled, QPalette::Highlight, theme::kLine);
    QApplication::setPalette(p);
    application.setStyleSheet(
        QStringLiteral("QToolTip { color: #e4e5e7; background: #35373a; border: 1px solid #55575b; padding: 3px; }"
                       "QDockWidget::title { background: #2e3033; padding: 5px 8px; }"
                       "QMainWindow::separator { background: #1c1d1f; width: 4px; height: 4px; }"
                       "QMainWindow::separator:hover { background: #4c9aff; }"
                       "QStatusBar::item { border: none; }"
                       "QStatusBar QLabel { color: #9a9da3; padding: 0 6px; }"
                       "#noticeBar { background: #4a3f22; border: none; border-bottom: 1px solid #6b5a2d; }"
                       "#noticeBar QLabel { color: #f2e3b8; }"
                       "QHeaderView::section { background: #2e3033; color: #b8bbc0; border: none; padding: 3px 6px; }"
                       "QTableView { border: none; gridline-color: #2e3033; }"));
}

QColor colorFromRgb(const Rgb& rgb) {
    const auto component = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return QColor::fromRgbF(component(rgb.r), component(rgb.g), component(rgb.b));
}

Rgb rgbFromColor(const QColor& color) { return {color.red() / 255.0, color.green() / 255.0, color.blue() / 255.0}; }

} // namespace pellucid::gui
