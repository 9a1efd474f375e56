// The editor of the transfer function, by real events: each test looks at the function and at what is drawn.
#include "gui_support.h"

#include <numeric>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QContextMenuEvent>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QMenu>
#include <QTimer>
#include <QWheelEvent>

#include "services/selection.h"
#include "tf/histogram_bars.h"
#include "tf/point_selection.h"
#include "widgets/number_text.h"
#include "widgets/opacity_axis.h"

using namespace pellucid;
using namespace pellucid::gui;

// The window opens tents:3: centres 1/6, 1/2, 5/6, bottoms at centre ± 0.4/3; points 0..8, each tent bottom, peak,
// bottom; peaks 0.5.

namespace {

QPointF at(OpenWindow& w, int index) {
    const ControlPoint& p = w.services().scene().tf.points[static_cast<std::size_t>(index)];
    return w.canvas().positionOf(p.x, p.opacity);
}

const ControlPoint& point(OpenWindow& w, int index) {
    return w.services().scene().tf.points[static_cast<std::size_t>(index)];
}

QImage image(OpenWindow& w) { return w.canvas().grab().toImage().convertToFormat(QImage::Format_RGB32); }

/// Intensities per pixel.
double perPixel(OpenWindow& w) {
    const IntensityAxis& axis = w.canvas().axis();
    return (axis.hi() - axis.lo()) / w.canvas().plot().width();
}

void turnWheel(QWidget& widget, const QPointF& position, int notches, Qt::KeyboardModifiers modifiers = {}) {
    QWheelEvent event(position, widget.mapToGlobal(position), {}, {0, 120 * notches}, Qt::NoButton, modifiers,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&widget, &event);
}

void moveTo(QWidget& widget, const QPointF& position) {
    QMouseEvent event(QEvent::MouseMove, position, widget.mapToGlobal(position), Qt::NoButton, Qt::NoButton,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
}

/// Draws a rubber band around the second tent: its peak, and its bottoms at the lower edge of the plot.
void selectSecondTent(OpenWindow& w) {
    const QPointF from = w.canvas().positionOf(0.34, 0.8);
    const QPointF to(w.canvas().positionOf(0.66, 0).x(), w.canvas().plot().bottom() + 4);
    drag(w.canvas(), from, to);
}

int countPixels(const QImage& image, const QRectF& where, const std::function<bool(QColor)>& is) {
    int count = 0;
    const QRect r = where.toRect().intersected(image.rect());
    for (int y = r.top(); y <= r.bottom(); ++y)
        for (int x = r.left(); x <= r.right(); ++x) count += is(QColor(image.pixel(x, y))) ? 1 : 0;
    return count;
}

} // namespace

TEST_CASE("screen readers hear the point that keys select and move", "[canvas][spoken]") {
    OpenWindow w;
    TfCanvas& canvas = w.canvas();
    canvas.setFineOpacityAxis(false); // height is opacity
    CHECK(heardValue(canvas) == "9 points; none selected");
    QTest::keyClick(&canvas, Qt::Key_PageDown);
    QTest::keyClick(&canvas, Qt::Key_PageDown); // the second one, the peak of the first tent
    const auto wanted = [&](const QString& opacity) {
        const Scene& scene = w.services().scene();
        const ValueRange range = scene.volume->range();
        QString value = gui::numberText(scene.volume->valueOfIntensity(point(w, 1).x), range.hi - range.lo);
        if (scene.unit && !scene.unit->empty()) value += " " + QString::fromStdString(*scene.unit);
        return QStringLiteral("9 points; point 2 selected: value %1, opacity %2; in the feature %3")
            .arg(value, opacity, QString::fromStdString(scene.tf.features[0].name))
            .toStdString();
    };
    CHECK(point(w, 1).x == Approx(1.0 / 6));
    CHECK(heardValue(canvas).toStdString() == wanted("0.5"));
    QTest::keyClick(&canvas, Qt::Key_Up); // 1/128 of the height
    CHECK(heardValue(canvas).toStdString() == wanted("0.5078"));
    QTest::keyClick(&canvas, Qt::Key_Right);
    CHECK(point(w, 1).x == Approx(1.0 / 6 + 1.0 / 128));
    CHECK(heardValue(canvas).toStdString() == wanted("0.5078")); // with the new value
    QTest::keyClick(&canvas, Qt::Key_Space);
    CHECK(heardValue(canvas).toStdString() == wanted("0.5078, fixed"));
    QTest::keyClick(&canvas, Qt::Key_Escape);
    CHECK(heardValue(canvas) == "9 points; none selected");
}

TEST_CASE("a point is added, moved along one axis with Shift, and finely with Ctrl", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture(), canvas = image(w);
    const double pixel = perPixel(w);

    QTest::mouseDClick(&w.canvas(), Qt::LeftButton, {}, w.canvas().positionOf(0.4, 0.7).toPoint());
    REQUIRE(w.document().tf().points.size() == start.points.size() + 1);
    const int index = w.canvas().selectedPoint();
    REQUIRE(index == 4); // between the bottom at 0.3667 and the peak at 0.5
    CHECK(point(w, index).x == Approx(0.4).margin(pixel));
    CHECK(point(w, index).opacity == Approx(0.7).margin(0.05)); // 3h²/120 with h = ∛0.7: 0.02 per pixel
    const QImage added = w.picture();
    CHECK(added != before);
    CHECK(image(w) != canvas);

    const ControlPoint placed = point(w, index);
    drag(w.canvas(), at(w, index), at(w, index) + QPointF(20, -7), Qt::LeftButton, Qt::ShiftModifier);
    CHECK(point(w, index).x == Approx(placed.x + 20 * pixel));
    CHECK(point(w, index).opacity == placed.opacity);
    drag(w.canvas(), at(w, index), at(w, index) + QPointF(-6, 30), Qt::LeftButton, Qt::ShiftModifier);
    CHECK(point(w, index).x == Approx(placed.x + 20 * pixel));
    CHECK(point(w, index).opacity < placed.opacity);
    CHECK(w.picture() != added);

    const double x = point(w, index).x;
    drag(w.canvas(), at(w, index), at(w, index) + QPointF(-30, 0), Qt::LeftButton, Qt::ControlModifier);
    CHECK(point(w, index).x == Approx(x - 3 * pixel));

    CHECK(w.document().stepCount() == 4);
    for (int i = 0; i < 4; ++i) w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);
}

