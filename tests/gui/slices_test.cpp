// Slices beside the volume: layouts, the crosshair that they share, the window of grey, and what is read off them.
#include "gui_support.h"

#include <QAction>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QSignalSpy>
#include <QSlider>
#include <QTemporaryDir>
#include <QToolButton>

#include "controllers/field_controller.h"
#include "controllers/probe_controller.h"
#include "store/view_edits.h"
#include "tf/color_maps.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct SliceWindow : OpenWindow {
    explicit SliceWindow(const char* layout = "layoutFourAction") : OpenWindow(24, ViewRenderer::Cpu) {
        child<QAction>(layout).trigger();
        settle();
    }
    SlicePane& pane(int worldAxis) { return window.views().pane(worldAxis); }
    QImage slice(int worldAxis) {
        settle();
        return pane(worldAxis).grab().toImage().convertToFormat(QImage::Format_RGB32);
    }
    SessionStore& store() { return services().store(); }
    Vec3 crosshair() { return crosshairOf(services().scene()); }
    const SliceViews& slices() { return *store().session().slices; }
    /// Where the middle of a voxel is seen.
    QPointF pixelOf(int worldAxis, const Vec3& voxel) {
        const Vec2 p = pixelOfVoxel(services().scene().volume->geometry(), pane(worldAxis).plane(), voxel);
        return {p.x, p.y};
    }
};

void wheel(QWidget& widget, const QPointF& at, int notches, Qt::KeyboardModifiers modifiers = {}) {
    QWheelEvent event(at, widget.mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton, modifiers, Qt::NoScrollPhase,
                      false);
    QCoreApplication::sendEvent(&widget, &event);
}

void moveTo(QWidget& widget, const QPointF& at) {
    QMouseEvent event(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::NoButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
}

void key(QWidget& widget, int code, Qt::KeyboardModifiers modifiers = {}) {
    QKeyEvent event(QEvent::KeyPress, code, modifiers);
    QCoreApplication::sendEvent(&widget, &event);
}

/// By more than the rims of letters and lines do, which are not painted alike each time.
bool differs(QRgb a, QRgb b) {
    return std::max({std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)), std::abs(qBlue(a) - qBlue(b))}) > 8;
}

/// Pixels that differ within a part of the widget, shares of its sides. Title and button, which knows where the mouse
/// is, lie above 0.25, the readout below 0.65.
int differences(const QImage& a, const QImage& b, double left = 0, double top = 0, double right = 1,
                double bottom = 1) {
    REQUIRE(a.size() == b.size());
    int count = 0;
    for (int y = static_cast<int>(top * a.height()); y < static_cast<int>(bottom * a.height()); ++y)
        for (int x = static_cast<int>(left * a.width()); x < static_cast<int>(right * a.width()); ++x)
            count += differs(a.pixel(x, y), b.pixel(x, y)) ? 1 : 0;
    return count;
}

double meanGrey(const QImage& image, const QRect& part) {
    double sum = 0;
    for (int y = part.top(); y <= part.bottom(); ++y)
        for (int x = part.left(); x <= part.right(); ++x) sum += qGray(image.pixel(x, y));
    return sum / (part.width() * part.height());
}

/// 10 × 12 × 14 voxels, RAS: value i + 10·(j mod 5), world LPS (−i, −j, k).
QString writePatient(const QTemporaryDir& folder) {
    const QString path = folder.filePath("head.nrrd");
    QByteArray bytes("NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 10 12 14\n"
                     "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n");
    for (int n = 0; n < 10 * 12 * 14; ++n) bytes.append(static_cast<char>(n % 10 + 10 * (n / 10 % 12 % 5)));
    QFile file(path);
    REQUIRE(file.open(QIODevice::WriteOnly));
    REQUIRE(file.write(bytes) == bytes.size());
    return path;
}

} // namespace

