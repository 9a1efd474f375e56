#include "bench/bench.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <ctime>
#include <deque>
#include <filesystem>
#include <functional>
#include <numbers>
#include <thread>

#include <unistd.h>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "bench/dicom_slices.h"
#include "optimize/optimizer.h"
#include "optimize/ray_vws.h"
#include "optimize/refine/refine.h"
#include "render/image_renderer.h"
#include "render/ssim.h"
#include "saliency/saliency_direct.h"
#include "volume/histogram.h"
#include "volume/loader.h"
#include "volume/volume_writer.h"

namespace pellucid {

namespace {

constexpr double kBytesPerCode = 2; ///< what engines and renderers read of a voxel, see IntensityGrid
constexpr double kDensePeak = 0.001;
constexpr double kDenseStepScale = 0.002; ///< steps in proportion to kDensePeak
constexpr double kSparseShare = 0.03;
constexpr int kClickIterations = 500, kMoreIterations = 1000; ///< as in table 3.2 of the thesis
/// Without a number of repetitions: rounds over all rows, and how long each row at least repeats in every round.
/// Seconds; what else a machine does comes and goes in tenths of them.
constexpr int kRounds = 3;
constexpr double kLeastSeconds = 0.2;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// Processor time of all threads of this process.
double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What is asked of an optimization: 0.1, 0.3, 0.6 for three features; for n of them in proportion to 1, 3, 6, 10, …
std::vector<double> benchTargets(std::size_t features) {
    std::vector<double> targets;
    for (std::size_t i = 0; i < features; ++i) targets.push_back(0.5 * static_cast<double>((i + 1) * (i + 2)));
    return normalizedTargets(std::move(targets), features);
}

/// What a parallel line search tries first (docs/method.md, "Optimization"): steps 0.05·2^i, i = −2 … 5, along −2(W −
/// t).
std::vector<TransferFunction> searchCandidates(const TransferFunction& tf, const std::vector<double>& vws,
                                               double stepScale) {
    std::vector<TransferFunction> candidates;
    const std::size_t n = tf.features.size();
    const std::vector<double> targets = n > 0 ? benchTargets(n) : std::vector<double>();
    for (int i = -2; i <= 5; ++i) {
        std::vector<double> x = featureOpacities(tf);
        for (std::size_t f = 0; f < n; ++f)
            x[f] = std::clamp(x[f] - stepScale * 0.05 * std::exp2(i) * 2 * (vws[f] - targets[f]), 0.0, 1.0);
        candidates.push_back(withFeatureOpacities(tf, x));
    }
    return candidates;
}

/// Around an axis along z through what it looks at; radians.
Camera turned(Camera camera, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](const Vec3& v) { return Vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z); };
    camera.eye = camera.center + turn(camera.eye - camera.center);
    camera.up = turn(camera.up);
    return camera;
}

OptimizeResult resultOf(const OptimizeProblem& problem, const OptimizeOptions& options, const JobControl& job) {
    OptimizeResult result = optimize(problem, options, job);
    if (result.reason == StopReason::Cancelled) throw Cancelled{};
    return result;
}

double bytesPerVoxel(const WeightFields& weights) {
    return weights.empty() ? 0.0 : static_cast<double>(sizeof(*weights.data()));
}

/// One row while it is being measured.
struct Measurement {
    BenchResult result;
    std::function<void(BenchResult& result, const JobControl& job)> work; ///< may add to `bytes` and `extra`
    int times = 1;                                                        ///< that `work` does the same
    std::vector<double> seconds, cpuSeconds;
    bool failed = false;
};

/// A folder for the files of the rows Open, gone with this.
class FolderForFiles {
public:
    FolderForFiles() {
        static std::atomic<int> s_count = 0;
        m_path = std::filesystem::temp_directory_path() /
                 ("pellucid-bench-" + std::to_string(getpid()) + "-" + std::to_string(s_count++));
        std::filesystem::create_directories(m_path);
    }
    ~FolderForFiles() {
        std::error_code ec;
        std::filesystem::remove_all(m_path, ec);
    }
    FolderForFiles(const FolderForFiles&) = delete;
    FolderForFiles& operator=(const FolderForFiles&) = delete;
    std::string path(const std::string& name) const { return (m_path / name).string(); }

private:
    std::filesystem::path m_path;
};

