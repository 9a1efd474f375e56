// What the workspace measures to say why a target is out of reach (optimize/answer/verdict.h).
#include "session/workspace.h"

namespace pellucid {

class WorkspaceTools final : public VerdictTools {
public:
    WorkspaceTools(Workspace& workspace, const MeasureInput& input, const std::vector<double>& targets,
                   const OptimizeOptions& options, std::vector<std::vector<double>> known)
        : m_workspace(workspace), m_input(input), m_targets(targets), m_options(options), m_known(std::move(known)) {
        // What the method at hand reaches, in as many moves as it may, says nothing of what can be reached.
        m_options.method = SearchMethod::Newton;
        m_options.restarts = true;
        m_options.maxIterations = OptimizeOptions{}.maxIterations;
    }

    const Geometry& geometry() const override { return m_input.volume->geometry(); }

    OptimizeResult solve(const ReachProblem& problem, bool rough, const JobControl& job) override {
        const MeasureInput input = inputOf(problem);
        std::shared_ptr<const VwsFunction> function = std::make_shared<EngineVws>(m_workspace.vws(input, job));
        VwsEstimates along = m_workspace.estimates(input, job);
        if (rough && !along.empty()) {
            function = along.front();
            along.erase(along.begin());
        }
        OptimizeProblem search{*function, m_targets, problem.limits, std::move(along)};
        search.known = m_known;
        OptimizeResult result = optimize(search, m_options, job);
        if (result.reason == StopReason::Cancelled) throw Cancelled{};
        return result;
    }

    std::vector<FeatureSums> sums(const ReachProblem& problem, const std::vector<std::vector<double>>& candidates,
                                  const JobControl& job) override {
        const MeasureInput input = inputOf(problem);
        std::vector<TransferFunction> tfs;
        for (const auto& x : candidates) tfs.push_back(withFeatureOpacities(problem.tf, x));
        VisibilityEngine& engine = m_workspace.engine(input);
        return engine.sums(input.view, tfs, &m_workspace.weights(input, job), job);
    }

private:
    MeasureInput inputOf(const ReachProblem& problem) const {
        MeasureInput input = m_input;
        input.view = problem.view;
        input.tf = problem.tf;
        return input;
    }

    Workspace& m_workspace;
    MeasureInput m_input;
    std::vector<double> m_targets;
    OptimizeOptions m_options;
    std::vector<std::vector<double>> m_known;
};

Verdict Workspace::explain(const MeasureInput& input, const std::vector<double>& targets,
                           const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                           const OptimizeResult& found, const JobControl& job,
                           const std::vector<std::vector<double>>& known) {
    const ReachProblem problem{input.view, input.tf, limits};
    // What keeps the picture visible says nothing of what shares can be reached.
    OptimizeResult nearest = found;
    if (found.seen && found.seen->exact) {
        const SeenShares& exact = *found.seen->exact;
        nearest.history.push_back({exact.objective, exact.vws, exact.opacity, 0});
        nearest.best = nearest.history.size() - 1;
    }
    // Only this search ends where nothing is nearer; of others, and of one that was stopped, nobody knows.
    const bool isGlobal =
        options.method == SearchMethod::Newton && options.restarts && found.reason == StopReason::NoProgress;
    return guarded([&] {
        std::vector<std::vector<double>> starts = known;
        starts.push_back(nearest.history[nearest.best].opacity);
        WorkspaceTools tools(*this, input, targets, options, std::move(starts));
        if (!isGlobal || !known.empty()) {
            OptimizeResult other = tools.solve(problem, false, job);
            if (other.history[other.best].objective < nearest.history[nearest.best].objective)
                nearest = std::move(other);
        }
        // The published profile has views of its own.
        return pellucid::explain(tools, problem, nearest.targets, nearest,
                                 {options.tolerance, input.settings.profile == Profile::Default}, job);
    });
}

} // namespace pellucid