TEST_CASE("a layout shows the volume with three slices, and undo hides them", "[slices]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    ViewGrid& views = w.window.views();
    const auto shown = [&] {
        int count = 0;
        for (int a = 0; a < 3; ++a) count += views.pane(a).isVisible() ? 1 : 0;
        return count;
    };
    CHECK(shown() == 0);
    const TransferFunction tf = w.document().tf();
    const QImage alone = w.picture();
    const int width = w.view().width();
    w.child<QAction>("layoutFourAction").trigger();
    w.settle();
    CHECK(shown() == 3);
    CHECK(w.view().isVisible());
    CHECK(w.view().width() < 0.55 * width);
    for (int a = 0; a < 3; ++a) { // of a size
        CHECK(std::abs(views.pane(a).width() - w.view().width()) <= 4);
        CHECK(std::abs(views.pane(a).height() - w.view().height()) <= 4);
        for (int b = 0; b < a; ++b) CHECK_FALSE(views.pane(a).geometry().intersects(views.pane(b).geometry()));
        CHECK_FALSE(views.pane(a).geometry().intersects(w.view().geometry()));
        CHECK(views.pane(a).grab().toImage().pixelColor(8, views.pane(a).height() / 2).isValid());
    }
    CHECK(w.child<QAction>("layoutFourAction").isChecked());
    w.child<QAction>("layoutVolumeLargeAction").trigger();
    w.settle();
    CHECK(shown() == 3);
    for (int a = 0; a < 3; ++a) CHECK(views.pane(a).width() < 0.5 * w.view().width());
    SessionStore& store = w.services().store();
    store.undo();
    CHECK(store.session().slices->layout == SliceViews::Layout::Four);
    store.undo();
    CHECK(shown() == 0);
    CHECK(w.picture() == alone);
    CHECK(rangeless(w.document().tf()) == rangeless(tf));
}

TEST_CASE("one view can be made large and small again", "[slices]") {
    SliceWindow w;
    SlicePane& z = w.pane(2);
    const QSize small = z.size();
    const QPointF title(30, 10);
    QTest::mouseDClick(&z, Qt::LeftButton, {}, title.toPoint());
    w.settle();
    CHECK_FALSE(w.view().isVisible());
    CHECK_FALSE(w.pane(0).isVisible());
    CHECK(z.width() > 1.8 * small.width());
    QTest::mouseClick(&w.child<QToolButton>("sliceZMaximize"), Qt::LeftButton);
    w.settle();
    CHECK(w.view().isVisible());
    CHECK(z.size() == small);
    CHECK(w.slices() == SliceViews{.layout = SliceViews::Layout::Four});
}

TEST_CASE("left drag moves the crosshair, and the other slices follow", "[slices]") {
    SliceWindow w;
    const int steps = w.document().stepCount();
    CHECK(w.crosshair() == Vec3(12)); // the middle of 24³
    const std::array<QImage, 3> before{w.slice(0), w.slice(1), w.slice(2)};
    const QImage volume = w.picture();
    // On the slice across z from voxel (12, 12) to (6, 17).
    drag(w.pane(2), w.pixelOf(2, {12, 12, 12}), w.pixelOf(2, {6, 17, 12}));
    w.settle();
    CHECK(w.crosshair() == Vec3(6, 17, 12));
    CHECK(w.pane(0).plane().position == 6);
    CHECK(w.pane(1).plane().position == 17);
    CHECK(w.pane(2).plane().position == 12);
    // What the slices show has changed where their crosshair's lines were not and are not: shells are thinner there.
    CHECK(differences(before[0], w.slice(0), 0.25, 0.25, 0.45, 0.45) > 50);
    CHECK(differences(before[1], w.slice(1), 0.55, 0.25, 0.75, 0.45) > 50);
    CHECK(differences(volume, w.picture()) > 20); // the marker in the volume
    // One looks elsewhere; nothing was edited.
    CHECK(w.document().stepCount() == steps);
    // Points of the three slices that show the crosshair are one point of the world.
    const Geometry& g = w.services().scene().volume->geometry();
    for (int a = 0; a < 3; ++a) {
        const QPointF p = w.pixelOf(a, w.crosshair());
        const Vec3 world = g.worldFromVoxel(voxelAtPixel(g, w.pane(a).plane(), {p.x(), p.y()}));
        CHECK(glm::length(world - g.worldFromVoxel({6, 17, 12})) < 1e-9);
    }
    // Esc gives up.
    SlicePane& z = w.pane(2);
    QTest::mousePress(&z, Qt::LeftButton, {}, w.pixelOf(2, {10, 10, 12}).toPoint());
    CHECK(w.crosshair() == Vec3(10, 10, 12));
    key(z, Qt::Key_Escape);
    CHECK(w.crosshair() == Vec3(6, 17, 12));
    QTest::mouseRelease(&z, Qt::LeftButton);
    // A point of the world, as a probe of the volume gives one.
    moveCrosshairToWorld(w.store(), g.worldFromVoxel({3.2, 4.4, 5.6}));
    CHECK(w.crosshair() == Vec3(3, 4, 6));
    w.child<QAction>("centreCrosshairAction").trigger();
    CHECK(w.crosshair() == Vec3(12));
}

