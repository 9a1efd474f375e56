// Targets by hand: bars that are dragged, typed and locked, presets, settings, targets held live.
#include "gui_support.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QTableView>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>
#include <QToolTip>

#include "controllers/live_controller.h"
#include "optimize/answer/visibility_words.h"
#include "panels/features_model.h"
#include "render/camera_motion.h"
#include "services/selection.h"
#include "session/target_presets.h"
#include "tf/edit.h"
#include "view/volume_view.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

QImage image(QWidget& widget) { return widget.grab().toImage().convertToFormat(QImage::Format_RGB32); }

TargetBars& barsOf(OpenWindow& w) { return w.child<TargetBars>("targetBars"); }
QLineEdit& boxOf(OpenWindow& w) { return w.child<QLineEdit>("targetBox"); }

void checkTargets(OpenWindow& w, const std::vector<double>& wanted) {
    const std::vector<double> targets = w.document().targets();
    REQUIRE(targets.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(targets[i] == Approx(wanted[i]).margin(1e-9));
}

void click(QWidget& widget, const QPointF& at) { QTest::mouseClick(&widget, Qt::LeftButton, {}, at.toPoint()); }

void type(OpenWindow& w, int feature, const QString& text) {
    QTest::mouseDClick(&barsOf(w), Qt::LeftButton, {}, barsOf(w).targetRect(feature).center().toPoint());
    REQUIRE(boxOf(w).isVisible());
    QTest::keyClicks(&boxOf(w), text);
    QTest::keyClick(&boxOf(w), Qt::Key_Return);
}

double farthest(OpenWindow& w) {
    const std::vector<double> targets = w.document().targets();
    double most = 0;
    for (std::size_t i = 0; i < targets.size(); ++i)
        most = std::max(most, std::abs(w.document().measures()->features[i].vws - targets[i]));
    return most;
}

Camera turned(OpenWindow& w, double degrees) {
    return rotated(w.document().camera(), w.document().volume()->geometry(), degrees, degrees / 4);
}

} // namespace

TEST_CASE("shares are read as people type them", "[targets]") {
    CHECK(shareFromText("0.3") == 0.3);
    CHECK(shareFromText(" 0,25 ") == 0.25);
    CHECK(shareFromText("30 %") == 0.3);
    CHECK(shareFromText("100%") == 1.0);
    for (const char* wrong : {"", "x", "1.5", "-0.1", "130 %", "30", "nan"}) CHECK_FALSE(shareFromText(wrong));
}

TEST_CASE("the bars are saved as charts, with their targets", "[targets]") {
    OpenWindow w;
    w.document().setTargets({0.1, 0.3, 0.6});
    w.settle();
    const QTemporaryDir folder;
    REQUIRE(w.saving().saveBars(folder.filePath("bars.svg")));
    QFile file(folder.filePath("bars.svg"));
    REQUIRE(file.open(QIODevice::ReadOnly));
    const QByteArray svg = file.readAll();
    for (const FeatureMeasures& m : w.document().measures()->features)
        for (const double share : {m.visibility, m.vws, m.vwsBrightness, m.vwsSaturation})
            CHECK(svg.contains(">" + QByteArray::number(share, 'f', 4) + "</text>"));
    CHECK(svg.count("stroke-dasharray") == 3); // a target each
    CHECK_FALSE(svg.contains("2D feature saliency"));
    REQUIRE(w.saving().saveBars(folder.filePath("bars.png")));
    CHECK(QImage(folder.filePath("bars.png")).width() == 2 * 760);

    // The button of the panel and the menu are one.
    auto& button = w.child<QToolButton>("saveBarsButton");
    CHECK(button.isEnabled());
    CHECK(button.defaultAction() == &w.child<QAction>("saveBarsAction"));
}

TEST_CASE("the caption on the clipboard has the shares that the bars show, and a screen reader hears them",
          "[targets]") {
    OpenWindow w;
    w.settle();
    w.child<QAction>("copyCaptionAction").trigger();
    const QString words = QApplication::clipboard()->text();
    const std::vector<FeatureMeasures>& measured = w.document().measures()->features;
    for (const FeatureMeasures& m : measured) {
        CAPTURE(words.toStdString(), m.vws);
        CHECK(words.contains(QString::fromStdString(percentText(m.vws))));
        CHECK(words.contains(QString::fromStdString(percentText(m.visibility))));
    }
    const QString heard = w.child<VolumeView>("volumeView").accessibleDescription();
    const auto most = std::ranges::max(measured, {}, &FeatureMeasures::vws);
    CHECK(heard.contains(QString::fromStdString(percentText(most.vws) + " of the saliency")));
}

