// What a source names over time: its frames, told by names and headers alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "volume/loader.h"

namespace pellucid {

/// One time step.
struct SeriesFrame {
    VolumeSource source;   ///< of this step alone: what loadVolume() takes
    double time = 0;       ///< in SeriesListing::timeUnit; the index where the data tell no times
    std::string name;      ///< for people: its file without suffix, or "step 7"
    bool afterGap = false; ///< numbers are missing between the file before and its own, and no frames stand for them
};

/// The frames of a source in their order; at least one.
struct SeriesListing {
    std::vector<SeriesFrame> frames;
    std::string timeUnit;                    ///< "s", "ms", …; empty: not known
    bool hasTimes = false;                   ///< SeriesFrame::time comes from the data
    std::string title;                       ///< what all frames are called together
    std::optional<ValueRange> declaredRange; ///< of the values of all frames, where it is known without reading them
    std::vector<std::string> notices;        ///< files that were passed over, and the like

    /// "frame 7", "t = 12.3 s", "step 7".
    std::string label(int frame) const;
    /// The name of its file without folder, "rho_07.nrrd", with the step where it holds several: "rho.nii.gz, step 7";
    /// of a sample "sample:vortex, step 7".
    std::string fileOf(int frame) const;
};

/// Lists what `source` names: a printf pattern ("f%02d.raw"), a glob ("f*.mhd"), a folder of volume files, a file with
/// several time steps, several files (VolumeSource::more), a sample with frames, or a single volume. Names are sorted
/// as people count: f2 before f10. Nothing but headers is read.
///
/// Numbered files (of a pattern, and of a glob or folder whose names differ in one number only) run from the smallest
/// number to the largest at the step most of them follow at. A number between that is not there is a frame, too, so
/// that frames stay where they are in time: load() of it fails, and it is passed over like any broken one. Where more
/// frames were missing than there are, only those that there are count, and SeriesFrame::afterGap tells. Of files of
/// several suffixes those of the most frequent one are taken; a_0.vti beside a.pvti is a piece of that one. Files that
/// hold several steps give all of them, one file after the other.
///
/// Frames keep raw, missing, component, axes, array, downsample and region of `source`. Throws FileError where nothing
/// is found, UsageError for VolumeSource::frames that are not there.
SeriesListing listSeries(const VolumeSource& source, const JobControl& job = {});

/// The files that listSeries() takes frames from, in their order and without looking into them: those on disk, or the
/// one that is named where nothing is there.
std::vector<std::string> seriesFiles(const VolumeSource& source);

/// Whether `path` names files by a printf pattern or a glob, rather than one.
bool isSeriesPattern(const std::string& path);

} // namespace pellucid
