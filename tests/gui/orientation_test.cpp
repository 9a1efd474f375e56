// Data that are turned, mirrored, or whose axes or spacing the user states.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QTimer>

#include <glm/geometric.hpp>

#include "dialogs/axes_dialog.h"
#include "dialogs/spacing_dialog.h"
#include "session/variable_edits.h"
#include "volume/orientation.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

const Geometry& geometryOf(OpenWindow& w) { return w.services().scene().volume->geometry(); }

void choose(OpenWindow& w, const char* action) {
    w.child<QAction>(action).trigger();
    w.settle();
}

/// Where a direction of the grid points in the picture: x to the right, y up, z toward the viewer.
Vec3 seen(OpenWindow& w, const Vec3& voxels) {
    const Camera& c = w.services().scene().camera;
    const Vec3 world = geometryOf(w).worldFromIndex() * voxels;
    return {glm::dot(world, c.right()), glm::dot(world, c.trueUp()), -glm::dot(world, c.forward())};
}

void lookFromTheFront(OpenWindow& w) {
    w.child<QAction>("view1").trigger();
    w.settle();
}

} // namespace

TEST_CASE("quarter turns go the way the picture shows, and undo", "[gui][orientation]") {
    OpenWindow w;
    lookFromTheFront(w); // i to the right, k up, j away from the viewer
    const Vec3 near(0, -1, 0), top(0, 0, 1), left(-1, 0, 0);
    REQUIRE(seen(w, near).z == Approx(1));
    const QImage before = w.picture();
    const struct {
        const char* action;
        Vec3 what, goes; // voxels; in the picture
    } turns[] = {{"turnLeftAction", near, {-1, 0, 0}},    {"turnRightAction", near, {1, 0, 0}},
                 {"tipForwardAction", top, {0, 0, 1}},    {"tipBackAction", top, {0, 0, -1}},
                 {"turnClockwiseAction", top, {1, 0, 0}}, {"turnAnticlockwiseAction", top, {-1, 0, 0}},
                 {"mirrorAction", left, {1, 0, 0}}};
    for (const auto& turn : turns) {
        INFO(turn.action);
        choose(w, turn.action);
        const Vec3 now = seen(w, turn.what);
        for (int axis = 0; axis < 3; ++axis) CHECK(now[axis] == Approx(turn.goes[axis]).margin(1e-9));
        CHECK(largestDifference(before, w.picture()) > 30);
        w.document().undo();
        w.settle();
        CHECK(axesText(geometryOf(w)) == "+x, +y, +z");
        CHECK(largestDifference(before, w.picture()) <= 2);
    }
}

TEST_CASE("a note stays as long as the data do not lie as the file says", "[gui][orientation]") {
    OpenWindow w;
    const auto& note = w.child<QLabel>("noticeText");
    choose(w, "turnLeftAction");
    CHECK(note.text().contains("Turned: the data do not lie as the file says."));
    choose(w, "mirrorAction");
    CHECK(note.text().contains("Mirrored: left and right are not as in the file."));
    CHECK_FALSE(note.text().contains("Turned"));
    CHECK(annotationInput(pictureInput(w.services().scene(), 64, 48), {}).title == "shells, mirrored");
    w.child<QPushButton>("noticeChoice0").click();
    w.settle();
    CHECK_FALSE(note.text().contains("Mirrored"));
    CHECK(axesText(geometryOf(w)) == "+x, +y, +z");
    CHECK(annotationInput(pictureInput(w.services().scene(), 64, 48), {}).title == "shells");
}

TEST_CASE("a patient is not mirrored without a question", "[gui][orientation]") {
    OpenWindow w;
    w.opening().editData("A patient", [](Session& s) { setDataAxes(s, parseGridAxes("LPS")); });
    w.settle();
    const auto answer = [&](QMessageBox::StandardButton with) {
        QTimer::singleShot(0, &w.window, [&w, with] {
            for (auto* box : w.window.findChildren<QMessageBox*>()) box->button(with)->click();
        });
        choose(w, "mirrorAction");
    };
    answer(QMessageBox::Cancel);
    CHECK(axesText(geometryOf(w)) == "R→L, A→P, I→S");
    answer(QMessageBox::Yes);
    CHECK(axesText(geometryOf(w)) != "R→L, A→P, I→S");
}

TEST_CASE("measures go along with data that are turned", "[gui][orientation]") {
    OpenWindow w;
    const Vec3 a(4, 5, 6), b(20, 9, 11); // voxels
    editPart(w.services().store(), &Session::rulers, "Measure", {}, [&](std::vector<Ruler>& rulers) {
        addRuler(rulers, {.points = {geometryOf(w).worldFromVoxel(a), geometryOf(w).worldFromVoxel(b)}});
    });
    choose(w, "tipForwardAction");
    const Ruler& ruler = w.services().scene().session.rulers->front();
    const Vec3 first = geometryOf(w).voxelFromWorld(ruler.points[0]);
    for (int axis = 0; axis < 3; ++axis) CHECK(first[axis] == Approx(a[axis]));
}

