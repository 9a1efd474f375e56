// Measures: set by clicks in picture and slices, changed by drags, listed, kept and exported.
#include "gui_support.h"

#include <QAction>
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <QTemporaryDir>
#include <QTreeWidget>

#include <glm/geometric.hpp>

#include "base/round_numbers.h"
#include "session/session_json.h"
#include "store/view_edits.h"
#include "view/slice_pane.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

RulerController& rulersOf(OpenWindow& w) { return w.controllers().rulers; }
const std::vector<Ruler>& allOf(OpenWindow& w) { return *w.services().scene().session.rulers; }

/// Press and release without a motion.
void click(QWidget& widget, const QPointF& at) {
    for (const QEvent::Type type : {QEvent::MouseButtonPress, QEvent::MouseButtonRelease}) {
        QMouseEvent event(type, at, widget.mapToGlobal(at), Qt::LeftButton,
                          type == QEvent::MouseButtonPress ? Qt::LeftButton : Qt::NoButton, {});
        QCoreApplication::sendEvent(&widget, &event);
    }
}

void moveTo(QWidget& widget, const QPointF& at) {
    QMouseEvent event(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::NoButton, {});
    QCoreApplication::sendEvent(&widget, &event);
}

QPointF middle(QWidget& widget) { return QRectF(widget.rect()).center(); }

PictureView pictureIn(OpenWindow& w) { return {w.services().scene().camera, w.view().width(), w.view().height()}; }

void trigger(OpenWindow& w, const char* action) { w.child<QAction>(action).trigger(); }

SlicePane& axial(OpenWindow& w) {
    setLayout(w.services().store(), SliceViews::Layout::Four);
    w.settle();
    return w.child<SlicePane>("sliceZ");
}

/// Where a voxel lies in the pane.
QPointF pixelIn(OpenWindow& w, SlicePane& pane, const Vec3& voxel) {
    const Vec2 at = pixelOfVoxel(w.services().scene().volume->geometry(), pane.plane(), voxel);
    return {at.x, at.y};
}

Ruler sphereAt(OpenWindow& w, const Vec3& voxel, double radius) {
    return {.kind = RulerKind::Sphere,
            .points = {w.services().scene().volume->geometry().worldFromVoxel(voxel)},
            .radius = radius};
}

void addOne(OpenWindow& w, const Ruler& ruler) {
    editPart(w.services().store(), &Session::rulers, "Measure", {},
             [&](std::vector<Ruler>& rulers) { addRuler(rulers, ruler); });
    w.settle();
}

QString cell(OpenWindow& w, int row, int column) {
    const QTreeWidget& list = w.child<QTreeWidget>("measureList");
    REQUIRE(row < list.topLevelItemCount());
    return list.topLevelItem(row)->text(column);
}

} // namespace

TEST_CASE("two clicks in the picture measure the distance of what is seen there", "[measures]") {
    OpenWindow w(32);
    const QPointF a = middle(w.view()) + QPointF(-40, 10), b = middle(w.view()) + QPointF(50, -20);
    const auto placeAt = [&](const QPointF& at) {
        return rulersOf(w).seenAt(w.document().camera(), at, QSizeF(w.view().size())).value();
    };
    const Vec3 first = placeAt(a), second = placeAt(b);
    trigger(w, "measureDistanceAction");
    CHECK(w.child<QWidget>("measuresDock").isVisible());
    CHECK(w.child<QAction>("measureDistanceAction").isChecked());
    CHECK(w.child<QLabel>("measureHint").text().contains("Click on one end"));
    click(w.view(), a);
    CHECK(allOf(w).empty());
    // What would come of the next click is drawn while the mouse goes there.
    const QImage before = w.picture();
    moveTo(w.view(), b);
    CHECK(w.picture() != before);
    click(w.view(), b);
    REQUIRE(allOf(w).size() == 1);
    CHECK_FALSE(rulersOf(w).placing());
    CHECK(glm::length(allOf(w)[0].points[0] - first) < 1e-9);
    CHECK(glm::length(allOf(w)[0].points[1] - second) < 1e-9);
    CHECK(cell(w, 0, 0) == "Distance 1");
    CHECK(cell(w, 0, 2) == QString::fromStdString(plainText(glm::length(second - first))) + " units");
    CHECK_FALSE(w.controllers().probe.isActive()); // the clicks were not for the probe
    // One step, which undo takes back and redo brings again.
    CHECK(w.document().stepCount() == 1);
    w.document().undo();
    CHECK(allOf(w).empty());
    CHECK(w.child<QTreeWidget>("measureList").topLevelItemCount() == 0);
    w.document().redo();
    CHECK(allOf(w).size() == 1);
    // The next click is the probe's again.
    click(w.view(), middle(w.view()));
    CHECK(w.controllers().probe.isActive());
}