TEST_CASE("a rubber band selects points, which move together and go together", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture(), canvas = image(w);
    const double pixel = perPixel(w);

    selectSecondTent(w);
    CHECK(w.canvas().selectedPoints().indices() == std::vector<int>{3, 4, 5});
    CHECK(w.document().tf() == start);
    CHECK(image(w) != canvas); // they are drawn as selected
    CHECK(w.document().stepCount() == 0);

    // The second tent ends at 0.6333, the third begins at 0.7: a part of that, its features' ends along.
    const double way = 12 * pixel;
    REQUIRE(way < 0.0666);
    drag(w.canvas(), at(w, 4), at(w, 4) + QPointF(12, 0));
    for (const std::size_t i : {3U, 4U, 5U}) {
        CHECK(w.document().tf().points[i].x == Approx(start.points[i].x + way));
        CHECK(w.document().tf().points[i].opacity == Approx(start.points[i].opacity));
    }
    CHECK(w.document().tf().features[1].a == Approx(start.features[1].a + way));
    CHECK(w.document().tf().features[1].b == Approx(start.features[1].b + way));
    CHECK(w.document().stepCount() == 1);
    CHECK(w.picture() != before);
    w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);

    // Arrow keys move all of them, in one step for a row of strokes.
    QTest::keyClick(&w.canvas(), Qt::Key_Right);
    QTest::keyClick(&w.canvas(), Qt::Key_Right);
    CHECK(point(w, 3).x == Approx(start.points[3].x + 2.0 / 128));
    CHECK(point(w, 5).x == Approx(start.points[5].x + 2.0 / 128));
    CHECK(w.document().stepCount() == 1);
    w.document().undo();

    QTest::mouseClick(&w.canvas(), Qt::LeftButton, Qt::ControlModifier, at(w, 5).toPoint());
    CHECK(w.canvas().selectedPoints().indices() == std::vector<int>{3, 4});
    QTest::mouseClick(&w.canvas(), Qt::LeftButton, Qt::ControlModifier, at(w, 7).toPoint());
    CHECK(w.canvas().selectedPoints().indices() == std::vector<int>{3, 4, 7});
    QTest::keyClick(&w.canvas(), Qt::Key_Delete);
    CHECK(w.document().tf().points.size() == start.points.size() - 3);
    CHECK(w.canvas().selectedPoints().isEmpty());
    CHECK(w.picture() != before);
    w.document().undo();
    CHECK(w.document().tf() == start);

    QTest::keyClick(&w.canvas(), Qt::Key_A, Qt::ControlModifier);
    CHECK(w.canvas().selectedPoints().size() == start.points.size());
    CHECK(w.picture() == before);
}

