// Frames of a series in the window: play, step, scrub; undo across frames; keys; transfer functions that follow.
#include "gui_support.h"
#include "widgets/theme.h"

#include <atomic>
#include <thread>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QSlider>
#include <QTemporaryDir>
#include <QToolButton>

#include "controllers/adapt_controller.h"
#include "controllers/player_controller.h"
#include "panels/temporal_panel.h"
#include "panels/time_strip.h"
#include "session/refine_priority.h"
#include "session/session_json.h"
#include "tf/palette_bar.h"
#include "widgets/input_habits.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kSide = 20;

/// Frame f of a ball that grows: 1 in its centre, falling evenly to 0 at radius (0.2 + 0.05 f) of the side.
Volume ball(int frame) {
    const Geometry geometry{{kSide, kSide, kSide}, Vec3(1), Vec3(0)};
    const double radius = (0.2 + 0.05 * frame) * kSide, centre = (kSide - 1) / 2.0;
    std::vector<float> samples;
    for (int k = 0; k < kSide; ++k)
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const double r =
                    std::sqrt((i - centre) * (i - centre) + (j - centre) * (j - centre) + (k - centre) * (k - centre));
                samples.push_back(static_cast<float>(std::max(0.0, 1 - r / radius)));
            }
    return {geometry, Samples(std::move(samples))};
}

struct BallOptions {
    int frames = 6;
    int broken = -1;
    int milliseconds = 0; ///< that reading a frame takes
};

std::shared_ptr<TimeSeries> balls(const BallOptions& options = {}) {
    SeriesListing listing;
    listing.title = "growing ball";
    listing.timeUnit = "s";
    listing.hasTimes = true;
    listing.declaredRange = ValueRange{0, 1};
    for (int f = 0; f < options.frames; ++f) {
        SeriesFrame frame;
        frame.source.path = "ball_" + std::to_string(f) + ".raw";
        frame.time = 0.5 * f;
        listing.frames.push_back(frame);
    }
    return std::make_shared<TimeSeries>(std::move(listing), [options](int frame, const JobControl&) {
        if (frame == options.broken)
            throw FileError("it ends early", "ball_" + std::to_string(frame) + ".raw", "mend it");
        std::this_thread::sleep_for(std::chrono::milliseconds(options.milliseconds));
        return ball(frame);
    });
}

/// Under tents:3. Nobody reads its source, for the series is there.
Scene sceneOf(const std::shared_ptr<TimeSeries>& series) {
    Scene basis;
    VolumeSource source;
    source.path = "ball_%d.raw";
    basis.session = sessionOf(source);
    basis.series = series;
    const ShownFrame shown = series->show(0, {});
    basis.data = shown.data;
    basis.volume = shown.volume;
    Session session = basis.session;
    session.setTf(tents(3));
    Scene scene = resolve(session, basis);
    prepareToShow(scene);
    return scene;
}

struct SeriesWindow : OpenWindow {
    std::shared_ptr<TimeSeries> series;

    explicit SeriesWindow(const BallOptions& options = {}) : series(balls(options)) {
        window.resize(1280, 900);
        services().store().open(sceneOf(series));
        window.activateWindow(); // keys go to the active window alone
        REQUIRE(waitFor([&] { return window.isActiveWindow(); }));
        settle();
    }
    PlayerController& player() { return controllers().player; }
    AdaptController& adapting() { return controllers().adapting; }
    TimeStrip& strip() { return child<TimeStrip>("timeStrip"); }
    const Session& session() { return services().store().session(); }
    int frame() { return session().frame; }
    void goTo(int frame) {
        player().goTo(frame);
        REQUIRE(waitFor([&] { return this->frame() == frame; }));
        settle();
    }
    void waitUntilKnown() {
        REQUIRE(waitFor([&] { return player().knownCount() == player().frameCount(); }));
        settle(); // what was read last is drawn, too
    }
    /// All opacities of the points times a factor.
    TransferFunction scaled(double factor) {
        TransferFunction tf = document().tf();
        for (ControlPoint& p : tf.points) p.opacity *= factor;
        return tf;
    }
    double peak() {
        double most = 0;
        for (const ControlPoint& p : document().tf().points) most = std::max(most, p.opacity);
        return most;
    }
    bool hasNotice(const QString& part) {
        for (const Notice& notice : services().notices().all())
            if (notice.text.contains(part)) return true;
        return false;
    }
};

} // namespace

