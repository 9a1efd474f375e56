// Files that pictures of the guide show, made of the sample `knee` and of numbers (scripts/guide-pictures.sh):
//
//     guide_data FOLDER
//
// writes scan.raw (no header), study/ (three DICOM series) and tmap.nrrd (values of t over the head ch2.nii.gz).
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/dicom_writer.h"
#include "volume/loader.h"

using namespace pellucid;

namespace {

constexpr int kFullIntensity = 4000; // of 12 bits

Volume kneeOf(int size) {
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = size;
    return loadVolume(source);
}

void writeBytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream out(path, std::ios::binary);
    out << bytes;
    if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string voxelWords(const Volume& volume) {
    std::vector<int> values;
    for (std::size_t i = 0; i < volume.size(); ++i)
        values.push_back(static_cast<int>(kFullIntensity * volume.intensity(i)));
    return test::words(values);
}

/// Slices of `volume` across one axis, as DICOM of 12 bits.
void writeSlices(const std::filesystem::path& folder, const Volume& volume, int across, const char* description) {
    const Int3 dims = volume.dims();
    const int i = across == 0 ? 1 : 0, j = across == 2 ? 1 : 2;
    const char* const axes[] = {"0\\1\\0\\0\\0\\-1", "1\\0\\0\\0\\0\\-1", "1\\0\\0\\0\\1\\0"};
    for (int n = 0; n < dims[across]; ++n) {
        const std::string place = std::to_string(n);
        test::DicomSlice slice;
        slice.columns = dims[i];
        slice.rows = dims[j];
        slice.number = n + 1;
        slice.series = "1.2." + std::to_string(across);
        slice.seriesNumber = std::to_string(3 - across);
        slice.description = description;
        slice.modality = "MR";
        slice.axes = axes[across];
        slice.position = across == 0 ? place + "\\0\\0" : across == 1 ? "0\\" + place + "\\0" : "0\\0\\" + place;
        std::vector<int> values;
        for (int row = 0; row < dims[j]; ++row)
            for (int column = 0; column < dims[i]; ++column) {
                Int3 voxel(0);
                voxel[across] = n;
                voxel[i] = column;
                voxel[j] = across == 2 ? row : dims[j] - 1 - row;
                const auto at = static_cast<std::size_t>(voxel.x + dims.x * (voxel.y + dims.y * voxel.z));
                values.push_back(static_cast<int>(kFullIntensity * volume.intensity(at)));
            }
        slice.pixels = test::words(values);
        writeBytes(folder / ("IM" + std::to_string(across) + "_" + place), test::dicomFile(slice));
    }
}

/// Noise, and what stands out of it.
void writeTMap(const std::filesystem::path& path) {
    struct Peak {
        Vec3 place; ///< of the world, mm to the left, the back and the head
        double t, width;
    };
    const Peak peaks[] = {{{44, -14, 28}, 9, 11}, {{-46, -10, 30}, 7, 10}, {{2, 84, 6}, 8, 14}, {{0, -50, 22}, -7, 12}};
    const Geometry geometry{{40, 48, 40}, Vec3(4), Vec3(-78, -76, -60), Mat3(1), WorldAxes::Patient};
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.7);
    Grid<float> values(geometry.dims);
    std::size_t i = 0;
    for (int z = 0; z < geometry.dims.z; ++z)
        for (int y = 0; y < geometry.dims.y; ++y)
            for (int x = 0; x < geometry.dims.x; ++x) {
                double t = noise(random);
                for (const Peak& peak : peaks) {
                    const Vec3 away = (geometry.worldFromVoxel(Vec3(x, y, z)) - peak.place) / peak.width;
                    t += peak.t * std::exp(-(away.x * away.x + away.y * away.y + away.z * away.z));
                }
                values[i++] = static_cast<float>(t);
            }
    writeNrrd(geometry, values, path.string());
}

void run(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "study");
    writeBytes(folder / "scan.raw", voxelWords(kneeOf(128)));
    const Volume knee = kneeOf(96);
    const char* const names[] = {"sagittal", "coronal", "axial"};
    for (int axis = 0; axis < 3; ++axis) writeSlices(folder / "study", knee, axis, names[axis]);
    writeTMap(folder / "tmap.nrrd");
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("guide_data FOLDER\n", stderr);
        return 2;
    }
    try {
        run(argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "guide_data: %s\n", error.what());
        return 1;
    }
}
