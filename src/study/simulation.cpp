#include "study/simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <random>

#include "study/participation.h"

namespace pellucid {

namespace {

/// Draws that are the same everywhere: the standard prescribes the generator, and not its distributions.
class Draws {
public:
    explicit Draws(std::uint32_t seed) : m_random(seed) {}
    double uniform() { return (static_cast<double>(m_random()) + 0.5) / 4294967296.0; } ///< (0, 1)
    double normal() {                                                                   // Box and Muller
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

private:
    std::mt19937 m_random;
};

/// Each one's place in the order, from 0; of equal ones in the order in which they stand.
std::vector<double> placesOf(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> places(values.size());
    for (std::size_t place = 0; place < order.size(); ++place) places[order[place]] = static_cast<double>(place);
    return places;
}

std::vector<double> figuresOf(const std::vector<Stimulus>& stimuli, StudyMeasure measure) {
    std::vector<double> figures;
    for (const Stimulus& stimulus : stimuli) {
        const std::optional<double>& figure = figureOf(stimulus, measure);
        if (!figure)
            throw Error(std::string("the stimulus has no ") + shortName(measure), "stimulus " + stimulus.id,
                        "prepare the study again, or choose another measure");
        figures.push_back(*figure);
    }
    return figures;
}

std::string freeId(const std::string& folder, int& number) {
    for (;; ++number) {
        const std::string digits = std::to_string(number),
                          id = kSimulatedPrefix + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
        if (!std::filesystem::exists(participantFile(folder, id))) return id;
    }
}

/// Of a picture about which opinions are `opinion`.
int scoreOf(double opinion, double bias, double noise, Draws& draws) {
    const double score = std::round(opinion + bias + noise * draws.normal());
    return static_cast<int>(std::clamp<double>(score, kLowestScore, kHighestScore));
}

/// `opinions`: of the stimuli that are not for training, in their order.
void answerAll(Participation& participation, const std::vector<double>& opinions, double noise, Draws& draws) {
    const Study& study = participation.study();
    const double bias = noise / 2 * draws.normal(), middle = (kLowestScore + kHighestScore) / 2.0;
    participation.setColorVision(ColorVision::Normal);
    while (!participation.isDone()) {
        const PlannedTrial& trial = participation.plan()[participation.next()];
        const auto end = study.stimuli.begin() + static_cast<std::ptrdiff_t>(trial.stimulus);
        const auto place = static_cast<std::size_t>(
            std::count_if(study.stimuli.begin(), end, [](const Stimulus& stimulus) { return !stimulus.training; }));
        const int score = scoreOf(trial.training ? middle : opinions[place], bias, noise, draws);
        participation.answer(score, {.taskMs = 1000 * study.taskSeconds,
                                     .imageMs = 1000 * study.imageSeconds,
                                     .responseMs = 600 + 2000 * draws.uniform()});
    }
}

} // namespace

std::vector<double> plantedOpinions(const std::vector<double>& figures, double correlation, std::uint32_t seed) {
    const std::size_t n = figures.size();
    if (n < kLeastStimuli)
        throw Error("a correlation cannot be planted in " + std::to_string(n) + " pictures", "",
                    "give the study at least " + std::to_string(kLeastStimuli) + " that are not for training");
    if (std::ranges::all_of(figures, [&](double f) { return f == figures.front(); }))
        throw Error("all pictures have the same figure", "",
                    "choose another measure, or give the study other pictures");
    Draws draws(seed);
    const std::vector<double> places = placesOf(figures);
    std::vector<double> other(n);
    for (double& value : other) value = static_cast<double>(n) * draws.normal();
    // From the figures' own order at an angle of 0, over one that has nothing to do with it, to its reverse at π.
    const auto opinionsAt = [&](double angle) {
        std::vector<double> mixed(n);
        for (std::size_t i = 0; i < n; ++i) mixed[i] = std::cos(angle) * places[i] + std::sin(angle) * other[i];
        return placesOf(mixed);
    };
    const auto found = [&](double angle) { return coefficient(CorrelationKind::Spearman, figures, opinionsAt(angle)); };
    double low = 0, high = std::numbers::pi;
    for (int i = 0; i < 50; ++i) {
        const double middle = (low + high) / 2;
        (found(middle) >= correlation ? low : high) = middle;
    }
    const bool isLow = std::abs(found(low) - correlation) <= std::abs(found(high) - correlation);
    std::vector<double> opinions = opinionsAt(isLow ? low : high);
    for (double& opinion : opinions) opinion = 1.5 + 3 * (opinion + 0.5) / static_cast<double>(n);
    return opinions;
}

std::vector<std::string> simulateParticipants(const std::string& folder, const SimulationOptions& options,
                                              const JobControl& job) {
    const std::vector<Stimulus> stimuli = analysedStimuli(readPreparedStudy(folder));
    const std::vector<double> opinions =
        plantedOpinions(figuresOf(stimuli, options.measure), options.correlation, options.seed);
    std::vector<std::string> ids;
    for (int i = 0, number = 1; i < options.participants; ++i) {
        job.throwIfStopped();
        const std::string id = freeId(folder, number);
        Draws draws(options.seed + 7919u * static_cast<std::uint32_t>(number));
        Participation participation(folder, id);
        answerAll(participation, opinions, options.noise, draws);
        ids.push_back(id);
        job.report(static_cast<double>(i + 1) / options.participants);
    }
    return ids;
}

} // namespace pellucid
