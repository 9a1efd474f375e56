#include "optimize/refine/refine.h"

#include <algorithm>

#include "base/error.h"
#include "optimize/refine/refine_edges.h"
#include "optimize/refine/refine_features.h"

namespace pellucid {

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The greedy search (3.4.2). A move changes two edges at most, and nothing else is computed anew.
RefineResult refineGreedy(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                          const JobControl& job) {
    EdgeLine line(histogram, tf, options.priority, options.profile);
    RefineResult result = startOf(line, tf);
    EnergyCurve curve;
    curve.add(result.energyMovableBefore);

    // Weights of the participating edges side by side, and where each edge is among them.
    const std::vector<std::size_t>& which = line.participating;
    std::vector<double> weights = line.participatingWeights();
    std::vector<std::size_t> slot(line.edges(), kNone);
    for (std::size_t i = 0; i < which.size(); ++i) slot[which[i]] = i;
    const auto updateEdge = [&](std::size_t edge) {
        if (slot[edge] != kNone)
            weights[slot[edge]] = line.coefficients[edge].weight(line.opacity[edge], line.opacity[edge + 1]);
    };
    const auto move = [&](std::size_t point, double by) {
        line.opacity[point] = std::clamp(line.opacity[point] + by, 0.0, 1.0);
        if (point > 0) updateEdge(point - 1);
        if (point < slot.size()) updateEdge(point);
    };

    constexpr int kAskEvery = 64; // iterations, each well below a microsecond
    std::vector<double> best = line.opacity;
    double bestEnergy = result.energyMovableBefore;
    const int patience = 2 * static_cast<int>(line.edges());
    int sinceBest = 0;
    while (!which.empty() && result.iterations < options.maxIterations &&
           !(options.untilStable && sinceBest >= patience)) {
        if (result.iterations % kAskEvery == 0) job.throwIfStopped();
        std::size_t heaviest = kNone, lightest = kNone; // of equals the lower index
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (line.isSkipped(which[i])) continue;
            if (heaviest == kNone || weights[i] > weights[heaviest]) heaviest = i;
            if (lightest == kNone || weights[i] < weights[lightest]) lightest = i;
        }
        if (heaviest == kNone) break;
        const std::size_t down = line.endToMove(which[heaviest], true), up = line.endToMove(which[lightest], false);
        const double rise = line.stepUp(options, down, up);
        move(down, -options.stepDown);
        move(up, rise);
        ++result.iterations;
        ++sinceBest;
        const double energy = energyOf(weights);
        curve.add(energy);
        if (energy < bestEnergy) {
            bestEnergy = energy;
            best = line.opacity;
            sinceBest = 0;
        }
    }
    line.opacity = best;
    finish(result, line, tf);
    curve.moveInto(result);
    return result;
}

} // namespace

template <>
std::span<const Setting> settingsOf<RefineSteps>() {
    using R = RefineSteps;
    constexpr auto isGreedy = [](const void* r) { return static_cast<const R*>(r)->method == RefineMethod::Greedy; };
    static constexpr const char* kMethods[] = {"Greedy, step by step", "Exact"};
    static const Setting kSettings[] = {
        {.key = "method",
         .at = member<&R::method>,
         .words = "&Method",
         .help = "Greedy takes opacity from the heaviest edge and gives it to the lightest one while that helps; exact "
                 "finds the most even edges that the same total of movable opacities allows. The answer compares both "
                 "at one total.",
         .choices = kMethods},
        {.key = "step_down",
         .at = member<&R::stepDown>,
         .words = "Step &down",
         .help = "The opacity that a step takes from the heaviest edge.",
         .range = {0, 1, NumberRange::Open::Low},
         .used = isGreedy},
        {.key = "step_up",
         .at = member<&R::stepUp>,
         .words = "Step &up",
         .help = "The opacity that a step gives to the lightest edge; auto derives it from the step down and the "
                 "significances of both ends.",
         .range = {0, 1, NumberRange::Open::Low},
         .none = "auto",
         .used = isGreedy},
        {.key = "max_iterations",
         .at = member<&R::maxIterations>,
         .words = "Most s&teps",
         .help = "The most steps that a refinement makes.",
         .range = {0, 1e9},
         .unit = "steps",
         .used = isGreedy},
    };
    return kSettings;
}

void RefineOptions::validate() const {
    checkSettings<RefineSteps>(*this, "refine");
    if (priority.intensity && !priority.region.empty())
        throw UsageError("both an intensity and a region are prioritized", "refine", "choose one of them");
    if (priority.intensity && !(*priority.intensity >= 0 && *priority.intensity <= 1))
        throw UsageError("the prioritized intensity must lie in [0,1]", "refine",
                         "normalise it to the range of intensities");
    if (total && !(*total >= 0)) throw UsageError("the total opacity must not be negative", "refine", "correct it");
}

std::vector<double> edgeWeights(const Histogram& histogram, const TransferFunction& tf, const RefinePriority& priority,
                                Profile profile) {
    RefineOptions by;
    by.profile = profile;
    if (movesFeatures(tf, by)) return FeatureLine(histogram, tf, priority).weights();
    return EdgeLine(histogram, tf, priority, profile).weights();
}

double edgeEnergy(const std::vector<double>& edges) { return energyOf(edges); }

double movableOpacity(const TransferFunction& tf) {
    double sum = 0;
    for (const ControlPoint& p : tf.points)
        if (!p.fixed) sum += p.opacity;
    return sum;
}

RefineResult refine(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                    const JobControl& job) {
    options.validate();
    if (movesFeatures(tf, options)) return refineFeatures(histogram, tf, options, job);
    return options.method == RefineMethod::Exact ? refineExact(histogram, tf, options, job)
                                                 : refineGreedy(histogram, tf, options, job);
}

RefineComparison compareMethods(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                                const JobControl& job) {
    RefineOptions by = options;
    by.method = RefineMethod::Greedy;
    const RefineResult greedy = refine(histogram, tf, by, job);
    by.method = RefineMethod::Exact;
    by.priority = {};
    const bool features = movesFeatures(tf, by); // both of what greedy moves
    by.priority = options.priority;
    by.total =
        features ? FeatureLine(histogram, greedy.tf, options.priority).movableAmount() : movableOpacity(greedy.tf);
    // From there, so that it is never worse; published, the edges that take part are those of the start.
    const TransferFunction& start = options.profile == Profile::Published ? tf : greedy.tf;
    const RefineResult exact = (features ? refineFeatures : refineExact)(histogram, start, by, job);
    return {*by.total, greedy.energyMovableAfter, exact.energyMovableAfter, exact.tf};
}

} // namespace pellucid