/// The rows of one case. Keeps a reference to it and the options, which outlive it.
class CaseBench {
public:
    CaseBench(const BenchCase& of, const BenchOptions& options, const JobControl& job)
        : m_case(of), m_options(options) {
        using enum BenchRow;
        const auto wanted = [&](BenchRow row) { return of.rows.contains(row); };
        const bool measured =
            wanted(Sweep) || wanted(Jacobian) || wanted(Optimize) || wanted(OptimizeNewton) || wanted(OptimizeWhole);
        const bool weighted = measured || wanted(Slices) || wanted(Threads);
        if (measured || wanted(Setup)) m_engine = makeEngine(options.engine, of.volume, options.quality);
        if (wanted(Open)) addOpen(job);
        if (wanted(Setup)) addSetup();
        if (wanted(Saliency)) addSaliency(Saliency, updateSaliencyFields);
        if (wanted(SaliencyDirect)) addSaliency(SaliencyDirect, updateSaliencyFieldsDirect);
        if (weighted) m_weights = saliencyFields(*of.volume, of.tf, {}, job);
        if (wanted(Sweep)) addSweeps(job);
        if (wanted(Slices)) addSlices();
        if (wanted(Jacobian)) addJacobians(job);
        if (wanted(Optimize)) addOptimize();
        if (wanted(OptimizeNewton)) addNewton(job);
        if (wanted(Threads)) addThreads();
        if (wanted(OptimizeWhole)) addWhole();
        if (wanted(Refine)) addRefine();
        if (wanted(Refine500)) addPaletteClick(Refine500, refine, kClickIterations);
        if (wanted(Refine1000)) addPaletteClick(Refine1000, refine, kMoreIterations);
        if (wanted(RefineDirect)) addPaletteClick(RefineDirect, refineReference, kClickIterations);
        if (wanted(Render)) addRender();
        if (wanted(Preview)) addPreview(job);
    }
    CaseBench(const CaseBench&) = delete; // the measurements refer to it
    CaseBench& operator=(const CaseBench&) = delete;

    std::vector<Measurement>& measurements() { return m_measurements; }

private:
    double voxels() const { return static_cast<double>(m_case.volume->size()); }
    double sampleBytes() const { return static_cast<double>(m_case.volume->memoryBytes()); }
    /// Codes once, and both weights once: a sweep reads them whatever the number of candidates.
    double sweepBytes() const { return voxels() * (kBytesPerCode + bytesPerVoxel(m_weights)); }

    /// Adds the row once per number of threads; once in all where the work is not done by our threads.
    void add(const BenchResult& result, double bytes, const std::function<void(BenchResult&, const JobControl&)>& work,
             int times = 1) {
        for (const int threads : m_options.threads) {
            if ((result.engine == "gl" || result.engine == "slices") && threads != m_options.threads.back()) continue;
            addWith(threads, result, bytes, work, times);
        }
    }
    void addWith(int threads, const BenchResult& result, double bytes,
                 const std::function<void(BenchResult&, const JobControl&)>& work, int times = 1) {
        Measurement m{result, work, times, {}, {}, false};
        m.result.threads = threads;
        m.result.bytes = bytes;
        m_measurements.push_back(std::move(m));
    }

    BenchResult row(BenchRow row, const std::string& engine, int candidates, const TransferFunction& tf,
                    const std::string& tfName) const {
        BenchResult r;
        r.row = row;
        r.engine = engine;
        r.volume = m_case.volumeName;
        r.dims = m_case.volume->dims();
        r.tf = tfName;
        if (candidates > 0) r.candidates = candidates;
        r.features = static_cast<int>(tf.features.size());
        r.extra = nlohmann::ordered_json::object();
        return r;
    }
    BenchResult row(BenchRow which, const std::string& engine, int candidates = 0) const { ///< 0: none are measured
        return row(which, engine, candidates, m_case.tf, m_case.tfName);
    }

    /// The volume as it is, and read anew from what writers make of it.
    void addOpen(const JobControl& job) {
        if (m_case.volume->elsewhere() != nullptr) return; // no process has all of it
        m_files.emplace();
        for (const char* name : {"raw.mhd", "gzip.nrrd", "vtk.vti", "stack.tif", "image.zarr"}) {
            writeVolume(*m_case.volume, m_files->path(name), {}, {job.stop, {}});
            addOpen(name);
        }
        if (!fitsDicom(*m_case.volume)) return;
        std::filesystem::create_directory(m_files->path("dicom"));
        writeDicomSlices(*m_case.volume, m_files->path("dicom"));
        addOpen("dicom");
    }
    void addOpen(const std::string& name) {
        BenchResult r = row(BenchRow::Open, "cpu");
        r.tf.reset();
        r.features.reset();
        r.extra = {{"file", name}};
        addWith(1, r, sampleBytes(), [path = m_files->path(name)](BenchResult&, const JobControl& j) {
            VolumeSource source;
            source.path = path;
            source.downsample = 1;
            loadVolume(source, j);
        });
    }

