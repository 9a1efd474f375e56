// NIfTI-1 and NIfTI-2, in one file or as a pair of header and data, plain or gzip-compressed.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <zlib.h>

#include "base/round_numbers.h"
#include "volume/formats/nifti_form.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

/// The bytes of the longest header, unpacked where the file is gzip; fewer where there are no more.
std::vector<unsigned char> headerBytes(const std::string& path) {
    std::vector<unsigned char> bytes(kNiftiForms[1].bytes);
    const gzFile file = gzopen(path.c_str(), "rb"); // reads plain files as they are
    if (file == nullptr) throw FileError("cannot read the file", path, "check its permissions");
    const int read = gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
    bytes.resize(static_cast<std::size_t>(std::max(read, 0)));
    return bytes;
}

bool isGzip(const std::string& path) { return fileHead(path, 2) == "\x1f\x8b"; }

/// A header of NIfTI-1 or NIfTI-2, in either byte order.
class NiftiHeader {
public:
    explicit NiftiHeader(const std::string& path) : m_path(path), m_bytes(headerBytes(path)) {
        const NiftiForm* const form = m_bytes.size() < sizeof(std::int32_t) ? nullptr : formBySize();
        if (m_bytes.size() < (form != nullptr ? form->bytes : kNiftiForms[0].bytes)) {
            const std::string head = fileHead(path, 1024);
            if (form != nullptr || head.starts_with("\x1f\x8b"))
                fail("the file holds " + std::to_string(m_bytes.size()) + " readable bytes, fewer than a NIfTI header",
                     "copy the file again");
            throw notOfFormat("a NIfTI file", path, head);
        }
        if (form == nullptr)
            throw notOfFormat("a NIfTI file", path, {reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size()});
        m_form = *form;
        const char version = m_form.version == 2 ? '2' : '1';
        const std::string mark(reinterpret_cast<const char*>(m_bytes.data()) + m_form.magic, 4);
        m_isPair = mark == std::string("ni") + version + '\0';
        if (!m_isPair && mark != std::string("n+") + version + '\0')
            fail(std::string("the header lacks the mark of NIfTI-") + version,
                 "convert an Analyze file to NIfTI first");
        if (m_form.version == 2 && std::memcmp(m_bytes.data() + m_form.magic + 4, kNifti2Mark, 4) != 0)
            fail("the mark of NIfTI-2 in the header is damaged, as by copying the file as text",
                 "copy it again, as binary data");
    }

    [[noreturn]] void fail(const std::string& what, const std::string& toDo) const {
        throw FileError(what, m_path, toDo);
    }