TEST_CASE("who names the axes of a patient gets the words of anatomy, and the file's back", "[gui][orientation]") {
    OpenWindow w;
    QAction& ofFile = w.child<QAction>("axesOfFileAction");
    CHECK_FALSE(ofFile.isEnabled());
    bool looked = false;
    QTimer::singleShot(0, &w.window, [&] {
        auto* dialog = w.window.findChild<AxesDialog*>("axesDialog");
        if (dialog == nullptr) return;
        auto* ok = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
        auto* verdict = dialog->findChild<QLabel*>("axesVerdict");
        const auto along = [&](const char* axis) { return dialog->findChild<QComboBox*>(axis); };
        CHECK(along("axesAlongi")->currentText() == "+x");
        dialog->findChild<QCheckBox*>("axesPatient")->setChecked(true);
        CHECK(along("axesAlongi")->currentText() == "left");
        along("axesAlongj")->setCurrentText("head");
        CHECK_FALSE(ok->isEnabled()); // k points there, too
        CHECK(verdict->text().contains("direction of its own"));
        along("axesAlongk")->setCurrentText("back");
        CHECK(ok->isEnabled());
        CHECK(verdict->text().contains("mirror"));
        along("axesAlongk")->setCurrentText("front");
        CHECK(verdict->text().isEmpty());
        looked = true;
        dialog->accept();
    });
    choose(w, "sayAxesAction");
    REQUIRE(looked);
    CHECK(axesText(geometryOf(w)) == "R→L, I→S, P→A");
    CHECK(w.child<QAction>("view1").text() == "Anterior");
    CHECK(ofFile.isEnabled());
    choose(w, "axesOfFileAction");
    CHECK(axesText(geometryOf(w)) == "+x, +y, +z");
    CHECK_FALSE(ofFile.isEnabled());
}

TEST_CASE("who says how far voxels are apart gets a volume, measures and a scale bar of that size, and can undo it",
          "[gui][orientation]") {
    OpenWindow w;
    SessionStore& store = w.services().store();
    const Geometry before = geometryOf(w);
    const Camera camera = w.services().scene().camera;
    QAction& ofFile = w.child<QAction>("spacingOfFileAction");
    CHECK_FALSE(ofFile.isEnabled());
    const Vec3 a(4, 5, 6), b(4, 5, 16); // voxels
    editPart(store, &Session::rulers, "Measure", {}, [&](std::vector<Ruler>& rulers) {
        addRuler(rulers, {.points = {before.worldFromVoxel(a), before.worldFromVoxel(b)}});
    });
    bool looked = false;
    QTimer::singleShot(0, &w.window, [&] {
        auto* dialog = w.window.findChild<SpacingDialog*>("spacingDialog");
        if (dialog == nullptr) return;
        auto* z = dialog->findChild<QDoubleSpinBox*>("spacingZ");
        CHECK(z->value() == Approx(before.spacing.z));
        CHECK(dialog->spacing() == spacingOfData(*w.services().scene().data));
        z->setValue(4 * before.spacing.z);
        auto* unit = dialog->findChild<QComboBox*>("spacingUnit");
        unit->setCurrentText(QString::fromUtf8("\u00b5m"));
        looked = true;
        dialog->accept();
    });
    choose(w, "spacingAction");
    REQUIRE(looked);
    const Geometry after = geometryOf(w);
    CHECK(after.spacing.x == Approx(before.spacing.x));
    CHECK(after.spacing.z == Approx(4 * before.spacing.z));
    CHECK(std::string(lengthUnit(after)) == "\u00b5m");
    CHECK(*readGeometry(w.services().scene().session.rulers->front()).length == Approx(40 * before.spacing.z));
    // The camera stands as far from the volume as before, counted in volumes.
    const auto distance = [](const Camera& c, const Geometry& g) {
        return glm::distance(c.eye, g.boxCenter()) / g.radius();
    };
    CHECK(distance(w.services().scene().camera, after) == Approx(distance(camera, before)).epsilon(0.01));
    CHECK(ofFile.isEnabled());
    choose(w, "undoAction");
    CHECK(geometryOf(w).spacing == before.spacing);
    CHECK(distance(w.services().scene().camera, before) == Approx(distance(camera, before)).epsilon(0.01));
    choose(w, "redoAction");
    CHECK(geometryOf(w).spacing == after.spacing);
    // What is opened anew is seen as it is opened.
    const Scene spaced = w.services().scene();
    choose(w, "undoAction");
    store.open(spaced);
    w.settle();
    CHECK(w.services().scene().camera == spaced.camera);
    CHECK_FALSE(store.canUndoCamera());
    choose(w, "spacingOfFileAction");
    CHECK(geometryOf(w).spacing == before.spacing);
    CHECK_FALSE(ofFile.isEnabled());
}
