#include "session/sequence.h"

#include "base/error.h"

namespace pellucid {

SequenceMaker::Step SequenceMaker::next(const Scene& basis, const JobControl& job, const JobControl* smoothing,
                                        const std::function<void(int)>& begins) {
    TimeSeries& series = *basis.series;
    Step step;
    if (const auto task = nextToAdapt(basis.session, series)) {
        step.firstStale = task->frame;
        if (begins) begins(task->frame);
        try {
            step.made = m_adapter.adapt(basis, *task, m_workspace, {job.stop, {}});
        } catch (const FileError& error) {
            passOver(series, task->frame, error);
            step.passedOver = true;
        } catch (const Error&) {
            if (series.summary(task->frame).problem.empty()) throw; // not of the frame
            step.passedOver = true;
        }
        return step;
    }
    const auto task = smoothing != nullptr ? nextToSmooth(basis.session, series) : std::nullopt;
    if (!task) return step;
    try {
        step.smoothed = m_adapter.smooth(basis, *task, m_workspace, *smoothing);
    } catch (const FileError&) { // a frame that broke meanwhile belongs to no task any more
        if (const auto again = nextToSmooth(basis.session, series); again && again->basis == task->basis) throw;
        step.passedOver = true;
    }
    return step;
}

Session withStep(Session session, const SequenceMaker::Step& step) {
    if (step.made) session = withAdapted(std::move(session), step.made->frame, step.made->forTrack());
    if (step.smoothed) session = withSmoothed(std::move(session), *step.smoothed);
    return session;
}

void passOver(TimeSeries& series, int frame, const FileError& error) {
    if (series.summary(frame).problem.empty()) series.noteProblem(frame, error.problem() + ", " + error.where());
}

Session beginningHere(Session session, const TransferFunction& tf, const std::string& where) {
    const int start = session.frame;
    session.variables.edit([&](std::vector<Variable>& all) {
        auto& keys = all.front().track.keys;
        keys.erase(keys.begin(), keys.lower_bound(start));
        keys[start] = Part<TransferFunction>(tf);
    });
    const auto features = [](const TransferFunction& of) {
        std::vector<std::pair<FeatureId, std::string>> all;
        for (const Feature& f : of.features) all.emplace_back(f.id, f.name);
        return all;
    };
    for (const auto& [frame, key] : session.variable().track.keys)
        if (features(*key) != features(tf)) // figures of all frames stand in the same columns
            throw UsageError("the transfer functions of frames " + std::to_string(start) + " and " +
                                 std::to_string(frame) + " have other features",
                             where,
                             "give both the same in the same order, or begin with frame " + std::to_string(frame));
    return session;
}

} // namespace pellucid
