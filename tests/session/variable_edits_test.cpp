// What people do to variables and channels.
#include <catch2/catch.hpp>

#include "base/error.h"
#include "render/clipping.h"
#include "session/variable_edits.h"

using namespace pellucid;

namespace {

Variable plain(const std::string& name) {
    Variable v;
    v.name = name;
    v.source.path = name + ".nrrd";
    return v;
}

Variable derived(const std::string& name, const std::string& text) {
    Variable v;
    v.name = name;
    v.derivation = parseDerivation(text);
    return v;
}

Session cloudAndRain() {
    Session s;
    s.variables = std::vector<Variable>{plain("cloud"), plain("rain")};
    s.hsb.edit([](HsbMapping& h) {
        h.on = true;
        h.saturation = "volatility:cloud:10";
        h.brightness = "rain";
        h.hue = "cloud";
    });
    return s;
}

std::vector<std::string> namesOf(const Session& s) {
    std::vector<std::string> names;
    for (const Variable& v : *s.variables) names.push_back(v.name);
    return names;
}

using Names = std::vector<std::string>;

} // namespace

TEST_CASE("swapping opacity and brightness swaps all channels, and back", "[variables]") {
    Session s = cloudAndRain();
    swapOpacityAndBrightness(s);
    CHECK(namesOf(s) == Names{"rain", "cloud"});
    CHECK(s.hsb->saturation == "volatility:rain:10"); // of what is drawn, as in fig. 6.5
    CHECK(s.hsb->brightness == "cloud");
    CHECK(s.hsb->hue == "rain");
    swapOpacityAndBrightness(s);
    CHECK(s == cloudAndRain());
}

TEST_CASE("a derived variable becomes one of the session when it drives opacity", "[variables]") {
    Session s = cloudAndRain();
    setChannel(s, Channel::Brightness, "gradient:cloud");
    swapOpacityAndBrightness(s);
    CHECK(namesOf(s) == Names{"gradient of cloud", "rain", "cloud"});
    CHECK(s.variable().derivation == parseDerivation("gradient:cloud"));
    CHECK(s.hsb->brightness == "cloud");
    CHECK(s.hsb->saturation == "volatility:gradient of cloud:10");
    swapOpacityAndBrightness(s);
    CHECK(s.variable().name == "cloud");
    CHECK(s.hsb->brightness == "gradient of cloud");
    CHECK(s.hsb->saturation == "volatility:cloud:10");
}

TEST_CASE("features are of any variable, and channels stay with what they name", "[variables]") {
    Session s = cloudAndRain();
    const HsbMapping before = *s.hsb;
    setFeaturesOf(s, featuresOf(s, "volatility:5"));
    CHECK(namesOf(s) == Names{"volatility of cloud", "rain", "cloud"});
    CHECK(s.variable().derivation->text() == "volatility:cloud:5");
    CHECK(*s.hsb == before);
    CHECK(featureFrames(s) == 5);
    CHECK(dataVariable(s).name == "cloud");
    setFeatureFrames(s, 3);
    CHECK(s.variable().derivation->frames == 3);
    VolumeSource other;
    other.path = "other.nrrd";
    setDataSource(s, other);
    CHECK(s.variableNamed("cloud")->source == other);
    CHECK(s.variable().source == VolumeSource{});
    // The one that is there already, not another like it; and back.
    setFeaturesOf(s, "rain");
    CHECK(dataVariable(s).name == "rain");
    CHECK_FALSE(featureFrames(s));
    setFeaturesOf(s, "volatility:cloud:3");
    CHECK(s.variables->size() == 3);
    CHECK(s.variable().name == "volatility of cloud");
    // Of what is derived itself, it is still the data in the end.
    setFeaturesOf(s, "gradient:volatility of cloud");
    CHECK(dataVariable(s).name == "cloud");
    // A channel that is driven by the same is by its name from now on, so that it is made once.
    Session t = cloudAndRain();
    setFeaturesOf(t, "volatility:cloud:10");
    CHECK(t.hsb->saturation == "volatility of cloud");
    CHECK(t.hsb->hue == "cloud");
}

TEST_CASE("what features may be of is told in short and in full", "[variables]") {
    Session s = cloudAndRain();
    CHECK(featuresOf(s, "gradient") == "gradient:cloud");
    CHECK(featuresOf(s, "volatility:10") == "volatility:cloud:10");
    CHECK(featuresOf(s, "difference:0") == "difference:cloud:0");
    CHECK(featuresOf(s, "volatility:rain:4") == "volatility:rain:4");
    CHECK(featuresOf(s, "volatility:rain") == "volatility:rain"); // no number: told as it was typed
    CHECK(featuresOf(s, "rain") == "rain");
    addVariable(s, plain("gradient"));
    CHECK(featuresOf(s, "gradient") == "gradient"); // somebody has called one so
    const Session before = s;
    CHECK_THROWS_AS(setFeaturesOf(s, "wind"), UsageError);
    CHECK_THROWS_AS(setFeaturesOf(s, "gradient:wind"), UsageError);
    CHECK_THROWS_AS(setFeaturesOf(s, "volatility:cloud:0"), UsageError);
    CHECK(s == before);
    setFeaturesOf(s, "gradient:cloud");
    CHECK(dataVariable(s).name == "cloud");
}

