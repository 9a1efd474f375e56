// Several variables: added, renamed, removed; which drives which channel; the ground. Each time state and picture.
#include "gui_support.h"

#include <algorithm>
#include <cmath>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QToolButton>
#include <QTreeWidget>

#include "controllers/player_controller.h"
#include "dialogs/series_files.h"
#include "session/variable_edits.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kGridSide = 20, kFrames = 4;

void writeGrid(const QString& path, const Int3& dims, double spacing, const std::function<double(const Vec3&)>& value) {
    Geometry geometry;
    geometry.dims = dims;
    geometry.spacing = Vec3(spacing);
    Grid<float> grid(dims);
    std::size_t i = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x)
                grid[i++] = static_cast<float>(value(geometry.worldFromVoxel(Vec3(x, y, z))));
    writeNrrd(geometry, grid, path.toStdString());
}

double ball(const Vec3& p, const Vec3& middle, double radius) {
    const Vec3 d = p - middle;
    return std::max(0.0, 1 - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) / radius);
}

/// cloud0.nrrd …: a ball that rests and one that moves. rain0.nrrd …: a ball about the resting one that grows, on half
/// as many voxels along each axis. ground.nrrd: a slope, one layer.
struct Weather {
    QTemporaryDir folder;
    Weather() {
        for (int f = 0; f < kFrames; ++f) {
            writeGrid(folder.filePath(QStringLiteral("cloud%1.nrrd").arg(f)), {kGridSide, kGridSide, kGridSide}, 1,
                      [f](const Vec3& p) {
                          return std::max(ball(p, {5, 5, 10}, 5), ball(p, {8.0 + 2 * f, 14, 10}, 5));
                      });
            writeGrid(folder.filePath(QStringLiteral("rain%1.nrrd").arg(f)),
                      {kGridSide / 2, kGridSide / 2, kGridSide / 2}, 2, [f](const Vec3& p) {
                          return ball(p, {5, 5, 10}, 5.0 + f);
                      });
        }
        writeGrid(folder.filePath("ground.nrrd"), {kGridSide, kGridSide, 1}, 1,
                  [](const Vec3& p) { return 4 * std::sin(p.x / 4); });
    }
    VolumeSource series(const QString& name) const {
        QStringList paths;
        for (int f = 0; f < kFrames; ++f) paths << folder.filePath(QStringLiteral("%1%2.nrrd").arg(name).arg(f));
        return sourceOf(paths);
    }
    VolumeSource file(const char* name) const {
        VolumeSource source;
        source.path = folder.filePath(name).toStdString();
        return source;
    }
};

const Session& sessionOfWindow(OpenWindow& w) { return w.services().store().session(); }
const HsbMapping& hsbOf(OpenWindow& w) { return *sessionOfWindow(w).hsb; }

/// The cloud at its last frame, with the panel in front, so that the view has its size for good.
void openCloud(OpenWindow& w, const Weather& weather) {
    w.open(weather.series("cloud"));
    w.settle();
    w.child<QAction>("variablesAction").trigger();
    w.settle();
    w.opening().editData("Last frame", [](Session& s) { s.frame = kFrames - 1; });
    w.settle();
    QTest::qWait(100); // docks arrange themselves
    w.settle();
    REQUIRE(sessionOfWindow(w).frame == kFrames - 1);
}

/// As the menu of the panel does once a file has been chosen.
void addRain(OpenWindow& w, const Weather& weather) {
    Variable rain;
    rain.name = "rain";
    rain.source = weather.series("rain");
    w.opening().editInJob("Add rain", [rain](Session& s) { addVariable(s, rain); });
    w.settle();
    REQUIRE(sessionOfWindow(w).variables->size() == 2);
}

void turnOn(OpenWindow& w) {
    w.child<QCheckBox>("hsbCheck").click();
    w.settle();
    REQUIRE(hsbOf(w).on);
    REQUIRE(w.services().scene().colors);
}

void undo(OpenWindow& w) {
    w.child<QAction>("undoAction").trigger();
    w.settle();
}

