#include "volume/series.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/file_contents.h"
#include "volume/file_names.h"
#include "volume/formats/reader.h"
#include "volume/procedural.h"
#include "volume/process/reader_process.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 100'000; ///< a few hundred bytes each

std::string fileName(const std::string& path) { return fs::path(path).filename().string(); }

std::string filesText(std::size_t count) { return std::to_string(count) + (count == 1 ? " file" : " files"); }

SeriesListing listSample(const VolumeSource& source) {
    SeriesListing listing;
    const SampleInfo& info = sampleInfo(source.path.substr(source.path.find(':') + 1));
    listing.title = info.name;
    if (info.frames > 1) listing.declaredRange = info.range;
    for (int step = 0; step < info.frames; ++step) {
        SeriesFrame frame{source, static_cast<double>(step), "step " + std::to_string(step)};
        frame.source.frames.reset();
        frame.source.step = step;
        listing.frames.push_back(std::move(frame));
    }
    return listing;
}

/// The frames that are asked for of `count`; all without `range`.
std::vector<int> selected(int count, const std::optional<FrameRange>& range, const std::string& title) {
    const FrameRange wanted = range.value_or(FrameRange{0, {}, 1});
    const int last = wanted.last.value_or(count - 1);
    if (wanted.first < 0 || wanted.first >= count || last < wanted.first || last >= count || wanted.stride < 1)
        throw UsageError("the series has no such frames", title,
                         count == 1 ? "it has one, number 0" : "give frames from 0 to " + std::to_string(count - 1));
    if ((last - wanted.first) / wanted.stride >= kMostFrames) {
        const std::string problem =
            "a series of " + std::to_string((last - wanted.first) / wanted.stride + 1LL) + " frames";
        const std::string advice = "choose at most " + std::to_string(kMostFrames) + " of them";
        if (range) throw UsageError(problem, title, advice);
        throw FileError(problem, title, advice); // nobody has asked for so many but the file
    }
    std::vector<int> frames;
    for (long long f = wanted.first; f <= last; f += wanted.stride) frames.push_back(static_cast<int>(f));
    return frames;
}

/// Leaves out the images that are called after a file of pieces beside them: "a_0.vti" beside "a.pvti".
void dropPieces(std::map<std::string, std::vector<std::string>>& bySuffix) {
    const auto wholes = bySuffix.find(".pvti"), images = bySuffix.find(".vti");
    if (wholes == bySuffix.end() || images == bySuffix.end()) return;
    std::erase_if(images->second, [&](const std::string& image) {
        return std::ranges::any_of(wholes->second, [&](const std::string& whole) {
            return fileName(image).starts_with(fs::path(whole).stem().string());
        });
    });
    if (images->second.empty()) bySuffix.erase(images);
}