TEST_CASE("a click in the volume moves the crosshair to what is seen there", "[slices]") {
    SliceWindow w;
    const QImage before = w.slice(2);
    const QPoint point(w.view().width() / 2 - 30, w.view().height() / 2 - 20);
    QTest::mouseClick(&w.view(), Qt::LeftButton, {}, point);
    const ProbeController& probe = w.controllers().probe;
    REQUIRE(probe.isActive());
    const Vec3 place = w.services().scene().volume->geometry().voxelFromWorld(probe.place());
    // Slices go through middles of voxels: the nearest one.
    for (int a = 0; a < 3; ++a) CHECK(std::abs(w.crosshair()[a] - std::clamp(place[a], 0.0, 23.0)) <= 0.5 + 1e-9);
    CHECK(w.crosshair() != Vec3(12));
    CHECK(differences(before, w.slice(2)) > 50);
    w.child<QAction>("layoutVolumeAction").trigger();
    const Vec3 there = w.crosshair();
    QTest::mouseClick(&w.view(), Qt::LeftButton, {}, point + QPoint(40, 30));
    CHECK(w.crosshair() == there); // nobody sees it move
}

TEST_CASE("wheel and keys go from slice to slice", "[slices]") {
    SliceWindow w;
    SlicePane& z = w.pane(2);
    const QImage before = w.slice(2);
    wheel(z, {40, 60}, 1);
    CHECK(w.crosshair() == Vec3(12, 12, 13));
    wheel(z, {40, 60}, -2);
    CHECK(w.crosshair() == Vec3(12, 12, 11));
    key(z, Qt::Key_PageUp);
    key(z, Qt::Key_Up);
    CHECK(w.crosshair() == Vec3(12, 12, 13));
    key(z, Qt::Key_Down);
    key(z, Qt::Key_PageDown, Qt::ShiftModifier);
    CHECK(w.crosshair() == Vec3(12, 12, 2));
    CHECK(differences(before, w.slice(2), 0.3, 0.3, 0.45, 0.45) > 50);
    wheel(z, {40, 60}, -9); // not beyond the first
    CHECK(w.crosshair() == Vec3(12, 12, 0));
    wheel(w.pane(0), {40, 60}, 3);
    CHECK(w.crosshair() == Vec3(15, 12, 0));
}

