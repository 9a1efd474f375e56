// Features as objects, their eyes, colour maps and density, by the hands.
#include "gui_support.h"

#include <algorithm>
#include <cmath>

#include <QAction>
#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QSlider>
#include <QTableView>
#include <QTimer>
#include <QToolButton>

#include "base/round_numbers.h"
#include "optimize/answer/visibility_words.h"
#include "panels/density_slider.h"
#include "tf/color_maps.h"
#include "tf/part_names.h"
#include "tf/shapes.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Opens the menu of a button and clicks on the entry of that action.
void clickInMenu(QToolButton& button, const QString& action) {
    bool clicked = false;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
        auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
        if (menu == nullptr) return;
        timer.stop();
        for (QAction* entry : menu->actions())
            if (entry->objectName() == action) {
                clicked = true;
                const QPoint at = menu->actionGeometry(entry).center();
                QWidget* const inside = menu->childAt(at); // an entry may be a widget of its own
                QTest::mouseClick(inside ? inside : menu, Qt::LeftButton, {}, inside ? inside->mapFrom(menu, at) : at);
                return;
            }
        menu->close();
    });
    timer.start(20);
    QTest::mouseClick(&button, Qt::LeftButton); // returns when the menu has closed
    REQUIRE(clicked);
}

void clickCell(OpenWindow& w, int row, FeaturesModel::Column column, Qt::KeyboardModifiers modifiers = {}) {
    auto& table = w.child<QTableView>("featuresTable");
    const QRect cell = table.visualRect(table.model()->index(row, column));
    REQUIRE_FALSE(cell.isEmpty());
    const QPoint place(column == FeaturesModel::Name ? cell.left() + 40 : cell.center().x(), cell.center().y());
    QTest::mouseClick(table.viewport(), Qt::LeftButton, modifiers, place);
}

std::vector<double> opacities(const TransferFunction& tf) {
    std::vector<double> all;
    for (int i = 0; i <= 400; ++i) all.push_back(tf.opacity(i / 400.0 * 0.9999));
    return all;
}

double mostApart(const std::vector<double>& p, const std::vector<double>& q) {
    double most = 0;
    for (std::size_t i = 0; i < p.size(); ++i) most = std::max(most, std::abs(p[i] - q[i]));
    return most;
}

} // namespace

TEST_CASE("a trapezoid is added between the features, drawn, measured and undone", "[shapes]") {
    OpenWindow w;
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    clickInMenu(w.child<QToolButton>("addShapeButton"), "addTrapezoid");
    const QImage with = w.picture();
    const TransferFunction& tf = w.document().tf();
    REQUIRE(tf.features.size() == 4);
    const int index = featureWithId(tf, w.services().selection().feature()); // it is selected
    REQUIRE(index >= 0);
    const Feature& added = tf.features[static_cast<std::size_t>(index)];
    CHECK(added.name == "trapezoid");
    CHECK(tf.opacity((added.a + added.b) / 2) == 0.5); // as high as the tents
    CHECK_NOTHROW(tf.validate());
    CHECK(with != picture);
    REQUIRE(w.document().measuresAreCurrent());
    CHECK(w.document().measures()->features.size() == 4);
    w.document().undo();
    CHECK(w.picture() == picture);
    CHECK(w.document().tf() == before);
}