QTreeWidgetItem& rowOf(OpenWindow& w, const QString& name) {
    const auto found = w.child<QTreeWidget>("variablesList").findItems(name, Qt::MatchExactly);
    REQUIRE(found.size() == 1);
    return *found.front();
}

/// Chooses by name, as with the mouse.
void choose(OpenWindow& w, const char* combo, const std::string& driver) {
    auto& box = w.child<QComboBox>(combo);
    const int index = box.findData(QString::fromStdString(driver));
    REQUIRE(index >= 0);
    box.setCurrentIndex(index);
    Q_EMIT box.activated(index);
    w.settle();
}

/// Mean of max − min and of max over the pixels that differ from the background: how colourful, how bright.
struct Look {
    double saturation = 0, brightness = 0;
};
Look lookOf(const QImage& image) {
    Look look;
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const QColor c = image.pixelColor(x, y);
            if (c.value() < 8) continue;
            look.saturation += c.saturationF();
            look.brightness += c.valueF();
            ++count;
        }
    REQUIRE(count > 100);
    look.saturation /= count;
    look.brightness /= count;
    return look;
}

} // namespace

TEST_CASE("volatility colours what moves, and undo brings the colours of the curve back", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    const QImage before = w.picture();
    CHECK(w.child<QDockWidget>("tfDock").windowTitle() == "Transfer function");
    turnOn(w);
    CHECK(hsbOf(w).saturation == "volatility:cloud:10"); // startMapping()
    CHECK(w.child<QSpinBox>("hsbFrames").value() == 10);
    CHECK(w.child<QDockWidget>("tfDock").windowTitle().contains("colours come from variables"));
    const QImage mapped = w.picture();
    CHECK(mapped != before);
    // The resting ball is grey, the moving one has colour: voxels (5,5,10) and (14,14,10) of frame 3.
    const VoxelColors& colors = *w.services().scene().colors;
    const auto colorAt = [&](int x, int y, int z) {
        const std::uint32_t c = colors.rgba[static_cast<std::size_t>(x + kGridSide * (y + kGridSide * z))];
        return QColor(static_cast<int>(c & 255), static_cast<int>(c >> 8 & 255), static_cast<int>(c >> 16 & 255));
    };
    CHECK(colorAt(5, 5, 10).saturation() == 0);
    CHECK(colorAt(14, 14, 10).saturation() > 128);
    undo(w);
    CHECK_FALSE(hsbOf(w).on);
    CHECK(w.picture() == before);
    w.child<QAction>("redoAction").trigger();
    CHECK(w.picture() == mapped);
    // The key does the same.
    w.child<QAction>("hsbAction").trigger();
    w.settle();
    CHECK_FALSE(hsbOf(w).on);
    CHECK(w.picture() == before);
}

