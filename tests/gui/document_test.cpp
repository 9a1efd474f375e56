#include "gui_support.h"

#include <numeric>

#include <QAbstractItemModelTester>
#include <QSignalSpy>

#include "models/features_model.h"
#include "tf_edit.h"

using namespace pellucid;
using namespace pellucid::gui;

TEST_CASE("undo restores the transfer function exactly", "[document]") {
    Document document;
    document.setVolume(loadedSample("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    CHECK(document.undoStack().isClean());
    document.setTf(withPointMoved(start, 1, 0.123456789, 0.987654321), "Move");
    document.setTf(ramp(5), "Ramp");
    const TransferFunction last = document.tf();
    document.undoStack().undo();
    document.undoStack().undo();
    CHECK(document.tf() == start);
    CHECK(document.undoStack().isClean());
    document.undoStack().redo();
    document.undoStack().redo();
    CHECK(document.tf() == last);
}

TEST_CASE("a preview is no undo step until it is committed", "[document]") {
    Document document;
    document.setVolume(loadedSample("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    for (int i = 1; i <= 10; ++i) document.previewTf(withPointMoved(start, 1, start.points[1].x, 0.04 * i));
    CHECK(document.undoStack().count() == 0);
    CHECK(document.committedTf() == start);
    document.commitPreview("Move");
    CHECK(document.undoStack().count() == 1);
    CHECK(document.tf().points[1].opacity == Approx(0.4));
    document.previewTf(ramp(3));
    document.cancelPreview();
    CHECK(document.undoStack().count() == 1);
    CHECK(document.tf().points[1].opacity == Approx(0.4));
    document.undoStack().undo();
    CHECK(document.tf() == start);
    // A preview that ends where it began is nothing to undo.
    document.previewTf(ramp(3));
    document.previewTf(start);
    document.commitPreview("Move");
    CHECK_FALSE(document.undoStack().canUndo());
}

TEST_CASE("changes with one merge key in a row are one undo step", "[document]") {
    Document document;
    document.setVolume(loadedSample("shells", 12, tents(3)));
    const TransferFunction start = document.tf();
    for (int i = 1; i <= 4; ++i) document.setTf(withPointMoved(document.tf(), 1, 0.16, 0.1 * i), "Move", "nudge-1");
    document.setTf(withPointMoved(document.tf(), 4, 0.5, 0.2), "Move", "nudge-4");
    CHECK(document.undoStack().count() == 2);
    document.undoStack().undo();
    document.undoStack().undo();
    CHECK(document.tf() == start);
}

TEST_CASE("targets always add up to one", "[document]") {
    Document document;
    document.setVolume(loadedSample("shells", 12, tents(3)));
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
    CHECK(std::accumulate(document.targets().begin(), document.targets().end(), 0.0) == Approx(1));
}

TEST_CASE("figures of an older state are known to be old", "[document]") {
    Document document;
    document.setVolume(loadedSample("shells", 12, tents(3)));
    Measures measures;
    measures.features.resize(3);
    document.setMeasures(measures, document.version());
    CHECK(document.measuresAreCurrent());
    Camera camera = document.camera();
    camera.eye *= 1.01;
    document.setCamera(camera);
    CHECK_FALSE(document.measuresAreCurrent());
    measures.features.resize(2); // of a transfer function that is gone
    document.setMeasures(measures, document.version());
    CHECK_FALSE(document.measuresAreCurrent());
}

TEST_CASE("the table of features is a well-behaved model", "[model]") {
    Document document;
    FeaturesModel model(document);
    const QAbstractItemModelTester tester(&model, QAbstractItemModelTester::FailureReportingMode::Fatal);
    CHECK(model.rowCount() == 0);
    document.setVolume(loadedSample("shells", 12, tents(3, 0.5)));
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
    CHECK(document.undoStack().count() == 3);

    document.setTf(tents(6), "Tents");
    CHECK(model.rowCount() == 6);
    document.setTf(ramp(4), "Ramp");
    CHECK(model.rowCount() == 1);
    document.undoStack().undo();
    document.undoStack().undo();
    CHECK(model.rowCount() == 3);
    Measures measures;
    measures.features.resize(3);
    measures.features[1].vws = 0.625;
    document.setMeasures(measures, document.version());
    CHECK(model.data(model.index(1, FeaturesModel::Vws), Qt::EditRole).toDouble() == 0.625);
    model.setReadOnly(true);
    CHECK_FALSE(model.setData(model.index(1, FeaturesModel::Opacity), 0.9));
}

TEST_CASE("a held slider previews from one shape, so that nothing is lost at zero", "[model]") {
    Document document;
    FeaturesModel model(document);
    TransferFunction tf = tents(3, 0.5);
    tf = withPointAdded(tf, 0.45, 0.2).tf; // two heights in the middle tent
    document.setVolume(loadedSample("shells", 12, tf));
    model.previewOpacity(1, 0.0);
    model.previewOpacity(1, 0.5);
    model.endPreview();
    CHECK(document.tf() == tf);
    CHECK_FALSE(document.undoStack().canUndo());
}