TEST_CASE("fixed points are drawn differently, and several are fixed at once", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    REQUIRE_FALSE(start.points[4].fixed);
    const QImage before = w.picture();
    selectSecondTent(w);
    const QImage canvas = image(w);
    auto& box = w.child<QCheckBox>("pointFixed");
    CHECK(box.checkState() == (start.points[3].fixed ? Qt::PartiallyChecked : Qt::Unchecked));
    QTest::keyClick(&w.canvas(), Qt::Key_Space);
    for (const int i : {3, 4, 5}) CHECK(point(w, i).fixed);
    CHECK(box.checkState() == Qt::Checked);
    CHECK(image(w) != canvas);
    CHECK(w.picture() == before); // no colour and no opacity is another
    w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(image(w) == canvas);
}

TEST_CASE("numbers of several points: what they have in common, or nothing, and one for all", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture();
    auto& value = w.child<QDoubleSpinBox>("pointValue");
    auto& opacity = w.child<QDoubleSpinBox>("pointOpacity");
    w.canvas().selectPoints(PointSelection({1, 4}));
    CHECK(value.text().isEmpty());
    CHECK(opacity.value() == Approx(0.5));
    CHECK_FALSE(opacity.text().isEmpty());
    w.canvas().selectPoints(PointSelection({1, 5}, 1)); // a peak of 0.5, a bottom
    CHECK(opacity.text().isEmpty());
    // 0.5, the number that the box has kept for the current point: it counts all the same.
    QTest::keyClicks(&opacity, QLocale().toString(0.5));
    QTest::keyClick(&opacity, Qt::Key_Return);
    CHECK(point(w, 1).opacity == 0.5);
    CHECK(point(w, 5).opacity == 0.5);
    CHECK(w.picture() != before);
    w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);
}

TEST_CASE("the wheel zooms about the mouse, and a point moved there gets the value that is under it", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture(), canvas = image(w);
    const double whole = perPixel(w);
    const QPointF cursor(w.canvas().positionOf(0.45, 0).x(), w.canvas().plot().center().y());
    turnWheel(w.canvas(), cursor, 4);
    const IntensityAxis& axis = w.canvas().axis();
    const double part = std::pow(0.8, 4);
    CHECK(axis.hi() - axis.lo() == Approx(part));
    CHECK(w.canvas().positionOf(0.45, 0).x() == Approx(cursor.x()));
    CHECK(w.document().tf() == start);
    CHECK(image(w) != canvas); // what is seen is counted
    REQUIRE(waitFor([&] { return !w.canvas().isCounting(); }));
    CHECK(w.picture() == before);

    drag(w.canvas(), at(w, 4), at(w, 4) + QPointF(25, 0));
    CHECK(point(w, 4).x == Approx(0.5 + 25 * part * whole));
    CHECK(w.picture() != before);
    w.document().undo();

    // A point out of sight is not hit.
    CHECK(start.points[8].x > axis.hi());
    turnWheel(w.canvas(), cursor, -2, Qt::ShiftModifier); // two tenths of what is seen, to larger values
    CHECK(axis.lo() == Approx(0.45 * (1 - part) + 0.2 * part));
    const double lo = axis.lo();
    drag(w.canvas(), w.canvas().plot().center(), w.canvas().plot().center() + QPointF(30, 0), Qt::MiddleButton);
    CHECK(axis.lo() == Approx(lo - 30 * part * whole));
    const QPointF labels(w.canvas().plot().center().x(), w.canvas().plot().bottom() + 16);
    drag(w.canvas(), labels, labels - QPointF(30, 0));
    CHECK(axis.lo() == Approx(lo));
    QTest::mouseDClick(&w.canvas(), Qt::LeftButton, {}, labels.toPoint());
    CHECK(axis.isWhole());
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);
}