TEST_CASE("a target is dragged, typed and locked, each is one step", "[targets]") {
    OpenWindow w;
    TargetBars& bars = barsOf(w);
    const QImage start = image(bars);
    const int steps = w.document().stepCount();
    // Pixels of a bar are coarser than shares.
    drag(bars, bars.handlePosition(0), {bars.pixelOfShare(0.6), bars.handlePosition(0).y()});
    CHECK(w.document().targets()[0] == Approx(0.6).margin(0.02));
    CHECK(w.document().targets()[1] == Approx(w.document().targets()[2]));
    CHECK(w.document().stepCount() == steps + 1);
    w.settle();
    const QImage dragged = image(bars);
    CHECK(dragged != start);

    type(w, 1, "50 %"); // the others divide the rest in their proportion
    const double first = w.document().targets()[0];
    CHECK(w.document().targets()[1] == Approx(0.5));
    const std::vector<double> shares = w.document().targets();
    CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(1));
    CHECK(w.document().stepCount() == steps + 2);
    CHECK_FALSE(boxOf(w).isVisible());
    w.settle();
    CHECK(image(bars) != dragged);

    // What is no share is not taken; Escape leaves everything as it was.
    type(w, 1, "7");
    CHECK(boxOf(w).isVisible());
    CHECK(w.document().targets()[1] == Approx(0.5));
    QTest::keyClick(&boxOf(w), Qt::Key_Escape);
    CHECK_FALSE(boxOf(w).isVisible());
    CHECK(w.document().stepCount() == steps + 2);

    const QImage open = image(bars);
    click(bars, bars.lockRect(1).center());
    w.settle();
    CHECK(image(bars) != open);
    drag(bars, bars.handlePosition(0), {bars.pixelOfShare(0.1), bars.handlePosition(0).y()});
    CHECK(w.document().targets()[0] == Approx(0.1).margin(0.02));
    CHECK(w.document().targets()[1] == Approx(0.5));
    CHECK(w.document().targets()[2] == Approx(1 - 0.5 - w.document().targets()[0]));
    // No farther than the locked one leaves room for.
    drag(bars, bars.handlePosition(0), {bars.pixelOfShare(1), bars.handlePosition(0).y()});
    checkTargets(w, {0.5, 0.5, 0});
    CHECK(w.document().stepCount() == steps + 5);
    for (int i = 0; i < 3; ++i) w.document().undo();
    CHECK(w.document().targets()[0] == Approx(first));
    w.services().selection().setFeature(w.document().tf().features[1].id); // as it was then
    w.settle();
    CHECK(image(bars) == open);
}

TEST_CASE("targets by keys: a digit opens the box, L locks and leaves the light alone", "[targets]") {
    OpenWindow w;
    TargetBars& bars = barsOf(w);
    bars.setFocus();
    const bool lit = w.services().scene().session.display->light.on;
    QTest::keyClick(&bars, Qt::Key_Down); // the second
    QTest::keyClicks(&bars, "0");
    REQUIRE(boxOf(w).isVisible());
    CHECK(boxOf(w).text() == "0");
    QTest::keyClicks(&boxOf(w), ".4");
    QTest::keyClick(&boxOf(w), Qt::Key_Return);
    checkTargets(w, {0.3, 0.4, 0.3});
    const QImage before = image(bars);
    QTest::keyClick(&bars, Qt::Key_L);
    CHECK(w.services().store().session().goals->at(w.document().tf().features[1].id).targetLocked);
    CHECK(w.services().scene().session.display->light.on == lit);
    CHECK(image(bars) != before);
    QTest::keyClick(&bars, Qt::Key_Return);
    CHECK(boxOf(w).isVisible());
    QTest::keyClick(&boxOf(w), Qt::Key_Escape);
    CHECK_FALSE(boxOf(w).isVisible());
}

