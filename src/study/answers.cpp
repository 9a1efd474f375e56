#include "study/answers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/text.h"
#include "study/study.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

enum Column {
    kParticipant,
    kTrial,
    kPhase,
    kStimulus,
    kFeature,
    kRepeat,
    kScore,
    kResponse,
    kTask,
    kImage,
    kVision,
    kTime
};
constexpr std::array kColumns{"participant", "trial",       "phase",   "stimulus", "feature",      "repeat",
                              "score",       "response_ms", "task_ms", "image_ms", "color_vision", "time"};
constexpr const char *kTraining = "training", *kTrialPhase = "trial";

/// A line of the file, read field by field.
class Line {
public:
    /// `places`: where the columns stand.
    Line(const std::vector<std::string>& fields, const std::array<std::size_t, kColumns.size()>& places,
         std::size_t number, const std::string& path)
        : m_fields(fields), m_places(places), m_where(path + ":" + std::to_string(number)) {}

    [[noreturn]] void fail(const std::string& what) const { throw Error(what, m_where, "correct the file"); }
    const std::string& text(Column column) const { return m_fields[m_places[column]]; }
    double number(Column column) const {
        double value = 0;
        if (!parseNumber(text(column), value) || !std::isfinite(value))
            fail("'" + text(column) + "' is no number for " + kColumns[column]);
        return value;
    }
    int whole(Column column, int lo, int hi) const {
        std::int64_t value = 0;
        if (!parseNumber(text(column), value) || value < lo || value > hi)
            fail("'" + text(column) + "' is no " + kColumns[column]);
        return static_cast<int>(value);
    }

private:
    const std::vector<std::string>& m_fields;
    const std::array<std::size_t, kColumns.size()>& m_places;
    std::string m_where;
};

Answer answerFrom(const Line& line) {
    Answer a;
    a.trial = line.whole(kTrial, 1, 1'000'000'000);
    if (line.text(kPhase) != kTraining && line.text(kPhase) != kTrialPhase)
        line.fail("'" + line.text(kPhase) + "' is neither training nor trial");
    a.training = line.text(kPhase) == kTraining;
    a.stimulus = line.text(kStimulus);
    a.feature = line.text(kFeature);
    a.repeat = line.whole(kRepeat, 0, 1) == 1;
    if (!line.text(kScore).empty()) a.score = line.whole(kScore, kLowestScore, kHighestScore);
    a.responseMs = line.number(kResponse);
    a.taskMs = line.number(kTask);
    a.imageMs = line.number(kImage);
    a.time = line.text(kTime);
    return a;
}

std::array<std::size_t, kColumns.size()> placesOf(const std::vector<std::string>& head, const std::string& path) {
    std::array<std::size_t, kColumns.size()> places{};
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
        const auto at = std::ranges::find(head, kColumns[c]);
        if (at == head.end())
            throw Error(std::string("the column ") + kColumns[c] + " is missing", path, "give a file of answers");
        places[c] = static_cast<std::size_t>(at - head.begin());
    }
    return places;
}

/// A line whose end is missing: its last column, the time in UTC, has a last sign of its own.
bool isWhole(const std::vector<std::string>& fields) {
    return fields.size() == kColumns.size() && fields.back().ends_with('Z');
}

double tenths(double ms) { return std::round(ms * 10) / 10; }

} // namespace

std::string answersHead() {
    CsvTable csv;
    for (const char* column : kColumns) csv << column;
    csv.endLine();
    return csv.text();
}

std::string lineOf(const Participant& participant, const Answer& a) {
    CsvTable csv;
    csv << participant.id << a.trial << (a.training ? kTraining : kTrialPhase) << a.stimulus << a.feature
        << (a.repeat ? 1 : 0) << a.score << tenths(a.responseMs) << tenths(a.taskMs) << tenths(a.imageMs)
        << name(participant.colorVision) << a.time;
    csv.endLine();
    return csv.text();
}

AnswersRead answersFrom(const std::string& text, const std::string& path) {
    AnswersRead read;
    read.participant.id = fs::path(path).stem().string();
    CsvRecords csv = readCsv(text);
    if (csv.wholeBytes < text.size()) {
        CsvRecords ended = readCsv(text + "\n");
        if (ended.records.size() == csv.records.size() + 1 && isWhole(ended.records.back())) {
            csv = {std::move(ended.records), text.size()};
            read.lacksLineEnd = true;
        }
    }
    read.wholeBytes = csv.wholeBytes;
    if (csv.records.empty()) return read;
    const auto places = placesOf(csv.records.front(), path);
    std::set<int> trials;
    for (std::size_t i = 1; i < csv.records.size(); ++i) {
        const std::vector<std::string>& fields = csv.records[i];
        const Line line(fields, places, i + 1, path);
        if (fields.size() != csv.records.front().size())
            line.fail("the line has " + std::to_string(fields.size()) + " fields in place of " +
                      std::to_string(csv.records.front().size()));
        if (line.text(kParticipant) != read.participant.id)
            line.fail("the answer is of participant '" + line.text(kParticipant) + "'");
        const auto vision = findNamed<ColorVision>(line.text(kVision));
        if (!vision) line.fail("'" + line.text(kVision) + "' is no colour vision");
        read.participant.colorVision = *vision;
        read.participant.answers.push_back(answerFrom(line));
        if (!trials.insert(read.participant.answers.back().trial).second)
            line.fail("trial " + line.text(kTrial) + " is answered twice");
    }
    return read;
}

Participant readParticipant(const std::string& path) { return answersFrom(readText(path), path).participant; }

std::vector<Participant> readParticipants(const std::string& folder) {
    std::vector<std::string> files;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(participantsFolder(folder), ec))
        if (entry.path().extension() == ".csv" && isStudyId(entry.path().stem().string()))
            files.push_back(entry.path().string());
    std::ranges::sort(files);
    std::vector<Participant> all;
    for (const std::string& file : files) all.push_back(readParticipant(file));
    return all;
}

std::string participantFile(const std::string& folder, const std::string& id) {
    return (fs::path(participantsFolder(folder)) / (id + ".csv")).string();
}

} // namespace pellucid