    void addSetup() {
        BenchResult r = row(BenchRow::Setup, m_engine->name());
        r.tf.reset();
        r.features.reset();
        add(r, sampleBytes() + voxels() * kBytesPerCode, [this](BenchResult&, const JobControl&) {
            makeEngine(m_options.engine, m_case.volume, m_options.quality);
        });
    }

    /// Into memory that is there, as the window does after an edit.
    void addSaliency(BenchRow which, decltype(updateSaliencyFields)* update) {
        add(row(which, "cpu"), 0, [this, update](BenchResult& r, const JobControl& job) {
            update(m_weights, *m_case.volume, m_case.tf, {}, job, nullptr);
            r.bytes = sampleBytes() + voxels() * bytesPerVoxel(m_weights);
        });
    }

    void addSweeps(const JobControl& job) {
        const auto sums = m_engine->sums(m_case.view, {&m_case.tf, 1}, &m_weights, {job.stop, {}});
        m_candidates = searchCandidates(m_case.tf, vwsOf(sums[0]), m_case.stepScale);
        // One by one the same eight, since more opaque ones are done sooner. Where nothing is opaque one stands for
        // all.
        const int singles = m_case.equalCosts ? 1 : static_cast<int>(m_candidates.size());
        add(
            row(BenchRow::Sweep, m_engine->name(), 1), sweepBytes(),
            [this, singles](BenchResult&, const JobControl& j) {
                for (int i = 0; i < singles; ++i)
                    m_engine->sums(m_case.view, {&m_candidates[static_cast<std::size_t>(i)], 1}, &m_weights, j);
            },
            singles);
        add(row(BenchRow::Sweep, m_engine->name(), 8), sweepBytes(),
            [this](BenchResult&, const JobControl& j) { m_engine->sums(m_case.view, m_candidates, &m_weights, j); });
    }

    /// A sweep by the thesis's own method. Where there is no OpenGL the row is left out, not the others.
    void addSlices() {
        add(row(BenchRow::Slices, name(EngineChoice::Slices), 1), sweepBytes(),
            [this](BenchResult&, const JobControl& j) {
                if (!m_slices) m_slices = makeEngine(EngineChoice::Slices, m_case.volume, m_options.quality);
                m_slices->sums(m_case.view, {&m_case.tf, 1}, &m_weights, j);
            });
    }

    void addJacobians(const JobControl& job) {
        if (!m_case.tf.features.empty())
            add(row(BenchRow::Jacobian, m_engine->name(), 1), sweepBytes(), [this](BenchResult&, const JobControl& j) {
                m_engine->jacobian(m_case.view, m_case.tf, &m_weights, j);
            });
        if (!m_case.nineFeatures) return;
        m_nine = tents(9);
        m_nineWeights = saliencyFields(*m_case.volume, m_nine, {}, job);
        add(row(BenchRow::Jacobian, m_engine->name(), 1, m_nine, kNineTents), sweepBytes(),
            [this](BenchResult&, const JobControl& j) { m_engine->jacobian(m_case.view, m_nine, &m_nineWeights, j); });
    }

    /// The search alone: engine and weights are there.
    void addOptimize() {
        if (m_case.tf.features.empty()) return;
        add(row(BenchRow::Optimize, m_engine->name(), 8), 0,
            [this](BenchResult& r, const JobControl& j) { search(*m_engine, r, j); });
    }
    /// The same with ever more threads, which OpenGL would not use.
    void addThreads() {
        if (m_case.tf.features.empty()) return;
        m_threaded = makeEngine(EngineChoice::Cpu, m_case.volume, m_options.quality);
        for (const int threads : m_options.searchThreads)
            addWith(threads, row(BenchRow::Threads, m_threaded->name(), 8), 0,
                    [this](BenchResult& r, const JobControl& j) { search(*m_threaded, r, j); });
    }
    void search(VisibilityEngine& engine, BenchResult& r, const JobControl& job) const {
        const EngineVws function(engine, m_case.view, m_case.tf, m_weights);
        OptimizeOptions options;
        options.method = SearchMethod::Parallel;
        const OptimizeResult found = resultOf({function, benchTargets(m_case.tf.features.size())}, options, job);
        const int sweeps = 1 + (found.evaluations - 1) / 8; // the start, then eight at a time
        r.bytes = sweeps * sweepBytes();
        r.extra = {{"iterations", found.iterations()},
                   {"evaluations", found.evaluations},
                   {"sweeps", sweeps},
                   {"objective", found.history[found.best].objective},
                   {"converged", found.converged()}};
    }

