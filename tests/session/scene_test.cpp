// From names to what is drawn and measured: which window holds, where the curve lies, and what is shared.
#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/views/opening_view.h"
#include "render/camera_motion.h"
#include "session/scene.h"
#include "support/outlier_boxes.h"
#include "support/temp_folder.h"
#include "support/volumes.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// 0 … 215 as a u8 volume of 6³ voxels.
std::string ramp() {
    std::string bytes;
    for (int i = 0; i < 216; ++i) bytes += static_cast<char>(i);
    return bytes;
}

VolumeSource rawSource(const std::string& path) {
    VolumeSource source;
    source.path = path;
    source.raw = RawLayout{{6, 6, 6}, SampleType::U8, false, 0};
    return source;
}

/// A tent from 60 to 140 data units, in a file whose range is −100 … 300.
TransferFunction tentInDataUnits() {
    TransferFunction tf;
    tf.range = ValueRange{-100, 300};
    tf.points = {{0.4, 0, {1, 0, 0}, true, {}}, {0.5, 0.5, {1, 0, 0}, false, {}}, {0.6, 0, {1, 0, 0}, true, {}}};
    tf.features = {{"tent", 0.4, 0.6, {1, 0, 0}, {}}};
    return tf;
}

struct SceneFiles {
    TempFolder folder;
    std::string volume = folder.write("v.raw", ramp());
    std::string tf = folder.path("a.tf.json");
    SceneFiles() { writeTf(tentInDataUnits(), tf); }

    SceneInputs inputs() const {
        SceneInputs inputs;
        inputs.session = sessionOf(rawSource(volume));
        return inputs;
    }
    Session withWindow(const ValueRange& window) const {
        Session s = sessionOf(rawSource(volume));
        s.variables.edit([&](std::vector<Variable>& all) { all[0].window = window; });
        return s;
    }
};

double dataValue(double x, const Scene& scene) { return scene.volume->valueOfIntensity(x); }

} // namespace

TEST_CASE("the window: what is asked for, else the TF file's, else the session's, else the data's", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    Scene scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{0, 215});
    CHECK(scene.volume == scene.data);
    CHECK_FALSE(scene.session.variable().window);
    CHECK(scene.tf.range == ValueRange{0, 215});

    in.session = files.withWindow({10, 110});
    scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{10, 110});
    CHECK(scene.data->range() == ValueRange{0, 215});

    in.tf = files.tf;
    scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{-100, 300});
    CHECK(scene.session.variable().window == ValueRange{-100, 300});

    in.range = ValueRange{0, 100};
    scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{0, 100});
    CHECK(scene.tf.range == ValueRange{0, 100});
}

TEST_CASE("a transfer function keeps its data values whatever the window is", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    in.tf = files.tf;
    for (const std::optional<ValueRange> range :
         {std::optional<ValueRange>{}, std::optional<ValueRange>{{0, 215}}, std::optional<ValueRange>{{-1000, 1000}}}) {
        in.range = range;
        const Scene scene = openScene(in);
        REQUIRE(scene.tf.features.size() == 1);
        CHECK(dataValue(scene.tf.features[0].a, scene) == Approx(60));
        CHECK(dataValue(scene.tf.features[0].b, scene) == Approx(140));
        CHECK(scene.tf.opacity((100 - scene.volume->range().lo) /
                               (scene.volume->range().hi - scene.volume->range().lo)) == Approx(0.5));
        // The session's own stays as the file has it.
        CHECK(scene.session.tf()->range == ValueRange{-100, 300});
        CHECK(scene.session.tf()->points == tentInDataUnits().points);
    }
    // Cut where the window ends
    in.range = ValueRange{100, 215};
    const Scene cut = openScene(in);
    CHECK(cut.tf.features[0].a == 0);
    CHECK(cut.tf.opacity(0) == Approx(0.5));
}

TEST_CASE("a transfer function that says of no values is of the window", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    in.tf = "tents:3";
    in.range = ValueRange{50, 60};
    Scene scene = openScene(in);
    CHECK(scene.tf.points == tents(3).points);
    CHECK(scene.tf.range == ValueRange{50, 60});
    CHECK(scene.session.tf()->range == ValueRange{50, 60});

    TransferFunction bare = tentInDataUnits();
    bare.range.reset();
    writeTf(bare, files.tf);
    in.tf = files.tf;
    in.range.reset();
    in.session = files.withWindow({10, 110});
    scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{10, 110});
    CHECK(scene.tf.points == bare.points);

    // From then on it stays at these values.
    Session session = scene.session;
    session.variables.edit([](std::vector<Variable>& all) { all[0].window = ValueRange{10, 210}; });
    const Scene wider = resolve(session, scene);
    CHECK(dataValue(wider.tf.features[0].a, wider) == Approx(50)); // 10 + 0.4·100
    CHECK(wider.tf.features[0].a == Approx(0.2));
}

