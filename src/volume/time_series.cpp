#include "volume/time_series.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>

#include "base/byte_stream.h"
#include "base/check.h"
#include "base/memory.h"
#include "volume/derived.h"
#include "volume/orientation.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostBudget = std::size_t{2} << 30;
constexpr std::chrono::milliseconds kLookAtStop{50}; // of who waits
constexpr std::size_t kNoBudget = 0;
std::atomic<std::size_t> g_defaultBudget = kNoBudget;

/// What frames themselves may take of a budget: reading one and making its codes takes some for a while.
std::size_t forFrames(std::size_t budget) {
    constexpr std::size_t kWork = std::size_t{8} << 20;
    return budget >= 8 * kWork ? budget - kWork : budget;
}

std::size_t defaultBudget() {
    if (const std::size_t set = g_defaultBudget; set != kNoBudget) return set;
    return static_cast<std::size_t>(std::min<std::uint64_t>(availableMemoryBytes() / 4, kMostBudget));
}

/// Counts of valid values in equal bins of their range, of all processes.
std::vector<std::uint32_t> valueCounts(const Volume& volume) {
    std::vector<double> counts(FrameSummary::kBins, 0.0); // whole numbers, which sums of processes keep
    const ValueRange& range = volume.dataRange();
    const double scale = range.lo < range.hi ? FrameSummary::kBins / (range.hi - range.lo) : 0;
    const bool allValid = volume.invalidCount() == 0;
    const VolumePart part = partHere(volume);
    const auto count = [&](const auto& values) {
        part.forOwnRows(0, part.ownLayers(), [&](const Int3&, std::size_t row, int voxels) {
            for (std::size_t i = row; i < row + static_cast<std::size_t>(voxels); ++i) {
                if (!allValid && !part.volume->isValid(i)) continue;
                const int bin = static_cast<int>((static_cast<double>(values[i]) - range.lo) * scale);
                ++counts[static_cast<std::size_t>(std::min(bin, FrameSummary::kBins - 1))];
            }
        });
    };
    if (part.volume != nullptr) withSamples(*part.volume, count);
    if (const VoxelsElsewhere* elsewhere = volume.elsewhere()) elsewhere->sum(counts);
    constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> shown(counts.size());
    std::ranges::transform(counts, shown.begin(),
                           [kMost](double n) { return static_cast<std::uint32_t>(std::min(n, kMost)); });
    return shown;
}

/// Why a frame cannot be read. The frame has its own name: another file that is to blame is named, too.
std::string problemOf(const Error& error, const std::string& path) {
    const bool isOwn = error.where().empty() || error.where() == path;
    return isOwn ? error.problem() : error.problem() + ", " + error.where();
}

/// Of the frame's data, and of its codes of 16 bits with a byte for validity, where not all voxels are valid. Of
/// several processes the most that any has: they forget the same frames, and read them again together.
std::size_t bytesOf(const Volume& volume) {
    const Volume* const here = partHere(volume).volume;
    std::uint64_t bytes = (here != nullptr && here->isMapped() ? 0 : volume.memoryBytes()) +
                          (volume.invalidCount() > 0 ? 3 : 2) * voxelCount(volume.dimsHere());
    if (const VoxelsElsewhere* elsewhere = volume.elsewhere())
        for (const auto& of : elsewhere->gather(std::as_bytes(std::span(&bytes, 1))))
            bytes = std::max(bytes, ByteReader(of).take<std::uint64_t>());
    return bytes;
}

} // namespace

TimeSeries::TimeSeries(SeriesListing listing, Maker make)
    : m_listing(std::move(listing)), m_make(std::move(make)), m_summaries(m_listing.frames.size()),
      m_budget(defaultBudget()) {
    if (varies()) m_range = m_listing.declaredRange;
}

std::shared_ptr<TimeSeries> TimeSeries::open(const VolumeSource& source, const MemoryUse& then, const JobControl& job) {
    SeriesListing listing = listSeries(source, job);
    for (SeriesFrame& frame : listing.frames) {
        frame.source.range.reset();
        frame.source.then = then;
    }
    struct Shared {
        std::vector<SeriesFrame> frames;
        std::atomic<int> factor = 0; // by which the first frame was made coarser for memory: all have one grid
    };
    auto shared = std::make_shared<Shared>();
    shared->frames = listing.frames;
    return std::make_shared<TimeSeries>(std::move(listing), [shared](int frame, const JobControl& control) {
        VolumeSource file = shared->frames[static_cast<std::size_t>(frame)].source;
        if (file.downsample == 0 && !file.isSample()) file.downsample = shared->factor;
        Volume volume = loadVolume(file, control);
        int unset = 0;
        shared->factor.compare_exchange_strong(unset, volume.excerpt ? volume.excerpt->factor : 1);
        return volume;
    });
}

void TimeSeries::touch(Entry& entry) { m_used.splice(m_used.begin(), m_used, entry.used); }

std::size_t TimeSeries::held() const { return m_loading.size() * m_frameBytes + m_entryBytes; }

