// Parameter spaces: samples, axes, pictures.
#include <array>
#include <cmath>
#include <sstream>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "render/projected.h"
#include "report/space_picture.h"

using namespace pellucid;

namespace {

/// W_f = g_f x_f / Σ g x, all 0 where the sum is: known in closed form. Counts what it is asked for.
class ProportionalVws final : public VwsFunction {
public:
    explicit ProportionalVws(std::vector<double> gains)
        : m_base(tents(static_cast<int>(gains.size()), 0.5)), m_gains(std::move(gains)) {}
    const TransferFunction& base() const override { return m_base; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl&) const override {
        batches.push_back(candidates.size());
        if (stop != nullptr && batches.size() == 3) stop->request_stop();
        std::vector<std::vector<double>> all;
        for (const auto& x : candidates) all.push_back(vwsOf(x));
        return all;
    }
    Linear jacobian(const std::vector<double>&, const JobControl&) const override { return {}; }

    std::vector<double> vwsOf(const std::vector<double>& x) const {
        double sum = 0;
        for (std::size_t f = 0; f < x.size(); ++f) sum += m_gains[f] * x[f];
        std::vector<double> w;
        for (std::size_t f = 0; f < x.size(); ++f) w.push_back(sum > 0 ? m_gains[f] * x[f] / sum : 0);
        return w;
    }

    mutable std::vector<std::size_t> batches;
    std::stop_source* stop = nullptr;

private:
    TransferFunction m_base;
    std::vector<double> m_gains;
};

ParameterAxes axesOf(std::vector<std::size_t> features, int samples = 11) {
    ParameterAxes axes;
    axes.features = std::move(features);
    axes.samples = samples;
    return axes;
}

/// Two features of equal gain and targets: W_1 = x/(x + y), F = |W_1 − ½|.
ParameterSpace evenPair(int samples = 11) {
    return sampleParameterSpace(ProportionalVws({1, 1}), {1, 1}, axesOf({0, 1}, samples));
}

SpaceView viewOf(const ParameterSpace& space, int shown = kObjective) {
    SpaceView view;
    view.shown = shown;
    for (std::size_t f = 0; f < space.vws.size(); ++f) {
        view.names.push_back("f" + std::to_string(f + 1));
        view.colors.push_back({1.0 - 0.5 * static_cast<double>(f), 0.5 * static_cast<double>(f), 0});
    }
    view.width = 420;
    view.height = 400;
    if (!space.isFlat()) view.camera = spaceCamera(space, kSpaceAzimuth, kSpaceElevation);
    return view;
}

std::array<double, 3> rgbAt(const Image& image, const Vec2& p) {
    const float* pixel = image.pixel(static_cast<int>(p.x), static_cast<int>(p.y));
    return {pixel[0], pixel[1], pixel[2]};
}

OptimizeState stateOf(std::vector<double> opacity, std::vector<double> vws) {
    OptimizeState state;
    state.opacity = std::move(opacity);
    state.vws = std::move(vws);
    return state;
}

double brightnessAt(const Image& image, const Vec2& p) {
    const auto [r, g, b] = rgbAt(image, p);
    return r + g + b;
}

} // namespace

