// `bench`: how fast this machine measures, as a table (docs/performance.md says what the rows mean).
#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"
#include "bench/bench.h"
#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "render/memory_needs.h"
#include "report/drawing_file.h"
#include "resolve.h"
#include "session/target_presets.h"
#include "session/variable_edits.h"
#include "threads_plot.h"

namespace pellucid::cli {

namespace {

struct BenchArguments {
    SceneOptions scene;
    std::optional<std::set<BenchRow>> only;
    std::optional<int> repeat;
    bool full = false;
    RenderSettings picture;
    int orbit = 1;
    std::optional<std::string> plot; ///< file of the curves over the number of threads

    bool onBuiltIn() const { return !scene.volume.path && !scene.sessionFile; }
    /// All where none are named; but slices only with a GPU at work, since a software rasterizer takes minutes.
    std::set<BenchRow> rows() const {
        if (only) return *only;
        constexpr auto kRows = allOf<BenchRow>();
        std::set<BenchRow> all(kRows.begin(), kRows.end());
        if (scene.engine.given.values().engine == EngineChoice::Cpu ||
            scene.engine.given.values().engine == EngineChoice::Reference || !haveGpu())
            all.erase(BenchRow::Slices);
        return all;
    }
};

constexpr int kCubeSize = 128; ///< of the smallest

/// All rows at once: what measuring takes, weights for nine features (4), a renderer's codes (3) and, while `setup`
/// runs, another engine (5). Of lean volumes the weights (1) come twice.
const Work kWork{{"measuring", kMeasureBytesPerVoxel + 4 + 3 + 5, kLeanMeasureBytesPerVoxel + 1}, true};

/// One name per comma.
std::set<BenchRow> parseRows(const std::string& text, const std::string& option) {
    std::set<BenchRow> rows;
    for (const std::string& part : split(text, ',')) rows.insert(parseName<BenchRow>(part, option));
    return rows;
}

void check(const BenchArguments& o) {
    if (!o.onBuiltIn() && o.full)
        throw UsageError("--full works with the built-in volumes only", "--full", "leave out --full or VOLUME");
    if (o.onBuiltIn() && o.scene.volume.anyDetail())
        throw UsageError("options for a volume are given, but no volume", "bench", "name a file or sample:NAME");
    if (o.plot && !o.rows().contains(BenchRow::Threads))
        throw UsageError("--plot draws the row threads, which --only leaves out", *o.plot, "add threads to --only");
}

std::set<BenchRow> both(const std::set<BenchRow>& a, const std::set<BenchRow>& b) {
    std::set<BenchRow> rows;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(rows, rows.end()));
    return rows;
}

/// Measures, and tells what it found.
class Run {
public:
    /// `most`: threads that the user asks for.
    Run(const BenchArguments& options, std::optional<int> most, Progress& progress)
        : m_options(options), m_rows(options.rows()), m_progress(progress) {
        SceneOptions scene = options.scene;
        if (options.onBuiltIn()) {
            scene.volume.path = "sample:knee";
            if (!scene.tf.spec) scene.tf.spec = "tents:3";
        }
        m_inputs = inputsOf(scene, kWork, m_results.notices);
        m_mainVolume = dataVariable(m_inputs.session).source.path;
        m_mainTf = scene.tf.spec.value_or(scene.sessionFile ? "session" : "default");
        m_bench.threads = most ? std::vector{*most} : std::vector{1, 2};
        if (most) m_bench.searchThreads = searchThreadsUpTo(*most);
        m_bench.repeat = options.repeat;
        m_bench.engine = m_inputs.session.measure->engine;
        m_bench.quality = m_inputs.session.measure->quality;
        m_bench.pictures = {options.picture};
        m_bench.orbit = options.orbit;
    }

