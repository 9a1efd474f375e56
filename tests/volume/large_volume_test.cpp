// Samples that stay in their file, and volumes that are coarser than their data or a part of them.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include <zlib.h>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "support/temp_folder.h"
#include "volume/excerpt.h"
#include "volume/formats/samples.h"
#include "volume/intensity_grid.h"
#include "volume/loader.h"
#include "volume/noise.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

struct LimitedMemory {
    explicit LimitedMemory(std::uint64_t bytes) { setMemoryLimit(bytes); }
    ~LimitedMemory() { setMemoryLimit({}); }
};

template <class T>
std::string bytesOfValues(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> samplesOf(const Volume& volume) {
    const auto& samples = std::get<SampleArray<T>>(volume.samples());
    return {samples.begin(), samples.end()};
}

/// Values of any sort, the same each time.
template <class T>
std::vector<T> mixed(std::size_t count) {
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(i * 2654435761u >> 7);
    return values;
}

/// The definition, voxel by voxel. `missing` is what an invalid mean becomes.
template <class T>
std::vector<T> meansByTheBook(const std::vector<T>& data, const Int3& full, const VoxelRegion& region, int factor,
                              std::optional<double> missing, Int3& dims) {
    const Int3 size = region.hi - region.lo;
    Int3 f;
    for (int a = 0; a < 3; ++a) {
        f[a] = std::min(factor, size[a]);
        dims[a] = (size[a] + f[a] - 1) / f[a];
    }
    std::vector<T> means;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                double sum = 0;
                int count = 0;
                for (int z = k * f.z; z < std::min((k + 1) * f.z, size.z); ++z)
                    for (int y = j * f.y; y < std::min((j + 1) * f.y, size.y); ++y)
                        for (int x = i * f.x; x < std::min((i + 1) * f.x, size.x); ++x) {
                            const Int3 at = region.lo + Int3(x, y, z);
                            const double v = static_cast<double>(
                                data[static_cast<std::size_t>(at.x + full.x * (at.y + full.y * at.z))]);
                            if (!std::isfinite(v) || (missing && v == *missing)) continue;
                            sum += v;
                            ++count;
                        }
                const double mean = count > 0 ? sum / count : missing ? *missing : NAN;
                means.push_back(static_cast<T>(std::is_integral_v<T> ? std::floor(mean + 0.5) : mean));
            }
    return means;
}

} // namespace

TEST_CASE("a large raw file is mapped, and has the samples that reading it gives", "[large]") {
    const TempFolder folder;
    constexpr int kSide = 204; // 204³ · 2 bytes are just above 16 MiB
    const auto values = mixed<std::uint16_t>(kSide * kSide * kSide);
    REQUIRE(values.size() * 2 >= kMapBytes);
    const std::string bytes = bytesOfValues(values), head = "sixteen of them.";
    const std::string sizes = "204 204 204";
    const std::string nrrd =
        "NRRD0004\ntype: uint16\ndimension: 3\nsizes: " + sizes + "\nendian: little\nencoding: raw\n";
    // A comment makes the header's length even or odd.
    const auto padded = [&](const std::string& header, std::size_t odd) {
        const std::string with = header + "#\n\n";
        return with.size() % 2 == odd ? with : header + "##\n\n";
    };
    struct Case {
        std::string path;
        bool mapped;
    };
    VolumeSource raw;
    raw.path = folder.write("a.raw", head + bytes);
    raw.raw = parseRawLayout("204,204,204,u16");
    raw.raw->skipBytes = 16;
    const Volume fromRaw = loadVolume(raw);
    CHECK(fromRaw.isMapped());
    CHECK(samplesOf<std::uint16_t>(fromRaw) == values);
    raw.raw->bigEndian = true;
    const Volume swapped = loadVolume(raw);
    CHECK(!swapped.isMapped());
    CHECK(swapped.value(1) == static_cast<double>(static_cast<std::uint16_t>(values[1] << 8 | values[1] >> 8)));

    folder.write("data.raw", bytes);
    const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = " + sizes +
                             "\nElementType = MET_USHORT\nElementByteOrderMSB = False\nElementDataFile = data.raw\n";
    for (const Case& c : {Case{folder.write("even.nrrd", padded(nrrd, 0) + bytes), true},
                          Case{folder.write("odd.nrrd", padded(nrrd, 1) + bytes), false}, // no place for 16-bit numbers
                          Case{folder.write("a.mhd", meta), true}}) {
        CAPTURE(c.path);
        VolumeSource source;
        source.path = c.path;
        const Volume volume = loadVolume(source);
        CHECK(volume.isMapped() == c.mapped);
        CHECK(samplesOf<std::uint16_t>(volume) == values);
        CHECK(volume.dataRange() == fromRaw.dataRange());
    }
}