TEST_CASE("frames are stepped, scrubbed and played without a step of the history", "[player]") {
    SeriesWindow w;
    InputHabits habits;
    QApplication::instance()->installEventFilter(&habits);
    CHECK_FALSE(w.child<QDockWidget>("playerDock").isHidden()); // by itself
    CHECK(w.child<QLabel>("frameLabel").text().contains("t = 0 s"));
    const QImage first = w.picture();

    QTest::keyClick(&w.view(), Qt::Key_Period);
    REQUIRE(waitFor([&] { return w.frame() == 1; }));
    w.settle();
    CHECK(w.child<QLabel>("frameLabel").text().contains("t = 0.5 s"));
    CHECK(w.picture() != first);
    CHECK(w.document().volume()->dataRange() == w.series->load(1)->dataRange());
    QTest::keyClick(&w.view(), Qt::Key_Comma);
    REQUIRE(waitFor([&] { return w.frame() == 0; }));
    CHECK(w.picture() == first); // the same frame, the same picture

    // A press on the strip goes there, a drag follows: the latest wins.
    const auto at = [&](int frame) { return w.strip().rectOf(frame).center(); };
    CHECK(w.strip().frameAt(at(4).x()) == 4);
    QTest::mouseClick(&w.strip(), Qt::LeftButton, {}, at(4).toPoint());
    REQUIRE(waitFor([&] { return w.frame() == 4; }));
    drag(w.strip(), at(4), at(2));
    REQUIRE(waitFor([&] { return w.frame() == 2 && !w.player().awaited(); }));
    QTest::keyClick(&w.strip(), Qt::Key_Right);
    REQUIRE(waitFor([&] { return w.frame() == 3; }));

    // Play goes round and round; Space pauses.
    std::set<int> seen;
    const auto watch = QObject::connect(&w.services().store(), &SessionStore::changed,
                                        [&](const Scene&, const Scene& after) { seen.insert(after.session.frame); });
    w.player().setSpeed(30);
    QTest::keyClick(&w.view(), Qt::Key_Space);
    CHECK(w.player().isPlaying());
    REQUIRE(waitFor([&] { return seen.size() == 6; })); // 5 → 0 among them
    QTest::keyClick(&w.view(), Qt::Key_Space);
    CHECK_FALSE(w.player().isPlaying());
    QObject::disconnect(watch);
    CHECK(w.child<QLabel>("rateLabel").text().contains("of 30 frames a second"));

    // Without the loop it ends at the last frame.
    w.player().setLoops(false);
    w.child<QToolButton>("play").click();
    CHECK(w.player().isPlaying());
    REQUIRE(waitFor([&] { return !w.player().isPlaying(); }));
    CHECK(w.frame() == 5);
    w.settle();
    CHECK(w.document().stepCount() == 0);
    CHECK(w.document().isClean());
}

TEST_CASE("screen readers hear the frame that keys go to", "[player][spoken]") {
    SeriesWindow w;
    CHECK(heardValue(w.strip()).startsWith("frame 1 of 6, t = 0 s")); // half a second each
    QTest::keyClick(&w.strip(), Qt::Key_Right);
    REQUIRE(waitFor([&] { return w.frame() == 1; }));
    w.settle();
    CHECK(heardValue(w.strip()).startsWith("frame 2 of 6, t = 0.5 s"));
    QAccessibleValueInterface* const number = QAccessible::queryAccessibleInterface(&w.strip())->valueInterface();
    REQUIRE(number != nullptr);
    CHECK(number->currentValue().toInt() == 2);
    CHECK(number->maximumValue().toInt() == 6);
    number->setCurrentValue(5);
    REQUIRE(waitFor([&] { return w.frame() == 4; }));
    w.settle();
    CHECK(heardValue(w.strip()).startsWith("frame 5 of 6, t = 2 s"));
}

