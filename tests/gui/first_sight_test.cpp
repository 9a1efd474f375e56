// What a window does with a volume that brings no transfer function, and what it says about it.
#include "gui_support.h"

#include <cstring>
#include <filesystem>

#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSettings>

#include "controllers/start_controller.h"
#include "support/ball_on_board.h"
#include "support/outlier_boxes.h"
#include "window/welcome_card.h"

using namespace pellucid;
using namespace pellucid::gui;
using pellucid::test::boxesWithOutlier;
using pellucid::test::TempFolder;

namespace {

/// Part of the pixels in the middle third that are not black.
double litShare(const QImage& picture) {
    int lit = 0, all = 0;
    for (int y = picture.height() / 3; y < 2 * picture.height() / 3; ++y)
        for (int x = picture.width() / 3; x < 2 * picture.width() / 3; ++x, ++all)
            lit += qGray(picture.pixel(x, y)) > 12;
    return static_cast<double>(lit) / all;
}

QString noticeText(OpenWindow& w) { return w.child<QLabel>("noticeText").text(); }

} // namespace

TEST_CASE("a volume opens under its proposal, and its opacities come as a step", "[first sight]") {
    const TempFolder folder;
    OpenWindow w;
    w.opening().openVolume(boxesWithOutlier(folder));
    REQUIRE(waitFor([&] { return w.document().volume()->title == "boxes.raw"; }));
    w.settle();
    SceneInputs inputs;
    inputs.session = sessionOf(boxesWithOutlier(folder));
    const Scene tuned = openScene(inputs);
    CHECK(w.document().tf() == tuned.tf);             // as the command line has it
    CHECK(w.document().targets() == tuned.targets()); // what the start aims at
    CHECK(w.document().targets()[0] != Approx(w.document().targets()[1]).margin(0.05));
    CHECK(w.services().store().undoText() == "Automatic opacities");
    CHECK(w.document().isClean()); // the user has done nothing
    const QImage after = w.picture();
    CHECK(litShare(after) > 0.2);

    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf().points == tuned.proposal->tf.points);
    CHECK(w.document().targets()[0] == Approx(w.document().targets()[1])); // they are part of that step
    const QImage first = w.picture();
    CHECK(litShare(first) > 0.2); // the first picture shows something, too
    CHECK(first != after);
    w.child<QAction>("redoAction").trigger();
    CHECK(w.document().tf() == tuned.tf);
    CHECK(w.picture() == after);
}

TEST_CASE("values far off are said to lie beyond, and a click brings the full range", "[first sight]") {
    const TempFolder folder;
    OpenWindow w;
    w.opening().openVolume(boxesWithOutlier(folder));
    REQUIRE(waitFor([&] { return w.document().volume()->title == "boxes.raw"; }));
    w.settle();
    const ValueRange window = w.document().volume()->range();
    CHECK(window.hi < 400);
    CHECK(noticeText(w).contains("1e+06"));
    const TransferFunction tf = w.document().tf();

    QTest::mouseClick(&w.child<QPushButton>("noticeChoice0"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return w.document().volume()->range() == ValueRange{0, 1e6}; }));
    CHECK(w.services().store().undoText() == "Full range");
    CHECK_FALSE(noticeText(w).contains("1e+06"));
    // Values keep what they had; those beyond have that of the end.
    const auto opacityOf = [&](double value) {
        return w.document().tf().opacity(w.document().volume()->intensityOfValue(value));
    };
    CHECK(opacityOf(200) == Approx(tf.opacity(200 / window.hi)).epsilon(0.01));
    const QImage full = w.picture();
    CHECK(litShare(full) > 0.2);

    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().volume()->range() == window);
    CHECK(w.document().tf() == tf);
    CHECK(litShare(w.picture()) == Approx(litShare(full)).margin(0.1)); // values keep their opacity
}