TEST_CASE("a parameter space samples VWS and F at every combination of opacities", "[space]") {
    // g·x = (20·0.1, 3·0.4, 1·1) = (2, 1.2, 1): at these targets F is 0 there, and nowhere else on the grid, since the
    // other opacities of the same shares, (0.1, 0.4, 1)·k, are none of it.
    const ProportionalVws function({20, 3, 1});
    double last = 0;
    const ParameterSpace space = sampleParameterSpace(function, {2, 1.2, 1}, axesOf({0, 1, 2}), {{}, [&](double f) {
                                                                                                     CHECK(f >= last);
                                                                                                     last = f;
                                                                                                 }});
    CHECK(last == 1);
    REQUIRE(space.objective.size() == 11 * 11 * 11);
    CHECK(space.evaluations == 1331);
    for (const Int3& s : {Int3(0, 0, 0), Int3(1, 4, 10), Int3(10, 10, 10), Int3(3, 0, 7)}) {
        const auto index = static_cast<std::size_t>(s.x + 11 * (s.y + 11 * s.z));
        const std::vector<double> x{s.x / 10.0, s.y / 10.0, s.z / 10.0};
        const std::vector<double> w = function.vwsOf(x);
        for (std::size_t f = 0; f < 3; ++f) {
            CHECK(space.vws[f][index] == Approx(w[f]));
            CHECK(space.opacitiesAt(space.positionOfSample(index))[f] == Approx(x[f]));
        }
        CHECK(space.objective[index] == Approx(objectiveOf(w, space.targets)).margin(1e-15));
    }
    CHECK(space.best == 1 + 11 * (4 + 11 * 10));
    CHECK(space.objective[space.best] < 1e-12);
    // Without any opacity every W is 0, and F what is left: sqrt(Σ t² / 3), t = (2, 1.2, 1)/4.2.
    CHECK(space.objective[0] == Approx(std::sqrt((4 + 1.44 + 1) / 3) / 4.2));
}

TEST_CASE("samples are asked for eight in an engine call", "[space]") {
    const ProportionalVws function({20, 3, 1});
    const ParameterSpace space = sampleParameterSpace(function, {1, 1, 1}, axesOf({0, 1, 2}));
    REQUIRE(function.batches.size() == 167); // 166·8 + 3 = 1331
    for (std::size_t i = 0; i < 166; ++i) CHECK(function.batches[i] == 8);
    CHECK(function.batches.back() == 3);
    CHECK(space.axes.sweepCount() == 167);
}

TEST_CASE("sampling a parameter space can be cancelled", "[space]") {
    ProportionalVws function({20, 3, 1});
    std::stop_source stop;
    function.stop = &stop; // asks for it in its third call
    CHECK_THROWS_AS(sampleParameterSpace(function, {1, 1, 1}, axesOf({0, 1, 2}), {stop.get_token(), {}}), Cancelled);
    CHECK(function.batches.size() == 3);
}

TEST_CASE("features without an axis keep their opacities, axes may come in any order", "[space]") {
    const ProportionalVws function({4, 3, 2, 1});
    const ParameterSpace space = sampleParameterSpace(function, {1, 1, 1, 1}, axesOf({3, 0}, 3));
    REQUIRE(space.isFlat());
    REQUIRE(space.objective.size() == 9);
    // Sample 5 is (2, 1): the fourth feature at 1, the first at ½; the others have the ½ of the transfer function.
    const std::vector<double> x{0.5, 0.5, 0.5, 1};
    CHECK(space.opacitiesAt(space.positionOfSample(5)) == x);
    for (std::size_t f = 0; f < 4; ++f) CHECK(space.vws[f][5] == Approx(function.vwsOf(x)[f]));
    CHECK(space.positionOf({0.25, 0.7, 0.7, 0.75}) == Vec3(0.75, 0.25, 0));
}

TEST_CASE("axes are linear or logarithmic, and refuse what cannot be", "[space]") {
    ParameterAxes axes = axesOf({0, 1, 2}, 4);
    axes.scale = AxisScale::Logarithmic; // 0.001, 0.01, 0.1, 1
    for (int i = 0; i < 4; ++i) {
        CHECK(axes.opacityAt(axes.positionOfSample(i)) == Approx(std::pow(10, i - 3)));
        CHECK(axes.positionOf(std::pow(10, i - 3)) == Approx(i / 3.0).margin(1e-12));
    }
    CHECK(axes.positionOf(0) == 0);
    CHECK(axes.positionOf(1e-5) == 0);
    const auto ticks = axes.ticks(5);
    REQUIRE(ticks.size() == 4);
    CHECK(ticks[1].text == "0.01");
    CHECK(ticks[1].position == Approx(1.0 / 3));
    axes.lowest = 0.002; // its end is no power of ten
    REQUIRE(axes.ticks(5).size() == 4);
    CHECK(axes.ticks(5)[0].text == "0.002");
    axes.scale = AxisScale::Linear;
    CHECK(axes.opacityAt(0.3) == 0.3);
    CHECK(axes.ticks(5).front().position == 0);
    CHECK(axes.ticks(5).back().position == 1);

    CHECK_THROWS_AS(axesOf({0}).validate(3), UsageError);
    CHECK_THROWS_AS(axesOf({0, 0}).validate(3), UsageError);
    CHECK_THROWS_AS(axesOf({0, 3}).validate(3), UsageError);
    CHECK_THROWS_AS(axesOf({0, 1, 2, 3}).validate(4), UsageError);
    CHECK_THROWS_AS(axesOf({0, 1}, 1).validate(3), UsageError);
    CHECK_THROWS_AS(axesOf({0, 1}, 65).validate(3), UsageError);
    axes.lowest = 0;
    CHECK_THROWS_AS(axes.validate(3), UsageError);
    CHECK(fromName<AxisScale>("log") == AxisScale::Logarithmic);
    CHECK_THROWS_AS(fromName<AxisScale>("exp"), UsageError);
}

