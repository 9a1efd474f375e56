#include "session/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engines/engines.h"
#include "optimize/views/opening_view.h"
#include "render/holder.h"
#include "render/published_engine.h"
#include "session/scene_data.h"
#include "tf/color_maps.h"
#include "tf/formats/tf_file.h"
#include "tf/hsb_colors.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"
#include "volume/mirror_image.h"

namespace pellucid {

namespace {

/// Whether a window of these ends can stand for data of these values; constant data has no window but its value.
bool isWindow(const ValueRange& range) { return range.lo < range.hi; }

/// The window of a proposal, where it is another one than that of the data.
std::optional<ValueRange> windowToSet(const Proposal& proposal, const Volume& data) {
    if (!isWindow(data.range()) || proposal.window == data.range()) return {};
    return proposal.window;
}

/// Window and transfer function from the data, where the session has none.
void proposeStart(Scene& scene, const JobControl& job) {
    if (scene.session.tf() != nullptr) return;
    if (scene.session.hsb->on) { // colours say the rest: opacity is the intensity itself
        scene.session.setTf(opacityRamp(rampOpacity(*scene.volume)));
        return;
    }
    auto proposal = std::make_shared<const Proposal>(propose(*scene.volume, {job.stop, {}}));
    // Frames of a series are compared: their window is that of all values.
    if (!scene.session.variable().window && !scene.series->varies())
        if (const std::optional<ValueRange> window = windowToSet(*proposal, *scene.data)) {
            scene.session.variables.edit([&](std::vector<Variable>& all) { all.front().window = window; });
            scene.volume = throughWindow(scene.data, window);
            scene.histogram.reset();
            scene.codes.reset();
        }
    TransferFunction tf = proposal->tf;
    if (!isWindow(scene.volume->range())) tf.range.reset(); // one value: no two for 0 and 1
    scene.session.setTf(std::move(tf));
    scene.proposal = std::move(proposal);
}

/// The session's transfer function in the window.
void resolveTf(Scene& scene) {
    const ValueRange& window = scene.volume->range();
    const auto held = scene.session.tf();
    const TransferFunction& tf = *held;
    if (!isWindow(window)) {
        scene.tf = tf;
    } else if (tf.range) {
        scene.tf = inRange(tf, window);
    } else { // it says of no values: it is of whatever the window is
        TransferFunction placed = tf;
        placed.range = window;
        scene.session.setTf(placed);
        scene.tf = *scene.session.tf();
    }
}

/// So that both come from the data.
void forgetStart(Session& session) {
    session.variables.edit([](std::vector<Variable>& all) {
        all.front().window.reset();
        all.front().track = {};
    });
}

} // namespace

namespace {

int indexOf(const std::vector<Feature>& features, FeatureId id) {
    if (id == 0) return -1;
    for (std::size_t i = 0; i < features.size(); ++i)
        if (features[i].id == id) return static_cast<int>(i);
    return -1;
}

} // namespace

int Scene::onlyFeature() const { return indexOf(tf.features, session.display->onlyFeature); }
int Scene::fieldFeature() const { return indexOf(tf.features, session.field->feature); }

Session sessionOf(const VolumeSource& source) {
    Session session;
    Variable variable;
    variable.source = source;
    variable.window = source.range;
    variable.source.range.reset();
    variable.source.then = {};
    session.variables = std::vector<Variable>{std::move(variable)};
    return session;
}

namespace {

/// Whether the values of the variable are a volatility, or made of one.
bool isVolatile(const Session& session, const Variable& variable) {
    std::optional<Derivation> derivation = variable.derivation;
    for (int depth = 0; derivation && depth < 100; ++depth) { // a damaged file may go round in circles
        if (derivation->kind == Derivation::Kind::Volatility) return true;
        const Variable* of = session.variableNamed(derivation->of);
        derivation = of != nullptr ? of->derivation : parseDerivation(derivation->of);
    }
    return false;
}

} // namespace

bool needsData(const Session& session, const Scene& basis) {
    if (session.isEmpty() || basis.data == nullptr) return !session.isEmpty();
    const Variable &now = session.variable(), &before = basis.session.variable();
    if (!sameOrigin(now, before)) return true;
    if (volatilityKind(session) != volatilityKind(basis.session) && isVolatile(session, now)) return true;
    const int frame = basis.series->nearest(session.frame);
    if (frame != basis.session.frame) return !basis.series->isShown(frame, now.window);
    if (now.window == before.window) return false;
    const std::optional<ValueRange> all =
        basis.series->varies() ? basis.series->knownRange() : std::optional(basis.data->range());
    const std::optional<ValueRange> window = now.window ? now.window : all;
    return !window || *window != basis.volume->range();
}

void placeAsPublished(const Session& session, const Volume& data, TransferFunction& tf) {
    if (session.measure->profile == Profile::Published && !tf.range && data.sampleType() == SampleType::U8)
        tf.range = ValueRange{0, 255};
}

namespace {

/// The frame, or where it cannot be read the next that can, from the beginning again after the last: data that are
/// opened show something as long as one frame is sound. Throws what is wrong with the frame where none is.
int soundFrame(TimeSeries& series, int frame, const JobControl& job) {
    try {
        series.load(frame, job);
        return frame;
    } catch (const FileError&) {
        for (int n = 1; n < series.size(); ++n) {
            const int other = (frame + n) % series.size();
            try {
                series.load(other, job);
                return other;
            } catch (const FileError&) {
                continue;
            }
        }
        throw;
    }
}

} // namespace

Scene resolve(Session session, const Scene& basis, const MemoryUse& then, const JobControl& job,
              const std::shared_ptr<const Histogram>& histogram) {
    Scene scene;
    scene.session = std::move(session);
    if (scene.session.isEmpty()) return scene;
    SeriesFinder finder(scene, basis, then, job);
    scene.series = finder.of(scene.session.variable());
    scene.session.frame = scene.series->nearest(scene.session.frame);
    const bool sameSeries = scene.series == basis.series;
    if (!sameSeries && scene.series->varies())
        scene.session.frame = soundFrame(*scene.series, scene.session.frame, job);
    const int frame = scene.session.frame;
    const bool sameData = sameSeries && basis.session.frame == frame;
    scene.data = sameData ? basis.data : scene.series->load(frame, job);
    const ValueRange window = windowOf(scene.session.variable(), *scene.series, job);
    const bool sameWindow = sameData && window == basis.volume->range();
    if (sameWindow) {
        scene.volume = basis.volume;
        scene.histogram = basis.histogram;
        scene.codes = basis.codes;
    } else if (scene.series->varies() && scene.series->isShown(frame, window)) {
        ShownFrame shown = scene.series->show(frame, window, job);
        scene.data = std::move(shown.data);
        scene.volume = std::move(shown.volume);
        scene.histogram = std::move(shown.histogram);
        scene.codes = std::move(shown.codes);
    } else {
        scene.volume = throughWindow(scene.data, window);
    }
    if (sameSeries) scene.unit = basis.unit;
    followTargetKeys(scene.session, basis);
    proposeStart(scene, job);
    if (!scene.histogram)
        scene.histogram = histogram ? histogram : std::make_shared<const Histogram>(makeHistogram(*scene.volume));
    if (sameWindow && !scene.proposal && scene.session.tf() == basis.session.tf()) {
        scene.tf = basis.tf; // the very same
    } else {
        resolveTf(scene);
    }
    resolveColors(scene, basis, finder, job);
    finder.keepKnown();
    resolveGround(scene, basis, job);
    resolveOverlay(scene, basis, job);
    if (scene.session.camera) {
        scene.camera = *scene.session.camera;
    } else {
        scene.camera = homeCamera(scene.volume->geometry(), Projection::Perspective);
    }
    return scene;
}

namespace {

/// What a scene that has a proposal opens with, wherever somebody looks at it from and whatever is cut away: a volume
/// has one automatic start.
struct Opening {
    std::optional<Holder> holder; ///< what the object lies on
    View view;