void TimeSeries::makeRoom(std::size_t bytes) {
    // Others get hold of a frame under the mutex only: none that is ours alone becomes theirs meanwhile.
    const auto isOursAlone = [](const Entry& entry) {
        const long ours = 1 + (entry.shown.data ? 1 : 0) + (entry.shown.volume == entry.data ? 1 : 0);
        return entry.data.use_count() <= ours;
    };
    std::size_t sum = held();
    for (auto frame = m_used.end(); frame != m_used.begin() && sum + bytes > forFrames(m_budget);) {
        --frame;
        const auto entry = m_entries.find(*frame);
        if ((bytes == 0 && m_entries.size() == 1) || !isOursAlone(entry->second)) continue;
        sum -= entry->second.bytes;
        m_entryBytes -= entry->second.bytes;
        m_entries.erase(entry);
        frame = m_used.erase(frame);
    }
}

/// Whether somebody else reads this frame, or so many read that there is no room for one more.
bool TimeSeries::mustWait(int frame) const {
    if (m_loading.contains(frame)) return true;
    if (m_loading.empty()) return false;
    return m_frameBytes == 0 || (m_loading.size() + 1) * m_frameBytes > forFrames(m_budget);
}

void TimeSeries::note(int frame, const Volume& volume) {
    FrameSummary summary = this->summary(frame);
    if (summary.isKnown && summary.problem.empty()) return;
    summary = {}; // a file may have come back
    summary.isKnown = true;
    summary.range = volume.dataRange();
    summary.validCount = volume.size() - volume.invalidCount();
    if (summary.validCount > 0 && varies()) summary.counts = valueCounts(volume);
    const std::lock_guard lock(m_mutex);
    m_summaries[static_cast<std::size_t>(frame)] = std::move(summary);
}

void TimeSeries::noteProblem(int frame, const std::string& problem) {
    const std::lock_guard lock(m_mutex);
    m_summaries[static_cast<std::size_t>(frame)] = {true, problem, {}, 0, {}};
}

std::shared_ptr<const Volume> TimeSeries::load(int frame, const JobControl& job) {
    PELLUCID_CHECK(frame >= 0 && frame < size());
    const std::string& path = m_listing.frames[static_cast<std::size_t>(frame)].source.path;
    {
        std::unique_lock lock(m_mutex);
        while (true) { // one reads, the others wait for it
            if (const auto found = m_entries.find(frame); found != m_entries.end()) {
                touch(found->second);
                return found->second.data;
            }
            if (!mustWait(frame)) break;
            m_loaded.wait_for(lock, kLookAtStop);
            job.throwIfStopped();
        }
        makeRoom(m_frameBytes);
        m_loading.insert(frame);
    }
    const auto finish = [&](std::shared_ptr<const Volume> volume) {
        const std::size_t bytes = volume ? bytesOf(*volume) : 0;
        const std::lock_guard lock(m_mutex);
        m_loading.erase(frame);
        if (volume) {
            const auto [at, isNew] = m_entries.try_emplace(frame);
            Entry& entry = at->second;
            if (isNew) entry.used = m_used.insert(m_used.begin(), frame);
            entry.data = volume;
            m_entryBytes -= entry.bytes;
            entry.bytes = bytes;
            m_entryBytes += entry.bytes;
            m_frameBytes = std::max(m_frameBytes, entry.bytes);
            touch(entry);
            makeRoom(0); // it may be larger than those before
        }
        m_loaded.notify_all();
    };
    try {
        auto volume = std::make_shared<Volume>(m_make(frame, job));
        std::optional<Geometry> grid;
        {
            const std::lock_guard lock(m_mutex);
            if (!m_geometry) m_geometry = volume->geometry();
            grid = m_geometry;
        }
        if (const Geometry inSame = inUnit(volume->geometry(), unitOf(*grid));
            inSame.lengthUnit != volume->geometry().lengthUnit)
            *volume = volume->withGeometry(inSame);
        if (!onSameGrid(*grid, volume->geometry()))
            throw FileError("its grid (" + dimsText(volume->dims()) + ") is not that of the series (" +
                                dimsText(grid->dims) + ")",
                            path, "leave it out");
        if (varies()) volume->title = m_listing.title;
        note(frame, *volume);
        finish(volume);
        return volume;
    } catch (const Error& error) {
        noteProblem(frame, problemOf(error, path));
        finish(nullptr);
        throw;
    } catch (...) {
        finish(nullptr);
        throw;
    }
}