TEST_CASE("axes that nobody chose are those of the largest targets", "[space]") {
    TransferFunction tf = tents(5);
    CHECK(defaultAxes(tf, {0.1, 0.3, 0.05, 0.35, 0.2}) == std::vector<std::size_t>{1, 3, 4});
    tf.features[3].hidden = true;
    CHECK(defaultAxes(tf, {0.1, 0.3, 0.05, 0.35, 0.2}) == std::vector<std::size_t>{0, 1, 4});
    CHECK(defaultAxes(tents(2), {0.5, 0.5}) == std::vector<std::size_t>{0, 1});
    CHECK_THROWS_AS(defaultAxes(tents(1), {1}), UsageError);
}

TEST_CASE("other targets need no new samples", "[space]") {
    const ProportionalVws function({20, 3, 1});
    const ParameterSpace space = sampleParameterSpace(function, {2, 1.2, 1}, axesOf({0, 1, 2}));
    const ParameterSpace other = withTargets(space, {1, 1, 1});
    const ParameterSpace anew = sampleParameterSpace(function, {1, 1, 1}, axesOf({0, 1, 2}));
    CHECK(other.objective == anew.objective);
    CHECK(other.best == anew.best);
    CHECK(other.vws == space.vws);
}

TEST_CASE("a large volume is made coarser, a small one is not", "[space]") {
    // 41³ voxels times 167 sweeps are 1.2e7; 379·229·305 times 167 are 4.4e9, 1.5 times what is done in a while: the
    // cube root is 1.14. With 21 samples, 1158 sweeps, it is 2.2.
    CHECK(reductionFor(41 * 41 * 41, axesOf({0, 1, 2})) == 1);
    CHECK(reductionFor(379ul * 229 * 305, axesOf({0, 1, 2})) == 2);
    CHECK(reductionFor(379ul * 229 * 305, axesOf({0, 1, 2}, 21)) == 3);
    CHECK(reductionFor(379ul * 229 * 305, axesOf({0, 1})) == 1); // 16 sweeps
}

TEST_CASE("a space is a volume whose places are opacities", "[space]") {
    const ParameterSpace space = sampleParameterSpace(ProportionalVws({20, 3, 1}), {1, 1, 1}, axesOf({0, 1, 2}, 5));
    const Geometry g = space.geometry();
    CHECK(g.worldFromVoxel({0, 0, 0}) == Vec3(0));
    CHECK(glm::length(g.worldFromVoxel({4, 4, 4}) - Vec3(1)) < 1e-12);
    const auto volume = spaceVolume(space, 1);
    CHECK(volume->range() == ValueRange{0, 1});
    for (const std::size_t s : {std::size_t{0}, std::size_t{7}, std::size_t{93}, std::size_t{124}}) {
        const Int3 v(static_cast<int>(s % 5), static_cast<int>(s / 5 % 5), static_cast<int>(s / 25));
        CHECK(glm::length(g.worldFromVoxel(Vec3(v)) - space.positionOfSample(s)) < 1e-12);
        CHECK(volume->value(s) == Approx(space.vws[1][s]));
        CHECK(space.valueAt(1, space.positionOfSample(s)) == Approx(space.vws[1][s]));
    }
    const ValueRange range = spaceVolume(space, kObjective)->range();
    CHECK(range.lo == Approx(space.objective[space.best]));
    // In the middle of a cell the mean of its corners: samples 31, 32, 36, 37, 56, 57, 61, 62.
    double mean = 0;
    for (const std::size_t s : {31, 32, 36, 37, 56, 57, 61, 62}) mean += space.objective[s] / 8;
    CHECK(space.valueAt(kObjective, Vec3(0.375, 0.375, 0.375)) == Approx(mean));
}