    VwsEstimates estimatesAnew(const JobControl& job) const {
        return rayEstimates(
            std::make_shared<RaySamples>(*m_case.volume, m_case.tf, m_case.view, m_weights, JobControl{job.stop, {}}),
            m_case.tf);
    }

    /// Its rays are there, too.
    void addNewton(const JobControl& job) {
        if (m_case.tf.features.empty()) return;
        const Stopwatch watch;
        const VwsEstimates estimates = estimatesAnew(job);
        add(row(BenchRow::OptimizeNewton, m_engine->name(), 8), 0,
            [this, estimates, setup = watch.seconds()](BenchResult& r, const JobControl& j) {
                const EngineVws function(*m_engine, m_case.view, m_case.tf, m_weights);
                OptimizeProblem problem{function, benchTargets(m_case.tf.features.size())};
                problem.estimates = estimates;
                const OptimizeResult found = resultOf(problem, {}, j);
                // The start, and with each move derivatives and candidates; rays cost next to nothing.
                const int sweeps = 1 + found.iterations();
                r.bytes = sweeps * sweepBytes();
                r.extra = {{"iterations", found.iterations()},
                           {"coarse_iterations", found.coarseIterations()},
                           {"evaluations", found.evaluations},
                           {"estimates_seconds", setup},
                           {"objective", found.history[found.best].objective},
                           {"converged", found.converged()}};
            });
    }

    /// Rays are made anew each time, as they are for the first optimization of a volume and a view.
    void addWhole() {
        if (m_case.tf.features.empty()) return;
        for (const auto& [name, targets] : m_case.targets) {
            BenchResult result = row(BenchRow::OptimizeWhole, m_engine->name(), 8);
            result.extra = {{"target", name}};
            add(result, 0, [this, name = name, targets = targets](BenchResult& r, const JobControl& j) {
                const EngineVws function(*m_engine, m_case.view, m_case.tf, m_weights);
                OptimizeProblem problem{function, targets};
                double estimatesSeconds = 0;
                problem.makeEstimates = [&] {
                    const Stopwatch watch;
                    VwsEstimates estimates = estimatesAnew(j);
                    estimatesSeconds = watch.seconds();
                    return estimates;
                };
                const Stopwatch raysWatch;
                const RayBundle rays(*m_case.volume, m_case.tf, m_case.view, kCoverageRays, j);
                const double raysSeconds = raysWatch.seconds();
                problem.rays = &rays;
                const OptimizeResult found = resultOf(problem, {}, j);
                r.extra = {{"target", name},
                           {"estimates_seconds", estimatesSeconds},
                           {"rays_seconds", raysSeconds},
                           {"iterations", found.iterations()},
                           {"coarse_iterations", found.coarseIterations()},
                           {"evaluations", found.evaluations},
                           {"objective", found.history[found.best].objective},
                           {"coverage", found.seen->coverage.coverage},
                           {"stopped", pellucid::name(found.reason)}};
            });
        }
    }

    void addRefine() {
        add(row(BenchRow::Refine, "cpu"), sampleBytes(), [this](BenchResult& r, const JobControl& j) {
            r.extra = {{"iterations", refine(makeHistogram(*m_case.volume), m_case.tf, {}, j).iterations}};
        });
    }

    /// What follows a click on the palette: the histogram is there, an intensity is prioritized.
    void addPaletteClick(BenchRow which, decltype(refine)* by, int iterations) {
        if (!m_histogram) m_histogram = makeHistogram(*m_case.volume);
        add(row(which, "cpu"), 0, [this, by, iterations](BenchResult& r, const JobControl& j) {
            RefineOptions options;
            options.priority.intensity = 0.25;
            options.untilStable = false;
            options.maxIterations = iterations;
            const RefineResult refined = by(*m_histogram, m_case.tf, options, j);
            r.extra = {{"iterations", refined.iterations}, {"energy", refined.energyMovableAfter}};
        });
    }

