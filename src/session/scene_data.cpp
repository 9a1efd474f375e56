#include "session/scene_data.h"

#include <algorithm>

#include "session/ground_file.h"
#include "session/overlay_file.h"
#include "tf/hsb_colors.h"
#include "volume/orientation.h"

namespace pellucid {

VolatilityKind volatilityKind(const Session& session) {
    return session.measure->profile == Profile::Published ? VolatilityKind::Published : VolatilityKind::Population;
}

std::vector<std::string> openingNoticesIn(const Scene& scene, const ReadTf& read) {
    // The published profile takes Voreen's files as the thesis did.
    if (read.opensAsItIs && scene.session.measure->profile == Profile::Published) return {};
    return openingNotices(read, scene.data->geometry(), read.spansData ? dataRangeOf(scene) : scene.volume->range());
}

ValueRange dataRangeOf(const Scene& scene) {
    const std::optional<ValueRange> all = scene.series->varies() ? scene.series->knownRange() : std::nullopt;
    return all ? *all : scene.data->dataRange();
}

std::string frameOfDataRange(const Scene& scene) {
    if (!scene.series->varies() || scene.series->knownRange()) return {};
    return "frame " + std::to_string(scene.series->nearest(scene.session.frame));
}

TfToWrite toWrite(const TransferFunction& tf, const Scene& scene, const std::string& path,
                  const std::optional<ValueRange>& window) {
    TfToWrite writing{tf, window.value_or(scene.volume->range()), scene.volume->geometry(), presetNameOf(path),
                      dataRangeOf(scene)};
    writing.sayDataIsOf(frameOfDataRange(scene));
    return writing;
}

TransferFunction forScene(const ReadTf& read, const Scene& scene) {
    TransferFunction tf = forVolume(read, *scene.data);
    if (const ValueRange range = dataRangeOf(scene); read.spansData && range.lo < range.hi) tf.range = range;
    return tf;
}

bool sameOrigin(const Variable& a, const Variable& b) {
    return a.derivation == b.derivation && (a.derivation || a.source == b.source);
}

bool sameData(const std::vector<Variable>& a, const std::vector<Variable>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Variable& v, const Variable& w) {
        return v.name == w.name && sameOrigin(v, w) && v.window == w.window;
    });
}

std::vector<std::string> filesOf(const Session& session) {
    std::vector<std::string> files;
    const auto add = [&](const VolumeSource& source) {
        if (source.path.empty()) return;
        for (std::string& file : filesOf(source)) files.push_back(std::move(file));
    };
    for (const Variable& variable : *session.variables)
        if (!variable.derivation) add(variable.source);
    add(sourceOf(*session.ground));
    add(session.overlay->source);
    return files;
}

ValueRange windowOf(const Variable& variable, TimeSeries& series, const JobControl& job) {
    return variable.window ? *variable.window : series.range(job);
}

std::shared_ptr<const Volume> throughWindow(const std::shared_ptr<const Volume>& data,
                                            const std::optional<ValueRange>& window) {
    if (!window || *window == data->range() || !(window->lo < window->hi)) return data;
    return std::make_shared<const Volume>(data->withRange(*window));
}

// ---- variables

std::shared_ptr<TimeSeries> SeriesFinder::find(const std::string& name) {
    const Session& session = m_scene.session;
    if (!session.isEmpty() && session.variable().name == name && m_scene.series) return m_scene.series;
    if (const auto known = m_scene.others.find(name); known != m_scene.others.end()) return known->second;
    if (std::find(m_path.begin(), m_path.end(), name) != m_path.end())
        throw UsageError("it is made of itself", "variable " + name, "make it of another variable");
    m_path.push_back(name);
    std::shared_ptr<TimeSeries> series;
    if (const Variable* variable = session.variableNamed(name))
        series = of(*variable);
    else if (const auto derivation = parseDerivation(name))
        series = derived(name, *derivation);
    else
        throw UsageError("there is no variable of this name", "variable " + name, "the variables are " + knownNames());
    m_path.pop_back();
    m_scene.others[name] = series;
    return series;
}

std::shared_ptr<TimeSeries> SeriesFinder::of(const Variable& variable) {
    if (variable.derivation) return derived(variable.name, *variable.derivation);
    for (const Variable& before : *m_basis.session.variables)
        if (sameOrigin(before, variable))
            if (const auto series = knownOf(before.name)) return series;
    VolumeSource source = variable.source;
    source.range.reset();
    return TimeSeries::open(source, m_then, m_job);
}

std::shared_ptr<TimeSeries> SeriesFinder::knownOf(const std::string& name) const {
    if (!m_basis.session.isEmpty() && m_basis.session.variable().name == name) return m_basis.series;
    const auto found = m_basis.others.find(name);
    return found == m_basis.others.end() ? nullptr : found->second;
}

