#include "session/adapt.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "base/stopwatch.h"
#include "engines/engines.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/region_colors.h"
#include "optimize/solve/log_depths.h"
#include "optimize/time/tracking.h"
#include "render/color_difference.h"
#include "session/scene_data.h"
#include "session/session_json.h"
#include "tf/opacity.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"

namespace pellucid {

namespace {

using Mode = AdaptSettings::Mode;

constexpr int kRegionSize = 512;    ///< pixels of the side of the picture that a favoured region is of
constexpr int kMetricSize = 96;     ///< likewise, of pictures that tell how much they change
constexpr double kMetricStep = 0.1; ///< of ln τ
constexpr double kUnseen = 0.03;    ///< of the mean change, that even a feature counts which is not seen
constexpr int kMovesAnew = 12;      ///< of the search where a frame is off target

/// FNV-1a, twice with different starts: 128 bits.
class Hash {
public:
    void add(const void* bytes, std::size_t count) {
        const auto* p = static_cast<const unsigned char*>(bytes);
        for (std::size_t i = 0; i < count; ++i)
            for (std::uint64_t& h : m_state) h = (h ^ p[i]) * 0x100000001b3ull;
    }
    void add(double value) {
        value += 0.0; // −0 is 0
        add(&value, sizeof value);
    }
    void add(long long value) { add(&value, sizeof value); }
    void add(const std::string& text) {
        add(static_cast<long long>(text.size()));
        add(text.data(), text.size());
    }
    std::string text() const {
        std::array<char, 40> buffer{};
        std::snprintf(buffer.data(), buffer.size(), "%016llx%016llx", static_cast<unsigned long long>(m_state[0]),
                      static_cast<unsigned long long>(m_state[1]));
        return buffer.data();
    }

private:
    std::array<std::uint64_t, 2> m_state{0xcbf29ce484222325ull, 0x6c62272e07bb0142ull};
};

void addSource(Hash& hash, const VolumeSource& source) {
    namespace fs = std::filesystem;
    const auto addFile = [&](const std::string& path) {
        hash.add(source.isSample() ? path : fs::path(path).filename().string());
        std::error_code none;
        hash.add(fs::is_regular_file(path, none) ? static_cast<long long>(fs::file_size(path, none)) : -1LL);
    };
    addFile(source.path);
    for (const std::string& path : source.more) addFile(path);
    hash.add(static_cast<long long>(source.step));
    hash.add(source.array);
    if (source.raw) {
        const RawLayout& raw = *source.raw;
        for (const long long v : {static_cast<long long>(raw.dims.x), static_cast<long long>(raw.dims.y),
                                  static_cast<long long>(raw.dims.z), static_cast<long long>(raw.type),
                                  static_cast<long long>(raw.bigEndian), static_cast<long long>(raw.skipBytes)})
            hash.add(v);
        for (int a = 0; a < 3; ++a) hash.add(raw.spacing[a]);
    }
    hash.add(source.missing.value_or(std::nan("")));
    for (const int v : {source.component, source.sampleSize, static_cast<int>(source.seed), source.downsample})
        hash.add(static_cast<long long>(v));
    if (source.region)
        for (int a = 0; a < 3; ++a) {
            hash.add(static_cast<long long>(source.region->lo[a]));
            hash.add(static_cast<long long>(source.region->hi[a]));
        }
}

void addTf(Hash& hash, const TransferFunction& tf) {
    const auto addColor = [&](const Rgb& c) {
        hash.add(c.r);
        hash.add(c.g);
        hash.add(c.b);
    };
    hash.add(static_cast<long long>(tf.points.size()));
    for (const ControlPoint& p : tf.points) {
        hash.add(p.x);
        hash.add(p.opacity);
        addColor(p.color);
        hash.add(static_cast<long long>(p.fixed));
    }
    hash.add(static_cast<long long>(tf.features.size()));
    for (const Feature& f : tf.features) {
        hash.add(f.name);
        hash.add(f.a);
        hash.add(f.b);
        addColor(f.color);
        hash.add(static_cast<long long>(f.hidden));
        hash.add(static_cast<long long>(f.id));
    }
    if (tf.range) {
        hash.add(tf.range->lo);
        hash.add(tf.range->hi);
    }
}

/// Fingerprints of one session: what its frames have in common is hashed once.
class Fingerprints {
public:
    Fingerprints(const Session& session, const TimeSeries& series) : m_session(session), m_series(series) {
        const Mode mode = session.adapt->mode;
        Session common; // nothing but what counts
        common.adapt = session.adapt;
        common.adapt.edit([](AdaptSettings& a) { a.coherence = a.usedCoherence(); });
        const bool viewed = mode == Mode::Optimize || (mode == Mode::Refine && session.refine->region);
        if (mode == Mode::Refine) {
            common.refine = session.refine;
            common.refine.edit([](RefineSettings& r) { r.live = false; });
        }
        if (viewed) {
            common.camera = session.camera;
            common.clipping = session.clipping;
        }
        if (mode == Mode::Optimize) {
            common.measure = session.measure;
            common.optimize = session.optimize;
        }
        const bool coloured = viewed && session.hsb->on; // what is measured, and what a region shows
        if (coloured) common.hsb = session.hsb;
        m_common.add(jsonFromSession(common, "", DataPaths::Absolute).dump());
        const std::size_t variables = coloured ? session.variables->size() : 1;
        for (std::size_t i = 0; i < variables; ++i) {
            const Variable& v = (*session.variables)[i];
            m_common.add(v.derivation ? v.derivation->text() : std::string());
            if (v.window) {
                m_common.add(v.window->lo);
                m_common.add(v.window->hi);
            }
            if (i > 0 || v.derivation) { // of the first one, plain, frame by frame
                m_common.add(v.name);
                addSource(m_common, v.source);
            }
        }
        // Without a window of its own it is that of all frames; what is derived may be made of several.
        const bool others = variables > 1 || session.variable().derivation.has_value();
        if (!session.variable().window || others)
            for (const SeriesFrame& frame : series.listing().frames) addSource(m_common, frame.source);
        m_needsKey = mode == Mode::Refine && session.refine->region.has_value();
    }