TEST_CASE("any variable drives any channel", "[variables]") {
    Session s = cloudAndRain();
    setChannel(s, Channel::Saturation, "rain");
    setChannel(s, Channel::Hue, "gradient:rain");
    setChannel(s, Channel::Brightness, "");
    CHECK(channelOf(s, Channel::Opacity) == "cloud");
    CHECK(channelOf(s, Channel::Saturation) == "rain");
    CHECK(channelOf(s, Channel::Hue) == "gradient:rain");
    CHECK(channelOf(s, Channel::Brightness).empty());
    const Session before = s;
    swapOpacityAndBrightness(s); // nothing drives it
    CHECK(s == before);
}

TEST_CASE("volatility has the frames that it is given, named or not", "[variables]") {
    Session s = cloudAndRain();
    CHECK(volatilityFrames(s) == 10);
    setVolatilityFrames(s, 4);
    CHECK(s.hsb->saturation == "volatility:cloud:4");
    addVariable(s, derived("motion", "volatility:cloud:7"));
    setChannel(s, Channel::Saturation, "motion");
    CHECK(volatilityFrames(s) == 7);
    setVolatilityFrames(s, 3);
    CHECK(s.variableNamed("motion")->derivation->frames == 3);
    CHECK(s.hsb->saturation == "motion");
    setChannel(s, Channel::Saturation, "rain");
    CHECK_FALSE(volatilityFrames(s));
}

TEST_CASE("a new name goes wherever the old one stood", "[variables]") {
    Session s = cloudAndRain();
    addVariable(s, derived("edge", "gradient:cloud"));
    renameVariable(s, "cloud", "qc");
    CHECK(namesOf(s) == Names{"qc", "rain", "edge"});
    CHECK(s.hsb->saturation == "volatility:qc:10");
    CHECK(s.hsb->hue == "qc");
    CHECK(s.variableNamed("edge")->derivation->of == "qc");
    CHECK_THROWS_AS(renameVariable(s, "qc", "rain"), UsageError);
    CHECK_THROWS_AS(renameVariable(s, "qc", ""), UsageError);
    CHECK_THROWS_AS(renameVariable(s, "qc", "a:b"), UsageError);
    CHECK(addVariable(s, plain("rain")) == "rain 2");
    CHECK(addVariable(s, plain("rain")) == "rain 3");
}

TEST_CASE("what a removed variable drove is constant, what others are made of stays", "[variables]") {
    Session s = cloudAndRain();
    addVariable(s, derived("edge", "gradient:rain"));
    CHECK(madeOf(s, "rain") == Names{"edge"});
    CHECK_THROWS_AS(removeVariable(s, "rain"), UsageError);
    removeVariable(s, "edge");
    removeVariable(s, "cloud");
    CHECK(namesOf(s) == Names{"rain"});
    CHECK(s.hsb->saturation.empty()); // it was the volatility of cloud
    CHECK(s.hsb->hue.empty());
    CHECK(s.hsb->brightness == "rain");
    CHECK_THROWS_AS(removeVariable(s, "rain"), UsageError);
}

TEST_CASE("variables that are made of themselves are searched to an end", "[variables]") {
    Session s;
    s.variables = std::vector<Variable>{derived("a", "gradient:b"), derived("b", "gradient:a")};
    CHECK(madeOf(s, "x").empty());
    CHECK(dataVariable(s).name == "a");
}

TEST_CASE("a mapping begins with what there is", "[variables]") {
    Session s;
    s.variables = std::vector<Variable>{plain("smoke")};
    startMapping(s, false);
    CHECK(s.hsb->saturation.empty());
    startMapping(s, true);
    CHECK(s.hsb->saturation == "volatility:smoke:10");
    CHECK(s.hsb->brightness.empty());
    setChannel(s, Channel::Saturation, "");
    addVariable(s, plain("heat"));
    startMapping(s, false);
    CHECK(s.hsb->brightness == "heat");
    const Session before = s;
    startMapping(s, true); // a channel is driven already
    CHECK(s == before);
}

TEST_CASE("variables are named after their files", "[variables]") {
    const auto nameOf = [](const std::string& path) {
        VolumeSource source;
        source.path = path;
        return nameOfSource(source);
    };
    CHECK(nameOf("run/CLOUDf01.bin") == "CLOUDf");
    CHECK(nameOf("run/p_%03d.mhd") == "p");
    CHECK(nameOf("run/rain*.raw") == "rain");
    CHECK(nameOf("scan.nii.gz") == "scan");
    CHECK(nameOf("007.raw") == "007");
    CHECK(nameOf("sample:vortex") == "vortex");
    CHECK(nameOf("sample:hurricane/wind") == "wind");
}

