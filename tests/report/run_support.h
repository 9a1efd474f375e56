// A run that tests of reports share.
#pragma once

#include "session/session.h"

namespace pellucid::test {

/// Newton on two features, three states, the second one along rays.
inline Run exampleRun() {
    RunStart start;
    start.tf = tents(2);
    start.tf.features[0].name = "skin";
    start.tf.features[0].color = {1, 0.5, 0};
    start.tf.features[1].name = "bone, \"hard\"";
    start.options.method = SearchMethod::Newton;
    start.options.tolerance = 0.03;
    OptimizeResult result;
    result.targets = {0.25, 0.75};
    result.history = {
        {0.4, {0.8, 0.2}, {0.5, 0.5}, 0}, {0.1, {0.3, 0.7}, {0.05, 0.8}, 1}, {0.02, {0.24, 0.76}, {0.005, 0.9}, 0}};
    result.best = 2;
    result.evaluations = 9;
    result.reason = StopReason::Converged;
    Run run = runOf(result, std::move(start));
    run.started = "2026-11-22T14:03:07";
    run.number = 1;
    return run;
}

} // namespace pellucid::test
