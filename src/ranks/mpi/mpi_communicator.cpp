#include "ranks/mpi/mpi_communicator.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <string_view>
#include <thread>

#include <mpi.h>

#include "base/check.h"

namespace pellucid {

namespace {

constexpr int kTag = 1;
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30; ///< bytes: MPI counts in int

void require(int code, const char* doing) {
    if (code == MPI_SUCCESS) return;
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    throw Error(std::string("MPI cannot ") + doing + ": " + std::string(text.data(), static_cast<std::size_t>(length)),
                "", "see what mpirun says of the network and the ranks");
}

/// The longest pauses between two questions whether something has ended. Ranks that still compute may take long, so
/// that asking must cost little. Once all ranks take part, each question moves the data on: without the kernel's help,
/// MPI copies the next part of a large message only when it is asked.
constexpr std::chrono::microseconds kUntilAllCome{10'000}, kWhileDataMove{100};

/// Waits for what has been begun. MPI's own calls ask without a pause, and take the processor from ranks that have
/// something to do; here the pauses grow with the wait, up to `longest`.
void finish(std::span<MPI_Request> requests, const char* doing, std::chrono::nanoseconds longest = kWhileDataMove,
            const Communicator::Work& meanwhile = {}) {
    constexpr std::chrono::microseconds kAtHand{50};
    const auto begin = std::chrono::steady_clock::now();
    for (int done = 0;;) {
        require(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE), doing);
        if (done != 0) return;
        if (meanwhile && meanwhile()) continue;
        const std::chrono::nanoseconds waited = std::chrono::steady_clock::now() - begin;
        if (waited > kAtHand) std::this_thread::sleep_for(std::min(waited / 4, longest));
    }
}
void finish(MPI_Request request, const char* doing, std::chrono::nanoseconds longest = kWhileDataMove,
            const Communicator::Work& meanwhile = {}) {
    finish({&request, 1}, doing, longest, meanwhile);
}

/// Of the program that runs, so that ranks with different ones find out.
std::uint64_t programHash() {
    std::ifstream in("/proc/self/exe", std::ios::binary);
    std::uint64_t hash = 0;
    std::vector<char> piece(1 << 20);
    while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
        const std::string_view read(piece.data(), static_cast<std::size_t>(in.gcount()));
        hash = std::rotl(hash, 1) ^ std::hash<std::string_view>{}(read);
    }
    return hash;
}

/// Where a rank fails amid a call, the others wait for messages that never come: it takes all with it.
class Together {
public:
    explicit Together(MPI_Comm group) : m_group(group), m_exceptions(std::uncaught_exceptions()) {}
    ~Together() {
        if (std::uncaught_exceptions() <= m_exceptions) return;
        std::fprintf(stderr, "error: a rank has no memory for the messages of others, or the network failed, "
                             "use more ranks or machines with more memory\n");
        MPI_Abort(m_group, 1);
    }
    Together(const Together&) = delete;
    Together& operator=(const Together&) = delete;

private:
    MPI_Comm m_group;
    int m_exceptions;
};

} // namespace

struct MpiRanks::Group {
    MPI_Comm comm = MPI_COMM_WORLD;
    bool isOfProgram = true; ///< the program's own, with which MPI ends
};

MpiRanks::MpiRanks(int& argc, char**& argv) : m_group(std::make_unique<Group>()) {
    int provided = 0;
    require(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "begin");
    findPlace();
}

MpiRanks::MpiRanks(const void* comm) : m_group(std::make_unique<Group>()) {
    m_group->isOfProgram = false;
    require(MPI_Comm_dup(*static_cast<const MPI_Comm*>(comm), &m_group->comm), "begin");
    findPlace();
}

void MpiRanks::findPlace() {
    MPI_Comm_set_errhandler(m_group->comm, MPI_ERRORS_RETURN);
    MPI_Comm_rank(m_group->comm, &m_rank);
    MPI_Comm_size(m_group->comm, &m_size);
}

MpiRanks::~MpiRanks() {
    // What has not been agreed on cannot be ended in order: others may wait for this one for ever.
    if (!m_left && m_size > 1) MPI_Abort(m_group->comm, 1);
    if (m_group->isOfProgram)
        MPI_Finalize();
    else
        MPI_Comm_free(&m_group->comm);
}

