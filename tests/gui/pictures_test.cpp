// Makes the pictures of docs/images; run by hand:
//   PELLUCID_PICTURES=docs/images xvfb-run -a -s "-screen 0 1600x1000x24" build/release/bin/test_gui "[.pictures]"
#include "gui_support.h"

#include <cmath>
#include <fstream>
#include <random>

#include <QAction>
#include <QCheckBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QTemporaryDir>
#include <QToolButton>

#include "dialogs/raw_dialog.h"
#include "dialogs/series_choice_dialog.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "panels/space_panel.h"
#include "render/camera_motion.h"
#include "render/clip_handles.h"
#include "services/selection.h"
#include "session/variable_edits.h"
#include "support/dicom_writer.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

void grab(OpenWindow& w, const char* name) {
    w.settle();
    QTest::qWait(300); // docks arrange themselves
    w.settle();
    REQUIRE(w.window.grab().save(qEnvironmentVariable("PELLUCID_PICTURES") + '/' + name));
}

void showPanel(OpenWindow& w, const char* id) { w.services().panels().show(id); }

/// The knee, coarse enough to be drawn soon.
void openKnee(OpenWindow& w) {
    VolumeSource source;
    source.path = qEnvironmentVariable("PELLUCID_VOLUME", "sample:knee").toStdString();
    if (source.isSample()) source.sampleSize = 160;
    w.open(source);
    w.settle();
}

} // namespace

TEST_CASE("a picture of the transfer-function editor", "[.pictures]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    VolumeSource source;
    source.path = qEnvironmentVariable("PELLUCID_VOLUME", "sample:shells").toStdString();
    w.open(source);
    w.child<QAction>("jointHistogram").trigger();
    const Feature feature = w.document().tf().features.at(1);
    w.canvas().axis().setVisible(0, 0.8);
    w.services().selection().setFeature(feature.id);
    w.services().selection().setHoveredIntensity(feature.a + 0.3 * (feature.b - feature.a));
    std::vector<int> points;
    for (std::size_t i = 0; i < w.document().tf().points.size(); ++i)
        if (feature.contains(w.document().tf().points[i].x)) points.push_back(static_cast<int>(i));
    w.canvas().selectPoints(PointSelection(points));
    w.canvas().grab(); // what is seen is counted
    REQUIRE(waitFor([&] { return !w.canvas().isCounting(); }));
    w.settle();
    QDockWidget& dock = *w.services().panels().dock("tf");
    w.window.resizeDocks({&dock}, {300}, Qt::Vertical);
    w.settle();
    REQUIRE(dock.grab().save(qEnvironmentVariable("PELLUCID_PICTURES") + "/tf_editor.png"));
}

TEST_CASE("pictures for the guide", "[.pictures]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    VolumeSource source;
    source.path = qEnvironmentVariable("PELLUCID_VOLUME", "sample:shells").toStdString();
    w.open(source);
    grab(w, "window_opened.png");
    showPanel(w, "display");
    w.child<QDoubleSpinBox>("clipXHi").setValue(60);
    grab(w, "window_display.png");
    w.document().undo();
    showPanel(w, "clip");
    w.child<QAction>("addPlaneAction").trigger();
    const Camera home = w.document().camera();
    w.document().setCamera(rotated(home, w.document().volume()->geometry(), 50, 10));
    grab(w, "window_clip.png");
    w.document().setCamera(home);
    w.child<QAction>("clipHandlesAction").trigger();
    w.document().undo();
    showPanel(w, "features");
    w.document().setTargets({1.0 / 6, 2.0 / 6, 3.0 / 6});
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    grab(w, "window_optimized.png");
    showPanel(w, "influence");
    grab(w, "window_influence.png");
}

TEST_CASE("targets for the guide", "[.pictures][.targetspicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    openKnee(w);
    w.child<QAction>("targetsDiagonal").trigger();
    w.child<TargetBars>("targetBars").toggleLock(0);
    w.child<QAction>("liveTargetsAction").trigger();
    grab(w, "targets.png");
}

TEST_CASE("picture of the probe for the guide", "[.pictures][.probepicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    openKnee(w);
    QTest::mouseClick(&w.view(), Qt::LeftButton, {}, w.view().rect().center() + QPoint(20, 10));
    grab(w, "probe.png");
}