TEST_CASE("clicks beside the volume set no point, Esc cancels, drags turn the view", "[measures]") {
    OpenWindow w(24);
    QSignalSpy said(&w.services(), &Services::message);
    trigger(w, "measureDistanceAction");
    click(w.view(), {3, 3});
    CHECK(said.back().front().toString().contains("There is nothing there"));
    click(w.view(), middle(w.view()));
    const Camera camera = w.document().camera();
    drag(w.view(), middle(w.view()) + QPointF(30, 0), middle(w.view()) + QPointF(90, 20));
    CHECK_FALSE(w.document().camera() == camera);
    CHECK(rulersOf(w).placing());
    QTest::keyClick(&w.view(), Qt::Key_Escape);
    CHECK_FALSE(rulersOf(w).placing());
    CHECK(allOf(w).empty());
    CHECK(w.document().stepCount() == 0);
    // The menu's entry a second time does the same.
    trigger(w, "measureAngleAction");
    trigger(w, "measureAngleAction");
    CHECK_FALSE(rulersOf(w).placing());
}

TEST_CASE("three clicks measure an angle, quick ones too", "[measures]") {
    OpenWindow w(24);
    trigger(w, "measureAngleAction");
    click(w.view(), middle(w.view()) + QPointF(-50, 0));
    click(w.view(), middle(w.view()));
    // A second press in a row comes as a double-click, and does not fit the view.
    const Camera camera = w.document().camera();
    const QPointF at = middle(w.view()) + QPointF(0, -50);
    QMouseEvent twice(QEvent::MouseButtonDblClick, at, w.view().mapToGlobal(at), Qt::LeftButton, Qt::LeftButton, {});
    QCoreApplication::sendEvent(&w.view(), &twice);
    QMouseEvent release(QEvent::MouseButtonRelease, at, w.view().mapToGlobal(at), Qt::LeftButton, Qt::NoButton, {});
    QCoreApplication::sendEvent(&w.view(), &release);
    REQUIRE(allOf(w).size() == 1);
    CHECK(w.document().camera() == camera);
    CHECK(cell(w, 0, 1) == "Angle");
    CHECK(cell(w, 0, 2) == QString::number(*readGeometry(allOf(w)[0]).angle, 'f', 1) + "°");
}

TEST_CASE("spheres are set in slices, and say what the voxels in them have", "[measures]") {
    OpenWindow w(24);
    SlicePane& pane = axial(w);
    const Volume& volume = *w.services().scene().volume;
    const Vec3 center = crosshairOf(w.services().scene());
    trigger(w, "measureSphereAction");
    click(pane, pixelIn(w, pane, center));
    click(pane, pixelIn(w, pane, center + Vec3(4, 0, 0)));
    REQUIRE(allOf(w).size() == 1);
    const Ruler& sphere = allOf(w)[0];
    CHECK(glm::length(sphere.points[0] - volume.geometry().worldFromVoxel(center)) < 1e-6);
    CHECK(sphere.radius == Approx(4 * volume.geometry().spacing.x));
    w.settle(); // its values are found in the background
    const BodyValues values = valuesInSphere(volume, sphere.points[0], sphere.radius);
    REQUIRE(values.count > 200);
    const RulerReadings readings = rulersOf(w).readings();
    REQUIRE(readings.at(1).values);
    CHECK(readings.at(1).values->mean == values.mean);
    CHECK(cell(w, 0, 2).contains(QStringLiteral(" ± ")));
    CHECK(w.child<QTreeWidget>("measureList")
              .topLevelItem(0)
              ->toolTip(2)
              .contains(QString::number(values.count) + " voxels"));
    // The crosshair stayed: the clicks were for the sphere.
    CHECK(crosshairOf(w.services().scene()) == center);
}

TEST_CASE("the mouse drags ends, rims and faces, each drag one step", "[measures]") {
    OpenWindow w(24);
    SlicePane& pane = axial(w);
    const Geometry& g = w.services().scene().volume->geometry();
    const Vec3 center = crosshairOf(w.services().scene());
    addOne(w, sphereAt(w, center, 3 * g.spacing.x));
    const int steps = w.document().stepCount();
    // Its rim, 3 voxels to the right, goes to 5: x grows to the right in the file's own axes.
    drag(pane, pixelIn(w, pane, center + Vec3(3, 0, 0)), pixelIn(w, pane, center + Vec3(5, 0, 0)));
    CHECK(allOf(w)[0].radius == Approx(5 * g.spacing.x));
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(rulersOf(w).selected() == 1);
    // Its centre.
    drag(pane, pixelIn(w, pane, center), pixelIn(w, pane, center + Vec3(0, 2, 0)));
    CHECK(glm::length(allOf(w)[0].points[0] - g.worldFromVoxel(center + Vec3(0, 2, 0))) < 1e-6);
    w.document().undo();
    w.document().undo();
    CHECK(allOf(w)[0].radius == Approx(3 * g.spacing.x));

    // In the picture: the centre stays at its depth.
    const PictureView picture = pictureIn(w);
    const auto at = pixelOf(picture, allOf(w)[0].points[0]);
    const double depth = glm::dot(allOf(w)[0].points[0] - picture.camera.eye, picture.camera.forward());
    drag(w.view(), {at->x, at->y}, {at->x + 20, at->y});
    const Vec3 moved = allOf(w)[0].points[0];
    CHECK(glm::dot(moved - picture.camera.eye, picture.camera.forward()) == Approx(depth));
    const auto now = pixelOf(picture, moved);
    CHECK(now->x == Approx(at->x + 20));
    // Delete removes the selected one.
    QTest::keyClick(&w.view(), Qt::Key_Delete);
    CHECK(allOf(w).empty());
}

