#include "volume/formats/vtk_legacy_header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "base/round_numbers.h"
#include "volume/formats/file_check.h"
#include "volume/formats/text_header.h"
#include "volume/formats/vtk_header.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostArrays = 10'000;
constexpr std::int64_t kMostComponents = 10'000;
constexpr const char* kCheckSizes = "check DIMENSIONS and the type of the array, or copy the file again";

/// Type of one number; none where the file names one that cannot be read.
std::optional<ValueType> typeNamed(const std::string& name) {
    // VTK writes its ids as numbers of 32 bits, whatever they are in memory.
    static const std::map<std::string, ValueType> kTypes{
        {"char", ValueType::I8},           {"signed_char", ValueType::I8},     {"unsigned_char", ValueType::U8},
        {"short", ValueType::I16},         {"unsigned_short", ValueType::U16}, {"int", ValueType::I32},
        {"unsigned_int", ValueType::U32},  {"vtkidtype", ValueType::I32},      {"long", ValueType::I64},
        {"unsigned_long", ValueType::U64}, {"vtktypeint64", ValueType::I64},   {"vtktypeuint64", ValueType::U64},
        {"float", ValueType::F32},         {"double", ValueType::F64}};
    const auto it = kTypes.find(lowerCase(name));
    return it == kTypes.end() ? std::nullopt : std::optional(it->second);
}

/// A name as people read it: VTK writes blanks and the like as "%20", those of colours as "%%20".
std::string decodedName(std::string name) {
    for (std::size_t at = name.find("%%"); at != std::string::npos; at = name.find("%%", at + 1)) name.erase(at, 1);
    return percentDecoded(name);
}

/// Goes through a file by its words.
class LegacyReader {
public:
    LegacyReader(const std::string& path, const JobControl& job)
        : m_fileBytes(readableFileBytes(path)), m_text(path, 0, job), m_job(job) {
        m_file.path = path;
    }

    LegacyVtk read() {
        readBegin();
        std::string keyword;
        while (next(keyword)) readStatement(lowerCase(keyword));
        if (m_file.dims[0] == 0) fail("the file gives no DIMENSIONS", "copy it again");
        keepWhole();
        return std::move(m_file);
    }

private:
    [[noreturn]] void fail(const std::string& what,
                           const std::string& toDo = "correct the file, or write it again") const {
        failInVtk(m_file.path, what, toDo);
    }

    /// The next word; false at the end of the file.
    bool next(std::string& word) {
        constexpr std::size_t kMostCharacters = 4096;
        word.clear();
        while (std::isspace(m_text.peek()) != 0) m_text.pass();
        for (int c = m_text.peek(); c >= 0 && std::isspace(c) == 0; c = m_text.peek()) {
            if (word.size() == kMostCharacters) fail("there is a word of more than 4096 characters", "copy it again");
            word += static_cast<char>(c);
            m_text.pass();
        }
        return !word.empty();
    }
    std::string needed(const std::string& what) {
        std::string word;
        if (!next(word)) fail("the file ends where " + what + " should stand", "copy it again");
        return word;
    }
    std::int64_t wholeNumber(const std::string& what) {
        const std::string word = needed(what);
        std::int64_t value = 0;
        if (!parseNumber(word, value)) fail("there is " + inQuotes(word) + " where " + what + " should stand");
        return value;
    }
    double number(const std::string& what) {
        const std::string word = needed(what);
        const double value = numberIn(word);
        if (!std::isfinite(value)) fail("there is " + inQuotes(word) + " where " + what + " should stand");
        return value;
    }
    /// What is left of the line, whose end is passed: behind it binary data begin.
    std::string restOfLine() {
        constexpr std::size_t kMostCharacters = 1u << 16;
        std::string line;
        for (int c = m_text.peek(); c >= 0; c = m_text.peek()) {
            m_text.pass();
            if (c == '\n') break;
            line += static_cast<char>(c);
            if (line.size() > kMostCharacters) fail("there is a line of more than 64 KiB", "copy the file again");
        }
        return trimmed(line);
    }

    /// The first lines: version, title, how values are written.
    void readBegin() {
        const std::string head = fileHead(m_file.path, 1024);
        if (!lowerCase(head).starts_with("# vtk datafile version")) throw notOfFormat("a VTK file", m_file.path, head);
        restOfLine();
        restOfLine();
        const std::string written = restOfLine(), word = lowerCase(written);
        if (word != "ascii" && word != "binary")
            fail("the third line is " + inQuotes(written) + ", neither ASCII nor BINARY");
        m_file.isBinary = word == "binary";
    }