TEST_CASE("screen readers hear the target that keys change", "[targets][spoken]") {
    OpenWindow w;
    TargetBars& bars = barsOf(w);
    w.settle();
    bars.setFocus();
    QTest::keyClick(&bars, Qt::Key_Down); // the second of three
    const auto wanted = [&](const QString& targetText) {
        w.settle();
        const FeatureMeasures& m = w.document().measures()->features[1];
        return QStringLiteral("%1: %2 of the attention now, %3 of what is seen, target %4; feature 2 of 3")
            .arg(QString::fromStdString(w.document().tf().features[1].name), QString::number(m.vws, 'f', 3),
                 QString::number(m.visibility, 'f', 3), targetText);
    };
    CHECK(heardValue(bars).toStdString() == wanted("0.333").toStdString()); // a third each
    QTest::keyClick(&bars, Qt::Key_Right);                                  // 1/3 + 0.01
    CHECK(heardValue(bars).toStdString() == wanted("0.343").toStdString());

    // On Linux values are numbers, and words come as the description.
    QAccessibleInterface* const spoken = QAccessible::queryAccessibleInterface(&bars);
    CHECK(spoken->role() == QAccessible::Slider);
    CHECK(spoken->text(QAccessible::Name) == "Attention on the features and their targets");
    CHECK(spoken->text(QAccessible::Description).startsWith(heardValue(bars)));
    QAccessibleValueInterface* const number = spoken->valueInterface();
    REQUIRE(number != nullptr);
    CHECK(number->currentValue().toDouble() == Approx(1.0 / 3 + 0.01));
    CHECK(number->minimumValue().toDouble() == 0);
    CHECK(number->maximumValue().toDouble() == 1);
    CHECK(number->minimumStepSize().toDouble() == 0.01); // of Left and Right
    number->setCurrentValue(0.5);
    checkTargets(w, {0.25, 0.5, 0.25});

    QTest::keyClick(&bars, Qt::Key_L);
    CHECK(heardValue(bars).toStdString() == wanted("0.500, locked").toStdString());
    QTest::keyClick(&bars, Qt::Key_Down);
    CHECK(heardValue(bars).endsWith("target 0.250; feature 3 of 3"));
}

TEST_CASE("presets set all targets, locked ones stay", "[targets]") {
    OpenWindow w;
    TargetBars& bars = barsOf(w);
    const auto preset = [&](const char* action) { w.child<QAction>(action).trigger(); };
    w.services().selection().setFeature(w.document().tf().features[1].id);
    // Peaks at 1/6, 3/6, 5/6.
    preset("targetsDiagonal");
    checkTargets(w, {1 / 9.0, 3 / 9.0, 5 / 9.0});
    const QImage diagonal = image(bars);
    preset("targetsInsideOut");
    checkTargets(w, {5 / 9.0, 3 / 9.0, 1 / 9.0});
    CHECK(image(bars) != diagonal);
    preset("targetsOnlyThis");
    checkTargets(w, {0, 1, 0});
    preset("targetsEqual");
    checkTargets(w, {1 / 3.0, 1 / 3.0, 1 / 3.0});
    w.settle();
    preset("targetsAsNow");
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(w.document().targets()[i] == Approx(w.document().measures()->features[i].vws).margin(1e-9));
    const double second = w.document().targets()[1];
    preset("targetLock");
    preset("targetsEqual");
    checkTargets(w, {(1 - second) / 2, second, (1 - second) / 2});
    preset("targetsUnlock");
    preset("targetsEqual");
    checkTargets(w, {1 / 3.0, 1 / 3.0, 1 / 3.0});
}

TEST_CASE("the parts of VWS by brightness and saturation are seen in the bars", "[targets]") {
    OpenWindow w;
    w.settle();
    const QImage both = image(barsOf(w));
    w.services().store().edit("u", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.vws = {1, 0}; }); // brightness alone
    });
    w.settle();
    CHECK(image(barsOf(w)) != both);
    // All of the bar is plain: its colour at both ends, where the bar is long enough to tell.
    TargetBars& bars = barsOf(w);
    const auto& features = w.document().measures()->features;
    for (int i = 0; i < 3; ++i) {
        const FeatureMeasures& m = features[static_cast<std::size_t>(i)];
        CHECK(m.vws == Approx(m.vwsBrightness));
        const QRectF bar = bars.vwsRect(i);
        if (m.vws * bar.width() < 20) continue;
        const QImage now = image(bars);
        const int y = static_cast<int>(bar.center().y());
        const int left = static_cast<int>(bar.left()) + 3;
        const double handle = bars.handlePosition(i).x();
        for (int x = left; x < bar.left() + m.vws * bar.width() - 3; ++x)
            if (std::abs(x - handle) > 5) CHECK(now.pixel(x, y) == now.pixel(left, y));
    }
}

