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

std::string headerText(const Volume& volume, const std::string& dataFile) {
    constexpr const char* kTypes[] = {"MET_UCHAR", "MET_CHAR", "MET_USHORT", "MET_SHORT",
                                      "MET_UINT",  "MET_INT",  "MET_FLOAT",  "MET_DOUBLE"};
    const Geometry& g = volume.geometry();
    std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
    text += std::endian::native == std::endian::big ? "True" : "False";
    text += "\nCompressedData = False\nTransformMatrix =";
    for (int a = 0; a < 3; ++a) text += " " + vectorText(g.directions[a]);
    text += "\nOffset = " + vectorText(g.origin) + "\nCenterOfRotation = 0 0 0\n";
    if (g.worldAxes == WorldAxes::Patient) text += "AnatomicalOrientation = " + anatomy(g) + "\n";
    text += "ElementSpacing = " + vectorText(g.spacing) + "\nDimSize = " + std::to_string(g.dims.x) + " " +
            std::to_string(g.dims.y) + " " + std::to_string(g.dims.z) +
            "\nElementType = " + kTypes[static_cast<std::size_t>(volume.sampleType())] +
            "\nElementDataFile = " + dataFile + "\n";
    return text;
}

void write(const Volume& volume, const std::string& path, const JobControl& job) {
    const std::filesystem::path file(path);
    if (lowerCase(file.extension().string()) == ".mha")
        return writeAtomically(path, [&](OutputFile& out) {
            out.write(headerText(volume, "LOCAL"));
            writePieces(out, sampleBytes(volume), job);
        });
    std::filesystem::path data = file;
    data.replace_extension(".raw");
    // The header is on the disk before data take the place of those that an earlier one goes with.
    writeAtomically(path, [&](OutputFile& header) {
        header.write(headerText(volume, data.filename().string()));
        writeAtomically(data.string(), [&](OutputFile& out) { writePieces(out, sampleBytes(volume), job); });
    });
}

} // namespace

VolumeWriter metaImageWriter() {
    return {"MetaImage", {".mha", ".mhd"}, write, [](const Geometry&) { return std::vector<std::string>{}; }};
}

} // namespace pellucid