/// Those of the most frequent suffix that volumes have (any suffix, where data are headerless).
std::vector<std::string> ofOneSuffix(std::vector<std::string> paths, bool anySuffix,
                                     std::vector<std::string>& notices) {
    std::map<std::string, std::vector<std::string>> bySuffix;
    for (std::string& path : paths)
        if (anySuffix || hasVolumeSuffix(path)) bySuffix[volumeSuffix(path)].push_back(std::move(path));
    if (!anySuffix) dropPieces(bySuffix);
    if (bySuffix.empty()) return {};
    // A collection names the files beside it, and their times.
    auto chosen = bySuffix.find(".pvd");
    if (chosen == bySuffix.end() || chosen->second.size() != 1)
        chosen = std::max_element(bySuffix.begin(), bySuffix.end(),
                                  [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    std::vector<std::string> others;
    for (const auto& [suffix, files] : bySuffix)
        if (suffix != chosen->first) others.insert(others.end(), files.begin(), files.end());
    if (!others.empty() && chosen->first != ".pvd")
        notices.push_back(filesText(others.size()) + " of another suffix than *" + chosen->first +
                          (others.size() == 1 ? " was" : " were") + " passed over: " + someNames(others));
    return chosen->second;
}

/// What the source names, in order, with the names of missing files between numbered ones.
struct FileList {
    std::vector<std::string> paths;
    std::set<std::size_t> afterGap; ///< indices of paths before which numbers are missing
    std::vector<std::string> notices;
    std::string title;
};

/// Puts the names that are missing between numbered ones where they belong, unless there are too many.
void fillGaps(FileList& list, const std::optional<NumberedName>& pattern) {
    std::optional<NumberedNames> numbered = pattern ? numberedBy(*pattern, list.paths) : numberedNames(list.paths);
    const std::optional<NumberGaps> gaps = numbered ? gapsIn(numbered->numbers) : std::nullopt;
    if (!gaps) return;
    const std::vector<std::int64_t>& numbers = numbered->numbers;
    const auto [step, missing] = *gaps;
    if (missing > numbers.size()) {
        list.notices.push_back(std::to_string(missing) +
                               (missing == 1 ? " frame number is missing" : " frame numbers are missing"));
        for (std::size_t i = 1; i < numbers.size(); ++i)
            if (numbers[i] - numbers[i - 1] > step) list.afterGap.insert(i);
        return;
    }
    std::vector<std::string> paths, gone;
    std::size_t next = 0;
    for (std::int64_t number = numbers.front(); number <= numbers.back(); number += step) {
        if (numbers[next] == number) {
            paths.push_back(list.paths[next++]);
        } else {
            paths.push_back(numbered->name.with(number));
            gone.push_back(paths.back());
        }
    }
    list.paths = std::move(paths);
    list.notices.push_back(filesText(gone.size()) + (gone.size() == 1 ? " is" : " are") +
                           " missing in the series: " + someNames(gone));
}

FileList listFiles(const VolumeSource& source) {
    FileList list;
    const std::string& path = source.path;
    list.title = fileName(path);
    if (!source.more.empty()) {
        list.paths = {path};
        if (!source.raw && isDicom(path) && isDicom(source.more.front()))
            return list; // slices: the first stands for all
        list.paths.insert(list.paths.end(), source.more.begin(), source.more.end());
        list.title += " and " + std::to_string(source.more.size()) + " more";
        return list;
    }
    std::error_code ec;
    const bool isFolder = fs::is_directory(path, ec);
    if (!isFolder && !isSeriesPattern(path)) {
        list.paths = {path};
        return list;
    }
    const std::optional<NumberedName> pattern = isFolder ? std::nullopt : numberedName(path);
    if (isFolder) {
        if (list.title.empty() || list.title == "." || list.title == "..")
            list.title = fs::weakly_canonical(path, ec).filename().string();
        if (list.title.empty()) list.title = fs::weakly_canonical(path, ec).parent_path().filename().string();
        if (!source.raw && isVolumeFolder(path)) { // its files are slices
            list.paths = {path};
            return list;
        }
        list.paths = filesIn(path);
    } else {
        list.paths = pattern ? filesNumbered(*pattern) : filesMatching(path);
    }
    const std::vector<std::string> all = list.paths;
    if (!isFolder && !source.raw && all.size() > 1 && std::ranges::all_of(all, isDicom)) {
        list.paths = {*std::ranges::min_element(all, countsBefore)}; // which stands for its series
        return list;
    }
    if (!pattern) list.paths = ofOneSuffix(std::move(list.paths), source.raw.has_value(), list.notices);
    if (list.paths.empty()) {
        throw FileError(std::string("there is no file ") +
                            (all.empty() && !isFolder ? "" : "of a known volume format ") +
                            (isFolder ? "in this folder" : "with a name of this pattern"),
                        path, isFolder ? "name another folder, or a file" : "check folder and name",
                        all.empty() ? Remedy::AsSaid : Remedy::GiveRawLayout);
    }
    std::sort(list.paths.begin(), list.paths.end(), countsBefore);
    if (list.paths.size() == 1)
        list.title = fileName(list.paths.front());
    else
        fillGaps(list, pattern);
    return list;
}

/// What a file holds; nothing where it is missing or broken, which loading it will tell. One that is alone and takes
/// its reader too long is not tried twice: that is thrown.
std::optional<FileContents> knownContents(const VolumeSource& source, bool alone, const JobControl& job) {
    try {
        return contentsOf(source, job);
    } catch (const TakesTooLong&) {
        if (alone) throw;
        return {};
    } catch (const FileError&) {
        return {};
    }
}

/// The frames of one file.
void addFile(SeriesListing& listing, const VolumeSource& given, const std::string& path, bool alone,
             const JobControl& job) {
    SeriesFrame frame;
    frame.source = given;
    frame.source.path = path;
    frame.source.more.clear();
    frame.source.step = 0;
    if (!alone) frame.source.frames.reset(); // they count files, not steps of a longer headerless one
    const std::optional<FileContents> contents = knownContents(frame.source, alone, job);
    const int steps = contents ? contents->steps : 1;
    frame.source.frames.reset();
    // Of one file with many steps, no more are listed than are asked for.
    const std::vector<int> chosen = selected(steps, alone ? given.frames : std::nullopt, listing.title);
    std::string stem = fileName(path);
    if (const std::string suffix = volumeSuffix(path); suffix.size() < stem.size())
        stem.resize(stem.size() - suffix.size());
    const bool isTimed = contents && contents->times.size() == static_cast<std::size_t>(steps) &&
                         std::ranges::all_of(contents->times, [](double t) { return std::isfinite(t); });
    listing.hasTimes = listing.hasTimes && isTimed;
    for (const int step : chosen) {
        frame.source.step = step;
        if (contents && !contents->stepFiles.empty()) { // a collection: its files are read as they are
            frame.source.path = contents->stepFiles[static_cast<std::size_t>(step)];
            frame.source.step = 0;
        }
        // A headerless file is longer than a layout says: that it may be, the selection alone tells.
        if (given.raw && steps > 1) frame.source.frames = FrameRange{step, step, 1};
        frame.time = alone ? step : static_cast<double>(listing.frames.size());
        if (isTimed) frame.time = contents->times[static_cast<std::size_t>(step)];
        frame.name = alone && steps == 1 && !isTimed ? listing.title
                     : steps == 1                    ? stem
                                                     : (alone ? "" : stem + ", ") + "step " + std::to_string(step);
        listing.frames.push_back(frame);
    }
    if (contents && !contents->timeUnit.empty()) listing.timeUnit = contents->timeUnit;
}

} // namespace

std::string SeriesListing::fileOf(int frame) const {
    const auto f = static_cast<std::size_t>(frame);
    const VolumeSource& source = frames.at(f).source;
    const auto holds = [&](std::size_t other) {
        return other < frames.size() && frames[other].source.path == source.path;
    };
    const bool several = (f > 0 && holds(f - 1)) || holds(f + 1);
    return (source.isSample() ? source.path : fileName(source.path)) +
           (several ? ", step " + std::to_string(source.step) : "");
}

std::string SeriesListing::label(int frame) const {
    const SeriesFrame& f = frames.at(static_cast<std::size_t>(frame));
    if (!hasTimes) return f.name;
    return "t = " + plainText(f.time) + (timeUnit.empty() ? "" : " " + timeUnit);
}

bool isSeriesPattern(const std::string& path) {
    std::error_code ec;
    return !path.starts_with("sample:") && (numberedName(path) || isGlob(path)) && !fs::exists(path, ec);
}

std::vector<std::string> seriesFiles(const VolumeSource& source) {
    if (source.isSample()) return {};
    try {
        std::vector<std::string> paths = listFiles(source).paths;
        std::error_code ec;
        if (paths.size() > 1) std::erase_if(paths, [&](const std::string& p) { return !fs::exists(p, ec); });
        return paths;
    } catch (const Error&) {
        return {source.path};
    }
}

SeriesListing listSeries(const VolumeSource& source, const JobControl& job) {
    SeriesListing listing;
    bool alone = false; // one file, of which addFile() has chosen
    if (source.isSample()) {
        listing = listSample(source);
    } else if (source.path.empty()) {
        throw UsageError("no volume is named", "", "give a file or sample:NAME");
    } else {
        FileList list = listFiles(source);
        listing.title = std::move(list.title);
        listing.notices = std::move(list.notices);
        listing.hasTimes = true;
        alone = list.paths.size() == 1;
        for (std::size_t i = 0; i < list.paths.size(); ++i) {
            job.throwIfStopped();
            const std::size_t first = listing.frames.size();
            addFile(listing, source, list.paths[i], alone, job);
            listing.frames[first].afterGap = list.afterGap.contains(i);
        }
        if (!listing.hasTimes) {
            listing.timeUnit.clear();
            for (std::size_t f = 0; f < listing.frames.size() && !alone; ++f)
                listing.frames[f].time = static_cast<double>(f);
        }
    }
    if (source.frames && !alone) {
        std::vector<SeriesFrame> chosen;
        std::size_t passed = 0; // frames up to here
        for (const int f : selected(static_cast<int>(listing.frames.size()), source.frames, listing.title)) {
            chosen.push_back(listing.frames[static_cast<std::size_t>(f)]);
            for (; passed <= static_cast<std::size_t>(f); ++passed)
                chosen.back().afterGap = chosen.back().afterGap || listing.frames[passed].afterGap;
        }
        listing.frames = std::move(chosen);
    }
    return listing;
}

} // namespace pellucid
