// Clip handles, the light in the hand, and their panels.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QSlider>
#include <QToolButton>

#include <glm/geometric.hpp>

#include "render/camera_motion.h"
#include "render/image_renderer.h"
#include "render/light_presets.h"
#include "view/clip_layer.h"
#include "widgets/input_habits.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

const Clipping& clippingOf(OpenWindow& w) { return *w.services().store().session().clipping; }
const Light& lightOf(OpenWindow& w) { return w.services().store().session().display->light; }

PictureView pictureOf(OpenWindow& w) {
    return {w.document().camera(), w.view().overlay().width(), w.view().overlay().height()};
}

QPointF pointOf(OpenWindow& w, const Vec3& world) {
    const auto pixel = pixelOf(pictureOf(w), world);
    REQUIRE(pixel);
    return {pixel->x, pixel->y};
}

void send(QWidget& widget, QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons held) {
    QMouseEvent event(type, at, widget.mapToGlobal(at), button, held, {});
    QCoreApplication::sendEvent(&widget, &event);
}

} // namespace

TEST_CASE("a face of the box is dragged, and figures follow", "[clip]") {
    OpenWindow w;
    w.services().store().edit("Engine", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Reference; });
    });
    const int steps = w.document().stepCount();
    const Geometry& g = w.document().volume()->geometry();
    const Vec3 face = faceCenter({}, g, 0, true);
    const QPointF from = pointOf(w, face), to = pointOf(w, face - 0.4 * faceWay(g, 0));
    const Camera camera = w.document().camera();
    drag(w.view(), from, to); // without handles it turns the view
    CHECK_FALSE(w.document().camera() == camera);
    w.document().setCamera(camera);
    CHECK(clippingOf(w).isNone());

    w.child<QAction>("clipHandlesAction").trigger();
    w.settle();
    const QImage whole = w.picture();
    const Measures measures = *w.document().measures();
    drag(w.view(), from, to);
    CHECK(w.document().camera() == camera);
    CHECK(clippingOf(w).hi.x == Approx(0.6).margin(1e-6));
    CHECK(clippingOf(w).lo == Vec3(0));
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(w.picture() != whole);
    CHECK(w.document().measuresAreCurrent());
    CHECK(w.document().measures()->visibilityHistogram != measures.visibilityHistogram);
    CHECK(w.child<QDoubleSpinBox>("clipXHi").value() == Approx(60).margin(0.06));

    const Clipping part = clippingOf(w);
    const Vec3 cut = faceCenter(part, g, 0, true);
    drag(w.view(), pointOf(w, cut), pointOf(w, cut + 0.1 * faceWay(g, 0)), Qt::LeftButton, Qt::ShiftModifier);
    // With Shift the slab moves.
    CHECK(clippingOf(w).lo.x == Approx(0.1).margin(1e-6));
    CHECK(clippingOf(w).hi.x == Approx(0.7).margin(1e-6));

    w.document().undo();
    CHECK(clippingOf(w) == part);
    w.document().undo();
    CHECK(clippingOf(w).isNone());
    CHECK(w.picture() == whole);
    w.document().redo();
    CHECK(clippingOf(w) == part);
    w.child<QAction>("resetClipAction").trigger();
    CHECK(clippingOf(w).isNone());
    CHECK_FALSE(w.child<QAction>("resetClipAction").isEnabled());
}