TEST_CASE("the strip shows how many voxels have which value when", "[player]") {
    SeriesWindow w;
    w.waitUntilKnown();
    CHECK_FALSE(w.player().isSurveying());
    const QImage& image = w.strip().histogram();
    REQUIRE(image.width() == 6);
    // The ball grows, and so does the number of voxels of values above ½: within half its radius there are
    // 4/3 π (½ (0.2 + 0.05 f) 20)³ of them, 34 in frame 0 and 383 in frame 5.
    std::vector<double> bright;
    for (int f = 0; f < 6; ++f) {
        double sum = 0;
        for (int b = 0; b < image.height() / 2; ++b) sum += image.pixelColor(f, b).lightnessF();
        bright.push_back(sum);
    }
    for (int f = 1; f < 6; ++f) {
        INFO("frame " << f);
        CHECK(bright[static_cast<std::size_t>(f)] > bright[static_cast<std::size_t>(f) - 1]);
    }
    // Most voxels are 0 in all frames: the lowest bin is the brightest.
    CHECK(image.pixelColor(0, image.height() - 1).lightnessF() > image.pixelColor(0, image.height() / 2).lightnessF());
    // The mark of the present frame is drawn where that is.
    const auto marked = [&](int frame) {
        const QImage strip = w.strip().grab().toImage();
        const QPointF place = (w.strip().rectOf(frame).center()) * strip.devicePixelRatio();
        return strip.pixelColor(place.toPoint());
    };
    const QColor before = marked(3);
    w.goTo(3);
    CHECK(marked(3) != before);
}

TEST_CASE("undo leaves the frame where it is, and edits hold no frames", "[player]") {
    BallOptions options;
    options.frames = 8;
    SeriesWindow w(options);
    const double start = w.peak();
    std::vector<std::weak_ptr<const Volume>> frames;
    for (int f = 0; f < 8; ++f) {
        w.goTo(f);
        frames.push_back(w.document().volume());
        w.document().setTf(w.scaled(0.9), "Less");
    }
    CHECK(w.document().stepCount() == 8); // none was forgotten for its volume
    // With room for two frames no more than these, the present ones and those with figures live on.
    w.series->setBudget(1);
    w.goTo(0);
    w.goTo(1);
    w.goTo(7);
    int alive = 0;
    for (const auto& frame : frames) alive += frame.expired() ? 0 : 1;
    CHECK(alive <= 4);

    w.goTo(3);
    const auto volume = w.document().volume();
    for (int i = 7; i >= 0; --i) {
        w.document().undo();
        CHECK(w.frame() == 3);
        CHECK(w.peak() == Approx(start * std::pow(0.9, i)));
    }
    CHECK(w.document().volume() == volume);
    w.document().redo();
    CHECK(w.peak() == Approx(0.9 * start));

    // A window is undone on the frame that is there.
    w.opening().editData("Window", [](Session& session) {
        session.variables.edit([](std::vector<Variable>& all) { all.front().window = ValueRange{0, 0.5}; });
    });
    REQUIRE(waitFor([&] { return w.document().volume()->range().hi == 0.5; }));
    w.goTo(5);
    CHECK(w.document().volume()->range().hi == 0.5);
    const QImage narrow = w.picture();
    w.document().undo();
    CHECK(w.frame() == 5);
    CHECK(w.document().volume()->range().hi == 1);
    CHECK(w.document().histogram().total > 0);
    CHECK(w.picture() != narrow);
    // Another frame alone is nothing to be saved.
    w.services().store().setClean();
    w.goTo(2);
    CHECK(w.document().isClean());
}

TEST_CASE("a broken frame is told of once and left out", "[player]") {
    BallOptions options;
    options.broken = 2;
    SeriesWindow w(options);
    w.goTo(1);
    QTest::keyClick(&w.view(), Qt::Key_Period);
    REQUIRE(waitFor([&] { return w.frame() == 3; }));
    w.settle();
    CHECK(w.hasNotice("ball_2.raw"));
    CHECK(w.hasNotice("it ends early"));
    const auto notices = w.services().notices().all().size();
    QTest::keyClick(&w.view(), Qt::Key_Comma);
    REQUIRE(waitFor([&] { return w.frame() == 1; }));
    const QImage strip = w.strip().grab().toImage();
    const auto column = [&](int frame) { // hatched where the frame is left out
        const QRectF r = w.strip().rectOf(frame);
        const double scale = strip.devicePixelRatio();
        return strip.copy(QRectF((r.topLeft() + QPointF(2, 2)) * scale, QSizeF(8, r.height() - 4) * scale).toRect());
    };
    CHECK(column(2) != column(3));
    const auto colors = [](const QImage& image) {
        std::set<QRgb> all;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) all.insert(image.pixel(x, y));
        return all;
    };
    CHECK(colors(column(2)).contains(QColor(theme::kFalls).rgb()));
    CHECK_FALSE(colors(column(3)).contains(QColor(theme::kFalls).rgb()));
    // The player goes on behind it.
    std::set<int> seen;
    QObject::connect(&w.services().store(), &SessionStore::changed, &w.window,
                     [&](const Scene&, const Scene& after) { seen.insert(after.session.frame); });
    w.player().setSpeed(30);
    w.player().play();
    REQUIRE(waitFor([&] { return seen.size() == 5; }));
    w.player().pause();
    w.settle();
    CHECK_FALSE(seen.contains(2));
    CHECK(w.services().notices().all().size() == notices);
    // Nobody gets there by hand.
    w.goTo(3);
    w.player().goTo(2);
    w.settle();
    CHECK(w.frame() == 3);
}