    void memory() {
        const JobControl job = m_progress.phase("memcpy");
        requireMemory("copying", "memcpy", 2 * kMemcpyBytes);
        for (const int threads : m_bench.threads) m_memcpy.push_back(memcpyGbPerS(threads, job));
    }
    void draw() const {
        if (m_options.plot)
            writeDrawing([plot = threadsPlot(m_results.rows)](const PlotPage& page) { return drawingOf(plot, page); },
                         {.width = 640, .height = 400}, *m_options.plot);
    }
    void givenVolume() {
        const Scene scene = openScene(m_inputs, m_progress.phase("loading"));
        m_results.notices.insert(m_results.notices.end(), scene.volume->notices.begin(), scene.volume->notices.end());
        measureMain(scene);
    }
    void builtInVolumes() {
        measureMain(openScene(m_inputs, m_progress.phase("loading")));
        const std::set<BenchRow> rows = both(m_rows, {BenchRow::Sweep, BenchRow::Saliency, BenchRow::Jacobian});
        if (rows.empty()) return;
        SceneOptions blockOptions = m_options.scene;
        blockOptions.volume.path = "sample:shells";
        blockOptions.volume.sampleSize = kCubeSize;
        const SceneInputs inputs = inputsOf(blockOptions, kWork, m_results.notices);
        const Scene block = openScene(inputs, m_progress.phase("loading"));
        const bool isDense = !m_options.scene.tf.spec;
        const int largest = m_options.full ? 4 : 2;
        requireMemory(inputs.then, kCube + std::to_string(largest * kCubeSize), block.volume->dims() * largest,
                      block.volume->sampleType());
        std::vector<BenchCase> cubes;
        for (int n = 1; n <= largest; n *= 2) {
            const auto volume = n == 1 ? block.volume : tiled(*block.volume, n);
            cubes.push_back({volume,
                             kCube + std::to_string(n * kCubeSize),
                             {cameraOf(inputs, volume->geometry()), *inputs.session.clipping},
                             m_options.scene.tf.spec.value_or(kDense),
                             block.tf,
                             rows});
            if (isDense) cubes.back() = dense(std::move(cubes.back()));
        }
        bench(cubes, m_bench, m_progress.phase("cubes"), m_results);
    }

    Answer answer() const {
        Answer answer{textOfMemory() + "\n" + textOfRows() + textOfRatios(), json(), m_results.notices};
        if (m_rows.contains(BenchRow::Threads))
            if (const std::string shared = sharedProcessorsText(m_bench.searchThreads, processorCount());
                !shared.empty())
                answer.notices.push_back("rows threads: " + shared);
        if (m_options.plot) {
            answer.text += "wrote " + *m_options.plot + "\n";
            answer.json["plot"] = *m_options.plot;
        }
        return answer;
    }

private:
    /// All rows under `tf` and, unless the user wants this one alone, some under two of other densities.
    void measureMain(const Scene& scene) {
        const auto caseOf = [&](const std::string& tfName, TransferFunction tf, std::set<BenchRow> rows) {
            return BenchCase{scene.volume, m_mainVolume,  {scene.camera, *scene.session.clipping},
                             tfName,       std::move(tf), std::move(rows)};
        };
        BenchCase main = caseOf(m_mainTf, scene.tf, m_rows);
        main.nineFeatures = true;
        for (const TargetPreset preset : {TargetPreset::Equal, TargetPreset::Diagonal, TargetPreset::InsideOut})
            main.targets.emplace_back(name(preset), presetTargets(preset, scene.tf, *scene.session.goals));
        std::vector<BenchCase> cases{std::move(main)};
        if (!m_options.scene.tf.spec) {
            const std::set<BenchRow> rows = both(m_rows, {BenchRow::Sweep, BenchRow::Jacobian, BenchRow::Optimize});
            cases.push_back(dense(caseOf(kDense, scene.tf, rows)));
            cases.push_back(caseOf(kSparse, sparseTf(*scene.volume), rows));
        }
        for (const BenchCase& each : cases) // in turn: only one's fields are in memory
            if (!each.rows.empty())
                bench({&each, 1}, m_bench, m_progress.phase(m_mainVolume + ", " + each.tfName), m_results);
    }