TEST_CASE("a board on which an object lies is faint behind it, and a click leaves it out", "[first sight]") {
    const TempFolder folder;
    OpenWindow w;
    VolumeSource source;
    source.path = folder.write("onboard.raw", test::ballOnBoard());
    source.raw = RawLayout{{40, 40, 40}, SampleType::U8, false, 0};
    w.opening().openVolume(source);
    REQUIRE(waitFor([&] { return w.document().volume()->title == "onboard.raw"; }));
    w.settle();
    // The board lies at low y: the eye does not.
    const Camera opened = w.document().camera();
    CHECK(opened.forward().y < 0.1);
    REQUIRE(noticeText(w).contains("board"));
    const Clipping faint = *w.services().store().session().clipping;
    CHECK(faint.isNone());
    CHECK(faint.rest.within.lo.y >= 3.0 / 40);
    CHECK(faint.rest.within.lo.y <= 5.0 / 40);
    CHECK(faint.rest.density > 0);
    CHECK(faint.rest.density < 0.5);
    CHECK(w.services().store().isClean()); // nobody's work
    auto& density = w.child<QDoubleSpinBox>("holderDensity");
    CHECK(density.value() == Approx(100 * faint.rest.density).margin(0.05));

    QTest::mouseClick(&w.child<QPushButton>("noticeChoice0"), Qt::LeftButton);
    w.settle();
    CHECK(w.services().store().undoText() == "Leave out the holder");
    const Clipping cut = *w.services().store().session().clipping;
    CHECK(cut.rest.density == 0);
    CHECK(cut.rest.within == faint.rest.within);
    REQUIRE(noticeText(w).contains("left out"));
    CHECK(density.value() == 0);
    QTest::mouseClick(&w.child<QPushButton>("noticeChoice0"), Qt::LeftButton);
    w.settle();
    CHECK(w.services().store().session().clipping->rest.isNone());
    CHECK(noticeText(w).contains("like the rest"));
    CHECK_FALSE(noticeText(w).contains("left out"));
    CHECK(density.isVisibleTo(density.parentWidget())); // there is a way back
    CHECK(density.value() == 100);
    w.child<QAction>("undoAction").trigger();
    CHECK(*w.services().store().session().clipping == cut);
    CHECK(noticeText(w).contains("left out")); // what the note says is so
    w.child<QAction>("undoAction").trigger();
    CHECK(*w.services().store().session().clipping == faint);
    CHECK(noticeText(w).contains("drawn faintly"));
    CHECK_FALSE(noticeText(w).contains("left out"));

    // All of it, by number; and faint once more by the note, as it was.
    density.setValue(100);
    CHECK(w.services().store().session().clipping->rest.isNone());
    CHECK(noticeText(w).contains("like the rest"));
    QTest::mouseClick(&w.child<QPushButton>("noticeChoice0"), Qt::LeftButton);
    w.settle();
    CHECK(*w.services().store().session().clipping == faint);
    density.setValue(0);
    CHECK(w.services().store().session().clipping->rest.within == faint.rest.within);
    CHECK(noticeText(w).contains("left out"));

    // By number; clipping comes and goes beside it.
    density.setValue(20);
    CHECK(w.services().store().session().clipping->rest.density == Approx(0.2));
    w.child<QDoubleSpinBox>("clipXHi").setValue(60);
    w.child<QAction>("resetClipAction").trigger();
    CHECK(w.services().store().session().clipping->rest.density == Approx(0.2));
    CHECK(w.services().store().session().clipping->isNone());
}

TEST_CASE("Home goes back to the view that a volume opened with", "[first sight]") {
    const TempFolder folder;
    OpenWindow w;
    w.opening().openVolume(boxesWithOutlier(folder));
    REQUIRE(waitFor([&] { return w.document().volume()->title == "boxes.raw"; }));
    w.settle();
    const Camera opened = w.document().camera();
    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 100, -50, 2, Projection::Perspective));
    w.child<QAction>("resetViewAction").trigger();
    CHECK(w.document().camera() == opened); // whatever opacities have come meanwhile
}

TEST_CASE("who edits at once keeps what he has done", "[first sight]") {
    const TempFolder folder;
    OpenWindow w;
    TransferFunction mine = tents(2, 0.3);
    QObject::connect(&w.opening(), &OpenController::opened, &w.window,
                     [&] { editTf(w.services().store(), mine, "Mine"); });
    w.opening().openVolume(boxesWithOutlier(folder));
    REQUIRE(waitFor([&] { return w.document().volume()->title == "boxes.raw"; }));
    w.settle();
    CHECK(w.document().tf().points == mine.points);
    CHECK(w.document().stepCount() == 1);
    CHECK(w.services().store().undoText() == "Mine");
    const QImage picture = w.picture();
    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf().points != mine.points);
    CHECK(w.picture() != picture);
}