TEST_CASE("frames that come too late are dropped, and that is said", "[player]") {
    BallOptions options;
    options.frames = 30;
    options.milliseconds = 60; // of which 3 or 4 are due 60 times a second
    SeriesWindow w(options);
    w.player().stopSurvey();
    CHECK(w.child<QLabel>("rateLabel").text().isEmpty());
    w.player().setSpeed(60);
    w.player().play();
    REQUIRE(waitFor([&] { return w.player().dropped() >= 3; }));
    const QString said = w.child<QLabel>("rateLabel").text();
    INFO(said.toStdString());
    CHECK(said.contains("of 60 frames a second"));
    CHECK(said.contains("dropped"));
    CHECK_FALSE(said.contains("none"));
    w.player().pause();
    w.settle();
    CHECK(w.picture() == w.picture());
}

TEST_CASE("between keys a transfer function is halfway", "[player]") {
    SeriesWindow w;
    const double start = w.peak();
    w.goTo(4);
    CHECK_FALSE(w.child<QToolButton>("tfKey").isChecked());
    w.child<QToolButton>("tfKey").click();
    CHECK(w.child<QToolButton>("tfKey").isChecked());
    w.document().setTf(w.scaled(0.5), "Half");
    CHECK(w.session().variable().track.keys.size() == 2);
    const QImage half = w.picture();
    w.goTo(2);
    CHECK(w.peak() == Approx(0.75 * start)); // halfway from 1 to ½
    CHECK_FALSE(w.child<QToolButton>("tfKey").isChecked());
    QTest::keyClick(&w.view(), Qt::Key_Comma, Qt::ControlModifier);
    REQUIRE(waitFor([&] { return w.frame() == 0; }));
    CHECK(w.peak() == Approx(start));
    QTest::keyClick(&w.view(), Qt::Key_Period, Qt::ControlModifier);
    REQUIRE(waitFor([&] { return w.frame() == 4; }));
    CHECK(w.picture() == half);
    w.goTo(2);
    w.document().undo(); // the half
    CHECK(w.frame() == 2);
    CHECK(w.peak() == Approx(start));
    w.document().undo(); // the key
    CHECK(w.session().variable().track.keys.size() == 1);

    // Targets too.
    w.document().setTargets({0.2, 0.3, 0.5});
    w.goTo(0);
    w.child<QToolButton>("targetKey").click();
    w.goTo(4);
    w.child<QToolButton>("targetKey").click();
    w.document().setTargets({0.6, 0.1, 0.3});
    w.goTo(2);
    const std::vector<double> between = w.document().targets();
    CHECK(between[0] == Approx(0.4)); // halfway from 0.2 to 0.6
    CHECK(between[1] == Approx(0.2));
    CHECK(w.document().targets().size() == 3);
    w.goTo(4);
    w.child<QToolButton>("targetKey").click(); // gone
    CHECK(w.session().targetKeys->size() == 1);
    CHECK(w.document().targets()[0] == Approx(0.2)); // those of the key that is left
}