TEST_CASE("the histogram's scale changes what is drawn, and nothing else", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage log = image(w);
    w.child<QAction>("histogramLinear").trigger();
    CHECK(w.canvas().histogramScale() == HistogramScale::Linear);
    const QImage linear = image(w);
    w.child<QAction>("histogramPercentile").trigger();
    CHECK(w.canvas().histogramScale() == HistogramScale::Percentile);
    const QImage percentile = image(w);
    CHECK(linear != log);
    CHECK(percentile != linear);
    CHECK(percentile != log);
    w.child<QAction>("histogramLog").trigger(); // the next window has what was chosen last
    CHECK(image(w) == log);
    CHECK(w.document().tf() == start);
    CHECK(w.document().stepCount() == 0);
}

TEST_CASE("the joint histogram appears behind the curve, with its axis of gradients", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = image(w), picture = w.picture();
    auto& box = w.child<QAction>("jointHistogram");
    box.trigger();
    const QImage counting = image(w); // laid out already; what is seen is counted
    REQUIRE(waitFor([&] { return !w.canvas().isCounting(); }));
    const QImage after = image(w);
    // The picture has changed where gradients are, not where none are. Only the upper half: below, the histogram is an
    // outline now. The uppermost quarter has the words "counting gradients…" in the first image.
    const JointHistogram joint = makeJointHistogram(*w.services().scene().volume, 64, 16);
    const QRectF plot = w.canvas().plot();
    double changedFull = 0, changedEmpty = 0;
    int full = 0, empty = 0;
    for (int g = 8; g < 12; ++g) {
        for (int b = 0; b < 64; ++b) {
            const QPoint at(static_cast<int>(plot.left() + (b + 0.5) / 64 * plot.width()),
                            static_cast<int>(plot.bottom() - (g + 0.5) / 16 * plot.height()));
            const QColor one(counting.pixel(at)), other(after.pixel(at));
            const int change = std::abs(one.red() - other.red()) + std::abs(one.green() - other.green()) +
                               std::abs(one.blue() - other.blue());
            if (joint.at(b, g) > 8) {
                changedFull += change;
                ++full;
            } else if (joint.at(b, g) == 0) {
                changedEmpty += change;
                ++empty;
            }
        }
    }
    REQUIRE(full > 10);
    REQUIRE(empty > 10);
    CHECK(changedFull / full > 3 * changedEmpty / empty + 10);
    const QRectF axis(plot.right() + 6, plot.top(), 40, plot.height());
    const auto light = [](const QColor& c) { return c.lightness() > 110; };
    CHECK(countPixels(after, axis, light) > countPixels(counting, axis, light) + 20); // labels
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == picture);
    box.trigger();
    CHECK(image(w) == before);
}

TEST_CASE("the readout tells value, opacity, voxels and feature of what the mouse is over", "[canvas]") {
    OpenWindow w;
    CHECK(w.canvas().readout().isEmpty());
    const QImage before = image(w);
    const QPointF over(w.canvas().positionOf(0.5, 0).x(), w.canvas().plot().center().y());
    moveTo(w.canvas(), over);
    REQUIRE(w.services().selection().hoveredIntensity().has_value());
    const double x = *w.services().selection().hoveredIntensity();
    CHECK(x == Approx(0.5).margin(1e-9));
    const Scene& scene = w.services().scene();
    const auto bin = static_cast<std::size_t>(histogramBin(x, 256));
    const QString text = w.canvas().readout();
    INFO(text.toStdString());
    CHECK(text.contains(gui::numberText(scene.volume->valueOfIntensity(x), scene.volume->range().hi)));
    CHECK(text.contains("opacity " + QString::number(scene.tf.opacity(x), 'g', 3)));
    CHECK(text.contains(QLocale().toString(static_cast<qlonglong>(scene.histogram->counts[bin])) + " voxel"));
    CHECK(text.contains(QString::fromStdString(scene.tf.features[1].name)));
    const QImage hovered = image(w);
    CHECK(hovered != before);

    // From another view: a hair line where that points, and the same words.
    w.services().selection().setHoveredIntensity(0.9);
    const double hair = w.canvas().positionOf(0.9, 0).x();
    const QImage other = image(w);
    const auto differs = [&](double column) {
        const int i = static_cast<int>(column), y = static_cast<int>(w.canvas().plot().top()) + 4;
        return other.pixel(i, y) != before.pixel(i, y) || other.pixel(i - 1, y) != before.pixel(i - 1, y);
    };
    CHECK(differs(hair));
    CHECK_FALSE(differs(hair - 12));
    CHECK(w.canvas().readout() != text);
    w.services().selection().setHoveredIntensity({});
    CHECK(w.canvas().readout().isEmpty());
    CHECK(w.document().stepCount() == 0);
}