TEST_CASE("a slice is zoomed about the mouse, moved, and fitted again", "[slices]") {
    SliceWindow w;
    SlicePane& z = w.pane(2);
    const SlicePlane fitted = z.plane();
    const QImage before = w.slice(2);
    const Geometry& g = w.services().scene().volume->geometry();
    const QPointF at = w.pixelOf(2, {5, 9, 12});
    wheel(z, at, 4, Qt::ControlModifier);
    // 1.15⁴ of the zoom, with the voxel under the mouse where it was.
    CHECK(fitted.shown.width / z.plane().shown.width == Approx(std::pow(1.15, 4)));
    const Vec3 held = voxelAtPixel(g, z.plane(), {at.x(), at.y()});
    CHECK(held.x == Approx(5));
    CHECK(held.y == Approx(9));
    CHECK(differences(before, w.slice(2)) > 500);
    drag(z, {60, 60}, {90, 50}, Qt::MiddleButton);
    const Vec3 moved = voxelAtPixel(g, z.plane(), {at.x() + 30, at.y() - 10});
    CHECK(moved.x == Approx(5));
    CHECK(moved.y == Approx(9));
    CHECK(w.crosshair() == Vec3(12));
    // Double-click fits, and its first click leaves the crosshair where it was.
    QTest::mouseClick(&z, Qt::LeftButton, {}, QPoint(60, 70));
    QTest::mouseDClick(&z, Qt::LeftButton, {}, QPoint(60, 70));
    CHECK(z.plane() == fitted);
    CHECK(w.crosshair() == Vec3(12));
    moveTo(z, {1, 1});
    CHECK(differences(before, w.slice(2), 0, 0.25, 1, 0.65) == 0);
}

TEST_CASE("right drag sets the window of grey, a right double-click resets it", "[slices]") {
    SliceWindow w;
    w.child<QSlider>("sliceStrength").setValue(0); // grey alone
    CHECK(w.slices().tfStrength == 0);
    SlicePane& z = w.pane(2);
    const ValueRange all = w.services().scene().volume->range();
    const QImage before = w.slice(2);
    const TransferFunction tf = w.document().tf();
    // 100 pixels to the right double the width, 100 upward raise the level by half a width: the start's.
    const QPointF from(60, z.height() - 40.0);
    drag(z, from, from + QPointF(100, -100), Qt::RightButton);
    REQUIRE(w.slices().window);
    const double span = all.hi - all.lo;
    CHECK(w.slices().window->hi - w.slices().window->lo == Approx(2 * span));
    CHECK((w.slices().window->hi + w.slices().window->lo) / 2 == Approx(all.lo + span)); // clamped to the largest value
    CHECK(w.child<QDoubleSpinBox>("greyLo").value() == Approx(w.slices().window->lo).margin(0.01 * span));
    // Wider, and its middle is at the largest value: a voxel's grey g becomes (g − 0)/2: at most half as bright.
    const QImage wide = w.slice(2);
    const QRect part(z.width() / 4, z.height() / 4, z.width() / 5, z.height() / 5);
    REQUIRE(meanGrey(before, part) > 20);
    CHECK(meanGrey(wide, part) == Approx(meanGrey(before, part) / 2).epsilon(0.05));
    CHECK(w.document().tf() == tf);
    CHECK(w.store().undoText() == "Window of grey");
    w.store().undo();
    CHECK_FALSE(w.slices().window);
    CHECK(differences(before, w.slice(2), 0, 0.25, 1, 0.65) == 0);
    w.store().redo();
    QTest::mouseDClick(&z, Qt::RightButton, {}, QPoint(60, 70));
    CHECK_FALSE(w.slices().window);
    w.store().undo();
    CHECK(w.slices().window);
    CHECK(w.child<QAction>("resetGreyWindowAction").isEnabled());
    w.child<QAction>("resetGreyWindowAction").trigger();
    CHECK_FALSE(w.slices().window);
}