TEST_CASE("the globe for the guide", "[.pictures][.globepicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    openKnee(w);
    showPanel(w, "views");
    QTest::qWait(1000); // it begins when everything rests
    grab(w, "best_view.png");
}

TEST_CASE("curves for the guide", "[.pictures][.convergencepicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    w.settle();
    w.document().setTargets({0.1, 0.3, 0.6});
    const auto run = [&](SearchMethod method) {
        w.services().store().edit("Method", {}, [&](Session& session) {
            session.optimize.edit([&](OptimizeOptions& options) {
                options.method = method;
                options.maxIterations = 20;
            });
        });
        w.optimizing().start();
        REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    };
    run(SearchMethod::Fixed);
    showPanel(w, "convergence");
    w.child<QToolButton>("showStart").click();
    run(SearchMethod::Parallel);
    grab(w, "convergence.png");
}

TEST_CASE("the refiner for the guide", "[.pictures]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 860);
    VolumeSource source;
    source.path = "sample:knee";
    w.open(source);
    w.services().store().edit("Clip", {}, [](Session& session) {
        session.clipping.edit([](Clipping& clipping) { clipping.lo.y = 0.5; });
        session.refine.edit([](RefineSettings& refine) { refine.method = RefineMethod::Exact; });
    });
    w.services().panels().show("refinement");
    w.settle();
    // The femur above the joint, cut open.
    const Vec3 bone = w.document().volume()->geometry().boxCenter() + Vec3(0, 0, 25);
    const PictureView seen{w.document().camera(), w.view().overlay().width(), w.view().overlay().height()};
    const auto pixel = pixelOf(seen, bone);
    REQUIRE(pixel);
    const QPointF middle(pixel->x, pixel->y);
    w.child<QAction>("rectangleAction").trigger();
    drag(w.view(), middle - QPointF(26, 14), middle + QPointF(26, 14));
    REQUIRE(waitFor([&] { return !w.refining().isBusy(); }));
    QTest::qWait(1500); // the methods are compared
    grab(w, "refiner.png");
}

TEST_CASE("slices with a measure, two states and the saliency map for the guide", "[.pictures][.kneepictures]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    openKnee(w);
    const auto trigger = [&](const char* action) { w.child<QAction>(action).trigger(); };
    trigger("layoutFourAction");
    w.settle();
    grab(w, "slices.png");
    trigger("layoutVolumeAction");

    showPanel(w, "pictureSaliency");
    w.services().store().edit("2D saliency", {}, [](Session& s) {
        s.pictureSaliency.edit([](PictureSaliencyView& view) {
            view.on = true;
            view.map = SaliencyMapShown::Picture;
        });
    });
    grab(w, "picture_saliency.png");
    w.document().undo();

    w.controllers().comparing.pin();
    showPanel(w, "features");
    w.document().setTargets({0.2, 0.3, 0.5});
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    w.services().store().edit("Compare", {}, [](Session& s) {
        s.comparison.edit([](ComparisonView& view) { view.mode = CompareMode::SideBySide; });
    });
    showPanel(w, "compare");
    grab(w, "compare.png");
}

TEST_CASE("a field for the guide", "[.pictures][.fieldpicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w;
    w.window.resize(1280, 800);
    VolumeSource source;
    source.path = "sample:shells";
    w.open(source);
    showPanel(w, "fields");
    w.services().store().edit("Field", {}, [](Session& session) {
        session.clipping.edit([](Clipping& clipping) { clipping.lo.y = 0.5; });
        session.field.edit([](FieldView& f) { f.kind = FieldKind::Vws; });
    });
    grab(w, "fields.png");
}

TEST_CASE("the parameter space for the guide", "[.pictures][.spacepicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    OpenWindow w(64);
    w.window.resize(1400, 980);
    VolumeSource source;
    source.path = qEnvironmentVariable("PELLUCID_VOLUME", "sample:shells").toStdString();
    w.opening().openVolume(source, "tents:3");
    w.settle();
    showPanel(w, "space");
    w.document().setTargets({0.1, 0.3, 0.6});
    for (const SearchMethod method : {SearchMethod::Parallel, SearchMethod::Fixed}) {
        w.services().store().edit("Method", {}, [method](Session& session) {
            session.optimize.edit([method](OptimizeOptions& options) { options.method = method; });
        });
        w.document().setTf(tents(3), "Start");
        w.settle();
        w.optimizing().start();
        REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    }
    w.settle();
    auto& panel = w.child<SpacePanel>("spacePanel");
    panel.compute();
    REQUIRE(waitFor([&] { return panel.isCurrent() && panel.isPictureComplete(); }));
    grab(w, "parameter_space.png");
}