    const std::string& path() const { return m_path; }
    /// The data are in a file of their own, *.img.
    bool isPair() const { return m_isPair; }
    std::size_t bytes() const { return m_form.bytes; }
    std::int64_t dim(int i) const { return integer<std::int16_t, std::int64_t>(m_form.dim, i); }
    int datatype() const { return at<std::int16_t>(m_form.datatype); }
    double pixdim(int i) const { return real(m_form.pixdim, i); }
    double voxOffset() const {
        return m_form.version == 1 ? at<float>(m_form.voxOffset)
                                   : static_cast<double>(at<std::int64_t>(m_form.voxOffset));
    }
    double slope() const { return real(m_form.slope); }
    double intercept() const { return real(m_form.intercept); }
    int intent() const { return static_cast<int>(integer<std::int16_t, std::int32_t>(m_form.intent)); }
    int spaceUnit() const { return units() & 7; }
    int timeUnit() const { return units() & 0x38; }
    double timeOffset() const { return real(m_form.timeOffset); }
    bool hasQform() const { return integer<std::int16_t, std::int32_t>(m_form.qformCode) > 0; }
    bool hasSform() const { return integer<std::int16_t, std::int32_t>(m_form.sformCode) > 0; }
    /// b, c, d of the quaternion, then the offsets.
    double qform(int i) const { return real(m_form.qform, i); }
    /// Row by row, 3 x 4.
    double sform(int row, int column) const { return real(m_form.sform, 4 * row + column); }
    bool isBigEndian() const { return m_swapped != (std::endian::native == std::endian::big); }

private:
    /// By the size that the header gives of itself, in the byte order in which that is one; null: in neither.
    const NiftiForm* formBySize() {
        for (const bool swapped : {false, true}) {
            m_swapped = swapped;
            const auto size = at<std::int32_t>(0);
            for (const NiftiForm& form : kNiftiForms)
                if (size == static_cast<std::int32_t>(form.bytes)) return &form;
        }
        return nullptr;
    }
    template <class First, class Second>
    std::int64_t integer(std::size_t offset, int i = 0) const {
        const auto n = static_cast<std::size_t>(i);
        return m_form.version == 1 ? at<First>(offset + n * sizeof(First)) : at<Second>(offset + n * sizeof(Second));
    }
    double real(std::size_t offset, int i = 0) const {
        const auto n = static_cast<std::size_t>(i);
        return m_form.version == 1 ? at<float>(offset + n * sizeof(float)) : at<double>(offset + n * sizeof(double));
    }
    int units() const { return m_form.version == 1 ? m_bytes[m_form.units] : at<std::int32_t>(m_form.units); }
    template <class T>
    T at(std::size_t offset) const {
        std::array<unsigned char, sizeof(T)> bytes{};
        std::copy_n(m_bytes.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), bytes.begin());
        if (m_swapped) std::reverse(bytes.begin(), bytes.end());
        T value;
        std::memcpy(&value, bytes.data(), sizeof(T));
        return value;
    }

    std::string m_path;
    std::vector<unsigned char> m_bytes;
    bool m_swapped = false, m_isPair = false;
    NiftiForm m_form = kNiftiForms[0];
};

/// The file that holds the data: `header` itself, or the *.img beside a *.hdr, packed or not. Throws FileError where
/// there is none.
std::string dataPathOf(const NiftiHeader& header) {
    if (!header.isPair()) return header.path();
    std::string stem = header.path();
    for (const std::string_view packed : {".gz", ".GZ"})
        if (stem.ends_with(packed)) stem.resize(stem.size() - packed.size());
    const bool upper = stem.ends_with(".HDR");
    if (!upper && !stem.ends_with(".hdr"))
        header.fail("this is the header of a pair of files, whose name should end in .hdr",
                    "name it so, and the file with the data beside it .img");
    stem.resize(stem.size() - 4);
    const std::string image = stem + (upper ? ".IMG" : ".img");
    std::error_code ec;
    for (const std::string& path : {image, image + (upper ? ".GZ" : ".gz")})
        if (std::filesystem::is_regular_file(path, ec)) return path;
    header.fail("the file with the data, " + std::filesystem::path(image).filename().string() +
                    ", is not beside this header",
                "copy both into one folder");
}

/// A name whose suffix `from`, before that of gzip, is replaced by `to`, in the case of the letters that are there;
/// empty where it has another suffix.
std::string withSuffix(const std::string& path, const std::string& from, const std::string& to) {
    std::string stem = path;
    for (const std::string_view packed : {".gz", ".GZ"})
        if (stem.ends_with(packed)) stem.resize(stem.size() - packed.size());
    if (lowerCase(stem).size() <= from.size() || !lowerCase(stem).ends_with(from)) return {};
    const bool upper = !stem.ends_with(from);
    stem.resize(stem.size() - from.size());
    std::string suffix = to;
    if (upper) std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::toupper(c); });
    return stem + suffix;
}