TEST_CASE("a feature's bar selects it, moves it and widens it", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture(), canvas = image(w);
    const double pixel = perPixel(w);
    const QRectF bar = w.canvas().barOf(start.features[1]);
    CHECK(bar.left() == Approx(w.canvas().positionOf(start.features[1].a, 0).x()));

    QTest::mouseClick(&w.canvas(), Qt::LeftButton, {}, bar.center().toPoint());
    CHECK(w.services().selection().feature() == w.document().tf().features[1].id);
    CHECK(w.services().selection().feature() != 0);
    CHECK(w.document().tf() == start);
    CHECK(image(w) != canvas);

    drag(w.canvas(), bar.center(), bar.center() + QPointF(-10, 0));
    CHECK(w.document().tf().features[1].a == Approx(start.features[1].a - 10 * pixel));
    CHECK(w.document().tf().features[1].b == Approx(start.features[1].b - 10 * pixel));
    CHECK(point(w, 4).x == Approx(start.points[4].x - 10 * pixel));
    CHECK(point(w, 4).opacity == start.points[4].opacity);
    CHECK(w.document().stepCount() == 1);
    CHECK(w.picture() != before);
    w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);

    drag(w.canvas(), {bar.right() - 1, bar.center().y()}, {bar.right() + 9, bar.center().y()});
    CHECK(w.document().tf().features[1].a == Approx(start.features[1].a));
    CHECK(w.document().tf().features[1].b == Approx(start.features[1].b + 10 * pixel));
    CHECK(point(w, 5).x == Approx(start.points[5].x + 10 * pixel));
    CHECK(w.picture() != before);
    w.document().undo();
    CHECK(w.document().tf() == start);
}

TEST_CASE("the context menu zooms to a feature, selects all, and tells others where it opens", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage picture = w.picture(), canvas = image(w);
    double where = -1;
    FeatureId feature = 0;
    QObject::connect(&w.canvas(), &TfCanvas::menuOpening, [&](QMenu& menu, double intensity, FeatureId id) {
        menu.addAction("Of another");
        where = intensity;
        feature = id;
    });
    const QPoint place = w.canvas().positionOf(0.45, 0.9).toPoint();
    const auto choose = [&](const QString& text) {
        bool found = false;
        QTimer timer;
        QObject::connect(&timer, &QTimer::timeout, [&] {
            auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
            if (menu == nullptr) return;
            timer.stop();
            for (QAction* action : menu->actions()) {
                if (action->text() != text) continue;
                found = true;
                action->trigger();
            }
            menu->close();
        });
        timer.start(10);
        QContextMenuEvent event(QContextMenuEvent::Mouse, place, w.canvas().mapToGlobal(place));
        QCoreApplication::sendEvent(&w.canvas(), &event);
        return found;
    };
    CHECK(choose("Of another"));
    CHECK(where == Approx(0.45).margin(perPixel(w)));
    CHECK(feature == w.document().tf().features[1].id);
    CHECK(choose("Select all points"));
    CHECK(w.canvas().selectedPoints().size() == start.points.size());
    CHECK(choose("Zoom to " + QString::fromStdString(start.features[1].name)));
    const Feature f = start.features[1]; // with a quarter of its width on both sides
    CHECK(w.canvas().axis().lo() == Approx(f.a - (f.b - f.a) / 4));
    CHECK(w.canvas().axis().hi() == Approx(f.b + (f.b - f.a) / 4));
    CHECK(image(w) != canvas);
    CHECK(choose("Show all values"));
    CHECK(w.canvas().axis().isWhole());
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == picture);
}

