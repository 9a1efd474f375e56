#include "options/volume_options.h"

#include <algorithm>
#include <limits>

#include "base/text.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kGroup = "Volume";

Vec3 parseSpacing(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option, 3, "SX,SY,SZ in world units");
    for (const double s : v)
        if (!(s > 0))
            throw UsageError("the spacing " + text + " is not positive", option, "give three numbers above 0");
    return {v[0], v[1], v[2]};
}

/// "X0:X1,Y0:Y1,Z0:Z1".
VoxelRegion parseRegion(const std::string& text, const std::string& option) {
    VoxelRegion region;
    const auto fail = [&] {
        return UsageError("'" + text + "' is no region", option,
                          "give X0:X1,Y0:Y1,Z0:Z1, the first voxel along each axis and the one after the last");
    };
    std::size_t at = 0;
    for (int a = 0; a < 3; ++a) {
        const std::size_t end = a < 2 ? text.find(',', at) : text.size();
        if (end == std::string::npos) throw fail();
        const std::string part = text.substr(at, end - at);
        const std::size_t colon = part.find(':');
        std::int64_t lo = 0, hi = 0;
        constexpr std::int64_t kMost = std::numeric_limits<int>::max();
        if (colon == std::string::npos || !parseNumber(part.substr(0, colon), lo) ||
            !parseNumber(part.substr(colon + 1), hi) || lo < 0 || hi <= lo || hi > kMost)
            throw fail();
        region.lo[a] = static_cast<int>(lo);
        region.hi[a] = static_cast<int>(hi);
        at = end + 1;
    }
    return region;
}

/// "A:B[:STEP]", both ends included; A or B may be left out.
FrameRange parseFrames(const std::string& text, const std::string& option) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() < 2 || parts.size() > 3)
        throw UsageError("'" + text + "' is no range of frames", option,
                         "give A:B or A:B:STEP, the first frame and the last, counted from 0");
    constexpr long long kMost = std::numeric_limits<int>::max();
    FrameRange range;
    if (!parts[0].empty()) range.first = static_cast<int>(parseInteger(parts[0], option, 0, kMost));
    if (!parts[1].empty()) range.last = static_cast<int>(parseInteger(parts[1], option, 0, kMost));
    if (parts.size() == 3) range.stride = static_cast<int>(parseInteger(parts[2], option, 1, kMost));
    if (range.last && *range.last < range.first)
        throw UsageError("the frames " + text + " end before they begin", option, "give the smaller number first");
    return range;
}

} // namespace

