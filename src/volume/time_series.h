// The frames of a variable over time: read when they are wanted, and kept as far as a budget of memory goes.
#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "volume/histogram.h"
#include "volume/intensity_grid.h"
#include "volume/series.h"

namespace pellucid {

/// What is known of a frame without holding it.
struct FrameSummary {
    static constexpr int kBins = 1024;
    bool isKnown = false;              ///< it has been read once, or that failed
    std::string problem;               ///< why it cannot be read; empty: it can
    ValueRange range;                  ///< of its valid values; {0, 0} where none is
    std::size_t validCount = 0;        ///< voxels
    std::vector<std::uint32_t> counts; ///< of valid voxels in kBins equal bins of `range`; empty where none is valid
};

/// One frame as it is drawn and measured.
struct ShownFrame {
    std::shared_ptr<const Volume> data;         ///< as read, in the range of its own values
    std::shared_ptr<const Volume> volume;       ///< through the window
    std::shared_ptr<const Histogram> histogram; ///< of `volume`
    std::shared_ptr<const IntensityGrid> codes; ///< of `volume`
};

/// Any thread may call anything. Frames have the grid of the first one that can be read; others are refused.
class TimeSeries {
public:
    /// Makes one frame; throws FileError or Error where that cannot be done. Called from any thread, for several frames
    /// at a time.
    using Maker = std::function<Volume(int frame, const JobControl&)>;
    TimeSeries(SeriesListing listing, Maker make);

    /// Of a source: frames are loadVolume() of their sources. `then`: what is done with a frame, see VolumeSource.
    static std::shared_ptr<TimeSeries> open(const VolumeSource& source, const MemoryUse& then = {},
                                            const JobControl& job = {});

    const SeriesListing& listing() const noexcept { return m_listing; }
    int size() const noexcept { return static_cast<int>(m_listing.frames.size()); }
    bool varies() const noexcept { return size() > 1; }
    int nearest(int frame) const noexcept { return std::clamp(frame, 0, size() - 1); }

    /// The frame as read. Throws FileError where it is missing or broken, or has another grid than the series;
    /// Cancelled.
    std::shared_ptr<const Volume> load(int frame, const JobControl& job = {});
    /// The frame through `window` (empty: range()), with all that drawing and measuring begin with. Throws likewise.
    ShownFrame show(int frame, const std::optional<ValueRange>& window, const JobControl& job = {});
    /// Whether show() of this would neither read a file nor go over voxels.
    bool isShown(int frame, const std::optional<ValueRange>& window) const;

    /// Smallest and largest value of all frames: those of the only one, what the data declare, or what survey() finds.
    ValueRange range(const JobControl& job = {});
    std::optional<ValueRange> knownRange() const; ///< of several frames, the same where none has to be read for it
    /// Reads every frame once, if that has not been done, without keeping more than the budget allows. A frame that
    /// cannot be read is passed over; Error where none can.
    void survey(const JobControl& job = {});
    bool isSurveyed() const;
    FrameSummary summary(int frame) const;
    /// Takes the frame for one that cannot be read until it is read again: it may be sound, and what belongs to it not.
    void noteProblem(int frame, const std::string& problem);
    /// Voxels of a frame in `bins` equal bins of `window`, from its summary; those beyond count at the ends. Empty
    /// where it is not known.
    std::vector<double> countsIn(int frame, const ValueRange& window, int bins) const;

    /// Bytes that frames may take, codes and frames that are being read included; at least one frame is always held.
    /// The default is a quarter of the memory that is free now, at most 2 GiB. Frames that somebody else holds, too,
    /// stay and count: to forget them would free nothing. Who finds no room to read waits for others.
    void setBudget(std::size_t bytes);
    /// Of series that are opened from now on; empty: as above.
    static void setDefaultBudget(std::optional<std::size_t> bytes);
    std::size_t budget() const;
    std::size_t heldBytes() const; ///< of frames that are held or being read
    int roomFor() const;           ///< frames that the budget has room for; size() before the first was read

private:
    struct Entry {
        std::shared_ptr<const Volume> data;
        std::optional<ValueRange> window; // of `shown`
        ShownFrame shown;                 // its volume is null until it is asked for
        std::size_t bytes = 0;
        std::list<int>::iterator used; // in m_used
    };
    std::size_t held() const; // m_mutex is held, here and in the next ones
    void makeRoom(std::size_t bytes);
    void touch(Entry& entry);
    bool mustWait(int frame) const;
    void note(int frame, const Volume& volume);

    const SeriesListing m_listing;
    const Maker m_make;
    mutable std::mutex m_mutex;
    std::condition_variable m_loaded;
    std::map<int, Entry> m_entries;
    std::list<int> m_used;   // frames of m_entries, the latest first
    std::set<int> m_loading; // frames that somebody is reading
    std::vector<FrameSummary> m_summaries;
    std::optional<Geometry> m_geometry; // of the first frame that was read
    std::size_t m_entryBytes = 0;       // of all m_entries
    std::size_t m_frameBytes = 0;       // of a frame with its codes; 0: not known yet
    std::size_t m_budget = 0;
    std::optional<ValueRange> m_range;
};

} // namespace pellucid
