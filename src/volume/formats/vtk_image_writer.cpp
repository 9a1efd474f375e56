// Writes VTK image data (.vti): samples of points, appended as they are.
#include <bit>

#include "base/round_numbers.h"
#include "volume/formats/writer.h"

namespace pellucid {

namespace {

std::string headerText(const Volume& volume) {
    constexpr const char* kTypes[] = {"UInt8", "Int8", "UInt16", "Int16", "UInt32", "Int32", "Float32", "Float64"};
    const Geometry& g = volume.geometry();
    std::string extent, direction;
    for (int a = 0; a < 3; ++a) extent += (a > 0 ? " 0 " : "0 ") + std::to_string(g.dims[a] - 1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            direction += (direction.empty() ? "" : " ") + exactText(g.directions[column][row]);
    const auto vector = [](const Vec3& v) { return exactText(v.x) + " " + exactText(v.y) + " " + exactText(v.z); };
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"" +
           std::string(std::endian::native == std::endian::big ? "BigEndian" : "LittleEndian") +
           "\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + vector(g.origin) +
           "\" Spacing=\"" + vector(g.spacing) + "\" Direction=\"" + direction + "\">\n<Piece Extent=\"" + extent +
           "\">\n<PointData Scalars=\"values\">\n<DataArray type=\"" +
           kTypes[static_cast<std::size_t>(volume.sampleType())] +
           "\" Name=\"values\" format=\"appended\" offset=\"0\"/>\n</PointData>\n</Piece>\n</ImageData>\n"
           "<AppendedData encoding=\"raw\">\n_";
}

void write(const Volume& volume, const std::string& path, const JobControl& job) {
    writeAtomically(path, [&](OutputFile& out) {
        const auto bytes = sampleBytes(volume);
        const std::uint64_t count = bytes.size();
        out.write(headerText(volume));
        out.write(&count, sizeof count);
        writePieces(out, bytes, job);
        out.write("\n</AppendedData>\n</VTKFile>\n");
    });
}

std::vector<std::string> losses(const Geometry& g) {
    if (g.worldAxes != WorldAxes::Patient) return {};
    return {"VTK image data does not say that places are a patient's"};
}

} // namespace

VolumeWriter vtiWriter() { return {"VTK image data", {".vti"}, write, losses}; }

} // namespace pellucid