TEST_CASE("the transfer function of F hides what lies between", "[space]") {
    const ParameterSpace space = sampleParameterSpace(ProportionalVws({20, 3, 1}), {1, 1, 1}, axesOf({0, 1, 2}));
    const TransferFunction f = spaceTf(space, viewOf(space));
    CHECK_NOTHROW(f.validate());
    CHECK(f.opacity(0) > 0.3);
    CHECK(f.opacity(1) > 0.05);
    CHECK(f.opacity(0.5) == 0);
    CHECK(f.color(0).b > f.color(0).r); // blue is near the targets, orange far away
    CHECK(f.color(1).r > f.color(1).b);
    const TransferFunction w = spaceTf(space, viewOf(space, 0));
    CHECK(w.opacity(0) == 0);
    CHECK(w.opacity(0.4) < w.opacity(0.8));
    CHECK(w.color(0.4).r < w.color(0.8).r);
    CHECK(w.color(1) == Rgb{1, 0, 0});
    // As dense with finer samples: along an axis, through ten steps or twenty, the same.
    const ParameterSpace fine = sampleParameterSpace(ProportionalVws({20, 3, 1}), {1, 1, 1}, axesOf({0, 1, 2}, 21));
    CHECK(std::pow(1 - spaceTf(fine, viewOf(fine, 0)).opacity(1), 20) == Approx(std::pow(1 - w.opacity(1), 10)));
}

TEST_CASE("the picture of a W brightens along its feature's axis", "[space]") {
    const ParameterSpace space = sampleParameterSpace(ProportionalVws({1, 1, 1}), {1, 1, 1}, axesOf({0, 1, 2}));
    const SpaceView view = viewOf(space, 0);
    const Image image = spaceImage(space, view);
    // W_1 is largest around (1, 0, 0) and 0 where x is; the middles of those faces are apart in the picture.
    const Vec2 high = *pixelOf(space, view, {0.95, 0.2, 0.2}), low = *pixelOf(space, view, {0.05, 0.6, 0.6});
    CHECK(brightnessAt(image, high) > 1.5 * brightnessAt(image, low));
    // Beside the cube nothing but the background.
    CHECK(brightnessAt(image, {4.5, view.height - 4.5}) == 0);
}

TEST_CASE("heat maps have the colours of their values", "[space]") {
    const ParameterSpace space = evenPair();
    const SpaceView view = viewOf(space, 0);
    const Image image = heatMap(space, view);
    const PixelBox box = heatMapBox(space, view);
    CHECK(box.right - box.left == box.bottom - box.top);
    CHECK(box.left > 0);
    CHECK(box.right < view.width);
    // By symmetry W_1 is ½ all along the diagonal, also between samples; only the first cell has the W = 0 of (0, 0).
    for (const double p : {0.2, 0.35, 0.5, 0.77, 0.96}) {
        const Vec2 at = *pixelOf(space, view, {p, p, 0});
        const Vec3 middle = *positionAt(space, view, {std::floor(at.x) + 0.5, std::floor(at.y) + 0.5});
        const Rgb wanted = heatMapColor(space.valueAt(0, middle), {0, 1}), half = heatMapColor(0.5, {0, 1});
        const auto seen = rgbAt(image, at);
        CHECK(seen[0] == Approx(wanted.r).margin(1.0 / 255));
        CHECK(seen[1] == Approx(wanted.g).margin(1.0 / 255));
        CHECK(seen[2] == Approx(wanted.b).margin(1.0 / 255));
        CHECK(seen[1] == Approx(half.g).margin(0.03)); // a pixel aside of the diagonal at most
    }
    // Right below it W_1 is x/(x + y): 0.8 at (0.8, 0.2), a sample; above it 0.2.
    const auto right = rgbAt(image, *pixelOf(space, view, {0.8, 0.2, 0})),
               left = rgbAt(image, *pixelOf(space, view, {0.2, 0.8, 0}));
    CHECK(right[1] == Approx(heatMapColor(0.8, {0, 1}).g).margin(0.02));
    CHECK(left[1] == Approx(heatMapColor(0.2, {0, 1}).g).margin(0.02));
    CHECK(brightnessAt(image, {1.5, 1.5}) == 0);
}

