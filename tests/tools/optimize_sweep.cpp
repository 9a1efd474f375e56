// optimize_sweep VOLUME… [--starts N] [--newton-only] [--delta] [--tf tents:3|auto] [--azimuth A] [--which T]: what
// Newton reaches on volumes (files, sample:NAME) under three tents and the automatic start, from three views, for three
// targets each (rising, equal, falling); and on a copy of at most 48³ voxels Newton against the best of N random
// restarts of the other methods, where Newton does not get below 0.001 there. --delta: root mean square differences of
// W between the volume and its estimates along rays instead, at three opacities. One line per problem; histories of
// those not reached.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "engines/engines.h"
#include "optimize/measure.h"
#include "optimize/optimizer.h"
#include "optimize/ray_vws.h"
#include "session/scene.h"
#include "support/random_cases.h"
#include "volume/excerpt.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

std::vector<std::vector<double>> targetsFor(std::size_t n) {
    std::vector<double> rising, equal(n, 1.0), falling;
    for (std::size_t i = 0; i < n; ++i) rising.push_back(0.5 * static_cast<double>((i + 1) * (i + 2)));
    falling.assign(rising.rbegin(), rising.rend());
    return {rising, equal, falling};
}

struct Tally {
    std::vector<int> moves;
    int below001 = 0, problems = 0, lost = 0;
    double worst = 0;
};

} // namespace

