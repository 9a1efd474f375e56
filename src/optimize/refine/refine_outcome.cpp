#include "optimize/refine/refine_outcome.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/round_numbers.h"
#include "optimize/coverage.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_words.h"
#include "tf/empty_features.h"

namespace pellucid {

namespace {

constexpr double kWellSeen = 0.3; ///< coverage that a way out of the dark should have

constexpr double kSame = 1e-9;  ///< relative difference of two gains that are one
constexpr double kNone = 1e-12; ///< opacity, or part of Σ α·p, that is none

double gainOf(double before, double after) {
    if (before > kNone) return after / before;
    return after > kNone ? std::numeric_limits<double>::infinity() : 0;
}

/// What a priority chose: a feature, or a place on the curve.
struct Chosen {
    std::optional<std::size_t> feature;
    double x = 0;       ///< the value that counts
    bool inside = true; ///< the feature holds it
};

/// Where α is highest inside the feature.
double placeOfPeak(const TransferFunction& tf, const Feature& f) {
    double best = (f.a + f.b) / 2, most = tf.opacity(best);
    for (const ControlPoint& p : tf.points)
        if (p.x > f.a && p.x < f.b && p.opacity > most) {
            most = p.opacity;
            best = p.x;
        }
    return best;
}

std::optional<Chosen> chosenOf(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options) {
    const RefinePriority& priority = options.priority;
    Chosen chosen;
    if (tf.features.size() >= 2) {
        chosen.feature = prioritizedFeature(histogram, tf, priority, options.profile);
        if (!chosen.feature) return {};
        const Feature& f = tf.features[*chosen.feature];
        chosen.x = priority.intensity.value_or(placeOfPeak(tf, f));
        chosen.inside = f.contains(chosen.x);
        return chosen;
    }
    if (priority.intensity) {
        chosen.x = *priority.intensity;
        return chosen;
    }
    const std::vector<double> factors = pointFactors(tf, priority, options.profile);
    const std::size_t firstOwn = tf.points.empty() || tf.points.front().x > 0 ? 1 : 0;
    if (tf.points.empty()) return {};
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < tf.points.size(); ++i)
        if (factors[i + firstOwn] < factors[nearest + firstOwn]) nearest = i;
    chosen.x = tf.points[nearest].x;
    return chosen;
}

struct Other {
    std::string name;
    double gain = 0;
};

/// The one that gained most, of all but what was chosen.
Other strongestOther(const Histogram& histogram, const TransferFunction& before, const TransferFunction& after,
                     const Chosen& chosen) {
    Other most;
    const auto take = [&](const std::string& name, double gain) {
        if (gain > most.gain) most = {name, gain};
    };
    if (chosen.feature) {
        const std::vector<double> was = opacityParts(histogram, before), is = opacityParts(histogram, after);
        for (std::size_t f = 0; f < was.size(); ++f)
            if (f != *chosen.feature && !before.features[f].hidden)
                take(before.features[f].name, gainOf(was[f], is[f]));
        return most;
    }
    const auto next = std::ranges::find_if(
        before.points, [&](double x) { return x >= chosen.x; }, &ControlPoint::x);
    const auto upper = static_cast<std::size_t>(next - before.points.begin());
    const bool onPoint = next != before.points.end() && next->x == chosen.x;
    for (std::size_t i = 0; i < before.points.size(); ++i) {
        if (i == upper || (!onPoint && i + 1 == upper) || before.points[i].x == chosen.x) continue;
        take("the value " + valueName(before, before.points[i].x),
             gainOf(before.points[i].opacity, after.points[i].opacity));
    }
    return most;
}

PriorityOutcome figuresOf(const Histogram& histogram, const TransferFunction& before, const TransferFunction& after,
                          const Chosen& chosen, Other& other) {
    PriorityOutcome outcome;
    outcome.name = chosen.feature ? before.features[*chosen.feature].name : "the value " + valueName(before, chosen.x);
    outcome.valueGain = gainOf(before.opacity(chosen.x), after.opacity(chosen.x));
    outcome.partGain = outcome.valueGain;
    if (chosen.feature)
        outcome.partGain =
            gainOf(opacityParts(histogram, before)[*chosen.feature], opacityParts(histogram, after)[*chosen.feature]);
    other = strongestOther(histogram, before, after, chosen);
    outcome.othersGain = other.gain;
    const double least = std::min(outcome.valueGain, outcome.partGain);
    const bool isThere = !chosen.feature || hasVoxel(before.features[*chosen.feature], histogram);
    outcome.gained = isThere && chosen.inside && least >= 1 - kSame && least > outcome.othersGain * (1 + kSame);
    return outcome;
}

std::string percent(double gain) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * std::abs(gain - 1));
    return text;
}

/// Why what was chosen did not gain, where it could have.
std::string reasonOf(const PriorityOutcome& outcome, const Other& other) {
    const double least = std::min(outcome.valueGain, outcome.partGain);
    if (least < 1 - kSame)
        return "Refinement lowered " + outcome.name + " by " + percent(least) +
               ": its values carry so much information that evening out takes from them even where they are "
               "prioritized.";
    if (other.gain > least * (1 + kSame))
        return "Refinement raised " + other.name + " more than " + outcome.name + ": " + other.name +
               " carries less information, and evening out raises what carries least.";
    return outcome.name + " gained no more than " + other.name + ".";
}