TEST_CASE("the automatic start again is for the present view, and one step", "[first sight]") {
    OpenWindow w;
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 100, -50, 1, Projection::Perspective));
    const QImage turned = w.picture();
    const AutomaticStart expected = automaticStart(w.services().scene(), View(w.document().camera()));
    w.child<QAction>("automaticStartAction").trigger();
    REQUIRE(waitFor([&] { return w.services().store().undoText() == "Automatic start"; }));
    w.settle();
    CHECK(w.document().stepCount() == 1);
    CHECK(w.document().tf().points == expected.sight.tf.points);
    CHECK(w.document().tf().features == expected.sight.tf.features);
    const QImage automatic = w.picture();
    CHECK(automatic != turned);
    CHECK(litShare(automatic) > 0.2);
    w.child<QAction>("undoAction").trigger();
    CHECK(w.document().tf() == before);
    CHECK(w.picture() == turned);
}

TEST_CASE("the card of the first start goes for good", "[first sight]") {
    QSettings().remove("welcomeCardSeen");
    QSettings().remove("recentFiles"); // which it offers, too
    OpenWindow w;
    const TransferFunction tf = w.document().tf();
    const QSize whole = w.view().size();
    w.window.welcome();
    auto& card = w.child<WelcomeCard>("welcomeCard");
    REQUIRE(waitFor([&] { return w.view().width() < whole.width(); }));
    w.settle();
    CHECK(card.isVisible());
    CHECK(w.child<QLabel>("welcomeTitle").text().contains("sample"));
    // It lies beside the picture, of which it hides nothing, and a drag on it turns nothing.
    const auto inWindow = [&](QWidget& widget) { return QRect(widget.mapTo(&w.window, QPoint(0, 0)), widget.size()); };
    CHECK_FALSE(inWindow(card).intersects(inWindow(w.view())));
    CHECK(w.window.rect().contains(inWindow(card)));
    CHECK(w.view().width() > card.width());
    for (const QLabel* label : card.findChildren<QLabel*>())
        CHECK(label->height() >= label->heightForWidth(label->width()));
    const Camera camera = w.document().camera();
    drag(card, {10, 10}, {60, 30});
    CHECK(w.document().camera() == camera);

    QTest::mouseClick(&w.child<QPushButton>("welcomeClose"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return w.window.findChild<WelcomeCard*>() == nullptr; }));
    REQUIRE(waitFor([&] { return w.view().size() == whole; }));
    CHECK(QSettings().value("welcomeCardSeen").toBool());
    w.window.welcome();
    CHECK(w.window.findChild<WelcomeCard*>() == nullptr);
    CHECK(w.document().tf() == tf);

    // Another volume is the first thing to try.
    QSettings().remove("welcomeCardSeen");
    w.window.welcome();
    REQUIRE(w.window.findChild<WelcomeCard*>() != nullptr);
    const TempFolder folder;
    w.opening().openVolume(boxesWithOutlier(folder));
    REQUIRE(waitFor([&] { return w.window.findChild<WelcomeCard*>() == nullptr; }));
    CHECK(QSettings().value("welcomeCardSeen").toBool());
}

TEST_CASE("a skull is seen, lit, through the skin as soon as the file is open", "[first sight][files]") {
    const std::string path = std::string(PELLUCID_SHARED_DIR) + "/data/real/cranium_ct/cranium_ct.nrrd";
    if (!std::filesystem::exists(path)) {
        WARN("SKIPPED: " << path << " is not there");
        return;
    }
    OpenWindow w;
    w.opening().openPath(QString::fromStdString(path)); // as dropping it does: the one action
    REQUIRE(waitFor([&] { return w.document().volume()->title == "cranium_ct.nrrd"; }));
    w.settle();
    CHECK(noticeText(w).contains("Hounsfield"));
    CHECK(w.services().store().session().display->light.on);
    double bone = 0, skin = 0;
    REQUIRE(w.document().measures() != nullptr);
    const auto& features = w.document().tf().features;
    for (std::size_t f = 0; f < features.size(); ++f)
        (features[f].name.find("bone") != std::string::npos ? bone : skin) +=
            w.document().measures()->features[f].visibility;
    CHECK(bone > 0.25);
    CHECK(skin > 0.1);
    const TransferFunction& tf = w.document().tf();
    CHECK(tf.opacity(w.document().volume()->intensityOfValue(-1000)) == 0); // air
    const QImage picture = w.picture();
    CHECK(litShare(picture) > 0.5);
}