TEST_CASE("a drag can be given up", "[measures]") {
    OpenWindow w(24);
    SlicePane& pane = axial(w);
    const Vec3 center = crosshairOf(w.services().scene());
    addOne(w, sphereAt(w, center, 3 * w.services().scene().volume->geometry().spacing.x));
    const Ruler before = allOf(w)[0];
    const int steps = w.document().stepCount();
    const QPointF from = pixelIn(w, pane, center + Vec3(3, 0, 0)), to = from + QPointF(30, 0);
    QMouseEvent press(QEvent::MouseButtonPress, from, pane.mapToGlobal(from), Qt::LeftButton, Qt::LeftButton, {});
    QCoreApplication::sendEvent(&pane, &press);
    QMouseEvent move(QEvent::MouseMove, to, pane.mapToGlobal(to), Qt::NoButton, Qt::LeftButton, {});
    QCoreApplication::sendEvent(&pane, &move);
    CHECK(allOf(w)[0].radius > before.radius);
    QTest::keyClick(&pane, Qt::Key_Escape);
    CHECK(allOf(w)[0] == before);
    CHECK(w.document().stepCount() == steps);
}

TEST_CASE("the list renames, hides and removes", "[measures]") {
    OpenWindow w(24);
    w.services().panels().show("measures");
    addOne(w, {.kind = RulerKind::Distance, .points = {{0, 0, 0}, {1, 2, 2}}});
    addOne(w, boxRuler({0, 0, 0}, {2, 2, 2}));
    auto& list = w.child<QTreeWidget>("measureList");
    REQUIRE(list.topLevelItemCount() == 2);
    CHECK(cell(w, 0, 2) == "3 units");
    list.topLevelItem(0)->setText(0, "ear to ear");
    REQUIRE(waitFor([&] { return allOf(w)[0].name == "ear to ear"; }));
    const QImage shown = w.picture();
    list.topLevelItem(0)->setCheckState(0, Qt::Unchecked);
    REQUIRE(waitFor([&] { return !allOf(w)[0].shown; }));
    CHECK(w.picture() != shown);
    w.document().undo();
    CHECK(list.topLevelItem(0)->checkState(0) == Qt::Checked);
    list.setCurrentItem(list.topLevelItem(1));
    CHECK(rulersOf(w).selected() == 2);
    QTest::keyClick(&list, Qt::Key_Delete);
    REQUIRE(allOf(w).size() == 1);
    CHECK(allOf(w)[0].name == "ear to ear");
    // Annotations hide all of them, and handles with them.
    trigger(w, "frameMeasuresAction");
    CHECK(rulersOf(w).shown().empty());
    CHECK(rulersOf(w).draggable().empty());
}

TEST_CASE("a session keeps measures and coordinates, and a table has both", "[measures]") {
    const QTemporaryDir folder;
    OpenWindow w(24);
    addOne(w, {.kind = RulerKind::Distance, .points = {{0, 0, 0}, {1, 2, 2}}});
    addOne(w, sphereAt(w, {12, 12, 12}, 3));
    w.services().panels().show("measures");
    auto& coordinates = w.child<QComboBox>("coordinates");
    coordinates.setCurrentIndex(1);
    Q_EMIT coordinates.activated(1);
    CHECK(w.services().scene().session.coordinates->axes == PatientAxes::Ras);
    const QString file = folder.filePath("s.pellucid.json"), table = folder.filePath("m.csv");
    REQUIRE(w.saving().saveSession(file));
    const Session again = readSession(file.toStdString()).session;
    CHECK(*again.rulers == allOf(w));
    CHECK(again.coordinates->axes == PatientAxes::Ras);
    REQUIRE(rulersOf(w).exportTo(table));
    QFile read(table);
    REQUIRE(read.open(QIODevice::ReadOnly));
    const QString text = QString::fromUtf8(read.readAll());
    CHECK(text.contains("Distance 1,distance,3,"));
    CHECK(text.contains("Sphere 1,sphere,"));
    // Another volume has none of them.
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 16;
    w.open(source);
    CHECK(allOf(w).empty());
    CHECK(rulersOf(w).selected() == 0);
}

TEST_CASE("saved pictures have the measures, without them where nothing is to be written over", "[measures]") {
    const QTemporaryDir folder;
    OpenWindow w(24);
    QSignalSpy saved(&w.saving(), &SaveController::imageSaved);
    const auto save = [&](const char* name) {
        w.saving().saveImage({folder.filePath(name), QSize(160, 120), false, true});
        REQUIRE(waitFor([&] { return saved.count() > 0; }));
        saved.clear();
        return QImage(folder.filePath(name));
    };
    const QImage without = save("a.png");
    addOne(w, {.kind = RulerKind::Distance, .points = {{-5, 0, 0}, {25, 20, 20}}});
    CHECK(save("b.png") != without);
}