    std::string of(int frame, const TransferFunction& previous) const {
        Hash hash = m_common;
        addSource(hash, m_series.listing().frames[static_cast<std::size_t>(frame)].source);
        if (m_session.hsb->on) hash.add(static_cast<long long>(frame));
        addTf(hash, previous);
        const TfTrack& track = m_session.variable().track;
        if (const int key = track.keyBefore(frame); m_needsKey && key >= 0) {
            addTf(hash, *track.keys.at(key));
            addSource(hash, m_series.listing().frames[static_cast<std::size_t>(m_series.nearest(key))].source);
        }
        if (m_session.adapt->mode == Mode::Optimize) {
            const FeatureGoals goals = frame == m_session.frame ? *m_session.goals : goalsAt(m_session, frame);
            for (const double t : targetsOf(previous, goals)) hash.add(t);
            for (const OpacityLimits& limit : limitsOf(previous, goals)) {
                hash.add(limit.lowest);
                hash.add(limit.highest);
                hash.add(static_cast<long long>(limit.locked));
            }
        }
        return hash.text();
    }

private:
    const Session& m_session;
    const TimeSeries& m_series;
    Hash m_common;
    bool m_needsKey = false;
};

/// Calls `visit(task, isFresh)` for the frames that should have an adapted transfer function, in the order of
/// nextToAdapt(), until it returns false. A frame after a stale one has nothing to start from: its task is empty.
template <class Visit>
void visitFrames(const Session& session, const TimeSeries& series, const Visit& visit) {
    if (session.isEmpty() || session.adapt->mode == Mode::Static) return;
    const TfTrack& track = session.variable().track;
    if (track.keys.empty()) return;
    const Fingerprints fingerprints(session, series);
    std::vector<int> keys;
    const int present = track.keyBefore(session.frame);
    keys.push_back(present);
    for (const auto& [key, tf] : track.keys)
        if (key != present) keys.push_back(key);
    for (const int key : keys) {
        const auto next = track.keys.upper_bound(key);
        const int end = next == track.keys.end() ? series.size() : std::min(next->first, series.size());
        std::shared_ptr<const TransferFunction> previous = track.keys.at(key).shared();
        for (int frame = key; frame < end; ++frame) {
            if (!series.summary(frame).problem.empty()) continue;
            std::optional<AdaptTask> task;
            bool fresh = false;
            if (previous) {
                task = AdaptTask{frame, key, *previous, fingerprints.of(frame, *previous)};
                const auto there = track.adapted.find(frame);
                fresh = there != track.adapted.end() && there->second.basis == task->basis;
                previous = fresh ? there->second.tf.shared() : nullptr;
            }
            if (!visit(task, fresh)) return;
        }
    }
}

/// Frames from one key to the next.
struct Stretch {
    SmoothTask task;
    int all = 0, done = 0; ///< frames that should have a transfer function, and have one
    bool isSmooth = true;  ///< what was smoothed is of the present ones
};

/// What the frames from this key on begin with: what was made for its own frame, where that can be read, else the key.
const TransferFunction& startOf(const TfTrack& track, int key) {
    const auto made = track.adapted.find(key);
    return made == track.adapted.end() ? *track.keys.at(key) : *made->second.tf;
}

/// In the order of nextToAdapt().
std::vector<Stretch> stretchesOf(const Session& session, const TimeSeries& series) {
    std::vector<Stretch> stretches;
    std::vector<std::vector<std::string>> bases;
    visitFrames(session, series, [&](const std::optional<AdaptTask>& task, bool fresh) {
        if (task && (stretches.empty() || stretches.back().task.key != task->key)) {
            stretches.emplace_back().task.key = task->key;
            bases.emplace_back();
        }
        Stretch& stretch = stretches.back(); // the first frame from a key on has a task
        ++stretch.all;
        if (!fresh) return true;
        ++stretch.done;
        stretch.task.frames.push_back(task->frame);
        bases.back().push_back(task->basis);
        return true;
    });
    if (!smooths(*session.adapt)) return stretches;
    const TfTrack& track = session.variable().track;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        Stretch& stretch = stretches[i];
        if (stretch.done < stretch.all) {
            stretch.isSmooth = false;
            continue;
        }
        Hash hash;
        for (const std::string& basis : bases[i]) hash.add(basis);
        addTf(hash, *track.adapted.at(stretch.task.frames.back()).tf); // those before it are in the next one's basis
        if (const auto next = track.keys.upper_bound(stretch.task.key); next != track.keys.end())
            addTf(hash, startOf(track, next->first));
        stretch.task.basis = hash.text();
        if (session.adapt->mode == Mode::Optimize && track.keys.at(stretch.task.key)->features.empty())
            continue; // nothing was optimized
        for (const int frame : stretch.task.frames)
            stretch.isSmooth = stretch.isSmooth && track.adapted.at(frame).smooth &&
                               track.adapted.at(frame).smoothBasis == stretch.task.basis;
    }
    return stretches;
}

TransferFunction writtenFor(const TransferFunction& tf, const ValueRange& window) {
    return window.lo < window.hi && tf.range ? inRange(tf, window) : tf;
}

/// One number per frame that minimises Σ (x_t − r_t)² + λ Σ (x_t − x_(t−1))²; where `lastStays` the last is r's. A
/// tridiagonal system. No number goes to and fro more than before.
std::vector<double> withSmallSteps(const std::vector<double>& r, double weight, bool lastStays) {
    const std::size_t n = r.size();
    std::vector<double> x(n), above(n); // elimination: what is left is x_t = x[t] + above[t]·x_(t+1)
    for (std::size_t t = 0; t < n; ++t) {
        const bool last = t + 1 == n;
        if (last && lastStays) {
            x[t] = r[t];
            break;
        }
        const double before = t > 0 ? weight : 0, after = last ? 0 : weight;
        const double pivot = 1 + before + after - (t > 0 ? before * above[t - 1] : 0);
        above[t] = after / pivot;
        x[t] = (r[t] + (t > 0 ? before * x[t - 1] : 0)) / pivot;
    }
    for (std::size_t t = n - 1; t-- > 0;) x[t] += above[t] * x[t + 1];
    return x;
}

/// A chain of refinements with small steps: of the opacity of each point, or where points have come or moved on the way
/// of each feature's peak.
void holdBackJumps(std::vector<TransferFunction>& tfs, double coherence, bool lastStays) {
    const auto samePlaces = [&](const TransferFunction& tf) {
        return std::equal(tf.points.begin(), tf.points.end(), tfs.front().points.begin(), tfs.front().points.end(),
                          [](const ControlPoint& p, const ControlPoint& q) { return p.x == q.x; });
    };
    const bool byPoints = std::all_of(tfs.begin(), tfs.end(), samePlaces);
    std::vector<std::vector<double>> opacities; // [frame][point or feature]
    for (const TransferFunction& tf : tfs) {
        std::vector<double>& all = opacities.emplace_back(byPoints ? std::vector<double>() : featureOpacities(tf));
        for (std::size_t p = 0; byPoints && p < tf.points.size(); ++p) all.push_back(tf.points[p].opacity);
    }
    for (std::size_t i = 0; i < opacities.front().size(); ++i) {
        std::vector<double> one;
        for (const auto& all : opacities) one.push_back(all[i]);
        one = withSmallSteps(one, coherence, lastStays);
        for (std::size_t t = 0; t < one.size(); ++t) opacities[t][i] = std::clamp(one[t], 0.0, 1.0);
    }
    for (std::size_t t = 0; t < tfs.size(); ++t) {
        if (!byPoints) tfs[t] = withFeatureOpacities(tfs[t], opacities[t]);
        for (std::size_t p = 0; byPoints && p < tfs[t].points.size(); ++p) tfs[t].points[p].opacity = opacities[t][p];
    }
}

/// How much pictures change with ln τ of each feature: the mean over the pixels of a small picture of ⟨∂Lab/∂y_i,
/// ∂Lab/∂y_j⟩, so that a jump is a root mean square ΔE. Empty where the picture shows no change at all.
std::vector<std::vector<double>> pictureMetric(const Scene& scene, const JobControl& job) {
    const auto renderer = makeRenderer(scene.session.measure->engine, scene.volume);
    Scene plain = scene; // no figure depends on how it is displayed
    plain.session.display.set({});
    plain.ground.reset();
    PictureInput picture = pictureInput(plain, kMetricSize, kMetricSize);
    picture.settings.finestInD0.reset();
    const auto labOf = [&](const TransferFunction& tf) {
        return labPixels(renderer->render(picture.camera, tf, picture.settings, job));
    };
    const std::vector<double> base = labOf(picture.tf), x = featureOpacities(picture.tf);
    const std::size_t n = x.size();
    std::vector<std::vector<double>> changes(n);
    for (std::size_t f = 0; f < n; ++f) {
        if (picture.tf.features[f].hidden || x[f] <= 0) continue;
        std::vector<double> moved = x;
        moved[f] = opacityOfStep(x[f], std::exp(kMetricStep));
        changes[f] = labOf(withFeatureOpacities(picture.tf, moved));
        for (std::size_t i = 0; i < base.size(); ++i) changes[f][i] = (changes[f][i] - base[i]) / kMetricStep;
    }
    std::vector<std::vector<double>> metric(n, std::vector<double>(n, 0.0));
    double trace = 0;
    for (std::size_t f = 0; f < n; ++f)
        for (std::size_t g = 0; g <= f; ++g) {
            if (changes[f].empty() || changes[g].empty()) continue;
            double sum = 0;
            for (std::size_t i = 0; i < base.size(); ++i) sum += changes[f][i] * changes[g][i];
            metric[f][g] = metric[g][f] = sum / (static_cast<double>(base.size()) / 3);
            trace += f == g ? metric[f][g] : 0;
        }
    if (!(trace > 0)) return {};
    // What is not seen should not wander either.
    for (std::size_t f = 0; f < n; ++f) metric[f][f] += kUnseen * trace / static_cast<double>(n);
    return metric;
}

/// What a model depends on: the transfer function, and what that depends on.
std::string modelBasis(const TransferFunction& tf, const std::string& basis) {
    Hash hash;
    hash.add(basis);
    addTf(hash, tf);
    return hash.text();
}

/// Not so in a frame in which no feature has a voxel.
/// Of the scene's frame at `opacity`. `metric`: pictureMetric() under the transfer function of the frame before.
FrameModel modelOf(const Scene& scene, const VwsFunction& function, std::vector<double> opacity,
                   const AdaptSettings& settings, std::vector<std::vector<double>> metric, const JobControl& job) {
    std::vector<double> below1 = opacity; // where derivatives are
    for (double& x : below1) x = std::min(x, kMaxOpacity);
    VwsFunction::Linear linear = function.jacobian(below1, job);
    FrameModel model;
    model.targets = scene.targets();
    if (isAimed(model.targets)) model.targets = normalizedTargets(model.targets, function.featureCount());
    TrackOptions track;
    track.coherence = settings.usedCoherence();
    model.distance = std::max(std::hypot(track.distance(), leastDistance(linear.vws, linear.derivative, model.targets)),
                              objectiveOf(linear.vws, model.targets));
    model.opacity = std::move(opacity);
    model.vws = std::move(linear.vws);
    model.derivative = std::move(linear.derivative);
    model.metric = std::move(metric);
    model.limits = limitsOfMoves(function.base(), limitsOf(scene.tf, *scene.session.goals));
    return model;
}

/// A part of the way from one to the other in ln τ; the ends themselves at 0 and 1.
std::vector<double> opacitiesBetween(const std::vector<double>& from, const std::vector<double>& to, double part) {
    std::vector<double> x = to;
    for (std::size_t f = 0; f < x.size(); ++f) {
        if (part >= 1 || from[f] == to[f] || from[f] <= 0 || to[f] <= 0) continue;
        const double a = logDepthOf(from[f]);
        x[f] = opacityOfLogDepth(a + part * (logDepthOf(to[f]) - a));
    }
    return x;
}

} // namespace

