// The panel of the parameter space: computed, turned, read, picked from, and pale when it is not of the present state.
#include "gui_support.h"

#include <QAction>
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "panels/space_canvas.h"
#include "panels/space_panel.h"
#include "render/camera_motion.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct OpenSpace : OpenWindow {
    OpenSpace() : OpenWindow(16) {
        window.resize(1280, 900);
        child<QAction>("spaceAction").trigger();
        child<QSpinBox>("spaceSamples").setValue(5);
        settle();
    }
    SpacePanel& panel() { return child<SpacePanel>("spacePanel"); }
    SpaceCanvas& canvas3d() { return child<SpaceCanvas>("spaceCanvas"); }
    const ParameterSpace& space() { return *panel().space(); }
    void click(const char* name) { QTest::mouseClick(&child<QWidget>(name), Qt::LeftButton); }
    void computed() {
        REQUIRE(waitFor([&] { return panel().isCurrent() && !panel().isComputing() && panel().isPictureComplete(); }));
    }
    QImage image() {
        REQUIRE(waitFor([&] { return panel().isPictureComplete(); }));
        return canvas3d().grab().toImage().convertToFormat(QImage::Format_RGB32);
    }
    QPointF pixelOf(const Vec3& position) {
        const auto at = pellucid::pixelOf(space(), canvas3d().shownView(), position);
        REQUIRE(at);
        return {at->x, at->y};
    }
    void choose(const char* box, const QString& text) {
        auto& combo = child<QComboBox>(box);
        const int index = combo.findText(text);
        REQUIRE(index >= 0);
        combo.setFocus();
        combo.setCurrentIndex(index);
        Q_EMIT combo.activated(index);
    }
    QString reading() { return child<QLabel>("spaceReading").text(); }
};

/// Pixels that are nearly of a colour.
int countOf(const QImage& image, const Rgb& color) {
    int n = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const QColor c = image.pixelColor(x, y);
            n += std::abs(c.redF() - color.r) < 0.06 && std::abs(c.greenF() - color.g) < 0.06 &&
                 std::abs(c.blueF() - color.b) < 0.06;
        }
    return n;
}

double brightnessOf(const QImage& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += qGray(image.pixel(x, y));
    return sum;
}

void move(QWidget& widget, const QPointF& at) {
    QMouseEvent event(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::NoButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
}

} // namespace

TEST_CASE("the parameter space of three features is computed, shown and turned", "[gui][space]") {
    OpenSpace s;
    CHECK(s.panel().space() == nullptr);
    s.click("spaceCompute");
    s.computed();
    REQUIRE(s.space().evaluations == 125);
    CHECK(s.space().axes.features == std::vector<std::size_t>{0, 1, 2});
    CHECK(s.child<QLabel>("spaceWords").text().contains("125"));
    CHECK_FALSE(s.child<QPushButton>("spaceCompute").isEnabled()); // there is nothing to compute anew
    const QImage front = s.image();
    CHECK(brightnessOf(front) > 0);

    drag(s.canvas3d(), {150, 150}, {230, 180});
    REQUIRE(waitFor([&] { return s.panel().isPictureComplete(); }));
    CHECK(s.image() != front);
    CHECK(s.document().stepCount() == 0); // turning is no edit, and picks nothing

    s.choose("spaceShown", "Attention on f1");
    const QImage w1 = s.image();
    s.choose("spaceShown", "Attention on f3");
    CHECK(s.image() != w1);

    // The same point of the space as the engine of the window has it: its present opacities, ½ each, are sample 62.
    for (std::size_t f = 0; f < 3; ++f)
        CHECK(s.space().vws[f][62] == Approx(s.document().measures()->features[f].vws).margin(1e-4));
}

TEST_CASE("targets change F at once, the view makes the space one of an older state", "[gui][space]") {
    OpenSpace s;
    s.click("spaceCompute");
    s.computed();
    const QImage before = s.image();
    const double least = s.space().objective[s.space().best];
    s.document().setTargets({0.1, 0.1, 0.8});
    CHECK(s.panel().isCurrent());
    CHECK(s.space().targets[2] == Approx(0.8));
    CHECK(s.space().objective[s.space().best] != least);
    CHECK(s.image() != before);
    s.document().undo();
    CHECK(s.image() == before);

    const Camera home = s.document().camera();
    s.document().setCamera(rotated(home, s.document().volume()->geometry(), 60, 20));
    CHECK_FALSE(s.panel().isCurrent());
    CHECK(s.child<QPushButton>("spaceCompute").isEnabled());
    CHECK_FALSE(s.child<QPushButton>("spaceLeast").isEnabled());
    CHECK(brightnessOf(s.image()) < 0.8 * brightnessOf(before)); // pale
    move(s.canvas3d(), s.pixelOf({0.5, 0.5, 0.5}));
    CHECK(s.reading().isEmpty());
    s.document().setCamera(home);
    CHECK(s.panel().isCurrent());
    CHECK(s.image() == before);
}

TEST_CASE("the opacities of the least F are set, and can be undone", "[gui][space]") {
    OpenSpace s;
    s.click("spaceCompute");
    s.computed();
    const TransferFunction old = s.document().tf();
    const QImage picture = s.picture();
    s.click("spaceLeast");
    const auto x = featureOpacities(s.document().tf());
    const auto wanted = s.space().opacitiesAt(s.space().positionOfSample(s.space().best));
    for (std::size_t f = 0; f < 3; ++f) CHECK(x[f] == Approx(wanted[f]));
    CHECK(s.panel().isCurrent()); // opacities of the axes are what it is about
    CHECK(s.picture() != picture);
    s.document().undo();
    CHECK(s.document().tf() == old);
    CHECK(s.picture() == picture);
}

