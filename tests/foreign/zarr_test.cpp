// Zarr and OME-Zarr through pellucid-array-reader. Chunks are packed by the libraries of their formats.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>

#include <blosc.h>
#include <lz4.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <zstd.h>

#include "base/memory.h"
#include "support/notices.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/series.h"
#include "volume/volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

VolumeSource at(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

using Pack = std::function<std::string(const std::string&)>;

std::string packedByZstd(const std::string& bytes) {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
    return packed;
}
std::string packedByLz4(const std::string& bytes) {
    std::string packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))) + 4, '\0');
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(packed.data(), &size, 4);
    packed.resize(4 + static_cast<std::size_t>(LZ4_compress_default(bytes.data(), packed.data() + 4,
                                                                    static_cast<int>(bytes.size()),
                                                                    static_cast<int>(packed.size() - 4))));
    return packed;
}
std::string packedByBlosc(const std::string& bytes, const char* codec) {
    std::string packed(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
    packed.resize(static_cast<std::size_t>(blosc_compress_ctx(5, BLOSC_SHUFFLE, 2, bytes.size(), bytes.data(),
                                                              packed.data(), packed.size(), codec, 0, 1)));
    return packed;
}

std::uint32_t crc32c(const std::string& bytes) {
    std::uint32_t sum = ~0u;
    for (const char byte : bytes) {
        sum ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 1u) != 0 ? sum >> 1 ^ 0x82f63b78u : sum >> 1;
    }
    return ~sum;
}

void write(const std::string& path, const std::string& bytes) {
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
}

/// The value of a voxel in all arrays here.
std::uint16_t valueAt(int x, int y, int z) { return static_cast<std::uint16_t>(1000 * z + 100 * y + x); }

/// A chunk of an array of dims.x · dims.y · dims.z voxels; beyond these it has 9999.
std::string chunkAt(const Int3& dims, const Int3& chunk, const Int3& index) {
    std::vector<std::uint16_t> values;
    for (int z = 0; z < chunk.z; ++z)
        for (int y = 0; y < chunk.y; ++y)
            for (int x = 0; x < chunk.x; ++x) {
                const Int3 v = index * chunk + Int3(x, y, z);
                const bool isIn = v.x < dims.x && v.y < dims.y && v.z < dims.z;
                values.push_back(isIn ? valueAt(v.x, v.y, v.z) : std::uint16_t{9999});
            }
    return bytesOf(values);
}

const Int3 kDims{7, 5, 6}, kChunk{4, 3, 2};

void forEachChunk(const std::function<void(const Int3& index)>& body) {
    const Int3 count = (kDims - 1) / kChunk + 1;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) body({x, y, z});
}

json metadata2(const json& compressor, const std::string& separator = ".") {
    return {{"zarr_format", 2},
            {"shape", {kDims.z, kDims.y, kDims.x}},
            {"chunks", {kChunk.z, kChunk.y, kChunk.x}},
            {"dtype", "<u2"},
            {"compressor", compressor},
            {"fill_value", 0},
            {"order", "C"},
            {"filters", nullptr},
            {"dimension_separator", separator}};
}

/// An array of version 2.
void writeArray(const std::string& path, const json& metadata, const Pack& pack) {
    write(path + "/.zarray", metadata.dump());
    const std::string separator = metadata["dimension_separator"];
    forEachChunk([&](const Int3& i) {
        write(path + "/" + std::to_string(i.z) + separator + std::to_string(i.y) + separator + std::to_string(i.x),
              pack(chunkAt(kDims, kChunk, i)));
    });
}
std::string asItIs(const std::string& bytes) { return bytes; }