bool smooths(const AdaptSettings& settings) {
    return settings.mode != Mode::Static && settings.usedCoherence() > 0 && !std::isinf(settings.usedCoherence());
}

std::string fingerprintOf(const Session& session, const TimeSeries& series, int frame,
                          const TransferFunction& previous) {
    return Fingerprints(session, series).of(frame, previous);
}

std::optional<AdaptTask> nextToAdapt(const Session& session, const TimeSeries& series) {
    std::optional<AdaptTask> next;
    visitFrames(session, series, [&](std::optional<AdaptTask>& task, bool fresh) {
        if (fresh || !task) return true;
        next = std::move(task);
        return false;
    });
    return next;
}

int firstStale(const Session& session, const TimeSeries& series) {
    const auto next = nextToAdapt(session, series);
    return next ? next->frame : -1;
}

AdaptProgress adaptProgress(const Session& session, const TimeSeries& series) {
    AdaptProgress progress;
    for (const Stretch& stretch : stretchesOf(session, series)) {
        progress.all += stretch.all;
        progress.done += stretch.done;
        progress.smooth += stretch.isSmooth ? stretch.all : 0;
    }
    return progress;
}

std::optional<SmoothTask> nextToSmooth(const Session& session, const TimeSeries& series) {
    if (!smooths(*session.adapt)) return {};
    for (Stretch& stretch : stretchesOf(session, series))
        if (stretch.done == stretch.all && !stretch.isSmooth) return std::move(stretch.task);
    return {};
}