TEST_CASE("the menu of a feature's bar splits the feature where the mouse is", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage canvas = image(w);
    const double x = 0.45;
    const QPoint place(static_cast<int>(w.canvas().positionOf(x, 0).x()),
                       static_cast<int>(w.canvas().barOf(start.features[1]).center().y()));
    moveTo(w.canvas(), place);
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
        auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
        if (menu == nullptr) return;
        timer.stop();
        QEvent leave(QEvent::Leave); // the mouse is over the menu now
        QCoreApplication::sendEvent(&w.canvas(), &leave);
        w.child<QAction>("featureSplit").trigger();
        menu->close();
    });
    timer.start(10);
    QContextMenuEvent event(QContextMenuEvent::Mouse, place, w.canvas().mapToGlobal(place));
    QCoreApplication::sendEvent(&w.canvas(), &event);
    REQUIRE(w.document().tf().features.size() == 4);
    const Feature* lower = nullptr;
    for (const Feature& f : w.document().tf().features)
        if (f.a == start.features[1].a) lower = &f;
    REQUIRE(lower != nullptr);
    CHECK(lower->b == Approx(x).margin(1.5 * perPixel(w)));
    CHECK(w.services().selection().feature() == lower->id);
    CHECK(image(w) != canvas);
    w.document().undo();
    CHECK(w.document().tf() == start);
}

TEST_CASE("each of two points in one place can be reached", "[canvas]") {
    OpenWindow w;
    TransferFunction tf = w.document().tf();
    tf.points.insert(tf.points.begin() + 4, tf.points[4]); // the peak twice
    w.document().setTf(tf, "Twice");
    const QImage before = image(w);
    QTest::mouseClick(&w.canvas(), Qt::LeftButton, {}, at(w, 4).toPoint());
    const int first = w.canvas().selectedPoint();
    QTest::mouseClick(&w.canvas(), Qt::LeftButton, {}, at(w, 4).toPoint());
    const int second = w.canvas().selectedPoint();
    CHECK(std::min(first, second) == 4);
    CHECK(std::max(first, second) == 5);
    // The one at hand is dragged, the other stays: a step.
    const double x = point(w, second).x;
    drag(w.canvas(), at(w, second), at(w, second) + QPointF(0, 40));
    CHECK(point(w, second).opacity < 0.5);
    CHECK(point(w, first).opacity == 0.5);
    CHECK(point(w, second).x == x);
    CHECK(image(w) != before);
}

TEST_CASE("while nothing may be edited the canvas shows and selects, and nothing moves", "[canvas]") {
    OpenWindow w;
    const TransferFunction start = w.document().tf();
    const QImage before = w.picture();
    w.canvas().setReadOnly(true);
    const QImage canvas = image(w);
    drag(w.canvas(), at(w, 4), at(w, 4) + QPointF(0, 30));
    const QPointF bar = w.canvas().barOf(start.features[1]).center();
    drag(w.canvas(), bar, bar + QPointF(20, 0));
    QTest::mouseDClick(&w.canvas(), Qt::LeftButton, {}, w.canvas().positionOf(0.4, 0.7).toPoint());
    QTest::keyClick(&w.canvas(), Qt::Key_Up);
    QTest::keyClick(&w.canvas(), Qt::Key_Delete);
    CHECK(w.document().tf() == start);
    CHECK(w.picture() == before);
    turnWheel(w.canvas(), w.canvas().plot().center(), 3); // looking is no edit
    CHECK_FALSE(w.canvas().axis().isWhole());
    CHECK(image(w) != canvas);
    w.canvas().setReadOnly(false);
}

TEST_CASE("the editor comes back with the axis that was chosen", "[canvas]") {
    const auto height = [](OpenWindow& w) {
        return w.canvas().positionOf(0, 0).y() - w.canvas().positionOf(0, 0.2).y();
    };
    double fine = 0;
    {
        OpenWindow w;
        fine = height(w);
        const QImage before = image(w);
        w.child<QAction>("fineOpacityAxis").trigger();
        CHECK(height(w) < fine / 2); // 0.2 of the plot, in place of ∛0.2 = 0.58
        CHECK(image(w) != before);
    }
    OpenWindow w;
    CHECK(height(w) < fine / 2);
    w.child<QAction>("fineOpacityAxis").trigger();
    CHECK(height(w) == fine);
    CHECK(rangeless(w.document().tf()) == tents(3));
}

TEST_CASE("heights of bars: log, linear, and cut at the 99.5th percentile", "[histogram]") {
    // 400 bins of 1, …, 400, the last one a thousand times as large. 0.995 · 400 = 398: the 398th in order is 398.
    std::vector<double> counts(400);
    std::iota(counts.begin(), counts.end(), 1.0);
    counts.back() = 400000;
    const auto linear = barHeights(counts, HistogramScale::Linear);
    CHECK(linear[199] == Approx(200.0 / 400000));
    CHECK(linear[399] == 1);
    const auto percentile = barHeights(counts, HistogramScale::Percentile);
    CHECK(percentile[199] == Approx(200.0 / 398));
    CHECK(percentile[397] == 1);
    CHECK(percentile[399] == kCutBar);
    const auto log = barHeights(counts, HistogramScale::Log);
    CHECK(log[199] == Approx(std::log(201.0) / std::log(400001.0)));
    CHECK(barHeights(std::vector<double>(3, 0.0), HistogramScale::Percentile) == std::vector<double>(3, 0.0));
}

