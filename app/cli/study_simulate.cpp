#include "study_simulate.h"

#include "parse.h"

namespace pellucid::cli {

void SimulateOptions::add(CLI::App& app) {
    addValue(
        app, "--simulate", "N",
        [this](const std::string& text, const std::string& option) {
            m_options.participants = static_cast<int>(parseInteger(text, option, 1, 1000));
            m_isWanted = true;
        },
        "in place of a person N who are computed, simulated-001 and so on: a rehearsal");
    const auto addOwn = [&](const char* option, const char* value, auto& target, const auto& parse, const char* help) {
        addValue(
            app, option, value,
            [this, &target, parse](const std::string& text, const std::string& given) {
                target = parse(text, given);
                m_needless = given;
            },
            help);
    };
    addOwn("--measure", "vws|visibility|fs", m_options.measure, parseName<StudyMeasure>,
           "which figure their opinions follow (default vws)");
    addOwn("--rho", "R", m_options.correlation, realFrom(-1, 1),
           "Spearman's rank correlation of figure and opinions, -1 to 1 (default 0.7)");
    addOwn("--noise", "S", m_options.noise, realFrom(0, 10),
           "standard deviation of a score around the opinion, 0 to 10 (default 0.7)");
    addOwn("--seed", "N", m_options.seed, wholeFrom<std::uint32_t>(0, UINT32_MAX),
           "what opinions and scores are drawn from (default 1)");
}

void SimulateOptions::check() const {
    if (!m_isWanted && !m_needless.empty())
        throw UsageError("it is for simulated participants", m_needless, "give --simulate N too");
}

Answer SimulateOptions::run(const std::string& folder, Progress& progress) const {
    const Stopwatch total;
    const std::vector<std::string> ids = simulateParticipants(folder, m_options, progress.phase("simulating"));
    const std::string who = ids.size() == 1 ? ids.front() : ids.front() + " to " + ids.back();
    return {"simulated " + countText(ids.size()) + (ids.size() == 1 ? " participant: " : " participants: ") + who +
                "\n",
            Json{{"command", "study run"},
                 {"folder", folder},
                 {"simulated", ids},
                 {"measure", name(m_options.measure)},
                 {"rho", m_options.correlation},
                 {"noise", m_options.noise},
                 {"seed", m_options.seed},
                 {"seconds", {{"total", total.seconds()}}}}};
}

} // namespace pellucid::cli