    void addRender() {
        const std::shared_ptr<ImageRenderer> renderer = makeRenderer(m_options.engine, m_case.volume);
        for (const RenderSettings& settings : pictures())
            addPictures(pictureRow(BenchRow::Render, renderer->name(), settings),
                        [renderer, settings, this](const Camera& camera, const JobControl& j) {
                            return renderer->render(camera, m_case.tf, settings, j);
                        });
    }

    /// What the cpu renderer shows while the hand moves, and how alike it is to the picture.
    void addPreview(const JobControl& job) {
        const std::shared_ptr<TileRenderer> renderer = makeCpuRenderer(m_case.volume);
        for (const RenderSettings& settings : pictures()) {
            BenchResult r = pictureRow(BenchRow::Preview, renderer->name(), settings);
            double least = 1;
            for (int i = 0; i < m_options.orbit; ++i) {
                const Camera camera = viewOf(i);
                least = std::min(least, ssim(renderer->render(camera, m_case.tf, settings, job),
                                             renderer->preview(camera, m_case.tf, settings, 1, job)));
            }
            r.extra["ssim"] = least;
            addPictures(std::move(r), [renderer, settings, this](const Camera& camera, const JobControl& j) {
                return renderer->preview(camera, m_case.tf, settings, 1, j);
            });
        }
    }

    std::vector<RenderSettings> pictures() const {
        std::vector<RenderSettings> all = m_options.pictures;
        for (RenderSettings& settings : all) settings.clipping = m_case.view.clipping;
        return all;
    }
    Camera viewOf(int i) const { return turned(m_case.view.camera, 2 * std::numbers::pi * i / m_options.orbit); }

    BenchResult pictureRow(BenchRow which, const std::string& engine, const RenderSettings& settings) const {
        BenchResult r = row(which, engine);
        r.extra = {{"size", {settings.width, settings.height}}};
        if (settings.light.on) r.extra["lit"] = true;
        if (m_options.orbit > 1)
            r.extra.update(
                {{"frames", nlohmann::ordered_json::array()}, {"cpu_frames", nlohmann::ordered_json::array()}});
        return r;
    }

    /// Times `draw` from all views.
    template <class Draw>
    void addPictures(const BenchResult& r, const Draw& draw) {
        add(
            r, voxels() * kBytesPerCode,
            [this, draw](BenchResult& result, const JobControl& j) {
                for (int i = 0; i < m_options.orbit; ++i) {
                    const Stopwatch watch;
                    const double cpuStart = cpuSeconds();
                    draw(viewOf(i), j);
                    if (m_options.orbit == 1) continue;
                    result.extra["frames"].push_back(watch.seconds());
                    result.extra["cpu_frames"].push_back(cpuSeconds() - cpuStart);
                }
            },
            m_options.orbit);
    }

    const BenchCase& m_case;
    const BenchOptions& m_options;
    std::unique_ptr<VisibilityEngine> m_engine;   ///< null where no row needs one
    std::unique_ptr<VisibilityEngine> m_slices;   ///< made when first needed
    std::unique_ptr<VisibilityEngine> m_threaded; ///< of the rows Threads
    std::optional<FolderForFiles> m_files;        ///< of the rows Open
    std::optional<Histogram> m_histogram;
    WeightFields m_weights, m_nineWeights;
    TransferFunction m_nine;
    std::vector<TransferFunction> m_candidates; ///< the eight of a search
    std::vector<Measurement> m_measurements;
};

/// Runs it once, or several times where that takes less than `least` seconds.
void measure(Measurement& m, double least, bool counts, const JobControl& job, std::vector<std::string>& notices) {
    const Stopwatch all;
    do {
        job.throwIfStopped();
        try {
            const Stopwatch watch;
            const double cpuStart = cpuSeconds();
            const nlohmann::ordered_json before = counts ? nlohmann::ordered_json() : m.result.extra;
            m.work(m.result, job);
            if (!counts) { // nor does what it tells
                m.result.extra = before;
                return;
            }
            m.seconds.push_back(watch.seconds() / m.times);
            m.cpuSeconds.push_back((cpuSeconds() - cpuStart) / m.times);
        } catch (const Error& e) {
            m.failed = true;
            const std::string row = std::string("row ") + name(m.result.row) + " of " + m.result.volume;
            const std::string notice = row + " is left out: " + e.what();
            if (notices.empty() || notices.back() != notice) notices.push_back(notice);
        }
    } while (!m.failed && all.seconds() < least);
}