TEST_CASE("zoomed bins hold what lies in them, whatever is seen", "[histogram]") {
    std::vector<std::uint64_t> fine(65536);
    for (std::size_t i = 0; i < fine.size(); ++i) fine[i] = i % 7;
    // An eighth of the axis: 256 bins of 1/2048, each of 32 fine ones; 4/16 is where bin 512 begins.
    const SeenBins bins = seenBins(fine, 0.25, 0.375, 0);
    REQUIRE(bins.counts.size() == 256);
    CHECK(bins.lo == 0.25);
    CHECK(bins.width == 1.0 / 2048);
    for (const std::size_t b : {0U, 100U, 255U}) {
        const auto from = fine.begin() + 16384 + static_cast<std::ptrdiff_t>(32 * b);
        CHECK(bins.counts[b] == static_cast<double>(std::accumulate(from, from + 32, std::uint64_t{0})));
    }
    CHECK(bins.at(0.25) == 0);
    CHECK(bins.at(0.3) == 102); // 0.05 · 2048 = 102.4
    CHECK(bins.at(0.9) == -1);

    // Values 0 … 1000, one voxel each at intensity v/1000: every bin has as many as it has values, none is a gap.
    std::vector<std::uint64_t> whole(65536, 0);
    for (int v = 0; v <= 1000; ++v) ++whole[static_cast<std::size_t>(histogramBin(v / 1000.0, 65536))];
    const SeenBins values = seenBins(whole, 0.4, 0.6, 1.0 / 1000);
    CHECK(values.width == Approx(1.0 / 1000)); // the part's 1/8, in 256 bins, is finer than the values
    for (const double count : values.counts) CHECK(count == 1);
    CHECK(values.at(0.5) >= 0);
}

TEST_CASE("a selection of points moves as far as all of it can, and is followed through edits", "[canvas]") {
    const TransferFunction tf = tents(3);
    const PointSelection second({5, 3, 4, 4}, 4);
    CHECK(second.indices() == std::vector<int>{3, 4, 5});
    CHECK(second.current() == 4);
    CHECK(second.toggled(4).indices() == std::vector<int>{3, 5});
    CHECK(second.toggled(8).current() == 8);
    const auto same = [](double opacity) { return opacity; };
    // The upper bottom at 0.5 + 0.4/3 meets the next tent's at 5/6 − 0.4/3: 1/3 − 0.8/3 further.
    const TransferFunction far = withPointsMoved(tf, second, 0.4, same);
    const double way = 1.0 / 3 - 0.8 / 3;
    CHECK(far.points[3].x == Approx(tf.points[3].x + way));
    CHECK(far.points[4].x == Approx(tf.points[4].x + way));
    CHECK(far.points[5].x == Approx(tf.points[6].x));
    CHECK_NOTHROW(far.validate());
    const TransferFunction there = withPointsAt(tf, PointSelection({3, 4, 5}), 0.6, {});
    for (const std::size_t i : {3U, 4U, 5U}) CHECK(there.points[i].x == Approx(0.6));
    CHECK_NOTHROW(there.validate());
    CHECK(withPointsRemoved(tf, second).points.size() == 6);
    CHECK(second.followed(tf.points, withPointsRemoved(tf, PointSelection({0, 4})).points).indices() ==
          std::vector<int>{2, 3});
}

TEST_CASE("the fine axis of opacities has room for small ones, and is undone exactly", "[canvas]") {
    OpacityAxis axis;
    CHECK(axis.isFine());
    CHECK(axis.height(0.001) == Approx(0.1)); // ∛
    CHECK(axis.height(1) == 1);
    for (const double opacity : {0.0, 0.001, 0.05, 0.5, 1.0})
        CHECK(axis.opacity(axis.height(opacity)) == Approx(opacity));
    CHECK(axis.opacity(1.5) == 1);
    axis.setFine(false);
    CHECK(axis.height(0.3) == 0.3);
}