TEST_CASE("a region of a large raw file has the voxels of the whole, in either byte order", "[large]") {
    const TempFolder folder;
    const Int3 dims(230, 211, 225);
    const VoxelRegion region{{1, 2, 3}, {229, 210, 224}};
    REQUIRE(voxelCount(region.hi - region.lo) * 2 > kMapBytes + (2u << 20));
    auto values = mixed<std::uint16_t>(voxelCount(dims));
    VolumeSource raw;
    raw.path = folder.write("a.raw", "odd" + bytesOfValues(values));
    raw.raw = RawLayout{dims, SampleType::U16, false, 3};
    raw.region = region;
    for (const bool bigEndian : {false, true}) {
        CAPTURE(bigEndian);
        raw.raw->bigEndian = bigEndian;
        if (bigEndian)
            for (std::uint16_t& v : values) v = static_cast<std::uint16_t>(v << 8 | v >> 8);
        const Volume part = loadVolume(raw);
        CHECK(!part.isMapped());
        const auto samples = samplesOf<std::uint16_t>(part);
        REQUIRE(samples.size() == voxelCount(region.hi - region.lo));
        std::size_t n = 0, wrong = 0;
        for (int k = region.lo.z; k < region.hi.z; ++k)
            for (int j = region.lo.y; j < region.hi.y; ++j)
                for (int i = region.lo.x; i < region.hi.x; ++i)
                    wrong += samples[n++] != values[voxelIndex(dims, i, j, k)];
        CHECK(wrong == 0);
    }
    // One that is too short is refused, and not read beyond its end.
    folder.write("a.raw", std::string(1000, 'x'));
    CHECK_THROWS_AS(loadVolume(raw), FileError);
}

TEST_CASE("small files are read: they may change while they are in use", "[large]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.raw", "abcdefgh");
    source.raw = parseRawLayout("2,2,2,u8");
    const Volume volume = loadVolume(source);
    CHECK(!volume.isMapped());
    folder.write("a.raw", "x");
    CHECK(volume.value(7) == 'h');
}

