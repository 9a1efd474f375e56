#include "study/plan.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace pellucid {

namespace {

/// Draws that are the same everywhere: the standard prescribes the generator, and not its distributions.
class Draws {
public:
    Draws(int seed, const std::string& word) : m_random(mixed(static_cast<std::uint64_t>(seed), word)) {}

    /// One of 0 … count − 1, each as likely.
    std::size_t below(std::size_t count) {
        const std::uint64_t unfair = UINT64_MAX - UINT64_MAX % count; // from here on some would come more often
        for (;;)
            if (const std::uint64_t draw = m_random(); draw < unfair) return draw % count;
    }
    void shuffle(std::vector<std::size_t>& all) {
        for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[below(i)]);
    }

private:
    /// FNV-1a of the word, begun with the seed.
    static std::uint64_t mixed(std::uint64_t seed, const std::string& word) {
        std::uint64_t hash = 14695981039346656037u;
        const auto add = [&](std::uint64_t byte) { hash = (hash ^ byte) * 1099511628211u; };
        for (int i = 0; i < 8; ++i) add((seed >> (8 * i)) & 255u);
        for (const char c : word) add(static_cast<unsigned char>(c));
        return hash;
    }
    std::mt19937_64 m_random;
};

/// The places of `order` where a second showing of what stands at `first` is not beside it.
std::vector<std::size_t> placesApartFrom(std::size_t first, std::size_t size) {
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place <= size; ++place)
        if (place != first && place != first + 1) places.push_back(place);
    return places;
}

} // namespace

std::vector<PlannedTrial> planOf(const Study& study, const std::string& participant) {
    std::vector<PlannedTrial> plan;
    std::vector<std::size_t> order;
    const auto add = [&](std::size_t stimulus, bool training, bool repeat) {
        plan.push_back({static_cast<int>(plan.size()) + 1, training, stimulus, repeat});
    };
    for (std::size_t i = 0; i < study.stimuli.size(); ++i)
        if (study.stimuli[i].training)
            add(i, true, false);
        else
            order.push_back(i);

    std::vector<std::size_t> repeated = order;
    Draws(study.seed, "").shuffle(repeated);
    repeated.resize(std::min(repeated.size(), static_cast<std::size_t>(std::max(0, study.repeats))));
    Draws draws(study.seed, participant);
    draws.shuffle(order);
    for (const std::size_t stimulus : repeated) { // what is put in later only takes others further apart
        const auto first = static_cast<std::size_t>(std::ranges::find(order, stimulus) - order.begin());
        const std::vector<std::size_t> places = placesApartFrom(first, order.size());
        if (places.empty()) continue; // of a single stimulus, which readStudy() refuses
        order.insert(order.begin() + static_cast<std::ptrdiff_t>(places[draws.below(places.size())]), stimulus);
    }
    std::vector<bool> seen(study.stimuli.size());
    for (const std::size_t stimulus : order) {
        add(stimulus, false, seen[stimulus]);
        seen[stimulus] = true;
    }
    return plan;
}

bool isPauseBefore(const Study& study, const std::vector<PlannedTrial>& plan, std::size_t index) {
    if (index == 0 || index >= plan.size() || plan[index].training) return false;
    const auto training = static_cast<std::size_t>(std::ranges::count(plan, true, &PlannedTrial::training));
    if (index == training) return true;
    return study.pauseEvery > 0 && (index - training) % static_cast<std::size_t>(study.pauseEvery) == 0;
}

} // namespace pellucid
