// The entropy refiner in the window: palette, regions of the picture, live, settings, before and after.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>

#include "optimize/refine/refine.h"
#include "panels/refine_panel.h"
#include "render/clip_handles.h"
#include "tf/palette_bar.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

const RefineSettings& settingsOf(OpenWindow& w) { return *w.services().store().session().refine; }

void send(QWidget& widget, QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons held) {
    QMouseEvent event(type, at, widget.mapToGlobal(at), button, held, {});
    QCoreApplication::sendEvent(&widget, &event);
}

std::vector<double> opacities(const TransferFunction& tf) {
    std::vector<double> all;
    for (const ControlPoint& p : tf.points) all.push_back(p.opacity);
    return all;
}

/// The peak of one feature over the sum of all peaks.
double shareOfPeaks(const TransferFunction& tf, std::size_t feature) {
    const std::vector<double> peaks = featureOpacities(tf);
    double sum = 0;
    for (const double p : peaks) sum += p;
    return peaks[feature] / sum;
}

/// Of all colour in a picture (saturation times value), what has a hue within 60° of this one.
double shareOfHue(const QImage& picture, int hue) {
    double near = 0, all = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const QColor c = picture.pixelColor(x, y);
            if (c.hsvHue() < 0) continue;
            const int off = std::abs(c.hsvHue() - hue);
            const double weight = c.hsvSaturationF() * c.valueF();
            all += weight;
            if (std::min(off, 360 - off) < 60) near += weight;
        }
    return near / all;
}

// tents(3): centres 1/6, 1/2, 5/6, hues 60, 180, 300; points 0..8, each tent bottom, peak, bottom.
constexpr double kCenters[] = {1.0 / 6, 0.5, 5.0 / 6};
constexpr int kHues[] = {60, 180, 300};

QPointF centerOf(const ImageRegion& region) {
    QPointF sum;
    for (const glm::dvec2& corner : region.outline) sum += QPointF(corner.x, corner.y);
    return sum / static_cast<double>(region.outline.size());
}

} // namespace

TEST_CASE("a click on the palette brings its values out, whatever was clicked before", "[refine]") {
    OpenWindow w;
    auto& bar = w.child<PaletteBar>("paletteBar");
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    TransferFunction afterFirst;
    for (const std::size_t f : {0u, 2u, 0u}) {
        QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.positionOf(kCenters[f]).toPoint());
        REQUIRE(settingsOf(w).intensity);
        const double pixel = 1 / w.canvas().plot().width();
        CHECK(*settingsOf(w).intensity == Approx(kCenters[f]).margin(pixel));
        RefineOptions options;
        options.priority.intensity = *settingsOf(w).intensity;
        CHECK(opacities(w.document().tf()) == opacities(refine(w.document().histogram(), tf, options).tf));
        CHECK(shareOfPeaks(w.document().tf(), f) > shareOfPeaks(tf, f));
        const QImage refined = w.picture();
        CHECK(refined != picture);
        CHECK(shareOfHue(refined, kHues[f]) > shareOfHue(picture, kHues[f]));
        if (f == 0 && afterFirst.points.empty()) afterFirst = w.document().tf();
    }
    CHECK(w.document().tf() == afterFirst);
    CHECK(w.document().stepCount() == 3);
    for (int i = 0; i < 3; ++i) w.document().undo();
    CHECK(w.document().tf() == tf);
    CHECK_FALSE(settingsOf(w).intensity);
    CHECK(w.picture() == picture);
}

