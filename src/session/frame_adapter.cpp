#include "session/frame_adapter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/stopwatch.h"
#include "engines/engines.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/solve/log_depths.h"
#include "optimize/time/tracking.h"
#include "session/refine_priority.h"
#include "session/scene_data.h"
#include "tf/color_difference.h"
#include "tf/opacity.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"

namespace pellucid {

namespace {

using Mode = AdaptSettings::Mode;

constexpr int kMetricSize = 96;     ///< pixels of the side of pictures that tell how much they change
constexpr double kMetricStep = 0.1; ///< of ln τ
constexpr double kUnseen = 0.03;    ///< of the mean change, that even a feature counts which is not seen
constexpr int kMovesAnew = 12;      ///< of the search where a frame is off target

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
    plain.overlay.reset();
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

TransferFunction writtenFor(const TransferFunction& tf, const ValueRange& window) {
    return window.lo < window.hi && tf.range ? inRange(tf, window) : tf;
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

const std::vector<RegionColor>& FrameAdapter::regionOf(const Scene& basis, const AdaptTask& task,
                                                       const JobControl& job) {
    const RefineSettings& settings = *basis.session.refine;
    const auto& key = *basis.session.variable().track.keys.at(task.key);
    const std::string wanted = frameFingerprint(basis.session, *basis.series, task.key, key);
    if (m_regionBasis != wanted) {
        m_regionBasis.clear();
        m_colors = regionColors(sceneAt(basis, task.key, key, job), *settings.region, regionPictureSize(settings), job);
        m_regionBasis = wanted;
    }
    return m_colors;
}

void FrameAdapter::refine(const Scene& frame, const Scene& basis, const AdaptTask& task, AdaptedFrame& made,
                          const JobControl& job) {
    made.tf = frame.tf;
    if (std::isinf(basis.session.adapt->usedCoherence())) return;
    const RefineSettings& settings = *basis.session.refine;
    RefineOptions options = refineOptions(basis.session);
    if (settings.region) options.priority.region = m_colors;
    options.priority.intensity = settings.intensity;
    // The key's opacities say which of equal hues is meant: those of the frames before may cross.
    if (settings.hue)
        options.priority = huePriority(
            frame, writtenFor(*basis.session.variable().track.keys.at(task.key), frame.volume->range()), *settings.hue);
    RefineResult result = refineAsDrawn(*frame.histogram, frame.tf, *frame.volume, frame.colors.get(), options, job);
    made.tf = std::move(result.tf);
    made.energy = {result.energyBefore, result.energyAfter, result.energyMovableBefore, result.energyMovableAfter};
    made.moves = result.iterations;
    made.priority = std::move(options.priority);
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
    if (settings.mode == Mode::Refine && basis.session.refine->region) regionOf(basis, task, quiet);
    Scene scene = sceneAt(basis, task.frame, task.previous, quiet);
    if (settings.mode == Mode::Refine) {
        refine(scene, basis, task, made, quiet);
    } else if (settings.mode == Mode::Optimize && isAimed(scene.targets())) { // else nothing of it is in the frame
        const MeasureInput input = measureInput(scene);
        const std::vector<double> targets = scene.targets();
        const std::vector<OpacityLimits> limits = limitsOf(scene.tf, *scene.session.goals);
        const EngineVws function = workspace.vws(input, quiet);
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
            m_models[task.frame] = {fingerprintWith(made.tf, task.basis),
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
        tfs.push_back(startAtKey(track, next->first));
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
        use(scene, workspace.vws(measureInput(scene), quiet));
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
        const std::string of = fingerprintWith(tfs[i], track.adapted.at(frames[i]).basis);
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

} // namespace pellucid
