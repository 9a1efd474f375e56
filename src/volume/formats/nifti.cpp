// NIfTI-1 in one file, plain or gzip-compressed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include <zlib.h>

#include "volume/formats/file_check.h"
#include "volume/formats/itk_image.h"
#include "volume/formats/reader.h"

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
    explicit NiftiHeader(const std::string& path) : m_bytes(headerBytes(path)) {
        const auto foreign = [&](std::string_view sort) {
            return FileError("this is not a NIfTI file but " + std::string(sort), path,
                             "give it the suffix of its own format", Remedy::GiveRawLayout);
        };
        if (m_bytes.size() < kHeaderBytes) {
            const std::string head = fileHead(path, 1024);
            if (head.rfind("\x1f\x8b", 0) == 0)
                throw FileError("the compressed file holds " + std::to_string(m_bytes.size()) +
                                    " readable bytes, fewer than a NIfTI header",
                                path, "copy the file again");
            throw foreign(describeContent(head));
        }
        const auto size = at<std::int32_t>(0);
        m_swapped = size != 348 && size != 540;
        const auto sizeSwapped = at<std::int32_t>(0);
        if (sizeSwapped == 540)
            throw FileError("NIfTI-2 is not supported", path, "convert it to NIfTI-1, MetaImage or NRRD");
        if (sizeSwapped != 348)
            throw foreign(describeContent({reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size()}));
        if (std::memcmp(m_bytes.data() + 344, "ni1", 4) == 0)
            throw FileError("this is the header of a .hdr/.img pair", path, "convert it to one .nii file");
        if (std::memcmp(m_bytes.data() + 344, "n+1", 4) != 0)
            throw FileError("the header lacks the mark of NIfTI-1", path, "convert an Analyze file to NIfTI first");
    }

    int dim(int i) const { return at<std::int16_t>(40 + 2 * static_cast<std::size_t>(i)); }
    int datatype() const { return at<std::int16_t>(70); }
    float pixdim(int i) const { return at<float>(76 + 4 * static_cast<std::size_t>(i)); }
    float voxOffset() const { return at<float>(108); }

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

    std::vector<unsigned char> m_bytes;
    bool m_swapped = false;
};

struct NiftiType {
    std::uint64_t components, bytes;
};

NiftiType typeOf(int code, const std::string& path) {
    static const std::map<int, NiftiType> kTypes{
        {2, {1, 1}},   {4, {1, 2}},   {8, {1, 4}},   {16, {1, 4}},   {32, {2, 4}},   {64, {1, 8}},   {128, {3, 1}},
        {256, {1, 1}}, {512, {1, 2}}, {768, {1, 4}}, {1024, {1, 8}}, {1280, {1, 8}}, {1792, {2, 8}}, {2304, {4, 1}}};
    const auto it = kTypes.find(code);
    if (it != kTypes.end()) return it->second;
    throw FileError("the NIfTI data type " + std::to_string(code) + " is not supported", path,
                    "convert it to integers of 8 to 64 bits, float or double");
}

HeaderClaim checkedClaim(const std::string& path, const JobControl& job) {
    const std::uint64_t fileBytes = readableFileBytes(path);
    const NiftiHeader header(path);
    const int axes = header.dim(0);
    if (axes < 1 || axes > 7)
        throw FileError("the header gives " + std::to_string(axes) + " axes, not 1 to 7", path, "correct the header");
    const NiftiType type = typeOf(header.datatype(), path);
    std::vector<std::int64_t> sizes;
    for (int a = 1; a <= axes; ++a) sizes.push_back(header.dim(a));
    sizes.push_back(static_cast<std::int64_t>(type.components));
    HeaderClaim claim;
    claim.dataPath = path;
    claim.bytesPerValue = type.bytes;
    claim.values = valueCount(path, sizes, type.bytes);
    for (int a = 1; a <= std::min(axes, 3); ++a)
        if (!(header.pixdim(a) > 0) || !std::isfinite(header.pixdim(a)))
            throw FileError("the spacing of axis " + std::to_string(a - 1) + " is " + std::to_string(header.pixdim(a)) +
                                ", it must be positive and finite",
                            path, "correct pixdim in the header");

    const float offset = header.voxOffset();
    if (!(offset >= 0) || offset > 1e9f)
        throw FileError("the header gives a wrong place of the data", path, "correct vox_offset in the header");
    const std::string magic = fileHead(path, 2);
    const bool compressed = magic == "\x1f\x8b";
    const std::uint64_t start = std::max<std::uint64_t>(static_cast<std::uint64_t>(offset), kHeaderBytes);
    const std::uint64_t stored = compressed ? fileBytes : fileBytes - std::min(start, fileBytes);
    requireStored(path, compressed ? Encoding::Deflate : Encoding::Raw, claim.values, claim.bytesPerValue, stored,
                  "check dim and datatype in the header, or copy the file again");
    const std::uint64_t bytes = claim.values * claim.bytesPerValue;
    if (compressed) requireInflates(path, 0, false, start + bytes, job);
    if (!compressed && stored > bytes)
        claim.notices.push_back("the data has " + std::to_string(stored - bytes) + " bytes more than the header says");
    return claim;
}

class NiftiReader final : public VolumeReader {
public:
    const char* name() const override { return "NIfTI"; }
    const std::vector<std::string>& suffixes() const override {
        static const std::vector<std::string> kSuffixes{".nii", ".nii.gz"};
        return kSuffixes;
    }
    Volume read(const VolumeSource& source, const JobControl& job) const override {
        const HeaderClaim claim = checkedClaim(source.path, job);
        return readWithItk(ItkFormat::Nifti, source, claim, job);
    }
};

} // namespace

const VolumeReader& niftiReader() {
    static const NiftiReader reader;
    return reader;
}

} // namespace pellucid