TEST_CASE("thirty-two features have their bars and can be typed into", "[targets]") {
    OpenWindow w;
    w.document().setTf(tents(32), "Tents");
    w.settle();
    TargetBars& bars = barsOf(w);
    REQUIRE(w.document().targets().size() == 32);
    CHECK(bars.height() >= bars.rowRect(31).bottom()); // a row each, scrolled
    // Some of so many have no voxel here, and so no target.
    const Scene& scene = w.services().scene();
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < 32; ++i)
        if (!scene.isEmpty(i)) wanted.push_back(i);
    REQUIRE(wanted.size() > 16);
    const int last = static_cast<int>(wanted.back());
    w.child<QScrollArea>("barsScroll").ensureVisible(10, static_cast<int>(bars.rowRect(last).center().y()));
    const QImage before = image(bars);
    type(w, last, "0.38");
    std::vector<double> expected(32, 0.0);
    for (const std::size_t i : wanted) expected[i] = 0.62 / static_cast<double>(wanted.size() - 1);
    expected[wanted.back()] = 0.38;
    checkTargets(w, expected);
    CHECK(image(bars) != before);
}

TEST_CASE("a feature without a voxel is listed as empty, and cannot be aimed at", "[targets]") {
    OpenWindow w;
    // Of four tents over the values of the shells the second gets an interval that lies between two of their values.
    TransferFunction tf = tents(4);
    const Histogram& seen = w.document().histogram();
    double a = 0, b = 0; // the widest gap
    for (std::size_t i = 1; i < seen.codes.size(); ++i)
        if (const double from = static_cast<double>(seen.codes[i - 1]) / seen.maxCode,
            to = static_cast<double>(seen.codes[i]) / seen.maxCode;
            to - from > b - a)
            a = from, b = to;
    REQUIRE(b - a > 1e-5);
    tf.features = {{"below", 0, a, {1, 0, 0}, {}},
                   {"between", a + (b - a) / 4, b - (b - a) / 4, {0, 1, 0}, {}},
                   {"above", b, 1, {0, 0, 1}, {}}};
    w.document().setTf(tf, "Features");
    w.settle();
    const Scene& scene = w.services().scene();
    REQUIRE(scene.isEmpty(1));
    REQUIRE_FALSE(scene.isEmpty(0));
    REQUIRE_FALSE(scene.isEmpty(2));
    checkTargets(w, {0.5, 0, 0.5});
    auto& model = *w.child<QTableView>("featuresTable").model();
    const auto text = [&](int row, int column) { return model.data(model.index(row, column)).toString(); };
    CHECK(text(0, FeaturesModel::Name) == "below");
    CHECK(text(1, FeaturesModel::Name) == "between (empty)");
    CHECK(model.data(model.index(1, FeaturesModel::Name), Qt::EditRole).toString() == "between");
    CHECK(text(1, FeaturesModel::Target) == QStringLiteral("–"));
    CHECK(model.data(model.index(1, FeaturesModel::Target), Qt::ToolTipRole).toString().contains("no voxel"));
    CHECK_FALSE(model.flags(model.index(1, FeaturesModel::Target)).testFlag(Qt::ItemIsEditable));
    // A number typed for it is answered, and changes nothing.
    const int steps = w.document().stepCount();
    TargetBars& bars = barsOf(w);
    QTest::mouseDClick(&bars, Qt::LeftButton, {}, bars.targetRect(1).center().toPoint());
    CHECK_FALSE(boxOf(w).isVisible());
    CHECK(QToolTip::text().contains("between is empty"));
    CHECK(w.document().stepCount() == steps);
    // Presets pass over it.
    w.child<QAction>("targetsDiagonal").trigger();
    CHECK(w.document().targets()[1] == 0);
    w.child<QAction>("targetsEqual").trigger();
    checkTargets(w, {0.5, 0, 0.5});
    // With voxels it has a target again.
    tf.features = {
        {"below", 0, a / 2, {1, 0, 0}, {}}, {"between", a / 2, b, {0, 1, 0}, {}}, {"above", b, 1, {0, 0, 1}, {}}};
    w.document().setTf(tf, "Wider");
    CHECK(w.document().targets()[1] > 0);
    CHECK(text(1, FeaturesModel::Name) == "between");
}