TEST_CASE("frames of volatility, scales and hue change the picture", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    turnOn(w);
    const QImage ten = w.picture();
    auto& frames = w.child<QSpinBox>("hsbFrames");
    frames.setValue(1);
    w.settle();
    CHECK(hsbOf(w).saturation == "volatility:cloud:1");
    const QImage one = w.picture(); // of one frame it is 0
    for (const std::uint32_t c : w.services().scene().colors->rgba) {
        const bool grey = (c & 255) == (c >> 8 & 255) && (c & 255) == (c >> 16 & 255);
        if (!grey) FAIL("a voxel has colour");
    }
    CHECK(lookOf(ten).saturation > lookOf(one).saturation + 0.05);
    undo(w);
    CHECK(frames.value() == 10);
    CHECK(w.picture() == ten);

    // The slider of a: the picture follows while it is held, and it is one step.
    auto& slider = w.child<QSlider>("hsbASlider");
    const double automatic = w.services().scene().hsbA;
    CHECK_FALSE(hsbOf(w).a);
    CHECK(w.child<QToolButton>("hsbAAutomatic").isChecked());
    CHECK(w.child<QDoubleSpinBox>("hsbA").value() == Approx(automatic).margin(0.001));
    slider.setSliderDown(true);
    slider.setValue(slider.value() - 100);
    CHECK(w.document().isPreviewing());
    slider.setValue(0);
    REQUIRE(hsbOf(w).a);
    CHECK(*hsbOf(w).a == Approx(0.1)); // the least
    slider.setSliderDown(false);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK_FALSE(w.child<QToolButton>("hsbAAutomatic").isChecked());
    const QImage pale = w.picture();
    CHECK(lookOf(pale).saturation < lookOf(ten).saturation);
    undo(w); // all of it
    CHECK_FALSE(hsbOf(w).a);
    CHECK(w.picture() == ten);
    w.child<QAction>("redoAction").trigger();
    CHECK(w.picture() == pale);
    w.child<QToolButton>("hsbAAutomatic").click();
    w.settle();
    CHECK_FALSE(hsbOf(w).a);
    CHECK(w.services().scene().hsbA == automatic);
    CHECK(w.picture() == ten);

    // Another hue.
    w.child<QDoubleSpinBox>("hsbHueFrom").setValue(180);
    CHECK(hsbOf(w).hueFrom == 180);
    CHECK(w.picture() != ten);
    undo(w);
    CHECK(w.picture() == ten);
    choose(w, "hsbHue", "cloud");
    CHECK(hsbOf(w).hue == "cloud");
    CHECK(w.picture() != ten);
    CHECK(w.child<QDoubleSpinBox>("hsbHueTo").isVisible());
    undo(w);
    CHECK(w.picture() == ten);
}

TEST_CASE("colours from any variable, at any frame, read each frame once and leave the player in order",
          "[variables][player]") {
    const Weather weather;
    // Beside what moves: a value that is the same everywhere, nothing but NaN, and a series that ends with frame 1.
    for (int f = 0; f < kFrames; ++f) {
        writeGrid(weather.folder.filePath(QStringLiteral("flat%1.nrrd").arg(f)), {kGridSide, kGridSide, kGridSide}, 1,
                  [](const Vec3&) { return 3.0; });
        writeGrid(weather.folder.filePath(QStringLiteral("void%1.nrrd").arg(f)), {kGridSide, kGridSide, kGridSide}, 1,
                  [](const Vec3&) { return std::nan(""); });
    }
    OpenWindow w;
    openCloud(w, weather);
    for (const char* name : {"flat", "void", "rain"}) {
        Variable variable;
        variable.name = name;
        variable.source = weather.series(name);
        w.opening().editInJob("Add", [variable](Session& s) { addVariable(s, variable); });
        w.settle();
    }
    REQUIRE(sessionOfWindow(w).variables->size() == 4);
    for (int f = 2; f < kFrames; ++f) QFile::remove(weather.folder.filePath(QStringLiteral("rain%1.nrrd").arg(f)));
    w.window.resize(700, 500); // little to draw
    PlayerController& player = w.controllers().player;
    QSignalSpy read(&player, &PlayerController::heldChanged);
    const auto rest = [&] { // until no frame comes any more: each is read a few times at most, not for ever
        REQUIRE(waitFor([&] { return w.services().isIdle(); }));
        read.clear();
        for (int before = -1; before != read.count();) {
            before = read.count();
            QTest::qWait(30);
            REQUIRE(read.count() <= 5 * kFrames);
        }
    };
    for (const std::string driver :
         {"volatility:cloud:10", "difference:cloud:0", "gradient:cloud", "cloud", "flat", "void", "rain"})
        for (const Channel channel : {Channel::Saturation, Channel::Brightness, Channel::Hue})
            for (const int frame : {0, 1, kFrames - 1}) {
                if (driver == "rain" && frame > 1) continue; // it cannot be turned on there
                INFO(driver << " at frame " << frame << ", channel " << static_cast<int>(channel));
                w.opening().editData("Map", [&](Session& s) {
                    s.frame = frame;
                    s.hsb.set({}); // nothing is known of scales
                    setChannel(s, channel, driver);
                    s.hsb.edit([](HsbMapping& mapping) { mapping.on = true; });
                });
                rest();
                REQUIRE(hsbOf(w).on);
                REQUIRE(sessionOfWindow(w).frame == frame);
                // Another frame is shown, and the way back leads to the same colours.
                const std::shared_ptr<const VoxelColors> colors = w.services().scene().colors;
                player.goTo(frame == 0 ? 1 : 0);
                rest();
                CHECK(sessionOfWindow(w).frame == (frame == 0 ? 1 : 0));
                player.goTo(frame);
                rest();
                CHECK(sessionOfWindow(w).frame == frame);
                CHECK(w.services().scene().colors->rgba == colors->rgba);
            }
}