/// Why a chosen feature cannot be brought out at all; empty where it can.
std::string obstacle(const Histogram& histogram, const TransferFunction& tf, const Feature& f, const Chosen& chosen) {
    if (f.hidden) return f.name + " is hidden and cannot be brought out: show it first.";
    if (!hasVoxel(f, histogram))
        return "No voxel has a value of " + f.name + ", so there is nothing to bring out: choose another value.";
    if (isHeld(tf, f))
        return f.name + " has a fixed control point and keeps its opacity: release the point to bring it out.";
    if (!chosen.inside)
        return "No feature holds the value " + valueName(tf, chosen.x) + "; the nearest is " + f.name +
               ". Add a feature there to bring the value out.";
    return {};
}

RefineMethod otherThan(RefineMethod method) {
    return method == RefineMethod::Greedy ? RefineMethod::Exact : RefineMethod::Greedy;
}

} // namespace

std::optional<PriorityOutcome> priorityOutcome(const Histogram& histogram, const TransferFunction& before,
                                               const TransferFunction& after, const RefineOptions& options,
                                               const RefineAgain& again) {
    const std::optional<Chosen> chosen = chosenOf(histogram, before, options);
    if (!options.priority.any()) return {};
    if (!chosen) {
        PriorityOutcome none;
        none.text =
            "No feature that is shown has a voxel, so there is nothing to bring out: change a feature's interval.";
        return none;
    }
    Other other;
    PriorityOutcome outcome = figuresOf(histogram, before, after, *chosen, other);
    if (outcome.gained) return outcome;
    const std::string& name = outcome.name;
    if (chosen->feature) {
        outcome.text = obstacle(histogram, before, before.features[*chosen->feature], *chosen);
        if (!outcome.text.empty()) return outcome;
    }
    const std::string why = before.opacity(chosen->x) >= 1 - kSame ? name + " is fully opaque already and cannot gain."
                                                                   : reasonOf(outcome, other);
    RefineOptions by = options;
    by.method = otherThan(options.method);
    Other unused;
    const bool helps = figuresOf(histogram, before, again(by), *chosen, unused).gained;
    outcome.text =
        why + (helps ? std::string(" The method ") + (by.method == RefineMethod::Exact ? "Exact" : "Greedy") +
                           " brings " + name + " out."
               : before.opacity(chosen->x) >= 1 - kSame
                   ? " Lower the others by hand, or choose another value."
                   : " Raise it by hand, and fix its control points before you refine the others.");
    return outcome;
}

std::optional<Darkening> darkeningOf(const RayBundle& rays, const Histogram& histogram, const TransferFunction& before,
                                     const TransferFunction& after, const RefineOptions& options,
                                     const RefineAgain& again) {
    const auto strength = [&](const TransferFunction& tf) { return coverageOf(rays, tf).coverage; };
    Darkening dark;
    dark.before = strength(before);
    dark.after = strength(after);
    if (!(dark.after < kFaintCoverage && dark.after < dark.before)) return {};
    const std::optional<Chosen> chosen = options.priority.any() ? chosenOf(histogram, before, options) : std::nullopt;
    // Visible, and what was chosen has not lost.
    const auto helped = [&](const TransferFunction& tf, double least) {
        dark.helped = strength(tf);
        Other other;
        if (!(dark.helped >= least)) return false;
        return !chosen ||
               std::min(figuresOf(histogram, before, tf, *chosen, other).valueGain, 1.0) >=
                   std::min(figuresOf(histogram, before, after, *chosen, other).valueGain, 1.0) * (1 - kSame);
    };
    RefineOptions by = options;
    by.method = RefineMethod::Exact;
    if (options.method == RefineMethod::Greedy && helped(again(by), kFaintCoverage)) {
        dark.help = Darkening::Help::Exact;
        return dark;
    }
    if (options.method == RefineMethod::Greedy && dark.before > kFaintCoverage) {
        by.method = RefineMethod::Greedy;
        const double wanted = std::min(kWellSeen, (kFaintCoverage + dark.before) / 2);
        int visible = 0, faint = options.maxIterations; // coverage falls along the way, by and large
        while (faint - visible > 1) {
            by.maxIterations = visible + (faint - visible) / 2;
            (helped(again(by), wanted) ? visible : faint) = by.maxIterations;
        }
        by.maxIterations = visible;
        if (visible > 0 && helped(again(by), wanted)) {
            dark.help = Darkening::Help::Stop;
            dark.iterations = visible;
            return dark;
        }
    }
    dark.helped = 0;
    return dark;
}

std::string darkeningText(const Darkening& d) {
    const auto number = [](double coverage) { return fixedText(coverage, 2); };
    std::string text =
        "The picture gets dark: its coverage falls from " + number(d.before) + " to " + number(d.after) + ".";
    if (d.help == Darkening::Help::Exact) text += " With the method Exact it stays at " + number(d.helped) + ".";
    if (d.help == Darkening::Help::Stop)
        text += " Stopped after " + std::to_string(d.iterations) + (d.iterations == 1 ? " step" : " steps") +
                " it stays at " + number(d.helped) + ".";
    if (d.help == Darkening::Help::None) text += " Fix the control points that are to stay visible, and refine again.";
    return text;
}

} // namespace pellucid