TEST_CASE("slices have the colours of the transfer function, without hidden features", "[slices]") {
    SliceWindow w;
    const QImage before = w.slice(2), other = w.slice(0);
    TransferFunction blue = w.document().tf();
    for (ControlPoint& p : blue.points) p.color = {0, 0, 1};
    editTf(w.store(), blue, "Blue");
    const QImage after = w.slice(2);
    CHECK(differences(before, after) > 200);
    CHECK(differences(other, w.slice(0)) > 200);
    w.store().undo();
    CHECK(differences(before, w.slice(2)) == 0);
    // What the eye of a feature hides is grey, as with no colours at all.
    TransferFunction hidden = w.document().tf();
    for (Feature& f : hidden.features) f.hidden = true;
    editTf(w.store(), hidden, "Hide");
    const QImage grey = w.slice(2);
    CHECK(differences(before, grey) > 200);
    for (int i = 2; i < 22; ++i) { // along a row of voxels that no line of the crosshair covers
        const QColor c = grey.pixelColor(w.pixelOf(2, {static_cast<double>(i), 8, 12}).toPoint());
        if (i == 12) continue;
        CHECK(c.red() == c.green());
        CHECK(c.red() == c.blue());
    }
    w.store().undo();
    w.child<QSlider>("sliceStrength").setValue(100);
    CHECK(w.slices().tfStrength == 1);
    CHECK(differences(before, w.slice(2)) > 200);
    w.store().undo();
    CHECK(w.slices().tfStrength == 0.5);
}

TEST_CASE("what is clipped away is dimmed", "[slices]") {
    SliceWindow w;
    w.child<QSlider>("sliceStrength").setValue(0);
    const QImage before = w.slice(2);
    w.store().edit("Clip", {}, [](Session& session) { session.clipping.edit([](Clipping& c) { c.hi.x = 0.5; }); });
    const QImage after = w.slice(2);
    // x runs to the right: the left half stays as it was, the right one has 35 % of its brightness.
    const SlicePane& z = w.pane(2);
    const QRect kept(z.width() / 2 - 40, z.height() / 3, 20, 20), gone(z.width() / 2 + 20, z.height() / 3, 20, 20);
    CHECK(meanGrey(after, kept) == meanGrey(before, kept));
    REQUIRE(meanGrey(before, gone) > 20);
    CHECK(meanGrey(after, gone) == Approx(0.35 * meanGrey(before, gone)).epsilon(0.03));
}

TEST_CASE("the value under the mouse is the voxel's", "[slices]") {
    SliceWindow w;
    const Volume& volume = *w.services().scene().volume;
    SlicePane& y = w.pane(1);
    for (const Vec3 voxel : {Vec3(7, 12, 15), Vec3(16, 12, 4), Vec3(12, 12, 12)}) {
        moveTo(y, w.pixelOf(1, voxel));
        REQUIRE(y.hovered());
        REQUIRE(y.hovered()->value);
        const double value = std::visit(
            [&](const auto& samples) {
                return static_cast<double>(samples[static_cast<std::size_t>(voxel.x + 24 * (voxel.y + 24 * voxel.z))]);
            },
            volume.samples());
        CHECK(*y.hovered()->value == value);
        CHECK(glm::length(y.hovered()->world - volume.geometry().worldFromVoxel(voxel)) < 1e-9);
        REQUIRE(w.services().selection().hoveredIntensity());
        CHECK(*w.services().selection().hoveredIntensity() == volume.intensityOfValue(value));
        const int feature = featureAt(w.document().tf().features, volume.intensityOfValue(value));
        if (feature >= 0)
            CHECK(y.hoverText().toStdString().find(
                      w.document().tf().features[static_cast<std::size_t>(feature)].name) != std::string::npos);
    }
    moveTo(y, {2, y.height() / 2.0}); // beside the box, which fills 94 %
    CHECK_FALSE(y.hovered());
    CHECK(y.hoverText().isEmpty());
    CHECK_FALSE(w.services().selection().hoveredIntensity());
    moveTo(y, w.pixelOf(1, {7, 12, 15}));
    QEvent leave(QEvent::Leave);
    QCoreApplication::sendEvent(&y, &leave);
    CHECK_FALSE(w.services().selection().hoveredIntensity());
}

