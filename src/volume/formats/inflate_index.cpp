#include "volume/formats/inflate_index.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <list>
#include <utility>

#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostPlaces = 64;
constexpr std::uint64_t kFirstBetween = 1u << 20;
constexpr std::size_t kMostFiles = 16; ///< as many variables of packed files as a session is likely to have

/// Reads on from the place that is nearest.
class IndexedBytes final : public ByteSource {
public:
    IndexedBytes(const InflateIndex& index, const JobControl& job)
        : m_index(index), m_job(job), m_bytes(index.from(0, job)) {}
    std::size_t read(char* to, std::size_t count) override { return m_bytes->read(to, count); }
    bool skip(std::uint64_t count) override {
        const std::uint64_t target = m_bytes->decoded() + count;
        if (count >= kFirstBetween)
            if (auto nearer = m_index.from(target, m_job); nearer->decoded() > m_bytes->decoded())
                m_bytes = std::move(nearer);
        return ByteSource::skip(target - m_bytes->decoded());
    }

private:
    const InflateIndex& m_index;
    const JobControl& m_job;
    std::unique_ptr<InflatedBytes> m_bytes;
};

} // namespace

std::shared_ptr<InflateIndex> InflateIndex::of(const std::string& path, std::uint64_t start, bool zlib) {
    struct Known {
        std::string path;
        std::uint64_t start;
        bool zlib;
        std::uintmax_t bytes;
        std::filesystem::file_time_type time;
        std::shared_ptr<InflateIndex> index;
    };
    static std::mutex s_mutex;
    static std::list<Known> s_known; // the latest first
    std::error_code ec;
    const std::uintmax_t bytes = std::filesystem::file_size(path, ec);
    const auto time = std::filesystem::last_write_time(path, ec);
    const std::lock_guard lock(s_mutex);
    const auto known = std::ranges::find_if(
        s_known, [&](const Known& k) { return k.path == path && k.start == start && k.zlib == zlib; });
    if (known != s_known.end() && known->bytes == bytes && known->time == time) {
        s_known.splice(s_known.begin(), s_known, known);
        return s_known.front().index;
    }
    if (known != s_known.end()) s_known.erase(known);
    s_known.push_front({path, start, zlib, bytes, time, std::make_shared<InflateIndex>(path, start, zlib)});
    if (s_known.size() > kMostFiles) s_known.pop_back();
    return s_known.front().index;
}

InflateIndex::InflateIndex(std::string path, std::uint64_t start, bool zlib)
    : m_path(std::move(path)), m_start(start), m_zlib(zlib), m_between(kFirstBetween) {}

void InflateIndex::keep(const InflatedBytes& bytes) {
    if (m_places.size() == kMostPlaces) { // every other one
        for (std::size_t i = 1; 2 * i < m_places.size(); ++i) m_places[i] = std::move(m_places[2 * i]);
        m_places.erase(m_places.begin() + kMostPlaces / 2, m_places.end());
        m_between *= 2;
    }
    m_places.push_back(bytes.place());
}

std::unique_ptr<InflatedBytes> InflateIndex::unpackUpTo(std::uint64_t wanted, const JobControl& job) {
    using End = InflatedBytes::End;
    std::unique_ptr<InflatedBytes> bytes = m_places.empty()
                                               ? std::make_unique<InflatedBytes>(m_path, m_start, m_zlib, job)
                                               : std::make_unique<InflatedBytes>(m_path, m_places.back(), job);
    std::vector<char> unpacked(1u << 18);
    while (bytes->soundBytes() < wanted && bytes->end() == End::None) {
        bytes->read(unpacked.data(), unpacked.size());
        const std::uint64_t last = m_places.empty() ? 0 : m_places.back().decoded;
        if (bytes->end() == End::None && bytes->decoded() >= last + m_between) keep(*bytes);
    }
    m_sound = bytes->soundBytes();
    return bytes;
}

void InflateIndex::require(std::uint64_t wanted, const JobControl& job) {
    const std::lock_guard lock(m_mutex);
    if (m_sound >= wanted) return;
    const auto bytes = unpackUpTo(wanted, job);
    if (m_sound < wanted) failToUnpack(*bytes, wanted, m_path);
}

std::uint64_t InflateIndex::requireWhole(const JobControl& job) {
    const std::lock_guard lock(m_mutex);
    if (m_whole) return *m_whole;
    pellucid::requireWhole(*unpackUpTo(std::numeric_limits<std::uint64_t>::max(), job), 0, m_path);
    m_whole = m_sound;
    return *m_whole;
}

std::unique_ptr<InflatedBytes> InflateIndex::from(std::uint64_t decoded, const JobControl& job) const {
    const std::lock_guard lock(m_mutex);
    const auto after = std::ranges::upper_bound(m_places, decoded, {}, &InflatedBytes::Place::decoded);
    if (after == m_places.begin()) return std::make_unique<InflatedBytes>(m_path, m_start, m_zlib, job);
    return std::make_unique<InflatedBytes>(m_path, *(after - 1), job);
}

std::unique_ptr<ByteSource> InflateIndex::bytes(const JobControl& job) const {
    return std::make_unique<IndexedBytes>(*this, job);
}

} // namespace pellucid