void VolumeOptions::add(CLI::App& app, SizeIs size) {
    m_command = "pellucid-cli " + app.get_name();
    app.add_option_function<std::string>(
           "VOLUME", [this](const std::string& text) { path = text; },
           "a NRRD, MetaImage, NIfTI, VTK image (VTI, PVD) or (with --raw) headerless file, or sample:NAME; a series: "
           "a "
           "file with time steps, a pattern (f%03d.mhd), a quoted glob ('f*.mhd') or a folder; not needed with "
           "--session")
        ->type_name("");
    addValue(
        app, "--frames", "A:B[:STEP]",
        [this](const std::string& text, const std::string& option) { frames = parseFrames(text, option); },
        "only these frames of a series, from 0, B included; A or B may be left out", kGroup);
    addValue(
        app, "--frame", "N",
        [this](const std::string& text, const std::string& option) {
            frame = static_cast<int>(parseInteger(text, option, 0, std::numeric_limits<int>::max()));
        },
        "the frame to work on, from 0, of those that --frames selects (default: the session's, else 0)", kGroup);
    addValue(
        app, "--array", "NAME", [this](const std::string& text, const std::string&) { array = text; },
        "array of a file with several (default: its active scalars, else the first)", kGroup);
    addValue(
        app, "--cache", "MIB",
        [this](const std::string& text, const std::string& option) {
            cacheBytes =
                std::max<std::size_t>(1, static_cast<std::size_t>(parseRealAbove(text, option, 0, 1e9) * 1048576));
        },
        "memory for frames of a series, in MiB (default: a quarter of what is free, at most 2048)", kGroup);
    addValue(
        app, "--raw", "NX,NY,NZ,TYPE[,ENDIAN]",
        [this](const std::string& text, const std::string& option) {
            raw = atOption(option + " " + text, [&] { return parseRawLayout(text); });
        },
        "the file is headerless; TYPE is u8 i8 u16 i16 u32 i32 f32 f64, ENDIAN little (default) or big", kGroup);
    addValue(
        app, "--spacing", "SX,SY,SZ",
        [this](const std::string& text, const std::string& option) { spacing = parseSpacing(text, option); },
        "voxel distances of --raw data in world units (default 1,1,1)", kGroup);
    addValue(
        app, "--skip", "BYTES",
        [this](const std::string& text, const std::string& option) {
            skipBytes =
                static_cast<std::uint64_t>(parseInteger(text, option, 0, std::numeric_limits<long long>::max()));
        },
        "bytes before the --raw data", kGroup);
    addValue(
        app, "--missing", "VALUE",
        [this](const std::string& text, const std::string& option) { missing = parseReal(text, option); },
        "voxels of this value are invalid: never drawn, never counted", kGroup);
    addValue(
        app, "--range", "LO,HI",
        [this](const std::string& text, const std::string& option) { range = parseRange(text, option); },
        "the values of intensity 0 and 1 (default: those of the TF file, else of the session, else smallest and "
        "largest value)",
        kGroup);
    addValue(
        app, "--component", "N",
        [this](const std::string& text, const std::string& option) {
            component = static_cast<int>(parseInteger(text, option, 0, 1'000'000));
        },
        "component of a multi-component file, from 0", kGroup);
    addValue(
        app, size == SizeIs::Sample ? "--size,--sample-size" : "--sample-size", "N",
        [this](const std::string& text, const std::string& option) { takeSampleSize(text, option); },
        "voxels along the longest axis of a sample", kGroup);
    addValue(
        app, "--seed", "N",
        [this](const std::string& text, const std::string& option) {
            seed = static_cast<std::uint32_t>(parseInteger(text, option, 0, std::numeric_limits<std::uint32_t>::max()));
        },
        "seed of a sample's noise (default 1)", kGroup);
    addValue(
        app, "--downsample", "N",
        [this](const std::string& text, const std::string& option) {
            downsample = static_cast<int>(parseInteger(text, option, 1, 65536));
        },
        "each voxel is the mean of N along each axis (default: 1, or the least that memory has room for)", kGroup);
    if (size != SizeIs::Both)
        addValue(
            app, "--region", "X0:X1,Y0:Y1,Z0:Z1",
            [this](const std::string& text, const std::string& option) { takeRegion(text, option); },
            "only these voxels of the data, from the first to the one before the second", kGroup);
}

void VolumeOptions::takeSampleSize(const std::string& text, const std::string& option) {
    sampleSize = static_cast<int>(parseInteger(text, option, 8, 65536));
}

void VolumeOptions::takeRegion(const std::string& text, const std::string& option) {
    region = parseRegion(text, option);
}

bool VolumeOptions::anyDetail() const {
    return frames || frame || array || raw || spacing || skipBytes || missing || range || component || sampleSize ||
           seed || downsample || region;
}

void VolumeOptions::applyTo(SceneInputs& inputs) const {
    Session& session = inputs.session;
    if (path && path->empty())
        throw UsageError("the name of the volume is empty", "VOLUME", "name a file or sample:NAME");
    if (!path && session.isEmpty()) throw UsageError("VOLUME is required", m_command, "see " + m_command + " --help");

    VolumeSource source;
    if (path)
        source.path = *path;
    else
        source = session.variable().source;
    if (raw) source.raw = raw;
    if (spacing && !source.raw) throw UsageError("--spacing is for headerless data", "--spacing", "give --raw as well");
    if (skipBytes && !source.raw) throw UsageError("--skip is for headerless data", "--skip", "give --raw as well");
    if (source.isSample() && source.raw)
        throw UsageError("a built-in sample has no headerless file", "--raw", "leave it out");
    if (sampleSize && !source.isSample())
        throw UsageError("only built-in samples come in any size", "--sample-size", "leave it out or use sample:NAME");
    if (spacing) source.raw->spacing = *spacing;
    if (skipBytes) source.raw->skipBytes = *skipBytes;
    if (missing) source.missing = missing;
    if (component) source.component = *component;
    if (frames) source.frames = frames;
    if (array) source.array = *array;
    if (cacheBytes) TimeSeries::setDefaultBudget(*cacheBytes);
    if (sampleSize) source.sampleSize = *sampleSize;
    if (seed) source.seed = *seed;
    if (downsample) source.downsample = *downsample;
    if (region) source.region = region;

    session.variables.edit([&](std::vector<Variable>& all) {
        if (all.empty()) all.emplace_back();
        all.front().source = source;
    });
    inputs.range = range;
    inputs.frame = frame;
}

} // namespace pellucid::cli
