#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "base/parallel.h"

using namespace pellucid;

TEST_CASE("parallelFor calls each index once, whatever the thread count", "[parallel]") {
    for (const int threads : {1, 3, 0}) {
        setThreadCount(threads);
        std::vector<int> calls(1000, 0);
        parallelFor(calls.size(), [&](std::size_t i) { ++calls[i]; });
        CHECK(calls == std::vector<int>(1000, 1));
    }
    setThreadCount(0);
    parallelFor(0, [](std::size_t) { FAIL("nothing to call"); });
}

TEST_CASE("a reduction by slots has the same bits for any thread count", "[parallel]") {
    const auto sum = [](int threads) {
        setThreadCount(threads);
        std::vector<double> slots(64);
        parallelFor(slots.size(), [&](std::size_t s) {
            for (int i = 1; i < 1000; ++i) slots[s] += 1.0 / (static_cast<double>(s) + 0.1 * i);
        });
        double total = 0;
        for (const double v : slots) total += v;
        return total;
    };
    const double one = sum(1);
    CHECK(one == sum(2));
    CHECK(one == sum(5));
    setThreadCount(0);
}

TEST_CASE("an error in one call leaves no loop of another call half done", "[parallel]") {
    setThreadCount(4);
    for (int round = 0; round < 50; ++round) {
        std::atomic<int> returned = 0, calls = 0;
        const auto outer = [&](std::size_t i) {
            if (i == 1) throw std::runtime_error("one of them");
            parallelFor(200, [&](std::size_t) {
                std::this_thread::yield();
                ++calls;
            });
            ++returned;
        };
        CHECK_THROWS_AS(parallelFor(4, outer), std::runtime_error);
        CHECK(calls == 200 * returned);
    }
    setThreadCount(0);
}

TEST_CASE("the thread count is what was asked for", "[parallel]") {
    setThreadCount(3);
    CHECK(threadCount() == 3);
    setThreadCount(0);
    CHECK(threadCount() >= 1);
}

TEST_CASE("an exception inside parallelFor comes out", "[parallel]") {
    CHECK_THROWS_AS(parallelFor(100,
                                [](std::size_t i) {
                                    if (i == 17) throw std::runtime_error("17");
                                }),
                    std::runtime_error);
}

TEST_CASE("parallelFor begins in order, and nothing more after an exception", "[parallel]") {
    setThreadCount(1);
    std::vector<std::size_t> begun;
    CHECK_THROWS_AS(parallelFor(100,
                                [&](std::size_t i) {
                                    begun.push_back(i);
                                    if (i == 3) throw std::runtime_error("3");
                                }),
                    std::runtime_error);
    setThreadCount(0);
    CHECK(begun == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("loops may be begun inside loops, and by several threads at once", "[parallel]") {
    setThreadCount(4);
    std::atomic<int> calls = 0;
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 3; ++caller)
        callers.emplace_back([&] {
            for (int n = 0; n < 10; ++n)
                parallelFor(20, [&](std::size_t) { parallelFor(20, [&](std::size_t) { ++calls; }); });
        });
    for (std::thread& caller : callers) caller.join();
    setThreadCount(0);
    CHECK(calls == 3 * 10 * 20 * 20);
}