TEST_CASE("a session's transfer function is found again through another window", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    in.tf = files.tf;
    const Scene saved = openScene(in);
    SceneInputs again;
    again.session = saved.session;
    again.range = ValueRange{0, 215};
    const Scene scene = openScene(again);
    CHECK(dataValue(scene.tf.features[0].a, scene) == Approx(60));
    CHECK(scene.tf.features[0].id == saved.tf.features[0].id);
    again.tf = "tents:3";
    again.range.reset();
    CHECK(openScene(again).volume->range() == ValueRange{-100, 300}); // the session's
}

TEST_CASE("data of one value alone can be opened", "[session]") {
    const SceneFiles files;
    SceneInputs in;
    in.session = sessionOf(rawSource(files.folder.write("constant.raw", std::string(216, '\7'))));
    Scene scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{7, 7});
    CHECK(scene.tf.opacity(0) > 0); // all intensities are 0, and something is to be seen
    CHECK_FALSE(scene.tf.range);    // no two values for 0 and 1
    CHECK(scene.tf.features[0].id != 0);
    in.tf = files.tf;
    scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{-100, 300});
    CHECK(scene.tf.points == tentInDataUnits().points);
    in.range = ValueRange{0, 10};
    CHECK(openScene(in).volume->range() == ValueRange{0, 10});
}

namespace {

/// The boxes of tests/support, as something to open.
SceneInputs inputsOfBoxes(const TempFolder& folder) {
    SceneInputs inputs;
    inputs.session = sessionOf(boxesWithOutlier(folder));
    return inputs;
}

} // namespace

TEST_CASE("a volume that brings nothing opens by what its data propose", "[session]") {
    const TempFolder folder;
    SceneInputs in = inputsOfBoxes(folder);
    const Scene scene = openScene(in);
    REQUIRE(scene.proposal);
    // The one wild voxel does not stretch the window: 200 lies in its upper half.
    CHECK(scene.data->range() == ValueRange{0, 1e6});
    CHECK(scene.volume->range() == scene.proposal->window);
    CHECK(scene.volume->range().hi < 400);
    CHECK(scene.session.variable().window == scene.proposal->window);
    CHECK(scene.tf.range == scene.proposal->window);
    CHECK(scene.tf.features == scene.proposal->tf.features);
    CHECK(scene.tf.features.front().id != 0);
    CHECK(scene.tf.opacity(scene.volume->intensityOfValue(0)) == 0); // background
    CHECK(scene.tf.opacity(scene.volume->intensityOfValue(90)) > 0);
    CHECK(scene.tf.opacity(scene.volume->intensityOfValue(200)) > 0);

    // Shown first, tuned afterwards: the same in the end.
    in.start = SceneInputs::Start::Proposed;
    const Scene first = openScene(in);
    // Targets are what the start aims at, not equal shares.
    const std::vector<double> shares = tunedStart(first).shares, targets = scene.targets();
    REQUIRE(shares.size() == scene.tf.features.size());
    REQUIRE(targets.size() == shares.size());
    for (std::size_t f = 0; f < shares.size(); ++f) CHECK(targets[f] == Approx(shares[f]));
    CHECK(std::abs(targets[0] - targets[1]) > 0.05);
    CHECK(first.targets()[0] == first.targets()[1]); // nothing is aimed at yet
    // Those that somebody has set stay.
    Session wanted = first.session;
    wanted.goals.set(withTargets(*wanted.goals, first.tf, {0.9, 0.1}));
    setStart(wanted, tunedStart(first));
    CHECK(targetsOf(*wanted.tf(), *wanted.goals)[0] == Approx(0.9));
    CHECK(first.tf.points == scene.proposal->tf.points);
    CHECK(tunedStart(first).tf == scene.tf);
    // Not from where one happens to look: a volume has one automatic start.
    in.view = ViewAngles{120, -40, 3};
    CHECK(tunedStart(openScene(in)).tf == scene.tf);
    in.view.reset();
    // Asked for, whatever the session has.
    in.start = SceneInputs::Start::Tuned;
    in.session.setTf(tents(5));
    in.session.variables.edit([](std::vector<Variable>& all) { all[0].window = ValueRange{0, 10}; });
    CHECK(openScene(in).tf.features.size() == 5);
    CHECK_FALSE(openScene(in).proposal);
    in.tf = kAutomaticTf;
    CHECK(openScene(in).tf == scene.tf);
    CHECK(openScene(in).volume->range() == scene.volume->range());
    // Who needs none gets none.
    SceneInputs bare = inputsOfBoxes(folder);
    bare.start = SceneInputs::Start::Tents;
    CHECK(openScene(bare).volume->range() == ValueRange{0, 1e6});
    CHECK_FALSE(openScene(bare).proposal);
}