TEST_CASE("samples of 8 bits are their own codes, however they were read", "[large]") {
    const TempFolder folder;
    const Int3 dims(16, 8, 8);
    std::string bytes;
    for (std::size_t i = 0; i < voxelCount(dims); ++i) bytes += static_cast<char>(i % 256);
    VolumeSource source;
    source.raw = RawLayout{dims, SampleType::U8, false, 0};
    source.path = folder.write("plain.raw", bytes);
    CHECK(samplesAreNarrowCodes(loadVolume(source)));
    source.region = VoxelRegion{{0, 0, 2}, {16, 8, 6}};
    CHECK(samplesAreNarrowCodes(loadVolume(source)));
    source.region.reset();
    source.raw->skipBytes = 3;
    source.path = folder.path("packed.raw.gz");
    gzFile packed = gzopen(source.path.c_str(), "wb");
    gzwrite(packed, "abc", 3);
    gzwrite(packed, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(packed);
    const Volume unpacked = loadVolume(source);
    CHECK(samplesAreNarrowCodes(unpacked));
    CHECK(samplesOf<std::uint8_t>(unpacked) == std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
    // Values of two components, one of which is taken.
    VolumeSource component;
    component.path = folder.write("two.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 8 8 8\n"
                                              "kinds: vector domain domain domain\nencoding: raw\n\n" +
                                                  bytes);
    CHECK(samplesAreNarrowCodes(loadVolume(component)));
}

TEST_CASE("a mapping has the file's bytes and zeros behind them", "[large]") {
    const TempFolder folder;
    const std::string path = folder.write("a.raw", std::string(8192, 'a') + "bc");
    const auto file = MappedFile::map(path, 4097, 4097); // to the end, from no page's beginning
    REQUIRE(file);
    CHECK(file->size() == 4097);
    CHECK(file->data()[0] == 'a');
    CHECK(file->data()[4096] == 'c');
    for (std::size_t i = 0; i < MappedFile::kPadding; ++i) CHECK(file->data()[file->size() + i] == 0);
    std::filesystem::remove(path); // the name goes, the bytes stay
    CHECK(file->data()[4095] == 'b');
    CHECK(!MappedFile::map(path, 0, 1));
    const std::string page = folder.write("page.raw", std::string(4096, 'p')); // the padding lies beyond its last page
    const auto whole = MappedFile::map(page, 0, 4096);
    REQUIRE(whole);
    CHECK(whole->data()[4096 + MappedFile::kPadding - 1] == 0);
    CHECK(!MappedFile::map(page, 1, 4096)); // longer than the file
}

TEMPLATE_TEST_CASE("downsampling takes the means of blocks", "[large]", std::uint8_t, std::int16_t, std::uint32_t,
                   float, double) {
    const TempFolder folder;
    const Int3 full(11, 7, 5); // 2 divides none of them, 3 none either
    auto data = mixed<TestType>(voxelCount(full));
    for (std::size_t i = 0; i < data.size(); i += 3) data[i] = TestType(7); // missing, most of all in the first block:
    for (const std::size_t i : {0u, 1u, 11u, 12u, 77u, 78u, 88u, 89u}) data[i] = TestType(7);
    const auto name = findNamed<SampleType>(std::is_same_v<TestType, float>    ? "f32"
                                            : std::is_same_v<TestType, double> ? "f64"
                                            : sizeof(TestType) == 1            ? "u8"
                                            : sizeof(TestType) == 2            ? "i16"
                                                                               : "u32");
    VolumeSource source;
    source.path = folder.write("a.raw", bytesOfValues(data));
    source.raw = RawLayout{full, *name, false, 0};
    source.spacing = GridSpacing{{0.5, 1, 2}};
    for (const int factor : {1, 2, 3, 6, 100})
        for (const VoxelRegion& region : {VoxelRegion{{0, 0, 0}, full}, VoxelRegion{{2, 1, 1}, {9, 7, 4}}})
            for (const bool missing : {false, true}) {
                CAPTURE(factor, region.lo.x, missing);
                source.downsample = factor;
                source.region = region;
                source.missing.reset();
                if (missing) source.missing = 7;
                Int3 dims;
                const auto expected = meansByTheBook(data, full, region, factor, source.missing, dims);
                const Volume volume = loadVolume(source);
                REQUIRE(volume.dims() == dims);
                CHECK(static_cast<SampleType>(volume.sampleType()) == *name);
                // A mean that happens to be the missing value is moved to a neighbour; there is none such here but by
                // rounding.
                const auto samples = samplesOf<TestType>(volume);
                std::size_t off = 0;
                for (std::size_t i = 0; i < samples.size(); ++i)
                    if (!(samples[i] == expected[i])) ++off;
                CHECK(off == 0);
                const bool whole = factor == 1 && region.lo == Int3(0);
                CHECK(volume.excerpt.has_value() == !whole);
                if (!whole) {
                    CHECK(volume.excerpt->fullDims == full);
                    CHECK(volume.excerpt->region == region);
                    CHECK(!volume.excerpt->forMemory);
                }
            }
}

TEST_CASE("a downsampled volume lies where its data lie", "[large]") {
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 24;
    const Volume full = loadVolume(source);
    const Geometry& g = full.geometry();
    source.downsample = 2;
    REQUIRE(g.dims.x % 2 == 0);
    const Geometry half = loadVolume(source).geometry();
    CHECK(half.dims == g.dims / 2);
    CHECK(half.spacing == 2.0 * g.spacing);
    // The first voxel stands for the first two: its centre lies between theirs. The box is the same.
    CHECK(glm::length(half.worldFromVoxel(Vec3(0)) - g.worldFromVoxel(Vec3(0.5))) < 1e-12);
    CHECK(glm::length(half.worldFromVoxel(Vec3(half.dims) - 0.5) - g.worldFromVoxel(Vec3(g.dims) - 0.5)) < 1e-12);
    CHECK(glm::length(half.worldFromVoxel(Vec3(-0.5)) - g.worldFromVoxel(Vec3(-0.5))) < 1e-12);
    source.downsample = 0;
    source.region = VoxelRegion{{4, 5, 6}, {10, 12, 24}};
    const Volume part = loadVolume(source);
    CHECK(part.dims() == Int3(6, 7, 18));
    CHECK(glm::length(part.geometry().worldFromVoxel(Vec3(0)) - g.worldFromVoxel(Vec3(4, 5, 6))) < 1e-12);
    CHECK(part.value(0) == full.value(static_cast<std::size_t>(4 + g.dims.x * (5 + g.dims.y * 6))));
    CHECK(part.range() == full.range()); // intensities mean what they did
}

TEST_CASE("what is invalid stays so, and nothing becomes it", "[large]") {
    const Geometry line{{4, 1, 1}, {1, 1, 1}, {0, 0, 0}};
    const auto half = [&](Samples samples, std::optional<double> missing) {
        VolumeSource source;
        source.downsample = 2;
        const Volume whole(line, std::move(samples), missing);
        return excerptOf(whole, planExcerpt(source, line.dims, whole.sampleType(), false));
    };
    // (0 + 2)/2 is the missing value 1: it becomes 2, since halves go up; (1, 1) is invalid.
    const Volume ints = half(std::vector<std::uint8_t>{0, 2, 1, 1}, 1);
    CHECK(ints.value(0) == 2);
    CHECK(ints.isValid(0));
    CHECK(!ints.isValid(1));
    const Volume floats = half(std::vector<float>{NAN, 3, NAN, INFINITY}, {});
    CHECK(floats.value(0) == 3);
    CHECK(!floats.isValid(1));
    CHECK(ints.invalidCount() == 1);
    // One axis of two became one voxel; the others are as long as they were.
    CHECK(floats.geometry().spacing == Vec3(2, 1, 1));
}

TEST_CASE("the window of a downsampled volume is that of its data", "[large]") {
    const TempFolder folder;
    std::string data(64, '\x64'); // 100 everywhere, one 0 and one 200
    data[0] = '\0';
    data[63] = '\xc8';
    VolumeSource source;
    source.path = folder.write("a.raw", data);
    source.raw = parseRawLayout("4,4,4,u8");
    source.downsample = 4;
    const Volume one = loadVolume(source);
    CHECK(one.value(0) == 100); // (62·100 + 0 + 200)/64
    CHECK(one.range() == ValueRange{0, 200});
    CHECK(one.intensity(0) == 0.5);
}

TEST_CASE("what exceeds memory is downsampled by the smallest factor that fits, and says so", "[large]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.raw", std::string(64 * 64 * 64, 'x') + "y");
    source.raw = parseRawLayout("64,64,64,u8");
    source.raw->skipBytes = 1;
    // 64³ voxels need 26 GB, 32³ 3.3 GB, 22³ (a third) 1.1 GB; there are 3 GB less what the program takes.
    source.then = {"measuring", 1e5};
    const LimitedMemory limit(3'000'000'000);
    const Volume volume = loadVolume(source);
    CHECK(volume.dims() == Int3(22));
    REQUIRE(volume.excerpt);
    CHECK(volume.excerpt->factor == 3);
    CHECK(volume.excerpt->forMemory);
    REQUIRE(!volume.notices.empty());
    CHECK_THAT(volume.notices[0], Contains("downsampled by 3 to 22 x 22 x 22 voxels: all 64 x 64 x 64 need 26.2 GB") &&
                                      Contains("at full resolution"));
    source.region = VoxelRegion{{0, 0, 0}, {20, 20, 20}}; // 8000 voxels need 0.8 GB
    CHECK(loadVolume(source).dims() == Int3(20));
    source.downsample = 1;
    CHECK(loadVolume(source).dims() == Int3(20));
    source.region.reset();
    CHECK_THROWS_WITH(loadVolume(source), Contains("needs 26.2 GB"));
    source.then = {"measuring", 1e12}; // not even one voxel
    source.downsample = 0;
    CHECK_THROWS_AS(loadVolume(source), FileError);
}

TEST_CASE("a region must lie in the data", "[large]") {
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 16;
    for (const VoxelRegion& bad : {VoxelRegion{{0, 0, 0}, {17, 16, 16}}, VoxelRegion{{-1, 0, 0}, {4, 4, 4}},
                                   VoxelRegion{{4, 0, 0}, {4, 4, 4}}, VoxelRegion{{5, 0, 0}, {4, 4, 4}}}) {
        source.region = bad;
        CHECK_THROWS_AS(loadVolume(source), UsageError);
    }
}

TEST_CASE("what a box leaves of a downsampled volume is a region of its data", "[large]") {
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 24;
    const Int3 full = loadVolume(source).dims();
    source.downsample = 5; // which does not divide 24: the box is 25 voxels long
    REQUIRE(full.x == 24);
    const VoxelRegion all = regionBetween(loadVolume(source), Vec3(0), Vec3(1));
    CHECK(all == VoxelRegion{{0, 0, 0}, full});
    const VoxelRegion part = regionBetween(loadVolume(source), Vec3(0.2, 0.25, 0), Vec3(0.4, 0.5, 0.01));
    CHECK(part.lo.x == 5); // 0.2 · 25
    CHECK(part.hi.x == 10);
    CHECK(part.lo.z == 0);
    CHECK(part.hi.z == 1);
    source.region = VoxelRegion{{4, 4, 4}, {14, 14, 8}}; // 2 voxels along x and y, and one of 4 along z
    const VoxelRegion inner = regionBetween(loadVolume(source), Vec3(0.5), Vec3(1));
    CHECK(inner == VoxelRegion{{9, 9, 6}, {14, 14, 8}});
}

TEST_CASE("mapped 8-bit samples are their own codes", "[large]") {
    const TempFolder folder;
    VolumeSource source;
    std::string bytes(256 * 256 * 256, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31 >> 5);
    source.path = folder.write("a.raw", bytes);
    source.raw = parseRawLayout("256,256,256,u8");
    const Volume volume = loadVolume(source);
    REQUIRE(volume.isMapped());
    const auto& samples = std::get<SampleArray<std::uint8_t>>(volume.samples());
    const IntensityGrid grid = makeIntensityGrid(volume, CodeWidth::Narrow);
    CHECK(grid.codes.narrow() == samples.data());
    CHECK(grid.maxCode == 255);
    // Where the window cuts values off they are codes of their own.
    const IntensityGrid cut = makeIntensityGrid(volume.withRange({0, 100}), CodeWidth::Narrow);
    REQUIRE(cut.codes.isNarrow());
    CHECK(cut.codes.narrow() != samples.data());
    CHECK(cut.codes[8] == std::min<int>(100, samples[8]));
}
