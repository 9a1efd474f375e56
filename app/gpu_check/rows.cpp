#include "rows.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/bench.h"
#include "render/camera.h"
#include "tf/transfer_function.h"
#include "volume/procedural.h"

namespace pellucid::gpu_check {

namespace {

constexpr const char* kTents = "tents:3";
constexpr int kCubeSize = 128;
constexpr double kAzimuth = 30, kElevation = 20; ///< of `bench`

BenchCase caseOf(std::shared_ptr<const Volume> volume, std::string name, std::set<BenchRow> rows) {
    const Camera camera = cameraFromView(volume->geometry(), kAzimuth, kElevation, 1, Projection::Perspective);
    return {std::move(volume), std::move(name), camera, kTents, tents(3), std::move(rows)};
}

std::vector<BenchCase> knee(const std::string& tf, const RowsOptions& o) {
    std::set<BenchRow> rows{BenchRow::Sweep, BenchRow::Jacobian, BenchRow::Optimize, BenchRow::Render};
    if (tf == kTents) rows.insert(BenchRow::Setup);
    if (tf == kTents && o.engine == EngineChoice::Cpu) rows.merge(std::set{BenchRow::Saliency, BenchRow::Refine});
    BenchCase of = caseOf(std::make_shared<const Volume>(makeSample("knee", o.size)), "sample:knee", std::move(rows));
    if (tf == kDense) {
        of.tfName = kDense;
        of = dense(std::move(of));
    } else if (tf == kSparse) {
        of.tfName = kSparse;
        of.tf = sparseTf(*of.volume);
    } else
        of.nineFeatures = true;
    return {std::move(of)};
}

std::vector<BenchCase> cubes(const RowsOptions& o) {
    std::set<BenchRow> rows{BenchRow::Sweep, BenchRow::Jacobian};
    if (o.engine == EngineChoice::Cpu) rows.insert(BenchRow::Saliency);
    const int side = o.size > 0 ? o.size : kCubeSize;
    const Volume block = makeSample("shells", side);
    std::vector<BenchCase> all;
    for (int n = 1; n <= (o.size > 0 ? 1 : 2); ++n) {
        BenchCase of = caseOf(tiled(block, n), kCube + std::to_string(n * side), rows);
        of.tfName = kDense;
        all.push_back(dense(std::move(of)));
    }
    return all;
}

} // namespace

const std::vector<std::string>& rowVolumes() {
    static const std::vector<std::string> all{std::string("knee/") + kTents, std::string("knee/") + kDense,
                                              std::string("knee/") + kSparse, std::string("cubes/") + kDense};
    return all;
}

std::vector<int> benchThreads() {
    setThreadCount(0);
    return threadCount() > 1 ? std::vector{1, threadCount()} : std::vector{1};
}

Json measureRows(const RowsOptions& o) {
    BenchOptions options;
    options.threads = benchThreads();
    options.engine = o.engine;
    if (o.once) {
        options.repeat = 1;
    } else {
        options.pictures.clear();
        for (const auto& [width, height] : {std::pair{512, 512}, {1920, 1080}})
            for (const bool lit : {false, true}) {
                RenderSettings picture;
                picture.width = width;
                picture.height = height;
                picture.light.on = lit;
                options.pictures.push_back(picture);
            }
    }
    BenchResults results;
    bench(o.volumes.starts_with("cubes") ? cubes(o) : knee(o.volumes.substr(o.volumes.find('/') + 1), o), options, {},
          results);
    Json rows = Json::array();
    for (const BenchResult& row : results.rows) {
        const auto at = std::find(options.threads.begin(), options.threads.end(), row.threads);
        rows.push_back(
            jsonFromBenchResult(row, o.memcpyGbPerS.at(static_cast<std::size_t>(at - options.threads.begin()))));
    }
    return {{"rows", rows}, {"notices", results.notices}};
}

} // namespace pellucid::gpu_check
