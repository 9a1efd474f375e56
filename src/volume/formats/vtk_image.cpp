// VTK's XML files of image data: in one file (.vti), or each piece in a file of its own (.pvti).
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/vtk_bytes.h"
#include "volume/formats/vtk_header.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

/// As many finite numbers as `otherwise` has, which are taken where the text is empty.
std::vector<double> numbersIn(const std::string& text, const std::string& what, const std::vector<double>& otherwise,
                              const std::string& path) {
    const std::vector<double> numbers = finiteNumbers(text, what, path);
    if (numbers.empty()) return otherwise;
    if (numbers.size() != otherwise.size())
        failInVtk(path, what + " has " + std::to_string(numbers.size()) + " numbers, not " +
                            std::to_string(otherwise.size()));
    return numbers;
}

ValueType typeOf(const VtkArray& array, const std::string& path) {
    static const std::map<std::string, ValueType> kTypes{
        {"Int8", ValueType::I8},     {"UInt8", ValueType::U8},   {"Int16", ValueType::I16}, {"UInt16", ValueType::U16},
        {"Int32", ValueType::I32},   {"UInt32", ValueType::U32}, {"Int64", ValueType::I64}, {"UInt64", ValueType::U64},
        {"Float32", ValueType::F32}, {"Float64", ValueType::F64}};
    const auto it = kTypes.find(array.type);
    if (it != kTypes.end()) return it->second;
    failInVtk(path, "the type " + inQuotes(array.type) + " is not supported",
              "use one of Int8, UInt8, … Float32, Float64");
}

/// Where the data of an array of `file` are, which has to have so many values.
StoredValues dataOf(const VtkImage& file, const VtkArray& array, std::uint64_t values, const JobControl& job) {
    const std::string& path = file.path;
    StoredValues stored;
    stored.dataPath = path;
    stored.type = typeOf(array, path);
    stored.bigEndian = file.bigEndian;
    const std::uint64_t bytesPer = bytesPerValue(stored.type);
    if (array.format == "ascii") {
        stored.encoding = Encoding::Text;
        stored.start = array.contentStart;
        const std::uint64_t bytes = readableFileBytes(path);
        requireStored(path, stored.encoding, values, bytesPer, bytes - std::min(bytes, stored.start), kCheckArray);
        requireNumbers(path, stored.start, values, job);
        return stored;
    }
    VtkData data{path, array.contentStart, true, file.packing, file.bigEndian, file.headerBytes, values * bytesPer};
    if (array.format == "appended") {
        if (!file.appendedStart) failInVtk(path, "there are no appended data in the file", "copy it again");
        if (array.offset > (std::uint64_t{1} << 62)) failInVtk(path, "the offset of an array lies beyond any file");
        data.start = *file.appendedStart + array.offset;
        data.base64 = file.appendedBase64;
    } else if (array.format != "binary") {
        failInVtk(path, "the format " + inQuotes(array.format) + " of the array is not known");
    }
    stored.start = requireVtkBytes(data, job);
    if (data.base64 || data.packing != VtkPacking::None)
        stored.open = [data](const JobControl& control) { return openVtkData(data, control); };
    return stored;
}

/// The array of piece `n` of `file` that is part of `whole`, an array of the image.
const VtkArray& arrayOfPiece(const VtkImage& file, std::size_t n, const VtkArray& whole) {
    const std::string piece = file.pieces.size() == 1
                                  ? "the piece"
                                  : "piece " + std::to_string(n + 1) + " of " + std::to_string(file.pieces.size());
    const std::vector<VtkArray>& arrays = file.pieces[n].arrays.all;
    const auto found = std::ranges::find_if(
        arrays, [&](const VtkArray& array) { return array.name == whole.name && array.ofCells == whole.ofCells; });
    if (found == arrays.end())
        failInVtk(file.path, piece + " has no array " + inQuotes(whole.name), "write it with the arrays of the others");
    if (found->type != whole.type)
        failInVtk(file.path,
                  "the array " + inQuotes(whole.name) + " of " + piece + " is " + inQuotes(found->type) +
                      ", that of the image " + inQuotes(whole.type),
                  "write all pieces with one type");
    if (found->components != whole.components)
        failInVtk(file.path,
                  "the array " + inQuotes(whole.name) + " of " + piece + " has " + std::to_string(found->components) +
                      " components, that of the image " + std::to_string(whole.components),
                  "write all pieces with the same components");
    return *found;
}