TEST_CASE("a click on the palette refines all frames, one from the other", "[player]") {
    SeriesWindow w;
    w.child<QComboBox>("adaptMode").setCurrentIndex(1);
    Q_EMIT w.child<QComboBox>("adaptMode").activated(1);
    w.settle();
    CHECK(w.session().adapt->mode == AdaptSettings::Mode::Refine);
    const int steps = w.document().stepCount();
    auto& palette = w.child<PaletteBar>("paletteBar");
    QTest::mouseClick(&palette, Qt::LeftButton, {}, QPoint(palette.width() * 4 / 5, palette.height() / 2));
    w.settle();
    CHECK(w.document().stepCount() == steps + 1); // what follows in other frames is none
    const TfTrack& track = w.session().variable().track;
    REQUIRE(track.adapted.size() == 6);
    REQUIRE(w.session().refine->intensity.has_value());
    CHECK(w.adapting().progress().done == 6);
    CHECK(w.child<QLabel>("adaptLabel").text() == "made for all frames");

    // Each frame's is that of the frame before, refined by its own histogram.
    TransferFunction tf = *track.keys.at(0);
    RefineOptions by = w.session().refine->options();
    by.priority.intensity = w.session().refine->intensity;
    for (int f = 0; f < 6; ++f) {
        const Volume volume = ball(f).withRange({0, 1});
        tf = refine(makeHistogram(volume), tf, by).tf;
        INFO("frame " << f);
        REQUIRE(track.adapted.at(f).tf->points.size() == tf.points.size());
        for (std::size_t i = 0; i < tf.points.size(); ++i)
            CHECK(track.adapted.at(f).tf->points[i].opacity == Approx(tf.points[i].opacity).margin(1e-9));
    }
    w.goTo(5);
    CHECK(w.document().tf().points[1].opacity == Approx(tf.points[1].opacity));
    const QImage refined = w.picture();

    // An edit at a frame is a key; only what comes after it is made anew.
    w.goTo(3);
    const AdaptedTf second = track.adapted.at(2);
    w.document().setTf(w.scaled(0.5), "Half");
    w.settle();
    const TfTrack& now = w.session().variable().track;
    CHECK(now.keys.contains(3));
    CHECK(now.adapted.at(2) == second);
    w.goTo(5);
    CHECK(w.picture() != refined);
    CHECK(w.adapting().progress().done == 6); // that of the key, too
    // Undone from another frame.
    w.document().undo();
    w.settle();
    CHECK(w.frame() == 5);
    CHECK_FALSE(w.session().variable().track.keys.contains(3));
    CHECK(w.picture() == refined);
    // Without coherence frames differ, with all of it none does.
    w.child<QSlider>("coherence").setValue(100);
    w.settle();
    CHECK(std::isinf(w.session().adapt->usedCoherence()));
    CHECK(w.document().tf().points[1].opacity == Approx(w.session().variable().track.keys.at(0)->points[1].opacity));
}

TEST_CASE("a region of the picture is brought out in all frames", "[player]") {
    SeriesWindow w;
    w.child<QAction>("adaptRefineAction").trigger();
    w.settle();
    const QPoint middle(w.view().width() / 2, w.view().height() / 2);
    w.child<QAction>("rectangleAction").trigger();
    drag(w.view(), middle - QPoint(12, 12), middle + QPoint(12, 12));
    REQUIRE(waitFor([&] { return w.session().refine->region.has_value(); }));
    w.settle();
    REQUIRE(w.adapting().progress().done == 6);
    // What every frame is refined for: the colours that the key's picture shows there.
    const TfTrack& track = w.session().variable().track;
    const RefineSettings& favoured = *w.session().refine;
    CHECK(favoured.regionSize[0] == 320); // the longer side of the view, as the selection was looked at
    TransferFunction tf = *track.keys.at(0);
    RefineOptions by = favoured.options();
    by.priority.region = regionColors(sceneAt(w.services().scene(), 0, tf), *favoured.region, favoured.regionSize);
    for (int f = 0; f < 6; ++f) {
        tf = refine(makeHistogram(ball(f).withRange({0, 1})), tf, by).tf;
        INFO("frame " << f);
        REQUIRE(track.adapted.at(f).tf->points.size() == tf.points.size());
        for (std::size_t i = 0; i < tf.points.size(); ++i)
            CHECK(track.adapted.at(f).tf->points[i].opacity == Approx(tf.points[i].opacity).margin(1e-9));
    }
    CHECK(w.child<QLabel>("refinePriority").text() == "Prioritized: a region");
    w.child<QToolButton>("clearPriorityButton").click();
    w.settle();
    CHECK_FALSE(w.session().refine->favoursAny());
    CHECK(w.adapting().progress().done == 6); // made anew, for nothing
    RefineOptions evenly = w.session().refine->options();
    tf = refine(makeHistogram(ball(0).withRange({0, 1})), *w.session().variable().track.keys.at(0), evenly).tf;
    CHECK(w.session().variable().track.adapted.at(0).tf->points[1].opacity == Approx(tf.points[1].opacity));
}