Scene sceneAt(const Scene& basis, int frame, const TransferFunction& tf, const JobControl& job) {
    Session session = basis.session;
    session.frame = frame;
    if (basis.series->varies() && frame != basis.session.frame) // with histogram and codes
        basis.series->show(frame, windowOf(session.variable(), *basis.series, job), job);
    Scene scene = resolve(std::move(session), basis, {}, job);
    scene.tf = writtenFor(tf, scene.volume->range());
    return scene;
}

RefinePriority FrameAdapter::priorityOf(const Scene& basis, const AdaptTask& task, const JobControl& job) {
    const RefineSettings& settings = *basis.session.refine;
    RefinePriority priority;
    priority.intensity = settings.intensity;
    if (settings.intensity || !settings.region) return priority;
    // The colours that somebody has chosen are those of the key frame, whatever lies there later.
    const auto& key = *basis.session.variable().track.keys.at(task.key);
    const std::string wanted = fingerprintOf(basis.session, *basis.series, task.key, key);
    if (m_regionBasis != wanted) {
        m_regionBasis.clear();
        const Scene scene = sceneAt(basis, task.key, key, job);
        const PictureInput picture = plainPictureInput(scene, kRegionSize, kRegionSize);
        // Always by the cpu renderer: the same answer on every machine.
        const Image image = makeCpuRenderer(picture.volume)->render(picture.camera, picture.tf, picture.settings, job);
        m_colors = regionColors(image, *settings.region);
        m_regionBasis = wanted;
    }
    priority.region = m_colors;
    return priority;
}

