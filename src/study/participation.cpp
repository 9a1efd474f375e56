#include "study/participation.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <random>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/error.h"

namespace pellucid {

namespace fs = std::filesystem;

std::string newParticipantId(const std::string& folder) {
    constexpr std::string_view kSigns = "abcdefghjkmnpqrstuvwxyz23456789"; // none that look alike
    std::random_device random;
    std::uniform_int_distribution<std::size_t> sign(0, kSigns.size() - 1);
    for (;;) {
        std::string id = "p";
        for (int i = 0; i < 6; ++i) id += kSigns[sign(random)];
        std::error_code ec;
        if (!fs::exists(participantFile(folder, id), ec)) return id;
    }
}

Participation::Participation(std::string folder, const std::string& id)
    : m_folder(std::move(folder)), m_study(readPreparedStudy(m_folder)) {
    if (!isStudyId(id))
        throw UsageError("'" + id + "' cannot name a participant", "", "use up to 40 letters, digits, - and _");
    m_participant.id = id;
    m_plan = planOf(m_study, id);
    m_isAnswered.resize(m_plan.size());
    const std::string path = participantFile(m_folder, id);
    if (std::error_code ec; fs::exists(path, ec)) readEarlier(path);
    findNext();
}

void Participation::readEarlier(const std::string& path) {
    m_file = std::make_unique<GrowingFile>(path);
    AnswersRead read = answersFrom(readText(path), path);
    for (const Answer& answer : read.participant.answers) {
        const auto index = static_cast<std::size_t>(answer.trial - 1);
        if (index >= m_plan.size() || stimulusOf(index).id != answer.stimulus || m_plan[index].repeat != answer.repeat)
            throw Error("the answer to trial " + std::to_string(answer.trial) + " is of another study or order", path,
                        "prepare that study into a folder of its own, or name another participant");
        m_isAnswered[index] = true;
    }
    if (read.wholeBytes < m_file->size()) m_file->cut(read.wholeBytes);
    if (read.lacksLineEnd) m_file->append("\n");
    m_participant = std::move(read.participant);
}

void Participation::findNext() {
    m_next = static_cast<std::size_t>(std::ranges::find(m_isAnswered, false) - m_isAnswered.begin());
}

void Participation::answer(std::optional<int> score, const TrialTimes& times) {
    PELLUCID_CHECK(!isDone());
    const PlannedTrial& trial = m_plan[m_next];
    const Stimulus& stimulus = stimulusOf(m_next);
    Answer answer{trial.trial, trial.training,   stimulus.id,  stimulus.feature, trial.repeat,
                  score,       times.responseMs, times.taskMs, times.imageMs,    utcNow()};
    if (!m_file) {
        std::error_code ec;
        fs::create_directories(participantsFolder(m_folder), ec); // where it fails, opening the file says why
        auto file = std::make_unique<GrowingFile>(participantFile(m_folder, m_participant.id));
        if (file->size() > 0)
            throw FileError("another window is already running this participant", file->path(), "close one of the two");
        m_file = std::move(file);
    }
    m_file->append((m_file->size() == 0 ? answersHead() : std::string()) + lineOf(m_participant, answer));
    m_participant.answers.push_back(std::move(answer));
    m_isAnswered[m_next] = true;
    findNext();
}

std::string utcNow() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

} // namespace pellucid
