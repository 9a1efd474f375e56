// The window as a viewer with a colour-vision deficiency sees it, and features that such viewers cannot tell apart.
#include "gui_support.h"

#include <QAction>
#include <QDockWidget>
#include <QGraphicsEffect>
#include <QLabel>
#include <QToolButton>

#include "services/notices.h"
#include "tf/alike_features.h"
#include "tf/edit.h"
#include "view/gl_surface.h"
#include "widgets/shown_vision.h"
#include "widgets/theme.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct NormalAgain {
    ~NormalAgain() { shownVision().show(VisionKind::Normal); }
};

/// How far pixels are from what seenColor() makes of those of `before`, of 255.
int farthestFromSeen(const QImage& before, const QImage& after, const LightMatrix& vision) {
    REQUIRE(before.size() == after.size());
    int farthest = 0;
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            const QColor seen = colorFromRgb(seenColor(rgbFromColor(before.pixelColor(x, y)), vision));
            const QColor is = after.pixelColor(x, y);
            for (const int d : {seen.red() - is.red(), seen.green() - is.green(), seen.blue() - is.blue()})
                farthest = std::max(farthest, std::abs(d));
        }
    return farthest;
}

int greyest(const QImage& image) {
    int most = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const QColor c = image.pixelColor(x, y);
            most = std::max({most, std::abs(c.red() - c.green()), std::abs(c.blue() - c.green())});
        }
    return most;
}

TransferFunction inColors(TransferFunction tf, const std::vector<Rgb>& colors) {
    for (std::size_t f = 0; f < colors.size(); ++f) tf = withFeatureColor(tf, static_cast<int>(f), colors[f]);
    return tf;
}

void checkPicture(ViewRenderer renderer) {
    const NormalAgain normal;
    OpenWindow w(24, renderer);
    // Letters are mixed with what lies below them, in other light than the matrix is for.
    if (w.services().store().session().reference->on) w.child<QAction>("frameAction").trigger();
    const QImage before = w.picture();
    for (const VisionKind vision : {VisionKind::Deuteranopia, VisionKind::Grey}) {
        shownVision().show(vision);
        const QImage after = w.picture();
        // Both tables and the device round; shades of dark colours are a value apart.
        CHECK(farthestFromSeen(before, after, visionMatrix(vision)) <= 2);
        CHECK(largestDifference(before, after) > 20);
    }
    shownVision().show(VisionKind::Normal);
    CHECK(largestDifference(before, w.picture()) == 0);
}

} // namespace

TEST_CASE("the picture of the CPU is shown as other viewers see it", "[vision]") { checkPicture(ViewRenderer::Cpu); }

TEST_CASE("the picture of OpenGL is shown as other viewers see it", "[vision]") {
    if (GlSurface::available() == GlSurface::Available::No) {
        WARN("no OpenGL here");
        return;
    }
    checkPicture(ViewRenderer::Gl);
}

TEST_CASE("panels are shown as other viewers see them, and the menu and a notice say so", "[vision]") {
    const NormalAgain normal;
    OpenWindow w;
    QWidget& panel = *w.child<QDockWidget>("featuresDock").widget();
    REQUIRE(greyest(panel.grab().toImage()) > 60); // bars have colours
    w.child<QAction>("visionGreyAction").trigger();
    CHECK(greyest(panel.grab().toImage()) <= 1);
    CHECK(w.child<QAction>("visionGreyAction").isChecked());
    CHECK_FALSE(w.child<QAction>("visionNormalAction").isChecked());
    REQUIRE_FALSE(w.services().notices().all().empty());
    const Notice notice = w.services().notices().all().back();
    CHECK(notice.text.contains("without colours"));
    REQUIRE(notice.choices.size() == 1);
    notice.choices[0].act();
    CHECK(shownVision().isNormal());
    CHECK(w.services().notices().all().empty());
    CHECK(greyest(panel.grab().toImage()) > 60);
    CHECK(panel.graphicsEffect() == nullptr); // nothing is between when nobody asks
}

TEST_CASE("the session and its pictures know nothing of who looks", "[vision]") {
    const NormalAgain normal;
    OpenWindow w;
    const auto before = w.services().store().session();
    shownVision().show(VisionKind::Protanopia);
    w.settle();
    CHECK(w.services().store().session() == before);
    CHECK(w.document().isClean());
}

TEST_CASE("features that look alike are told of, and mended in one step", "[vision]") {
    OpenWindow w;
    auto& label = w.child<QLabel>("alikeLabel");
    auto& mend = w.child<QToolButton>("mendColorsButton");
    // Apart in lightness for everybody.
    w.document().setTf(inColors(w.document().tf(), {{0.1, 0.1, 0.6}, {0.8, 0.5, 0.2}, {1, 1, 0.9}}), "Colours");
    w.settle();
    CHECK_FALSE(label.isVisible());
    CHECK_FALSE(mend.isVisible());
    // A red and a green of one lightness.
    w.document().setTf(
        inColors(w.document().tf(), {rgbFromHex("#cc3300"), rgbFromHex("#668000"), rgbFromHex("#3060d0")}), "Colours");
    w.settle();
    REQUIRE(label.isVisible());
    CHECK(label.text().contains("f1 and f2"));
    CHECK(label.toolTip().contains("look alike to a viewer with"));
    CHECK(label.accessibleName() == label.toolTip());
    const TransferFunction alike = w.document().tf();
    const int steps = w.document().stepCount();
    QTest::mouseClick(&mend, Qt::LeftButton);
    w.settle();
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(alikeFeatures(w.document().tf(), featuresToTell(w.document().tf())).empty());
    CHECK(featureOpacities(w.document().tf()) == featureOpacities(alike));
    CHECK_FALSE(label.isVisible());
    w.document().undo();
    w.settle();
    CHECK(w.document().tf() == alike);
    CHECK(label.isVisible());
    // Where one of both is hidden there is nothing to confuse.
    TransferFunction hidden = alike;
    hidden.features[0].hidden = true;
    w.document().setTf(hidden, "Hide");
    w.settle();
    CHECK_FALSE(label.isVisible());
}