TEST_CASE("a drag along the palette is followed, and is one step", "[refine]") {
    OpenWindow w;
    auto& bar = w.child<PaletteBar>("paletteBar");
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    const QPointF from = bar.positionOf(kCenters[0]), to = bar.positionOf(kCenters[2]);
    send(bar, QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    const TransferFunction pressed = w.document().tf();
    CHECK_FALSE(pressed == tf);
    send(bar, QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
    CHECK(w.document().isPreviewing());
    CHECK(w.document().committedTf() == tf);
    const TransferFunction followed = w.document().tf();
    CHECK(shareOfPeaks(followed, 2) > shareOfPeaks(pressed, 2));
    CHECK(w.picture() != picture);
    send(bar, QEvent::MouseMove, from, Qt::NoButton, Qt::LeftButton); // there and back: from the start each time
    CHECK(w.document().tf() == pressed);
    send(bar, QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
    send(bar, QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(w.document().tf() == followed);
    CHECK(w.document().stepCount() == 1);
    CHECK(w.services().store().session().runs->size() == 1);
    const QImage refined = w.picture();
    CHECK(shareOfHue(refined, kHues[2]) > shareOfHue(picture, kHues[2]));

    SECTION("Esc gives a drag up") {
        send(bar, QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
        CHECK_FALSE(w.document().tf() == followed);
        QTest::keyClick(&bar, Qt::Key_Escape);
        CHECK(w.document().tf() == followed);
        send(bar, QEvent::MouseButtonRelease, from, Qt::LeftButton, Qt::NoButton);
        CHECK(w.document().stepCount() == 1);
        CHECK(w.picture() == refined);
    }
    SECTION("arrow keys move the marker, Delete forgets it") {
        QTest::keyClick(&bar, Qt::Key_Left);
        QTest::keyClick(&bar, Qt::Key_Left);
        CHECK(*settingsOf(w).intensity == Approx(kCenters[2] - 2.0 / 128).margin(1 / w.canvas().plot().width()));
        CHECK_FALSE(w.document().tf() == followed);
        CHECK(w.document().stepCount() == 2); // both keys
        const TransferFunction moved = w.document().tf();
        QTest::keyClick(&bar, Qt::Key_Delete);
        CHECK_FALSE(settingsOf(w).intensity);
        CHECK(w.document().tf() == moved);
        for (int i = 0; i < 3; ++i) w.document().undo();
        CHECK(w.document().tf() == tf);
        CHECK(w.picture() == picture);
    }
    SECTION("an undo in the middle of a drag ends it") {
        send(bar, QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
        w.document().undo();
        CHECK(w.document().tf() == followed);
        send(bar, QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
        CHECK(w.document().tf() == followed);
        send(bar, QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
        QTest::mouseClick(&bar, Qt::LeftButton, {}, from.toPoint());
        CHECK_FALSE(w.document().tf() == followed);
        CHECK(w.picture() != refined);
    }
}

TEST_CASE("what is selected under a clip plane comes out of what lies over it", "[refine]") {
    OpenWindow w;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 48;
    w.opening().openVolume(source);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    // Flesh of −200 to 200 HU in orange over bone of 200 HU and more in blue.
    const auto at = [&](double hounsfield) {
        const ValueRange range = w.document().volume()->range();
        return std::clamp((hounsfield - range.lo) / (range.hi - range.lo), 0.0, 1.0);
    };
    const Rgb orange{1, 0.5, 0.1}, blue{0.3, 0.5, 1};
    TransferFunction tf;
    tf.points = {{at(-200), 0, orange, true, {}}, {at(0), 0.3, orange, false, {}}, {at(200), 0, orange, true, {}},
                 {at(200), 0, blue, true, {}},    {at(600), 0.3, blue, false, {}}, {1, 0, blue, true, {}}};
    tf.features = {{"flesh", at(-200), at(200), orange, {}}, {"bone", at(200), 1, blue, {}}};
    w.document().setTf(tf, "Anatomy");
    w.settle();
    const TransferFunction before = w.document().tf();
    const QImage whole = w.picture();
    const double visible = w.document().measures()->features[1].visibility;

    // The front half away: the femur's lateral condyle, about (20, 6, 17) mm of the middle, is cut open at y = 0.
    w.services().store().edit(
        "Clip", {}, [](Session& session) { session.clipping.edit([](Clipping& clipping) { clipping.lo.y = 0.5; }); });
    w.settle();
    const Vec3 bone = w.document().volume()->geometry().boxCenter() + Vec3(20, 0, 17);
    const PictureView seen{w.document().camera(), w.view().overlay().width(), w.view().overlay().height()};
    const auto pixel = pixelOf(seen, bone);
    REQUIRE(pixel);
    const QPointF middle(pixel->x, pixel->y);
    w.child<QAction>("rectangleAction").trigger();
    CHECK(w.child<QAction>("rectangleAction").isChecked());
    const Camera camera = w.document().camera();
    drag(w.view(), middle - QPointF(8, 8), middle + QPointF(8, 8));
    CHECK(w.document().camera() == camera);
    CHECK_FALSE(w.child<QAction>("rectangleAction").isChecked()); // the mouse turns the volume again
    REQUIRE(waitFor([&] { return settingsOf(w).region.has_value(); }));
    const TransferFunction refined = w.document().tf();
    CHECK(shareOfPeaks(refined, 1) > shareOfPeaks(before, 1));
    CHECK(shareOfPeaks(refined, 1) > shareOfPeaks(refine(w.document().histogram(), before).tf, 1));
    CHECK(w.services().store().undoText() == "Refine for a region");
    // The rectangle is 16 pixels of the view wide.
    const ImageRegion region = *settingsOf(w).region;
    CHECK((region.outline[2].x - region.outline[0].x) * w.view().width() == Approx(16).margin(0.01));

    // The whole again: the selection stays, and so does what it did.
    w.child<QAction>("resetClipAction").trigger();
    w.settle();
    CHECK(settingsOf(w).region == region);
    CHECK(w.document().tf() == refined);
    CHECK(w.document().measures()->features[1].visibility > visible);
    const QImage after = w.picture();
    CHECK(after != whole);
    CHECK(shareOfHue(after, 223) > shareOfHue(whole, 223)); // hue of the blue
    w.document().undo();
    w.document().undo();
    CHECK(w.document().tf() == before);
    CHECK_FALSE(settingsOf(w).region);
}

TEST_CASE("a selection is moved, stretched and removed, one of nothing is refused", "[refine]") {
    OpenWindow w;
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    const QSizeF size = w.view().size();
    const QPointF middle(size.width() / 2, size.height() / 2);
    w.window.activateWindow();
    w.view().setFocus();
    REQUIRE(waitFor([&] { return w.window.isActiveWindow(); }));

    // A corner of the view shows nothing.
    QTest::keyClick(&w.view(), Qt::Key_R, Qt::ShiftModifier);
    REQUIRE(w.refining().selecting() == RefineController::Selecting::Rectangle);
    drag(w.view(), {4, 4}, {30, 30});
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    CHECK(w.child<QLabel>("panelMessage").text().contains("the region shows nothing"));
    CHECK_FALSE(w.refining().region());
    CHECK(w.document().stepCount() == 0);
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == picture);

    // A lasso: a triangle about the middle.
    QTest::keyClick(&w.view(), Qt::Key_L, Qt::ShiftModifier);
    REQUIRE(w.refining().selecting() == RefineController::Selecting::Lasso);
    send(w.view(), QEvent::MouseButtonPress, middle + QPointF(0, -40), Qt::LeftButton, Qt::LeftButton);
    send(w.view(), QEvent::MouseMove, middle + QPointF(40, 40), Qt::NoButton, Qt::LeftButton);
    send(w.view(), QEvent::MouseMove, middle + QPointF(-40, 40), Qt::NoButton, Qt::LeftButton);
    send(w.view(), QEvent::MouseButtonRelease, middle + QPointF(-40, 40), Qt::LeftButton, Qt::NoButton);
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    REQUIRE(settingsOf(w).region);
    CHECK(settingsOf(w).region->outline.size() == 3);
    CHECK_FALSE(w.document().tf() == tf);
    CHECK(w.picture() != picture);
    const QPointF center = centerOf(*settingsOf(w).region);
    drag(w.view(), middle + QPointF(0, 10), middle + QPointF(20, 10)); // of its inside
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    CHECK((centerOf(*settingsOf(w).region).x() - center.x()) * size.width() == Approx(20).margin(0.01));
    CHECK(w.document().stepCount() == 2);
    QTest::keyClick(&w.view(), Qt::Key_Delete);
    CHECK_FALSE(settingsOf(w).region);
    CHECK(w.document().stepCount() == 3);

    // A rectangle, whose right edge is drawn out.
    w.child<QAction>("rectangleAction").trigger();
    drag(w.view(), middle - QPointF(30, 30), middle + QPointF(30, 30));
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    REQUIRE(settingsOf(w).region);
    const ImageRegion drawn = *settingsOf(w).region;
    drag(w.view(), middle + QPointF(30, 0), middle + QPointF(50, 5));
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    const ImageRegion wider = *settingsOf(w).region;
    CHECK(wider.outline[0] == drawn.outline[0]);
    CHECK((wider.outline[2].x - drawn.outline[2].x) * size.width() == Approx(20).margin(0.01));
    CHECK(wider.outline[2].y == drawn.outline[2].y);
    // A click in a palette takes its place.
    auto& bar = w.child<PaletteBar>("paletteBar");
    QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.positionOf(0.5).toPoint());
    CHECK_FALSE(settingsOf(w).region);
    CHECK(settingsOf(w).intensity);
    w.document().undo();
    CHECK(settingsOf(w).region == wider);
    QTest::keyClick(&w.view(), Qt::Key_Escape);
    CHECK_FALSE(settingsOf(w).region);
    while (w.document().canUndo()) w.document().undo();
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == picture);
}

TEST_CASE("live refinement follows an edit, spares what the hand holds, and goes with it", "[refine]") {
    OpenWindow w;
    const TransferFunction opened = w.document().tf();
    w.child<QCheckBox>("liveRefineCheck").click();
    REQUIRE(settingsOf(w).live);
    const TransferFunction tf = w.document().tf();
    CHECK(opacities(tf) == opacities(refine(w.document().histogram(), opened).tf));
    const QImage picture = w.picture();
    const int steps = w.document().stepCount();

    const QPointF peak = w.canvas().positionOf(tf.points[4].x, tf.points[4].opacity);
    drag(w.canvas(), peak, w.canvas().positionOf(tf.points[4].x, 0.9));
    const TransferFunction edited = w.document().tf();
    CHECK(edited.points[4].opacity == Approx(0.9).margin(0.02)); // a pixel
    // The other two peaks give up what the one got, in proportion, and are refined.
    TransferFunction start = tf;
    start.points[4] = edited.points[4];
    start.points[4].fixed = true;
    const double others = tf.points[1].opacity + tf.points[7].opacity;
    const double left = others - (edited.points[4].opacity - tf.points[4].opacity);
    for (const std::size_t i : {1u, 7u}) start.points[i].opacity *= std::clamp(left / others, 0.25, 4.0);
    const std::vector<double> expected = opacities(refine(w.document().histogram(), start).tf);
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(edited.points[i].opacity == Approx(expected[i]).margin(1e-9));
    CHECK(edited.points[1].opacity < tf.points[1].opacity);
    CHECK(edited.points[7].opacity < tf.points[7].opacity);
    CHECK_FALSE(edited.points[4].fixed);
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(w.services().store().undoText() == "Move point, refined live");
    CHECK(w.picture() != picture);
    w.document().undo();
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == picture);
    w.document().redo();
    CHECK(w.document().tf() == edited);
    w.document().undo();
    w.document().undo();
    CHECK(w.document().tf() == opened);
    CHECK_FALSE(settingsOf(w).live);
    // Switched off, an edit is an edit.
    const QPointF top = w.canvas().positionOf(opened.points[4].x, opened.points[4].opacity);
    drag(w.canvas(), top, w.canvas().positionOf(opened.points[4].x, 0.9));
    CHECK(w.document().tf().points[1] == opened.points[1]);
}

TEST_CASE("live refinement for a hue brings out what has it after the edit", "[refine]") {
    OpenWindow w;
    w.services().store().edit("Favour yellow", {}, [](Session& session) {
        session.refine.edit([](RefineSettings& r) {
            r.hue = 60; // of the first tent, around 1/6
            r.live = true;
        });
    });
    const auto favoured = [&] { return w.refining().latest()->options.priority.intensity; };
    REQUIRE(favoured());
    CHECK(*favoured() < 1.0 / 3);
    w.services().store().edit("Swap colours", {}, [](Session& session) {
        TransferFunction tf = *session.tf();
        for (std::size_t i = 0; i < 3; ++i) std::swap(tf.points[i].color, tf.points[i + 6].color);
        session.setTf(tf);
    });
    CHECK(*favoured() > 2.0 / 3);
}

TEST_CASE("an optimization is not refined, however live refinement is", "[refine]") {
    OpenWindow w;
    w.child<QCheckBox>("liveRefineCheck").click();
    w.settle();
    const int steps = w.document().stepCount();
    const QImage picture = w.picture();
    w.document().setTargets({0.1, 0.3, 0.6});
    QTest::mouseClick(&w.child<QPushButton>("optimizeButton"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    CHECK(w.document().stepCount() == steps + 2);
    const Run& run = w.services().store().session().runs->back();
    CHECK(run.kind == "optimize");
    const std::vector<double> shown = featureOpacities(w.document().tf()), found = run.history[run.best].opacity;
    REQUIRE(shown.size() == found.size());
    for (std::size_t f = 0; f < found.size(); ++f)
        CHECK(shown[f] == Approx(found[f]).epsilon(1e-12)); // but for rounding
    CHECK(w.picture() != picture);
}

TEST_CASE("fixed points never move", "[refine]") {
    OpenWindow w;
    w.services().panels().show("refinement");
    w.canvas().selectPoint(1);
    QTest::keyClick(&w.canvas(), Qt::Key_Space); // fixed
    const TransferFunction tf = w.document().tf();
    REQUIRE(tf.points[1].fixed);
    const QImage picture = w.picture();
    auto& bar = w.child<PaletteBar>("paletteBar");
    const auto check = [&] {
        for (std::size_t i = 0; i < tf.points.size(); ++i)
            if (tf.points[i].fixed) CHECK(w.document().tf().points[i] == tf.points[i]);
        CHECK_FALSE(w.document().tf().points[4].opacity == tf.points[4].opacity);
        CHECK(w.picture() != picture);
    };
    w.child<QPushButton>("refineNowButton").click();
    check();
    w.document().undo();
    w.child<QComboBox>("refineMethodCombo").setCurrentIndex(1);
    Q_EMIT w.child<QComboBox>("refineMethodCombo").activated(1);
    w.child<QPushButton>("refineNowButton").click();
    check();
    w.document().undo();
    for (const double center : kCenters) {
        QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.positionOf(center).toPoint());
        if (center == kCenters[0]) { // the peak that would have to rise is the fixed one
            CHECK(w.document().tf() == tf);
            CHECK(w.child<QLabel>("refineNote").text().startsWith("f1 has a fixed control point"));
        } else {
            check();
        }
    }
}

TEST_CASE("the exact method can be chosen, and the panel compares", "[refine]") {
    OpenWindow w;
    w.services().panels().show("refinement");
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    auto& method = w.child<QComboBox>("refineMethodCombo");
    method.setCurrentIndex(1);
    Q_EMIT method.activated(1);
    REQUIRE(settingsOf(w).method == RefineMethod::Exact);
    CHECK(w.document().tf() == tf);
    w.child<QPushButton>("refineNowButton").click();
    RefineOptions exact;
    exact.method = RefineMethod::Exact;
    const RefineResult expected = refine(w.document().histogram(), tf, exact);
    CHECK(opacities(w.document().tf()) == opacities(expected.tf));
    CHECK(w.picture() != picture);
    REQUIRE(waitFor([&] { return !w.child<QLabel>("refineComparison").text().isEmpty(); }));
    // One bar per edge, the gaps' among them, with the weights before and after.
    const auto& bars = w.child<EdgeBars>("refineEdges").bars();
    REQUIRE(bars.size() == expected.edgesAfter.size());
    for (std::size_t i = 0; i < bars.size(); ++i) {
        CHECK(bars[i].weight == expected.edgesAfter[i]);
        CHECK(bars[i].before == expected.edgesBefore[i]);
    }
    // Undone, the bars are those of what is there.
    w.document().undo();
    CHECK(w.child<EdgeBars>("refineEdges").bars()[1].weight == Approx(expected.edgesBefore[1]));
    CHECK_FALSE(w.child<EdgeBars>("refineEdges").bars()[1].before);
    w.document().undo();
    CHECK(settingsOf(w).method == RefineMethod::Greedy);
    CHECK(method.currentIndex() == 0);
    CHECK(w.picture() == picture);
}

TEST_CASE("before and after stand side by side", "[refine]") {
    OpenWindow w;
    CHECK_FALSE(w.child<QAction>("sideBySideAction").isEnabled());
    const TransferFunction tf = w.document().tf();
    const QImage picture = w.picture();
    w.child<QAction>("refineAction").trigger();
    REQUIRE_FALSE(w.document().tf() == tf);
    CHECK(w.picture() != picture);
    w.child<QPushButton>("sideBySideButton").click();
    const ComparisonController& comparing = w.controllers().comparing;
    REQUIRE(waitFor([&] { return comparing.state() == ComparisonController::State::Current; }));
    CHECK(rangeless(comparing.sceneB()->tf).points == rangeless(tf).points);
    CHECK(comparing.view().mode == CompareMode::SideBySide);
    CHECK(comparing.comparison()->difference.largest > 0);
    CHECK(w.child<QLabel>("compareName").text() == "B: Before the refinement");
}