    void readStatement(const std::string& keyword) {
        static const std::map<std::string, std::int64_t> kOfFixedSize{
            {"vectors", 3}, {"normals", 3}, {"tensors", 9}, {"tensors6", 6}, {"global_ids", 1}, {"pedigree_ids", 1}};
        if (keyword == "dataset") return readDataset(needed("a type of data set"));
        if (keyword == "metadata") return passMetadata();
        if (keyword == "field") return readFields();
        if (m_file.dims[0] == 0 && !m_hasDataset) fail("there is " + inQuotes(keyword) + " before any DATASET");
        if (keyword == "dimensions") return readDimensions();
        if (keyword == "extent") return readExtent();
        if (keyword == "spacing" || keyword == "aspect_ratio") return readSpacing(keyword);
        if (keyword == "origin") return readOrigin();
        if (keyword.size() > 2 && keyword.substr(1) == "_coordinates") return readCoordinates(keyword[0] - 'x');
        if (keyword == "point_data" || keyword == "cell_data") return beginData(keyword == "cell_data");
        if (keyword == "scalars") return readScalars();
        if (keyword == "color_scalars") return readColours();
        if (keyword == "lookup_table") return passLookupTable();
        if (keyword == "texture_coordinates") return readTextureCoordinates();
        if (const auto it = kOfFixedSize.find(keyword); it != kOfFixedSize.end()) {
            LegacyArray array = named(it->second);
            array.typeName = needed("a type");
            return addArray(std::move(array));
        }
        fail("the keyword " + inQuotes(keyword) + " is not known");
    }

    void readDataset(const std::string& type) {
        const std::string lower = lowerCase(type);
        if (lower != "structured_points" && lower != "rectilinear_grid")
            fail("this VTK file holds " + inQuotes(type) + ", not STRUCTURED_POINTS", "resample it to an image");
        m_hasDataset = true;
    }

    /// Blocks that describe an array end with an empty line.
    void passMetadata() {
        restOfLine();
        while (m_text.peek() >= 0 && !restOfLine().empty()) continue;
    }

    void setDimensions(const std::array<std::int64_t, 3>& dims) {
        m_file.dims = dims;
        valueCount(m_file.path, dims, sizeof(double)); // so many that they can be counted
    }
    void readDimensions() {
        std::array<std::int64_t, 3> dims{};
        for (std::int64_t& size : dims) size = wholeNumber("a number of DIMENSIONS");
        setDimensions(dims);
    }
    void readExtent() {
        std::array<std::int64_t, 3> dims{};
        for (std::size_t a = 0; a < 3; ++a) {
            constexpr std::int64_t kMost = std::int64_t{1} << 31;
            const std::int64_t first = wholeNumber("a number of EXTENT"), last = wholeNumber("a number of EXTENT");
            if (std::min(first, last) < -kMost || std::max(first, last) > kMost)
                fail("a number of EXTENT is beyond any image");
            dims[a] = last - first + 1;
            m_firstPoint[static_cast<int>(a)] = static_cast<double>(first);
        }
        setDimensions(dims);
    }
    void readSpacing(const std::string& keyword) {
        for (int a = 0; a < 3; ++a) {
            const std::string word = needed("a number of " + keyword);
            m_file.spacing[a] = numberIn(word);
            requireSpacing(m_file.spacing[a], static_cast<std::size_t>(a), word, m_file.path);
        }
    }
    void readOrigin() {
        for (int a = 0; a < 3; ++a) m_file.origin[a] = number("a number of ORIGIN");
    }