TEST_CASE("measures and clipping planes go along with data that are turned", "[variables]") {
    Session s = cloudAndRain();
    s.variables.edit([](std::vector<Variable>& all) { all.push_back(derived("slope", "gradient:cloud")); });
    Geometry g;
    g.dims = {8, 10, 12};
    g.spacing = {1, 2, 0.5};
    g.origin = {5, -3, 40};
    const Volume before(g, SampleArray<float>(std::vector<float>(voxelCount(g.dims), 1)));
    const Vec3 a(1, 2, 3), b(6, 7, 9); // voxels
    s.rulers.edit([&](std::vector<Ruler>& rulers) {
        addRuler(rulers, {.kind = RulerKind::Distance, .points = {g.worldFromVoxel(a), g.worldFromVoxel(b)}});
        addRuler(rulers, boxRuler(g.worldFromVoxel(a), g.worldFromVoxel(b)));
    });
    s.clipping.edit([](Clipping& c) { c.planes = {{{1, 2, 3}, 130}, {{0, 0, -2}, -84}}; });
    const double length = *readGeometry(s.rulers->front()).length;

    const Session old = s;
    const GridAxes axes = parseGridAxes("PIR");
    placeData(s, before, axes, {});
    CHECK((*s.variables)[0].source.axes == axes);
    CHECK((*s.variables)[1].source.axes == axes);
    CHECK_FALSE((*s.variables)[2].source.axes); // it is made of one that is turned
    const Geometry after = withPlacement(before, axes, {}).geometry();
    for (std::size_t p = 0; p < 2; ++p) {
        const Vec3 voxel = after.voxelFromWorld(s.rulers->front().points[p]);
        for (int axis = 0; axis < 3; ++axis) CHECK(voxel[axis] == Approx((p == 0 ? a : b)[axis]));
    }
    CHECK(*readGeometry(s.rulers->front()).length == Approx(length));
    const Ruler& box = s.rulers->back();
    for (int axis = 0; axis < 3; ++axis) CHECK(box.points[0][axis] <= box.points[1][axis]);
    // The planes keep the same voxels.
    const auto oldPlanes = planesInVoxels(*old.clipping, g), newPlanes = planesInVoxels(*s.clipping, after);
    int kept = 0, all = 0;
    for (int k = 0; k < g.dims.z; ++k)
        for (int j = 0; j < g.dims.y; ++j)
            for (int i = 0; i < g.dims.x; ++i) {
                const bool keeps = pellucid::keeps(oldPlanes, Vec3(i, j, k));
                CHECK(keeps == pellucid::keeps(newPlanes, Vec3(i, j, k)));
                kept += keeps;
                ++all;
            }
    CHECK(kept > 0);
    CHECK(kept < all);

    placeData(s, withPlacement(before, axes, {}), {}, {});
    CHECK_FALSE((*s.variables)[0].source.axes);
    for (std::size_t p = 0; p < 2; ++p)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(s.rulers->front().points[p][axis] == Approx(old.rulers->front().points[p][axis]));

    // With other distances, measures and planes stay at their voxels, too, and keyframes see the same part of the data.
    const GridSpacing spacing{{0.5, 0.5, 4}};
    const Camera camera = cameraFromView(g, 30, 20, 1, Projection::Perspective);
    s.keyframes.edit([&](Keyframes& keys) { keys.emplace_back().state.camera = camera; });
    placeData(s, before, {}, spacing);
    CHECK((*s.variables)[0].source.spacing == spacing);
    CHECK_FALSE((*s.variables)[2].source.spacing);
    const Geometry spaced = withPlacement(before, {}, spacing).geometry();
    for (int axis = 0; axis < 3; ++axis)
        CHECK(spaced.voxelFromWorld(s.rulers->front().points[1])[axis] == Approx(b[axis]));
    const auto spacedPlanes = planesInVoxels(*s.clipping, spaced);
    for (int k = 0; k < g.dims.z; ++k)
        for (int j = 0; j < g.dims.y; ++j)
            for (int i = 0; i < g.dims.x; ++i)
                CHECK(pellucid::keeps(oldPlanes, Vec3(i, j, k)) == pellucid::keeps(spacedPlanes, Vec3(i, j, k)));
    const Camera expected = cameraFromView(spaced, 30, 20, 1, Projection::Perspective);
    CHECK(glm::distance(s.keyframes->front().state.camera.eye, expected.eye) < 1e-9 * spaced.radius());
    CHECK(glm::distance(s.keyframes->front().state.camera.center, expected.center) < 1e-9 * spaced.radius());
    CHECK(glm::length(s.clipping->planes.front().normal) == Approx(glm::length(Vec3(1, 2, 3))));
}
