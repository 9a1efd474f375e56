// The dark and the light window: what is painted changes at once and can be read in both; the picture stays.
#include "gui_support.h"

#include <map>

#include <QAction>
#include <QApplication>
#include <QLabel>
#include <QSettings>
#include <QStatusBar>

#include "controllers/theme_actions.h"
#include "theme.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Relative luminance, WCAG 2.1.
double luminance(const QColor& color) {
    const auto linear = [](double v) { return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

double contrast(const QColor& a, const QColor& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

/// The colour that most pixels have: what the widget is painted on.
QColor groundOf(const QImage& image) {
    std::map<QRgb, int> counts;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) ++counts[image.pixel(x, y)];
    REQUIRE_FALSE(counts.empty());
    return QColor::fromRgb(
        std::max_element(counts.begin(), counts.end(), [](auto& a, auto& b) { return a.second < b.second; })->first);
}

/// Of the pixel that stands out most: the middle of a letter's stroke has the text's colour.
double textContrast(QWidget& widget) {
    const QImage image = widget.grab().toImage().convertToFormat(QImage::Format_RGB32);
    const QColor ground = groundOf(image);
    double most = 1;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            most = std::max(most, contrast(QColor::fromRgb(image.pixel(x, y)), ground));
    return most;
}

struct DarkAgain {
    ~DarkAgain() { applyTheme(*qApp, Theme::Dark); }
};

} // namespace

TEST_CASE("text can be read in both themes", "[theme]") {
    const DarkAgain dark;
    for (const Theme theme : {Theme::Dark, Theme::Light}) {
        INFO(name(theme));
        applyTheme(*qApp, theme);
        for (const QColor& ground : {theme::kWindow, theme::kPanel, theme::kRaised, theme::kTitle}) {
            INFO(ground.name().toStdString());
            // 4.5 is what WCAG 2.1 AA asks for.
            CHECK(contrast(theme::kText, ground) >= 4.5);
            CHECK((contrast(theme::kFaint, ground) >= 4.5 || ground == theme::kRaised));
        }
        CHECK(contrast(theme::kCurve, theme::kHistogram) >= 4.5);
        CHECK(contrast(theme::kCurve, theme::kPanel) >= 4.5);
        CHECK(contrast(theme::kKnob, theme::kPanel) >= 4.5);
        const QPalette p = QApplication::palette();
        CHECK(contrast(p.color(QPalette::HighlightedText), p.color(QPalette::Highlight)) >= 4.5);
        CHECK(contrast(p.color(QPalette::ButtonText), p.color(QPalette::Button)) >= 4.5);
        CHECK(contrast(p.color(QPalette::ToolTipText), p.color(QPalette::ToolTipBase)) >= 4.5);
        CHECK(contrast(p.color(QPalette::PlaceholderText), p.color(QPalette::Base)) >= 4.5);
        CHECK(contrast(p.color(QPalette::Link), p.color(QPalette::Window)) >= 4.5);
    }
}

TEST_CASE("the View menu switches the theme at once, and back", "[theme]") {
    const DarkAgain dark;
    OpenWindow w(24, ViewRenderer::Cpu);
    w.child<QAction>("influenceAction").trigger();
    w.bench().notices().add({"A notice to be read", {}});
    w.settle();
    REQUIRE(waitFor([&] { return w.document().influenceIsCurrent(); }));
    QCoreApplication::processEvents();
    const auto grab = [](QWidget& widget) { return widget.grab().toImage().convertToFormat(QImage::Format_RGB32); };
    // What paints itself, and what keeps colours of its own.
    const std::vector<const char*> widgets{"tfCanvas",   "targetBars",    "influenceTable", "featuresTable",
                                           "noticeText", "opacityEditor", "volumeLabel"};
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    std::map<std::string, QImage> before;
    for (const char* id : widgets) {
        INFO(id);
        QWidget& widget = w.child<QWidget>(id);
        before[id] = grab(widget);
        CHECK(luminance(groundOf(before[id])) < 0.1);
        CHECK(textContrast(widget) >= 4.5);
    }

    w.child<QAction>("themeLightAction").trigger();
    CHECK(QSettings().value("theme").toString() == "light");
    CHECK(keptTheme() == Theme::Light);
    CHECK(w.child<QAction>("themeLightAction").isChecked());
    CHECK_FALSE(w.child<QAction>("themeDarkAction").isChecked());
    CHECK(w.window.palette().color(QPalette::Window) == theme::kWindow);
    CHECK(luminance(theme::kWindow) > 0.7);
    for (const char* id : widgets) {
        INFO(id);
        QWidget& widget = w.child<QWidget>(id);
        CHECK(luminance(groundOf(grab(widget))) > 0.6);
        CHECK(textContrast(widget) >= 4.5);
    }
    // No feature is painted in another colour, and nothing was edited.
    CHECK(w.document().tf() == tf);
    CHECK(w.document().stepCount() == 0);
    CHECK(w.picture() == picture);

    w.child<QAction>("themeDarkAction").trigger();
    CHECK(QSettings().value("theme").toString() == "dark");
    for (const char* id : widgets) {
        INFO(id);
        CHECK(grab(w.child<QWidget>(id)) == before[id]);
    }
}

TEST_CASE("themes have names", "[theme]") {
    for (const Theme theme : {Theme::Dark, Theme::Light, Theme::System}) CHECK(themeFromName(name(theme)) == theme);
    CHECK_FALSE(themeFromName("pink"));
    CHECK_FALSE(themeFromName(""));
}