TEST_CASE("a range that is asked for is the window of an automatic start, too", "[session]") {
    const TempFolder folder;
    SceneInputs in = inputsOfBoxes(folder);
    in.range = ValueRange{-50, 250};
    const Scene scene = openScene(in);
    CHECK(scene.volume->range() == ValueRange{-50, 250});
    CHECK(scene.tf.range == ValueRange{-50, 250});
    CHECK(scene.tf.opacity(scene.volume->intensityOfValue(200)) > 0);
    CHECK(scene.tf.opacity(scene.volume->intensityOfValue(0)) == 0);
}

TEST_CASE("a session keeps the transfer function that was found for it", "[session]") {
    const TempFolder folder;
    const Scene opened = openScene(inputsOfBoxes(folder));
    SceneInputs again;
    again.session = opened.session;
    const Scene scene = openScene(again);
    CHECK(scene.tf == opened.tf);
    CHECK(scene.volume->range() == opened.volume->range());
    CHECK_FALSE(scene.proposal); // nothing was proposed
    CHECK_FALSE(resolve(opened.session, opened).proposal);
}

TEST_CASE("an automatic start again is one for the view that it is asked for", "[session]") {
    const TempFolder folder;
    SceneInputs in = inputsOfBoxes(folder);
    const Scene automatic = openScene(in);
    in.tf = "tents:4";
    const Scene other = openScene(in);
    CHECK(other.volume->range() == ValueRange{0, 1e6});
    const AutomaticStart home = automaticStart(other, View(automatic.camera));
    CHECK(home.window == automatic.session.variable().window);
    CHECK(home.sight.tf.points == automatic.tf.points);
    // With the outer box cut away in front, the inner one needs less to be seen as much.
    View cut(automatic.camera);
    cut.clipping.lo = {0, 0.5, 0};
    CHECK(automaticStart(other, cut).sight.tf.points != automatic.tf.points);
}

TEST_CASE("nothing to open is wrong usage", "[session]") {
    CHECK_THROWS_AS(openScene({}), UsageError);
    const Scene empty = resolve({}, {});
    CHECK(empty.data == nullptr);
    CHECK_FALSE(needsData({}, empty));
}

TEST_CASE("the camera: what is asked for, else the session's, else the home view", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    const Scene home = openScene(in);
    const Geometry geometry = home.volume->geometry();
    const Camera opening = openingView(*home.volume, home.proposal->tf, {}).camera;
    CHECK(home.camera == opening);
    CHECK_FALSE(home.session.camera);
    in.projection = Projection::Orthographic;
    CHECK(openScene(in).camera == withProjection(opening, geometry, Projection::Orthographic));
    in.tf = "tents:3"; // the same view for all that somebody gives
    CHECK(openScene(in).camera == homeCamera(geometry, Projection::Orthographic));
    in.tf.reset();
    in.view = ViewAngles{10, 20, 3};
    CHECK(openScene(in).camera == cameraFromView(geometry, 10, 20, 3, Projection::Orthographic));
    in.projection.reset();

    const Camera saved = cameraFromView(geometry, -40, 5, 1, Projection::Perspective);
    in.session.camera = saved;
    Scene scene = openScene(in);
    CHECK(scene.camera == cameraFromView(geometry, 10, 20, 3, Projection::Perspective));
    CHECK(scene.session.camera == scene.camera);
    in.view.reset();
    CHECK(openScene(in).camera == saved);
    in.projection = Projection::Orthographic;
    CHECK(openScene(in).camera == withProjection(saved, geometry, Projection::Orthographic));
    in.projection.reset();
    in.camera = cameraFromView(geometry, 90, 0, 1, Projection::Orthographic);
    in.cameraName = "side.camera.json";
    CHECK(openScene(in).camera == *in.camera);

    in.camera->projection = Projection::Perspective;
    in.camera->eye = geometry.boxCenter() + Vec3(0.1, 0, 0);
    try {
        openScene(in);
        FAIL("a camera inside the box");
    } catch (const Error& e) {
        CHECK(e.where() == "side.camera.json");
    }
    // One that is not used does no harm.
    in.session.camera = in.camera;
    in.camera.reset();
    CHECK_THROWS_AS(openScene(in), Error);
    in.view = ViewAngles{0, 0, 1};
    CHECK_NOTHROW(openScene(in));
}