/// How many times as fast as with one thread, to the rows Threads.
void addSpeedups(std::span<BenchResult> rows) {
    for (BenchResult& r : rows) {
        if (r.row != BenchRow::Threads) continue;
        const auto alone = std::find_if(rows.begin(), rows.end(), [&](const BenchResult& other) {
            return other.row == r.row && other.volume == r.volume && other.tf == r.tf && other.threads == 1;
        });
        if (alone != rows.end() && r.seconds > 0) r.extra["speedup"] = alone->seconds / r.seconds;
        r.extra["processors"] = processorCount();
    }
}

} // namespace

int processorCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

std::string sharedProcessorsText(std::span<const int> threads, int processors) {
    std::string more;
    int last = 0;
    for (const int count : threads) {
        if (count <= processors) continue;
        if (last > 0) more += (more.empty() ? "" : ", ") + std::to_string(last);
        last = count;
    }
    if (last == 0) return {};
    return (more.empty() ? "" : more + " and ") + std::to_string(last) + " threads share " +
           std::to_string(processors) + (processors == 1 ? " processor" : " processors");
}

TransferFunction denseTf() {
    TransferFunction tf;
    for (int i = 0; i < 3; ++i) {
        const double a = i / 3.0, b = (i + 1) / 3.0;
        const Rgb color = rgbFromHsv(360 * (a + b) / 2, 1, 1);
        tf.points.push_back({a, kDensePeak, color, false, {}});
        tf.points.push_back({b, kDensePeak, color, false, {}});
        tf.features.push_back({"f" + std::to_string(i + 1), a, b, color, {}});
    }
    return tf;
}

BenchCase dense(BenchCase of) {
    of.tf = denseTf();
    of.stepScale = kDenseStepScale;
    of.equalCosts = true;
    return of;
}

TransferFunction sparseTf(const Volume& volume) {
    constexpr int kBins = 256, kTents = 3;
    const Histogram histogram = makeHistogram(volume, kBins);
    TransferFunction tf = tents(kTents);
    // The tents' ends, from above: each tent takes as many voxels, but at least one bin.
    std::array<int, kTents + 1> end{};
    end[kTents] = kBins;
    std::uint64_t above = 0;
    int bin = kBins;
    for (int t = kTents - 1; t >= 0; --t) {
        const double wanted = kSparseShare * (kTents - t) / kTents * static_cast<double>(histogram.total);
        do {
            above += histogram.counts[static_cast<std::size_t>(--bin)];
        } while (bin > t && static_cast<double>(above) < wanted);
        end[static_cast<std::size_t>(t)] = bin;
    }
    for (std::size_t t = 0; t < kTents; ++t) {
        const double a = static_cast<double>(end[t]) / kBins, b = static_cast<double>(end[t + 1]) / kBins;
        tf.points[3 * t].x = a;
        tf.points[3 * t + 1].x = (a + b) / 2;
        tf.points[3 * t + 2].x = b;
        tf.features[t].a = a;
        tf.features[t].b = b;
    }
    return tf;
}

std::shared_ptr<const Volume> tiled(const Volume& block, int n) {
    Geometry geometry = block.geometry();
    const Int3 d = geometry.dims;
    geometry.dims = d * n;
    Samples samples = std::visit(
        [&](const auto& from) -> Samples {
            std::vector<typename std::decay_t<decltype(from)>::value_type> to;
            to.reserve(voxelCount(geometry.dims));
            for (int k = 0; k < geometry.dims.z; ++k)
                for (int j = 0; j < geometry.dims.y; ++j) {
                    const std::ptrdiff_t row = d.x * (j % d.y + static_cast<std::ptrdiff_t>(d.y) * (k % d.z));
                    for (int i = 0; i < n; ++i) to.insert(to.end(), from.begin() + row, from.begin() + row + d.x);
                }
            return to;
        },
        block.samples());
    return std::make_shared<const Volume>(Volume(geometry, std::move(samples)).withRange(block.range()));
}

