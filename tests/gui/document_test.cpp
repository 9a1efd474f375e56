#include "gui_support.h"

#include <numeric>

#include <QAbstractItemModelTester>
#include <QSignalSpy>

#include "panels/features_model.h"
#include "tf/edit.h"

using namespace pellucid;
using namespace pellucid::gui;

TEST_CASE("undo restores the transfer function exactly", "[document]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    CHECK(document.isClean());
    document.setTf(withPointMoved(start, 1, 0.123456789, 0.987654321), "Move");
    document.setTf(ramp(5), "Ramp");
    const TransferFunction last = document.tf();
    document.undo();
    document.undo();
    CHECK(document.tf() == start);
    CHECK(document.isClean());
    document.redo();
    document.redo();
    CHECK(document.tf() == last);
}

TEST_CASE("a preview is no undo step until it is committed", "[document]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    for (int i = 1; i <= 10; ++i) document.previewTf(withPointMoved(start, 1, start.points[1].x, 0.04 * i));
    CHECK(document.stepCount() == 0);
    CHECK(document.committedTf() == start);
    w.store.commit();
    CHECK(document.stepCount() == 1);
    CHECK(document.tf().points[1].opacity == Approx(0.4));
    document.previewTf(ramp(3));
    w.store.cancel();
    CHECK(document.stepCount() == 1);
    CHECK(document.tf().points[1].opacity == Approx(0.4));
    document.undo();
    CHECK(document.tf() == start);
    // A preview that ends where it began is nothing to undo.
    document.previewTf(ramp(3));
    document.previewTf(start);
    w.store.commit();
    CHECK_FALSE(document.canUndo());
}

TEST_CASE("changes with one merge key in a row are one undo step", "[document]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    for (int i = 1; i <= 4; ++i) document.setTf(withPointMoved(document.tf(), 1, 0.16, 0.1 * i), "Move", "nudge-1");
    document.setTf(withPointMoved(document.tf(), 4, 0.5, 0.2), "Move", "nudge-4");
    CHECK(document.stepCount() == 2);
    document.undo();
    document.undo();
    CHECK(document.tf() == start);
}

TEST_CASE("targets always add up to one", "[document]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    CHECK(document.targets() == std::vector<double>(3, 1.0 / 3));
    document.setTarget(0, 0.7); // the others share 0.3 equally
    CHECK(document.targets()[1] == Approx(0.15));
    document.setTarget(1, 0.5); // the rest in the proportion 0.7 : 0.15
    CHECK(document.targets()[0] == Approx(0.5 * 0.7 / 0.85));
    CHECK(document.targets()[2] == Approx(0.5 * 0.15 / 0.85));
    document.setTarget(2, 5); // as far as it goes
    CHECK(document.targets() == std::vector<double>{0, 0, 1});
    document.setTarget(2, 0.4); // nobody has a proportion: equal shares
    CHECK(document.targets()[0] == Approx(0.3));
    CHECK(document.targets()[1] == Approx(0.3));
    document.setTf(tents(5), "Tents");
    REQUIRE(document.targets().size() == 5);
    const std::vector<double> five = document.targets();
    CHECK(std::accumulate(five.begin(), five.end(), 0.0) == Approx(1));
}

TEST_CASE("figures of an older state are known to be old", "[document]") {
    StoreAlone w;
    Document& document = w.document;
    w.store.open(sampleScene("shells", 12, tents(3)));
    CHECK_FALSE(document.measuresAreCurrent());
    REQUIRE(waitFor([&] { return document.measuresAreCurrent(); }));
    Camera camera = document.camera();
    camera.eye *= 1.01;
    document.setCamera(camera);
    CHECK_FALSE(document.measuresAreCurrent());
    CHECK(document.measures() != nullptr); // shown all the same, as what they are
    REQUIRE(waitFor([&] { return document.measuresAreCurrent(); }));
    document.setTf(tents(2), "Tents");
    CHECK_FALSE(document.measuresAreCurrent());
    CHECK(document.measures() == nullptr); // of features that are gone
    // Undo brings back what is known already, at once.
    document.undo();
    CHECK(document.measuresAreCurrent());
}

TEST_CASE("the table of features is a well-behaved model", "[model]") {
    StoreAlone w;
    Document& document = w.document;
    FeaturesModel model(w.store, w.results);
    const QAbstractItemModelTester tester(&model, QAbstractItemModelTester::FailureReportingMode::Fatal);
    CHECK(model.rowCount() == 0);
    w.store.open(sampleScene("shells", 12, tents(3, 0.5)));
    REQUIRE(model.rowCount() == 3);
    CHECK(model.data(model.index(0, FeaturesModel::Name)).toString() == "f1");
    CHECK(model.data(model.index(1, FeaturesModel::Opacity), Qt::EditRole).toDouble() == 0.5);
    CHECK_FALSE(model.data(model.index(1, FeaturesModel::Vws)).isValid()); // not measured yet

    QSignalSpy changed(&model, &QAbstractItemModel::dataChanged);
    CHECK(model.setData(model.index(1, FeaturesModel::Opacity), 0.25));
    CHECK(featureOpacities(document.tf()) == std::vector<double>{0.5, 0.25, 0.5});
    CHECK(changed.count() > 0);
    CHECK(model.setData(model.index(0, FeaturesModel::Name), "skin"));
    CHECK(document.tf().features[0].name == "skin");
    CHECK(model.setData(model.index(0, FeaturesModel::Target), 0.8));
    CHECK(document.targets()[0] == Approx(0.8));
    CHECK(model.setData(model.index(2, FeaturesModel::Name), QColor(Qt::red), Qt::DecorationRole));
    CHECK(document.tf().features[2].color == Rgb{1, 0, 0});
    CHECK_FALSE(model.setData(model.index(1, FeaturesModel::Opacity), 1.5));
    CHECK_FALSE(model.setData(model.index(1, FeaturesModel::Opacity), "much"));
    CHECK_FALSE(model.setData(model.index(1, FeaturesModel::Range), 0.5));
    CHECK(document.stepCount() == 4); // the target is one of them

    document.setTf(tents(6), "Tents");
    CHECK(model.rowCount() == 6);
    document.setTf(ramp(4), "Ramp");
    CHECK(model.rowCount() == 1);
    document.undo();
    document.undo();
    CHECK(model.rowCount() == 3);
    REQUIRE(waitFor([&] { return document.measuresAreCurrent(); }));
    w.results.addVws(measureInput(w.store.scene()), w.store.scene().tf, {0.25, 0.625, 0.125});
    CHECK(model.data(model.index(1, FeaturesModel::Vws), Qt::EditRole).toDouble() == 0.625);
    model.setReadOnly(true);
    CHECK_FALSE(model.setData(model.index(1, FeaturesModel::Opacity), 0.9));
}

TEST_CASE("a held slider previews from one shape, so that nothing is lost at zero", "[model]") {
    StoreAlone w;
    Document& document = w.document;
    FeaturesModel model(w.store, w.results);
    TransferFunction tf = tents(3, 0.5);
    tf = withPointAdded(tf, 0.45, 0.2).tf; // two heights in the middle tent
    w.store.open(sampleScene("shells", 12, tf));
    tf = document.tf();
    model.previewOpacity(1, 0.0);
    model.previewOpacity(1, 0.5);
    model.endPreview();
    CHECK(document.tf() == tf);
    CHECK_FALSE(document.canUndo());
}
