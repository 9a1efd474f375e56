// How long the parts of a measurement take on one volume, with several numbers of threads (docs/performance.md).
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/enum_names.h"
#include "base/job.h"
#include "engines/engines.h"
#include "render/render_settings.h"
#include "render/view.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

enum class BenchRow {
    Open, ///< the volume from files of several formats, which the cache of the system holds
    Setup,
    Saliency,
    SaliencyDirect,
    Sweep,
    Slices,
    Jacobian,
    Optimize,       ///< by parallel line search
    OptimizeNewton, ///< the same targets
    Threads,        ///< Optimize by the cpu engine with each of BenchOptions::searchThreads (thesis fig. 5.11)
    OptimizeWhole,  ///< all that an optimization does from saliency on, per BenchCase::targets
    Refine,
    Refine500,
    Refine1000,
    RefineDirect,
    Render,
    Preview ///< the same pictures as the cpu renderer draws them while the hand moves
};
template <>
inline constexpr auto kNamesOf<BenchRow> = enumNames("row", "open", "setup", "saliency", "saliency-direct", "sweep",
                                                     "slices", "jacobian", "optimize", "optimize-newton", "threads",
                                                     "optimize-whole", "refine", "refine-500", "refine-1000",
                                                     "refine-direct", "render", "preview");

/// One line of the table.
struct BenchResult {
    BenchRow row = BenchRow::Setup;
    std::string engine, volume;
    std::optional<std::string> tf;
    Int3 dims{0, 0, 0};
    int threads = 1;
    std::optional<int> candidates, features;
    int runs = 0;                 ///< warm ones
    double seconds = 0;           ///< median of the warm runs
    double cpuSeconds = 0;        ///< of all threads together, median too: hardly changes where others use the machine
    double bytes = 0;             ///< that have to be read or written at least once, see docs/performance.md
    nlohmann::ordered_json extra; ///< further fields of this row, an object
};

/// A row as `bench --json` prints it, keys in that order. `memcpyGbPerS` is that of as many threads, where it is known.
nlohmann::ordered_json jsonFromBenchResult(const BenchResult& result, std::optional<double> memcpyGbPerS);

/// A volume under a transfer function, and what is to be measured of them.
struct BenchCase {
    std::shared_ptr<const Volume> volume;
    std::string volumeName;
    View view; ///< looks at the volume
    std::string tfName;
    TransferFunction tf;
    std::set<BenchRow> rows;
    /// By name, of the rows OptimizeWhole: one number ≥ 0 per feature.
    std::vector<std::pair<std::string, std::vector<double>>> targets{};
    bool nineFeatures = false; ///< a Jacobian of kNineTents too
    /// Length of the steps of the eight candidates in those of a line search, (0, 1].
    double stepScale = 1;
    bool equalCosts = false; ///< nothing is left out whatever the candidate: one stands for all in the row of 1 TF
};

inline constexpr const char* kNineTents = "tents:9";
inline constexpr const char* kDense = "dense";
inline constexpr const char* kSparse = "sparse";
inline constexpr const char* kCube = "cube:"; ///< name of a volume, followed by the number of voxels along each side

/// Every voxel has an opacity, so low that no ray is exhausted: nothing can be left out. Three features.
TransferFunction denseTf();
/// The case under denseTf().
BenchCase dense(BenchCase of);
/// Three tents over the (about) 3 % of the voxels with the highest intensities: nearly all can be left out.
TransferFunction sparseTf(const Volume& volume);
/// Blocks of the same volume side by side, `n` along each axis: the same voxels whatever the size, so that only the
/// engine can make larger ones slower.
std::shared_ptr<const Volume> tiled(const Volume& block, int n);

struct BenchOptions {
    std::vector<int> threads;                   ///< ascending
    std::vector<int> searchThreads{1, 2, 4, 8}; ///< of the rows Threads: ascending, from 1 on
    std::optional<int> repeat; ///< runs of each row after a warm-up; else as many as tell enough, 3 at least
    EngineChoice engine = EngineChoice::Auto;
    Quality quality = Quality::Normal;
    std::vector<RenderSettings> pictures{{}}; ///< a row `render` and a row `preview` of each
    int orbit = 1; ///< those rows draw so many views from all around (axis: z), and tell the time of each
};

struct BenchResults {
    std::vector<BenchResult> rows;
    std::vector<std::string> notices; ///< about rows that could not be measured
};

/// Processors that threads can run on at once here.
int processorCount();
/// Which of `threads` there are more of than processors, in a sentence; empty where there are none.
std::string sharedProcessorsText(std::span<const int> threads, int processors);

/// Appends the rows of `cases`. Their repetitions with as many threads alternate, so that a machine that changes its
/// speed changes that of all of them, and their ratios hold.
void bench(std::span<const BenchCase> cases, const BenchOptions& options, const JobControl& job, BenchResults& results);

inline constexpr std::size_t kMemcpyBytes = std::size_t{256} << 20;
/// Bytes read plus bytes written per second, in 1e9, by a plain copy of kMemcpyBytes cut into one piece per thread:
/// what this machine's memory gives. Median of five.
double memcpyGbPerS(int threads, const JobControl& job);

} // namespace pellucid