TEST_CASE("several variables for the guide", "[.pictures][.variablespicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    struct Show {
        const char *sample, *brightness;
        int frame, frames;
        double a, b, azimuth, elevation, zoom; // a, b 0: automatic
    };
    const Show shows[] = {{"vortex", "gradient:vortex", 40, 10, 0, 1, 30, 15, 1.2},
                          {"smoke", "gradient:smoke", 90, 10, 10, 1.5, 30, 5, 1.4},
                          {"hurricane", "precipitation", 30, 10, 0, 8, 20, 40, 1.5}};
    for (const Show& show : shows) {
        OpenWindow w;
        w.window.resize(1280, 860);
        VolumeSource source;
        source.path = "sample:" + std::string(show.sample);
        w.open(source);
        w.settle();
        showPanel(w, "variables");
        w.opening().editInJob("Mapping", [&](Session& s) {
            s.frame = show.frame;
            if (show.sample == std::string("hurricane")) {
                Variable rain;
                rain.name = "precipitation";
                rain.source.path = "sample:hurricane/precipitation";
                addVariable(s, rain);
                s.ground.edit([](GroundView& g) { g.path = "sample:hurricane/ground"; });
            }
            s.hsb.edit([&](HsbMapping& h) {
                h.on = true;
                h.saturation = "volatility:" + std::string(show.sample) + ":" + std::to_string(show.frames);
                h.brightness = show.brightness;
                if (show.a > 0) h.a = show.a;
                if (show.b > 0) h.b = show.b;
            });
        });
        w.settle();
        w.document().setCamera(cameraFromView(w.document().volume()->geometry(), show.azimuth, show.elevation,
                                              show.zoom, Projection::Perspective));
        w.settle();
        const PictureInput picture = pictureInput(w.services().scene(), 640, 480);
        const auto renderer = makeRenderer(EngineChoice::Cpu, picture.volume);
        const std::string folder = qEnvironmentVariable("PELLUCID_PICTURES").toStdString() + "/variables_";
        writeImage(renderer->render(picture.camera, picture.tf, picture.settings, {}), folder + show.sample + ".png");
        if (show.sample == std::string("hurricane")) grab(w, "variables.png");
    }
}

// A map of t-values that is made up, over a head.
namespace {

/// Slices of the knee across one axis, as DICOM: of the voxels of `volume`, 12 bits.
void writeSlices(const QTemporaryDir& folder, const Volume& volume, int across, const char* description) {
    const Int3 dims = volume.dims();
    const int i = across == 0 ? 1 : 0, j = across == 2 ? 1 : 2;
    const char* const axes[] = {"0\\1\\0\\0\\0\\-1", "1\\0\\0\\0\\0\\-1", "1\\0\\0\\0\\1\\0"};
    for (int n = 0; n < dims[across]; ++n) {
        test::DicomSlice slice;
        slice.columns = dims[i];
        slice.rows = dims[j];
        slice.number = n + 1;
        slice.series = "1.2." + std::to_string(across);
        slice.seriesNumber = std::to_string(3 - across);
        slice.description = description;
        slice.modality = "MR";
        slice.axes = axes[across];
        slice.position = across == 0   ? std::to_string(n) + "\\0\\0"
                         : across == 1 ? "0\\" + std::to_string(n) + "\\0"
                                       : "0\\0\\" + std::to_string(n);
        std::vector<int> values;
        for (int row = 0; row < dims[j]; ++row)
            for (int column = 0; column < dims[i]; ++column) {
                Int3 voxel(0);
                voxel[across] = n;
                voxel[i] = column;
                voxel[j] = across == 2 ? row : dims[j] - 1 - row;
                const auto at = static_cast<std::size_t>(voxel.x + dims.x * (voxel.y + dims.y * voxel.z));
                values.push_back(static_cast<int>(4000 * volume.intensity(at)));
            }
        slice.pixels = test::words(values);
        const QString name = QStringLiteral("IM%1_%2").arg(across).arg(n);
        std::ofstream(folder.filePath(name).toStdString(), std::ios::binary) << test::dicomFile(slice);
    }
}

} // namespace

