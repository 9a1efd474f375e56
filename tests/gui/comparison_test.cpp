// Comparing in the window: B beside A, wiped over it, as a difference; figures of both as the command line has them.
#include "gui_support.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QTemporaryDir>

#include "image_io/image_file.h"
#include "panels/compare_bars.h"
#include "render/camera_motion.h"
#include "session/session_json.h"
#include "tf/formats/tf_json.h"
#include "view/compared_view.h"
#include "view/difference_layer.h"
#include "view/wipe_divider.h"

using namespace pellucid;
using namespace pellucid::gui;
using nlohmann::json;

namespace {

using State = ComparisonController::State;

ComparisonController& comparing(OpenWindow& w) { return w.controllers().comparing; }
void trigger(OpenWindow& w, const char* action) { w.child<QAction>(action).trigger(); }

void setOpacities(OpenWindow& w, const std::vector<double>& opacities) {
    w.document().setTf(withFeatureOpacities(w.document().tf(), opacities), "Opacities");
}

/// Pinned, then changed: B is what A was. All has its place.
void pinAndChange(OpenWindow& w) {
    trigger(w, "comparePinAction");
    w.settle();
    QTest::qWait(100); // docks arrange themselves
    setOpacities(w, {0.02, 0.1, 0.9});
    w.settle();
    REQUIRE(comparing(w).state() == State::Current);
}

/// Pixels of the widget as they are on the screen, without what lies over its picture.
QImage pictureOf(OpenWindow& w, QWidget& view, const char* overlay) {
    auto& over = *view.findChild<QWidget*>(overlay);
    w.settle();
    over.hide();
    const QImage image = view.grab().toImage().convertToFormat(QImage::Format_RGB32);
    over.show();
    return image;
}
QImage pictureOfA(OpenWindow& w) { return pictureOf(w, w.view(), "viewOverlay"); }
QImage pictureOfB(OpenWindow& w) { return pictureOf(w, w.window.views().compared(), "comparedOverlay"); }

void choose(QComboBox& box, int index) {
    while (box.currentIndex() != index) QTest::keyClick(&box, box.currentIndex() < index ? Qt::Key_Down : Qt::Key_Up);
}

QString savedAs(OpenWindow& w, ComparisonController::File file, const QString& path) {
    QSignalSpy spy(&comparing(w), &ComparisonController::saved);
    comparing(w).save(file, path);
    REQUIRE(waitFor([&] { return spy.count() == 1; }));
    return path;
}

Image readAt(const QString& path) { return readImage(path.toStdString()); }

} // namespace

TEST_CASE("a pinned state stands beside what becomes of it, and stays over an undo", "[comparison]") {
    OpenWindow w(24, GENERATE(ViewRenderer::Cpu, ViewRenderer::Auto));
    CHECK(w.window.views().compared().isHidden());
    CHECK_FALSE(w.child<QAction>("compareUseAction").isEnabled());
    const int steps = w.document().stepCount();
    trigger(w, "comparePinAction");
    CHECK(w.document().stepCount() == steps); // it is no step, and nothing to be saved
    CHECK(w.document().isClean());
    w.settle();
    QTest::qWait(100);
    w.settle();
    REQUIRE(comparing(w).state() == State::Current);
    // Both are the same, on the screen too.
    CHECK(comparing(w).comparison()->difference.largest == 0);
    CHECK(comparing(w).comparison()->difference.ssim == 1);
    CHECK(comparing(w).sceneB()->volume == w.document().volume()); // which is not there twice
    const QImage before = pictureOfA(w);
    CHECK(largestDifference(before, pictureOfB(w)) == 0);

    setOpacities(w, {0.02, 0.1, 0.9});
    CHECK(comparing(w).state() == State::Computing);
    CHECK_FALSE(w.child<CompareBars>("compareBars").isCurrent()); // pale until they are measured
    w.settle();
    const Comparison& c = *comparing(w).comparison();
    CHECK(c.difference.mean > 0.5);
    CHECK(c.difference.ssim < 1);
    REQUIRE(c.features.size() == 3);
    CHECK(c.features[0].a->opacity == Approx(0.02));
    CHECK(c.features[0].b->opacity == Approx(0.5)); // the peak of tents:3
    CHECK(pictureOfA(w) != before);
    CHECK(largestDifference(before, pictureOfB(w)) == 0);
    CHECK(w.child<CompareBars>("compareBars").isCurrent());
    CHECK(w.child<QLabel>("compareWords").text().contains("SSIM"));

    trigger(w, "undoAction");
    w.settle();
    REQUIRE(comparing(w).hasB());
    CHECK(comparing(w).comparison()->difference.largest == 0);
    trigger(w, "compareClearAction");
    CHECK(w.window.views().compared().isHidden());
    CHECK_FALSE(comparing(w).hasB());
}