    /// The numbers of the thesis, as far as the user goes.
    static std::vector<int> searchThreadsUpTo(int most) {
        std::vector<int> threads;
        for (int n = 1; n < most && n <= 8; n *= 2) threads.push_back(n);
        threads.push_back(most);
        return threads;
    }

    std::optional<double> memcpyOf(int threads) const {
        const auto at = std::find(m_bench.threads.begin(), m_bench.threads.end(), threads);
        if (at == m_bench.threads.end()) return {};
        return m_memcpy[static_cast<std::size_t>(at - m_bench.threads.begin())];
    }

    // ---- The ratios ------------------------------------------------------------------------------------------------

    struct Ratio {
        std::string key;
        double value;
        std::string wanted;
    };

    /// The first row of this kind; null where there is none.
    const BenchResult* find(BenchRow row, const std::string& volume, const std::string& tf, int threads,
                            int candidates = 1) const {
        for (const BenchResult& r : m_results.rows)
            if (r.row == row && r.volume == volume && r.tf == tf && r.threads == threads &&
                r.candidates.value_or(candidates) == candidates)
                return &r;
        return nullptr;
    }

    /// Of the first volume and transfer function, with the most threads; see docs/performance.md.
    std::vector<Ratio> ratios() const {
        std::vector<Ratio> all;
        const int threads = m_bench.threads.back();
        const auto add = [&](const char* key, const BenchResult* a, const BenchResult* b, double times,
                             const char* wanted) {
            if (a && b && b->seconds * times > 0) all.push_back({key, a->seconds / (b->seconds * times), wanted});
        };
        const auto main = [&](BenchRow row, int threadCount, int candidates = 1) {
            return find(row, m_mainVolume, m_mainTf, threadCount, candidates);
        };
        const BenchResult* const sweep8 = main(BenchRow::Sweep, threads, 8);
        const BenchResult* const saliency = main(BenchRow::Saliency, threads);
        add("sweep8_over_8_singles", sweep8, main(BenchRow::Sweep, threads, 1), 8, "<= 0.35");
        if (m_bench.threads == std::vector{1, 2}) {
            add("threads_speedup", main(BenchRow::Sweep, 1, 8), sweep8, 1, ">= 1.7");
            add("threads_speedup_saliency", main(BenchRow::Saliency, 1), saliency, 1, "");
        }
        add("jacobian_over_sweep8", find(BenchRow::Jacobian, m_mainVolume, kNineTents, threads), sweep8, 1, "<= 2");
        add("saliency_over_sweep8", saliency, sweep8, 1, "<= 3");
        add("saliency_direct_over_saliency", main(BenchRow::SaliencyDirect, threads), saliency, 1, ">= 3");
        const BenchResult* const refined = main(BenchRow::Refine500, threads);
        add("refine_direct_over_refine500", main(BenchRow::RefineDirect, threads), refined, 1, ">= 20");
        add("preview_over_render", main(BenchRow::Preview, threads), main(BenchRow::Render, threads), 1, "");
        add("refine500_over_render", refined, main(BenchRow::Render, threads), 1, "<= 0.05");
        if (const BenchResult* const optimized = main(BenchRow::Optimize, threads, 8))
            add("optimize_over_sweeps", optimized, sweep8, optimized->extra.at("iterations").get<double>(), "<= 3");
        if (std::vector<double> sweeps = wholeInSweeps(threads); !sweeps.empty()) {
            std::sort(sweeps.begin(), sweeps.end());
            const double median = (sweeps[(sweeps.size() - 1) / 2] + sweeps[sweeps.size() / 2]) / 2;
            all.push_back({"optimize_whole_median_sweeps", median, "<= 4"});
            all.push_back({"optimize_whole_most_sweeps", sweeps.back(), "<= 6"});
        }
        add("newton_over_optimize", main(BenchRow::OptimizeNewton, threads), main(BenchRow::Optimize, threads), 1,
            "<= 0.5");
        if (const auto flat = flatness(threads)) all.push_back({"flatness", *flat, "<= 1.25"});
        return all;
    }