/// Puts the pieces of `file` into the layout that have points of `wanted`, a part of `whole`.
void addPieces(FileLayout& layout, const VtkImage& file, const VtkArray& array, const VtkExtent& wanted,
               const VtkExtent& whole, const JobControl& job) {
    for (std::size_t n = 0; n < file.pieces.size(); ++n) {
        const VtkExtent& extent = file.pieces[n].extent;
        const VtkExtent taken = common(extent, wanted);
        if (taken.isEmpty()) continue;
        const VtkArray& own = arrayOfPiece(file, n, array);
        const auto size = extent.hi - extent.lo;
        const std::uint64_t values =
            valueCount(file.path, std::array{own.components, size.x, size.y, size.z}, sizeof(double));
        // From here on its numbers are those of voxels.
        FilePiece piece{{Int3(taken.lo - whole.lo), Int3(taken.hi - whole.lo)},
                        Int3(extent.lo - whole.lo),
                        Int3(size),
                        dataOf(file, own, values, job)};
        layout.pieces.push_back(std::move(piece));
    }
}

/// Makes the extents of pieces of `file` those of their cells; `whole`: the points of the image.
void countCells(VtkImage& file, const VtkExtent& whole) {
    for (VtkPiece& piece : file.pieces) piece.extent = cellsOf(piece.extent, whole);
    std::erase_if(file.pieces, [](const VtkPiece& piece) { return piece.extent.isEmpty(); });
}

/// The file of a piece of `image`, whose extents are those of cells of `cellsIn` where that is given.
VtkImage readPiece(const VtkImage& image, const VtkPiece& piece, const std::optional<VtkExtent>& cellsIn,
                   const JobControl& job) {
    const std::string header = inQuotes(fs::path(image.path).filename().string());
    std::error_code ec;
    if (fs::status(piece.path, ec).type() == fs::file_type::not_found)
        failInVtk(piece.path, "this file is missing, a piece of " + header, "put it there, or write the image again");
    if (readableFileBytes(piece.path) == 0) failInVtk(piece.path, "the file is empty", "copy it again");
    VtkImage file = readVtkImage(piece.path, false, job);
    if (cellsIn) countCells(file, *cellsIn);
    requireCovered(file, piece.extent, "correct the extent that " + header + " gives, or write the image again", job);
    return file;
}

/// The values of `region`; of the whole image where it is empty. Files of pieces outside are not looked at.
void placeValues(FileLayout& layout, VtkImage& image, const VtkArray& array, const std::optional<VtkExtent>& cellsIn,
                 const std::optional<VoxelRegion>& region, const JobControl& job) {
    using Points = glm::vec<3, std::int64_t>;
    const VtkExtent whole = *image.extent;
    const VtkExtent asked = region ? VtkExtent{whole.lo + Points(region->lo), whole.lo + Points(region->hi)} : whole;
    if (image.piecesInFiles) {
        for (const VtkPiece& piece : image.pieces) {
            const VtkExtent wanted = common(piece.extent, asked);
            if (wanted.isEmpty()) continue;
            const VtkImage file = readPiece(image, piece, cellsIn, job);
            addPieces(layout, file, array, wanted, whole, job);
            if (image.direction.empty()) image.direction = file.direction; // some writers leave it to the pieces
        }
    } else {
        addPieces(layout, image, array, common(asked, whole), whole, job);
    }
    const Int3 dims(whole.hi - whole.lo);
    if (layout.pieces.size() != 1 || layout.pieces[0].first != Int3(0) || layout.pieces[0].dims != dims) return;
    static_cast<StoredValues&>(layout) = std::move(layout.pieces[0].values); // all in one place
    layout.pieces.clear();
}

