// A map of t-values on its anatomy: laid over it, changed, seen in the picture and in slices, taken away.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "render/projected.h"
#include "store/view_edits.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Where the map has its two peaks, mm: t = 8 and t = −8.
const Vec3 kAbove(-6, -2, 3), kBelow(7, 3, -2);

/// head.nrrd: a ball of 16 mm. map.nrrd: two blobs in it, on a coarser grid that is turned.
struct MapFiles {
    QTemporaryDir folder;
    MapFiles() {
        const Geometry head{{20, 20, 20}, Vec3(2), Vec3(-19), Mat3(1), WorldAxes::Patient};
        write("head.nrrd", head, [](const Vec3& p) { return std::max(0.0, 1 - glm::length(p) / 16); });
        Geometry map{{12, 12, 12}, Vec3(3.3, 3, 3.1), Vec3(0), Mat3(1), WorldAxes::Patient};
        map.directions = Mat3(glm::rotate(glm::dmat4(1), 0.4, glm::normalize(Vec3(1, 2, 3))));
        map.origin -= map.boxCenter();
        const auto t = [](const Vec3& p) {
            const auto blob = [&](const Vec3& middle) {
                return 8 * std::exp(-0.06 * glm::dot(p - middle, p - middle));
            };
            return blob(kAbove) - blob(kBelow);
        };
        write("map.nrrd", map, t);
        const Vec3 away(100, 0, 0);
        map.origin += away;
        write("far.nrrd", map, [&](const Vec3& p) { return t(p - away); });
    }
    void write(const char* name, const Geometry& geometry, const std::function<double(const Vec3&)>& value) {
        Grid<float> grid(geometry.dims);
        std::size_t i = 0;
        for (int z = 0; z < geometry.dims.z; ++z)
            for (int y = 0; y < geometry.dims.y; ++y)
                for (int x = 0; x < geometry.dims.x; ++x)
                    grid[i++] = static_cast<float>(value(geometry.worldFromVoxel(Vec3(x, y, z))));
        writeNrrd(geometry, grid, folder.filePath(name).toStdString());
    }
    VolumeSource file(const char* name) const {
        VolumeSource source;
        source.path = folder.filePath(name).toStdString();
        return source;
    }
};

struct MapWindow : OpenWindow {
    explicit MapWindow(const MapFiles& files, ViewRenderer renderer = ViewRenderer::Cpu) : OpenWindow(24, renderer) {
        child<QAction>("overlayAction").trigger();
        QSignalSpy open(&opening(), &OpenController::opened);
        opening().openVolume(files.file("head.nrrd"), "tents:1:0.02"); // faint: what is inside is seen
        REQUIRE(waitFor([&] { return open.count() == 1; }));
        settle();
        QTest::qWait(100); // docks arrange themselves
    }
    void lay(const VolumeSource& source) {
        controllers().overlays.lay(source);
        settle();
    }
    const OverlayView& overlay() { return *services().store().session().overlay; }
    void undo() { child<QAction>("undoAction").trigger(); }
    /// Red minus blue at a place of the world.
    int warmth(const QImage& picture, const Vec3& world) {
        const Vec2 at = Projected(services().scene().camera, picture.width(), picture.height())(world);
        const QRgb c = picture.pixel(static_cast<int>(at.x), static_cast<int>(at.y));
        return qRed(c) - qBlue(c);
    }
};

/// Largest difference of a component.
int farthest(const QImage& a, const QImage& b) {
    int most = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            most = std::max(
                {most, std::abs(qRed(p) - qRed(q)), std::abs(qGreen(p) - qGreen(q)), std::abs(qBlue(p) - qBlue(q))});
        }
    return most;
}

} // namespace

TEST_CASE("a map of t-values is laid over its anatomy, changed and taken away", "[overlay]") {
    const MapFiles files;
    MapWindow w(files);
    const QImage before = w.picture();
    CHECK_FALSE(w.child<QAction>("removeOverlayAction").isEnabled());
    CHECK(w.child<QLabel>("overlayFile").text() == "none");
    w.lay(files.file("map.nrrd"));
    CHECK(w.child<QLabel>("overlayFile").text() == "map.nrrd");
    CHECK(w.child<QCheckBox>("overlayShown").isChecked());
    CHECK(w.child<QLabel>("overlayState").text().contains("Figures in the panel Features are of the volume alone"));
    w.child<QDoubleSpinBox>("overlayOpacity").setValue(0.4);
    const QImage both = w.picture();
    // Red where t is 8, blue where it is −8, each where it lies in the world.
    CHECK(w.warmth(both, kAbove) > w.warmth(before, kAbove) + 40);
    CHECK(w.warmth(both, kBelow) < w.warmth(before, kBelow) - 40);

    // Above 8.1 there is nothing.
    auto& threshold = w.child<QDoubleSpinBox>("overlayThreshold");
    threshold.setValue(8.1);
    CHECK(w.overlay().threshold == 8.1);
    CHECK(farthest(w.picture(), before) <= 2);
    w.undo();
    CHECK_FALSE(w.overlay().threshold);
    CHECK(w.picture() == both);

    // Without the values below 0 there is no blue.
    auto& sides = w.child<QComboBox>("overlaySides");
    sides.setCurrentIndex(1);
    Q_EMIT sides.activated(1);
    CHECK(w.overlay().sides == OverlayView::Sides::One);
    CHECK(std::abs(w.warmth(w.picture(), kBelow) - w.warmth(before, kBelow)) < 10);
    w.undo();

    auto& maps = w.child<QComboBox>("overlayColorMap");
    maps.setCurrentIndex(maps.findData("sand"));
    Q_EMIT maps.activated(maps.currentIndex());
    CHECK(w.overlay().colorMap == "sand");
    CHECK(w.picture() != both);
    w.undo();
    w.child<QDoubleSpinBox>("overlayOpacity").setValue(0.01);
    CHECK(w.overlay().opacity == 0.01);
    CHECK(w.warmth(w.picture(), kAbove) < w.warmth(both, kAbove));
    w.child<QDoubleSpinBox>("overlayOpacity").setValue(0.4);

    w.child<QCheckBox>("overlayShown").click();
    w.settle();
    CHECK_FALSE(w.overlay().shown);
    CHECK(w.picture() == before);
    w.undo();
    CHECK(w.picture() == both);
    w.child<QAction>("removeOverlayAction").trigger();
    CHECK(w.overlay().isNone());
    CHECK(w.picture() == before);
    w.undo();
    CHECK(w.picture() == both);
}

