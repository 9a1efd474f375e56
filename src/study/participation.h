// One participant's way through a study, from whichever trial is the first without an answer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/growing_file.h"
#include "study/answers.h"
#include "study/plan.h"
#include "study/trial_clock.h"

namespace pellucid {

/// An id that no participant of the prepared study has: "p" and six letters and digits, drawn at random.
std::string newParticipantId(const std::string& folder);

/// Every answer is on the disk when answer() returns. A file whose last line is torn, since the program ended while
/// writing it, loses that line and none before it. One window at a time has a participant's file.
class Participation {
public:
    /// Of a prepared study. Where participant `id` has answered before, the rest is what is left. Throws Error where
    /// the id cannot be one, or earlier answers are of another study.
    Participation(std::string folder, const std::string& id);

    const std::string& folder() const { return m_folder; }
    const Study& study() const { return m_study; }
    const Participant& participant() const { return m_participant; }
    const std::vector<PlannedTrial>& plan() const { return m_plan; }
    bool hasBegun() const { return !m_participant.answers.empty(); }
    void setColorVision(ColorVision vision) { m_participant.colorVision = vision; }

    /// Index in plan() of the first trial without an answer; the size of plan() where all have one.
    std::size_t next() const { return m_next; }
    bool isDone() const { return m_next == m_plan.size(); }
    /// The stimulus of trial `index` of the plan.
    const Stimulus& stimulusOf(std::size_t index) const { return m_study.stimuli[m_plan.at(index).stimulus]; }

    /// Of the next trial; an empty score: left out. Throws FileError where it cannot be kept: the trial is still next.
    void answer(std::optional<int> score, const TrialTimes& times);

private:
    void readEarlier(const std::string& path);
    void findNext();

    std::string m_folder;
    Study m_study;
    Participant m_participant;
    std::vector<PlannedTrial> m_plan;
    std::vector<bool> m_isAnswered; ///< per trial of the plan
    std::size_t m_next = 0;
    std::unique_ptr<GrowingFile> m_file; ///< null until there is an answer
};

/// The present time in UTC: "2026-11-25T03:14:15Z".
std::string utcNow();

} // namespace pellucid