TEST_CASE("figures of a comparison are those of the command line", "[comparison][doors]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    QTemporaryDir folder;
    w.services().store().edit("Engine", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
        session.pictureSaliency.edit([](PictureSaliencyView& view) { view.on = true; });
    });
    pinAndChange(w);
    const QString session = folder.filePath("a.pellucid.json");
    REQUIRE(w.saving().saveSession(session));
    const Comparison& ours = *comparing(w).comparison();

    QProcess process;
    const QString size = QStringLiteral("%1x%2").arg(ours.imageA.width).arg(ours.imageA.height);
    process.start(PELLUCID_CLI_PROGRAM, {"compare", session, "--size", size, "--json"}); // it has kept B
    REQUIRE(process.waitForFinished(kPatience));
    INFO(process.readAllStandardError().toStdString());
    REQUIRE(process.exitCode() == 0);
    const json theirs = json::parse(process.readAllStandardOutput().toStdString());
    CHECK(theirs["ssim"].get<double>() == Approx(ours.difference.ssim).margin(1e-9));
    CHECK(theirs["delta_e"]["mean"].get<double>() == Approx(ours.difference.mean).margin(1e-9));
    CHECK(theirs["delta_e"]["largest"].get<double>() == Approx(ours.difference.largest).margin(1e-6));
    CHECK(theirs["delta_e"]["noticed"].get<double>() == Approx(ours.difference.noticed).margin(1e-9));
    REQUIRE(theirs["features"].size() == ours.features.size());
    auto& bars = w.child<CompareBars>("compareBars");
    auto& box = w.child<QComboBox>("compareFigure");
    for (std::size_t n = 0; n < comparedFigures().size(); ++n) {
        choose(box, static_cast<int>(n));
        const auto values = bars.values();
        for (std::size_t f = 0; f < ours.features.size(); ++f) {
            const char* const key = comparedFigures()[n].key;
            INFO(key << " of feature " << f);
            CHECK(theirs["features"][f]["a"][key].get<double>() == Approx(values[f].a.value()).margin(1e-9));
            CHECK(theirs["features"][f]["b"][key].get<double>() == Approx(values[f].b.value()).margin(1e-9));
        }
    }
    // Bars have the lengths of their values, on one scale.
    const auto values = bars.values();
    CHECK(bars.barRect(0, false).width() / bars.barRect(2, false).width() ==
          Approx(values[0].a.value() / values[2].a.value()));

    // What is saved is what is shown.
    const json saved = json::parse(
        std::ifstream(savedAs(w, ComparisonController::File::Figures, folder.filePath("f.json")).toStdString()));
    CHECK(saved["features"] == theirs["features"]);
    std::ifstream table(savedAs(w, ComparisonController::File::Figures, folder.filePath("f.csv")).toStdString());
    std::string head;
    std::getline(table, head);
    CHECK(head == "feature,figure,a,b,difference");
    const Image map = readAt(savedAs(w, ComparisonController::File::Difference, folder.filePath("d.exr")));
    CHECK(*std::max_element(map.rgba.begin(), map.rgba.end()) == Approx(ours.difference.largest).epsilon(1e-4));
    const Image both = readAt(savedAs(w, ComparisonController::File::SideBySide, folder.filePath("both.png")));
    CHECK(both.width == 2 * ours.imageA.width);
    CHECK(both.height == ours.imageA.height);
    const int x = both.width / 4, y = both.height / 2;
    CHECK(both.pixel(x, y)[0] == Approx(ours.imageA.pixel(x, y)[0]).margin(0.003));
    CHECK(both.pixel(x + ours.imageA.width, y)[0] == Approx(ours.imageB.pixel(x, y)[0]).margin(0.003));
}