TEST_CASE("a feature is split where its histogram says, merged again and removed", "[shapes]") {
    OpenWindow w;
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    CHECK_FALSE(w.child<QToolButton>("featureSplitButton").isEnabled()); // nothing is selected
    clickCell(w, 1, FeaturesModel::Name);
    CHECK(w.services().selection().feature() == before.features[1].id);
    CHECK(w.child<TargetBars>("targetBars").currentFeature() == 1);
    QTest::mouseClick(&w.child<QToolButton>("featureSplitButton"), Qt::LeftButton);
    const QImage split = w.picture();
    {
        const TransferFunction& tf = w.document().tf();
        REQUIRE(tf.features.size() == 4);
        CHECK(tf.features[1].id == before.features[1].id);
        CHECK(tf.features[1].b == splitPlace(before.features[1], w.document().histogram().counts));
        CHECK(tf.features[2].a == tf.features[1].b);
        const auto [lower, upper] = namesOfParts(
            before.features[1].name, numberText(w.document().volume()->valueOfIntensity(tf.features[1].b),
                                                w.document().volume()->range().hi - w.document().volume()->range().lo));
        CHECK(tf.features[1].name == lower);
        CHECK(tf.features[2].name == upper);
        // Each half has voxels to be seen.
        for (int f : {1, 2}) CHECK(w.document().measures()->features[static_cast<std::size_t>(f)].visibility > 0);
        CHECK(mostApart(opacities(tf), opacities(before)) < 1e-12);
        CHECK(w.document().measures()->features.size() == 4);
    }
    CHECK(split != picture); // the upper part has a colour of its own

    QTest::mouseClick(&w.child<QToolButton>("featureMergeButton"), Qt::LeftButton);
    w.settle();
    REQUIRE(w.document().tf().features.size() == 3);
    CHECK(w.document().tf().features[1].a == before.features[1].a);
    CHECK(w.document().tf().features[1].b == before.features[1].b);
    CHECK(w.picture() == split); // points and their colours stay
    QTest::mouseClick(&w.child<QToolButton>("featureRemoveButton"), Qt::LeftButton);
    const QImage removed = w.picture();
    REQUIRE(w.document().tf().features.size() == 2);
    CHECK(w.document().tf().opacity(0.5) == 0);
    CHECK(removed != split);
    for (int i = 0; i < 3; ++i) w.document().undo();
    CHECK(w.picture() == picture);
    CHECK(w.document().tf() == before);
}

TEST_CASE("a closed eye takes the feature out of picture and figures, an open one brings it back", "[shapes]") {
    OpenWindow w;
    w.document().setTf(tents(3, 0.1), "thin");
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    const double visible = w.document().measures()->features[1].visibility;
    REQUIRE(visible > 0.05);
    clickCell(w, 1, FeaturesModel::Eye);
    const QImage without = w.picture();
    CHECK(w.document().tf().features[1].hidden);
    CHECK(w.document().tf().points == before.points); // hidden, not changed
    CHECK(without != picture);
    REQUIRE(w.document().measuresAreCurrent());
    CHECK(w.document().measures()->features[1].visibility == 0);
    CHECK(w.document().measures()->features[1].vws == 0);
    // The picture is that of a function without the tent.
    w.document().setTf(withFeatureRemoved(before, 1), "removed");
    CHECK(w.picture() == without);
    w.document().undo();
    w.settle();
    const QAbstractItemModel& model = *w.child<QTableView>("featuresTable").model();
    CHECK(model.data(model.index(1, FeaturesModel::Target)).toString() == QStringLiteral("–"));
    CHECK(w.document().targets()[1] == 0);
    clickCell(w, 1, FeaturesModel::Eye);
    CHECK(w.picture() == picture);
    CHECK(w.document().measures()->features[1].visibility == visible);
    w.document().undo();
    CHECK(w.document().tf().features[1].hidden);
    CHECK(w.picture() == without);
}

TEST_CASE("Alt and a click on an eye draws only that feature, figures stay", "[shapes]") {
    OpenWindow w;
    const QImage picture = w.picture();
    const double visible = w.document().measures()->features[0].visibility;
    clickCell(w, 2, FeaturesModel::Eye, Qt::AltModifier);
    const QImage alone = w.picture();
    CHECK(alone != picture);
    CHECK(w.services().scene().onlyFeature() == 2);
    CHECK_FALSE(w.document().tf().features[0].hidden);
    CHECK(w.document().measures()->features[0].visibility == visible);
    clickCell(w, 2, FeaturesModel::Eye, Qt::ControlModifier);
    CHECK(w.services().scene().onlyFeature() == -1);
    CHECK(w.picture() == picture);
    // Hiding the others gives the same picture by another way.
    clickCell(w, 2, FeaturesModel::Name);
    w.child<QAction>("featureHideOthers").trigger();
    w.settle();
    CHECK(w.document().tf().features[0].hidden);
    CHECK(w.document().measures()->features[0].visibility == 0);
    CHECK(w.document().measures()->features[2].visibility == Approx(1));
    CHECK(w.picture() != picture);
    w.child<QAction>("featureShowAll").trigger();
    CHECK(w.picture() == picture);
}