int main(int argc, char** argv) {
    int starts = 200;
    bool delta = false, others = true;
    double onlyAzimuth = -1000;
    int onlyTarget = -1;
    std::string onlyTf;
    std::vector<std::string> volumes;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--starts"))
            starts = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--delta"))
            delta = true;
        else if (!std::strcmp(argv[i], "--newton-only"))
            others = false;
        else if (!std::strcmp(argv[i], "--azimuth"))
            onlyAzimuth = std::atof(argv[++i]);
        else if (!std::strcmp(argv[i], "--which"))
            onlyTarget = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--tf"))
            onlyTf = argv[++i];
        else
            volumes.push_back(argv[i]);
    }
    Tally tally;
    for (const std::string& path : volumes)
        for (const std::string tfName : {"tents:3", "auto"}) {
            if (!onlyTf.empty() && tfName != onlyTf) continue;
            Scene scene;
            try {
                SceneInputs inputs;
                VolumeSource source;
                source.path = path;
                inputs.session = sessionOf(source);
                inputs.tf = tfName;
                scene = openScene(inputs);
            } catch (const std::exception& e) {
                std::printf("%s %s: %s\n", path.c_str(), tfName.c_str(), e.what());
                continue;
            }
            if (scene.tf.features.empty()) continue;
            const auto make = [](std::shared_ptr<const Volume> v) { return makeEngine(EngineChoice::Cpu, v); };
            const auto engine = make(scene.volume);
            const WeightFields weights = saliencyFields(*scene.volume, scene.tf);
            int factor = 1;
            while (scene.volume->size() > 48u * 48 * 48 * static_cast<unsigned>(factor * factor * factor)) ++factor;
            const auto tiny =
                factor == 1 ? scene.volume : std::make_shared<const Volume>(coarserCopy(*scene.volume, factor));
            const WeightFields tinyWeights = saliencyFields(*tiny, scene.tf);
            const auto tinyEngine = make(tiny);
            for (const auto& [azimuth, elevation] : {std::pair{30.0, 20.0}, {0.0, 0.0}, {-115.0, -40.0}}) {
                if (onlyAzimuth != -1000 && onlyAzimuth != azimuth) continue;
                const View view{
                    cameraFromView(scene.volume->geometry(), azimuth, elevation, 1, Projection::Perspective), {}};
                const EngineVws f(*engine, view, scene.tf, weights), ft(*tinyEngine, view, scene.tf, tinyWeights);
                const VwsEstimates levels =
                    rayEstimates(std::make_shared<RaySamples>(*scene.volume, scene.tf, view, weights), scene.tf);
                if (delta) {
                    const std::vector<std::vector<double>> xs{featureOpacities(scene.tf),
                                                              std::vector<double>(scene.tf.features.size(), 0.02),
                                                              std::vector<double>(scene.tf.features.size(), 0.9)};
                    const auto full = f.evaluate(xs);
                    std::printf("%s %s %g,%g", path.c_str(), tfName.c_str(), azimuth, elevation);
                    for (std::size_t l = 0; l < levels.size(); ++l) {
                        const auto w = levels[l]->evaluate(xs);
                        std::printf("  level %zu:", l + 1);
                        for (std::size_t i = 0; i < xs.size(); ++i) std::printf(" %.4f", objectiveOf(w[i], full[i]));
                    }
                    std::printf("\n");
                    continue;
                }
                int which = 0;
                for (const std::vector<double>& targets : targetsFor(scene.tf.features.size())) {
                    if (onlyTarget >= 0 && which != onlyTarget && which++ >= 0) continue;
                    const Stopwatch watch;
                    const OptimizeResult r = optimize({f, targets, {}, levels});
                    const double seconds = watch.seconds();
                    const double found = r.history[r.best].objective;
                    std::printf("%-30s %-8s %4g,%-4g t%d  newton F %.5f moves %d coarse %d eval %d starts %d %s %.2fs",
                                path.substr(path.find_last_of('/') + 1).c_str(), tfName.c_str(), azimuth, elevation,
                                which++, found, r.iterations(), r.coarseIterations(), r.evaluations, r.spreadStarts,
                                name(r.reason), seconds);
                    double best = 1;
                    std::string by;
                    if (others) {
                        const auto normalized = normalizedTargets(targets, scene.tf.features.size());
                        // Newton and the others on the same tiny volume.
                        const OptimizeResult rt = optimize({ft, targets});
                        const double tinyFound = rt.history[rt.best].objective;
                        Random random(7);
                        for (int s = 0; s < starts && tinyFound >= 1e-3; ++s) { // else nobody is better by much
                            std::vector<double> x;
                            for (std::size_t i = 0; i < scene.tf.features.size(); ++i)
                                x.push_back(std::pow(10, random.between(-3.5, 0)));
                            if (s == 0) x = featureOpacities(scene.tf);
                            TransferFunction base = withFeatureOpacities(scene.tf, x);
                            const EngineVws fs(*tinyEngine, view, base, tinyWeights);
                            OptimizeOptions o;
                            o.method = s % 3 == 0   ? SearchMethod::Parallel
                                       : s % 3 == 1 ? SearchMethod::Line
                                                    : SearchMethod::Fixed;
                            o.direction = s % 4 == 3 ? Direction::Exact : Direction::Gradient;
                            if (s % 3 == 2) o.maxIterations = 60;
                            o.tolerance = 1e-3;
                            if (s % 3 < 2) o.maxIterations = 40;
                            const OptimizeResult rs = optimize({fs, targets}, o);
                            if (rs.history[rs.best].objective < best) {
                                best = rs.history[rs.best].objective;
                                by = std::string(name(o.method)) + "/" + name(o.direction) + " start " +
                                     std::to_string(s);
                            }
                            if (best < 1e-3) break;
                        }
                        const bool lost = (best < 0.03 && tinyFound >= 1e-3) || best < tinyFound - 0.005;
                        tally.lost += lost;
                        std::printf("  | small: newton %.5f others %.5f (%s)%s", tinyFound, best, by.c_str(),
                                    lost ? " LOST" : "");
                        tally.worst = std::max(tally.worst, tinyFound - best);
                    }
                    std::printf("\n");
                    if (found >= 1e-3 || std::getenv("VERBOSE"))
                        for (const OptimizeState& state : r.history) {
                            std::printf("    level %d F %.5f x", state.level, state.objective);
                            for (const double x : state.opacity) std::printf(" %.6f", x);
                            std::printf("  W");
                            for (const double w : state.vws) std::printf(" %.5f", w);
                            std::printf("\n");
                        }
                    std::fflush(stdout);
                    ++tally.problems;
                    tally.below001 += found < 1e-3;
                    tally.moves.push_back(r.iterations());
                }
            }
        }
    if (!tally.moves.empty()) {
        std::sort(tally.moves.begin(), tally.moves.end());
        std::printf("%d problems, newton below 0.001: %d, median moves %d, lost %d, worst difference %.4f\n",
                    tally.problems, tally.below001, tally.moves[tally.moves.size() / 2], tally.lost, tally.worst);
    }
}