TEST_CASE("with volatility from the first frame on its scale is found where there is some", "[variables][player]") {
    const Weather weather;
    OpenWindow w;
    w.open(weather.series("cloud"));
    w.settle();
    const int steps = w.services().store().stepCount();
    w.window.activateWindow();
    REQUIRE(waitFor([&] { return w.window.isActiveWindow(); }));
    QTest::keyClick(&w.window, Qt::Key_S, Qt::ShiftModifier);
    w.settle();
    REQUIRE(hsbOf(w).on);
    CHECK(hsbOf(w).saturation == "volatility:cloud:10");
    CHECK_FALSE(hsbOf(w).found.a); // nothing has changed yet
    w.controllers().player.goTo(1);
    w.settle();
    REQUIRE(sessionOfWindow(w).frame == 1);
    REQUIRE(hsbOf(w).found.a);
    const double a = *hsbOf(w).found.a;
    CHECK(w.services().scene().hsbA == a);
    w.controllers().player.goTo(kFrames - 1);
    w.settle();
    REQUIRE(sessionOfWindow(w).frame == kFrames - 1);
    CHECK(w.services().scene().hsbA == a); // frames are compared
    CHECK(w.services().store().stepCount() == steps + 1);
}

TEST_CASE("features are of the volatility: figures, refinement, optimization and the player", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    const QImage before = w.picture();
    const Session session = sessionOfWindow(w);
    const auto data = w.services().scene().data;
    const int steps = w.document().stepCount();
    CHECK_FALSE(w.child<QSpinBox>("featureFrames").isVisible());
    choose(w, "featuresOf", "volatility:cloud:10");
    CHECK(w.document().stepCount() == steps + 1);
    REQUIRE(sessionOfWindow(w).variable().derivation);
    CHECK(sessionOfWindow(w).variable().derivation->text() == "volatility:cloud:10");
    CHECK(w.child<QDockWidget>("featuresDock").windowTitle() == "Features of volatility of cloud");
    CHECK(*sessionOfWindow(w).hsb == *session.hsb);

    // Of four frames with values 0 to 1: the moving ball is at 8 + 2f, where (14,14,10) has 0, 0.2, 0.6 and 1 or so.
    const std::shared_ptr<const Volume> deviation = w.document().volume();
    const auto at = [](int x, int y, int z) { return static_cast<std::size_t>(x + kGridSide * (y + kGridSide * z)); };
    double sum = 0, squares = 0, most = 0;
    for (int f = 0; f < kFrames; ++f)
        for (int x = 0; x < kGridSide; ++x) most = std::max(most, ball(Vec3(x, 14, 10), {8.0 + 2 * f, 14, 10}, 5));
    REQUIRE(most == 1);
    for (int f = 0; f < kFrames; ++f) {
        const double value = ball({14, 14, 10}, {8.0 + 2 * f, 14, 10}, 5);
        sum += value / kFrames;
        squares += value * value / kFrames;
    }
    CHECK(deviation->value(at(14, 14, 10)) == Approx(std::sqrt(squares - sum * sum)).margin(1e-5));
    CHECK(deviation->value(at(5, 5, 10)) == 0); // it rests
    CHECK(deviation->range().lo == 0);          // of all frames: in the first there is none

    // Features, and what is said of them, are of it.
    w.settle();
    REQUIRE(w.document().measures() != nullptr);
    CHECK(w.document().measuresAreCurrent());
    CHECK(w.document().measures()->features.size() == w.document().tf().features.size());
    Workspace workspace;
    const Measures own = workspace.measure(measureInput(w.services().scene()));
    for (std::size_t f = 0; f < own.features.size(); ++f)
        CHECK(w.document().measures()->features[f].vws == Approx(own.features[f].vws).margin(1e-9));
    const TransferFunction automatic = w.document().tf();
    w.document().setTf(tents(3, 0.3), "Tents");
    w.settle();
    w.refining().refine();
    w.settle();
    CHECK_FALSE(rangeless(w.document().tf()) == rangeless(tents(3, 0.3)));
    undo(w);
    w.child<QAction>("optimizeAction").trigger();
    w.settle();
    CHECK_FALSE(rangeless(w.document().tf()) == rangeless(tents(3, 0.3)));
    undo(w);
    undo(w);
    CHECK(w.document().tf() == automatic);

    // Frame by frame; over fewer frames; and back to the cloud, whose own curve comes back.
    w.controllers().player.goTo(1);
    w.settle();
    CHECK(w.document().volume()->value(at(14, 14, 10)) < std::sqrt(squares - sum * sum));
    CHECK(w.document().volume()->range() == deviation->range());
    w.controllers().player.goTo(kFrames - 1);
    w.settle();
    auto& frames = w.child<QSpinBox>("featureFrames");
    CHECK(frames.isVisible());
    CHECK(frames.value() == 10);
    frames.setValue(2);
    w.settle();
    CHECK(sessionOfWindow(w).variable().derivation->frames == 2);
    const double last = ball({14, 14, 10}, {14, 14, 10}, 5), previous = ball({14, 14, 10}, {12, 14, 10}, 5);
    CHECK(w.document().volume()->value(at(14, 14, 10)) == Approx((last - previous) / 2).margin(1e-5));

    // A session keeps it.
    const QString path = weather.folder.filePath("s.pellucid.json");
    const Session kept = sessionOfWindow(w);
    const std::vector<double> values = [&] {
        std::vector<double> all;
        for (std::size_t i = 0; i < w.document().volume()->size(); ++i) all.push_back(w.document().volume()->value(i));
        return all;
    }();
    REQUIRE(w.saving().saveSession(path));
    choose(w, "featuresOf", "cloud");
    CHECK(sessionOfWindow(w).variable().track == session.variable().track);
    CHECK(w.picture() == before);
    CHECK(w.document().volume()->value(at(5, 5, 10)) == data->value(at(5, 5, 10)));
    w.services().store().setClean();
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(*sessionOfWindow(w).variables == *kept.variables);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (w.document().volume()->value(i) != values[i]) FAIL("voxel " << i);
}

