// Fields of a scene: computed in a workspace, drawn in the place of the data.
#include <numeric>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "engines/engines.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

Scene sampleScene(const std::string& tf) {
    SceneInputs in;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 20;
    in.session = sessionOf(source);
    in.tf = tf;
    in.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return openScene(in);
}

double sum(const Field& field) {
    double total = 0;
    for (std::size_t i = 0; i < field.volume->size(); ++i) total += field.volume->value(i);
    return total;
}

} // namespace

TEST_CASE("fields of features sum to the figures", "[session][fields]") {
    const MeasureInput input = measureInput(sampleScene("tents:3:0.1"));
    Workspace workspace;
    const Measures measures = workspace.measure(input);
    const Field visibility = workspace.field(input, FieldKind::Visibility);
    const Field vws = workspace.field(input, FieldKind::Vws);
    CHECK(sum(vws) == Approx(1).margin(1e-5));
    for (int f = 0; f < 3; ++f) {
        const FeatureMeasures& m = measures.features[static_cast<std::size_t>(f)];
        const Field part = workspace.field(input, FieldKind::Visibility, f);
        CHECK(sum(part) / sum(visibility) == Approx(m.visibility).margin(1e-5));
        CHECK(sum(workspace.field(input, FieldKind::Vws, f)) == Approx(m.vws).margin(1e-5));
        CHECK(part.top == visibility.top); // features compare
        CHECK(part.volume->title == "Visibility, f" + std::to_string(f + 1));
    }
    // Whatever was computed before.
    Workspace fresh;
    const Field again = fresh.field(input, FieldKind::Vws);
    CHECK(again.volume->samples() == vws.volume->samples());
}

TEST_CASE("a field is stopped, and refused where memory does not suffice", "[session][fields]") {
    const MeasureInput input = measureInput(sampleScene("tents:3"));
    Workspace workspace;
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(workspace.field(input, FieldKind::Vws, -1, {stop.get_token(), {}}), Cancelled);
    workspace.measure(input); // engine and weights are there: what is asked for is the field's own
    setMemoryLimit(1);
    CHECK_THROWS_WITH(workspace.field(input, FieldKind::Vws), Catch::Contains("a field of 20 x 20 x 20"));
    setMemoryLimit({});
    CHECK(workspace.field(input, FieldKind::Vws).top > 0);
}

TEST_CASE("a field is drawn from its threshold to its top", "[session][fields]") {
    FieldView view;
    view.kind = FieldKind::Visibility;
    view.colorMap = "grey";
    view.strength = 0.4;
    view.threshold = 0.2;
    const TransferFunction tf = fieldTf(view, {});
    CHECK(tf.opacity(0.1) == 0);
    CHECK(tf.opacity(0.2) == Approx(0));
    CHECK(tf.opacity(0.6) == Approx(0.2)); // half the way from 0.2 to 1
    CHECK(tf.opacity(1) == Approx(0.4));
    CHECK(tf.color(1).r == Approx(1).margin(0.01));
    const TransferFunction slice = fieldSliceTf(tf);
    CHECK(slice.opacity(0.19) == 0);
    CHECK(slice.opacity(0.21) == 1);

    // In the colour of a feature: it stands half-way.
    Feature red{"red", 0, 1, {0.8, 0.1, 0.1}, {}};
    red.id = 7;
    view.colorMap = kFeatureColorMap;
    view.feature = 7;
    const std::vector<Feature> features{red};
    const TransferFunction own = fieldTf(view, features);
    CHECK(own.color(0.5) == red.color);
    CHECK(own.color(1) == Rgb{1, 1, 1});
    CHECK(own.opacity(0.6) == Approx(0.2));

    // The values 0 … top of a field lie below intensity top / largest of its volume.
    Scene scene = sampleScene("tents:3:0.1");
    view.feature = 0;
    view.colorMap = "grey";
    view.top = 0.05;
    scene.session.field.set(view);
    Grid<float> values(scene.volume->dims());
    values[0] = 0.1f;
    const Field field = fieldVolume(scene.volume->geometry(), values, 0.08, "Visibility");
    const PictureInput picture = fieldPictureInput(scene, field, 32, 24);
    CHECK(picture.tf.opacity(0.05) == 0);           // 0.005, a tenth of the top
    CHECK(picture.tf.opacity(0.3) == Approx(0.2));  // 0.03 is 0.6 of the top
    CHECK(picture.tf.opacity(0.75) == Approx(0.4)); // above the top
    CHECK(picture.camera == scene.camera);
    CHECK(picture.settings.width == 32);
    CHECK_FALSE(picture.settings.light.on);
    const AnnotationInput around = fieldAnnotationInput(picture, scene, field, AnnotationChoice::none());
    CHECK(around.window == ValueRange{0, 0.05});
    CHECK(around.show.legend);
    CHECK(around.title == "Visibility");
    // A top beyond all values: the colours are cut off, not squeezed.
    scene.session.field.edit([](FieldView& f) { f.top = 0.2; });
    CHECK(fieldPictureInput(scene, field, 32, 24).tf.opacity(1) == Approx(0.4 * (0.5 - 0.2) / 0.8));
}

TEST_CASE("the picture of a field is of the same view, other than that of the data", "[session][fields]") {
    Scene scene = sampleScene("tents:3:0.1");
    scene.session.field.edit([](FieldView& f) { f.kind = FieldKind::Visibility; });
    Workspace workspace;
    const Field field = workspace.field(measureInput(scene), FieldKind::Visibility);
    const auto drawn = [](const PictureInput& in) {
        return makeRenderer(EngineChoice::Cpu, in.volume)->render(in.camera, in.tf, in.settings);
    };
    const Image data = drawn(pictureInput(scene, 48, 48));
    const Image a = drawn(fieldPictureInput(scene, field, 48, 48));
    CHECK(a.rgba != data.rgba);
    // Nothing but the background in the corner, something in the middle.
    CHECK(a.pixel(0, 0)[0] == 0);
    CHECK(a.pixel(24, 24)[0] > 0.02f);
}

TEST_CASE("fields that depend on no view are asked for without one", "[session][fields]") {
    Scene scene = sampleScene("tents:2:0.3");
    const auto inputOf = [&](FieldKind kind) {
        scene.session.field.edit([&](FieldView& f) { f.kind = kind; });
        return fieldInput(scene);
    };
    const MeasureInput seen = inputOf(FieldKind::Visibility), vws = inputOf(FieldKind::Vws);
    CHECK(seen.tf == measureInput(scene).tf);
    CHECK(vws.settings == measureInput(scene).settings);
    for (const FieldKind kind : allOf<FieldKind>())
        if (!dependsOnView(kind)) {
            const MeasureInput input = inputOf(kind);
            CHECK(input.view == View{});
            for (const ControlPoint& point : input.tf.points) CHECK(point.opacity == 0);
        }
}