TEST_CASE("Esc gives a drag of a handle up", "[clip]") {
    OpenWindow w;
    w.child<QAction>("clipHandlesAction").trigger();
    const Geometry& g = w.document().volume()->geometry();
    const Vec3 face = faceCenter({}, g, 2, true);
    const QPointF from = pointOf(w, face), to = pointOf(w, face - 0.5 * faceWay(g, 2));
    send(w.view(), QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    send(w.view(), QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
    CHECK(clippingOf(w).hi.z == Approx(0.5).margin(1e-6));
    CHECK(w.document().isPreviewing());
    QTest::keyClick(&w.view(), Qt::Key_Escape);
    CHECK(clippingOf(w).isNone());
    CHECK_FALSE(w.document().isPreviewing());
    const Camera camera = w.document().camera();
    send(w.view(), QEvent::MouseMove, from, Qt::NoButton, Qt::LeftButton); // the button is still down
    CHECK(clippingOf(w).isNone());
    CHECK(w.document().camera() == camera);
    send(w.view(), QEvent::MouseButtonRelease, from, Qt::LeftButton, Qt::NoButton);
    CHECK_FALSE(w.document().canUndo());
}

TEST_CASE("an oblique plane is added, moved, turned, flipped and removed", "[clip]") {
    OpenWindow w;
    const Geometry g = w.document().volume()->geometry();
    CHECK_FALSE(w.child<QAction>("clipHandlesAction").isChecked());
    w.child<QAction>("addPlaneAction").trigger();
    CHECK(w.child<QAction>("clipHandlesAction").isChecked());
    REQUIRE(clippingOf(w).planes.size() == 1);
    const ClipPlane added = clippingOf(w).planes[0];
    // Through the middle, facing the viewer: what is nearer is cut away.
    CHECK(glm::dot(added.normal, g.boxCenter()) == Approx(added.offset));
    CHECK(glm::dot(added.normal, w.document().camera().forward()) == Approx(-1));

    // From the side its handle moves it along its normal.
    w.document().setCamera(rotated(w.document().camera(), g, 60, 0));
    const Vec3 anchor = planeAnchor(added, g);
    drag(w.view(), pointOf(w, anchor), pointOf(w, anchor + 3.0 * added.normal));
    CHECK(clippingOf(w).planes[0].normal == added.normal);
    CHECK(clippingOf(w).planes[0].offset == Approx(added.offset + 3).margin(1e-6));
    w.document().undo();
    CHECK(clippingOf(w).planes[0] == added);

    // The tip, 64 pixels' worth along the normal, turns it about the middle.
    const Vec3 tip = anchor + added.normal * (64 * worldPerPixel(pictureOf(w), anchor));
    drag(w.view(), pointOf(w, tip), pointOf(w, tip) + QPointF(0, -20));
    const ClipPlane turned = clippingOf(w).planes[0];
    CHECK(glm::length(turned.normal) == Approx(1));
    // By 20 of 64 pixels on the ball, less where the normal is not seen from its front.
    CHECK(glm::dot(turned.normal, added.normal) < std::cos(0.1));
    CHECK(glm::dot(turned.normal, added.normal) > std::cos(20.0 / 64 + 1e-6));
    CHECK(glm::dot(turned.normal, anchor) == Approx(turned.offset));

    w.child<QToolButton>("flipPlane1").click();
    CHECK(clippingOf(w).planes[0] == ClipPlane{-turned.normal, -turned.offset});
    w.child<QDoubleSpinBox>("clipPlane1D").setValue(5);
    CHECK(clippingOf(w).planes[0].offset == 5);
    CHECK(clippingOf(w).planes[0].normal == -turned.normal); // not what the boxes round it to
    for (int i = 0; i < 5; ++i) w.child<QAction>("addPlaneAction").trigger();
    CHECK(clippingOf(w).planes.size() == kMostClipPlanes);
    CHECK_FALSE(w.child<QAction>("addPlaneAction").isEnabled());
    CHECK_FALSE(w.child<QPushButton>("addPlaneButton").isEnabled());
    w.child<QToolButton>("removePlane1").click();
    CHECK(clippingOf(w).planes.size() == kMostClipPlanes - 1);
    w.child<QPushButton>("resetClipButton").click();
    CHECK(clippingOf(w).isNone());
}

TEST_CASE("light is on where a volume opens, and one key switches it", "[light]") {
    OpenWindow w;
    CHECK(lightOf(w) == withPreset({}, lightPresets().front()));
    CHECK_FALSE(w.window.isWindowModified());
    CHECK_FALSE(w.document().canUndo());
    const QImage lit = w.picture();
    w.window.activateWindow(); // shortcuts belong to the active window
    w.view().setFocus();
    REQUIRE(waitFor([&] { return w.window.isActiveWindow(); }));
    QTest::keyClick(&w.view(), Qt::Key_L);
    CHECK_FALSE(lightOf(w).on);
    CHECK(w.picture() != lit);
    QTest::keyClick(&w.view(), Qt::Key_L);
    CHECK(lightOf(w).on);
    CHECK(w.picture() == lit);

    // From a number, too, once it is typed.
    InputHabits habits;
    qApp->installEventFilter(&habits);
    w.services().panels().show("clip");
    auto& box = w.child<QDoubleSpinBox>("clipXLo");
    box.setFocus();
    REQUIRE(waitFor([&] { return box.hasFocus(); }));
    box.selectAll();
    QTest::keyClick(&box, Qt::Key_5);
    QTest::keyClick(&box, Qt::Key_L);
    CHECK(lightOf(w).on);
    QTest::keyClick(&box, Qt::Key_Return);
    QCoreApplication::processEvents();
    QTest::keyClick(&box, Qt::Key_L);
    CHECK_FALSE(lightOf(w).on);
    CHECK(box.value() == 5);
}

TEST_CASE("the light is turned by hand", "[light]") {
    OpenWindow w;
    w.child<QAction>("shadingAction").trigger(); // off: turning it switches it on
    const Camera camera = w.document().camera();
    // A quarter of the view's height is the ball's radius: a drag by as much turns it by one radian.
    const double radius = w.view().height() / 4.0;
    const QPointF from(w.view().width() / 2.0, w.view().height() / 2.0);
    drag(w.view(), from, from + QPointF(radius, 0), Qt::LeftButton, Qt::ControlModifier);
    CHECK(w.document().camera() == camera);
    CHECK(lightOf(w).on);
    CHECK(glm::length(lightOf(w).direction - Vec3(std::sin(1.0), 0, std::cos(1.0))) < 1e-9);
    CHECK(w.child<QDoubleSpinBox>("lightRight").value() == Approx(57)); // degrees
    CHECK(w.child<QComboBox>("lightPresetCombo").currentIndex() == 0);  // wherever it comes from
    w.document().undo();
    CHECK_FALSE(lightOf(w).on);
    CHECK(lightOf(w).direction == Vec3(0, 0, 1));
    w.document().redo();
    w.child<QPushButton>("lightFromEyeButton").click();
    CHECK(lightOf(w).direction == Vec3(0, 0, 1));
}

TEST_CASE("presets and numbers of the light", "[light]") {
    OpenWindow w;
    auto& presets = w.child<QComboBox>("lightPresetCombo");
    REQUIRE(presets.count() == static_cast<int>(lightPresets().size()));
    for (int i = presets.count() - 1; i >= 0; --i) {
        presets.setCurrentIndex(i);
        Q_EMIT presets.activated(i);
        CHECK(presetOf(lightOf(w)) == &lightPresets()[static_cast<std::size_t>(i)]);
        CHECK(presets.currentIndex() == i);
    }
    const int steps = w.document().stepCount();
    for (const double value : {0.5, 0.6, 0.7}) w.child<QDoubleSpinBox>("lightAmbient").setValue(value);
    CHECK(lightOf(w).ambient == 0.7);
    CHECK(w.document().stepCount() == steps + 1); // one number, one step
    CHECK(presets.currentIndex() == -1);          // its own
    auto& slider = w.child<QSlider>("lightOcclusionSlider");
    slider.setSliderDown(true);
    slider.setSliderPosition(50);
    slider.setSliderPosition(100);
    CHECK(w.document().isPreviewing());
    CHECK(lightOf(w).occlusion == 0.5); // 100 of 200 steps
    slider.setSliderDown(false);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(w.document().stepCount() == steps + 2);
    w.document().undo();
    CHECK(lightOf(w).occlusion == 0);
    CHECK(w.child<QDoubleSpinBox>("lightOcclusion").value() == 0);
}

TEST_CASE("at rest the picture becomes the one that is saved", "[display]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    w.settle();
    // ½ d0 halved three times: 1/16, unless the panel says otherwise.
    CHECK(w.view().picture().stepInD0 == 1.0 / 16);
    w.window.findChild<QAction*>("displayAction")->trigger();
    auto& finest = w.child<QComboBox>("finestStepCombo");
    CHECK(finest.currentText() == "1/16 d0");
    const QImage refined = w.picture();
    finest.setCurrentIndex(0);
    Q_EMIT finest.activated(0);
    CHECK(w.services().store().session().display->finestStep == 0.5);
    const QImage plain = w.picture();
    CHECK(w.view().picture().stepInD0 == 0.5);
    CHECK(plain != refined);
    w.document().undo();
    CHECK(finest.currentText() == "1/16 d0");
    CHECK(w.picture() == refined);

    // As it would be saved: the same pixels, rounded to 8 bits in the same way.
    auto& surface = w.child<QWidget>("cpuSurface");
    PictureInput input = pictureInput(w.services().scene(), surface.width(), surface.height());
    const Image saved = makeCpuRenderer(input.volume)->render(input.camera, input.tf, input.settings);
    const QImage shown = surface.grab().toImage();
    int off = 0;
    for (int y = 0; y < saved.height; ++y)
        for (int x = 0; x < saved.width; ++x) {
            const QColor color = shown.pixelColor(x, y);
            const int have[3] = {color.red(), color.green(), color.blue()};
            for (int c = 0; c < 3; ++c)
                off += have[c] != static_cast<int>(std::clamp(saved.pixel(x, y)[c], 0.0f, 1.0f) * 255.0f + 0.5f);
        }
    CHECK(off == 0);
}

TEST_CASE("a change interrupts refining, and nothing is drawn afterwards", "[display]") {
    OpenWindow w(48, ViewRenderer::Cpu);
    w.settle();
    const Camera home = w.document().camera();
    // The full picture is there, the finished one is not yet.
    w.document().setCamera(rotated(home, w.document().volume()->geometry(), 40, 0));
    REQUIRE(waitFor([&] { return w.view().picture().resolutionScale == 1 && !w.view().isComplete(); }));
    w.document().setCamera(home);
    w.settle();
    PictureInput input = pictureInput(w.services().scene(), 1, 1);
    CHECK(input.camera == home);
    CHECK(w.view().picture().stepInD0 == 1.0 / 16);
    QSignalSpy shown(&w.view(), &VolumeView::pictureShown);
    QTest::qWait(600); // several times as long as it rests before it goes on
    CHECK(shown.count() == 0);
}

TEST_CASE("mode and background are edits of the display", "[display]") {
    OpenWindow w;
    auto& mode = w.child<QComboBox>("modeCombo");
    REQUIRE(mode.count() == 5);
    Q_EMIT mode.activated(static_cast<int>(RenderMode::Average));
    CHECK(w.services().store().session().display->mode == RenderMode::Average);
    CHECK(mode.currentIndex() == static_cast<int>(RenderMode::Average));
    auto& gradient = w.child<QCheckBox>("gradientCheck");
    gradient.click();
    CHECK(w.services().store().session().display->backgroundTop);
    w.settle();
    CHECK(w.document().measuresAreCurrent());
    gradient.click();
    CHECK_FALSE(w.services().store().session().display->backgroundTop);
    for (int i = 0; i < 3; ++i) w.document().undo();
    DisplaySettings opened;
    opened.light.on = true;
    CHECK(*w.services().store().session().display == opened);
}

TEST_CASE("the faster renderer draws, and the status line says why", "[window]") {
    // By half as much again, or what is expected stays.
    CHECK(RendererTimes{1.0, 1.4}.preferGl(true));
    CHECK_FALSE(RendererTimes{1.0, 1.6}.preferGl(true));
    CHECK(RendererTimes{1.0, 0.6}.preferGl(false));
    CHECK_FALSE(RendererTimes{1.0, 0.7}.preferGl(false));
    CHECK_FALSE(RendererTimes{1.0, {}}.preferGl(true));
    CHECK(timeRenderers().cpu > 0);
    OpenWindow w;
    CHECK_FALSE(w.view().rendererReason().isEmpty());
    OpenWindow cpu(16, ViewRenderer::Cpu);
    CHECK(cpu.view().rendererReason() == "Because it was asked for.");
    CHECK(cpu.child<QLabel>("rendererLabel").toolTip().contains("Because it was asked for."));
}