TEST_CASE("a hue of a session stands on the palette and is brought out in all frames", "[player]") {
    SeriesWindow w;
    w.services().store().edit("Hue", {}, [](Session& session) {
        session.refine.edit([](RefineSettings& r) { r.hue = 180; });
        session.adapt.edit([](AdaptSettings& a) { a.mode = AdaptSettings::Mode::Refine; });
    });
    w.settle();
    CHECK(w.child<QLabel>("refinePriority").text() == "Prioritized: hue 180°");
    REQUIRE(w.adapting().progress().done == 6);
    const TfTrack& track = w.session().variable().track;
    RefineOptions by = w.session().refine->options();
    by.priority.intensity = 0.5; // the middle tent of tents:3
    TransferFunction tf = *track.keys.at(0);
    for (int f = 0; f < 6; ++f) {
        tf = refine(makeHistogram(ball(f).withRange({0, 1})), tf, by).tf;
        CHECK(track.adapted.at(f).tf->points[4].opacity == Approx(tf.points[4].opacity).margin(1e-9));
    }
    auto& palette = w.child<PaletteBar>("paletteBar"); // a click there takes its place
    QTest::mouseClick(&palette, Qt::LeftButton, {}, palette.positionOf(1.0 / 6).toPoint());
    CHECK_FALSE(w.session().refine->hue);
    CHECK(w.session().refine->intensity);
}

TEST_CASE("with coherence frames are smoothed together, and undo knows nothing of it", "[player]") {
    SeriesWindow w;
    w.document().setTargets({0.2, 0.3, 0.5});
    w.child<QSlider>("coherence").setValue(60); // a step of its own: coherences in a row are one
    w.child<QAction>("adaptOptimizeAction").trigger();
    const int steps = w.document().stepCount();
    w.settle();
    REQUIRE(*w.session().adapt->coherence > 0);
    REQUIRE(std::isfinite(*w.session().adapt->coherence));
    const auto track = [&]() -> const TfTrack& { return w.session().variable().track; };
    REQUIRE(track().adapted.size() == 6);
    for (const auto& [frame, adapted] : track().adapted) {
        INFO("frame " << frame);
        REQUIRE(adapted.smooth);
        CHECK_FALSE(adapted.smoothBasis.empty());
        CHECK(adapted.smoothBasis == track().adapted.at(1).smoothBasis);
    }
    CHECK(w.adapting().progress().smooth == 6);
    CHECK(w.child<QLabel>("adaptLabel").text() == "made for all frames");
    CHECK(w.document().stepCount() == steps);
    // What is shown and edited is the smoothed one.
    w.goTo(4);
    CHECK(w.document().tf() == **track().adapted.at(4).smooth);
    const QImage smooth = w.picture();
    const AdaptedTf made = track().adapted.at(4);
    // Without coherence the frames are made anew, each for itself; back again it is the picture it was.
    w.child<QSlider>("coherence").setValue(0);
    w.settle();
    CHECK_FALSE(track().adapted.at(4).smooth);
    CHECK(w.picture() != smooth);
    w.document().undo();
    w.settle();
    CHECK(track().adapted.at(4) == made);
    CHECK(w.picture() == smooth);
}