AdaptedFrame FrameAdapter::adapt(const Scene& basis, const AdaptTask& task, Workspace& workspace,
                                 const JobControl& job) {
    const Stopwatch watch;
    const JobControl quiet{job.stop, {}};
    const AdaptSettings& settings = *basis.session.adapt;
    AdaptedFrame made;
    made.frame = task.frame;
    made.basis = task.basis;
    made.tf = task.previous;
    const RefinePriority priority = settings.mode == Mode::Refine ? priorityOf(basis, task, quiet) : RefinePriority{};
    Scene scene = sceneAt(basis, task.frame, task.previous, quiet);
    if (settings.mode == Mode::Refine) {
        RefineOptions options = basis.session.refine->options();
        options.priority = priority;
        made.tf = scene.tf;
        if (!std::isinf(settings.usedCoherence())) {
            RefineResult result =
                refineAsDrawn(*scene.histogram, scene.tf, *scene.volume, scene.colors.get(), options, quiet);
            made.tf = std::move(result.tf);
            made.energy = result.energyMovableAfter;
            made.moves = result.iterations;
        }
    } else if (settings.mode == Mode::Optimize && isAimed(scene.targets())) { // else nothing of it is in the frame
        const MeasureInput input = measureInput(scene);
        const std::vector<double> targets = scene.targets();
        const std::vector<OpacityLimits> limits = limitsOf(scene.tf, *scene.session.goals);
        VisibilityEngine& engine = workspace.engine(input);
        const EngineVws function(engine, input.view, input.tf, workspace.weights(input, quiet), input.settings.vws);
        TrackOptions track;
        track.coherence = settings.usedCoherence();
        std::optional<std::vector<std::vector<double>>> metric;
        if (smooths(settings)) track.metric = [&] { return *(metric = pictureMetric(scene, quiet)); };
        Tracked found = pellucid::track(function, targets, limits, track, quiet);
        // Moves downhill are stuck far from the targets: other starts may not be.
        const double enough = std::hypot(std::max(basis.session.optimize->tolerance, track.distance()), found.least);
        MeasureInput from = input;
        from.tf = withFeatureOpacities(input.tf, found.opacity);
        // Nor do they know whether anything of the shares can be seen.
        const bool vanishes = !basis.session.optimize->exactShares &&
                              isFaint(workspace.coverage(from, quiet), normalizedTargets(targets, targets.size()));
        if (!std::isinf(settings.usedCoherence()) && (found.objective > enough || vanishes)) {
            OptimizeOptions options = *basis.session.optimize;
            options.method = SearchMethod::Newton;
            options.coverage.reset();
            options.maxIterations = kMovesAnew;
            const OptimizeResult anew = workspace.optimize(from, targets, limits, options, quiet);
            if (anew.reason == StopReason::Cancelled) throw Cancelled{};
            if (const OptimizeState& best = anew.history[anew.best]; vanishes || best.objective < enough) {
                found.opacity = best.opacity;
                found.vws = best.vws;
                found.objective = best.objective;
                found.moves += anew.iterations();
            }
        }
        made.tf = std::isinf(settings.usedCoherence()) ? scene.tf : withShownOpacities(scene.tf, found.opacity);
        if (smooths(settings)) { // while the frame is at hand
            if (!metric) metric = pictureMetric(scene, quiet);
            m_models[task.frame] = {modelBasis(made.tf, task.basis),
                                    modelOf(scene, function, found.opacity, settings, std::move(*metric), quiet)};
        }
        made.vws = std::move(found.vws);
        made.objective = found.objective;
        made.moves = found.moves;
    }
    made.seconds = watch.seconds();
    return made;
}

