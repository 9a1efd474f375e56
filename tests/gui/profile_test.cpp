// The published definitions in the window: figures of the grid's face, whatever the picture shows.
#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>

#include "gui_support.h"
#include "optimize/refine/refine.h"
#include "render/published_engine.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// As a hand picks an entry: the list opens, arrow keys go there, Enter takes it.
void pick(QComboBox& box, const QString& text) {
    const int wanted = box.findText(text);
    REQUIRE(wanted >= 0);
    box.setFocus();
    const int steps = wanted - box.currentIndex();
    for (int i = 0; i < std::abs(steps); ++i) QTest::keyClick(&box, steps > 0 ? Qt::Key_Down : Qt::Key_Up);
    REQUIRE(box.currentIndex() == wanted);
}

/// Brightness of a picture's pixels, added.
double light(const QImage& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += qGray(image.pixel(x, y));
    return sum;
}

const char* const kTent = R"(<VoreenData><TransFuncIntensity><Keys>
    <key><intensity value="0.2"/><split value="false"/><colorL r="255" g="0" b="0" a="0"/></key>
    <key><intensity value="0.4"/><split value="false"/><colorL r="255" g="0" b="0" a="102"/></key>
    <key><intensity value="0.6"/><split value="false"/><colorL r="255" g="0" b="0" a="0"/></key>
    </Keys></TransFuncIntensity></VoreenData>)";

} // namespace

TEST_CASE("the window measures by the published definitions", "[window][published]") {
    OpenWindow w;
    Document document = w.document();
    w.services().panels().show("settings");
    w.settle();
    auto& profile = w.child<QComboBox>("profileCombo");
    auto& along = w.child<QComboBox>("alongCombo");
    auto& look = w.child<QPushButton>("lookAlongButton");
    CHECK_FALSE(along.isVisible());
    CHECK_FALSE(look.isVisible());
    const QImage before = w.picture();
    const Measures own = *document.measures();

    pick(profile, "Published");
    w.settle();
    CHECK(w.services().scene().session.measure->profile == Profile::Published);
    CHECK(along.isVisible());
    CHECK(w.child<QLabel>("profileRemark").text().contains("front"));
    CHECK(w.picture() == before); // the picture is none of its business
    const Measures published = *document.measures();
    CHECK(published.features[0].vws == Approx(Workspace().measure(measureInput(w.services().scene())).features[0].vws));
    CHECK_FALSE(published.features[0].vws == own.features[0].vws);

    pick(along, "top");
    w.settle();
    CHECK(w.services().scene().session.measure->along == Along::Top);
    // A turned picture has the same figures.
    document.setCamera(cameraFromView(document.volume()->geometry(), 70, 20, 1, Projection::Perspective));
    CHECK(document.measuresAreCurrent());

    QTest::mouseClick(&look, Qt::LeftButton);
    w.settle();
    CHECK(document.camera() == cameraAlong(document.volume()->geometry(), Along::Top));
    CHECK_FALSE(look.isVisible());
    CHECK_FALSE(w.picture() == before);
    CHECK(light(w.picture()) > 0.05 * light(before)); // the volume is in it

    document.undo(); // the choices in a row are one step
    w.settle();
    CHECK(w.services().scene().session.measure->profile == Profile::Default);
    CHECK(profile.currentText() == "Pellucid's");
}

TEST_CASE("the window refines by the published definitions", "[window][published]") {
    OpenWindow w;
    const TransferFunction before = w.document().tf();
    auto& remark = w.child<QLabel>("refineProfile");
    auto& step = w.child<QDoubleSpinBox>("refineStepDown");
    CHECK(remark.isHidden());
    CHECK_FALSE(step.isHidden());
    pick(w.child<QComboBox>("profileCombo"), "Published");
    w.settle();
    CHECK_FALSE(remark.isHidden());
    CHECK(step.isHidden()); // the profile has steps of its own
    w.child<QAction>("refineAction").trigger();
    w.settle();
    RefineOptions by;
    by.profile = Profile::Published;
    by.stepDown = kPublishedStep;
    by.stepUp = kPublishedStep;
    const RefineResult expected = refine(w.document().histogram(), before, by);
    REQUIRE(expected.iterations > 0);
    for (std::size_t i = 0; i < before.points.size(); ++i)
        CHECK(w.document().tf().points[i].opacity == Approx(expected.tf.points[i].opacity));
    CHECK(w.child<QLabel>("panelMessage").text().contains("By the published definitions."));
    CHECK_FALSE(refine(w.document().histogram(), before).tf == expected.tf);
}

TEST_CASE("a transfer function of Voreen opens in the window", "[window][published]") {
    OpenWindow w;
    Document document = w.document();
    const QImage before = w.picture();
    const test::TempFolder folder;
    const QString path = QString::fromStdString(folder.write("one.tfi", kTent));
    w.opening().openPath(path);
    w.settle();
    REQUIRE(document.tf().features.size() == 1);
    CHECK(document.tf().features[0].a == 0.2);
    CHECK(document.tf().opacity(0.4) == Approx(0.4)); // 102/255
    CHECK_FALSE(w.picture() == before);
    CHECK(w.saving().tfPath().isEmpty()); // saving asks for a name of its own
}