int MpiRanks::onThisMachine() {
    requireAll();
    MPI_Comm here = MPI_COMM_NULL;
    require(MPI_Comm_split_type(m_group->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here), "find neighbours");
    int count = 1;
    MPI_Comm_size(here, &count);
    MPI_Comm_free(&here);
    return count;
}

void MpiRanks::requireSameProgram() {
    const auto all = gatherValues(*this, programHash());
    for (const std::uint64_t other : all)
        if (other != all.front())
            throw Error("the ranks run different programs", "mpirun", "give all of them the same pellucid-mpi");
}

void MpiRanks::requireAll(const Work& meanwhile) {
    // Calls of two threads would meet those of others in any order.
    int isMain = 0;
    MPI_Is_thread_main(&isMain);
    PELLUCID_CHECK(isMain != 0);
    if (m_lost) throw RankLost(); // others are past this call
    ++m_traffic.rounds;
    int well = 1, all = 0;
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Iallreduce(&well, &all, 1, MPI_INT, MPI_MIN, m_group->comm, &request), "reach all ranks");
    finish(request, "reach all ranks", kUntilAllCome, meanwhile);
    if (all == 1) return;
    m_lost = true;
    throw RankLost();
}

MpiRanks::Ending MpiRanks::leave(const Ending& mine) {
    m_left = true;
    // The others may be in any of their calls, which all begin with requireAll().
    if (!m_lost) {
        int well = mine.status == 0 ? 1 : 0, all = 0;
        MPI_Request request = MPI_REQUEST_NULL; // the counterpart of requireAll()'s
        MPI_Iallreduce(&well, &all, 1, MPI_INT, MPI_MIN, m_group->comm, &request);
        finish(request, "end", kUntilAllCome);
    }
    const std::string& text = mine.message;
    const std::array<int, 2> own{mine.status, static_cast<int>(text.size())};
    std::vector<int> sizes(static_cast<std::size_t>(m_size) * 2);
    MPI_Allgather(own.data(), 2, MPI_INT, sizes.data(), 2, MPI_INT, m_group->comm);
    Ending result;
    int from = -1;
    bool allSay = true;
    for (int r = m_size - 1; r >= 0; --r) {
        const int status = sizes[static_cast<std::size_t>(r) * 2], length = sizes[static_cast<std::size_t>(r) * 2 + 1];
        if (status != 0 && (result.status == 0 || length > 0)) result.status = status;
        if (length > 0)
            from = r;
        else
            allSay = false;
    }
    if (from < 0) return result;
    result.message.resize(static_cast<std::size_t>(sizes[static_cast<std::size_t>(from) * 2 + 1]));
    if (m_rank == from) result.message = text;
    MPI_Bcast(result.message.data(), static_cast<int>(result.message.size()), MPI_CHAR, from, m_group->comm);
    if (!allSay && m_size > 1) result.message = "rank " + std::to_string(from) + ": " + result.message;
    return result;
}

void MpiRanks::await(const Work& meanwhile) {
    std::exception_ptr fault;
    requireAll([&] {
        if (fault) return false;
        try {
            return meanwhile();
        } catch (...) { // the others have been told that this rank comes
            fault = std::current_exception();
            return false;
        }
    });
    if (fault) std::rethrow_exception(fault);
}

std::vector<RankMessage> MpiRanks::exchange(std::vector<RankMessage> messages) {
    requireAll();
    const Together together(m_group->comm);
    const auto count = static_cast<std::size_t>(m_size);
    std::vector<std::uint64_t> send(count, 0), receive(count, 0);
    for (const RankMessage& message : messages) send[static_cast<std::size_t>(message.rank)] = message.bytes.size();
    MPI_Request sizes = MPI_REQUEST_NULL;
    require(MPI_Ialltoall(send.data(), 1, MPI_UINT64_T, receive.data(), 1, MPI_UINT64_T, m_group->comm, &sizes),
            "tell how much is sent");
    finish(sizes, "tell how much is sent");
    std::vector<RankMessage> arrived;
    for (std::size_t r = 0; r < count; ++r) {
        if (receive[r] == 0) continue;
        RankMessage& message = arrived.emplace_back();
        message.rank = static_cast<int>(r);
        if (message.rank != m_rank) message.bytes.resize(receive[r]);
    }
    std::vector<MPI_Request> requests;
    for (RankMessage& message : arrived)
        for (std::size_t at = 0; message.rank != m_rank && at < message.bytes.size(); at += kMostAtOnce)
            require(MPI_Irecv(message.bytes.data() + at,
                              static_cast<int>(std::min(kMostAtOnce, message.bytes.size() - at)), MPI_BYTE,
                              message.rank, kTag, m_group->comm, &requests.emplace_back()),
                    "receive");
    for (RankMessage& message : messages) {
        if (message.bytes.empty()) continue;
        if (message.rank == m_rank) {
            for (RankMessage& mine : arrived)
                if (mine.rank == m_rank) mine.bytes = std::move(message.bytes);
            continue;
        }
        m_traffic.bytes += message.bytes.size();
        ++m_traffic.messages;
        for (std::size_t at = 0; at < message.bytes.size(); at += kMostAtOnce)
            require(MPI_Isend(message.bytes.data() + at,
                              static_cast<int>(std::min(kMostAtOnce, message.bytes.size() - at)), MPI_BYTE,
                              message.rank, kTag, m_group->comm, &requests.emplace_back()),
                    "send");
    }
    ++m_traffic.rounds;
    finish(requests, "exchange messages");
    return arrived;
}

