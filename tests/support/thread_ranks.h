// Ranks as threads of one process: the same program without MPI.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "ranks/communicator.h"

namespace pellucid::test {

/// Where the threads meet. One that fails takes the others along.
class MeetingPoint {
public:
    explicit MeetingPoint(int count) : m_count(count), m_boxes(static_cast<std::size_t>(count)) {}

    /// Goes on when all have come.
    void meet() {
        std::unique_lock lock(m_mutex);
        if (m_failed) throw RankLost();
        if (++m_waiting == m_count) {
            m_waiting = 0;
            ++m_round;
            m_changed.notify_all();
            return;
        }
        m_changed.wait(lock, [&, round = m_round] { return m_round != round || m_failed; });
        if (m_failed) throw RankLost();
    }
    void fail() {
        const std::lock_guard lock(m_mutex);
        m_failed = true;
        m_changed.notify_all();
    }
    std::vector<std::vector<RankMessage>>& boxes() { return m_boxes; } ///< of each rank, by sender
    std::mutex& mutex() { return m_mutex; }

private:
    int m_count, m_waiting = 0;
    std::uint64_t m_round = 0;
    bool m_failed = false;
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::vector<std::vector<RankMessage>> m_boxes;
};

class ThreadRank final : public Communicator {
public:
    ThreadRank(MeetingPoint& point, int rank, int size) : m_point(point), m_rank(rank), m_size(size) {}
    int rank() const override { return m_rank; }
    int size() const override { return m_size; }

    /// Ranks of odd numbers do all of the work, the others none.
    void await(const Work& meanwhile) override {
        while (m_rank % 2 == 1 && meanwhile()) {
        }
        m_point.meet();
    }
    std::vector<RankMessage> exchange(std::vector<RankMessage> messages) override {
        ++m_traffic.rounds;
        {
            const std::lock_guard lock(m_point.mutex());
            for (RankMessage& message : messages) {
                if (message.bytes.empty()) continue;
                const auto to = static_cast<std::size_t>(message.rank);
                if (message.rank != m_rank) {
                    m_traffic.bytes += message.bytes.size();
                    ++m_traffic.messages;
                }
                message.rank = m_rank;
                m_point.boxes()[to].push_back(std::move(message));
            }
        }
        m_point.meet();
        auto mine = std::move(m_point.boxes()[static_cast<std::size_t>(m_rank)]);
        m_point.boxes()[static_cast<std::size_t>(m_rank)].clear();
        m_point.meet();
        std::ranges::sort(mine, {}, &RankMessage::rank);
        return mine;
    }
    void sum(std::span<double> values) override {
        std::vector<double> all(values.size(), 0.0);
        for (const auto& bytes : gather(std::as_bytes(values))) {
            ByteReader reader(bytes);
            for (double& value : all) value += reader.take<double>();
        }
        std::ranges::copy(all, values.begin());
    }
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override {
        std::vector<RankMessage> messages;
        for (int r = 0; r < m_size; ++r) messages.push_back({r, {bytes.begin(), bytes.end()}});
        std::vector<std::vector<std::byte>> all(static_cast<std::size_t>(m_size));
        for (RankMessage& message : exchange(std::move(messages)))
            all[static_cast<std::size_t>(message.rank)] = std::move(message.bytes);
        return all;
    }

private:
    MeetingPoint& m_point;
    int m_rank, m_size;
};

/// Calls body(communicator) on `count` threads; rethrows what the first rank that failed has thrown.
inline void onRanks(int count, const std::function<void(Communicator&)>& body) {
    MeetingPoint point(count);
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int r = 0; r < count; ++r)
        threads.emplace_back([&, r] {
            try {
                ThreadRank rank(point, r, count);
                body(rank);
            } catch (const RankLost&) {
            } catch (...) {
                thrown[static_cast<std::size_t>(r)] = std::current_exception();
                point.fail();
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const auto& e : thrown)
        if (e) std::rethrow_exception(e);
}

} // namespace pellucid::test