    /// Like the rest of what is drawn.
    void drawHolder() {
        holder.reset();
        view.clipping.rest = {};
    }
};

Opening openingOf(const Scene& scene, const JobControl& job) {
    const std::optional<Holder> holder = findHolder(*scene.volume, scene.proposal->tf, {job.stop, {}});
    return {holder, openingView(*scene.volume, scene.proposal->tf, holder, {job.stop, {}})};
}

FirstSight tunedFrom(const Scene& scene, const Opening& opening, const JobControl& job) {
    FirstSight sight = withOpacitiesForView(*scene.volume, *scene.proposal, scene.tf, opening.view, {job.stop, {}});
    if (opening.holder) sight.rest = faintRest(*opening.holder, *scene.volume, sight.tf, {job.stop, {}});
    return sight;
}

} // namespace

FirstSight tunedStart(const Scene& scene, const JobControl& job) {
    Opening opening = openingOf(scene, job);
    if (scene.session.clipping->rest.isNone()) opening.drawHolder();
    return tunedFrom(scene, opening, job);
}

void setStart(Session& session, const FirstSight& start) {
    session.setTf(start.tf);
    const TransferFunction& tf = *session.tf(); // its features have their identities
    // Every feature has a goal from its first day on, the same for all: what differs somebody has set.
    const std::vector<double> targets = targetsOf(tf, *session.goals);
    const bool wanted =
        std::any_of(targets.begin(), targets.end(), [&](double t) { return std::abs(t - targets.front()) > 1e-9; });
    if (!start.shares.empty() && !wanted) session.goals.set(withTargets(*session.goals, tf, start.shares));
    if (!start.rest.isNone()) session.clipping.edit([&](Clipping& c) { c.rest = start.rest; });
}

AutomaticStart automaticStart(const Scene& scene, const View& view, const JobControl& job) {
    AutomaticStart start;
    start.proposal = propose(*scene.data, {job.stop, {}});
    start.window = windowToSet(start.proposal, *scene.data);
    const auto volume = throughWindow(scene.data, start.window);
    start.sight = withOpacitiesForView(*volume, start.proposal, start.proposal.tf, view, {job.stop, {}});
    return start;
}

Camera cameraOf(const SceneInputs& inputs, const Geometry& geometry) {
    const Projection projection = inputs.projection.value_or(Projection::Perspective);
    Camera camera;
    std::string where = "the camera of the session";
    std::optional<ViewAngles> view = inputs.view;
    if (inputs.namedView) view = anglesOf(*inputs.namedView, geometry.worldAxes);
    if (inputs.camera && !inputs.namedView) {
        camera = *inputs.camera;
        where = inputs.cameraName;
    } else if (view) {
        camera = cameraFromView(geometry, view->azimuth, view->elevation, view->zoom, projection);
        where = "view";
    } else if (inputs.session.camera) {
        camera = *inputs.session.camera;
        if (inputs.projection) camera = withProjection(camera, geometry, projection);
    } else {
        camera = homeCamera(geometry, projection);
    }
    camera.validate(geometry, where);
    return camera;
}

namespace {

/// The scene with its volumes read anew.
Scene readAgain(Scene scene, const MemoryUse& then, const JobControl& job) {
    const auto proposal = scene.proposal;
    const Camera camera = scene.camera;
    const auto histogram = scene.histogram;
    Session session = std::move(scene.session);
    scene = {}; // its memory is wanted
    scene = resolve(std::move(session), {}, then, job, histogram);
    scene.proposal = proposal;
    scene.camera = camera;
    return scene;
}

} // namespace

Scene openScene(const SceneInputs& inputs, const JobControl& job) {
    if (inputs.session.isEmpty()) throw UsageError("no volume is named", "", "give a file or sample:NAME");
    Session session = inputs.session;
    // The transfer function first: it is small, and an error in it should not wait for a large volume.
    std::optional<ReadTf> read;
    std::optional<TransferFunction> tf;
    if (inputs.tf == kAutomaticTf)
        forgetStart(session);
    else if (inputs.tf)
        read = readTfNamed(*inputs.tf);
    if (read) tf = read->tf;
    if (inputs.frame) session.frame = *inputs.frame;
    std::optional<ValueRange> window = inputs.range;
    if (!window && tf && tf->range) window = tf->range;
    if (window) session.variables.edit([&](std::vector<Variable>& all) { all.front().window = window; });
    if (!tf && session.tf() == nullptr && inputs.start == SceneInputs::Start::Tents) tf = tents(3);
    if (tf) session.setTf(*tf);
    const bool windowIsOpen = !session.variable().window;
    // Who asks for what the data propose gets it also where colours come from several variables.
    const Part<HsbMapping> mapping = session.hsb;
    const bool proposesFirst = inputs.tf == kAutomaticTf && mapping->on;
    if (proposesFirst) session.hsb.edit([](HsbMapping& h) { h.on = false; });
    Scene scene = resolve(std::move(session), {}, inputs.then, job);
    if (inputs.frame && *inputs.frame != scene.session.frame && *inputs.frame < scene.series->size())
        scene.series->load(*inputs.frame, job); // tells why not
    if (inputs.frame && *inputs.frame != scene.session.frame)
        throw UsageError("there is no frame " + std::to_string(*inputs.frame), scene.series->listing().title,
                         "give 0 to " + std::to_string(scene.series->size() - 1));
    if (read) { // how long a path its opacities are of here is known now
        TransferFunction placed = forScene(*read, scene);
        if (!(placed == *tf)) {
            tf = std::move(placed);
            Session changed = scene.session; // apart from the basis, which tells what is new
            changed.setTf(*tf);
            scene = resolve(std::move(changed), scene, inputs.then, job);
        }
    }
    const bool followsData = read && read->spansData && !inputs.range;
    if (tf && (windowIsOpen || followsData)) { // what kind of samples there are is known now
        placeAsPublished(scene.session, *scene.data, *tf);
        if (tf->range) {
            scene.session.variables.edit([&](std::vector<Variable>& all) { all.front().window = tf->range; });
            scene.session.setTf(std::move(*tf));
            scene = resolve(scene.session, scene, inputs.then, job);
        }
    }
    // Under a transfer function that somebody gives it is the box that fits, so that the figures of several compare.
    std::optional<Camera> home;
    if (scene.proposal) {
        Opening opening = openingOf(scene, job);
        home = opening.view.camera;
        if (!scene.session.clipping->rest.isNone() || inputs.holder == 1.0) opening.drawHolder();
        if (inputs.start == SceneInputs::Start::Tuned) {
            setStart(scene.session, tunedFrom(scene, opening, job));
            resolveTf(scene);
        } else if (opening.holder) {
            const FaintRest rest = faintRest(*opening.holder, *scene.volume, scene.tf, {job.stop, {}});
            scene.session.clipping.edit([&](Clipping& c) { c.rest = rest; });
        }
    }
    if (inputs.holder && !scene.session.clipping->rest.isNone())
        scene.session.clipping.edit([&](Clipping& c) {
            if (*inputs.holder < 1)
                c.rest.density = *inputs.holder;
            else
                c.rest = {};
        });
    if (proposesFirst) {
        Session mapped = scene.session;
        mapped.hsb = mapping;
        const auto proposal = scene.proposal;
        scene = resolve(std::move(mapped), scene, inputs.then, job);
        scene.proposal = proposal;
    }
    const bool isAsked = inputs.camera || inputs.view || inputs.namedView || inputs.session.camera;
    scene.camera = home && !isAsked ? withProjection(*home, scene.volume->geometry(),
                                                     inputs.projection.value_or(Projection::Perspective))
                                    : cameraOf(inputs, scene.volume->geometry());
    if (inputs.camera || inputs.view || inputs.namedView || inputs.projection) scene.session.camera = scene.camera;
    if (cutBlocksByWork(*scene.volume, shownTf(scene.tf), *scene.session.clipping, inputs.then, {job.stop, {}}))
        scene = readAgain(std::move(scene), inputs.then, job);
    return scene;
}

void prepareToShow(Scene& scene, const JobControl& job) {
    if (!scene.volume) return;
    job.throwIfStopped();
    if (!scene.unit) {
        const JobControl stop{job.stop, {}};
        scene.unit = scene.proposal ? scene.proposal->unit
                                    : unitOf(recogniseKind(*scene.data, surveyVoxels(*scene.data, stop), stop).kind);
    }
    job.throwIfStopped();
    if (!scene.codes) scene.codes = sharedIntensityGrid(*scene.volume);
}

MeasureInput measureInput(const Scene& scene) {
    if (const MeasureSettings& wanted = *scene.session.measure; wanted.profile == Profile::Published && scene.volume) {
        MeasureSettings settings;
        settings.profile = wanted.profile;
        settings.along = wanted.along;
        const Camera camera = cameraAlong(scene.volume->geometry(), wanted.along);
        return {scene.volume, shownTf(scene.tf), {camera, *scene.session.clipping}, settings, {}};
    }
    return {
        scene.volume, shownTf(scene.tf), {scene.camera, *scene.session.clipping}, *scene.session.measure, scene.colors};
}

RunStart runStartOf(const Scene& scene, const OptimizeOptions& options) {
    return {scene.tf,
            scene.camera,
            *scene.session.clipping,
            *scene.session.measure,
            options,
            limitsOf(scene.tf, *scene.session.goals)};
}

PictureInput pictureInput(const Scene& scene, int width, int height, bool transparent) {
    PictureInput input{scene.volume, shownTf(scene.tf), scene.camera, {}};
    RenderSettings& s = input.settings;
    const DisplaySettings& display = *scene.session.display;
    s.width = width;
    s.height = height;
    if (transparent)
        s.background.reset();
    else
        s.background = display.background;
    s.stepInD0 = scene.session.measure->quality == Quality::High ? 0.25 : 0.5;
    s.finestInD0 = display.finestStep;
    s.backgroundTop = transparent ? std::nullopt : display.backgroundTop;
    s.mode = display.mode;
    s.light = display.light;
    s.clipping = *scene.session.clipping;
    s.onlyFeature = scene.onlyFeature();
    s.colors = scene.colors;
    s.ground = scene.ground;
    s.overlay = scene.overlay;
    return input;
}

double topOf(const FieldView& view, const Field& field) { return view.top.value_or(field.top); }

TransferFunction fieldTf(const FieldView& view, std::span<const Feature> features) {
    TransferFunction tf;
    const auto add = [&](double x, double opacity, const Rgb& color) {
        tf.points.push_back({x, opacity, color, false, {}});
    };
    const auto feature = std::find_if(features.begin(), features.end(),
                                      [&](const Feature& f) { return f.id != 0 && f.id == view.feature; });
    const bool ownColor = view.colorMap == kFeatureColorMap && feature != features.end();
    const auto colorAt = [&](double t) -> Rgb {
        if (!ownColor) return {};
        const Rgb& c = feature->color;
        const double w = std::max(0.0, 2 * t - 1), dark = std::min(1.0, 2 * t);
        return {c.r * dark + (1 - c.r) * w, c.g * dark + (1 - c.g) * w, c.b * dark + (1 - c.b) * w};
    };
    const double t = view.threshold;
    add(0, 0, colorAt(0));
    if (t > 0) add(t, 0, colorAt(t));
    if (ownColor && t < 0.5) add(0.5, view.strength * (0.5 - t) / (1 - t), colorAt(0.5));
    add(1, view.strength, colorAt(1));
    if (!ownColor)
        tf = withColorMap(tf, colorMapNamed(view.colorMap == kFeatureColorMap ? FieldView{}.colorMap : view.colorMap));
    return tf;
}

namespace {

/// `tf` over values 0 … top, written for the window 0 … `largest`.
TransferFunction stretched(TransferFunction tf, double top, double largest) {
    const double scale = top / largest;
    std::vector<ControlPoint> points;
    for (ControlPoint& p : tf.points) {
        if (p.x * scale > 1) { // the colours reach beyond all values: cut off where those end
            const ControlPoint& before = points.back();
            const double t = (1 - before.x) / (p.x * scale - before.x);
            points.push_back(
                {1,
                 before.opacity + t * (p.opacity - before.opacity),
                 {before.color.r + t * (p.color.r - before.color.r), before.color.g + t * (p.color.g - before.color.g),
                  before.color.b + t * (p.color.b - before.color.b)},
                 false,
                 {}});
            break;
        }
        p.x *= scale;
        points.push_back(p);
    }
    if (points.back().x < 1) {
        points.push_back(points.back());
        points.back().x = 1;
    }
    tf.points = std::move(points);
    return tf;
}

} // namespace

TransferFunction fieldSliceTf(TransferFunction tf) {
    // Up to the last transparent point nothing is; from there on, all of it.
    std::size_t first = 0;
    while (first + 1 < tf.points.size() && tf.points[first + 1].opacity == 0) ++first;
    for (std::size_t i = first; i < tf.points.size(); ++i) tf.points[i].opacity = 1;
    if (first > 0) {
        ControlPoint end = tf.points[first];
        end.opacity = 0;
        tf.points.insert(tf.points.begin() + static_cast<std::ptrdiff_t>(first), end);
    }
    return tf;
}

MeasureInput fieldInput(const Scene& scene) {
    const FieldKind kind = *scene.session.field->kind;
    MeasureInput input = measureInput(scene);
    if (kind != FieldKind::Vws && kind != FieldKind::Saliency) input.settings.vws = {};
    if (kind == FieldKind::Visibility) input.settings.saliency = {};
    if (!dependsOnView(kind)) {
        input.view = {};
        for (ControlPoint& point : input.tf.points) point.opacity = 0;
    }
    return input;
}

PictureInput fieldPictureInput(const Scene& scene, const Field& field, int width, int height, bool transparent) {
    PictureInput input = plainPictureInput(scene, width, height);
    input.settings.colors.reset();
    const FieldView& view = *scene.session.field;
    input.volume = field.volume;
    input.tf = stretched(fieldTf(view, scene.tf.features), topOf(view, field), field.volume->range().hi);
    if (!transparent) {
        input.settings.background = scene.session.display->background;
        input.settings.backgroundTop = scene.session.display->backgroundTop;
    }
    return input;
}

AnnotationInput fieldAnnotationInput(const PictureInput& picture, const Scene& scene, const Field& field,
                                     AnnotationChoice show, double density) {
    show.legend = show.title = true;
    AnnotationInput input = annotationInput(picture, show, density);
    const FieldView& view = *scene.session.field;
    input.window = {0, topOf(view, field)};
    input.tf = fieldTf(view, scene.tf.features);
    return input;
}

PictureInput plainPictureInput(const Scene& scene, int width, int height) {
    PictureInput input = pictureInput(scene, width, height, true);
    input.settings.mode = RenderMode::Composite;
    input.settings.light = {};
    input.settings.onlyFeature = -1;
    input.settings.ground.reset();
    input.settings.overlay.reset();
    input.settings.clipping.rest.density = 0; // in no feature
    return input;
}

AnnotationInput annotationInput(const PictureInput& picture, const AnnotationChoice& show, double density) {
    const Volume& volume = *picture.volume;
    TransferFunction tf = picture.tf;
    if (picture.settings.colors) { // the legend tells opacities alone: a value has no colour
        constexpr double kGrey = 0.8;
        for (ControlPoint& p : tf.points) p.color = {kGrey, kGrey, kGrey};
    }
    return {show,
            picture.camera,
            volume.geometry(),
            std::move(tf),
            volume.range(),
            isMirrorImage(volume) ? volume.title + ", mirrored" : volume.title,
            picture.settings,
            density};
}

RulerReadings readRulers(const std::vector<Ruler>& rulers, const Volume& volume, const JobControl& job) {
    RulerReadings readings;
    for (const Ruler& ruler : rulers) readings[ruler.number] = read(ruler, volume, job);
    return readings;
}

std::vector<ShownRuler> shownRulers(const Scene& scene, const RulerReadings& readings) {
    const ValueRange& range = scene.data->range();
    std::vector<ShownRuler> shown;
    for (const Ruler& ruler : *scene.session.rulers) {
        if (!ruler.shown) continue;
        const auto known = readings.find(ruler.number);
        const RulerReading reading = known != readings.end() ? known->second : readGeometry(ruler);
        shown.push_back({ruler, labelOf(reading, scene.data->geometry(), range.hi - range.lo)});
    }
    return shown;
}

void addMeasures(AnnotationInput& input, const Scene& scene, const RulerReadings& readings) {
    input.rulers = shownRulers(scene, readings);
    input.axes = scene.session.coordinates->axes;
}

} // namespace pellucid