void placeGrid(FileLayout& layout, const VtkImage& image) {
    const auto spacing = numbersIn(image.spacing, "Spacing", {1, 1, 1}, image.path);
    const auto origin = numbersIn(image.origin, "Origin", {0, 0, 0}, image.path);
    const auto direction = numbersIn(image.direction, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1}, image.path);
    Vec3 first(0);
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        layout.spacing[axis] = spacing[a];
        layout.origin[axis] = origin[a];
        layout.directions[axis] = cleanDirection({direction[a], direction[3 + a], direction[6 + a]});
        first[axis] = static_cast<double>(image.extent->lo[axis]) * spacing[a];
    }
    layout.origin += layout.directions * first; // the extent need not begin at 0
}

/// Moves the origin from the first point to the middle of the first cell.
void moveToCells(FileLayout& layout, const VtkExtent& points) {
    Vec3 half(0);
    for (int a = 0; a < 3; ++a)
        if (points.hi[a] - points.lo[a] > 1) half[a] = layout.spacing[a] / 2;
    layout.origin += layout.directions * half;
}

/// The one value of TimeValue; none where it cannot be read.
std::optional<double> timeOf(const VtkImage& image, const JobControl& job) {
    if (!image.time || image.time->components != 1) return {};
    try {
        FileLayout layout;
        layout.axes = {{1}};
        static_cast<StoredValues&>(layout) = dataOf(image, *image.time, 1, job);
        VolumeSource source;
        source.path = image.path;
        const double time = readSamples(source, layout, {job.stop, {}}).value(0);
        return std::isfinite(time) ? std::optional(time) : std::nullopt;
    } catch (const Error&) {
        return {};
    }
}

template <bool piecesInFiles>
FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    VtkImage image = readVtkImage(source.path, piecesInFiles, job);
    const std::vector<std::string> names = image.arrays.names();
    if (names.empty()) failInVtk(image.path, "the file has no values for points, nor for cells");
    const std::size_t chosen = chosenOf(names, source.array, image.arrays.active, source.path);
    const VtkArray array = image.arrays.all[chosen];
    std::optional<VtkExtent> cellsIn; // of so many points, where the array is one of cells
    if (array.ofCells) {
        cellsIn = image.extent;
        countCells(image, *cellsIn);
        image.extent = cellsOf(*cellsIn, *cellsIn);
    }
    requireCovered(image, *image.extent, "write the image again, with all of its pieces", job);
    FileLayout layout;
    layout.dataPath = source.path;
    layout.array = names[chosen];
    layout.type = typeOf(array, source.path);
    if (array.components != 1) layout.axes.push_back({array.components, true});
    const auto size = image.extent->hi - image.extent->lo;
    for (int a = 0; a < 3; ++a) layout.axes.push_back({size[a]});
    valuesIn(layout, source.path); // so many that they can be counted
    if (step) placeValues(layout, image, array, cellsIn, source.region, job);
    placeGrid(layout, image);
    if (cellsIn) moveToCells(layout, *cellsIn);
    if (names.size() > 1 && source.array.empty())
        layout.notices.push_back("array " + inQuotes(layout.array) + " of " + std::to_string(names.size()) +
                                 " is shown");
    if (cellsIn) layout.notices.emplace_back(kCellsNotice);
    if (step) return layout;
    layout.arrays = names;
    if (const auto time = timeOf(image, job)) layout.times = StepTimes{*time, 1, ""};
    return layout;
}

std::vector<std::string> filesOfPieces(const std::string& path) {
    std::vector<std::string> files;
    for (VtkPiece& piece : readVtkImage(path, true, {}).pieces) files.push_back(std::move(piece.path));
    return files;
}

} // namespace

VolumeFormat vtiFormat() {
    VolumeFormat format{"VTK image data", {".vti"},   describeLayout<layoutOf<false>>, readLayout<layoutOf<false>>,
                        nullptr,          kVtiContent};
    format.holdsSeveral = true;
    return format;
}

VolumeFormat pvtiFormat() {
    VolumeFormat format{"VTK image data in pieces", {".pvti"},     describeLayout<layoutOf<true>>,
                        readLayout<layoutOf<true>>, filesOfPieces, kPvtiContent};
    format.holdsSeveral = true;
    return format;
}

} // namespace pellucid