TEST_CASE("a second variable darkens, swapping it and back gives the same picture", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    addRain(w, weather);
    REQUIRE(waitFor([&] { return rowOf(w, "rain").text(3).contains("10×10×10"); }));
    // The grid is in sight, before the column From; the tip has the frames.
    const QHeaderView& header = *w.child<QTreeWidget>("variablesList").header();
    CHECK(header.visualIndex(3) < header.visualIndex(2));
    CHECK(rowOf(w, "rain").text(3) == "10×10×10");
    CHECK(rowOf(w, "rain").toolTip(3).contains("frames"));
    // It lies on another grid, and the panel says so.
    CHECK(w.child<QLabel>("variablesNotice").text().contains("rain"));
    turnOn(w);
    CHECK(hsbOf(w).brightness == "rain");
    CHECK(rowOf(w, "rain").text(1) == "brightness");
    const QImage mapped = w.picture();
    const TransferFunction tf = w.document().tf();
    choose(w, "hsbBrightness", "");
    const QImage bright = w.picture();
    CHECK(lookOf(bright).brightness > lookOf(mapped).brightness);
    undo(w);
    CHECK(w.picture() == mapped);
    auto& b = w.child<QDoubleSpinBox>("hsbB");
    b.setValue(b.value() / 8);
    w.settle();
    CHECK(lookOf(w.picture()).brightness > lookOf(mapped).brightness);
    undo(w);
    CHECK(w.picture() == mapped);

    const Session session = sessionOfWindow(w);
    QTest::mouseClick(&w.child<QPushButton>("hsbSwap"), Qt::LeftButton);
    w.settle();
    CHECK(sessionOfWindow(w).variable().name == "rain");
    CHECK(hsbOf(w).brightness == "cloud");
    CHECK(hsbOf(w).saturation == "volatility:rain:10");
    REQUIRE(sessionOfWindow(w).tf() != nullptr); // an automatic one of its own
    CHECK_FALSE(sessionOfWindow(w).variable().track == session.variable().track);
    CHECK(w.child<QDockWidget>("featuresDock").windowTitle().contains("rain"));
    const QImage swapped = w.picture();
    CHECK(swapped != mapped);
    w.child<QAction>("swapVariablesAction").trigger();
    w.settle();
    CHECK(sessionOfWindow(w).variable().name == "cloud");
    CHECK(*sessionOfWindow(w).hsb == *session.hsb);
    CHECK(w.document().tf() == tf);
    CHECK(w.picture() == mapped);
    undo(w);
    CHECK(w.picture() == swapped);
    undo(w);
    CHECK(w.picture() == mapped);
}