TEST_CASE("slices show the map where it lies, and say its value", "[overlay]") {
    const MapFiles files;
    MapWindow w(files);
    w.child<QAction>("layoutFourAction").trigger();
    w.lay(files.file("map.nrrd"));
    const Geometry& head = w.services().scene().volume->geometry();
    for (const Vec3& place : {kAbove, kBelow}) {
        w.services().store().setCrosshair(head.voxelFromWorld(place));
        for (int axis = 0; axis < 3; ++axis) {
            SlicePane& pane = w.window.views().pane(axis);
            const Vec2 at = pixelOfVoxel(head, pane.plane(), head.voxelFromWorld(place));
            const auto warmth = [&] {
                w.settle();
                const QRgb c = pane.grab().toImage().pixel(static_cast<int>(at.x), static_cast<int>(at.y));
                return qRed(c) - qBlue(c);
            };
            CHECK(waitFor([&] { return place == kAbove ? warmth() > 60 : warmth() < -60; }));
            QMouseEvent move(QEvent::MouseMove, {at.x, at.y}, pane.mapToGlobal(QPointF{at.x, at.y}), Qt::NoButton,
                             Qt::NoButton, Qt::NoModifier);
            QCoreApplication::sendEvent(&pane, &move);
            REQUIRE(pane.hovered());
            // Between the centres of coarse voxels the peak of 8 is flatter.
            const double value = pane.hovered()->overlay.value();
            CHECK(std::abs(value) > 5);
            CHECK((value > 0) == (place == kAbove));
            CHECK(pane.hoverText().contains("overlay "));
        }
    }
}

TEST_CASE("the panel tells the shares of both on request, as long as they hold", "[overlay]") {
    const MapFiles files;
    MapWindow w(files);
    w.lay(files.file("map.nrrd"));
    auto& dock = w.child<QDockWidget>("overlayDock");
    dock.show();
    dock.raise();
    const auto& text = w.child<QLabel>("overlayShares");
    CHECK_FALSE(text.isVisible());
    w.child<QPushButton>("overlayComputeShares").click();
    REQUIRE(waitFor([&] { return text.text().startsWith("Seen in the picture: overlay "); }));
    INFO(text.text().toStdString());
    double sum = 0;
    static const QRegularExpression percents(QStringLiteral("([0-9.]+) %"));
    for (auto found = percents.globalMatch(text.text()); found.hasNext();) sum += found.next().captured(1).toDouble();
    CHECK(sum == Approx(100).margin(0.3)); // each is rounded to a tenth
    Camera turned = w.services().scene().camera;
    turned.eye += Vec3(20, 0, 0);
    w.document().setCamera(turned);
    CHECK_FALSE(text.isVisible());
}

TEST_CASE("an overlay is saved with the session and opened again", "[overlay]") {
    const MapFiles files;
    const QString path = files.folder.filePath("work.pellucid.json");
    QImage saved;
    {
        MapWindow w(files);
        w.lay(files.file("map.nrrd"));
        w.child<QDoubleSpinBox>("overlayThreshold").setValue(3.1);
        saved = w.picture();
        w.saving().saveSession(path);
        w.settle();
        CHECK(w.services().store().isClean());
    }
    MapWindow w(files);
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return !w.overlay().isNone(); }));
    CHECK(w.overlay().threshold == 3.1);
    CHECK(waitFor([&] { return w.picture() == saved; })); // docks arrange themselves
}

TEST_CASE("a map that lies elsewhere is refused with the distance, and nothing changes", "[overlay]") {
    const MapFiles files;
    MapWindow w(files);
    const QImage before = w.picture();
    w.controllers().overlays.lay(files.file("far.nrrd"));
    QDialog* error = nullptr;
    REQUIRE(waitFor([&] { return (error = w.window.findChild<QDialog*>("errorDialog")) != nullptr; }));
    QString said;
    for (const QLabel* label : error->findChildren<QLabel*>()) said += label->text();
    INFO(said.toStdString());
    CHECK(said.contains("do not meet"));
    CHECK(said.contains("mm"));
    error->reject();
    w.settle();
    CHECK(w.overlay().isNone());
    CHECK(w.picture() == before);
}

TEST_CASE("OpenGL leaves the picture to the CPU as long as there is an overlay", "[overlay]") {
    const MapFiles files;
    MapWindow w(files, ViewRenderer::Gl);
    REQUIRE(w.view().drawsByGl());
    const int before = w.warmth(w.picture(), kAbove);
    w.lay(files.file("map.nrrd"));
    CHECK_FALSE(w.view().drawsByGl());
    CHECK(w.view().rendererReason().contains("overlay"));
    CHECK(w.warmth(w.picture(), kAbove) > before + 15);
    w.child<QAction>("removeOverlayAction").trigger();
    w.settle();
    CHECK(w.view().drawsByGl());
    CHECK(w.view().rendererReason() == "Because it was asked for.");
}