TEST_CASE("the contour of a heat map is where F is the tolerance", "[space]") {
    const ParameterSpace space = evenPair();
    SpaceView view = viewOf(space);
    view.tolerance = 0.1;
    const double width = 0.2 * 7; // of its lines; capitals are 7 pixels high
    const PixelBox box = heatMapBox(space, view);
    int ends = 0;
    for (const Mark& mark : spaceMarks(space, view)) {
        if (mark.part != AnnotationPart::Axes || mark.kind != Mark::Kind::Line || std::abs(mark.width - width) > 1e-9)
            continue;
        for (const Vec2& p : mark.points) {
            const Vec3 position{(p.x - box.left) / (box.right - box.left), (box.bottom - p.y) / (box.bottom - box.top),
                                0};
            CHECK(space.valueAt(kObjective, position) == Approx(0.1).margin(1e-9));
            ++ends;
        }
    }
    // F = |x/(x + y) − ½| = 0.1 on the lines y = 2/3·x and y = 3/2·x, both from the first cell to the border: each goes
    // through 10 columns or rows of cells at least.
    CHECK(ends >= 2 * 2 * 10);
    view.tolerance = 0.9; // F is nowhere so large
    for (const Mark& mark : spaceMarks(space, view)) CHECK_FALSE(std::abs(mark.width - width) < 1e-9);
}

TEST_CASE("positions and pixels of a space belong together", "[space]") {
    const ParameterSpace flat = evenPair();
    const SpaceView flatView = viewOf(flat);
    const Vec3 place{0.3, 0.8, 0};
    CHECK(glm::length(*positionAt(flat, flatView, *pixelOf(flat, flatView, place)) - place) < 1e-9);
    CHECK_FALSE(positionAt(flat, flatView, {1, 1}));

    const ParameterSpace space = sampleParameterSpace(ProportionalVws({20, 3, 1}), {2, 1.2, 1}, axesOf({0, 1, 2}));
    SpaceView view = viewOf(space);
    const Vec2 pixel = *pixelOf(space, view, {0.1, 0.4, 1});
    const Ray ray = pixelRay(view.camera, pixel.x, pixel.y, view.width, view.height);
    const Vec3 way = Vec3(0.1, 0.4, 1) - ray.origin;
    CHECK(glm::length(way - ray.direction * glm::dot(way, ray.direction)) < 1e-9);
    // That is the least F of all: what its ray reads is there, to within the steps along the ray.
    CHECK(glm::length(*positionAt(space, view, pixel) - Vec3(0.1, 0.4, 1)) < 0.02);
    CHECK_FALSE(positionAt(space, view, {2, 2}));
    // Of W_1 it is where that is largest: near x = 1 on a ray through the middle.
    view.shown = 0;
    const Vec2 middle = *pixelOf(space, view, {0.5, 0.5, 0.5});
    const Vec3 most = *positionAt(space, view, middle);
    const Ray through = pixelRay(view.camera, middle.x, middle.y, view.width, view.height);
    for (double t = 0; t < 10; t += 0.01) {
        const Vec3 p = through.origin + through.direction * t;
        if (glm::any(glm::lessThan(p, Vec3(0))) || glm::any(glm::greaterThan(p, Vec3(1)))) continue;
        CHECK(space.valueAt(0, p) <= space.valueAt(0, most) + 0.01);
    }
}