TEST_CASE("variables are added, renamed, given a range and removed", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    addRain(w, weather);
    turnOn(w);
    const QImage mapped = w.picture();

    // Made of another one, by the menu.
    auto& menu = w.child<QMenu>("variableAddMenu");
    Q_EMIT menu.aboutToShow();
    QAction* gradient = w.window.findChild<QAction*>("addGradient_cloud");
    REQUIRE(gradient != nullptr);
    gradient->trigger();
    w.settle();
    REQUIRE(sessionOfWindow(w).variableNamed("gradient of cloud") != nullptr);
    CHECK(w.picture() == mapped); // it drives nothing yet
    CHECK(rowOf(w, "gradient of cloud").text(2) == "gradient of cloud");
    choose(w, "hsbBrightness", "gradient of cloud");
    const QImage edges = w.picture();
    CHECK(edges != mapped);

    // Another name goes everywhere, and is no other picture.
    auto& list = w.child<QTreeWidget>("variablesList");
    rowOf(w, "gradient of cloud").setText(0, "edges");
    w.settle();
    CHECK(hsbOf(w).brightness == "edges");
    CHECK(w.picture() == edges);
    // A name that is taken is refused.
    rowOf(w, "edges").setText(0, "rain");
    QDialog* error = nullptr;
    REQUIRE(waitFor([&] { return (error = w.window.findChild<QDialog*>("errorDialog")) != nullptr; }));
    error->reject();
    CHECK(sessionOfWindow(w).variableNamed("edges") != nullptr);
    CHECK(list.topLevelItemCount() == 3);

    // A range of its own.
    choose(w, "hsbBrightness", "rain");
    CHECK(w.picture() == mapped);
    list.setCurrentItem(&rowOf(w, "rain"));
    auto& hi = w.child<QLineEdit>("variableHi");
    REQUIRE(waitFor([&] { return hi.isEnabled(); }));
    const auto type = [&](QLineEdit& edit, const QString& text) {
        edit.selectAll();
        QTest::keyClicks(&edit, text);
        QTest::keyClick(&edit, Qt::Key_Return);
        w.settle();
    };
    w.child<QToolButton>("hsbBAutomatic").click(); // b stays what it is
    w.settle();
    type(hi, "4");
    REQUIRE(sessionOfWindow(w).variableNamed("rain")->window);
    CHECK(sessionOfWindow(w).variableNamed("rain")->window->hi == 4);
    CHECK(lookOf(w.picture()).brightness > lookOf(mapped).brightness); // less of it
    w.child<QPushButton>("variableWholeRange").click();
    w.settle();
    CHECK_FALSE(sessionOfWindow(w).variableNamed("rain")->window);
    CHECK(w.picture() == mapped);

    // cloud cannot go while edges are made of it; rain can.
    list.setCurrentItem(&rowOf(w, "cloud"));
    CHECK_FALSE(w.child<QPushButton>("variableRemove").isEnabled());
    list.setCurrentItem(&rowOf(w, "rain"));
    QTest::mouseClick(&w.child<QPushButton>("variableRemove"), Qt::LeftButton);
    w.settle();
    CHECK(sessionOfWindow(w).variableNamed("rain") == nullptr);
    CHECK(hsbOf(w).brightness.empty());
    CHECK(w.picture() != mapped);
    undo(w);
    CHECK(hsbOf(w).brightness == "rain");
    CHECK(w.picture() == mapped);
}