TEST_CASE("a heat map is read below the mouse, and a click sets its opacities", "[gui][space]") {
    OpenSpace s;
    s.choose("spaceAxisZ", "none");
    s.choose("spaceAxisY", "f3");
    s.click("spaceCompute");
    s.computed();
    REQUIRE(s.space().isFlat());
    CHECK(s.space().axes.features == std::vector<std::size_t>{0, 2});
    CHECK(s.space().evaluations == 25);
    const QImage before = s.image();
    const Vec3 place{0.25, 0.75, 0};
    move(s.canvas3d(), s.pixelOf(place));
    CHECK(s.reading().contains("f1: opacity 0.2"));
    CHECK(s.reading().contains("f3: opacity 0.7"));
    CHECK(s.reading().contains("off target by "));
    QTest::mouseClick(&s.canvas3d(), Qt::LeftButton, {}, s.pixelOf(place).toPoint());
    const auto x = featureOpacities(s.document().tf());
    CHECK(x[0] == Approx(0.25).margin(0.01)); // a pixel
    CHECK(x[1] == 0.5);
    CHECK(x[2] == Approx(0.75).margin(0.01));
    CHECK(s.panel().isCurrent());
    CHECK(s.image() != before); // the square of the opacities now has moved
    s.document().undo();
    CHECK(featureOpacities(s.document().tf()) == std::vector<double>{0.5, 0.5, 0.5});
    CHECK(s.image() == before);
}

TEST_CASE("optimizations of the session are paths, and a click on a state goes there", "[gui][space]") {
    OpenSpace s;
    s.document().setTargets({1.0 / 6, 2.0 / 6, 3.0 / 6});
    s.click("spaceCompute");
    s.computed();
    CHECK(countOf(s.image(), pathColor(0)) == 0);
    s.optimizing().start();
    REQUIRE(waitFor([&] { return !s.optimizing().isRunning(); }));
    s.settle();
    REQUIRE(s.panel().isCurrent());
    REQUIRE(waitFor([&] { return s.panel().isPictureComplete(); }));
    CHECK(countOf(s.image(), pathColor(0)) > 20);
    const SpaceView view = s.canvas3d().shownView();
    REQUIRE(view.paths.size() == 1);
    const OptimizeState& start = view.paths[0].states.front();
    const QPointF at = s.pixelOf(s.space().positionOf(start.opacity));
    move(s.canvas3d(), at);
    CHECK(s.reading().startsWith("run 1, newton, state 0"));
    QTest::mouseClick(&s.canvas3d(), Qt::LeftButton, {}, at.toPoint());
    for (const double x : featureOpacities(s.document().tf())) CHECK(x == Approx(0.5));
    s.document().undo();
    CHECK(featureOpacities(s.document().tf()) != start.opacity);
}

TEST_CASE("computing a parameter space is cancelled without a trace", "[gui][space]") {
    OpenSpace s;
    s.child<QSpinBox>("spaceSamples").setValue(64);
    s.click("spaceCompute");
    REQUIRE(s.panel().isComputing());
    REQUIRE(waitFor([&] { return s.child<QPushButton>("spaceCancel").isVisible(); }));
    s.click("spaceCancel");
    REQUIRE(waitFor([&] { return !s.panel().isComputing(); }));
    CHECK(s.panel().space() == nullptr);
    CHECK(s.child<QPushButton>("spaceCompute").isEnabled());
    CHECK(brightnessOf(s.image()) == 0);
}

TEST_CASE("axes swap features instead of sharing one", "[gui][space]") {
    OpenSpace s;
    s.choose("spaceAxisX", "f3");
    CHECK(s.child<QComboBox>("spaceAxisX").currentText() == "f3");
    CHECK(s.child<QComboBox>("spaceAxisZ").currentText() == "f1");
    s.choose("spaceAxisZ", "none");
    s.choose("spaceAxisZ", "f2"); // y has it, and takes the one that is left
    CHECK(s.child<QComboBox>("spaceAxisY").currentText() == "f1");
}

TEST_CASE("a parameter space is saved as a picture and as a table", "[gui][space]") {
    OpenSpace s;
    s.click("spaceCompute");
    s.computed();
    const QString folder = QDir::tempPath() + "/pellucid-space-test";
    QDir(folder).removeRecursively();
    REQUIRE(QDir().mkpath(folder));
    s.panel().saveTo(folder + "/F.png");
    REQUIRE(waitFor([&] { return QFile::exists(folder + "/F.png"); }));
    REQUIRE(waitFor([&] { return s.child<QWidget>("spaceSave").isEnabled(); }));
    CHECK(QImage(folder + "/F.png").size() == QSize(1024, 1024));
    CHECK(brightnessOf(QImage(folder + "/F.png")) > 0);
    s.panel().saveTo(folder + "/F.csv");
    REQUIRE(waitFor([&] { return QFile::exists(folder + "/F.csv"); }));
    QFile table(folder + "/F.csv");
    REQUIRE(table.open(QIODevice::ReadOnly));
    CHECK(table.readAll().count('\n') == 126);
    QDir(folder).removeRecursively();
}