void MpiRanks::sum(std::span<double> values) {
    requireAll();
    const Together together(m_group->comm);
    const int count = static_cast<int>(values.size());
    std::vector<double> other(values.size());
    MPI_Request request = MPI_REQUEST_NULL;
    // Pairs, pairs of pairs, …: the order depends on the number of ranks alone.
    for (int step = 1; step < m_size; step *= 2) {
        if ((m_rank & step) != 0) {
            require(MPI_Isend(values.data(), count, MPI_DOUBLE, m_rank - step, kTag, m_group->comm, &request), "send");
            finish(request, "send");
            m_traffic.bytes += values.size_bytes();
            ++m_traffic.messages;
            break;
        }
        if (m_rank + step >= m_size) continue;
        require(MPI_Irecv(other.data(), count, MPI_DOUBLE, m_rank + step, kTag, m_group->comm, &request), "receive");
        finish(request, "receive");
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += other[i];
    }
    require(MPI_Ibcast(values.data(), count, MPI_DOUBLE, 0, m_group->comm, &request), "tell all ranks");
    finish(request, "tell all ranks");
}

std::vector<std::vector<std::byte>> MpiRanks::gather(std::span<const std::byte> bytes) {
    requireAll();
    const Together together(m_group->comm);
    const auto count = static_cast<std::size_t>(m_size);
    const std::uint64_t mine = bytes.size();
    std::vector<std::uint64_t> sizes(count);
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Iallgather(&mine, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, m_group->comm, &request),
            "tell all ranks");
    finish(request, "tell all ranks");
    // A rank after the other where one is large, since MPI counts in int; else all at once.
    std::vector<std::vector<std::byte>> all(count);
    std::uint64_t total = 0;
    for (const std::uint64_t size : sizes) total += size;
    m_traffic.bytes += mine * (count - 1);
    if (total < kMostAtOnce) {
        std::vector<std::byte> joined(total);
        std::vector<int> counts(count), starts(count);
        for (std::size_t r = 0, at = 0; r < count; at += sizes[r], ++r) {
            counts[r] = static_cast<int>(sizes[r]);
            starts[r] = static_cast<int>(at);
        }
        require(MPI_Iallgatherv(bytes.data(), static_cast<int>(mine), MPI_BYTE, joined.data(), counts.data(),
                                starts.data(), MPI_BYTE, m_group->comm, &request),
                "tell all ranks");
        finish(request, "tell all ranks");
        for (std::size_t r = 0; r < count; ++r) {
            const auto first = joined.begin() + starts[r];
            all[r].assign(first, first + counts[r]);
        }
        return all;
    }
    for (std::size_t r = 0; r < count; ++r) {
        if (static_cast<int>(r) == m_rank) all[r].assign(bytes.begin(), bytes.end());
        all[r].resize(sizes[r]);
        for (std::size_t at = 0; at < sizes[r]; at += kMostAtOnce) {
            require(MPI_Ibcast(all[r].data() + at, static_cast<int>(std::min<std::size_t>(kMostAtOnce, sizes[r] - at)),
                               MPI_BYTE, static_cast<int>(r), m_group->comm, &request),
                    "tell all ranks");
            finish(request, "tell all ranks");
        }
    }
    return all;
}

} // namespace pellucid
