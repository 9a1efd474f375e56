#include "ranks/process_ranks.h"

#include "base/atomic_file.h"

namespace pellucid {

namespace {

Communicator* g_ranks = nullptr;
bool g_dividesFrames = false;

/// A rank without others.
class OnlyRank final : public Communicator {
public:
    int rank() const override { return 0; }
    int size() const override { return 1; }
    void await(const Work&) override {}
    std::vector<RankMessage> exchange(std::vector<RankMessage> messages) override { return messages; }
    void sum(std::span<double>) override {}
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override {
        return {{bytes.begin(), bytes.end()}};
    }
};

} // namespace

Communicator* ranksOfProcess() { return g_ranks; }

void setRanksOfProcess(Communicator* ranks) {
    g_ranks = ranks;
    keepWrittenFiles(ranks == nullptr || ranks->rank() == 0);
}

WorkAlone::WorkAlone() : m_ranks(g_ranks) {
    static OnlyRank s_only;
    if (m_ranks != nullptr) setRanksOfProcess(&s_only);
}

WorkAlone::~WorkAlone() {
    if (m_ranks != nullptr) setRanksOfProcess(m_ranks);
}

SharedWork workOfProcess() {
    if (g_ranks == nullptr) return {};
    return {static_cast<std::size_t>(g_ranks->rank()), static_cast<std::size_t>(g_ranks->size()),
            [](std::span<const std::byte> bytes) { return g_ranks->gather(bytes); }};
}

void divideFrames(bool divides) { g_dividesFrames = divides; }
bool dividesFrames() { return g_dividesFrames; }

} // namespace pellucid
