#include "volume/series.h"

#include <cstdio>
#include <filesystem>

#include "volume/procedural.h"

namespace pellucid {

namespace {

std::string numberText(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

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

/// Of all frames those that are asked for.
void select(SeriesListing& listing, const FrameRange& range) {
    const int count = static_cast<int>(listing.frames.size());
    const int last = range.last.value_or(count - 1);
    if (range.first < 0 || range.first >= count || last < range.first || last >= count || range.stride < 1)
        throw UsageError("the series has no such frames", listing.title,
                         "give frames from 0 to " + std::to_string(count - 1));
    std::vector<SeriesFrame> chosen;
    for (int f = range.first; f <= last; f += range.stride)
        chosen.push_back(std::move(listing.frames[static_cast<std::size_t>(f)]));
    listing.frames = std::move(chosen);
}

} // namespace

std::string SeriesListing::label(int frame) const {
    const SeriesFrame& f = frames.at(static_cast<std::size_t>(frame));
    if (!hasTimes) return f.name;
    return "t = " + numberText(f.time) + (timeUnit.empty() ? "" : " " + timeUnit);
}

bool isSeriesPattern(const std::string& path) {
    return !path.starts_with("sample:") && path.find_first_of("%*?[") != std::string::npos &&
           !std::filesystem::exists(path);
}

SeriesListing listSeries(const VolumeSource& source, const JobControl&) {
    SeriesListing listing;
    if (source.isSample()) {
        listing = listSample(source);
    } else {
        listing.title = std::filesystem::path(source.path).filename().string();
        listing.frames.push_back({source, 0, listing.title});
    }
    if (source.frames) select(listing, *source.frames);
    return listing;
}

} // namespace pellucid