TEST_CASE("views that are linked turn together, others do not", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    trigger(w, "comparePinAction");
    w.settle();
    QWidget& b = w.window.views().compared();
    const Camera first = w.document().camera();
    drag(w.view(), {100, 100}, {160, 120});
    const Camera second = w.document().camera();
    CHECK_FALSE(second == first);
    CHECK(comparing(w).sceneB()->camera == second);
    drag(b, {100, 100}, {60, 100});
    const Camera third = w.document().camera();
    CHECK_FALSE(third == second);
    CHECK(comparing(w).sceneB()->camera == third);
    // B goes back to where it was pinned, and is turned alone.
    w.child<QCheckBox>("compareSameView").click();
    CHECK(comparing(w).sceneB()->camera == first);
    drag(w.view(), {100, 100}, {160, 120});
    CHECK(comparing(w).sceneB()->camera == first);
    const Camera ofA = w.document().camera();
    drag(b, {100, 100}, {60, 100});
    CHECK(w.document().camera() == ofA);
    CHECK_FALSE(comparing(w).sceneB()->camera == first);
    QTest::keyClick(&b, Qt::Key_Up);
    QTest::mouseDClick(&b, Qt::LeftButton);
    CHECK(w.document().camera() == ofA);
    w.settle();
    // Of one transfer function figures differ by the view alone.
    const Comparison& c = *comparing(w).comparison();
    CHECK(c.features[0].a->opacity == c.features[0].b->opacity);
    CHECK(c.features[0].a->vws != c.features[0].b->vws);
    w.child<QCheckBox>("compareSameView").click();
    CHECK(comparing(w).sceneB()->camera == ofA);
}

TEST_CASE("a wipe shows A to the left of its border and B to the right", "[comparison]") {
    OpenWindow w(24, GENERATE(ViewRenderer::Cpu, ViewRenderer::Auto));
    pinAndChange(w);
    trigger(w, "compareOffAction");
    const QImage a = pictureOfA(w);
    trigger(w, "undoAction");
    const QImage b = pictureOfA(w);
    trigger(w, "redoAction");
    trigger(w, "compareWipeAction");
    w.settle();
    auto& divider = w.child<WipeDivider>("wipeDivider");
    REQUIRE(divider.isVisible());
    const auto check = [&] {
        w.settle();
        auto& overlayA = w.child<QWidget>("viewOverlay");
        auto& overlayB = w.child<QWidget>("comparedOverlay");
        const QImage whole = [&] {
            overlayA.hide();
            overlayB.hide();
            divider.hide();
            QImage image = w.window.views().grab(QRect(w.view().pos(), w.view().size())).toImage();
            overlayA.show();
            overlayB.show();
            divider.show();
            return image.convertToFormat(QImage::Format_RGB32);
        }();
        REQUIRE(whole.size() == a.size());
        const int border = divider.columnOf(w.view().width());
        CHECK(largestDifference(whole.copy(0, 0, border, whole.height()), a.copy(0, 0, border, a.height())) == 0);
        const QRect right(border, 0, whole.width() - border, whole.height());
        CHECK(largestDifference(whole.copy(right), b.copy(right)) == 0);
        return border;
    };
    const int middle = check();
    CHECK(middle == Approx(w.view().width() / 2.0).margin(1));
    // It goes along under the hand.
    const QPointF grip(WipeDivider::kWidth / 2, 60), pressed = divider.mapToParent(grip);
    const auto send = [&](QEvent::Type type, double way, Qt::MouseButtons held) {
        const QPointF at = divider.mapFromParent(pressed + QPointF(way, 0));
        QMouseEvent event(type, at, divider.mapToGlobal(at), Qt::LeftButton, held, Qt::NoModifier);
        QCoreApplication::sendEvent(&divider, &event);
    };
    send(QEvent::MouseButtonPress, 0, Qt::LeftButton);
    for (const double way : {20.0, -40.0, 80.0}) send(QEvent::MouseMove, way, Qt::LeftButton);
    send(QEvent::MouseButtonRelease, 80, Qt::NoButton);
    CHECK(check() == Approx(middle + 80).margin(1));
    divider.setFocus();
    QTest::keyClick(&divider, Qt::Key_Left, Qt::ShiftModifier);
    CHECK(check() == Approx(middle + 80 - 0.1 * w.view().width()).margin(1));
    QTest::keyClick(&divider, Qt::Key_Home);
    CHECK(check() == 0);
    QTest::mouseDClick(&divider, Qt::LeftButton);
    CHECK(check() == middle);
    // A hand beside the border turns both.
    const Camera before = w.document().camera();
    drag(w.window.views().compared(), {60, 100}, {100, 100});
    CHECK_FALSE(w.document().camera() == before);
    CHECK(comparing(w).sceneB()->camera == w.document().camera());
}