/// The header of a pair beside its *.img; empty where there is none.
std::string headerBeside(const std::string& image) {
    const std::string header = withSuffix(image, ".img", ".hdr");
    if (header.empty()) return {};
    std::error_code ec;
    for (const std::string& path : {header, header + ".gz", header + ".GZ"}) {
        if (!std::filesystem::is_regular_file(path, ec)) continue;
        const std::vector<unsigned char> bytes = headerBytes(path);
        if (beginsLikeNifti({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) return path;
    }
    return {};
}

/// The file with the header: the one that is opened, or the one beside it.
std::string headerPathOf(const std::string& opened) {
    const std::string beside = headerBeside(opened);
    return beside.empty() ? opened : beside;
}

bool isOfPair(const std::string& path) { return !headerBeside(path).empty(); }

struct NiftiType {
    std::int64_t components; ///< of one voxel, beside each other
    ValueType type;
    bool isColour = false;
};

NiftiType typeIn(const NiftiHeader& header) {
    static const std::map<int, NiftiType> kTypes{
        {2, {1, ValueType::U8}},         {4, {1, ValueType::I16}},        {8, {1, ValueType::I32}},
        {16, {1, ValueType::F32}},       {32, {2, ValueType::F32}},       {64, {1, ValueType::F64}},
        {128, {3, ValueType::U8, true}}, {256, {1, ValueType::I8}},       {512, {1, ValueType::U16}},
        {768, {1, ValueType::U32}},      {1024, {1, ValueType::I64}},     {1280, {1, ValueType::U64}},
        {1792, {2, ValueType::F64}},     {2304, {4, ValueType::U8, true}}};
    if (const auto it = kTypes.find(header.datatype()); it != kTypes.end()) return it->second;
    header.fail("the NIfTI data type " + std::to_string(header.datatype()) + " is not supported",
                "convert it to integers of 8 to 64 bits, float or double");
}

/// What lies along the fifth axis is no series but the components of each voxel: a matrix, a vector, a colour.
bool fifthAxisHasComponents(int intent) {
    constexpr int kMatrix = 1004, kVector = 1007, kRgb = 2003, kRgba = 2004;
    return (intent >= kMatrix && intent <= kVector) || intent == kRgb || intent == kRgba;
}

std::vector<FileAxis> axesIn(const NiftiHeader& header, const NiftiType& type) {
    const std::int64_t count = header.dim(0);
    if (count < 1 || count > 7)
        header.fail("the header gives " + std::to_string(count) + " axes, not 1 to 7", "correct the header");
    const bool vector = count >= 5 && header.dim(5) > 1 && fifthAxisHasComponents(header.intent());
    if (vector && type.components > 1)
        header.fail("a vector of colours or complex numbers is not supported", "write one file for each");
    std::vector<FileAxis> axes;
    if (type.components > 1) axes.push_back({type.components, true});
    for (int a = 1; a <= count; ++a) axes.push_back({header.dim(a), vector && a == 5});
    return axes;
}

/// The scaling that the header asks for; none where the slope is 0 or no number, as NIfTI has it, and none for colours.
std::optional<ValueScaling> scalingIn(const NiftiHeader& header, const NiftiType& type) {
    const double slope = header.slope(), intercept = header.intercept();
    if (type.isColour || slope == 0 || !std::isfinite(slope)) return {};
    if (!std::isfinite(intercept))
        header.fail("the header scales by " + std::to_string(slope) + " and adds " + std::to_string(intercept),
                    "correct scl_slope and scl_inter in the header");
    if (slope == 1 && intercept == 0) return {};
    return ValueScaling{slope, intercept};
}

/// Where the grid lies according to one of the header's two forms, in NIfTI's world and the header's unit.
struct Placement {
    Mat3 axes{1}; ///< unit columns
    Vec3 spacing{1, 1, 1}, origin{0, 0, 0};
};

Placement fromQform(const NiftiHeader& header, const Vec3& spacing) {
    double b = header.qform(0), c = header.qform(1), d = header.qform(2);
    double a = 0;
    const double square = b * b + c * c + d * d;
    if (square > 1) { // rounded off: the quaternion is of length 1
        const double length = std::sqrt(square);
        b /= length;
        c /= length;
        d /= length;
    } else {
        a = std::sqrt(1 - square);
    }
    const double third = header.pixdim(0) < 0 ? -1 : 1;
    return {Mat3{Vec3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                 Vec3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                 third * Vec3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b}},
            spacing,
            {header.qform(3), header.qform(4), header.qform(5)}};
}

/// None where it is no map of space onto itself.
std::optional<Placement> fromSform(const NiftiHeader& header) {
    Placement placement;
    for (int column = 0; column < 3; ++column) {
        const Vec3 axis{header.sform(0, column), header.sform(1, column), header.sform(2, column)};
        const double length = glm::length(axis);
        if (!(length > 0) || !std::isfinite(length)) return {};
        placement.axes[column] = axis / length;
        // pixdim says the same with other rounding; where it does not, the map is what is meant.
        const double pixdim = header.pixdim(column + 1);
        placement.spacing[column] = std::abs(length - pixdim) < 1e-5 * length ? pixdim : length;
    }
    if (!(std::abs(glm::determinant(placement.axes)) > 1e-6)) return {};
    placement.origin = {header.sform(0, 3), header.sform(1, 3), header.sform(2, 3)};
    return placement;
}

/// Whether both say the same but for rounding: a quaternion of single precision may be off by 6e-4, where it turns by
/// almost half a circle.
bool agree(const Placement& one, const Placement& other) {
    constexpr double kTurn = 1e-3, kStretch = 1e-3, kShift = 1e-2; // the last in voxels
    const double voxel = std::min({one.spacing.x, one.spacing.y, one.spacing.z});
    bool same = glm::length(one.origin - other.origin) <= kShift * voxel;
    for (int a = 0; a < 3; ++a)
        same = same && glm::length(one.axes[a] - other.axes[a]) <= kTurn &&
               std::abs(one.spacing[a] - other.spacing[a]) <= kStretch * one.spacing[a];
    return same;
}

/// sform where the header has one, else qform. Empty where it has neither: then the grid's own axes are the world's.
std::optional<Placement> placementIn(const NiftiHeader& header, const Vec3& spacing,
                                     std::vector<std::string>& notices) {
    const bool hasQform = header.hasQform(), hasSform = header.hasSform();
    bool finite = true;
    for (int i = 0; i < 6; ++i) finite = finite && (!hasQform || std::isfinite(header.qform(i)));
    for (int i = 0; i < 12; ++i) finite = finite && (!hasSform || std::isfinite(header.sform(i / 4, i % 4)));
    if (!finite) header.fail("the header's qform or sform has a number that is not finite", "correct it in the header");
    std::optional<Placement> qform, sform;
    if (hasQform) qform = fromQform(header, spacing);
    if (hasSform) sform = fromSform(header);
    if (hasSform && !sform) {
        if (!hasQform)
            header.fail("the axes that sform gives lie in one plane", "correct sform, or give qform in the header");
        notices.emplace_back("the axes of the header's sform lie in one plane: qform says where the volume lies");
    }
    if (sform && qform && !agree(*sform, *qform))
        notices.emplace_back("the header's sform and qform place the volume differently: it lies as sform says");
    return sform ? sform : qform;
}

/// The header's unit of length.
LengthUnit lengthUnitIn(const NiftiHeader& header) {
    static const std::map<int, LengthUnit> kUnits{
        {1, LengthUnit::Metre}, {2, LengthUnit::Millimetre}, {3, LengthUnit::Micrometre}};
    const auto unit = kUnits.find(header.spaceUnit());
    return unit == kUnits.end() ? LengthUnit::Unknown : unit->second;
}

void placeGrid(FileLayout& layout, const NiftiHeader& header) {
    const int axes = static_cast<int>(std::min<std::int64_t>(header.dim(0), 3));
    const LengthUnit ofFile = lengthUnitIn(header);
    for (int a = 1; a <= axes; ++a) {
        layout.spacing[a - 1] = header.pixdim(a);
        requireSpacing(layout.spacing[a - 1], static_cast<std::size_t>(a - 1), plainText(layout.spacing[a - 1]),
                       header.path());
    }
    if (const std::optional<Placement> placement = placementIn(header, layout.spacing, layout.notices)) {
        layout.worldAxes = WorldAxes::Patient;
        const double millimetres = converted(1, ofFile, LengthUnit::Millimetre);
        const Vec3 flip{-1, -1, 1}; // our x goes to the left, our y to the back
        for (int a = 0; a < 3; ++a) {
            layout.origin[a] = placement->origin[a] == 0 ? 0 : flip[a] * placement->origin[a] * millimetres;
            layout.directions[a] = cleanDirection(flip * placement->axes[a]);
            if (a < axes) layout.spacing[a] = placement->spacing[a] * millimetres;
        }
    } else {
        layout.lengthUnit = ofFile;
    }
}

/// When the steps along the fourth axis were; none where that axis is no time, or the header does not tell.
std::optional<StepTimes> timesIn(const NiftiHeader& header) {
    for (int a = 5; a <= header.dim(0); ++a)
        if (header.dim(a) > 1) return {}; // steps of steps
    const double width = header.pixdim(4), first = header.timeOffset();
    if (header.dim(0) < 4 || header.dim(4) < 2 || !(width > 0) || !std::isfinite(width)) return {};
    static const std::map<int, const char*> kUnits{{8, "s"}, {16, "ms"}, {24, "µs"}};
    const auto unit = kUnits.find(header.timeUnit());
    if (unit != kUnits.end()) return StepTimes{std::isfinite(first) ? first : 0, width, unit->second};
    if (header.timeUnit() != 0 || width == 1) return {}; // hertz and the like; or nobody has set anything
    return StepTimes{std::isfinite(first) ? first : 0, width, ""};
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const std::string path = headerPathOf(source.path);
    readableFileBytes(path);
    const NiftiHeader header(path);
    const NiftiType type = typeIn(header);
    FileLayout layout;
    layout.dataPath = dataPathOf(header);
    layout.type = type.type;
    layout.bigEndian = header.isBigEndian();
    layout.axes = axesIn(header, type);
    constexpr int kSymmetricMatrix = 1005;
    if (header.intent() == kSymmetricMatrix && layout.axes.size() >= 5 && layout.axes[4].components &&
        header.dim(5) == 6)                         // the file has xx xy yy xz yz zz
        layout.componentOrder = {0, 1, 3, 2, 4, 5}; // as NRRD: xx xy xz yy yz zz
    layout.scaling = scalingIn(header, type);
    valuesIn(layout, path); // throws where they are too many to count
    placeGrid(layout, header);
    const double offset = header.voxOffset();
    if (!(offset >= 0) || offset > 1e9)
        header.fail("the header's vox_offset cannot be where the data begin", "correct vox_offset in the header");
    layout.times = timesIn(header);
    if (!step) return layout;
    // Four bytes about extensions follow the header of a single file: data cannot begin before, and do so there where
    // nothing is said.
    auto start = static_cast<std::uint64_t>(offset);
    if (!header.isPair()) start = start == 0 ? header.bytes() + 4 : std::max<std::uint64_t>(start, header.bytes());
    const bool compressed = isGzip(layout.dataPath);
    layout.encoding = compressed ? Encoding::Deflate : Encoding::Raw;
    (compressed ? layout.skip : layout.start) = start;
    const std::uint64_t fileBytes = dataFileBytes(layout.dataPath, path);
    requireData(layout, fileBytes - std::min(layout.start, fileBytes), valuesUpTo(layout, *step),
                "check dim and datatype in the header, or copy the file again", job);
    return layout;
}

std::vector<std::string> dataFiles(const std::string& path) {
    const std::string headerPath = headerPathOf(path);
    const NiftiHeader header(headerPath);
    if (headerPath != path) return {headerPath};
    return header.isPair() ? std::vector<std::string>{dataPathOf(header)} : std::vector<std::string>{};
}

} // namespace

VolumeFormat niftiFormat() {
    return {"NIfTI",
            {".nii", ".nii.gz", ".hdr", ".hdr.gz"},
            describeLayout<layoutOf>,
            readLayout<layoutOf>,
            dataFiles,
            kNiftiContent,
            {".img", ".img.gz"},
            isOfPair};
}

} // namespace pellucid
