// VTK's legacy files (.vtk) of regular grids: a text header, values written out or binary.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "volume/formats/byte_source.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/vtk_header.h"
#include "volume/formats/vtk_legacy_header.h"

namespace pellucid {

namespace {

/// The arrays as they are offered: those of points, then those of cells.
struct Offered {
    std::vector<LegacyArray> arrays;
    std::vector<std::string> names;
};

Offered offeredBy(const LegacyVtk& file) {
    Offered offered{file.arrays, {}};
    std::ranges::stable_sort(offered.arrays, {}, &LegacyArray::ofCells);
    std::vector<std::string> ofPoints, ofCells;
    for (const LegacyArray& array : offered.arrays) (array.ofCells ? ofCells : ofPoints).push_back(array.name);
    offered.names = offeredNames(ofPoints, ofCells);
    return offered;
}

/// The name of the first scalars, which other programs show, too; empty where there are none.
std::string activeOf(const Offered& offered) {
    const auto found = std::ranges::find(offered.arrays, true, &LegacyArray::isScalars);
    return found == offered.arrays.end() ? std::string()
                                         : offered.names[static_cast<std::size_t>(found - offered.arrays.begin())];
}

/// Axes, and where the first value lies: that of a cell in its middle.
void placeGrid(FileLayout& layout, const LegacyVtk& file, const LegacyArray& array) {
    layout.spacing = file.spacing;
    layout.origin = file.origin;
    if (array.components != 1) layout.axes.push_back({array.components, true});
    for (std::size_t a = 0; a < 3; ++a) {
        layout.axes.push_back({array.ofCells ? cellsAlong(file.dims[a]) : file.dims[a]});
        const int axis = static_cast<int>(a);
        if (array.ofCells && file.dims[a] > 1) layout.origin[axis] += file.spacing[axis] / 2;
    }
}

/// The bytes that numbers from 0 to 1 stand for, as VTK makes them: to the nearest.
class BytesOfFractions final : public ByteSource {
public:
    BytesOfFractions(const std::string& path, std::uint64_t start, const JobControl& job) : m_words(path, start, job) {}
    std::size_t read(char* to, std::size_t count) override {
        std::string word;
        std::size_t done = 0;
        for (; done < count && m_words.next(word); ++done) {
            const double value = numberIn(word);
            if (std::isnan(value)) break;
            to[done] = static_cast<char>(static_cast<unsigned char>(std::clamp(255 * value + 0.5, 0.0, 255.0)));
        }
        return done;
    }

private:
    TextWords m_words;
};

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const LegacyVtk file = readLegacyVtk(source.path, job);
    const Offered offered = offeredBy(file);
    if (offered.arrays.empty()) failInVtk(source.path, "the file has no values for points, nor for cells");
    const std::size_t chosen = chosenOf(offered.names, source.array, activeOf(offered), source.path);
    const LegacyArray& array = offered.arrays[chosen];
    if (!array.type)
        failInVtk(source.path,
                  "the type " + inQuotes(array.typeName) + " of " + inQuotes(array.name) + " is not supported",
                  "use one of char, unsigned_char, … float, double");
    FileLayout layout;
    layout.dataPath = source.path;
    layout.array = offered.names[chosen];
    layout.type = *array.type;
    layout.bigEndian = true;
    layout.encoding = file.isBinary ? Encoding::Raw : Encoding::Text;
    layout.start = array.start;
    if (array.areFractions) {
        layout.encoding = Encoding::Raw;
        layout.open = [path = source.path, start = array.start](const JobControl& control) {
            return std::make_unique<BytesOfFractions>(path, start, control);
        };
    }
    placeGrid(layout, file, array);
    const std::uint64_t values = valuesIn(layout, source.path);
    if (offered.arrays.size() > 1 && source.array.empty())
        layout.notices.push_back("array " + inQuotes(layout.array) + " of " + std::to_string(offered.arrays.size()) +
                                 " is shown");
    if (array.ofCells) layout.notices.emplace_back(kCellsNotice);
    if (file.time) layout.times = StepTimes{*file.time, 1, ""};
    if (!step)
        layout.arrays = offered.names;
    else if (!file.isBinary) // of binary values it is known already that all are there
        requireNumbers(source.path, array.start, values, job);
    return layout;
}

} // namespace

VolumeFormat vtkLegacyFormat() {
    VolumeFormat format{"VTK legacy file",    {".vtk"}, describeLayout<layoutOf>,
                        readLayout<layoutOf>, nullptr,  kVtkLegacyContent};
    format.holdsSeveral = true;
    return format;
}

} // namespace pellucid