json metadata3(const json& codecs) {
    return {{"zarr_format", 3},
            {"node_type", "array"},
            {"shape", {kDims.z, kDims.y, kDims.x}},
            {"data_type", "uint16"},
            {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", {kChunk.z, kChunk.y, kChunk.x}}}}}},
            {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
            {"fill_value", 0},
            {"codecs", codecs},
            {"attributes", json::object()}};
}
const json kBytes{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}};

void requireValues(const Volume& volume) {
    REQUIRE(volume.dims() == kDims);
    REQUIRE(volume.sampleType() == SampleType::U16);
    std::size_t wrong = 0, n = 0;
    for (int z = 0; z < kDims.z; ++z)
        for (int y = 0; y < kDims.y; ++y)
            for (int x = 0; x < kDims.x; ++x) wrong += volume.value(n++) != valueAt(x, y, z) ? 1u : 0u;
    CHECK(wrong == 0);
}

/// An image of one array "0" with axes z, y, x.
json image(const json& transformations = json::array(), const std::string& unit = "") {
    json axes = json::array();
    for (const char* name : {"z", "y", "x"}) {
        axes.push_back({{"name", name}, {"type", "space"}});
        if (!unit.empty()) axes.back()["unit"] = unit;
    }
    return {{"multiscales",
             {{{"version", "0.4"},
               {"axes", axes},
               {"datasets", {{{"path", "0"}, {"coordinateTransformations", transformations}}}}}}}};
}

std::string errorOf(const VolumeSource& source) {
    try {
        static_cast<void>(loadVolume(source));
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

} // namespace

TEST_CASE("chunks of Zarr are unpacked, whatever they are packed by", "[zarr]") {
    const TempFolder folder;
    const std::vector<std::pair<json, Pack>> ways{
        {nullptr, asItIs},
        {{{"id", "gzip"}}, gzipped},
        {{{"id", "zlib"}}, zlibbed},
        {{{"id", "zstd"}}, packedByZstd},
        {{{"id", "lz4"}}, packedByLz4},
        {{{"id", "blosc"}}, [](const std::string& bytes) { return packedByBlosc(bytes, "lz4"); }},
        {{{"id", "blosc"}}, [](const std::string& bytes) { return packedByBlosc(bytes, "zstd"); }},
        {{{"id", "blosc"}}, [](const std::string& bytes) { return packedByBlosc(bytes, "blosclz"); }}};
    int n = 0;
    for (const auto& [compressor, pack] : ways)
        for (const char* separator : {".", "/"}) {
            CAPTURE(compressor.dump(), separator);
            const std::string path = folder.path(std::to_string(n++) + ".zarr");
            writeArray(path, metadata2(compressor, separator), pack);
            const Volume volume = loadVolume(at(path));
            requireValues(volume);
            CHECK(volume.format == "OME-Zarr");
        }
    // Where the folder has another name.
    const std::string path = folder.path("anything");
    writeArray(path, metadata2(nullptr), asItIs);
    requireValues(loadVolume(at(path)));
}

TEST_CASE("types, byte orders and the order of axes of Zarr are read right", "[zarr]") {
    const TempFolder folder;
    const auto loaded = [&](const std::string& type, const std::string& bytes, const std::string& order = "C") {
        static int s_n = 0;
        const std::string path = folder.path("t" + std::to_string(s_n++) + ".zarr");
        json metadata = metadata2(nullptr);
        metadata["shape"] = metadata["chunks"] = {1, 2, 3};
        metadata["dtype"] = type;
        metadata["order"] = order;
        write(path + "/.zarray", metadata.dump());
        write(path + "/0.0.0", bytes);
        const Volume volume = loadVolume(at(path));
        std::vector<double> values;
        for (std::size_t i = 0; i < volume.size(); ++i) values.push_back(volume.value(i));
        return values;
    };
    using Values = std::vector<double>;
    CHECK(loaded("|u1", bytesOf<std::uint8_t>({0, 1, 2, 3, 4, 255})) == Values{0, 1, 2, 3, 4, 255});
    CHECK(loaded("|i1", bytesOf<std::int8_t>({-128, 1, 2, 3, 4, 127})) == Values{-128, 1, 2, 3, 4, 127});
    CHECK(loaded("|b1", bytesOf<std::uint8_t>({0, 1, 0, 1, 1, 0})) == Values{0, 1, 0, 1, 1, 0});
    CHECK(loaded(">u2", std::string("\x01\x02\0\0\0\1\0\2\0\3\xff\xff", 12)) == Values{258, 0, 1, 2, 3, 65535});
    CHECK(loaded("<i2", bytesOf<std::int16_t>({-32768, 0, 1, 2, 3, 32767})) == Values{-32768, 0, 1, 2, 3, 32767});
    CHECK(loaded("<u8", bytesOf<std::uint64_t>({1ull << 40, 0, 1, 2, 3, 4})) ==
          Values{std::ldexp(1.0, 40), 0, 1, 2, 3, 4});
    CHECK(loaded("<f4", bytesOf<float>({0.5f, 0, 1, 2, 3, -4})) == Values{0.5, 0, 1, 2, 3, -4});
    CHECK(loaded("<f8", bytesOf<double>({0.1, 0, 1, 2, 3, -4})) == Values{0.1, 0, 1, 2, 3, -4});
    // Halves: 1, −2, 0.5, the smallest 2^−24, 65504, 0 (IEEE 754, binary16).
    CHECK(loaded("<f2", bytesOf<std::uint16_t>({0x3c00, 0xc000, 0x3800, 0x0001, 0x7bff, 0})) ==
          Values{1, -2, 0.5, std::ldexp(1.0, -24), 65504, 0});
    // Columns first: element (y, x) at y + 2 x.
    CHECK(loaded("|u1", bytesOf<std::uint8_t>({0, 3, 1, 4, 2, 5}), "F") == Values{0, 1, 2, 3, 4, 5});
}

TEST_CASE("chunks that are not stored have the fill value", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    json metadata = metadata2(nullptr);
    metadata["fill_value"] = 65535;
    writeArray(path, metadata, asItIs);
    fs::remove(path + "/2.1.1"); // voxels from (4, 3, 4) on
    const Volume volume = loadVolume(at(path));
    CHECK(volume.value(voxelIndex(kDims, 4, 3, 4)) == 65535);
    CHECK(volume.value(voxelIndex(kDims, 6, 4, 5)) == 65535);
    CHECK(volume.value(voxelIndex(kDims, 3, 3, 4)) == valueAt(3, 3, 4));
}

TEST_CASE("version 3 of Zarr, with steps in a row and shards", "[zarr]") {
    const TempFolder folder;
    const auto with = [&](const std::string& name, const json& codecs, const Pack& pack) {
        write(folder.path(name) + "/zarr.json", metadata3(codecs).dump());
        forEachChunk([&](const Int3& i) {
            write(folder.path(name) + "/c/" + std::to_string(i.z) + "/" + std::to_string(i.y) + "/" +
                      std::to_string(i.x),
                  pack(chunkAt(kDims, kChunk, i)));
        });
        return loadVolume(at(folder.path(name)));
    };
    requireValues(with("raw", json::array({kBytes}), asItIs));
    requireValues(with("gzip", {kBytes, {{"name", "gzip"}}}, gzipped));
    requireValues(with("sums", {kBytes, {{"name", "zstd"}}, {{"name", "crc32c"}}}, [](const std::string& bytes) {
        const std::string packed = packedByZstd(bytes);
        return packed + bytesOf<std::uint32_t>({crc32c(packed)});
    }));

    // Two chunks along each axis in a shard; what has none of the array is not stored.
    json codecs{{{"name", "sharding_indexed"},
                 {"configuration",
                  {{"chunk_shape", {kChunk.z, kChunk.y, kChunk.x}},
                   {"codecs", {kBytes, {{"name", "zstd"}}}},
                   {"index_codecs", {kBytes, {{"name", "crc32c"}}}},
                   {"index_location", "end"}}}}};
    json metadata = metadata3(codecs);
    metadata["chunk_grid"]["configuration"]["chunk_shape"] = {2 * kChunk.z, 2 * kChunk.y, 2 * kChunk.x};
    const std::string path = folder.path("shards");
    write(path + "/zarr.json", metadata.dump());
    for (int shard = 0; shard < 2; ++shard) { // along z: kDims has 2 x 2 x 3 chunks
        std::string body, table;
        for (int n = 0; n < 8; ++n) {
            const Int3 i(n & 1, n >> 1 & 1, (n >> 2) + 2 * shard);
            if (i.z * kChunk.z >= kDims.z) {
                table += std::string(16, '\xff');
                continue;
            }
            const std::string chunk = packedByZstd(chunkAt(kDims, kChunk, i));
            table += bytesOf<std::uint64_t>({body.size(), chunk.size()});
            body += chunk;
        }
        write(path + "/c/" + std::to_string(shard) + "/0/0", body + table + bytesOf<std::uint32_t>({crc32c(table)}));
    }
    requireValues(loadVolume(at(path)));
    // The table is damaged.
    std::string bytes = [&] {
        std::ifstream in(path + "/c/1/0/0", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    bytes[bytes.size() - 20] ^= 1;
    write(path + "/c/1/0/0", bytes);
    CHECK_THAT(errorOf(at(path)), Contains("its checksum is wrong"));
    write(path + "/c/1/0/0", bytes.substr(0, 20));
    CHECK_THAT(errorOf(at(path)), Contains("shorter than its own table"));
}

TEST_CASE("OME-Zarr says where voxels lie", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    writeArray(path + "/0", metadata2(nullptr), asItIs);
    const json scale{{"type", "scale"}, {"scale", {4, 2, 0.5}}},
        moved{{"type", "translation"}, {"translation", {30, 20, 10}}};
    write(path + "/.zattrs", image({scale, moved}, "micrometer").dump());
    const Volume volume = loadVolume(at(path));
    requireValues(volume);
    CHECK(volume.geometry().spacing == Vec3(0.5, 2, 4));
    CHECK(volume.geometry().origin == Vec3(10, 20, 30));
    CHECK(volume.geometry().worldAxes == WorldAxes::File);
    CHECK(volume.geometry().lengthUnit == LengthUnit::Micrometre);
    // In the unit of the first axis that has one.
    json other = image(json::array({scale}), "micrometer");
    other["multiscales"][0]["axes"][0]["unit"] = "nanometer";
    write(path + "/.zattrs", other.dump());
    CHECK(loadVolume(at(path)).geometry().spacing == Vec3(0.5, 2, 0.004));
    // Metadata of NGFF 0.5 lie in zarr.json.
    fs::remove(path + "/.zattrs");
    fs::remove_all(path + "/0");
    write(path + "/zarr.json",
          json{{"zarr_format", 3}, {"node_type", "group"}, {"attributes", {{"ome", image({scale, moved})}}}}.dump());
    write(path + "/0/zarr.json", metadata3(json::array({kBytes})).dump());
    forEachChunk([&](const Int3& i) {
        write(path + "/0/c/" + std::to_string(i.z) + "/" + std::to_string(i.y) + "/" + std::to_string(i.x),
              chunkAt(kDims, kChunk, i));
    });
    const Volume newer = loadVolume(at(path));
    requireValues(newer);
    CHECK(newer.geometry().origin == Vec3(10, 20, 30));
}

TEST_CASE("times and channels of OME-Zarr are steps and components", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    json metadata = metadata2(nullptr);
    metadata["shape"] = {2, 3, 1, 2, 2}; // t, c, z, y, x
    metadata["chunks"] = {1, 1, 1, 2, 2};
    metadata["dtype"] = "|u1";
    write(path + "/0/.zarray", metadata.dump());
    for (int t = 0; t < 2; ++t)
        for (int c = 0; c < 3; ++c)
            write(path + "/0/" + std::to_string(t) + "." + std::to_string(c) + ".0.0.0",
                  std::string(4, static_cast<char>(10 * t + c)));
    json axes = json::array();
    for (const auto& [name, type] :
         {std::pair{"t", "time"}, {"c", "channel"}, {"z", "space"}, {"y", "space"}, {"x", "space"}})
        axes.push_back({{"name", name}, {"type", type}});
    axes[0]["unit"] = "millisecond";
    const json multiscale{
        {"axes", axes},
        {"datasets",
         {{{"path", "0"}, {"coordinateTransformations", {{{"type", "scale"}, {"scale", {500, 1, 1, 1, 1}}}}}}}}};
    write(path + "/.zattrs", json{{"multiscales", {multiscale}}}.dump());
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.steps == 2);
    CHECK(contents.components == 3);
    CHECK(contents.times == std::vector<double>{0, 0.5});
    CHECK(contents.timeUnit == "s");
    VolumeSource source = at(path);
    source.step = 1;
    source.component = 2;
    const Volume volume = loadVolume(source);
    CHECK(volume.value(0) == 12);
    CHECK(volume.value(3) == 12);
    CHECK(hasNotice(volume, "component 2 of 3"));
    source.component = 3;
    CHECK_THAT(errorOf(source), Contains("component"));
}

TEST_CASE("a coarser copy in the file is read where one is wanted", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    // Levels of 8, 4 and 2 voxels along each axis; each says by its values which one it is.
    json datasets = json::array();
    for (int level = 0; level < 3; ++level) {
        const int size = 8 >> level;
        json metadata = metadata2(nullptr);
        metadata["shape"] = metadata["chunks"] = {size, size, size};
        metadata["dtype"] = "|u1";
        const std::string name = std::to_string(level);
        write(path + "/" + name + "/.zarray", metadata.dump());
        std::string values;
        for (int i = 0; i < size * size * size; ++i)
            values += static_cast<char>(level == 0 ? i % 8 : 100 * level + i % size);
        write(path + "/" + name + "/0.0.0", values);
        const int f = 1 << level;
        datasets.push_back(
            {{"path", name}, {"coordinateTransformations", {{{"type", "scale"}, {"scale", {f, f, f}}}}}});
    }
    json whole = image();
    whole["multiscales"][0]["datasets"] = datasets;
    write(path + "/.zattrs", whole.dump());
    VolumeSource source = at(path);
    CHECK(loadVolume(source).value(7) == 7); // it is small
    source.downsample = 2;
    const Volume half = loadVolume(source);
    CHECK(half.dims() == Int3(4));
    CHECK(half.value(1) == 101);
    CHECK(half.geometry().spacing == Vec3(2));
    CHECK(half.geometry().origin == Vec3(0.5)); // between the first two voxels
    REQUIRE(half.excerpt);
    CHECK(half.excerpt->fullDims == Int3(8));
    CHECK(half.excerpt->factor == 2);
    CHECK(hasNotice(half, "coarser copy in the file"));
    // A region that the level does not cut: voxels 2 … 5 of the data.
    source.region = VoxelRegion{{2, 2, 2}, {6, 6, 6}};
    const Volume part = loadVolume(source);
    CHECK(part.dims() == Int3(2));
    CHECK(part.value(0) == 101);
    CHECK(part.geometry().origin == Vec3(2.5));
    // One that it does: means of the data themselves, (1 + 2) / 2 rounded up.
    source.region = VoxelRegion{{1, 0, 0}, {5, 4, 4}};
    CHECK(loadVolume(source).value(0) == 2);
    // By three of the data; by eight of the coarsest level, (200 + 201) / 2.
    source.region = {};
    source.downsample = 3;
    CHECK(loadVolume(source).value(0) == 1);
    source.downsample = 8;
    const Volume one = loadVolume(source);
    CHECK(one.dims() == Int3(1));
    CHECK(one.value(0) == 201);
}

TEST_CASE("a level of OME-Zarr lies where the file says", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    json datasets = json::array();
    for (int level = 0; level < 2; ++level) {
        const int size = 8 >> level, f = 1 << level;
        json metadata = metadata2(nullptr);
        metadata["shape"] = metadata["chunks"] = {size, size, size};
        metadata["dtype"] = "|u1";
        const std::string name = std::to_string(level);
        write(path + "/" + name + "/.zarray", metadata.dump());
        write(path + "/" + name + "/0.0.0", std::string(static_cast<std::size_t>(size * size * size), '\1'));
        const json scale{{"type", "scale"}, {"scale", {f, f, f}}},
            moved{{"type", "translation"}, {"translation", {10, 10, 10}}};
        datasets.push_back({{"path", name}, {"coordinateTransformations", {scale, moved}}});
    }
    json whole = image();
    whole["multiscales"][0]["datasets"] = datasets;
    write(path + "/.zattrs", whole.dump());
    VolumeSource source = at(path);
    CHECK(loadVolume(source).geometry().origin == Vec3(10));
    source.downsample = 2;
    // Every second voxel, from the first one on: not the means of two, which would lie half a voxel further.
    CHECK(loadVolume(source).geometry().origin == Vec3(10));
    CHECK(loadVolume(source).geometry().spacing == Vec3(2));
    // A translation of all levels says nothing of one: the mean of two voxels is between them.
    for (json& dataset : whole["multiscales"][0]["datasets"]) dataset["coordinateTransformations"].erase(1);
    whole["multiscales"][0]["coordinateTransformations"] = {{{"type", "translation"}, {"translation", {10, 10, 10}}}};
    write(path + "/.zattrs", whole.dump());
    CHECK(loadVolume(source).geometry().origin == Vec3(10.5));
}

namespace {

/// The places along an axis: an array of one axis, with a unit.
void writeCoordinates(const std::string& path, const std::vector<double>& places, const std::string& units) {
    json metadata = metadata2(nullptr);
    metadata["shape"] = metadata["chunks"] = {places.size()};
    metadata["dtype"] = "<f8";
    write(path + "/.zarray", metadata.dump());
    write(path + "/.zattrs", json{{"units", units}}.dump());
    write(path + "/0", bytesOf(places));
}

/// Coordinates of kDims: x 10, 11, …; y 20, 22, …; z 5, 8, ….
void writePlaces(const std::string& group) {
    for (int a = 0; a < 3; ++a) {
        std::vector<double> places;
        for (int i = 0; i < kDims[a]; ++i) places.push_back(Vec3(10, 20, 5)[a] + i * (a + 1));
        writeCoordinates(group + "/" + "xyz"[a], places, "mm");
    }
}

} // namespace

TEST_CASE("arrays of xarray are placed and unpacked as those of NetCDF are", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    write(path + "/.zgroup", R"({"zarr_format": 2})");
    writeArray(path + "/temp", metadata2(nullptr), asItIs);
    writePlaces(path);
    // Python writes NaN without quotes; in a text it stays what it is.
    write(path + "/temp/.zattrs", R"({"_ARRAY_DIMENSIONS": ["z", "y", "x"], "scale_factor": 0.5, "add_offset": 10,
        "_FillValue": 101, "missing_value": NaN, "limits": [-Infinity, Infinity], "note": "a \" NaN, Infinity"})");
    const Volume volume = loadVolume(at(path));
    REQUIRE(volume.dims() == kDims);
    CHECK(volume.geometry().spacing == Vec3(1, 2, 3));
    CHECK(volume.geometry().origin == Vec3(10, 20, 5));
    CHECK(volume.value(voxelIndex(kDims, 0, 0, 0)) == 10);
    CHECK(volume.value(voxelIndex(kDims, 3, 2, 1)) == 0.5 * 1203 + 10);
    CHECK(volume.invalidCount() == 1); // 101
    CHECK_FALSE(volume.isValid(voxelIndex(kDims, 1, 1, 0)));
    CHECK(volume.notices.empty());

    // The value of chunks that are not stored is missing where xarray has written it, and only there.
    json metadata = metadata2(nullptr);
    metadata["fill_value"] = 101;
    write(path + "/temp/.zarray", metadata.dump());
    write(path + "/temp/.zattrs", R"({"_ARRAY_DIMENSIONS": ["z", "y", "x"]})");
    CHECK(loadVolume(at(path)).invalidCount() == 1);
    write(path + "/temp/.zattrs", "{}");
    CHECK(loadVolume(at(path)).invalidCount() == 0);
    CHECK(loadVolume(at(path)).geometry().spacing == Vec3(1)); // which places are its axes', nobody knows
    // A name that leads out of the folder is none.
    writeCoordinates(folder.path("x"), {0, 7, 14, 21, 28, 35, 42}, "mm");
    write(path + "/temp/.zattrs", R"({"_ARRAY_DIMENSIONS": ["z", "y", "../x"]})");
    CHECK(loadVolume(at(path)).geometry().spacing == Vec3(1, 2, 3)); // x: 1, as nothing says more
    // Coordinates that cannot be read are passed over with a word.
    json texts = metadata2(nullptr);
    texts["shape"] = texts["chunks"] = {kDims.z};
    texts["dtype"] = "<U5";
    write(path + "/z/.zarray", texts.dump());
    write(path + "/temp/.zattrs", R"({"_ARRAY_DIMENSIONS": ["z", "y", "x"]})");
    CHECK(hasNotice(loadVolume(at(path)), "the coordinates along 'z' are passed over"));
}

TEST_CASE("times of xarray are steps, and version 3 names axes and missing values in its way", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    json metadata = metadata3(json::array({kBytes}));
    metadata["shape"] = {2, 2, 2, 3};
    metadata["data_type"] = "float32";
    metadata["chunk_grid"]["configuration"]["chunk_shape"] = {1, 1, 2, 3};
    metadata["dimension_names"] = {"time", "z", "y", "x"};
    // The eight bytes of the number −999, in base64.
    metadata["attributes"] = {{"_FillValue", "AAAAAAA4j8A="}};
    write(path + "/zarr.json", json{{"zarr_format", 3}, {"node_type", "group"}}.dump());
    write(path + "/temp/zarr.json", metadata.dump());
    for (const int t : {0, 1}) // the layer z = 1 is not stored: 0, the fill value
        write(path + "/temp/c/" + std::to_string(t) + "/0/0/0",
              bytesOf<float>({static_cast<float>(6 * t + 1), 2, 3, 4, 5, -999}));
    writeCoordinates(path + "/time", {0, 6}, "hours since 2000-01-01");
    writeCoordinates(path + "/x", {0, 0.5, 1}, "km");
    writeCoordinates(path + "/y", {100, 0}, "m");
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.steps == 2);
    CHECK(contents.times == std::vector<double>{0, 6});
    CHECK(contents.timeUnit == "h");
    VolumeSource source = at(path);
    source.step = 1;
    const Volume volume = loadVolume(source);
    REQUIRE(volume.dims() == Int3(3, 2, 2));
    CHECK(volume.value(0) == 7);
    CHECK(volume.value(6) == 0);
    CHECK(volume.invalidCount() == 1);
    CHECK(volume.geometry().spacing.x == 0.5); // in km, as y is: its places go down by 100 m
    CHECK(volume.geometry().spacing.y == Approx(0.1));
    CHECK(volume.geometry().directions[1] == Vec3(0, -1, 0));
}

TEST_CASE("of several images in a folder one is chosen", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    for (const char* name : {"0", "1"}) {
        writeArray(path + "/" + name + "/0", metadata2(nullptr), asItIs);
        write(path + "/" + std::string(name) + "/.zattrs", image().dump());
    }
    write(path + "/.zgroup", R"({"zarr_format": 2})");
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.arrays == std::vector<std::string>{"0", "1"});
    VolumeSource source = at(path);
    requireValues(loadVolume(source));
    source.array = "1";
    requireValues(loadVolume(source));
    source.array = "2";
    CHECK_THAT(errorOf(source), Contains("there is no image \"2\"") || Contains("there is no image '2'"));
}

