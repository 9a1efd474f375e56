#include "optimize/answer/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "base/color.h"
#include "base/round_numbers.h"
#include "optimize/answer/visibility_words.h"

namespace pellucid {

namespace {

constexpr double kHelps = 0.005;          ///< of F: less is not worth a word
constexpr double kWorthTurning = 0.75;    ///< of F: a view that leaves more of it is no help
constexpr double kAtBound = 1e-3;         ///< of opacity, relative
constexpr double kNothing = 1e-9;         ///< part of all visibility, or of all saliency
constexpr std::size_t kMostHelps = 3;     ///< of one kind, in words
constexpr std::size_t kViewsVerified = 3; ///< on the whole volume, until one helps

/// Around the volume: six sides and eight corners, degrees.
std::vector<ViewAngles> viewsAround(double zoom) {
    const double corner = std::atan(std::sqrt(0.5)) * 180 / std::numbers::pi;
    std::vector<ViewAngles> views{{0, 90, zoom}, {0, -90, zoom}};
    for (const double azimuth : {0.0, 90.0, 180.0, -90.0}) {
        views.push_back({azimuth, 0, zoom});
        for (const double elevation : {corner, -corner}) views.push_back({azimuth - 45, elevation, zoom});
    }
    return views;
}

double objectiveAt(const OptimizeResult& result) { return result.history[result.best].objective; }

/// What holds a feature where it is: its limits at an opacity; empty where none does.
std::optional<LimitReason> activeLimit(const OpacityLimits& limits, double opacity) {
    if (limits.locked) return LimitReason::Locked;
    if (limits.lowest > 0 && opacity <= limits.lowest * (1 + kAtBound)) return LimitReason::Lowest;
    if (limits.highest < 1 && opacity >= limits.highest * (1 - kAtBound)) return LimitReason::Highest;
    return {};
}

/// In sight and salient: of the feature alone, everything else transparent.
struct Presence {
    bool inSight = false, salient = false;
};

std::vector<Presence> presenceOf(VerdictTools& tools, const ReachProblem& problem, const JobControl& job) {
    const std::size_t n = problem.limits.size();
    std::vector<std::vector<double>> candidates;
    for (std::size_t i = 0; i < n; ++i) {
        candidates.emplace_back(n, 0.0);
        if (!problem.tf.features[i].hidden) candidates.back()[i] = 0.5;
    }
    std::vector<Presence> all;
    const std::vector<FeatureSums> sums = tools.sums(problem, candidates, job);
    for (std::size_t i = 0; i < n; ++i) {
        const double v = sums[i].visibility[i];
        all.push_back({v > kNothing * std::max(1.0, sums[i].allVisibility),
                       sums[i].weighted[0][i] > kNothing * v || sums[i].weighted[1][i] > kNothing * v});
    }
    return all;
}

OcclusionMatrix occlusionAt(VerdictTools& tools, const ReachProblem& problem, const std::vector<double>& x,
                            const JobControl& job) {
    std::vector<std::vector<double>> candidates{x};
    for (std::size_t j = 0; j < x.size(); ++j) {
        candidates.push_back(x);
        candidates.back()[j] = 0;
    }
    return occlusionOf(tools.sums(problem, candidates, job));
}

/// A colour that nothing nearby has: the opposite hue, bright and saturated.
Rgb contrasting(const Rgb& color) {
    const double most = std::max({color.r, color.g, color.b}), least = std::min({color.r, color.g, color.b});
    if (most - least < 0.05) return {1, 0.6, 0};
    Rgb opposite{most - color.r, most - color.g, most - color.b};
    const double top = std::max({opposite.r, opposite.g, opposite.b});
    for (double* c : {&opposite.r, &opposite.g, &opposite.b}) *c /= top;
    return opposite;
}

TransferFunction withColor(TransferFunction tf, std::size_t feature, const Rgb& color) {
    Feature& f = tf.features[feature];
    f.color = color;
    for (ControlPoint& p : tf.points)
        if (p.x >= f.a && p.x <= f.b) p.color = color;
    return tf;
}

std::vector<std::string> sentencesOf(const Verdict& v, const ReachProblem& problem, const std::vector<double>& targets,
                                     double tolerance) {
    const std::vector<Feature>& features = problem.tf.features;
    std::vector<std::string> sentences, shares;
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (std::abs(v.vws[i] - targets[i]) > 0.005)
            shares.push_back(features[i].name + " " + percentText(v.vws[i]) + " (wanted " + percentText(targets[i]) +
                             ")");
    sentences.push_back("Out of reach: the nearest is " + offTargetText(v.objective) +
                        (shares.empty() ? "" : ", with " + listed(shares)) + ".");
    const auto reached = [&](double objective) {
        return objective < tolerance ? std::string("the targets are reached")
                                     : "it would be " + offTargetText(objective);
    };
    std::size_t told = 0;
    for (const ReachLimit& limit : v.limits) {
        if (told++ == kMostHelps) break;
        const std::string& name = features[limit.feature].name;
        std::array<char, 64> opacity{};
        std::snprintf(opacity.data(), opacity.size(), "%.3g", v.opacity[limit.feature]);
        const auto held = [&](const char* how, const char* otherwise) {
            sentences.push_back(name + how + opacity.data() + otherwise + reached(limit.objective) + ".");
        };
        switch (limit.reason) {
        case LimitReason::Locked:
            held(" is locked at opacity ", "; unlocked, ");
            break;
        case LimitReason::Lowest:
            held(" may not be fainter than ", "; if it may, ");
            break;
        case LimitReason::Highest:
            held(" may not be more opaque than ", "; if it may, ");
            break;
        case LimitReason::OutOfSight:
            sentences.push_back("Nothing of " + name + " is in sight from here" +
                                (problem.view.clipping.isNone() ? "." : ", of what the clipping leaves."));
            break;
        case LimitReason::NoContrast:
            sentences.push_back(name + " is in sight, but its colour does not stand out from its surroundings.");
            break;
        }
    }
    if (const auto hiding = occlusionWords(v.occlusion, features); !hiding.empty())
        sentences.push_back("There, " + listed(hiding) + ".");
    for (const ReachHelp& help : v.helps) {
        switch (help.kind) {
        case ReachHelp::Kind::Release:
            break; // said of the limit
        case ReachHelp::Kind::View:
            sentences.push_back("From azimuth " + fixedText(help.view->azimuth, 0) + "°, elevation " +
                                fixedText(help.view->elevation, 0) + "° " + reached(help.objective) + ".");
            break;
        case ReachHelp::Kind::Color:
            sentences.push_back("With another colour of " + features[help.feature].name + ", such as " +
                                hexFromRgb(*help.color) + ", " + reached(help.objective) + ".");
            break;
        case ReachHelp::Kind::Clipping:
            sentences.push_back("Without clipping " + reached(help.objective) + ".");
            break;
        }
    }
    return sentences;
}

} // namespace

Verdict explain(VerdictTools& tools, const ReachProblem& problem, const std::vector<double>& targets,
                const OptimizeResult& found, const VerdictOptions& options, const JobControl& job) {
    const std::size_t n = problem.tf.features.size();
    const OptimizeState& nearest = found.history[found.best];
    Verdict verdict{nearest.objective, nearest.vws, nearest.opacity, {}, {}, {}, {}};
    verdict.occlusion = occlusionAt(tools, problem, nearest.opacity, job);
    if (nearest.objective < options.tolerance) {
        verdict.sentences = {"Within reach: Newton's method comes within " + percentText(nearest.objective) +
                             " of the targets."};
        return verdict;
    }

    const auto helps = [&](double objective) { return objective < nearest.objective - kHelps; };
    for (std::size_t j = 0; j < n; ++j) {
        const auto reason = activeLimit(problem.limits[j], nearest.opacity[j]);
        if (!reason || problem.tf.features[j].hidden) continue;
        ReachProblem released = problem;
        released.limits[j] = {};
        const double objective = objectiveAt(tools.solve(released, false, job));
        if (!helps(objective)) continue;
        verdict.limits.push_back({j, *reason, objective});
        verdict.helps.push_back({ReachHelp::Kind::Release, j, {}, {}, objective});
    }
    std::ranges::stable_sort(verdict.limits, {}, &ReachLimit::objective);

    const std::vector<Presence> presence = presenceOf(tools, problem, job);
    bool outOfSight = false;
    std::vector<ReachLimit> absent;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(targets[i] > 0) || presence[i].salient || problem.tf.features[i].hidden) continue;
        absent.push_back(
            {i, presence[i].inSight ? LimitReason::NoContrast : LimitReason::OutOfSight, nearest.objective});
        outOfSight = outOfSight || !presence[i].inSight;
        if (!presence[i].inSight) continue;
        ReachProblem recolored = problem;
        const Rgb color = contrasting(problem.tf.features[i].color);
        recolored.tf = withColor(problem.tf, i, color);
        if (const double objective = objectiveAt(tools.solve(recolored, false, job)); helps(objective))
            verdict.helps.push_back({ReachHelp::Kind::Color, i, {}, color, objective});
    }
    // What is not there limits more than what is held.
    std::ranges::stable_sort(absent, std::greater{}, [&](const ReachLimit& limit) { return targets[limit.feature]; });
    verdict.limits.insert(verdict.limits.begin(), absent.begin(), absent.end());

    if (!problem.view.clipping.isNone()) {
        ReachProblem whole = problem;
        whole.view.clipping.setPart({});
        if (const double objective = objectiveAt(tools.solve(whole, false, job)); helps(objective))
            verdict.helps.push_back({ReachHelp::Kind::Clipping, 0, {}, {}, objective});
    }
    // Where every limit could be lifted by a word, no other view is needed; elsewhere the best of those around.
    const bool held = !verdict.limits.empty() || outOfSight;
    if (options.otherViews && held) {
        const Camera& camera = problem.view.camera;
        const double zoom = std::min(viewAngles(camera, tools.geometry()).zoom, 1.0);
        const auto seenFrom = [&](const ViewAngles& angles) {
            ReachProblem other = problem;
            other.view.camera =
                cameraFromView(tools.geometry(), angles.azimuth, angles.elevation, angles.zoom, camera.projection);
            return other;
        };
        const auto isWorthTurning = [&](double objective) {
            return helps(objective) && (objective < options.tolerance || objective < kWorthTurning * nearest.objective);
        };
        std::vector<ReachHelp> promising;
        const std::vector<ViewAngles> around = viewsAround(zoom);
        for (std::size_t k = 0; k < around.size(); ++k) {
            job.report(static_cast<double>(k) / static_cast<double>(around.size()));
            const double objective = objectiveAt(tools.solve(seenFrom(around[k]), true, job));
            promising.push_back({ReachHelp::Kind::View, 0, around[k], {}, objective});
        }
        std::ranges::stable_sort(promising, {}, &ReachHelp::objective);
        for (std::size_t k = 0; k < kViewsVerified; ++k) {
            ReachHelp& help = promising[k];
            if (!helps(help.objective)) break;
            help.objective = objectiveAt(tools.solve(seenFrom(*help.view), false, job));
            if (!isWorthTurning(help.objective)) continue;
            verdict.helps.push_back(help);
            break;
        }
    }
    std::ranges::stable_sort(verdict.helps, {}, &ReachHelp::objective);
    verdict.sentences = sentencesOf(verdict, problem, targets, options.tolerance);
    return verdict;
}

} // namespace pellucid