TEST_CASE("an opacity that is locked or limited is so in an optimization, and is seen in the table", "[targets]") {
    OpenWindow w;
    auto& table = w.child<QTableView>("featuresTable");
    w.document().setTargets({0.2, 0.2, 0.6});
    w.services().selection().setFeature(w.document().tf().features[1].id);
    w.settle();
    const QImage plain = image(table);
    const std::vector<double> before = featureOpacities(w.document().tf());
    w.child<QAction>("opacityLock").trigger();
    CHECK(image(table) != plain);
    QTimer::singleShot(0, [&] {
        auto* dialog = w.window.findChild<QDialog*>("limitsDialog");
        REQUIRE(dialog != nullptr);
        dialog->findChild<QDoubleSpinBox*>("lowestOpacity")->setValue(0.3);
        dialog->findChild<QDoubleSpinBox*>("highestOpacity")->setValue(0.35);
        dialog->accept();
    });
    w.services().selection().setFeature(w.document().tf().features[2].id);
    w.child<QAction>("opacityLimits").trigger();
    const QImage picture = w.picture();
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    const std::vector<double> after = featureOpacities(w.document().tf());
    CHECK(after[1] == Approx(before[1]));
    CHECK(after[2] >= 0.3 - 1e-9);
    CHECK(after[2] <= 0.35 + 1e-9);
    CHECK(w.picture() != picture);
}

TEST_CASE("settings of figures and searches are edits of the session", "[targets][settings]") {
    OpenWindow w;
    const MeasureSettings measure = *w.services().store().session().measure;
    const OptimizeOptions optimize = *w.services().store().session().optimize;
    const auto set = [&](const char* id, double value) { w.child<QDoubleSpinBox>(id).setValue(value); };
    QTest::mouseClick(&w.child<QToolButton>("settingsButton"), Qt::LeftButton);
    CHECK(w.child<QDockWidget>("settingsDock").isVisible());
    auto& method = w.child<QComboBox>("methodCombo");
    const auto choose = [&](QComboBox& combo, int data) {
        combo.setCurrentIndex(combo.findData(data));
        Q_EMIT combo.activated(combo.currentIndex());
    };
    // Newton has steps of its own.
    choose(method, static_cast<int>(SearchMethod::Newton));
    CHECK_FALSE(w.child<QDoubleSpinBox>("stepSpin").isEnabled());
    choose(method, static_cast<int>(SearchMethod::Line));
    CHECK(w.child<QDoubleSpinBox>("stepSpin").isEnabled());
    set("stepSpin", 0.2);
    set("bSpin", 3);
    set("toleranceSpin", 0.01);
    choose(w.child<QComboBox>("directionCombo"), static_cast<int>(Direction::Second));
    w.child<QCheckBox>("normalizeCheck").click();
    w.child<QSpinBox>("mostMovesSpin").setValue(7);
    const OptimizeOptions now = *w.services().store().session().optimize;
    CHECK(now.method == SearchMethod::Line);
    CHECK(now.direction == Direction::Second);
    CHECK(now.step == 0.2);
    CHECK(now.b == 3);
    CHECK(now.tolerance == 0.01);
    CHECK(now.maxIterations == 7);
    CHECK(now.normalize != optimize.normalize);

    w.settle();
    const QImage before = image(barsOf(w));
    const double vws = w.document().measures()->features[0].vws;
    set("u1Spin", 0.9);
    CHECK(w.child<QDoubleSpinBox>("u2Spin").value() == Approx(0.1));
    set("sigmaSpin", 3);
    choose(w.child<QComboBox>("kernelCombo"), static_cast<int>(SaliencyKernel::Narrow));
    set("w2Spin", 0.5);
    w.settle();
    const MeasureSettings measured = *w.services().store().session().measure;
    CHECK(measured.vws.u1 == 0.9);
    CHECK(measured.vws.u2 == Approx(0.1));
    CHECK(measured.saliency.sigma == 3);
    CHECK(measured.saliency.kernel == SaliencyKernel::Narrow);
    CHECK(measured.saliency.w2 == 0.5);
    CHECK(w.document().measures()->features[0].vws != vws);
    CHECK(image(barsOf(w)) != before);
    // Edits of one kind in a row are one step.
    w.document().undo();
    CHECK(*w.services().store().session().measure == measure);
    w.document().undo();
    CHECK(*w.services().store().session().optimize == optimize);
    CHECK(w.child<QDoubleSpinBox>("u1Spin").value() == Approx(measure.vws.u1));
    w.settle();
    CHECK(image(barsOf(w)) == before);
}