ShownFrame TimeSeries::show(int frame, const std::optional<ValueRange>& window, const JobControl& job) {
    const ValueRange wanted = window ? *window : range(job);
    std::shared_ptr<const Volume> data = load(frame, job);
    {
        const std::lock_guard lock(m_mutex);
        const auto found = m_entries.find(frame);
        if (found != m_entries.end() && found->second.shown.volume && found->second.window == wanted)
            return found->second.shown;
    }
    ShownFrame shown;
    shown.data = data;
    shown.volume = wanted == data->range() || !(wanted.lo < wanted.hi)
                       ? data
                       : std::make_shared<const Volume>(data->withRange(wanted));
    job.throwIfStopped();
    shown.histogram = std::make_shared<const Histogram>(makeHistogram(*shown.volume));
    job.throwIfStopped();
    if (const Volume* here = partHere(*shown.volume).volume) shown.codes = sharedIntensityGrid(*here);
    const std::lock_guard lock(m_mutex);
    if (const auto found = m_entries.find(frame); found != m_entries.end() && found->second.data == data) {
        found->second.window = wanted;
        found->second.shown = shown;
    }
    return shown;
}

bool TimeSeries::isShown(int frame, const std::optional<ValueRange>& window) const {
    const std::lock_guard lock(m_mutex);
    const auto found = m_entries.find(frame);
    if (found == m_entries.end() || !found->second.shown.volume) return false;
    if (window) return found->second.window == window;
    return varies() ? m_range && found->second.window == m_range : found->second.window == found->second.data->range();
}

ValueRange TimeSeries::range(const JobControl& job) {
    if (!varies()) return load(0, job)->range();
    {
        const std::lock_guard lock(m_mutex);
        if (m_range) return *m_range;
    }
    survey(job);
    const std::lock_guard lock(m_mutex);
    return *m_range;
}

std::optional<ValueRange> TimeSeries::knownRange() const {
    const std::lock_guard lock(m_mutex);
    return m_range;
}

bool TimeSeries::isSurveyed() const {
    const std::lock_guard lock(m_mutex);
    return std::ranges::all_of(m_summaries, &FrameSummary::isKnown);
}

void TimeSeries::survey(const JobControl& job) {
    std::optional<Error> first;
    for (int frame = 0; frame < size(); ++frame) {
        job.throwIfStopped();
        if (summary(frame).isKnown) continue;
        try {
            load(frame, {job.stop, {}});
        } catch (const Error& error) {
            if (!first) first = error;
        }
        job.report((frame + 1.0) / size());
    }
    const std::lock_guard lock(m_mutex);
    if (m_range) return;
    ValueRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    bool any = false, readable = false;
    for (const FrameSummary& s : m_summaries) {
        readable = readable || s.problem.empty();
        if (!s.problem.empty() || s.validCount == 0) continue;
        range.lo = std::min(range.lo, s.range.lo);
        range.hi = std::max(range.hi, s.range.hi);
        any = true;
    }
    if (!readable) {
        if (first) throw *first;
        throw Error("no frame of the series can be read", m_listing.title, "copy its files again");
    }
    m_range = any ? range : ValueRange{0, 0};
}

FrameSummary TimeSeries::summary(int frame) const {
    const std::lock_guard lock(m_mutex);
    return m_summaries.at(static_cast<std::size_t>(frame));
}

std::vector<double> TimeSeries::countsIn(int frame, const ValueRange& window, int bins) const {
    const FrameSummary s = summary(frame);
    if (!s.isKnown || s.counts.empty() || !(window.lo < window.hi)) return {};
    std::vector<double> out(static_cast<std::size_t>(bins), 0.0);
    const double width = (s.range.hi - s.range.lo) / FrameSummary::kBins;
    const auto binOf = [&](double value) { return (value - window.lo) / (window.hi - window.lo) * bins; };
    for (int b = 0; b < FrameSummary::kBins; ++b) {
        const double count = s.counts[static_cast<std::size_t>(b)];
        if (count == 0) continue;
        // Spread evenly over the bins that the values of this one lie in.
        const double from = std::clamp(binOf(s.range.lo + b * width), 0.0, bins - 1e-9);
        const double to = std::clamp(binOf(s.range.lo + (b + 1) * width), 0.0, bins - 1e-9);
        const int first = static_cast<int>(from), last = static_cast<int>(to);
        if (first == last) {
            out[static_cast<std::size_t>(first)] += count;
            continue;
        }
        for (int i = first; i <= last; ++i)
            out[static_cast<std::size_t>(i)] +=
                count * (std::min(to, i + 1.0) - std::max(from, double(i))) / (to - from);
    }
    return out;
}

void TimeSeries::setBudget(std::size_t bytes) {
    const std::lock_guard lock(m_mutex);
    m_budget = bytes;
    makeRoom(0);
}

std::size_t TimeSeries::budget() const {
    const std::lock_guard lock(m_mutex);
    return m_budget;
}

std::size_t TimeSeries::heldBytes() const {
    const std::lock_guard lock(m_mutex);
    return held();
}

void TimeSeries::setDefaultBudget(std::optional<std::size_t> bytes) { g_defaultBudget = bytes.value_or(kNoBudget); }

int TimeSeries::roomFor() const {
    const std::lock_guard lock(m_mutex);
    if (m_frameBytes == 0) return size();
    return std::max(
        1, static_cast<int>(std::min<std::size_t>(forFrames(m_budget) / m_frameBytes, m_listing.frames.size())));
}

} // namespace pellucid