TEST_CASE("every frame is optimized to the targets, and the curves show it", "[player]") {
    SeriesWindow w;
    w.services().store().edit("Exact shares", {}, [](Session& session) { // else what can hardly be seen gets more
        session.optimize.edit([](OptimizeOptions& options) { options.exactShares = true; });
    });
    w.document().setTargets({0.2, 0.3, 0.5});
    w.settle();
    w.child<QAction>("adaptOptimizeAction").trigger();
    CHECK(w.session().adapt->usedCoherence() == kUsualCoherence);
    CHECK(w.child<QLabel>("coherenceLabel").text() == "2");
    w.adapting().setCoherence(0);
    w.settle();
    CHECK(w.adapting().progress().done == w.adapting().progress().all);
    REQUIRE(w.session().variable().track.adapted.size() == 6);

    w.child<QAction>("temporalAction").trigger();
    auto& panel = *w.window.findChild<TemporalPanel*>();
    CHECK(panel.knownCount() == 0);
    w.child<QToolButton>("temporalMeasure").click();
    REQUIRE(waitFor([&] { return panel.knownCount() == 6; }));
    const TemporalCurves curves = panel.curves();
    REQUIRE(curves.runs.size() == 2);
    CHECK(curves.runs[0].name == "optimize");
    for (int f = 0; f < 6; ++f) {
        INFO("frame " << f);
        CHECK(curves.runs[0].frames[static_cast<std::size_t>(f)].objective < 0.02);
        CHECK(curves.runs[1].frames[static_cast<std::size_t>(f)].objective > 0.02); // nobody has optimized the key
        if (f == 0) continue;                                                       // nothing is before it
        CHECK(*curves.runs[1].frames[static_cast<std::size_t>(f)].flicker == 0);
        CHECK(*curves.runs[0].frames[static_cast<std::size_t>(f)].flicker > 0);
    }
    CHECK(w.child<QLabel>("temporalWords").text().contains("flicker"));
    // The worst frame of the static run is told with its number, and how many are not on target.
    const SequenceFigures still = summaryOf(curves.runs[1].frames);
    CHECK(w.child<QLabel>("temporalWords").text().contains(QStringLiteral(", frame %1").arg(still.worst)));
    CHECK(w.child<QLabel>("temporalWords").text().contains(QStringLiteral("%1 more than 3.0 %").arg(still.above)));
    // The figures of the frame that is shown are those of the curve.
    w.goTo(4);
    REQUIRE(waitFor([&] { return w.services().results().measuresAreCurrent(); }));
    CHECK(*w.services().results().objective() == Approx(curves.runs[0].frames[4].objective).margin(1e-9));
    QTemporaryDir folder;
    for (const char* name : {"curves.csv", "curves.png", "curves.svg"}) {
        panel.exportTo(folder.filePath(name));
        CHECK(QFileInfo(folder.filePath(name)).size() > 500);
    }
    QFile csv(folder.filePath("curves.csv"));
    REQUIRE(csv.open(QIODevice::ReadOnly));
    CHECK(QString::fromUtf8(csv.readAll()).split('\n', Qt::SkipEmptyParts).size() == 1 + 2 * 6);
    // What catches the eye in the pictures is measured when it is chosen, and stays known.
    CHECK_FALSE(curves.hasPictures());
    auto& shown = w.child<QComboBox>("temporalShown");
    while (shown.currentIndex() < 3) QTest::keyClick(&shown, Qt::Key_Down);
    CHECK(panel.knownCount() == 0);
    w.child<QToolButton>("temporalMeasure").click();
    REQUIRE(waitFor([&] { return panel.knownCount() == 6; }));
    const TemporalCurves pictured = panel.curves();
    for (const TemporalRun& run : pictured.runs)
        for (const FrameFigures& f : run.frames) {
            REQUIRE(f.fs.size() == 3);
            CHECK(f.fs[0] + f.fs[1] + f.fs[2] == Approx(1));
        }
    CHECK(pictured.runs[0].frames[4].fs != pictured.runs[1].frames[4].fs);
    while (shown.currentIndex() > 0) QTest::keyClick(&shown, Qt::Key_Up);
    CHECK(panel.knownCount() == 6);
    CHECK(panel.curves().hasPictures());
    const QImage drawn = w.child<QWidget>("temporalDynamic").grab().toImage();
    // From another side nothing is known any more.
    Camera camera = w.document().camera();
    camera.eye = camera.center + 1.2 * (camera.eye - camera.center);
    w.document().setCamera(camera);
    CHECK(panel.knownCount() == 0);
    CHECK(w.child<QWidget>("temporalDynamic").grab().toImage() != drawn);
}

