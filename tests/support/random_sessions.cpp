#include "support/random_sessions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace pellucid::test {

namespace {

constexpr const char* kForeign = R"({"x-note":[1,2.5,"ä"],"x-other":{"deep":null}})";

std::string randomExtra(Random& random) { return random.chance(0.3) ? kForeign : ""; }

Vec3 oddVector(Random& random, double lo, double hi) {
    return {oddNumber(random, lo, hi), oddNumber(random, lo, hi), oddNumber(random, lo, hi)};
}

ValueRange randomRange(Random& random) {
    const double lo = oddNumber(random, -2000, 2000);
    return {lo, lo + random.between(1e-3, 4000)};
}

template <class T, std::size_t N>
T oneOf(Random& random, const std::array<T, N>& choices) {
    return choices[static_cast<std::size_t>(random.below(static_cast<int>(N)))];
}

VolumeSource randomSource(Random& random) {
    VolumeSource s;
    if (random.chance(0.4)) {
        s.path = std::string("sample:") + oneOf(random, std::array{"shells", "disks", "knee"});
        if (random.chance(0.5)) s.sampleSize = 8 + random.below(60);
        s.seed = random.chance(0.5) ? 1u : static_cast<std::uint32_t>(4294967295.0 * random.unit());
    } else {
        s.path = "/nowhere/at all/data \"" + std::to_string(random.below(100)) + "\" ü.raw";
        if (random.chance(0.5)) {
            RawLayout raw;
            raw.dims = {1 + random.below(1000), 1 + random.below(1000), 1 + random.below(1000)};
            raw.type = static_cast<SampleType>(random.below(8));
            raw.bigEndian = random.chance(0.5);
            raw.skipBytes = random.chance(0.5) ? 0 : static_cast<std::uint64_t>(9e18 * random.unit());
            s.raw = raw;
        }
        if (random.chance(0.3)) s.component = random.below(5);
    }
    if (random.chance(0.4))
        s.spacing = GridSpacing{oddVector(random, 1e-6, 1e6), static_cast<LengthUnit>(random.below(15))};
    if (random.chance(0.4)) s.missing = oddNumber(random, -1e300, 1e300);
    if (random.chance(0.3)) s.downsample = 1 + random.below(9);
    if (random.chance(0.3)) {
        s.region = VoxelRegion{{random.below(100), random.below(100), random.below(100)}, {}};
        s.region->hi = s.region->lo + Int3(1 + random.below(100), 1 + random.below(100), 1 + random.below(100));
    }
    return s;
}

Camera randomCamera(Random& random) {
    Camera c;
    c.projection = random.chance(0.5) ? Projection::Perspective : Projection::Orthographic;
    c.center = oddVector(random, -1000, 1000);
    c.eye = c.center + Vec3(random.between(1, 2000), random.between(-2000, 2000), random.between(-50, 50));
    c.up = Vec3(oddNumber(random, -0.1, 0.1), oddNumber(random, -0.1, 0.1), random.between(1, 2));
    c.fovY = random.between(0.5, 170);
    c.height = random.between(1e-3, 1e6);
    return c;
}

Variable randomVariable(Random& random, int& features) {
    Variable v;
    v.name = oneOf(random, std::array{"x", "density", "Dichte ρ", ""});
    v.source = randomSource(random);
    if (random.chance(0.5)) v.window = randomRange(random);
    const int keys = random.chance(0.2) ? 0 : random.chance(0.7) ? 1 : 2 + random.below(3);
    for (int k = 0; k < keys; ++k) {
        TransferFunction tf = randomTf(random);
        features = std::max(features, static_cast<int>(tf.features.size()));
        v.track.keys[k == 0 ? random.below(3) : 10 * k + random.below(10)] = Part<TransferFunction>(std::move(tf));
    }
    for (int i = keys == 0 ? 0 : random.below(3); i > 0; --i) {
        TransferFunction tf = randomTf(random);
        features = std::max(features, static_cast<int>(tf.features.size()));
        AdaptedTf& adapted = v.track.adapted[100 + i];
        adapted = {Part<TransferFunction>(tf), "fingerprint " + std::to_string(i)};
        if (!random.chance(0.5)) continue;
        adapted.smooth = Part<TransferFunction>(std::move(tf));
        adapted.smoothBasis = "of all " + std::to_string(i);
    }
    v.extraJson = randomExtra(random);
    return v;
}

/// Beside those that a session begins with.
Variable randomDerived(Random& random) {
    Variable v;
    v.name = "derived";
    v.derivation = Derivation{oneOf(random, std::array{Derivation::Kind::Gradient, Derivation::Kind::Volatility,
                                                       Derivation::Kind::Difference}),
                              "density", 1 + random.below(20), random.below(10)};
    if (v.derivation->kind != Derivation::Kind::Volatility) v.derivation->frames = Derivation{}.frames;
    if (v.derivation->kind != Derivation::Kind::Difference) v.derivation->reference = 0;
    return v;
}

std::vector<Ruler> randomRulers(Random& random) {
    std::vector<Ruler> rulers;
    for (int n = random.below(4); n > 0; --n) {
        Ruler ruler{.kind = static_cast<RulerKind>(random.below(4))};
        for (std::size_t p = 0; p < pointsOf(ruler.kind); ++p) ruler.points.push_back(oddVector(random, -1000, 1000));
        if (ruler.kind == RulerKind::Sphere) ruler.radius = random.between(1e-3, 100);
        if (ruler.kind == RulerKind::Box) ruler = boxRuler(ruler.points[0], ruler.points[1]);
        if (random.chance(0.3)) ruler.name = "Länge \"ä\"";
        ruler.shown = random.chance(0.7);
        if (!rulerProblem(ruler).empty()) continue; // two points have come out the same
        addRuler(rulers, ruler);
    }
    return rulers;
}

void addSeriesParts(Session& s, Random& random) {
    if (!s.isEmpty() && random.chance(0.4))
        s.variables.edit([&](std::vector<Variable>& all) { all.push_back(randomDerived(random)); });
    if (random.chance(0.3)) {
        TargetKeys keys;
        for (int i = 1 + random.below(3); i > 0; --i)
            keys[10 * i][static_cast<FeatureId>(1 + random.below(4))] = oddNumber(random, 0, 1);
        s.targetKeys = keys;
    }
    AdaptSettings adapt{static_cast<AdaptSettings::Mode>(random.below(3))};
    if (random.chance(0.8))
        adapt.coherence = random.chance(0.2) ? std::numeric_limits<double>::infinity() : oddNumber(random, 0, 100);
    s.adapt = adapt;
    if (random.chance(0.5)) {
        HsbMapping hsb;
        hsb.on = random.chance(0.5);
        hsb.saturation = "volatility:x:10";
        hsb.brightness = random.chance(0.5) ? "derived" : "";
        if (random.chance(0.5)) hsb.a = oddNumber(random, 0, 100);
        hsb.hueFrom = oddNumber(random, 0, 360);
        if (random.chance(0.5)) {
            hsb.found.saturation = hsb.saturation;
            hsb.found.a = oddNumber(random, 0, 100);
        }
        s.hsb = hsb;
    }
    if (random.chance(0.5)) {
        GroundView ground;
        ground.path = "sample:disks";
        if (random.chance(0.5)) ground.scale = oddNumber(random, 0.1, 10);
        ground.relief = oddNumber(random, 0, 1);
        ground.shown = random.chance(0.5);
        s.ground = ground;
    }
    if (random.chance(0.5)) {
        OverlayView overlay;
        overlay.source.path = "sample:disks";
        overlay.shown = random.chance(0.5);
        overlay.sides = static_cast<OverlayView::Sides>(random.below(3));
        if (random.chance(0.5)) overlay.threshold = oddNumber(random, -5, 5);
        if (random.chance(0.5)) overlay.top = oddNumber(random, 5, 10);
        if (random.chance(0.5)) overlay.opacity = oddNumber(random, 0, 1);
        if (random.chance(0.5)) overlay.colorMap = "sand";
        if (random.chance(0.3)) overlay.curve = tents(2, 0.3);
        s.overlay = overlay;
    }
}

FeatureGoals randomGoals(Random& random, int features) {
    FeatureGoals goals;
    for (int i = 1; i <= features + 3; ++i) {
        if (random.chance(0.2)) continue;
        FeatureGoal g;
        g.target = random.chance(0.2) ? 0 : oddNumber(random, 0, random.chance(0.5) ? 1 : kLargestTarget);
        g.locked = random.chance(0.3);
        g.targetLocked = random.chance(0.2);
        if (random.chance(0.3)) {
            g.lowest = oddNumber(random, 0, 0.5);
            g.highest = oddNumber(random, 0.5, 1);
        }
        if (i > features || random.chance(0.2))
            g.departed = FeatureGoal::Departed{"gone " + std::to_string(i), oddNumber(random, 0, 0.4),
                                               oddNumber(random, 0.5, 1)};
        goals[static_cast<FeatureId>(i)] = g;
    }
    return goals;
}

MeasureSettings randomMeasure(Random& random) {
    MeasureSettings m;
    m.saliency.sigma = random.between(0.01, 8);
    m.saliency.kernel = random.chance(0.5) ? SaliencyKernel::Thesis : SaliencyKernel::Narrow;
    m.saliency.w1 = oddNumber(random, 0, 1e6);
    m.saliency.w2 = oddNumber(random, 0, 2);
    m.saliency.background = randomColor(random);
    m.vws.u1 = oddNumber(random, 0, 1);
    m.vws.u2 = 1 - m.vws.u1;
    m.quality = random.chance(0.5) ? Quality::Normal : Quality::High;
    m.profile = random.chance(0.5) ? Profile::Default : Profile::Published;
    m.along = oneOf(random, std::array{Along::Top, Along::Bottom, Along::Front, Along::Left});
    m.engine = oneOf(random, std::array{EngineChoice::Auto, EngineChoice::Gl, EngineChoice::Cpu, EngineChoice::Slices,
                                        EngineChoice::Reference});
    return m;
}

OptimizeOptions randomOptimize(Random& random) {
    OptimizeOptions o;
    o.method = oneOf(random,
                     std::array{SearchMethod::Fixed, SearchMethod::Line, SearchMethod::Parallel, SearchMethod::Newton});
    o.direction =
        oneOf(random, std::array{Direction::Gradient, Direction::Backward, Direction::Second, Direction::Exact});
    o.b = random.between(1e-3, 1e3);
    o.coarse = random.chance(0.5);
    o.restarts = random.chance(0.5);
    o.exactShares = random.chance(0.5);
    if (random.chance(0.5)) o.coverage = random.between(1e-3, 1);
    o.normalize = random.chance(0.5);
    o.step = random.between(1e-9, 10);
    o.tolerance = random.between(1e-9, 0.5);
    o.maxIterations = random.below(100000);
    return o;
}

Run randomRun(Random& random) {
    Run r;
    r.kind = random.chance(0.5) ? "optimize" : "refine";
    r.ended = oneOf(random, std::array{"converged", "max-iterations", "no-progress", "cancelled", "visible", "done"});
    const auto n = static_cast<std::size_t>(random.below(4));
    const auto numbers = [&] {
        std::vector<double> all;
        for (std::size_t i = 0; i < n; ++i) all.push_back(oddNumber(random, 0, 1));
        return all;
    };
    for (std::size_t i = 0; i < n; ++i) r.features.push_back("f" + std::to_string(i));
    r.targets = numbers();
    for (int i = random.below(5); i > 0; --i)
        r.history.push_back({oddNumber(random, 0, 1), numbers(), numbers(), random.below(4)});
    if (!r.history.empty()) r.best = static_cast<std::size_t>(random.below(static_cast<int>(r.history.size())));
    r.before = oddNumber(random, 0, 1e10);
    r.after = oddNumber(random, 0, 1);
    r.iterations = random.below(1000);
    r.seconds = oddNumber(random, 0, 1e6);
    r.evaluations = random.below(100'000);
    if (random.chance(0.5)) r.name = "run \"" + std::to_string(random.below(100)) + "\" of mine, ä";
    if (random.chance(0.5)) r.started = "2026-11-22T14:03:07";
    if (n > 0 && random.chance(0.5)) {
        RunStart start;
        start.tf = tents(static_cast<int>(n), random.between(0.01, 1));
        start.camera = randomCamera(random);
        start.clipping.lo.x = random.between(0, 0.4);
        start.measure = randomMeasure(random);
        start.options = randomOptimize(random);
        if (random.chance(0.5))
            start.limits.assign(n, {random.between(0, 0.3), random.between(0.4, 1), random.chance(0.5)});
        r.start = std::move(start);
    }
    return r;
}

RefineSettings randomRefine(Random& random) {
    RefineSettings r;
    r.stepDown = random.between(1e-9, 1);
    r.stepUp = random.chance(0.3) ? std::nullopt : std::optional(random.between(1e-9, 1));
    r.maxIterations = random.below(100000);
    r.method = random.chance(0.5) ? RefineMethod::Greedy : RefineMethod::Exact;
    r.live = random.chance(0.5);
    if (random.chance(0.3)) {
        r.intensity = oddNumber(random, 0, 1);
    } else if (random.chance(0.3)) {
        r.hue = oddNumber(random, -360, 720);
    } else if (random.chance(0.4)) {
        ImageRegion region;
        for (int i = 3 + random.below(5); i > 0; --i)
            region.outline.emplace_back(oddNumber(random, 0, 1), oddNumber(random, 0, 1));
        r.region = std::move(region);
        if (random.chance(0.5)) r.regionSize = {1 + random.below(2000), 1 + random.below(2000)};
    }
    return r;
}

SliceViews randomSlices(Random& random) {
    SliceViews s;
    s.layout = static_cast<SliceViews::Layout>(random.below(3));
    if (random.chance(0.5)) s.crosshair = oddVector(random, 0, 500);
    if (random.chance(0.5)) s.window = randomRange(random);
    s.tfStrength = oddNumber(random, 0, 1);
    return s;
}

FieldView randomField(Random& random) {
    FieldView f;
    if (random.chance(0.7)) f.kind = static_cast<FieldKind>(random.below(5));
    f.feature = static_cast<FeatureId>(random.below(4));
    f.colorMap = oneOf(random, std::array{"ember", "sand", kFeatureColorMap});
    f.strength = random.between(1e-6, 1);
    f.threshold = random.between(0, 0.999);
    if (random.chance(0.5)) f.top = random.between(1e-12, 1e3);
    return f;
}

} // namespace

double oddNumber(Random& random, double lo, double hi) {
    switch (random.below(5)) {
    case 0: // tiny
        if (lo <= 0 && hi > 0) return std::numeric_limits<double>::denorm_min() * (1 + random.below(1000));
        return lo;
    case 1: // 0.30000000000000004, brought into the range
        return std::clamp((0.1 + 0.2) * (random.chance(0.5) ? 1.0 : 100.0), lo, hi);
    case 2:
        return random.chance(0.5) ? lo : hi;
    case 3: // all bits
        return std::clamp(lo + (hi - lo) * (random.unit() + random.unit() / 4294967296.0), lo, hi);
    default: // what people type
        return std::clamp(std::round(100 * random.between(lo, hi)) / 100, lo, hi);
    }
}

Rgb randomColor(Random& random) {
    if (random.chance(0.5)) return {random.below(256) / 255.0, random.below(256) / 255.0, random.below(256) / 255.0};
    return {oddNumber(random, 0, 1), oddNumber(random, 0, 1), random.unit()};
}

TransferFunction randomTf(Random& random, FeatureId first) {
    TransferFunction tf;
    if (random.chance(0.6)) tf.range = randomRange(random);
    std::vector<double> x;
    for (int i = random.below(9); i > 0; --i) x.push_back(oddNumber(random, 0, 1));
    std::sort(x.begin(), x.end());
    for (const double each : x)
        tf.points.push_back(
            {each, oddNumber(random, 0, 1), randomColor(random), random.chance(0.4), randomExtra(random)});
    std::vector<double> ends;
    for (int i = 2 * random.below(5); i > 0; --i) ends.push_back(oddNumber(random, 0, 1));
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        if (!(ends[i] < ends[i + 1])) continue;
        Feature f{"f" + std::to_string(i), ends[i], ends[i + 1], randomColor(random), randomExtra(random)};
        f.hidden = random.chance(0.2);
        f.id = first++;
        tf.features.push_back(std::move(f));
    }
    tf.extraJson = randomExtra(random);
    return tf;
}

