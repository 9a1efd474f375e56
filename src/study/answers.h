// What participants of a study have answered: a CSV file for each, participants/ID.csv.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/enum_names.h"

namespace pellucid {

/// What participants say of themselves.
enum class ColorVision { Normal, Deficient, Unsure, NotSaid };
template <>
inline constexpr auto kNamesOf<ColorVision> = enumNames("colour vision", "normal", "deficient", "unsure", "not said");

/// To one trial; a line of the file.
struct Answer {
    int trial = 1; ///< its number, from 1
    bool training = false;
    std::string stimulus;                           ///< its id
    std::string feature;                            ///< that was asked about
    bool repeat = false;                            ///< the stimulus was shown the second time
    std::optional<int> score;                       ///< 1 to 5; empty: left out by the participant
    double responseMs = 0, taskMs = 0, imageMs = 0; ///< see TrialTimes, to a tenth
    std::string time;                               ///< when it was given: UTC, ISO 8601
    bool operator==(const Answer&) const = default;
};

struct Participant {
    std::string id;
    ColorVision colorVision = ColorVision::NotSaid;
    std::vector<Answer> answers; ///< in the order of the file
    bool operator==(const Participant&) const = default;
};

/// Names of the columns, as a line with its end.
std::string answersHead();
/// A line with its end.
std::string lineOf(const Participant& participant, const Answer& answer);

/// A file, and how much of it holds.
struct AnswersRead {
    Participant participant;
    std::size_t wholeBytes = 0; ///< of whole lines: what is behind was being written when the program ended
    bool lacksLineEnd = false;  ///< the last one is whole, but an editor has taken the end of its line
};
/// `text` of the file `path`, ID.csv. Throws Error with the line that is wrong.
AnswersRead answersFrom(const std::string& text, const std::string& path);

/// Answers in a file without a torn last line. Throws Error.
Participant readParticipant(const std::string& path);
/// All participants of a prepared study, by id. Throws Error.
std::vector<Participant> readParticipants(const std::string& folder);

std::string participantFile(const std::string& folder, const std::string& id);

} // namespace pellucid