TEST_CASE("slices show the field that is chosen, through its colour map", "[slices][fields]") {
    SliceWindow w;
    const FieldController& fields = w.controllers().fields;
    const QImage data = w.slice(2);
    CHECK(w.pane(2).titleText().count('\n') == 0);
    w.child<QAction>("field_visibility").trigger();
    w.settle();
    REQUIRE(fields.state() == FieldController::State::Current);
    const QImage field = w.slice(2);
    CHECK(differences(data, field) > 500);
    // A pixel is the field between the voxels there, in the colours of its map from 0 to its top; away from the lines
    // of the crosshair.
    const SlicePlane plane = w.pane(2).plane();
    const Volume& values = *fields.field()->volume;
    const FieldView& view = *w.store().session().field;
    const ColorMap& map = colorMapNamed(view.colorMap);
    const double top = topOf(view, *fields.field());
    int seen = 0;
    for (const double x : {6.0, 8.0, 9.5, 15.0, 17.0})
        for (const double y : {7.0, 8.5, 15.5, 17.0}) {
            const QPoint pixel = w.pixelOf(2, {x, y, 12}).toPoint();
            const Vec3 voxel = voxelAtPixel(values.geometry(), plane, {pixel.x() + 0.5, pixel.y() + 0.5});
            const double value = valueAt(values, voxel).value();
            const Rgb expected = map.colorAt(std::min(1.0, value / top));
            const QColor c = field.pixelColor(pixel);
            CHECK(std::abs(c.red() - 255 * expected.r) < 6); // the map is drawn as a line of points
            CHECK(std::abs(c.green() - 255 * expected.g) < 6);
            CHECK(std::abs(c.blue() - 255 * expected.b) < 6);
            seen += value > 0.1 * top ? 1 : 0;
        }
    CHECK(seen > 3);
    // What saliency has nothing to do with: grey of the data is out of reach, and says why.
    CHECK_FALSE(w.child<QSlider>("sliceStrength").isEnabled());
    CHECK(w.child<QLabel>("sliceFieldNote").isVisible());
    const int steps = w.document().stepCount();
    drag(w.pane(2), {60, 60}, {120, 40}, Qt::RightButton);
    CHECK(w.document().stepCount() == steps);

    // Under the mouse stands the field's value, beside that of the data.
    SlicePane& z = w.pane(2);
    moveTo(z, w.pixelOf(2, {8, 9, 12}));
    REQUIRE(z.hovered());
    REQUIRE(z.hovered()->field);
    CHECK(*z.hovered()->field == values.value(8 + 24 * (9 + 24 * 12)));
    CHECK(*z.hovered()->value == w.document().volume()->value(8 + 24 * (9 + 24 * 12)));
    CHECK(z.hoverText().startsWith("Visibility " + QString::number(*z.hovered()->field, 'g', 4) + " (0 to 1)"));
    CHECK(z.titleText().endsWith("\nVisibility"));

    // Of an earlier view it says so until its own is there.
    const std::shared_ptr<const Volume> before = fields.field()->volume;
    drag(w.view(), w.view().rect().center(), w.view().rect().center() + QPoint(90, 10));
    CHECK(z.titleText().endsWith("\nVisibility\nof an earlier state; the present one: being computed"));
    w.settle();
    CHECK(z.titleText().endsWith("\nVisibility"));
    CHECK(fields.field()->volume != before);
    moveTo(z, {1, 1});
    CHECK(differences(field, w.slice(2), 0.25, 0.25, 0.75, 0.65) > 100);

    // The data come back as they were.
    w.child<QAction>("fieldAction").trigger();
    CHECK(differences(data, w.slice(2), 0, 0.25, 1, 0.65) == 0);
    CHECK(w.child<QSlider>("sliceStrength").isEnabled());
    moveTo(z, w.pixelOf(2, {8, 9, 12}));
    CHECK_FALSE(z.hovered()->field);
}

