// NIfTI-1 in one file, plain or gzip-compressed.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <zlib.h>

#include "base/round_numbers.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

constexpr std::size_t kHeaderBytes = 348;

/// The first 348 bytes, unpacked where the file is gzip; fewer where there are no more.
std::vector<unsigned char> headerBytes(const std::string& path) {
    std::vector<unsigned char> bytes(kHeaderBytes);
    const gzFile file = gzopen(path.c_str(), "rb"); // reads plain files as they are
    if (file == nullptr) throw FileError("cannot read the file", path, "check its permissions");
    const int read = gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
    bytes.resize(static_cast<std::size_t>(std::max(read, 0)));
    return bytes;
}

/// Fields of the header at their offsets, in either byte order.
class NiftiHeader {
public:
    explicit NiftiHeader(const std::string& path) : m_path(path), m_bytes(headerBytes(path)) {
        if (m_bytes.size() < kHeaderBytes) {
            const std::string head = fileHead(path, 1024);
            if (head.starts_with("\x1f\x8b"))
                fail("the compressed file holds " + std::to_string(m_bytes.size()) +
                         " readable bytes, fewer than a NIfTI header",
                     "copy the file again");
            throw notOfFormat("a NIfTI file", path, head);
        }
        const auto size = at<std::int32_t>(0);
        m_swapped = size != 348 && size != 540;
        const auto sizeSwapped = at<std::int32_t>(0);
        if (sizeSwapped == 540) fail("NIfTI-2 is not supported", "convert it to NIfTI-1, MetaImage or NRRD");
        if (sizeSwapped != 348)
            throw notOfFormat("a NIfTI file", path, {reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size()});
        if (std::memcmp(m_bytes.data() + 344, "ni1", 4) == 0)
            fail("this is the header of a .hdr/.img pair", "convert it to one .nii file");
        if (std::memcmp(m_bytes.data() + 344, "n+1", 4) != 0)
            fail("the header lacks the mark of NIfTI-1", "convert an Analyze file to NIfTI first");
    }

    [[noreturn]] void fail(const std::string& what, const std::string& toDo) const {
        throw FileError(what, m_path, toDo);
    }

    const std::string& path() const { return m_path; }
    int dim(int i) const { return at<std::int16_t>(40 + 2 * static_cast<std::size_t>(i)); }
    int datatype() const { return at<std::int16_t>(70); }
    float pixdim(int i) const { return at<float>(76 + 4 * static_cast<std::size_t>(i)); }
    float voxOffset() const { return at<float>(108); }
    float slope() const { return at<float>(112); }
    float intercept() const { return at<float>(116); }
    int intent() const { return at<std::int16_t>(68); }
    int spaceUnit() const { return m_bytes[123] & 7; }
    int timeUnit() const { return m_bytes[123] & 0x38; }
    float timeOffset() const { return at<float>(136); }
    int qformCode() const { return at<std::int16_t>(252); }
    int sformCode() const { return at<std::int16_t>(254); }
    /// b, c, d of the quaternion, then the offsets.
    float qform(int i) const { return at<float>(256 + 4 * static_cast<std::size_t>(i)); }
    /// Row by row, 3 x 4.
    float sform(int row, int column) const { return at<float>(280 + 4 * static_cast<std::size_t>(4 * row + column)); }
    bool isBigEndian() const { return m_swapped != (std::endian::native == std::endian::big); }

private:
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
    bool m_swapped = false;
};

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
    const int count = header.dim(0);
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
    const bool hasQform = header.qformCode() > 0, hasSform = header.sformCode() > 0;
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

/// Millimetres of the header's unit of length.
double millimetresIn(const NiftiHeader& header) {
    constexpr int kMetre = 1, kMicrometre = 3;
    return header.spaceUnit() == kMetre ? 1e3 : header.spaceUnit() == kMicrometre ? 1e-3 : 1.0;
}

void placeGrid(FileLayout& layout, const NiftiHeader& header) {
    const int axes = std::min(header.dim(0), 3);
    const double millimetres = millimetresIn(header);
    for (int a = 1; a <= axes; ++a) {
        layout.spacing[a - 1] = header.pixdim(a);
        requireSpacing(layout.spacing[a - 1], static_cast<std::size_t>(a - 1), plainText(layout.spacing[a - 1]),
                       header.path());
    }
    if (const std::optional<Placement> placement = placementIn(header, layout.spacing, layout.notices)) {
        layout.worldAxes = WorldAxes::Patient;
        const Vec3 flip{-1, -1, 1}; // our x goes to the left, our y to the back
        for (int a = 0; a < 3; ++a) {
            layout.origin[a] = placement->origin[a] == 0 ? 0 : flip[a] * placement->origin[a] * millimetres;
            layout.directions[a] = cleanDirection(flip * placement->axes[a]);
            if (a < axes) layout.spacing[a] = placement->spacing[a];
        }
    }
    for (int a = 0; a < axes; ++a) layout.spacing[a] *= millimetres;
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
    const std::string& path = source.path;
    const std::uint64_t fileBytes = readableFileBytes(path);
    const NiftiHeader header(path);
    const NiftiType type = typeIn(header);
    FileLayout layout;
    layout.dataPath = path;
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
    const float offset = header.voxOffset();
    if (!(offset >= 0) || offset > 1e9f)
        header.fail("the header's vox_offset cannot be where the data begin", "correct vox_offset in the header");
    layout.times = timesIn(header);
    if (!step) return layout;
    const std::uint64_t start = std::max<std::uint64_t>(static_cast<std::uint64_t>(offset), kHeaderBytes);
    const bool compressed = fileHead(path, 2) == "\x1f\x8b";
    layout.encoding = compressed ? Encoding::Deflate : Encoding::Raw;
    (compressed ? layout.skip : layout.start) = start;
    requireData(layout, fileBytes - std::min(layout.start, fileBytes), valuesUpTo(layout, *step),
                "check dim and datatype in the header, or copy the file again", job);
    return layout;
}

} // namespace

VolumeFormat niftiFormat() { return {"NIfTI", {".nii", ".nii.gz"}, describeLayout<layoutOf>, readLayout<layoutOf>}; }

} // namespace pellucid