std::shared_ptr<TimeSeries> SeriesFinder::derived(const std::string& name, const Derivation& derivation) {
    std::shared_ptr<TimeSeries> base = find(derivation.of);
    const VolatilityKind kind = volatilityKind(m_scene.session);
    const bool sameKind = derivation.kind != Derivation::Kind::Volatility || m_basis.session.isEmpty() ||
                          kind == volatilityKind(m_basis.session);
    if (const auto before = sameKind ? knownOf(name) : nullptr; before && knownOf(derivation.of) == base) {
        const Variable* variable = m_basis.session.variableNamed(name);
        if (variable == nullptr || variable->derivation == derivation) return before;
    }
    return derive(std::move(base), derivation, m_job, kind);
}

bool SeriesFinder::isKnown(const Variable& variable) const {
    const auto& before = *m_basis.session.variables;
    if (variable.derivation) {
        const Variable* base = m_scene.session.variableNamed(variable.derivation->of);
        return base != nullptr && base->derivation == std::nullopt && isKnown(*base) &&
               knownOf(variable.name) != nullptr;
    }
    return std::any_of(before.begin(), before.end(),
                       [&](const Variable& v) { return sameOrigin(v, variable) && knownOf(v.name) != nullptr; });
}

void SeriesFinder::keepKnown() {
    const std::vector<Variable>& all = *m_scene.session.variables;
    for (std::size_t i = 1; i < all.size(); ++i)
        if (isKnown(all[i])) find(all[i].name);
    // What channels name besides, whether they are drawn now or not.
    const HsbMapping& hsb = *m_scene.session.hsb;
    for (const std::string& name : {hsb.saturation, hsb.brightness, hsb.hue}) {
        if (name.empty() || m_scene.session.variableNamed(name) != nullptr || knownOf(name) == nullptr) continue;
        const Variable* of = m_scene.session.variableNamed(parseDerivation(name)->of);
        if (of != nullptr && isKnown(*of)) find(name);
    }
}

void openNewVariables(Scene& scene, const Scene& basis, const MemoryUse& then, const JobControl& job) {
    SeriesFinder finder(scene, basis, then, job);
    for (const Variable& variable : *scene.session.variables) {
        const Variable* before = basis.session.variableNamed(variable.name);
        if (before != nullptr && sameOrigin(*before, variable)) continue;
        const auto series = finder.find(variable.name);
        static_cast<void>(series->load(series->nearest(scene.session.frame), job));
    }
}

std::string SeriesFinder::knownNames() const {
    return joined(*m_scene.session.variables, ", ", &Variable::name) +
           "; or gradient:NAME, volatility:NAME:FRAMES, difference:NAME:FRAME";
}

// ---- targets

FeatureGoals goalsAt(const Session& session, int frame) {
    FeatureGoals goals = *session.goals;
    if (session.targetKeys->empty()) return goals;
    for (const auto& [id, target] : targetsBetween(*session.targetKeys, frame))
        if (const auto goal = goals.find(id); goal != goals.end()) goal->second.target = target;
    return goals;
}

void followTargetKeys(Session& session, const Scene& basis) {
    if (session.targetKeys->empty()) return;
    if (basis.session.frame == session.frame && session.targetKeys.isSame(basis.session.targetKeys)) {
        if (session.goals.isSame(basis.session.goals)) return;
        const auto targetsIn = [](const FeatureGoals& goals) {
            std::map<FeatureId, double> targets;
            for (const auto& [id, goal] : goals) targets[id] = goal.target;
            return targets;
        };
        std::map<FeatureId, double> targets = targetsIn(*session.goals);
        if (targets != targetsIn(*basis.session.goals))
            session.targetKeys.edit([&](TargetKeys& keys) { keys[session.frame] = std::move(targets); });
        return;
    }
    session.goals.set(goalsAt(session, session.frame));
}

// ---- colours

