// Fields in the place of the data: chosen, looked at from elsewhere, changed in look, stopped, saved.
#include "gui_support.h"

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSlider>
#include <QTemporaryDir>

#include "controllers/field_controller.h"
#include "render/camera_motion.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

using State = FieldController::State;

FieldController& fieldsOf(OpenWindow& w) { return w.controllers().fields; }
const FieldView& viewOf(OpenWindow& w) { return *w.services().store().session().field; }

/// With the panel of fields in front, so that the view has its size for good.
void openPanel(OpenWindow& w) {
    w.child<QAction>("fieldsAction").trigger();
    w.settle();
    QTest::qWait(100); // docks arrange themselves
    w.settle();
}

void choose(OpenWindow& w, const char* combo, int index) {
    auto& box = w.child<QComboBox>(combo);
    while (box.currentIndex() != index) QTest::keyClick(&box, box.currentIndex() < index ? Qt::Key_Down : Qt::Key_Up);
}

/// What stands around the picture now.
AnnotationInput around(OpenWindow& w) {
    const FieldController& fields = fieldsOf(w);
    return fields.annotation(fields.picture(400, 300), *w.services().store().session().reference);
}

int differing(const QImage& a, const QImage& b, const QRect& where) {
    int count = 0;
    for (int y = where.top(); y <= where.bottom(); ++y)
        for (int x = where.left(); x <= where.right(); ++x) count += a.pixel(x, y) != b.pixel(x, y) ? 1 : 0;
    return count;
}

/// Computed anew, of the present state.
Field expected(OpenWindow& w, FieldKind kind, int feature = -1) {
    Workspace workspace;
    return workspace.field(measureInput(w.services().scene()), kind, feature);
}

} // namespace

TEST_CASE("a field takes the place of the data and gives it back", "[fields]") {
    OpenWindow w;
    openPanel(w);
    const QImage data = w.picture();
    CHECK(fieldsOf(w).state() == State::Off);
    const int steps = w.document().stepCount();
    choose(w, "fieldKindCombo", 1);
    CHECK(viewOf(w).kind == FieldKind::Visibility);
    CHECK(w.document().stepCount() == steps + 1);
    const QImage field = w.picture();
    REQUIRE(fieldsOf(w).state() == State::Current);
    CHECK(fieldsOf(w).field()->volume->samples() == expected(w, FieldKind::Visibility).volume->samples());
    // The volume in the middle, and the legend at the right.
    const QRect middle(data.width() / 3, data.height() / 3, data.width() / 3, data.height() / 3);
    CHECK(differing(data, field, middle) > middle.width() * middle.height() / 3);
    const QRect right(data.width() * 9 / 10, 10, data.width() / 10 - 1, data.height() / 3);
    CHECK(differing(data, field, right) > 200);
    CHECK(around(w).title == "Visibility");

    w.child<QAction>("undoAction").trigger();
    CHECK(fieldsOf(w).state() == State::Off);
    CHECK(fieldsOf(w).field() == nullptr); // at once
    CHECK(w.picture() == data);
    // The key brings it back, and takes it away. Keys are for the window that is active.
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    QTest::keyClick(&w.view(), Qt::Key_V);
    CHECK(viewOf(w).kind == FieldKind::Visibility);
    CHECK(w.picture() == field);
    QTest::keyClick(&w.view(), Qt::Key_V);
    CHECK(w.picture() == data);
}

TEST_CASE("a field of an earlier view is drawn as that until its own is there", "[fields]") {
    OpenWindow w;
    openPanel(w);
    choose(w, "fieldKindCombo", 5);
    const QImage first = w.picture();
    REQUIRE(fieldsOf(w).state() == State::Current);
    const std::shared_ptr<const Volume> before = fieldsOf(w).field()->volume;
    drag(w.view(), w.view().rect().center(), w.view().rect().center() + QPoint(120, 10));
    CHECK(fieldsOf(w).state() == State::Computing);
    REQUIRE(fieldsOf(w).field() != nullptr);
    CHECK(fieldsOf(w).field()->volume == before);
    CHECK(around(w).title.find("of an earlier state") != std::string::npos);
    CHECK_FALSE(w.child<QPushButton>("fieldSave").isEnabled());
    const QImage turned = w.picture();
    CHECK(fieldsOf(w).state() == State::Current);
    CHECK(fieldsOf(w).field()->volume->samples() == expected(w, FieldKind::Vws).volume->samples());
    CHECK(around(w).title == "Visibility-weighted saliency");
    CHECK(turned != first);

    // Saliency is the same from everywhere.
    choose(w, "fieldKindCombo", 2);
    const QImage saliency = w.picture();
    CHECK(saliency != turned);
    const std::shared_ptr<const Volume> same = fieldsOf(w).field()->volume;
    QTest::keyClick(&w.view(), Qt::Key_Left);
    CHECK(fieldsOf(w).state() == State::Current);
    CHECK(w.picture() != saliency);
    CHECK(fieldsOf(w).field()->volume == same);
    // With other colours it is another one.
    TransferFunction tf = w.document().tf();
    for (ControlPoint& p : tf.points) p.color = {0.2, 0.5, 0.9};
    w.document().setTf(tf, "Colours");
    CHECK(fieldsOf(w).state() == State::Computing);
    w.settle();
    CHECK(fieldsOf(w).field()->volume != same);
}