    std::vector<double> wholeInSweeps(int threads) const {
        std::vector<double> sweeps;
        for (const BenchResult& r : m_results.rows)
            if (r.row == BenchRow::OptimizeWhole && r.threads == threads && r.extra.contains("sweeps"))
                sweeps.push_back(r.extra["sweeps"].get<double>());
        return sweeps;
    }

    /// Largest time per voxel over the smallest, of the cubes; empty where there are not two.
    std::optional<double> flatness(int threads) const {
        std::vector<double> perVoxel;
        for (const BenchResult& r : m_results.rows)
            if (r.row == BenchRow::Sweep && r.volume.starts_with(kCube) && r.threads == threads && r.candidates == 8)
                perVoxel.push_back(r.seconds / static_cast<double>(voxelCount(r.dims)));
        if (perVoxel.size() < 2) return {};
        const auto [least, most] = std::minmax_element(perVoxel.begin(), perVoxel.end());
        return *most / *least;
    }

    // ---- The answer ------------------------------------------------------------------------------------------------

    std::string textOfMemory() const {
        std::string text = "memcpy";
        for (std::size_t i = 0; i < m_memcpy.size(); ++i)
            text += (i == 0 ? " " : ", ") + fixedText(m_memcpy[i], 1) + " GB/s with " +
                    std::to_string(m_bench.threads[i]) + (m_bench.threads[i] == 1 ? " thread" : " threads");
        return text + " (bytes read and written)\n";
    }

    std::string textOfRows() const {
        Table table({"row", "volume", "TF", "engine", "threads", "time", "CPU time", "ns/voxel", "GB/s", "of memcpy"});
        for (const BenchResult& r : m_results.rows) {
            const Json j = jsonOfRow(r);
            std::string label = name(r.row);
            if (r.row == BenchRow::Sweep)
                label += *r.candidates == 1 ? ", 1 TF" : ", " + std::to_string(*r.candidates) + " TFs";
            if (r.row == BenchRow::Jacobian) label += ", " + std::to_string(*r.features) + " features";
            if (r.row == BenchRow::Optimize || r.row == BenchRow::OptimizeNewton || r.row == BenchRow::Threads)
                label += ", " + j["iterations"].dump() + " moves";
            if (j.contains("ssim")) label += ", SSIM " + fixedText(j["ssim"], 3);
            if (j.contains("speedup")) label += ", " + fixedText(j["speedup"], 2) + "x";
            if (r.row == BenchRow::Open) label += ", " + r.extra["file"].get<std::string>();
            if (r.row == BenchRow::OptimizeWhole) {
                label += ", " + j["target"].get<std::string>();
                if (j.contains("sweeps")) label += ", " + fixedText(j["sweeps"], 1) + " sweeps";
            }
            table.add({label, r.volume, r.tf.value_or(""), r.engine, std::to_string(r.threads), secondsText(r.seconds),
                       secondsText(r.cpuSeconds), fixedText(j["ns_per_voxel"], 2), fixedText(j["gb_per_s"], 2),
                       j.contains("memcpy_share") ? fixedText(100 * j["memcpy_share"].get<double>(), 1) + " %" : "-"});
        }
        return table.text();
    }

    std::string textOfRatios() const {
        Table table({"ratio", "value", "wanted"});
        const auto all = ratios();
        if (all.empty()) return {};
        for (const Ratio& r : all)
            table.add({r.key, r.value < 0.01 ? plainText(r.value) : fixedText(r.value, 3), r.wanted});
        return "\n" + table.text();
    }

    Json jsonOfRow(const BenchResult& r) const { return jsonFromBenchResult(r, memcpyOf(r.threads)); }