TEST_CASE("behind a broken frame there is no flicker unless it is asked for", "[player]") {
    SeriesWindow w(BallOptions{.broken = 2});
    w.waitUntilKnown();
    w.child<QComboBox>("adaptMode").setCurrentIndex(1);
    Q_EMIT w.child<QComboBox>("adaptMode").activated(1);
    w.settle();
    w.child<QAction>("temporalAction").trigger();
    auto& panel = *w.window.findChild<TemporalPanel*>();
    const auto measured = [&] {
        if (panel.knownCount() < 6) w.child<QToolButton>("temporalMeasure").click();
        REQUIRE(waitFor([&] { return panel.knownCount() == 6; }));
        return panel.curves().runs[0].frames;
    };
    const auto frames = measured();
    CHECK_FALSE(frames[2].problem.empty());
    for (std::size_t f : {0, 2, 3}) CHECK_FALSE(frames[f].flicker);
    for (std::size_t f : {1, 4, 5}) CHECK(frames[f].flicker);
    CHECK(frames[3].file == "ball_3.raw");
    w.child<QCheckBox>("temporalOverGaps").click();
    CHECK(panel.isOverGaps());
    const auto over = measured();
    CHECK(over[3].flicker);
    CHECK(over[4].flicker == frames[4].flicker);
    w.child<QCheckBox>("temporalOverGaps").click();
    CHECK_FALSE(measured()[3].flicker);
}

TEST_CASE("a session with a series comes back at its frame", "[player]") {
    OpenWindow w;
    VolumeSource source;
    source.path = "sample:vortex";
    source.sampleSize = 16;
    source.frames = FrameRange{0, 9, 3}; // 0, 3, 6, 9
    w.open(source);
    w.settle();
    PlayerController& player = w.controllers().player;
    REQUIRE(player.frameCount() == 4);
    player.goTo(2);
    REQUIRE(waitFor([&] { return w.services().scene().session.frame == 2; }));
    w.settle();
    CHECK(w.child<QLabel>("volumeLabel").text().contains("(3 of 4)"));
    w.controllers().adapting.setTfKey();
    w.document().setTarget(0, 0.5);
    w.controllers().adapting.setTargetKey();
    w.controllers().adapting.setMode(AdaptSettings::Mode::Refine);
    w.settle();
    const QImage before = w.picture();
    const Session saved = w.services().store().session();
    QTemporaryDir folder;
    const QString path = folder.filePath("vortex.pellucid.json");
    REQUIRE(w.saving().saveSession(path));
    CHECK(w.document().isClean());
    player.goTo(0);
    w.settle();
    CHECK(w.document().isClean()); // another frame is nothing to be saved

    OpenWindow other;
    other.opening().openSession(path);
    REQUIRE(waitFor([&] { return other.services().scene().series->size() == 4; }));
    other.settle();
    const Session& opened = other.services().store().session();
    CHECK(opened.frame == 2);
    CHECK(opened.variable().track.keys == saved.variable().track.keys);
    CHECK(opened.targetKeys == saved.targetKeys);
    CHECK(opened.adapt->mode == AdaptSettings::Mode::Refine);
    CHECK(opened.variable().track.adapted == saved.variable().track.adapted); // true still: not made again
    CHECK(other.document().isClean());
    other.window.resize(w.window.size());
    REQUIRE(waitFor([&] { return other.view().size() == w.view().size(); }));
    other.settle();
    CHECK(largestDifference(other.picture(), before) <= 4); // of 255: a slow machine draws rays in portions
}

TEST_CASE("the playhead of a film goes to the frames of its keys, with what belongs to them", "[player][keyframes]") {
    SeriesWindow w;
    KeyframesController& keyframes = w.controllers().keyframes;
    keyframes.add();
    w.goTo(4);
    w.document().setTf(w.scaled(0.5), "Fade");
    const double faint = w.peak();
    keyframes.add();
    REQUIRE(keyframes.keys().size() == 2);
    CHECK(keyframes.keys()[1].state.frame == 4);
    keyframes.goTo(0);
    REQUIRE(waitFor([&] { return w.frame() == 0; }));
    w.settle();
    CHECK(w.peak() == Approx(2 * faint));
    keyframes.goTo(1); // halfway
    REQUIRE(waitFor([&] { return w.frame() == 2; }));
    w.settle();
    CHECK(w.peak() == Approx(1.5 * faint));
    keyframes.goTo(2);
    REQUIRE(waitFor([&] { return w.frame() == 4; }));
    w.settle();
    CHECK(w.peak() == Approx(faint));
}
