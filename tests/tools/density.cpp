// density FILE …: how far density reaches at equal shares, for each volume under three tents and the automatic start,
// from three views, with three kinds of targets: one line per case, then the worst. "held" is the largest F between the
// strong end and a quarter of its coverage, along the curve and half-way between its points; "of largest" the coverage
// of the answer over the largest of the curve. A volume is a file or sample:NAME; @N after it makes it coarser by N.
#include <chrono>
#include <cstdio>
#include <string>

#include "optimize/answer/density_curve.h"
#include "optimize/answer/visibility_words.h"
#include "session/scene.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

struct Worst {
    double held = 0;
    int cases = 0, reached = 0, heldAll = 0, strong = 0;
};

void run(const std::string& label, MeasureInput input, const std::vector<double>& wanted, Worst& worst) {
    Workspace workspace;
    const std::vector<double> targets = normalizedTargets(wanted, input.tf.features.size());
    OptimizeOptions options;
    options.method = SearchMethod::Newton;
    const auto clock = std::chrono::steady_clock::now;
    const auto start = clock();
    const OptimizeResult result = workspace.optimize(input, targets, {}, options);
    const auto middle = clock();
    const OptimizeState& best = result.history[result.best];
    input.tf = result.tf;
    const DensityCurve curve = workspace.densityCurve(input, {});
    const auto seconds = [](auto from, auto to) { return std::chrono::duration<double>(to - from).count(); };
    const double searched = seconds(start, middle), followed = seconds(middle, clock());

    // Along the curve, as the slider moves, down to a quarter.
    const double end = curve.strongest().coverage.coverage;
    std::vector<std::vector<double>> places;
    for (int n = 0; n < 23; ++n) places.push_back(curve.at(end * std::pow(0.25, n / 22.0)));
    places.push_back(best.opacity);
    const EngineVws function(workspace.engine(input), input.view, input.tf, workspace.weights(input),
                             input.settings.vws);
    const auto vws = function.evaluate(places);
    // Of reachable targets against these, else against the closest shares.
    const bool reached = best.objective < 0.001;
    double held = 0;
    for (const auto& w : vws) held = std::max(held, objectiveOf(w, reached ? targets : curve.shares));
    const double reach = curve.faintest().coverage.coverage / end;
    const double ofLargest = result.seen->coverage.coverage / std::max(end, 1e-9);
    std::string opacities;
    for (const double x : best.opacity) {
        char text[32];
        std::snprintf(text, sizeof text, " %.4f", x);
        opacities += text;
    }
    std::printf("%-38s F %.4f  coverage %.3f (curve %.3f, to %.2f of it)  held %.4f  of largest %.3f  %d moves, "
                "%d+%d evaluations, %.1f+%.1f s, opacities%s%s\n",
                label.c_str(), best.objective, result.seen->coverage.coverage, end, reach, held, ofLargest,
                result.iterations(), result.evaluations, curve.evaluations, searched, followed, opacities.c_str(),
                (keptText(result) + faintText(result)).c_str());
    std::fflush(stdout);
    ++worst.cases;
    worst.reached += reached;
    worst.heldAll += held < 0.01 && (reach < 0.26 || curve.isPoint());
    worst.strong += result.seen->coverage.coverage > 0.199 && result.seen->coverage.coverage < 0.75;
    worst.held = std::max(worst.held, held);
}

} // namespace

int main(int count, char** arguments) {
    Worst worst;
    for (int i = 1; i < count; ++i)
        for (const std::string& tf : {std::string("tents:3"), std::string(kAutomaticTf)})
            for (const auto& [azimuth, elevation] : {std::pair{30.0, 20.0}, {120.0, -10.0}, {250.0, 60.0}}) {
                SceneInputs inputs;
                VolumeSource source;
                const std::string named = arguments[i];
                source.path = named.substr(0, named.find('@'));
                if (source.path != named) source.downsample = std::stoi(named.substr(named.find('@') + 1));
                inputs.session = sessionOf(source);
                inputs.tf = tf;
                inputs.view = ViewAngles{azimuth, elevation};
                const Scene scene = openScene(inputs);
                const MeasureInput input = measureInput(scene);
                const std::size_t n = input.tf.features.size();
                std::vector<double> rising, equal(n, 1.0), falling;
                for (std::size_t f = 0; f < n; ++f)
                    rising.push_back(n == 3 ? (f == 0 ? 1 : f == 1 ? 3 : 6) : static_cast<double>(f + 1));
                falling.assign(rising.rbegin(), rising.rend());
                const char* const names[]{"rising", "equal", "inside out"};
                int k = 0;
                for (const auto& targets : {rising, equal, falling}) {
                    const std::string file = arguments[i];
                    char label[128];
                    std::snprintf(label, sizeof label, "%s %s %.0f %s", file.substr(file.rfind('/') + 1).c_str(),
                                  tf.c_str(), azimuth, names[k++]);
                    try {
                        run(label, input, targets, worst);
                    } catch (const Error& e) {
                        std::printf("%s: %s\n", label, e.what());
                    }
                }
            }
    std::printf("%d cases, %d on target (F < 0.001), held %d (worst %.4f), coverage in [0.2, 0.75] %d\n", worst.cases,
                worst.reached, worst.heldAll, worst.held, worst.strong);
    return 0;
}
