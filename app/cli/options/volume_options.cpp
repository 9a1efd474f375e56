#include "options/volume_options.h"

#include <algorithm>
#include <limits>

#include "base/text.h"
#include "parse.h"
#include "session/variable_edits.h"
#include "volume/file_names.h"
#include "volume/outside_files.h"

namespace pellucid::cli {

namespace {

constexpr const char* kVolumeGroup = "Volume";

/// "A:B[:STEP]", both ends included; A or B may be left out.
FrameRange parseFrames(const std::string& text, const std::string& option) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() < 2 || parts.size() > 3)
        throw UsageError("'" + text + "' is not a range of frames", option,
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
    m_command = app.get_name();
    app.add_option_function<std::string>(
           "VOLUME", [this](const std::string& text) { path = pathOfUrl(text); },
           "a NRRD, MetaImage, NIfTI, VTK (VTI, PVTI, PVD, legacy), DICOM, TIFF, HDF5, NetCDF, PVM, Voreen, Inviwo or "
           "(with --raw) headerless file, a scene of 3D Slicer, a folder of DICOM files, pictures or OME-Zarr, a "
           "file: address, or sample:NAME; a series: "
           "a file with time steps, a pattern (f%03d.mhd), a quoted glob ('f*.mhd') or a folder; not needed with "
           "--session")
        ->type_name("");
    app.add_flag_callback(
           "--allow-outside", [] { allowOutsideFiles(); },
           "headers may name data files outside their own folder: for files that you trust")
        ->group(kVolumeGroup);
    addValue(app, "--frames", "A:B[:STEP]", frames, parseFrames,
             "only these frames of a series, from 0, B included; A or B may be left out", kVolumeGroup);
    addValue(app, "--frame", "N", frame, wholeFrom(0, std::numeric_limits<int>::max()),
             "the frame to work on, from 0, of those that --frames selects (default: the session's, else 0)",
             kVolumeGroup);
    addValue(app, "--array", "NAME", array, anyText,
             "array of a file with several (default: its active scalars, else the largest or the first)", kVolumeGroup);
    addValue(app, "--series", "NAME", array, anyText,
             "series of a folder of DICOM files: its name, number or UID (default: the one with the most slices); "
             "or image of an OME-TIFF: its name, or its number from 1 (default: the first one)",
             kVolumeGroup);
    addValue(
        app, "--cache", "MIB",
        [this](const std::string& text, const std::string& option) {
            cacheBytes =
                std::max<std::size_t>(1, static_cast<std::size_t>(parseRealAbove(text, option, 0, 1e9) * 1048576));
        },
        "memory for frames of a series, in MiB (default: a quarter of what is free, at most 2048)", kVolumeGroup);
    addValue(
        app, "--raw", "NX,NY,NZ,TYPE[,ENDIAN]",
        [this](const std::string& text, const std::string& option) {
            raw = atOption(option + " " + text, [&] { return parseRawLayout(text); });
        },
        "the file is headerless; TYPE is u8 i8 u16 i16 u32 i32 f32 f64, ENDIAN little (default) or big", kVolumeGroup);
    addValue(
        app, "--spacing", "SX,SY,SZ[,UNIT]",
        [this](const std::string& text, const std::string& option) {
            spacing = atOption(option + " " + text, [&] { return parseGridSpacing(text); });
        },
        "distances between voxels, whatever the file says, in its unit of length or in UNIT, such as nm, um or mm "
        "(default: the file's; 1,1,1 for --raw data)",
        kVolumeGroup);
    addValue(app, "--skip", "BYTES", skipBytes, wholeFrom<std::uint64_t>(0, std::numeric_limits<long long>::max()),
             "bytes before the --raw data", kVolumeGroup);
    addValue(app, "--missing", "VALUE", missing, parseReal,
             "voxels of this value are invalid: never drawn, never counted", kVolumeGroup);
    addValue(app, "--range", "LO,HI", range, parseRange,
             "the values of intensity 0 and 1 (default: those of the TF file, else of the session, else smallest and "
             "largest value)",
             kVolumeGroup);
    addValue(app, "--component", "N", component, wholeFrom(0, 1'000'000), "component of a multi-component file, from 0",
             kVolumeGroup);
    addValue(
        app, "--axes", "IJK",
        [this](const std::string& text, const std::string& option) {
            axes = atOption(option + " " + text, [&] { return parseGridAxes(text); });
        },
        "where the axes i, j, k of the data point, whatever the file says: LPS (letters of L R A P S I), or +x-y+z",
        kVolumeGroup);
    addValue(app, size == SizeIs::Sample ? "--size,--sample-size" : "--sample-size", "N", sampleSize, parseSampleSize,
             "voxels along the longest axis of a sample", kVolumeGroup);
    addValue(app, "--seed", "N", seed, wholeFrom<std::uint32_t>(0, std::numeric_limits<std::uint32_t>::max()),
             "seed of a sample's noise (default 1)", kVolumeGroup);
    addValue(app, "--downsample", "N", downsample, wholeFrom(1, 65536),
             "each voxel is the mean of N along each axis (default: 1, or the least that memory has room for)",
             kVolumeGroup);
    if (size != SizeIs::Both && size != SizeIs::ImageWithRegion)
        addValue(app, "--region", "X0:X1,Y0:Y1,Z0:Z1", region, parseVoxelRegion,
                 "only these voxels of the data, from the first to the one before the second", kVolumeGroup);
}

void VolumeOptions::addSizeOfBoth(CLI::App& app, std::function<void(const ImageSize&)> setImage,
                                  const std::string& help) {
    addValue(
        app, "--size", "WxH|N",
        [this, setImage = std::move(setImage)](const std::string& text, const std::string& option) {
            if (text.find('x') != std::string::npos)
                setImage(parseImageSize(text, option));
            else
                sampleSize = parseSampleSize(text, option);
        },
        help);
}

void VolumeOptions::addRegionOfBoth(CLI::App& app, Take takeImage, const std::string& form, const std::string& help) {
    addValue(
        app, "--region", form + "|X0:X1,Y0:Y1,Z0:Z1",
        [this, takeImage = std::move(takeImage)](const std::string& text, const std::string& option) {
            if (text.find(':') == std::string::npos) return takeImage(text, option);
            region = parseVoxelRegion(text, option);
        },
        help);
}

VoxelRegion parseVoxelRegion(const std::string& text, const std::string& option) {
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    VoxelRegion region;
    const std::vector<std::string> axes = split(text, ',');
    for (int a = 0; a < 3; ++a) {
        const std::vector<std::string> ends = split(axes.size() == 3 ? axes[static_cast<std::size_t>(a)] : "", ':');
        std::int64_t lo = 0, hi = 0;
        if (ends.size() != 2 || !parseNumber(ends[0], lo) || !parseNumber(ends[1], hi) || lo < 0 || hi <= lo ||
            hi > kMost)
            throw UsageError("'" + text + "' is not a region", option,
                             "give X0:X1,Y0:Y1,Z0:Z1, the first voxel along each axis and the one after the last");
        region.lo[a] = static_cast<int>(lo);
        region.hi[a] = static_cast<int>(hi);
    }
    return region;
}

bool VolumeOptions::anyDetail() const {
    return frames || frame || array || raw || spacing || skipBytes || missing || range || component || axes ||
           sampleSize || seed || downsample || region;
}

void VolumeOptions::applyTo(SceneInputs& inputs) const {
    Session& session = inputs.session;
    if (path && path->empty())
        throw UsageError("the name of the volume is empty", "VOLUME", "name a file or sample:NAME");
    if (!path && session.isEmpty()) throw isRequired("VOLUME", m_command);

    VolumeSource source;
    if (path)
        source.path = *path;
    else
        source = dataVariable(session).source;
    if (raw) source.raw = raw;
    const bool isSample = source.isSample();
    refuse({{skipBytes && !source.raw, "--skip is for headerless data", "--skip", "give --raw as well"},
            {isSample && source.raw, "a built-in sample has no headerless file", "--raw", "leave it out"},
            {sampleSize && !isSample, "only built-in samples come in any size", "--sample-size",
             "leave it out or use sample:NAME"}});
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

    if (session.isEmpty()) session.variables.edit([](std::vector<Variable>& all) { all.emplace_back(); });
    setDataSource(session, source);
    if (axes) setDataAxes(session, axes);
    if (spacing) setDataSpacing(session, spacing);
    inputs.range = range;
    inputs.frame = frame;
}

} // namespace pellucid::cli