TEST_CASE("a feature is renamed in its row", "[shapes]") {
    OpenWindow w;
    const QImage picture = w.picture();
    auto& table = w.child<QTableView>("featuresTable");
    const QRect cell = table.visualRect(table.model()->index(1, FeaturesModel::Name));
    const QPoint place(cell.left() + 40, cell.center().y());
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {}, place);
    QTest::mouseDClick(table.viewport(), Qt::LeftButton, {}, place);
    auto* editor = table.viewport()->findChild<QLineEdit*>(QString(), Qt::FindDirectChildrenOnly);
    REQUIRE(editor != nullptr);
    editor->selectAll();
    QTest::keyClicks(editor, "enamel");
    QTest::keyClick(editor, Qt::Key_Return);
    CHECK(waitFor([&] { return w.document().tf().features[1].name == "enamel"; }));
    CHECK(w.picture() == picture);
    w.document().undo();
    CHECK(w.document().tf().features[1].name == "f2");
}

TEST_CASE("what is selected in one place is selected in all", "[shapes]") {
    OpenWindow w;
    auto& table = w.child<QTableView>("featuresTable");
    auto& bars = w.child<TargetBars>("targetBars");
    const auto idOf = [&](std::size_t f) { return w.document().tf().features[f].id; };
    w.services().selection().setFeature(idOf(2));
    CHECK(table.selectionModel()->isRowSelected(2));
    CHECK(bars.currentFeature() == 2);
    QTest::mouseClick(&bars, Qt::LeftButton, {}, QPoint(40, static_cast<int>(bars.handlePosition(0).y())));
    CHECK(w.services().selection().feature() == idOf(0));
    CHECK(table.selectionModel()->isRowSelected(0));
    CHECK_FALSE(table.selectionModel()->isRowSelected(2));
    // The selection follows the feature, not the row.
    TransferFunction swapped = w.document().tf();
    std::swap(swapped.features[0], swapped.features[1]);
    w.document().setTf(swapped, "order");
    CHECK(table.selectionModel()->isRowSelected(1));
}

TEST_CASE("a colour map changes the colours and no opacity", "[shapes]") {
    OpenWindow w;
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    const double visible = w.document().measures()->features[0].visibility;
    clickInMenu(w.child<QToolButton>("colorMapButton"), "colorMap-sand");
    const QImage colored = w.picture();
    const ColorMap& sand = colorMapNamed("sand");
    CHECK(w.document().tf() == withColorMap(before, sand));
    for (int f = 0; f < 3; ++f)
        CHECK(colorDifference(w.document().tf().features[static_cast<std::size_t>(f)].color,
                              colorOf(sand, (f + 0.5) / 3)) < 1e-6);
    CHECK(mostApart(opacities(w.document().tf()), opacities(before)) < 1e-12);
    CHECK(colored != picture);
    CHECK(w.document().measures()->features[0].visibility == Approx(visible).margin(1e-6));
    w.child<QAction>("colorsReverse").trigger();
    CHECK(w.picture() != colored);
    w.document().undo();
    w.document().undo();
    CHECK(w.document().tf() == before);
    CHECK(w.picture() == picture);
}

TEST_CASE("the density slider moves along equal shares, live, and is one step", "[shapes]") {
    OpenWindow w;
    w.document().setTf(tents(3, 0.3), "some");
    const QImage picture = w.picture();
    const TransferFunction before = w.document().tf();
    const Measures measured = *w.document().measures();
    const int steps = w.document().stepCount();
    auto& row = w.child<DensitySlider>("densityRow");
    auto& slider = w.child<QSlider>("densitySlider");
    auto& value = w.child<QLabel>("densityValue");
    REQUIRE(measured.coverage);
    CHECK(value.text() == QString::fromStdString(percentText(measured.coverage->coverage)));
    const auto send = [&](QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons held) {
        QMouseEvent event(type, at, slider.mapToGlobal(at), button, held, {});
        QCoreApplication::sendEvent(&slider, &event);
    };
    // The first touch has the curve computed, then the slider is where the picture is, wherever it was taken.
    const QPointF middle = QRectF(slider.rect()).center(), left = middle - QPointF(slider.width() / 4.0, 0);
    send(QEvent::MouseButtonPress, middle, Qt::LeftButton, Qt::LeftButton);
    REQUIRE(waitFor([&] { return row.curve() != nullptr; }));
    CHECK_FALSE(w.document().isPreviewing());
    send(QEvent::MouseMove, left, Qt::NoButton, Qt::LeftButton);
    CHECK(w.document().isPreviewing());
    CHECK(w.picture() != picture);
    const std::vector<double> held = opacities(w.document().tf());
    for (std::size_t f = 0; f < 3; ++f) CHECK(held[f] < 0.3);
    send(QEvent::MouseButtonRelease, left, Qt::LeftButton, Qt::NoButton);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(opacities(w.document().tf()) == held);
    w.settle();
    const Measures fainter = *w.document().measures();
    CHECK(fainter.coverage->coverage < 0.8 * measured.coverage->coverage);
    for (std::size_t f = 0; f < 3; ++f) CHECK(fainter.features[f].vws == Approx(measured.features[f].vws).margin(0.01));
    CHECK(value.text() == QString::fromStdString(percentText(fainter.coverage->coverage)));
    REQUIRE(row.curve());

    // Keys go to the ends, in one step; there the curve ends.
    const QImage faint = w.picture();
    slider.setFocus();
    QTest::keyClick(&slider, Qt::Key_End);
    QTest::keyClick(&slider, Qt::Key_Home);
    QTest::keyClick(&slider, Qt::Key_End);
    CHECK(w.document().stepCount() == steps + 2);
    CHECK(w.picture() != faint);
    CHECK(w.document().measures()->coverage->coverage ==
          Approx(row.curve()->strongest().coverage.coverage).epsilon(0.01));
    for (std::size_t f = 0; f < 3; ++f)
        CHECK(w.document().measures()->features[f].vws == Approx(measured.features[f].vws).margin(0.01));
    w.document().undo();
    CHECK(w.picture() == faint);
    CHECK(row.curve()); // it still lies on it
    w.document().undo();
    CHECK(w.picture() == picture);
    CHECK(w.document().tf() == before);
    // Other shares, another curve.
    w.document().setTf(tents(3, 0.5), "others");
    CHECK(row.curve() == nullptr);
}