namespace {

/// The frame of a variable on the grid of the picture, through its window. Null for an empty name.
std::shared_ptr<const Volume> channelOf(Scene& scene, SeriesFinder& finder, const std::string& name,
                                        const JobControl& job) {
    if (name.empty()) return nullptr;
    const std::shared_ptr<TimeSeries> series = finder.find(name);
    const Variable* variable = scene.session.variableNamed(name);
    std::optional<ValueRange> window = variable != nullptr ? variable->window : std::nullopt;
    const std::optional<Derivation> derivation = variable != nullptr ? variable->derivation : parseDerivation(name);
    // Volatility is a deviation of intensities: it is its own measure.
    if (!window && derivation && derivation->kind == Derivation::Kind::Volatility) window = ValueRange{0, 1};
    std::shared_ptr<const Volume> volume = series->load(series->nearest(scene.session.frame), job);
    // Published, each frame is normalised by itself.
    if (!window && scene.session.measure->profile == Profile::Published && !volume->isConstant())
        window = volume->dataRange();
    const Geometry& grid = scene.volume->geometry();
    if (!onSameGrid(inUnit(volume->geometry(), unitOf(grid)), grid))
        volume = std::make_shared<const Volume>(resampledTo(*volume, grid, job));
    if (!window) window = series->range(job);
    return throughWindow(volume, *window);
}

/// Whether colours, and what they are made of, are those of `basis`.
bool sameColors(const Scene& scene, const Scene& basis) {
    return scene.data == basis.data && scene.session.hsb == basis.session.hsb &&
           scene.session.measure->profile == basis.session.measure->profile &&
           sameData(*scene.session.variables, *basis.session.variables);
}

} // namespace

void resolveColors(Scene& scene, const Scene& basis, SeriesFinder& finder, const JobControl& job) {
    const HsbMapping hsb = *scene.session.hsb;
    if (!hsb.on) return;
    if (basis.colors && sameColors(scene, basis)) {
        scene.colors = basis.colors;
        scene.others = basis.others;
        scene.hsbA = basis.hsbA;
        scene.hsbB = basis.hsbB;
        return;
    }
    HsbInput input;
    input.dims = scene.volume->dims();
    input.saturation = channelOf(scene, finder, hsb.saturation, job);
    input.brightness = channelOf(scene, finder, hsb.brightness, job);
    input.hue = channelOf(scene, finder, hsb.hue, job);
    // Automatic scales stay what they were when the mapping began.
    HsbMapping::Found found{hsb.saturation, hsb.brightness, {}, {}};
    const bool sameKind = basis.session.isEmpty() || volatilityKind(scene.session) == volatilityKind(basis.session);
    const auto scale = [&](const std::optional<double>& set, bool isKnown, const std::optional<double>& before,
                           const std::shared_ptr<const Volume>& v, std::optional<double>& now) {
        if (set || !v) return set.value_or(1);
        now = isKnown && before ? before : automaticScale(*v);
        return now.value_or(1); // nothing there yet, as with the first frame's volatility: found later
    };
    const HsbMapping::Found& was = hsb.found;
    scene.hsbA = input.a = scale(hsb.a, sameKind && was.saturation == hsb.saturation, was.a, input.saturation, found.a);
    scene.hsbB = input.b = scale(hsb.b, sameKind && was.brightness == hsb.brightness, was.b, input.brightness, found.b);
    input.hueFrom = hsb.hueFrom;
    input.hueTo = hsb.hueTo;
    scene.colors = std::make_shared<const VoxelColors>(hsbColors(input, job));
    scene.session.hsb.edit([&](HsbMapping& mapping) { mapping.found = found; });
}

namespace {

/// Whether what lies in the world of one lies there in the other.
bool isSameWorld(const Scene& a, const Scene& b) {
    return onSameGrid(a.volume->geometry(), b.volume->geometry()) &&
           unitOf(a.volume->geometry()) == unitOf(b.volume->geometry());
}

} // namespace

void resolveGround(Scene& scene, const Scene& basis, const JobControl& job) {
    const GroundView& view = *scene.session.ground;
    if (view.path.empty() || !view.shown) return;
    GroundView look = *basis.session.ground; // of the same heights
    look.colorMap = view.colorMap;
    look.relief = view.relief;
    if (basis.ground && look == view && isSameWorld(basis, scene)) {
        scene.ground = basis.ground;
        if (view == *basis.session.ground) return;
        Ground ground = *basis.ground;
        dressGround(ground, view);
        scene.ground = std::make_shared<const Ground>(std::move(ground));
    } else {
        scene.ground = std::make_shared<const Ground>(readGround(view, scene.volume->geometry(), job));
    }
}

void resolveOverlay(Scene& scene, const Scene& basis, const JobControl& job) {
    const OverlayView& view = *scene.session.overlay;
    if (!view.isDrawn()) return;
    const Geometry& first = scene.volume->geometry();
    const bool sameVoxels = basis.overlay && basis.session.overlay->source == view.source && isSameWorld(basis, scene);
    if (sameVoxels && view == *basis.session.overlay) {
        scene.overlay = basis.overlay;
        return;
    }
    SceneOverlay overlay = sameVoxels ? *basis.overlay : readOverlay(view, first, job);
    if (sameVoxels) dressOverlay(overlay, view);
    scene.overlay = std::make_shared<const SceneOverlay>(std::move(overlay));
}

} // namespace pellucid
