// Writes VTK image data (.vti): samples of points, appended as they are; several frames as a file each, and a
// collection
// (.pvd) that names them.
#include <bit>
#include <filesystem>

#include <unistd.h>

#include "base/error.h"
#include "base/file_watch.h"
#include "base/round_numbers.h"
#include "base/write_errors.h"
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

void writeImage(const Volume& volume, const std::string& path, const JobControl& job) {
    writeAtomically(path, [&](OutputFile& out) {
        const auto bytes = sampleBytes(volume);
        const std::uint64_t count = bytes.size();
        out.write(headerText(volume));
        out.write(&count, sizeof count);
        writePieces(out, bytes, job);
        out.write("\n</AppendedData>\n</VTKFile>\n");
    });
}

std::string inXml(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

bool isCollection(const std::string& path) { return lowerCase(path).ends_with(".pvd"); }

/// "name_007.vti" beside "name.pvd", with as many digits as the last one needs.
std::filesystem::path fileOf(int frame, int frames, const std::filesystem::path& collection) {
    std::string number = std::to_string(frame);
    const std::size_t digits = std::to_string(frames - 1).size();
    number.insert(0, digits - number.size(), '0');
    return collection.parent_path() / (collection.stem().string() + "_" + number + ".vti");
}

/// Each frame under a name of its own until all are there: what had their names stays as it was if one fails.
void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    if (!isCollection(path)) return writeImage(frames.frame(0, job), path, job);
    struct File {
        std::filesystem::path made, name;
    };
    std::vector<File> files;
    std::string entries;
    for (int n = 0; n < frames.count; ++n) {
        const std::filesystem::path name = fileOf(n, frames.count, path);
        requireWritable(name.string());
        tellOfWriting(name.string()); // who reads one of them says so before any is replaced
        const std::string made = ".pellucid-" + std::to_string(getpid()) + "-" + std::to_string(n) + ".vti.part";
        files.push_back({name.parent_path() / made, name});
        const double time = frames.frameTimes.empty() ? n : frames.frameTimes[static_cast<std::size_t>(n)];
        entries += "<DataSet timestep=\"" + exactText(time) + "\" part=\"0\" file=\"" +
                   inXml(name.filename().string()) + "\"/>\n";
    }
    try {
        writeAtomically(path, [&](OutputFile& collection) {
            collection.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" +
                             entries + "</Collection>\n</VTKFile>\n");
            for (int n = 0; n < frames.count; ++n) {
                const JobControl part = frames.part(n, job);
                writeImage(frames.frame(n, part), files[static_cast<std::size_t>(n)].made.string(), part);
            }
            for (const File& file : files) {
                std::error_code ec;
                std::filesystem::rename(file.made, file.name, ec);
                if (ec) throw cannotWrite(file.name.string(), ec.value());
            }
        });
    } catch (...) {
        std::error_code ec;
        for (const File& file : files) std::filesystem::remove(file.made, ec);
        throw;
    }
}

std::vector<std::string> filesBeside(const std::string& path, int frames) {
    std::vector<std::string> files;
    for (int n = 0; n < frames && isCollection(path); ++n) files.push_back(fileOf(n, frames, path).string());
    return files;
}

std::vector<std::string> losses(const FramesToWrite& frames, const std::string& path) {
    if (frames.count > 1 && !isCollection(path))
        throw UsageError("a .vti file has one frame", path,
                         "give a name that ends in .pvd: it becomes a collection of .vti files");
    std::vector<std::string> lost;
    if (frames.geometry.worldAxes == WorldAxes::Patient)
        lost.emplace_back("VTK image data does not say that places are a patient's");
    if (frames.geometry.lengthUnit != LengthUnit::Unknown)
        lost.emplace_back("VTK image data cannot store the unit of length");
    if (frames.times && !frames.times->unit.empty())
        lost.emplace_back("a collection of VTK does not say in what unit times are");
    return lost;
}

} // namespace

VolumeWriter vtiWriter() { return {"VTK image data", {".vti", ".pvd"}, write, losses, filesBeside}; }

} // namespace pellucid
