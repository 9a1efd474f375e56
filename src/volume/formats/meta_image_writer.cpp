// Writes MetaImage: .mha, or .mhd with the samples beside it as .raw.
#include <bit>
#include <filesystem>

#include "base/round_numbers.h"
#include "volume/formats/writer.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

std::string vectorText(const Vec3& v) { return exactText(v.x) + " " + exactText(v.y) + " " + exactText(v.z); }

/// Where each axis comes from, as ITK has it: "RAI" where all run to the left, the back and the head.
std::string anatomy(const Geometry& geometry) {
    std::string letters;
    for (int a = 0; a < 3; ++a) letters += axisText(geometry, a).front();
    return letters;
}

std::string headerText(const FramesToWrite& frames, const std::string& dataFile) {
    constexpr const char* kTypes[] = {"MET_UCHAR", "MET_CHAR", "MET_USHORT", "MET_SHORT",
                                      "MET_UINT",  "MET_INT",  "MET_FLOAT",  "MET_DOUBLE"};
    const Geometry& g = frames.geometry;
    const bool several = frames.count > 1;
    const StepTimes times = frames.times.value_or(StepTimes{});
    const auto withTime = [&](const std::string& ofSpace, const std::string& ofTime) {
        return ofSpace + (several ? " " + ofTime : "") + "\n";
    };
    std::string text = "ObjectType = Image\nNDims = " + std::string(several ? "4" : "3") +
                       "\nBinaryData = True\nBinaryDataByteOrderMSB = ";
    text += std::endian::native == std::endian::big ? "True" : "False";
    text += "\nCompressedData = False\nTransformMatrix =";
    for (int a = 0; a < 3; ++a) text += " " + vectorText(g.directions[a]) + (several ? " 0" : "");
    text += withTime("", "0 0 0 1") + "Offset = " + withTime(vectorText(g.origin), exactText(times.first)) +
            "CenterOfRotation = " + withTime("0 0 0", "0");
    if (g.worldAxes == WorldAxes::Patient) text += "AnatomicalOrientation = " + anatomy(g) + "\n";
    if (g.lengthUnit != LengthUnit::Unknown) text += "DistanceUnits = " + std::string(plainSign(g.lengthUnit)) + "\n";
    text += "ElementSpacing = " + withTime(vectorText(g.spacing), exactText(times.width)) +
            "DimSize = " + std::to_string(g.dims.x) + " " + std::to_string(g.dims.y) + " " +
            withTime(std::to_string(g.dims.z), std::to_string(frames.count)) +
            "ElementType = " + kTypes[static_cast<std::size_t>(frames.type)] + "\nElementDataFile = " + dataFile + "\n";
    return text;
}

/// The data of a header of its own.
std::vector<std::string> filesBeside(const std::string& path, int) {
    std::filesystem::path data = path;
    if (lowerCase(data.extension().string()) == ".mha") return {};
    return {data.replace_extension(".raw").string()};
}

void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    const std::filesystem::path file(path);
    if (lowerCase(file.extension().string()) == ".mha")
        return writeAtomically(path, [&](OutputFile& out) {
            out.write(headerText(frames, "LOCAL"));
            writeFrames(out, frames, job);
        });
    const std::filesystem::path data = filesBeside(path, frames.count).front();
    // The header is on the disk before data take the place of those that an earlier one goes with.
    writeAtomically(path, [&](OutputFile& header) {
        header.write(headerText(frames, data.filename().string()));
        writeAtomically(data.string(), [&](OutputFile& out) { writeFrames(out, frames, job); });
    });
}

std::vector<std::string> losses(const FramesToWrite& frames, const std::string&) {
    if (!frames.times || frames.times->unit.empty()) return {};
    return {"MetaImage does not say in what unit times are"};
}

} // namespace

VolumeWriter metaImageWriter() { return {"MetaImage", {".mha", ".mhd"}, write, losses, filesBeside}; }

} // namespace pellucid