TEST_CASE("what has not changed is not made again", "[session]") {
    const SceneFiles files;
    const Scene first = openScene(files.inputs());
    Session session = first.session;
    CHECK_FALSE(needsData(session, first));

    Scene next = resolve(session, first);
    CHECK(next.data == first.data);
    CHECK(next.volume == first.volume);
    CHECK(next.tf == first.tf);
    CHECK(next.session.variables.isSame(first.session.variables));

    session.camera = cameraFromView(first.volume->geometry(), 1, 2, 3, Projection::Perspective);
    session.setTf(tents(5));
    CHECK_FALSE(needsData(session, first));
    next = resolve(session, first);
    CHECK(next.data == first.data);
    CHECK(next.volume == first.volume);
    CHECK(next.tf.features.size() == 5);
    CHECK(next.camera == *session.camera);

    session.variables.edit([](std::vector<Variable>& all) { all[0].window = ValueRange{20, 100}; });
    CHECK(needsData(session, next));
    const Scene windowed = resolve(session, next);
    CHECK(windowed.data == first.data);
    CHECK(windowed.volume != first.volume);
    CHECK(windowed.volume->range() == ValueRange{20, 100});
    CHECK(&windowed.volume->samples() == &first.volume->samples()); // not copied
    CHECK(windowed.tf.range == ValueRange{20, 100});

    session.variables.edit([](std::vector<Variable>& all) { all[0].source.missing = 3; });
    CHECK(needsData(session, windowed));
    CHECK(resolve(session, windowed).data != first.data);
}

TEST_CASE("codes are shared by all who hold a volume in its window", "[session]") {
    const SceneFiles files;
    const Scene scene = openScene(files.inputs());
    auto one = sharedIntensityGrid(*scene.volume);
    const auto two = sharedIntensityGrid(*scene.volume);
    CHECK(one == two);
    const Volume copy = *scene.volume;
    CHECK(sharedIntensityGrid(copy) == one);
    const Volume windowed = scene.volume->withRange({0, 100});
    CHECK(sharedIntensityGrid(windowed) != one);
    CHECK_FALSE(scene.volume->sharedCodes().grid.expired());
}

TEST_CASE("a picture is made of what the session shows", "[session]") {
    const SceneFiles files;
    SceneInputs in = files.inputs();
    in.tf = "tents:3";
    Scene scene = openScene(in);
    scene.session.display = DisplaySettings{
        RenderMode::Mip, Light{.on = true, .occlusion = 0.5}, {0.1, 0.2, 0.3}, Rgb{1, 1, 1}, scene.tf.features[1].id};
    scene.session.clipping = Clipping{{0, 0.25, 0}, {1, 1, 0.5}, {{{1, 2, 3}, 4}}};
    scene.session.measure.edit([](MeasureSettings& m) { m.quality = Quality::High; });
    PictureInput picture = pictureInput(scene, 40, 30);
    RenderSettings expected;
    expected.width = 40;
    expected.height = 30;
    expected.background = Rgb{0.1, 0.2, 0.3};
    expected.stepInD0 = 0.25;
    expected.backgroundTop = Rgb{1, 1, 1};
    expected.mode = RenderMode::Mip;
    expected.light = Light{.on = true, .occlusion = 0.5};
    expected.clipping = *scene.session.clipping;
    expected.onlyFeature = 1;
    expected.finestInD0 = 1.0 / 16;
    CHECK(picture.settings == expected);
    scene.session.display.edit([](DisplaySettings& d) { d.finestStep = 0.25; });
    CHECK(pictureInput(scene, 40, 30).settings.finestInD0 == 0.25);
    CHECK(picture.volume == scene.volume);
    CHECK(picture.tf == scene.tf);
    CHECK(picture.camera == scene.camera);
    CHECK_FALSE(pictureInput(scene, 40, 30, true).settings.background);
    // A feature that has left the transfer function is not drawn alone.
    Session fewer = scene.session;
    fewer.setTf(tents(1));
    scene = resolve(fewer, scene);
    CHECK(pictureInput(scene, 40, 30).settings.onlyFeature == -1);
    CHECK(measureInput(scene).settings == *scene.session.measure);
    CHECK(measureInput(scene).view.clipping == *scene.session.clipping); // figures are of what is left
    CHECK(pictureInput(resolve({}, {}), 4, 3).volume == nullptr);
}