SmoothedFrames FrameAdapter::smooth(const Scene& basis, const SmoothTask& task, Workspace& workspace,
                                    const JobControl& job) {
    const Stopwatch watch;
    const JobControl quiet{job.stop, {}};
    const AdaptSettings& settings = *basis.session.adapt;
    const TfTrack& track = basis.session.variable().track;
    const TimeSeries& series = *basis.series;
    std::vector<int> frames = task.frames;
    std::vector<TransferFunction> tfs;
    for (const int frame : frames) tfs.push_back(*track.adapted.at(frame).tf);
    const auto next = track.keys.upper_bound(task.key);
    const bool hasNext = next != track.keys.end() && next->first < series.size() &&
                         next->second->features.size() == tfs.front().features.size() &&
                         series.summary(next->first).problem.empty();
    if (hasNext) {
        frames.push_back(next->first);
        tfs.push_back(startOf(track, next->first));
    }
    const auto stays = [&](std::size_t i) { return hasNext && i + 1 == frames.size(); };
    SmoothedFrames smoothed;
    smoothed.basis = task.basis;
    const auto put = [&](std::size_t i, TransferFunction tf) {
        smoothed.tfs[frames[i]] = std::move(tf);
        smoothed.from[frames[i]] = track.adapted.at(frames[i]).basis;
    };
    if (settings.mode == Mode::Refine) {
        holdBackJumps(tfs, settings.usedCoherence(), hasNext);
        for (std::size_t i = 0; i < frames.size(); ++i)
            if (!stays(i)) put(i, std::move(tfs[i]));
        smoothed.seconds = watch.seconds();
        return smoothed;
    }
    const auto withFunction = [&](std::size_t i, const auto& use) {
        const Scene scene = sceneAt(basis, frames[i], tfs[i], quiet);
        tfs[i] = scene.tf;
        const MeasureInput input = measureInput(scene);
        VisibilityEngine& engine = workspace.engine(input);
        use(scene, EngineVws(engine, input.view, input.tf, workspace.weights(input, quiet), input.settings.vws));
    };

    std::vector<FrameModel> models(frames.size());
    double allowed = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        job.throwIfStopped();
        job.report(0.5 * static_cast<double>(i) / static_cast<double>(frames.size()));
        FrameModel& model = models[i];
        model.stays = stays(i);
        const TransferFunction& before = i == 0 ? *track.keys.at(task.key) : tfs[i - 1];
        if (model.stays) { // what a jump to it would be is all that counts
            const Scene scene = sceneAt(basis, frames[i], before, quiet);
            model.opacity = featureOpacities(shownTf(tfs[i]));
            model.metric = pictureMetric(scene, quiet);
            continue;
        }
        const std::string of = modelBasis(tfs[i], track.adapted.at(frames[i]).basis);
        if (const auto known = m_models.find(frames[i]); known != m_models.end() && known->second.basis == of) {
            model = known->second.model;
        } else {
            auto metric = pictureMetric(sceneAt(basis, frames[i], before, quiet), quiet);
            withFunction(i, [&](const Scene& scene, const EngineVws& function) {
                model = modelOf(scene, function, featureOpacities(function.base()), settings, std::move(metric), quiet);
            });
            m_models[frames[i]] = {of, model};
        }
        allowed += model.distance * model.distance;
    }
    std::vector<std::vector<double>> found;
    if (models.size() > 1)
        found = pellucid::smoothed(models, quiet);
    else
        found = {models.front().opacity}; // a frame alone jumps nowhere

    // Models are not exact: as far of the way as the distance allows.
    constexpr std::array<double, 7> kParts{1, 0.97, 0.93, 0.88, 0.8, 0.6, 0.3};
    std::array<double, kParts.size()> sums{};
    std::vector<std::vector<std::vector<double>>> ways(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        job.throwIfStopped();
        job.report(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(frames.size()));
        if (stays(i)) continue;
        for (const double part : kParts) ways[i].push_back(opacitiesBetween(models[i].opacity, found[i], part));
        withFunction(i, [&](const Scene&, const EngineVws& function) {
            const auto vws = function.evaluate(ways[i], quiet);
            for (std::size_t p = 0; p < kParts.size(); ++p) {
                const double objective = objectiveOf(vws[p], models[i].targets);
                sums[p] += objective * objective;
            }
        });
    }
    std::size_t part = 0;
    while (part < kParts.size() && !(sums[part] <= allowed)) ++part;

    for (std::size_t i = 0; i < frames.size(); ++i)
        if (!stays(i)) put(i, withShownOpacities(tfs[i], part < kParts.size() ? ways[i][part] : models[i].opacity));
    smoothed.seconds = watch.seconds();
    return smoothed;
}