TEST_CASE("live targets are held while the view turns, and undo brings back what was before", "[targets][live]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click();
    w.document().setTargets({0.2, 0.3, 0.5});
    w.settle();
    const std::vector<double> before = featureOpacities(w.document().tf());
    const QImage picture = w.picture();
    int updates = 0;
    QObject::connect(&w.controllers().live, &LiveController::updated, &w.window, [&] { ++updates; });
    const int steps = w.document().stepCount();
    QTest::mouseClick(&w.child<QToolButton>("liveTargetsButton"), Qt::LeftButton);
    CHECK(w.services().store().session().holdTargets);
    w.settle();
    CHECK(farthest(w) < 0.01);
    CHECK(w.picture() != picture);
    for (int turn = 0; turn < 3; ++turn) {
        const QImage shown = w.picture();
        const int done = updates;
        for (int i = 0; i < 8; ++i) { // while the mouse is down
            w.document().setCamera(turned(w, 5));
            QTest::qWait(10);
        }
        w.settle();
        CHECK(updates > done);
        CHECK(w.document().measuresAreCurrent());
        CHECK(farthest(w) < 0.01);
        CHECK(w.picture() != shown);
    }
    // Nothing that the view does is a step, nor what follows of it.
    CHECK(w.document().stepCount() == steps + 1);
    w.document().undo();
    CHECK_FALSE(w.services().store().session().holdTargets);
    CHECK(featureOpacities(w.document().tf()) == before);
    w.document().redo();
    w.settle();
    CHECK(farthest(w) < 0.01);
}

TEST_CASE("live targets follow targets, colours and opacities that are set", "[targets][live]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click();
    w.child<QAction>("liveTargetsAction").trigger();
    w.settle();
    TargetBars& bars = barsOf(w);
    QImage shown = w.picture();
    const int steps = w.document().stepCount();
    drag(bars, bars.handlePosition(2), {bars.pixelOfShare(0.55), bars.handlePosition(2).y()});
    w.settle();
    CHECK(farthest(w) < 0.01);
    CHECK(w.document().targets()[2] == Approx(0.55).margin(0.02));
    CHECK(w.document().stepCount() == steps + 1); // with what followed of it
    CHECK(w.picture() != shown);
    shown = w.picture();
    w.document().setTf(withFeatureColor(w.document().tf(), 0, {0.9, 0.9, 0.9}), "Colour");
    w.settle();
    CHECK(farthest(w) < 0.01);
    CHECK(w.picture() != shown);
    // An opacity that is set stays; the others follow.
    const double half = featureOpacities(w.document().tf())[1] / 2;
    w.document().setTf(withFeatureOpacity(w.document().tf(), 1, half), "Opacity");
    w.settle();
    CHECK(featureOpacities(w.document().tf())[1] == Approx(half));
    CHECK(farthest(w) < 0.01);
    w.document().undo();
    w.settle();
    CHECK(farthest(w) < 0.01);
    // Live refinement and live targets exclude each other.
    w.child<QAction>("liveRefineAction").trigger();
    CHECK_FALSE(w.services().store().session().holdTargets);
    w.child<QAction>("liveTargetsAction").trigger();
    CHECK_FALSE(w.services().store().session().refine->live);
    w.settle();
}

TEST_CASE("a view that turns during an optimization restarts it from there", "[targets][live]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click();
    w.document().setTargets({0.2, 0.2, 0.6});
    bool turned = false;
    const Camera other = cameraFromView(w.document().volume()->geometry(), -70, 30, 1, Projection::Perspective);
    QObject::connect(&w.optimizing(), &OptimizeController::moved, &w.window, [&] {
        if (w.optimizing().move() < 0 || turned) return;
        turned = true;
        w.document().setCamera(other);
    });
    const QImage picture = w.picture();
    const int steps = w.document().stepCount();
    w.optimizing().start();
    REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
    REQUIRE(turned);
    CHECK(w.optimizing().restarts() == 1);
    CHECK(w.optimizing().message().contains("restarted from the new view"));
    CHECK(w.document().stepCount() == steps + 1);
    w.settle();
    // What is said is true of the view that is shown.
    CHECK(w.document().camera() == other);
    CHECK(farthest(w) < 0.06);
    CHECK(w.picture() != picture);
    w.document().undo();
    CHECK(w.document().camera() == other);
}