/// Up to two, cut and lit as the session is.
Keyframes randomKeyframes(Random& random, const Session& of) {
    Keyframes keys;
    double time = 0;
    for (int i = random.chance(0.4) ? 1 + random.below(2) : 0; i > 0; --i) {
        Keyframe key{time, random.chance(0.5) ? "Näher \"heran\"" : "", static_cast<Easing>(random.below(5))};
        key.state = {randomCamera(random), randomTf(random, 1), *of.clipping, of.display->light, random.below(60)};
        keys.push_back(std::move(key));
        time += random.between(0.01, 900);
    }
    return keys;
}

ComparisonView randomComparison(Random& random, const Session& of) {
    ComparisonView view{static_cast<CompareMode>(random.below(4)),
                        random.chance(0.5),
                        random.chance(0.5),
                        random.chance(0.5),
                        0.05 * random.below(21),
                        0.05 * (1 + random.below(20)),
                        {}};
    if (random.chance(0.2)) return view;
    view.b = ComparedState{"B \"" + std::to_string(random.below(9)) + "\"",
                           randomTf(random, 1),
                           {},
                           random.below(99),
                           of.display,
                           of.clipping};
    if (random.chance(0.7)) view.b->camera = randomCamera(random);
    return view;
}

Session randomSession(std::uint32_t number) {
    Random random(number);
    Session s;
    int features = 0;
    if (number % 10 != 9) s.variables = std::vector<Variable>{randomVariable(random, features)};
    s.frame = random.chance(0.6) ? 0 : random.below(60);
    s.goals = randomGoals(random, features);
    s.holdTargets = random.chance(0.3);
    if (random.chance(0.5)) s.density = oddNumber(random, 0, 1);
    if (random.chance(0.5)) s.camera = randomCamera(random);
    if (random.chance(0.5)) {
        Clipping clipping{oddVector(random, 0, 0.45), oddVector(random, 0.5, 1), {}, {}};
        for (int i = random.below(3); i > 0; --i)
            clipping.planes.push_back({oddVector(random, 0.1, 1), oddVector(random, -100, 100).x});
        if (random.chance(0.3))
            clipping.rest = {{oddVector(random, 0, 0.45), oddVector(random, 0.5, 1), clipping.planes},
                             random.between(0, 0.9)};
        s.clipping = clipping;
    }
    if (random.chance(0.7)) {
        const auto only = random.chance(0.3) ? static_cast<FeatureId>(1 + random.below(3)) : FeatureId{0};
        const Vec3 parts = oddVector(random, 0, 1);
        DisplaySettings d;
        d.mode = static_cast<RenderMode>(random.below(5));
        d.light = {random.chance(0.5),        parts.x, parts.y, parts.z, 1 + 99 * parts.x,
                   oddVector(random, 0.1, 1), parts.y, parts.z, parts.x, parts.y};
        d.background = randomColor(random);
        if (random.chance(0.3)) d.backgroundTop = randomColor(random);
        d.onlyFeature = only;
        d.finestStep = random.between(kFinestStep, 1);
        s.display = d;
    }
    if (random.chance(0.5)) {
        AnnotationChoice reference;
        reference.on = random.chance(0.8);
        for (const AnnotationPartInfo& part : kAnnotationParts) reference.*part.shown = random.chance(0.5);
        s.reference = reference;
    }
    if (random.chance(0.7)) s.measure = randomMeasure(random);
    if (random.chance(0.7)) s.optimize = randomOptimize(random);
    if (random.chance(0.7)) s.refine = randomRefine(random);
    if (random.chance(0.7)) s.slices = randomSlices(random);
    if (random.chance(0.5)) s.coordinates = CoordinateSettings{PatientAxes::Ras};
    s.rulers = randomRulers(random);
    s.field = randomField(random);
    if (random.chance(0.5)) s.comparison = randomComparison(random, s);
    if (random.chance(0.7))
        s.pictureSaliency = PictureSaliencyView{random.chance(0.5), static_cast<SaliencyMapShown>(random.below(4)),
                                                0.05 * (1 + random.below(20))};
    for (int i = random.below(4); i > 0; --i) s.addRun(randomRun(random));
    addSeriesParts(s, random);
    s.extraJson = randomExtra(random);
    s.keyframes = randomKeyframes(random, s);
    return s;
}

bool identical(const Session& a, const Session& b) {
    if (!(a == b)) return false;
    for (std::size_t v = 0; v < a.variables->size(); ++v) {
        const auto &keysA = (*a.variables)[v].track.keys, &keysB = (*b.variables)[v].track.keys;
        const bool same = std::equal(keysA.begin(), keysA.end(), keysB.begin(), [](const auto& p, const auto& q) {
            const auto &f = p.second->features, &g = q.second->features;
            return std::equal(f.begin(), f.end(), g.begin(),
                              [](const Feature& x, const Feature& y) { return x.id == y.id; });
        });
        if (!same) return false;
    }
    return true;
}

} // namespace pellucid::test
