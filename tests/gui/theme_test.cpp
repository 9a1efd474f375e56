// The dark and the light window: what is painted changes at once and can be read in both; the picture stays.
#include "gui_support.h"

#include <map>

#include <QAction>
#include <QApplication>
#include <QLabel>
#include <QSettings>
#include <QStatusBar>

#include "controllers/menu_actions.h"
#include "widgets/theme.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// 0 of black, 1 of white: from the contrast to black, (L + 0.05)/0.05.
double luminance(const QColor& color) { return 0.05 * contrast(color, Qt::black) - 0.05; }

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
            CHECK(contrast(theme::kText, ground) >= kTextContrast);
            CHECK(contrast(theme::kFaint, ground) >= kTextContrast);
            CHECK(contrast(theme::kAccent, ground) >= kMarkContrast); // marks of what the mouse is at
        }
        CHECK(contrast(theme::kFalls, theme::kPanel) >= kMarkContrast);
        CHECK(contrast(theme::kCurve, theme::kHistogram) >= kTextContrast);
        CHECK(contrast(theme::kCurve, theme::kPanel) >= kTextContrast);
        CHECK(contrast(theme::kKnob, theme::kPanel) >= kTextContrast);
        const QPalette p = QApplication::palette();
        CHECK(contrast(p.color(QPalette::HighlightedText), p.color(QPalette::Highlight)) >= kTextContrast);
        CHECK(contrast(p.color(QPalette::ButtonText), p.color(QPalette::Button)) >= kTextContrast);
        CHECK(contrast(p.color(QPalette::ToolTipText), p.color(QPalette::ToolTipBase)) >= kTextContrast);
        CHECK(contrast(p.color(QPalette::PlaceholderText), p.color(QPalette::Base)) >= kTextContrast);
        CHECK(contrast(p.color(QPalette::Link), p.color(QPalette::Window)) >= kTextContrast);
    }
}

TEST_CASE("colours of the data are brought to where they can be seen, and no farther", "[theme]") {
    // WCAG 2.1: white on black is 21; mid grey #767676 on white is the classic 4.54.
    CHECK(contrast(Qt::white, Qt::black) == Approx(21));
    CHECK(contrast(QColor(0x76, 0x76, 0x76), Qt::white) == Approx(4.54).margin(0.01));
    const DarkAgain dark;
    for (const Theme theme : {Theme::Dark, Theme::Light}) {
        applyTheme(*qApp, theme);
        for (const QColor& ground : {theme::kWindow, theme::kPanel, theme::kTrack})
            for (int hue = 0; hue < 360; hue += 30)
                for (const int saturation : {0, 60, 255})
                    for (int value = 0; value <= 255; value += 51) {
                        const QColor color = QColor::fromHsv(hue, saturation, value);
                        const QColor seen = seenOn(ground, color);
                        INFO(name(theme) << ' ' << ground.name().toStdString() << ' ' << color.name().toStdString());
                        CHECK(contrast(seen, ground) >= kMarkContrast - 1e-3);
                        if (contrast(color, ground) >= kMarkContrast)
                            CHECK(seen == color);
                        else
                            CHECK(contrast(seen, ground) < kMarkContrast + 0.2);
                        CHECK(contrast(seenOn(ground, color, kTextContrast), ground) >= kTextContrast - 1e-3);
                    }
    }
}

TEST_CASE("the View menu switches the theme at once, and back", "[theme]") {
    const DarkAgain dark;
    OpenWindow w(24, ViewRenderer::Cpu);
    w.child<QAction>("influenceAction").trigger();
    w.services().notices().add({"A notice to be read", {}});
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
        CHECK(textContrast(widget) >= kTextContrast);
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
        CHECK(textContrast(widget) >= kTextContrast);
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
    for (const Theme theme : {Theme::Dark, Theme::Light, Theme::System}) CHECK(findNamed<Theme>(name(theme)) == theme);
    CHECK_FALSE(findNamed<Theme>("pink"));
    CHECK_FALSE(findNamed<Theme>(""));
}