TEST_CASE("the density slider scales all opacities, is one step, and springs back", "[shapes]") {
    OpenWindow w;
    w.child<QToolButton>("densityAll").click();
    w.document().setTf(tents(3, 0.1), "thin");
    const TransferFunction before = w.document().tf();
    const QImage picture = w.picture();
    const int steps = w.document().stepCount();
    auto& slider = w.child<QSlider>("densitySlider");
    auto& factor = w.child<QLabel>("densityValue");
    CHECK(factor.text() == QStringLiteral("× 1.00"));
    const auto send = [&](QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons held) {
        QMouseEvent event(type, at, slider.mapToGlobal(at), button, held, {});
        QCoreApplication::sendEvent(&slider, &event);
    };
    const QPointF middle = QRectF(slider.rect()).center(), right = middle + QPointF(slider.width() / 6.0, 0);
    send(QEvent::MouseButtonPress, middle, Qt::LeftButton, Qt::LeftButton);
    send(QEvent::MouseMove, right, Qt::NoButton, Qt::LeftButton);
    const double k = std::exp2(slider.value() / 100.0);
    CHECK(k > 1.5);
    CHECK(w.document().isPreviewing());
    CHECK(factor.text() == QStringLiteral("× %1").arg(k, 0, 'f', 2));
    CHECK(w.document().tf().points[1].opacity == Approx(1 - std::pow(0.9, k)).margin(1e-12));
    CHECK(w.picture() != picture);
    send(QEvent::MouseButtonRelease, right, Qt::LeftButton, Qt::NoButton);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(slider.value() == 0);
    CHECK(factor.text() == QStringLiteral("× 1.00"));
    CHECK(w.document().stepCount() == steps + 1);
    const QImage denser = w.picture();
    CHECK(denser != picture);
    CHECK(w.document().tf().points[1].opacity == Approx(1 - std::pow(0.9, k)).margin(1e-12));

    // Keys: a tenth of a doubling each, together one step.
    slider.setFocus();
    for (int i = 0; i < 10; ++i) QTest::keyClick(&slider, Qt::Key_Left);
    CHECK(w.document().stepCount() == steps + 2);
    CHECK(w.document().tf().points[1].opacity == Approx(1 - std::pow(0.9, k / 2)).margin(1e-12));
    w.document().undo();
    CHECK(w.picture() == denser);

    // Escape gives a drag up, whatever the mouse does then.
    send(QEvent::MouseButtonPress, middle, Qt::LeftButton, Qt::LeftButton);
    send(QEvent::MouseMove, right, Qt::NoButton, Qt::LeftButton);
    QTest::keyClick(&slider, Qt::Key_Escape);
    send(QEvent::MouseMove, middle, Qt::NoButton, Qt::LeftButton);
    send(QEvent::MouseButtonRelease, middle, Qt::LeftButton, Qt::NoButton);
    CHECK(w.picture() == denser);
    w.document().undo();
    CHECK(w.document().tf() == before);
    CHECK(w.picture() == picture);
}