TEST_CASE("paths are drawn where their opacities are", "[space]") {
    for (const bool flat : {true, false}) {
        INFO(flat);
        const ParameterSpace space =
            sampleParameterSpace(ProportionalVws({20, 3, 1}), {2, 1.2, 1},
                                 axesOf(flat ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{0, 1, 2}));
        SpaceView view = viewOf(space);
        SpacePath path{"newton", pathColor(0), {}, 2};
        for (const std::vector<double>& x : {std::vector<double>{0.9, 0.5, 0.5}, {0.4, 0.5, 0.8}, {0.1, 0.4, 1.0}})
            path.states.push_back({0.1, {}, x});
        view.paths = {path};
        std::vector<Vec2> places;
        for (const OptimizeState& state : path.states)
            places.push_back(*pixelOf(space, view, space.positionOf(state.opacity)));
        int moves = 0;
        for (const Mark& mark : spaceMarks(space, view))
            for (std::size_t i = 0; i < 2; ++i)
                if (mark.color == path.color && mark.points.size() == 2 &&
                    glm::length(mark.points[0] - places[i]) < 1e-9 &&
                    glm::length(mark.points[1] - places[i + 1]) < 1e-9)
                    ++moves;
        CHECK(moves == 2);
        CHECK(pathStateAt(space, view, places[1] + Vec2(3, 0), 5) == PathState{0, 1});
        CHECK_FALSE(pathStateAt(space, view, places[1] + Vec2(30, 30), 5));
        // The dot at the best state is a capital high and more: its middle has the path's colour.
        const auto seen = rgbAt(spaceImage(space, view), places[2]);
        if (space.best == 1 + 11 * (4 + 11 * 10)) continue; // the cross of the least F lies over it
        CHECK(seen[1] == Approx(path.color.g).margin(0.05));
    }
}

TEST_CASE("a table has every sample", "[space]") {
    const ParameterSpace space = evenPair(3);
    std::istringstream lines(csvOf(space, {"skin", "a \"b\""}));
    std::string line;
    std::getline(lines, line);
    CHECK(line == R"(opacity skin,"opacity a ""b""",W skin,"W a ""b""",F)");
    std::vector<std::string> rows;
    while (std::getline(lines, line)) rows.push_back(line);
    REQUIRE(rows.size() == 9);
    std::istringstream fields(rows[5]); // x = 1, y = ½: W = ⅔, ⅓, F = ⅙
    for (const double expected : {1.0, 0.5, 2.0 / 3, 1.0 / 3, 1.0 / 6}) {
        std::string field;
        std::getline(fields, field, ',');
        CHECK(std::stod(field) == Approx(expected).epsilon(1e-12));
    }
}

TEST_CASE("runs are paths of the features that bear their names", "[session][space]") {
    Run old;
    old.kind = "optimize";
    old.features = {"f2", "f1"}; // another order, and no f3
    old.history = {stateOf({0.2, 0.1}, {0.9, 0.1}), stateOf({0.4, 0.3}, {0.5, 0.5})};
    old.best = 1;
    Run refinement;
    refinement.kind = "refine";
    Run other;
    other.kind = "optimize";
    other.features = {"bone", "f1"};
    other.history = old.history;
    ParameterAxes axes;
    axes.features = {0, 1};
    const auto paths = pathsOfRuns({refinement, other, old}, tents(3), axes);
    REQUIRE(paths.size() == 1); // the others know no f2
    CHECK(paths[0].name == "run 2");
    old.number = 7;
    old.start.edit([](RunStart& start) {
        start.tf = tents(3);
        start.options.method = SearchMethod::Line;
    });
    CHECK(pathsOfRuns({old}, tents(3), axes)[0].name == "run 7, line");
    old.name = "from above";
    CHECK(pathsOfRuns({old}, tents(3), axes)[0].name == "from above");
    CHECK(paths[0].best == 1);
    REQUIRE(paths[0].states.size() == 2);
    CHECK(paths[0].states[1].opacity == std::vector<double>{0.3, 0.4, 0});
    CHECK(paths[0].states[0].vws == std::vector<double>{0.1, 0.9, 0});
    axes.features = {0, 1, 2};
    CHECK(pathsOfRuns({old}, tents(3), axes).empty());
}