bool adaptsOtherwise(const Session& a, const Session& b) {
    return !a.variables.isSame(b.variables) || !a.adapt.isSame(b.adapt) || !a.targetKeys.isSame(b.targetKeys) ||
           !a.goals.isSame(b.goals) || !a.refine.isSame(b.refine) || !a.optimize.isSame(b.optimize) ||
           !a.measure.isSame(b.measure) || !a.clipping.isSame(b.clipping) || !a.hsb.isSame(b.hsb) ||
           a.camera != b.camera || a.frame != b.frame;
}

void setTfKey(Session& session) {
    const TransferFunction tf = *session.tf();
    session.variables.edit([&](std::vector<Variable>& all) {
        all.front().track.keys[session.frame] = Part<TransferFunction>(tf);
        all.front().track.adapted.erase(session.frame);
    });
}

void removeTfKey(Session& session) {
    session.variables.edit([&](std::vector<Variable>& all) { all.front().track.keys.erase(session.frame); });
}

void beginTracksHere(Session& session) {
    setTfKey(session);
    session.variables.edit([&](std::vector<Variable>& all) {
        TfTrack& track = all.front().track;
        track.keys.erase(track.keys.upper_bound(session.frame), track.keys.end());
        track.adapted.erase(track.adapted.lower_bound(session.frame), track.adapted.end());
    });
}

void setTargetKey(Session& session) {
    std::map<FeatureId, double> targets;
    for (const auto& [id, goal] : *session.goals) targets[id] = goal.target;
    session.targetKeys.edit([&](TargetKeys& keys) { keys[session.frame] = std::move(targets); });
}