    /// Coordinates along an axis of a rectilinear grid, which have to be evenly spaced.
    void readCoordinates(int axis) {
        if (axis < 0 || axis > 2) fail("there are coordinates of an axis that is none of X, Y, Z");
        LegacyArray list;
        list.name = std::string(1, static_cast<char>('X' + axis)) + "_COORDINATES";
        const std::int64_t count = wholeNumber("a number of coordinates");
        if (count != m_file.dims[static_cast<std::size_t>(axis)])
            fail("there are " + std::to_string(count) + " " + list.name + ", but DIMENSIONS has " +
                 std::to_string(m_file.dims[static_cast<std::size_t>(axis)]));
        list.tuples = static_cast<std::uint64_t>(count);
        list.typeName = needed("a type");
        list.type = typeNamed(list.typeName);
        if (!list.type) failType(list);
        passValues(list);
        setAxis(axis, list, valuesOf(list));
    }
    void setAxis(int axis, const LegacyArray& list, const std::vector<double>& at) {
        m_file.origin[axis] = at.front();
        if (at.size() == 1) return;
        const double step = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
        if (!(step > 0)) fail("the " + list.name + " do not increase", "write the grid the other way round");
        const double rounding =
            std::numeric_limits<float>::epsilon() * std::max(std::abs(at.front()), std::abs(at.back()));
        for (std::size_t i = 0; i < at.size(); ++i)
            if (!(std::abs(at[i] - (at.front() + static_cast<double>(i) * step)) <= 1e-4 * step + rounding))
                fail("the " + list.name + " are not evenly spaced: number " + std::to_string(i) + " is " +
                         exactText(at[i]) + ", not " + exactText(at.front() + static_cast<double>(i) * step),
                     "resample it to an image");
        m_file.spacing[axis] = step;
    }
    /// Values of a list that is in the file as a whole.
    std::vector<double> valuesOf(const LegacyArray& list) {
        FileLayout layout;
        layout.axes = {{static_cast<std::int64_t>(list.tuples)}};
        layout.dataPath = m_file.path;
        layout.encoding = m_file.isBinary ? Encoding::Raw : Encoding::Text;
        layout.type = *list.type;
        layout.bigEndian = true;
        layout.start = list.start;
        VolumeSource source;
        source.path = m_file.path;
        const Volume values = readSamples(source, layout, {m_job.stop, {}});
        std::vector<double> numbers;
        for (std::size_t i = 0; i < list.tuples; ++i) numbers.push_back(values.value(i));
        return numbers;
    }

    void beginData(bool ofCells) {
        if (m_file.dims[0] == 0) fail("there are data before DIMENSIONS");
        m_isInData = true;
        m_ofCells = ofCells;
        const std::int64_t count = wholeNumber("a number of tuples");
        std::uint64_t needed = 1;
        for (const std::int64_t points : m_file.dims)
            needed *= static_cast<std::uint64_t>(ofCells ? cellsAlong(points) : points);
        if (count < 0 || static_cast<std::uint64_t>(count) != needed)
            fail("the file gives " + std::string(ofCells ? "CELL_DATA " : "POINT_DATA ") + std::to_string(count) +
                 ", but its DIMENSIONS have " + std::to_string(needed));
        m_tuples = needed;
    }

    /// An array of the data that have begun, whose name comes next.
    LegacyArray named(std::int64_t components) {
        if (!m_isInData) fail("there is an array before POINT_DATA and CELL_DATA");
        LegacyArray array;
        array.name = decodedName(needed("the name of an array"));
        array.components = components;
        array.tuples = m_tuples;
        array.ofCells = m_ofCells;
        return array;
    }
    void readScalars() {
        LegacyArray array = named(1);
        array.isScalars = true;
        array.typeName = needed("a type");
        const std::string line = restOfLine();
        if (!line.empty() && !parseNumber(line, array.components))
            fail("there is " + inQuotes(line) + " where a number of components should stand");
        if (isLookupTableNext()) restOfLine();
        addArray(std::move(array), true);
    }
    /// Whether the line names a table of colours: many writers leave it out.
    bool isLookupTableNext() {
        constexpr std::string_view kKeyword = "lookup_table";
        while (!m_file.isBinary && std::isspace(m_text.peek()) != 0) m_text.pass();
        const std::uint64_t here = m_text.passed();
        FileBytes bytes(m_file.path, here, m_job);
        std::string word(kKeyword.size(), '\0');
        word.resize(bytes.read(word.data(), word.size()));
        return lowerCase(word) == kKeyword;
    }
    /// Bytes; as numbers from 0 to 1 where they are written out.
    void readColours() {
        LegacyArray array = named(1);
        array.components = wholeNumber("a number of components");
        array.typeName = "unsigned_char";
        array.areFractions = !m_file.isBinary;
        addArray(std::move(array));
    }
    void readTextureCoordinates() {
        LegacyArray array = named(1);
        array.components = wholeNumber("a number of components");
        array.typeName = needed("a type");
        addArray(std::move(array));
    }
    void passLookupTable() {
        LegacyArray table;
        table.name = needed("the name of a table");
        table.components = 4;
        table.tuples = tuplesIn("a number of colours");
        table.typeName = m_file.isBinary ? "unsigned_char" : "float";
        table.type = typeNamed(table.typeName);
        passValues(table);
    }