TEST_CASE("what Zarr cannot be is said", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    const auto with = [&](const json& metadata) {
        write(path + "/.zarray", metadata.dump());
        return errorOf(at(path));
    };
    fs::create_directories(path);
    CHECK_THAT(errorOf(at(path)), Contains("holds no Zarr metadata") || Contains("folder"));
    writeArray(path, metadata2(nullptr), asItIs);
    write(path + "/0.0.0", "short");
    CHECK_THAT(errorOf(at(path)), Contains("this chunk has 5 bytes, not 48") && Contains("0.0.0"));
    CHECK_THAT(with(metadata2({{"id", "zstd"}})), Contains("damaged"));
    CHECK_THAT(with(metadata2({{"id", "blosc"}})), Contains("damaged"));
    CHECK_THAT(with(metadata2({{"id", "jpeg2k"}})), Contains("jpeg2k") && Contains("cannot be unpacked"));
    json metadata = metadata2(nullptr);
    metadata["shape"] = {2000000000, 2000000000, 2000000000};
    metadata["chunks"] = {1, 1, 1};
    CHECK_THAT(with(metadata), Contains("more than any memory"));
    metadata["shape"] = {20000, 20000, 20000};
    CHECK_THAT(with(metadata), Contains("would take hours"));
    metadata = metadata2(nullptr);
    metadata["chunks"] = {100000, 100000, 1};
    CHECK_THAT(with(metadata), Contains("larger than any memory"));
    metadata["chunks"] = {1, 1};
    CHECK_THAT(with(metadata), Contains("is no volume"));
    metadata["dtype"] = "<U8";
    CHECK_THAT(with(metadata), Contains("not supported"));
    metadata.erase("shape");
    CHECK_THAT(with(metadata), Contains("'shape' is missing"));
    for (const char* broken : {"{", "{\"a\": NaN", "{\"a\": nan}", "{\"a\": \"NaN}"}) {
        write(path + "/.zarray", broken);
        CHECK_THAT(errorOf(at(path)), Contains("no JSON object"));
    }
    // Names of chunks that lead out of the folder.
    CHECK_THAT(with(metadata2(nullptr, "/../")), Contains("not separated by"));
    // 2^30 · 2^30 · 2^4 chunks in a shard are 2^64, which 64 bits count as none.
    json shards = metadata3(json::array({{{"name", "sharding_indexed"},
                                          {"configuration",
                                           {{"chunk_shape", {1, 1, 1}},
                                            {"codecs", json::array({kBytes})},
                                            {"index_codecs", json::array({kBytes})}}}}}));
    shards["chunk_grid"]["configuration"]["chunk_shape"] = {1 << 30, 1 << 30, 16};
    write(folder.path("s.zarr/zarr.json"), shards.dump());
    write(folder.path("s.zarr/c/0/0/0"), "xyz");
    CHECK_THAT(errorOf(at(folder.path("s.zarr"))), Contains("too many chunks in a shard"));
    // A chunk that unpacks to gigabytes of zeros.
    writeArray(path, metadata2({{"id", "zlib"}}),
               [](const std::string&) { return zlibbed(std::string(1u << 24, '\0')); });
    CHECK_THAT(errorOf(at(path)), Contains("unpacks to more than the array has"));
    // An array of an image that leads elsewhere.
    const std::string other = folder.path("b.zarr");
    json outside = image();
    outside["multiscales"][0]["datasets"][0]["path"] = "../a.zarr";
    write(other + "/.zattrs", outside.dump());
    CHECK_THAT(errorOf(at(other)), Contains("leads out of its image"));
}

TEST_CASE("a limit on the size of files is not taken for a lack of memory", "[zarr]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    writeArray(path, metadata2(nullptr), asItIs);
    rlimit usual{};
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &usual) == 0);
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit none{0, usual.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &none) == 0);
    const std::string error = errorOf(at(path));
    ::setrlimit(RLIMIT_FSIZE, &usual);
    std::signal(SIGXFSZ, before);
    CHECK_THAT(error, Contains("the limit on the size of files") && Contains("ulimit -f"));
    requireValues(loadVolume(at(path)));
}