std::optional<int> keyBeside(const Session& session, int frame, int direction) {
    std::set<int> frames;
    for (const auto& [key, tf] : session.variable().track.keys) frames.insert(key);
    for (const auto& [key, targets] : *session.targetKeys) frames.insert(key);
    const auto after = frames.upper_bound(frame), here = frames.lower_bound(frame);
    if (direction > 0 && after != frames.end()) return *after;
    if (direction < 0 && here != frames.begin()) return *std::prev(here);
    return {};
}

Session withAdapted(Session session, int frame, AdaptedTf adapted) {
    session.variables.edit([&](std::vector<Variable>& all) { all.front().track.adapted[frame] = std::move(adapted); });
    return session;
}

Session withSmoothed(Session session, const SmoothedFrames& smoothed) {
    session.variables.edit([&](std::vector<Variable>& all) {
        std::map<int, AdaptedTf>& adapted = all.front().track.adapted;
        for (const auto& [frame, tf] : smoothed.tfs)
            if (const auto there = adapted.find(frame); there != adapted.end() && smoothed.from.contains(frame) &&
                                                        smoothed.from.at(frame) == there->second.basis) {
                there->second.smooth = Part<TransferFunction>(tf);
                there->second.smoothBasis = smoothed.basis;
            }
    });
    return session;
}

FrameFigures figuresOf(const Scene& scene, const TransferFunction* before, Workspace& workspace,
                       const JobControl& job) {
    FrameFigures figures;
    figures.frame = scene.session.frame;
    figures.file = scene.series->listing().fileOf(figures.frame);
    figures.time = scene.series->listing().frames[static_cast<std::size_t>(figures.frame)].time;
    figures.targets = scene.targets();
    figures.empty = emptyFeatures(scene.tf, *scene.histogram);
    const Measures measures = workspace.measure(measureInput(scene), {job.stop, {}});
    for (const FeatureMeasures& feature : measures.features) {
        figures.vws.push_back(feature.vws);
        figures.visibility.push_back(feature.visibility);
    }
    figures.opacity = measures.opacities;
    if (!figures.vws.empty()) figures.objective = objectiveOf(figures.vws, figures.targets);
    if (before == nullptr) return figures;
    figures.flicker = 0;
    if (*before == scene.tf) return figures;
    const auto renderer = makeRenderer(scene.session.measure->engine, scene.volume);
    std::array<Image, 2> pictures;
    Scene shown = scene;
    for (std::size_t i = 0; i < 2; ++i) {
        if (i == 1) shown.tf = *before;
        PictureInput picture = pictureInput(shown, kFlickerSize, kFlickerSize);
        picture.settings.finestInD0.reset(); // nor on how finely
        pictures[i] = renderer->render(picture.camera, picture.tf, picture.settings, {job.stop, {}});
    }
    figures.flicker = meanDeltaE(pictures[0], pictures[1]);
    return figures;
}

FrameFigures brokenFigures(const TimeSeries& series, int frame) {
    FrameFigures figures;
    figures.frame = frame;
    figures.file = series.listing().fileOf(frame);
    figures.time = series.listing().frames[static_cast<std::size_t>(frame)].time;
    figures.problem = series.summary(frame).problem;
    if (figures.problem.empty()) figures.problem = "it cannot be read";
    return figures;
}

int neighbourBefore(const TimeSeries& series, int frame, bool overGaps) {
    int before = frame - 1;
    if (!overGaps && series.listing().frames.at(static_cast<std::size_t>(frame)).afterGap) return -1;
    while (before >= 0 && !series.summary(before).problem.empty()) {
        if (!overGaps) return -1;
        --before;
    }
    return before;
}

SequenceFigures summaryOf(const std::vector<FrameFigures>& frames, double tolerance) {
    SequenceFigures sums;
    int flickers = 0, made = 0;
    for (const FrameFigures& f : frames) {
        if (!f.problem.empty()) {
            ++sums.broken;
            continue;
        }
        ++sums.frames;
        sums.rms += f.objective * f.objective;
        sums.above += f.objective < tolerance ? 0 : 1;
        if (sums.worst < 0 || f.objective > sums.worstObjective) {
            sums.worst = f.frame;
            sums.worstObjective = f.objective;
        }
        if (f.flicker) {
            sums.flicker += *f.flicker;
            ++flickers;
        }
        if (f.moves) {
            sums.moves += *f.moves;
            sums.seconds += f.seconds;
            ++made;
        }
    }
    if (sums.frames > 0) sums.rms = std::sqrt(sums.rms / sums.frames);
    if (flickers > 0) sums.flicker /= flickers;
    if (made > 0) {
        sums.moves /= made;
        sums.seconds /= made;
    }
    return sums;
}

} // namespace pellucid