TEST_CASE("the difference lies over the picture that it is of", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    pinAndChange(w);
    trigger(w, "compareOffAction");
    w.settle();
    const QImage plain = w.picture();
    trigger(w, "compareDifferenceAction");
    w.settle();
    CHECK(w.child<QComboBox>("compareMode").currentIndex() == static_cast<int>(CompareMode::Difference));
    CHECK(w.window.views().compared().isHidden());
    const QImage mapped = w.picture();
    // Where the difference is largest the colour of the map is seen, where there is none the picture.
    const Plane& map = comparing(w).comparison()->difference.map;
    const auto at = std::max_element(map.values.begin(), map.values.end()) - map.values.begin();
    const QPoint most(static_cast<int>(at) % map.width, static_cast<int>(at) / map.width);
    CHECK(mapped.pixel(most) != plain.pixel(most));
    int same = 0;
    for (int y = map.height / 2; y < map.height; ++y) {
        if (map.row(y)[20] > 0) continue;
        ++same;
        CHECK(mapped.pixel(20, y) == plain.pixel(20, y));
    }
    CHECK(same > 0);
    CHECK(topOfDifferences(4.9) == 5);
    CHECK(topOfDifferences(50.1) == 100);
    // Of equal states there is none: what is drawn over the picture are legend and name.
    trigger(w, "undoAction");
    w.settle();
    CHECK(comparing(w).comparison()->difference.largest == 0);
    CHECK(w.child<QLabel>("compareWords").text().contains("0.0 % of the pixels"));
}

TEST_CASE("B becomes the present state by one step, or changes place with it", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    const TransferFunction first = w.document().tf();
    pinAndChange(w);
    const TransferFunction second = w.document().tf();
    const int steps = w.document().stepCount();
    w.child<QPushButton>("compareUse").click();
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(rangeless(w.document().tf()).points == rangeless(first).points);
    trigger(w, "undoAction");
    CHECK(w.document().tf() == second);
    w.child<QPushButton>("compareSwap").click();
    CHECK(rangeless(w.document().tf()).points == rangeless(first).points);
    CHECK(rangeless(comparing(w).sceneB()->tf).points == rangeless(second).points);
    // Undo brings back what B was, too.
    trigger(w, "undoAction");
    CHECK(w.document().tf() == second);
    CHECK(rangeless(comparing(w).sceneB()->tf).points == rangeless(first).points);
    trigger(w, "redoAction");
    CHECK(rangeless(w.document().tf()).points == rangeless(first).points);
    CHECK(rangeless(comparing(w).sceneB()->tf).points == rangeless(second).points);
}

