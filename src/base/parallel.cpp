#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace pellucid {

namespace {

std::mutex g_mutex;
std::unique_ptr<tbb::global_control> g_limit;
std::shared_ptr<tbb::task_arena> g_arena; // null: the default arena, one thread per core

std::shared_ptr<tbb::task_arena> arena() {
    std::lock_guard lock(g_mutex);
    return g_arena;
}

} // namespace

void setThreadCount(int threads) {
    auto next = threads > 0 ? std::make_shared<tbb::task_arena>(threads) : nullptr;
    std::lock_guard lock(g_mutex);
    g_limit.reset();
    // Without this TBB takes no more workers than cores, and says so on stderr.
    if (threads > tbb::info::default_concurrency())
        g_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        static_cast<std::size_t>(threads));
    g_arena = std::move(next);
}

int threadCount() {
    const auto a = arena();
    return a ? a->max_concurrency() : tbb::this_task_arena::max_concurrency();
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
    // In order, one by one: who has nothing left to do waits for one call of body at most.
    std::atomic<std::size_t> next = 0;
    const auto run = [&] {
        // A loop within another's body is not left half done where that one ends early by an error.
        tbb::task_group_context alone(tbb::task_group_context::isolated);
        const auto workers = std::min(count, static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, workers, 1),
            [&](const tbb::blocked_range<std::size_t>&) {
                try {
                    for (std::size_t i = next++; i < count; i = next++) body(i);
                } catch (...) {
                    next = count; // the others need not go on
                    throw;
                }
            },
            tbb::simple_partitioner{}, alone);
    };
    if (const auto a = arena())
        a->execute(run);
    else
        run();
}

} // namespace pellucid
