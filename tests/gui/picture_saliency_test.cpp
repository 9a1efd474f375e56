// 2D feature saliency in the window: followed when the hand rests, laid over the picture, kept, saved.
#include "gui_support.h"

#include <numeric>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QTableView>
#include <QTemporaryDir>

#include "controllers/picture_saliency_controller.h"
#include "image_io/image_file.h"
#include "render/feature_pictures.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

using SaliencyState = PictureSaliencyController::State;

PictureSaliencyController& saliencyOf(OpenWindow& w) { return w.controllers().pictureSaliency; }

/// With its panel in front, so that the view has its size for good.
void openPanel(OpenWindow& w) {
    w.services().panels().show("pictureSaliency");
    w.settle();
    QTest::qWait(100); // docks arrange themselves
    w.settle();
}

/// Of the picture that is shown, computed anew.
FeatureSaliency expected(OpenWindow& w) {
    const PictureInfo& size = w.view().picture();
    const PictureInput picture = pictureInput(w.services().scene(), size.width, size.height);
    return featureSaliency(
        featurePictures(*makeCpuRenderer(picture.volume), picture.camera, picture.tf, picture.settings));
}

void checkShares(OpenWindow& w) {
    REQUIRE(saliencyOf(w).state() == SaliencyState::Current);
    const FeatureSaliency saliency = expected(w);
    double sum = 0;
    for (std::size_t f = 0; f < saliency.shares.size(); ++f) {
        CHECK(saliencyOf(w).share(f) == saliency.shares[f]);
        sum += saliency.shares[f];
    }
    CHECK(sum == Approx(1));
}

} // namespace

TEST_CASE("2D feature saliency follows the picture when the hand rests", "[picture_saliency]") {
    OpenWindow w;
    openPanel(w);
    auto& table = w.child<QTableView>("featuresTable");
    CHECK(table.isColumnHidden(FeaturesModel::PictureShare));
    CHECK(saliencyOf(w).state() == SaliencyState::Off);
    CHECK_FALSE(w.child<QPushButton>("pictureSaliencySave").isEnabled());

    w.child<QCheckBox>("pictureSaliencyCheck").click();
    CHECK(saliencyOf(w).state() == SaliencyState::Computing);
    w.settle();
    checkShares(w);
    CHECK_FALSE(table.isColumnHidden(FeaturesModel::PictureShare));
    const QModelIndex cell = table.model()->index(0, FeaturesModel::PictureShare);
    CHECK(cell.data(Qt::EditRole).toDouble() == *saliencyOf(w).share(0));
    const auto isLit = [&w] { return !w.child<QLabel>("pictureSaliencyState").text().contains("not lit"); };
    CHECK(isLit());
    const double before = *saliencyOf(w).share(0);

    SECTION("of another view") {
        drag(w.view(), w.view().rect().center(), w.view().rect().center() + QPoint(120, 40));
        CHECK(saliencyOf(w).state() == SaliencyState::Computing);
        CHECK(*saliencyOf(w).share(0) == before); // of the one before, until the next comes
        w.settle();
        checkShares(w);
        CHECK(*saliencyOf(w).share(0) != before);
    }
    SECTION("of other opacities, and back with an undo") {
        w.document().setTf(withFeatureOpacities(w.document().tf(), {0.02, 0.2, 0.9}), "Opacities");
        w.settle();
        checkShares(w);
        CHECK(*saliencyOf(w).share(0) != before);
        w.child<QAction>("undoAction").trigger();
        w.settle();
        CHECK(*saliencyOf(w).share(0) == before);
    }
    SECTION("of a picture that is not lit") {
        w.child<QAction>("shadingAction").trigger();
        w.settle();
        checkShares(w);
        CHECK_FALSE(isLit());
    }
    SECTION("not of a field, and again after it") {
        w.child<QAction>("fieldAction").trigger();
        CHECK(saliencyOf(w).state() == SaliencyState::Field);
        CHECK_FALSE(saliencyOf(w).share(0));
        w.child<QAction>("fieldAction").trigger();
        w.settle();
        CHECK(*saliencyOf(w).share(0) == before);
    }
    SECTION("until it is switched off") {
        w.child<QAction>("followPictureAction").trigger();
        CHECK(saliencyOf(w).state() == SaliencyState::Off);
        CHECK_FALSE(saliencyOf(w).share(0));
        CHECK(table.isColumnHidden(FeaturesModel::PictureShare));
    }
}

TEST_CASE("a saliency map is laid over the picture that it is of, and saved", "[picture_saliency]") {
    OpenWindow w;
    openPanel(w);
    w.child<QCheckBox>("pictureSaliencyCheck").click();
    const QImage plain = w.picture();
    auto& box = w.child<QComboBox>("pictureSaliencyMap");
    const auto choose = [&](SaliencyMapShown map) {
        const int index = static_cast<int>(map);
        while (box.currentIndex() != index)
            QTest::keyClick(&box, box.currentIndex() < index ? Qt::Key_Down : Qt::Key_Up);
    };
    CHECK_FALSE(saliencyOf(w).map());
    choose(SaliencyMapShown::Picture);
    const QImage mapped = w.picture();
    CHECK(mapped != plain);
    const FeatureSaliency saliency = expected(w);
    REQUIRE(saliencyOf(w).map());
    CHECK(saliencyOf(w).map()->values == saliency.map.values);

    QTemporaryDir folder;
    const auto saved = [&](const QString& name) {
        QSignalSpy spy(&saliencyOf(w), &PictureSaliencyController::saved);
        saliencyOf(w).save(folder.filePath(name));
        REQUIRE(waitFor([&] { return spy.count() == 1; }));
        return readImage(folder.filePath(name).toStdString());
    };
    const Image exr = saved("map.exr");
    REQUIRE(exr.rgba.size() == 4 * saliency.map.values.size());
    CHECK(exr.rgba[4 * 1000] == saliency.map.values[1000]);

    // What a feature has of it is that of the selected one.
    choose(SaliencyMapShown::Feature);
    w.services().selection().setFeature(w.document().tf().features[1].id);
    REQUIRE(saliencyOf(w).map());
    CHECK(saliencyOf(w).map()->values == totalOf(saliency, 1).values);
    w.services().selection().setFeature(w.document().tf().features[2].id);
    CHECK(saliencyOf(w).map()->values == totalOf(saliency, 2).values);
    choose(SaliencyMapShown::Rest);
    CHECK(saliencyOf(w).map()->values == saliency.rest.values);
    // Nothing lies over a picture that it is not of.
    choose(SaliencyMapShown::Picture);
    drag(w.view(), w.view().rect().center(), w.view().rect().center() + QPoint(60, 0));
    CHECK_FALSE(saliencyOf(w).map());
    w.settle();
    CHECK(saliencyOf(w).map());
    choose(SaliencyMapShown::None);
    CHECK_FALSE(saliencyOf(w).map());
    CHECK(saved("map.png").width == w.view().picture().width);
}