TEST_CASE("the series of a study for the guide", "[.pictures][.seriespicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    const QTemporaryDir folder;
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 96;
    const Volume knee = loadVolume(source);
    writeSlices(folder, knee, 0, "sagittal");
    writeSlices(folder, knee, 1, "coronal");
    writeSlices(folder, knee, 2, "axial");
    source = {};
    source.path = folder.path().toStdString();
    SeriesChoiceDialog dialog(source, contentsOf(source));
    dialog.show();
    QTest::qWait(3000); // for the pictures
    REQUIRE(dialog.grab().save(qEnvironmentVariable("PELLUCID_PICTURES") + "/series_dialog.png"));
}

TEST_CASE("the dialog for files without a header for the guide", "[.pictures][.rawpicture]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    const QTemporaryDir folder;
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 128;
    const Volume knee = loadVolume(source);
    const QString path = folder.filePath("scan.raw");
    std::ofstream out(path.toStdString(), std::ios::binary);
    for (std::size_t i = 0; i < knee.size(); ++i) {
        const auto value = static_cast<std::uint16_t>(4000 * knee.intensity(i));
        out.write(reinterpret_cast<const char*>(&value), 2);
    }
    out.close();
    RawDialog dialog(QStringList{path});
    dialog.show();
    QTest::qWait(3000); // for the guesses, and the picture
    REQUIRE(dialog.grab().save(qEnvironmentVariable("PELLUCID_PICTURES") + "/raw_dialog.png"));
}

TEST_CASE("a picture of an overlay", "[.pictures]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_PICTURES")) return;
    VolumeSource head;
    head.path = PELLUCID_SHARED_DIR "/data/real/nifti/ch2.nii.gz";
    const Geometry map{{40, 48, 40}, Vec3(4), Vec3(-78, -76, -60), Mat3(1), WorldAxes::Patient};
    struct Peak {
        Vec3 place; // of the world, mm to the left, the back and the head
        double t, width;
    };
    const Peak peaks[] = {{{44, -14, 28}, 9, 11}, {{-46, -10, 30}, 7, 10}, {{2, 84, 6}, 8, 14}, {{0, -50, 22}, -7, 12}};
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.7);
    Grid<float> values(map.dims);
    std::size_t i = 0;
    for (int z = 0; z < map.dims.z; ++z)
        for (int y = 0; y < map.dims.y; ++y)
            for (int x = 0; x < map.dims.x; ++x) {
                double t = noise(random);
                for (const Peak& peak : peaks) {
                    const Vec3 away = (map.worldFromVoxel(Vec3(x, y, z)) - peak.place) / peak.width;
                    t += peak.t * std::exp(-(away.x * away.x + away.y * away.y + away.z * away.z));
                }
                values[i++] = static_cast<float>(t);
            }
    const QTemporaryDir folder;
    VolumeSource tMap;
    tMap.path = folder.filePath("tmap.nrrd").toStdString();
    writeNrrd(map, values, tMap.path);

    OpenWindow w;
    w.window.resize(1400, 860);
    w.open(head);
    w.settle();
    w.controllers().overlays.lay(tMap);
    w.settle();
    w.opening().editInJob("Look", [](Session& s) {
        s.overlay.edit([](OverlayView& o) {
            o.threshold = 3.1;
            o.opacity = 0.3;
        });
        s.clipping.edit([](Clipping& c) { c.hi = {1, 1, 0.55}; });
    });
    showPanel(w, "overlay");
    w.child<QAction>("layoutFourAction").trigger();
    w.settle();
    const Geometry& g = w.services().scene().volume->geometry();
    w.services().store().setCrosshair(g.voxelFromWorld({44, -14, 28}));
    w.document().setCamera(cameraFromView(g, 40, 50, 1.6, Projection::Perspective));
    grab(w, "overlay.png");
}