TEST_CASE("a large slice has the legend of its field", "[slices][fields]") {
    SliceWindow w;
    w.child<QAction>("field_vws").trigger();
    w.window.views().maximize(&w.pane(2));
    const QImage strong = w.slice(2);
    // Another top is another scale at the right edge, and other colours.
    w.store().edit("Top", {}, [](Session& s) { s.field.edit([](FieldView& f) { f.top = 1; }); });
    CHECK(differences(strong, w.slice(2), 0.85, 0, 1, 0.4) > 50);
}

TEST_CASE("slices of a patient lie as radiologists are used to", "[slices]") {
    SliceWindow w;
    w.store().undo(); // the layout: what is unsaved would be asked about
    const QTemporaryDir folder;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(writePatient(folder));
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.child<QAction>("layoutFourAction").trigger();
    w.settle();
    // The file is RAS, the world LPS: i runs to the right, j to the front. Axial from the feet: the patient's right,
    // large i, at the left; the front, large j, up.
    CHECK(w.pixelOf(2, {9, 5, 7}).x() < w.pixelOf(2, {0, 5, 7}).x());
    CHECK(w.pixelOf(2, {5, 11, 7}).y() < w.pixelOf(2, {5, 0, 7}).y());
    // Coronal: right at the left, head up. Sagittal from the left: the front at the left, head up.
    CHECK(w.pixelOf(1, {9, 5, 7}).x() < w.pixelOf(1, {0, 5, 7}).x());
    CHECK(w.pixelOf(1, {5, 5, 13}).y() < w.pixelOf(1, {5, 5, 0}).y());
    CHECK(w.pixelOf(0, {5, 11, 7}).x() < w.pixelOf(0, {5, 0, 7}).x());
    CHECK(w.pixelOf(0, {5, 5, 13}).y() < w.pixelOf(0, {5, 5, 0}).y());
    // The wheel goes up to the head, and to the left, which is toward small i.
    wheel(w.pane(2), {40, 60}, 1);
    CHECK(w.crosshair() == Vec3(5, 6, 8));
    wheel(w.pane(0), {40, 60}, 1);
    CHECK(w.crosshair() == Vec3(4, 6, 8));
    moveTo(w.pane(2), w.pixelOf(2, {3, 6, 8}));
    CHECK(*w.pane(2).hovered()->value == 3 + 10 * (6 % 5));
    CHECK(w.pane(2).hoverText().contains("mm"));
    CHECK(glm::length(w.pane(2).hovered()->world - Vec3(-3, -6, 8)) < 1e-9);
    CHECK(w.pane(2).edgeLetters() == QStringList{"L", "R", "A", "P"}); // right, left, up, down
    CHECK(w.pane(1).edgeLetters() == QStringList{"L", "R", "S", "I"});
    CHECK(w.pane(0).edgeLetters() == QStringList{"P", "A", "S", "I"});
}

TEST_CASE("a session keeps layout, crosshair and window of the slices", "[slices]") {
    const QTemporaryDir folder;
    const QString path = folder.filePath("slices.pellucid.json");
    QImage shown;
    SliceViews kept;
    {
        SliceWindow w("layoutVolumeLargeAction");
        drag(w.pane(2), w.pixelOf(2, {12, 12, 12}), w.pixelOf(2, {8, 15, 12}));
        w.child<QDoubleSpinBox>("greyHi").setValue(0.7 * w.services().scene().volume->range().hi);
        kept = w.slices();
        CHECK(kept.crosshair == Vec3(8, 15, 12));
        CHECK(kept.window);
        REQUIRE(w.saving().saveSession(path));
        moveTo(w.pane(0), {1, 1});
        w.pane(0).clearFocus();
        shown = w.slice(0);
    }
    OpenWindow w(20, ViewRenderer::Cpu);
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(*w.services().store().session().slices == kept);
    SlicePane& x = w.window.views().pane(0);
    REQUIRE(x.isVisible());
    x.clearFocus();
    w.settle();
    const QImage again = x.grab().toImage().convertToFormat(QImage::Format_RGB32);
    REQUIRE(again.size() == shown.size());
    CHECK(differences(again, shown, 0, 0.25, 1, 0.65) == 0);
}