TEST_CASE("a variable that cannot be read is not added", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    const QImage before = w.picture();
    Variable missing;
    missing.name = "missing";
    missing.source = weather.file("missing.nrrd");
    w.opening().editInJob("Add", [missing](Session& s) { addVariable(s, missing); });
    QDialog* error = nullptr;
    REQUIRE(waitFor([&] { return (error = w.window.findChild<QDialog*>("errorDialog")) != nullptr; }));
    error->reject();
    w.settle();
    CHECK(sessionOfWindow(w).variables->size() == 1);
    CHECK(w.picture() == before);
}

TEST_CASE("a ground is laid under the volume, changed and taken away", "[variables]") {
    const Weather weather;
    OpenWindow w;
    openCloud(w, weather);
    const QImage before = w.picture();
    w.opening().editInJob("Ground", [path = weather.file("ground.nrrd").path](Session& s) {
        s.ground.edit([&](GroundView& g) { g.path = path; });
    });
    w.settle();
    CHECK(w.child<QCheckBox>("groundShown").isChecked());
    CHECK(w.child<QLabel>("groundFile").text() == "ground.nrrd");
    const QImage ground = w.picture();
    CHECK(ground != before);
    w.child<QDoubleSpinBox>("groundRelief").setValue(0);
    CHECK(sessionOfWindow(w).ground->relief == 0);
    CHECK(w.picture() != ground);
    undo(w);
    CHECK(w.picture() == ground);
    auto& maps = w.child<QComboBox>("groundColorMap");
    maps.setCurrentIndex(maps.currentIndex() == 0 ? 1 : 0);
    Q_EMIT maps.activated(maps.currentIndex());
    CHECK(sessionOfWindow(w).ground->colorMap == maps.currentData().toString().toStdString());
    CHECK(w.picture() != ground);
    undo(w);
    w.child<QCheckBox>("groundShown").click();
    w.settle();
    CHECK_FALSE(sessionOfWindow(w).ground->shown);
    CHECK(w.picture() == before);
    undo(w);
    CHECK(w.picture() == ground);
    QTest::mouseClick(&w.child<QPushButton>("groundRemove"), Qt::LeftButton);
    CHECK(sessionOfWindow(w).ground->path.empty());
    CHECK(w.picture() == before);
}

TEST_CASE("a session with several variables and a ground is saved and opened", "[variables]") {
    const Weather weather;
    const QString path = weather.folder.filePath("work.pellucid.json");
    QImage saved;
    Session session;
    {
        OpenWindow w;
        openCloud(w, weather);
        addRain(w, weather);
        turnOn(w);
        w.opening().editInJob("Ground", [file = weather.file("ground.nrrd").path](Session& s) {
            s.ground.edit([&](GroundView& g) { g.path = file; });
        });
        w.settle();
        saved = w.picture();
        session = sessionOfWindow(w);
        w.saving().saveSession(path);
        w.settle();
        CHECK(w.services().store().isClean());
    }
    OpenWindow w;
    w.child<QAction>("variablesAction").trigger();
    w.settle();
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return sessionOfWindow(w).variables->size() == 2; }));
    w.settle();
    CHECK(*sessionOfWindow(w).hsb == *session.hsb);
    CHECK(*sessionOfWindow(w).variables == *session.variables);
    CHECK(*sessionOfWindow(w).ground == *session.ground);
    CHECK(sessionOfWindow(w).frame == kFrames - 1);
    CHECK(waitFor([&] { return w.picture() == saved; })); // docks arrange themselves
    REQUIRE(waitFor([&] { return rowOf(w, "rain").text(3).contains("10×10×10"); }));
}