TEST_CASE("a field of one feature, its colours, strength, threshold and top", "[fields]") {
    OpenWindow w;
    openPanel(w);
    choose(w, "fieldKindCombo", 1);
    const QImage all = w.picture();
    const double top = fieldsOf(w).field()->top;
    choose(w, "fieldFeatureCombo", 2);
    CHECK(viewOf(w).feature == w.document().tf().features[1].id);
    const QImage one = w.picture();
    CHECK(one != all);
    CHECK(fieldsOf(w).field()->volume->samples() == expected(w, FieldKind::Visibility, 1).volume->samples());
    CHECK(fieldsOf(w).field()->top == top);
    CHECK(around(w).title == "Visibility, f2");

    // The look changes without computing.
    const std::shared_ptr<const Volume> values = fieldsOf(w).field()->volume;
    auto& colors = w.child<QComboBox>("fieldColorMapCombo");
    choose(w, "fieldColorMapCombo", colors.count() - 1);
    CHECK(viewOf(w).colorMap == kFeatureColorMap);
    const QImage coloured = w.picture();
    CHECK(coloured != one);
    const int steps = w.document().stepCount();
    auto& strength = w.child<QSlider>("fieldStrengthSlider");
    strength.setSliderDown(true); // as a hand holds it
    strength.setValue(150);
    CHECK(w.document().isPreviewing());
    strength.setValue(190);
    strength.setSliderDown(false);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(viewOf(w).strength == Approx(std::pow(0.001, 0.05))); // 190 of 200 steps, logarithmic
    const QImage strong = w.picture();
    CHECK(strong != coloured);
    auto& threshold = w.child<QDoubleSpinBox>("fieldThreshold");
    threshold.selectAll();
    QTest::keyClicks(&threshold, "40");
    QTest::keyClick(&threshold, Qt::Key_Return);
    CHECK(viewOf(w).threshold == Approx(0.4));
    const QImage above = w.picture();
    CHECK(above != strong);
    auto& topEdit = w.child<QLineEdit>("fieldTop");
    topEdit.selectAll();
    QTest::keyClicks(&topEdit, "0.05");
    QTest::keyClick(&topEdit, Qt::Key_Return);
    REQUIRE(viewOf(w).top);
    CHECK(*viewOf(w).top == 0.05);
    CHECK(around(w).window == ValueRange{0, 0.05});
    CHECK(w.picture() != above);
    w.child<QPushButton>("fieldUsualTop").click();
    CHECK_FALSE(viewOf(w).top);
    CHECK(w.picture() == above);
    CHECK(fieldsOf(w).field()->volume == values);
}

TEST_CASE("computing a field is stopped, and begun again", "[fields]") {
    OpenWindow w(64);
    openPanel(w);
    const QImage data = w.picture();
    // Far longer than anyone waits.
    w.services().store().edit("Engine", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Reference; });
    });
    w.services().results().setPaused(true);
    choose(w, "fieldKindCombo", 1);
    CHECK(fieldsOf(w).state() == State::Computing);
    REQUIRE(waitFor([&] { return fieldsOf(w).progress() > 0; }));
    CHECK(around(w).title == "Visibility: being computed");
    w.child<QPushButton>("fieldStop").click();
    CHECK(fieldsOf(w).state() == State::Stopped);
    CHECK_FALSE(fieldsOf(w).isBusy());
    CHECK(around(w).title == "Visibility: stopped");
    CHECK(fieldsOf(w).field() == nullptr);
    w.services().store().edit("Engine", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    });
    w.services().results().setPaused(false);
    w.settle();
    CHECK(fieldsOf(w).state() == State::Current);
    CHECK(w.picture() != data);
    choose(w, "fieldKindCombo", 0);
    CHECK(w.picture() == data);
}

TEST_CASE("a field is saved, with the session and in a picture", "[fields]") {
    QTemporaryDir folder;
    OpenWindow w;
    openPanel(w);
    choose(w, "fieldKindCombo", 5);
    w.settle();
    QSignalSpy saved(&fieldsOf(w), &FieldController::saved);
    const QString path = folder.filePath("vws.nrrd");
    fieldsOf(w).save(path);
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    VolumeSource source;
    source.path = path.toStdString();
    CHECK(loadVolume(source).samples() == fieldsOf(w).field()->volume->samples());

    // The picture that is saved is the one that is seen.
    QSignalSpy pictures(&w.saving(), &SaveController::imageSaved);
    const QString file = folder.filePath("field.png"), other = folder.filePath("data.png");
    w.saving().saveImage({file, {200, 150}, false, true});
    REQUIRE(waitFor([&] { return pictures.count() == 1; }));
    const QString session = folder.filePath("s.pellucid.json");
    REQUIRE(w.saving().saveSession(session));
    choose(w, "fieldKindCombo", 0);
    w.saving().saveImage({other, {200, 150}, false, true});
    REQUIRE(waitFor([&] { return pictures.count() == 2; }));
    CHECK(QImage(file) != QImage(other));

    // The session shows the field again.
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.services().store().setClean();
    w.opening().openPath(session);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(viewOf(w).kind == FieldKind::Vws);
    CHECK(fieldsOf(w).state() == State::Current);
    CHECK(w.child<QComboBox>("fieldKindCombo").currentIndex() == 5);
    CHECK(loadVolume(source).samples() == fieldsOf(w).field()->volume->samples());
}