    void readFields() {
        needed("the name of the field");
        const std::int64_t count = wholeNumber("a number of arrays");
        for (std::int64_t n = 0; n < count; ++n) {
            LegacyArray array;
            do { // VTK describes an array behind it
                array.name = needed("the name of an array");
                if (lowerCase(array.name) == "metadata") passMetadata();
            } while (lowerCase(array.name) == "metadata");
            array.name = decodedName(array.name);
            array.components = wholeNumber("a number of components");
            array.tuples = tuplesIn("a number of tuples");
            array.typeName = needed("a type");
            array.ofCells = m_ofCells;
            if (!m_isInData) {
                readOfFile(array);
                continue;
            }
            addArray(std::move(array));
        }
    }
    /// An array that belongs to the file as a whole.
    void readOfFile(LegacyArray& array) {
        array.type = typeNamed(array.typeName);
        passValues(array);
        const std::string name = lowerCase(array.name);
        const bool isTime = (name == "time" || name == "timevalue") && array.tuples == 1 && array.components == 1;
        if (!isTime || !array.type) return;
        const double time = valuesOf(array).front();
        if (std::isfinite(time)) m_file.time = time;
    }
    std::uint64_t tuplesIn(const std::string& what) {
        const std::int64_t count = wholeNumber(what);
        if (count < 0) fail("there is " + std::to_string(count) + " where " + what + " should stand");
        return static_cast<std::uint64_t>(count);
    }

    /// `isAtData`: the line that its values follow has been passed.
    void addArray(LegacyArray array, bool isAtData = false) {
        if (m_file.arrays.size() >= kMostArrays) fail("there are too many arrays");
        array.type = typeNamed(array.typeName);
        passValues(array, isAtData);
        if (array.tuples == m_tuples) m_file.arrays.push_back(std::move(array));
    }

    [[noreturn]] void failType(const LegacyArray& array) const {
        fail("the type " + inQuotes(array.typeName) + " of " + inQuotes(array.name) + " is not supported",
             "use one of char, unsigned_char, … float, double");
    }
    /// Goes past the values of an array, all of which have to be there.
    void passValues(LegacyArray& array, bool isAtData = false) {
        constexpr std::uint64_t kBitsPerByte = 8;
        const bool areBits = lowerCase(array.typeName) == "bit";
        if (!array.type && !areBits) failType(array);
        if (array.components < 1 || array.components > kMostComponents)
            fail("the array " + inQuotes(array.name) + " has " + std::to_string(array.components) + " components");
        if (array.tuples / kBitsPerByte > m_fileBytes) // before they are multiplied by anything
            fail("the array " + inQuotes(array.name) + " has more values than the file has bits", kCheckSizes);
        const std::uint64_t values = array.tuples * static_cast<std::uint64_t>(array.components);
        if (m_file.isBinary) {
            if (!isAtData) restOfLine();
            array.start = m_text.passed();
            const std::uint64_t left = m_fileBytes - std::min(array.start, m_fileBytes);
            const std::uint64_t bytesPer = areBits ? 1 : bytesPerValue(*array.type);
            const std::uint64_t units = areBits ? (values + kBitsPerByte - 1) / kBitsPerByte : values;
            requireStored(m_file.path, Encoding::Raw, units, bytesPer, left, kCheckSizes);
            m_text.skip(units * bytesPer);
        } else {
            array.start = m_text.passed();
            requireStored(m_file.path, Encoding::Text, values, 1, m_fileBytes - array.start, kCheckSizes);
            passWords(array, values);
        }
    }
    void passWords(const LegacyArray& array, std::uint64_t count) {
        for (std::uint64_t n = 0; n < count; ++n) {
            if (n % (1u << 20) == 0) m_job.throwIfStopped();
            while (std::isspace(m_text.peek()) != 0) m_text.pass();
            if (m_text.peek() < 0)
                fail("the array " + inQuotes(array.name) + " has " + std::to_string(n) + " of " +
                         std::to_string(count) + " values",
                     kCheckSizes);
            while (m_text.peek() >= 0 && std::isspace(m_text.peek()) == 0) m_text.pass();
        }
    }

    /// What is only known at the end.
    void keepWhole() {
        for (int a = 0; a < 3; ++a) m_file.origin[a] += m_firstPoint[a] * m_file.spacing[a];
    }

    LegacyVtk m_file;
    std::uint64_t m_fileBytes;
    FileCharacters m_text;
    const JobControl& m_job;
    Vec3 m_firstPoint{0, 0, 0}; // of EXTENT
    bool m_hasDataset = false, m_isInData = false, m_ofCells = false;
    std::uint64_t m_tuples = 0; // of the data that have begun
};

} // namespace

LegacyVtk readLegacyVtk(const std::string& path, const JobControl& job) { return LegacyReader(path, job).read(); }

std::int64_t cellsAlong(std::int64_t points) { return std::max<std::int64_t>(1, points - 1); }

} // namespace pellucid