TEST_CASE("B may be a preset, a file, a session, an earlier step, a frame or a view", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    QTemporaryDir folder;
    const auto nameOfB = [&] { return w.child<QLabel>("compareName").text(); };
    comparing(w).compareWithTf("tents:2:0.5", "two tents");
    CHECK(nameOfB() == "B: two tents");
    CHECK(comparing(w).sceneB()->tf.features.size() == 2);
    w.settle();
    CHECK(comparing(w).comparison()->features.size() == 3); // f1, f2 on both sides, f3 on one
    CHECK_FALSE(comparing(w).comparison()->features[2].b);

    const QString session = folder.filePath("s.pellucid.json");
    w.services().store().edit("Light", {}, [](Session& s) {
        s.display.edit([](DisplaySettings& d) { d.background = {1, 1, 1}; });
    });
    REQUIRE(w.saving().saveSession(session));
    trigger(w, "undoAction");
    comparing(w).compareWithSession(session);
    CHECK(nameOfB() == "B: s.pellucid.json");
    CHECK(comparing(w).sceneB()->session.display->background == Rgb{1, 1, 1});
    w.child<QCheckBox>("compareSameLook").click();
    CHECK(comparing(w).sceneB()->session.display->background == Rgb{0, 0, 0});

    const TransferFunction before = w.document().tf();
    setOpacities(w, {0.02, 0.1, 0.9});
    comparing(w).compareWithStep(w.services().store().doneCount() - 1);
    CHECK(nameOfB() == "B: Before: Opacities");
    CHECK(rangeless(comparing(w).sceneB()->tf).points == rangeless(before).points);

    const Camera ofA = w.document().camera();
    comparing(w).compareWithView(StandardView::Top);
    CHECK_FALSE(comparing(w).sceneB()->camera == ofA);
    CHECK(w.document().camera() == ofA);
    CHECK_FALSE(w.child<QCheckBox>("compareSameView").isChecked());
}

TEST_CASE("B is kept in the session file", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    QTemporaryDir folder;
    pinAndChange(w);
    trigger(w, "compareWipeAction");
    const ComparisonView kept = comparing(w).view();
    const QString path = folder.filePath("s.pellucid.json");
    REQUIRE(w.saving().saveSession(path));
    trigger(w, "compareClearAction");
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openSession(path);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(comparing(w).view() == kept);
    CHECK(comparing(w).state() == State::Current);
    CHECK(w.child<WipeDivider>("wipeDivider").isVisible());
}

TEST_CASE("a comparison rests while a field is drawn", "[comparison]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    pinAndChange(w);
    trigger(w, "fieldAction");
    CHECK(comparing(w).state() == State::Field);
    CHECK(w.window.views().compared().isHidden());
    CHECK(w.child<QLabel>("compareState").text().startsWith("A field is drawn"));
    trigger(w, "fieldAction");
    w.settle();
    CHECK(comparing(w).state() == State::Current);
    CHECK_FALSE(w.window.views().compared().isHidden());
}

TEST_CASE("frames of a series are compared, and B may follow them", "[comparison][series]") {
    OpenWindow w(16, ViewRenderer::Cpu);
    VolumeSource source;
    source.path = "sample:vortex";
    source.sampleSize = 16;
    w.open(source);
    w.settle();
    PlayerController& player = w.controllers().player;
    comparing(w).compareWithFrame(40);
    w.settle();
    REQUIRE(comparing(w).state() == State::Current);
    CHECK(comparing(w).sceneB()->session.frame == 40);
    CHECK_FALSE(comparing(w).sceneB()->volume == w.document().volume());
    CHECK(comparing(w).comparison()->difference.largest > 0);
    const auto goTo = [&](int frame) {
        player.goTo(frame);
        REQUIRE(waitFor([&] { return player.frame() == frame; }));
        w.settle();
    };
    goTo(40);
    CHECK(comparing(w).comparison()->difference.largest == 0);
    goTo(10);
    CHECK(comparing(w).sceneB()->session.frame == 40);
    w.child<QCheckBox>("compareSameFrame").click();
    w.settle();
    CHECK(comparing(w).sceneB()->session.frame == 10);
    CHECK(comparing(w).comparison()->difference.largest == 0);
    goTo(11);
    CHECK(comparing(w).sceneB()->volume == w.document().volume());
}