    Json json() const {
        Json rows = Json::array(), memory = Json::array(), values = Json::object();
        for (const BenchResult& r : m_results.rows) rows.push_back(jsonOfRow(r));
        for (std::size_t i = 0; i < m_memcpy.size(); ++i)
            memory.push_back({{"threads", m_bench.threads[i]}, {"gb_per_s", m_memcpy[i]}});
        for (const Ratio& r : ratios()) values[r.key] = r.value;
        return {{"command", "bench"},
                {"memcpy_gb_per_s", m_memcpy.back()},
                {"memcpy", memory},
                {"rows", rows},
                {"ratios", values}};
    }

    const BenchArguments& m_options;
    std::set<BenchRow> m_rows;
    Progress& m_progress;
    SceneInputs m_inputs; ///< of the first volume
    BenchOptions m_bench;
    std::vector<double> m_memcpy; ///< GB/s, per number of threads
    BenchResults m_results;
    std::string m_mainVolume, m_mainTf; ///< the first ones, which the ratios are about
};

Answer run(const BenchArguments& o, bool threadsGiven, Progress& progress) {
    check(o);
    Run bench(o, threadsGiven ? std::optional(threadCount()) : std::nullopt, progress);
    bench.memory();
    if (o.onBuiltIn())
        bench.builtInVolumes();
    else
        bench.givenVolume();
    bench.draw();
    return bench.answer();
}

} // namespace

Command addBench(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "bench", "Measures how fast this machine measures, with 1 and 2 threads (or --threads N)");
    const auto o = std::make_shared<BenchArguments>();
    o->scene.camera.fallback = ViewAngles{30, 20, 1}; // whatever the window opens on: figures stay comparable
    o->scene.volume.add(*app);
    app->get_option("VOLUME")->description("the volume to measure with, as in other commands; without one, sample:knee "
                                           "under tents:3, and cubes of 128 and 256 "
                                           "voxels along each side");
    o->scene.addSession(*app);
    o->scene.tf.addSource(*app);
    app->get_option("--tf")->description("transfer function; without it that of the volume, one that gives every voxel "
                                         "a little opacity (dense), and one that gives it to 3 % of them (sparse)");
    o->scene.camera.add(*app);
    o->scene.clip.add(*app);
    o->scene.engine.add(*app);
    addValue(
        *app, "--only", "ROW,...", o->only, parseRows,
        "only these rows of the table: open, setup, saliency, saliency-direct, sweep, slices, jacobian, optimize, "
        "optimize-newton, threads, optimize-whole, refine, refine-500, refine-1000, refine-direct, render, preview");
    addValue(
        *app, "--repeat", "N", o->repeat, wholeFrom(1, 1000),
        "runs of each row after a first one that does not count; the median is reported (default: 3, and more for rows "
        "that take less than 0.2 s)");
    addValue(
        *app, "--image-size", "WxH",
        [o](const std::string& text, const std::string& option) {
            const ImageSize size = parseImageSize(text, option);
            o->picture.width = size.width;
            o->picture.height = size.height;
        },
        "pixels of the rows \"render\" and \"preview\" (default 512x512)");
    addValue(*app, "--step", "D", o->picture.stepInD0, realAbove(0, 16),
             "largest distance of samples in the rows \"render\" and \"preview\", in reference lengths (default 0.5)");
    app->add_flag("--shading", o->picture.light.on, "draw the rows \"render\" and \"preview\" with light from the eye");
    addValue(*app, "--orbit", "N", o->orbit, wholeFrom(1, 1000),
             "views from all around that the rows \"render\" and \"preview\" draw; --json lists the time of each "
             "(default 1)");
    addOutputFile(*app, "--plot", o->plot,
                  "draw the seconds of the row \"threads\" over the number of threads: .svg or .png",
                  [](const std::string& path) { checkDrawingSuffix(path, "plots"); });
    app->add_flag("--full", o->full,
                  "also measure a cube of 512 voxels along each side, which takes some minutes and 2 GiB of memory");
    return {app, [o, app](Progress& progress) { return run(*o, app->get_option("--threads")->count() > 0, progress); }};
}

} // namespace pellucid::cli