nlohmann::ordered_json jsonFromBenchResult(const BenchResult& r, std::optional<double> memcpyGbPerS) {
    const auto voxels = static_cast<double>(voxelCount(r.dims));
    nlohmann::ordered_json j{{"name", name(r.row)}, {"engine", r.engine}, {"volume", r.volume}};
    if (r.tf) j["tf"] = *r.tf;
    j["dims"] = {r.dims.x, r.dims.y, r.dims.z};
    j["threads"] = r.threads;
    if (r.candidates) j["candidates"] = *r.candidates;
    if (r.features) j["features"] = *r.features;
    const double seconds = std::max(r.seconds, 1e-9); // of the clock's resolution
    j["runs"] = r.runs;
    j["seconds"] = r.seconds;
    j["cpu_seconds"] = r.cpuSeconds;
    j["ns_per_voxel"] = 1e9 * r.seconds / voxels;
    j["gb_per_s"] = r.bytes / seconds / 1e9;
    j["bytes_per_voxel"] = r.bytes / voxels;
    if (memcpyGbPerS) j["memcpy_share"] = r.bytes / seconds / 1e9 / *memcpyGbPerS;
    j.update(r.extra);
    return j;
}

void bench(std::span<const BenchCase> cases, const BenchOptions& options, const JobControl& job,
           BenchResults& results) {
    const JobControl quiet{job.stop, {}}; // reports would cost time
    std::set<int> counts(options.threads.begin(), options.threads.end());
    setThreadCount(options.threads.back());
    std::deque<CaseBench> benches; // does not move them
    std::size_t rows = 0;
    for (const BenchCase& each : cases) {
        rows += benches.emplace_back(each, options, quiet).measurements().size();
        if (each.rows.contains(BenchRow::Threads))
            counts.insert(options.searchThreads.begin(), options.searchThreads.end());
    }

    const int rounds = options.repeat.value_or(kRounds);
    const double all = static_cast<double>(rows) * (rounds + 1);
    double done = 0;
    // One number of threads after the other: a core that has been idle takes its time to run at full speed.
    for (const int threads : counts) {
        setThreadCount(threads);
        for (int round = 0; round <= rounds; ++round) // the first warms up
            for (CaseBench& bench : benches)
                for (Measurement& m : bench.measurements()) {
                    if (m.result.threads != threads) continue;
                    if (!m.failed) measure(m, options.repeat ? 0 : kLeastSeconds, round > 0, quiet, results.notices);
                    job.report(++done / all);
                }
    }
    const std::size_t first = results.rows.size();
    for (CaseBench& bench : benches)
        for (Measurement& m : bench.measurements()) {
            if (m.failed) continue;
            m.result.runs = static_cast<int>(m.seconds.size());
            m.result.seconds = median(m.seconds);
            m.result.cpuSeconds = median(m.cpuSeconds);
            results.rows.push_back(std::move(m.result));
        }
    addSpeedups(std::span(results.rows).subspan(first));
    // An optimization in sweeps of eight: a ratio of processor times, which hardly change where others use the machine.
    const auto sweepOf = [&](const BenchResult& whole) {
        return std::find_if(results.rows.begin(), results.rows.end(), [&](const BenchResult& r) {
            return r.row == BenchRow::Sweep && r.candidates == 8 && r.volume == whole.volume && r.tf == whole.tf &&
                   r.threads == whole.threads;
        });
    };
    for (std::size_t i = first; i < results.rows.size(); ++i)
        if (BenchResult& r = results.rows[i]; r.row == BenchRow::OptimizeWhole)
            if (const auto sweep = sweepOf(r); sweep != results.rows.end() && sweep->cpuSeconds > 0)
                r.extra["sweeps"] = r.cpuSeconds / sweep->cpuSeconds;
}

double memcpyGbPerS(int threads, const JobControl& job) {
    const std::vector<char> from(kMemcpyBytes, 1); // written, so that every page is there
    std::vector<char> to(kMemcpyBytes, 0);
    const auto pieces = static_cast<std::size_t>(threads);
    setThreadCount(threads);
    std::vector<double> seconds;
    for (int run = 0; run < 6; ++run) {
        job.throwIfStopped();
        const Stopwatch watch;
        parallelFor(pieces, [&](std::size_t i) {
            const std::size_t begin = kMemcpyBytes * i / pieces, end = kMemcpyBytes * (i + 1) / pieces;
            std::memcpy(to.data() + begin, from.data() + begin, end - begin);
        });
        if (run > 0) seconds.push_back(watch.seconds());
    }
    return 2.0 * static_cast<double>(kMemcpyBytes) / median(seconds) / 1e9;
}

} // namespace pellucid
