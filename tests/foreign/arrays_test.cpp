// HDF5 and NetCDF files through pellucid-array-reader.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "support/array_writer.h"
#include "support/notices.h"
#include "support/reader_log.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/series.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

VolumeSource at(const std::string& path, const std::string& array = "", int step = 0) {
    VolumeSource source;
    source.path = path;
    source.array = array;
    source.step = step;
    return source;
}

/// 0, 1, 2, …
template <class T>
std::vector<T> counted(std::size_t count) {
    std::vector<T> values(count);
    std::iota(values.begin(), values.end(), T{});
    return values;
}

bool isCounted(const Volume& volume, double first = 0) {
    for (std::size_t i = 0; i < volume.size(); ++i)
        if (volume.value(i) != first + static_cast<double>(i)) return false;
    return true;
}

/// A file of one array of 4 x 3 x 2 voxels, 0 … 23, changed by `change` before that is written.
template <class Change>
std::string hdf5(const TempFolder& folder, const char* name, const Change& change) {
    Hdf5Writer file(folder.path(name));
    change(file);
    file.array("/v", {2, 3, 4}, counted<std::int16_t>(24));
    return folder.path(name);
}

/// z, y, x of 2, 3, 4 and a variable "v" along them; `define` adds to that.
template <class Define>
NetCdfWriter& gridIn(NetCdfWriter& file, nc_type type, const Define& define) {
    file.dimension("z", 2);
    file.dimension("y", 3);
    file.dimension("x", 4);
    file.variable("v", type, {"z", "y", "x"});
    define();
    return file;
}
NetCdfWriter& gridIn(NetCdfWriter& file, nc_type type) {
    return gridIn(file, type, [] {});
}

void coordinates(NetCdfWriter& file, const std::string& axis, const std::string& unit) {
    file.variable(axis, NC_FLOAT, {axis});
    file.text(axis, "units", unit);
}

constexpr int kFormats[] = {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL};

} // namespace

TEST_CASE("numbers of HDF5 files keep their type, in both byte orders", "[arrays]") {
    const TempFolder folder;
    const auto check = [&](auto zero, hid_t inFile, SampleType type) {
        using T = decltype(zero);
        {
            Hdf5Writer file(folder.path("v.h5"));
            file.array("/v", {2, 3, 4}, counted<T>(24), inFile);
        }
        const Volume volume = loadVolume(at(folder.path("v.h5")));
        CHECK(volume.dims() == Int3(4, 3, 2));
        CHECK(volume.sampleType() == type);
        CHECK(volume.format == "HDF5");
        CHECK(isCounted(volume));
    };
    check(std::uint8_t{}, H5T_STD_U8LE, SampleType::U8);
    check(std::int8_t{}, H5T_STD_I8BE, SampleType::I8);
    check(std::uint16_t{}, H5T_STD_U16BE, SampleType::U16);
    check(std::int16_t{}, H5T_STD_I16LE, SampleType::I16);
    check(std::uint32_t{}, H5T_STD_U32BE, SampleType::U32);
    check(std::int32_t{}, H5T_STD_I32LE, SampleType::I32);
    check(std::uint64_t{}, H5T_STD_U64BE, SampleType::F64);
    check(std::int64_t{}, H5T_STD_I64LE, SampleType::F64);
    check(float{}, H5T_IEEE_F32BE, SampleType::F32);
    check(double{}, H5T_IEEE_F64LE, SampleType::F64);
    check(double{}, H5T_IEEE_F64BE, SampleType::F64);
}

TEST_CASE("values in one piece are read from the file itself, without the library", "[arrays]") {
    const TempFolder folder;
    const ReaderLog log(folder, "pellucid-array-reader");
    // The volume, and whether the reader has said where its values are.
    const auto load = [&](const std::string& path, int step = 0) {
        log.clear();
        VolumeSource source = at(path);
        source.step = step;
        Volume volume = loadVolume(source);
        return std::pair{std::move(volume), log.namesPlaces()};
    };
    SECTION("HDF5: numbers as processors have them, of one step, in either byte order") {
        for (const hid_t type : {H5T_STD_I16LE, H5T_STD_I16BE}) {
            {
                Hdf5Writer file(folder.path("v.h5"));
                file.array("/v", {3, 2, 3, 4}, counted<std::int16_t>(72), type);
            }
            const auto [volume, isInFile] = load(folder.path("v.h5"), 2);
            CHECK(isInFile);
            CHECK(isCounted(volume, 48));
        }
    }
    SECTION("not HDF5 in chunks, with bytes before it, or of numbers that processors do not have") {
        const auto isRead = [&](const std::string& path) {
            const auto [volume, isInFile] = load(path);
            return isCounted(volume) && !isInFile;
        };
        CHECK(isRead(hdf5(folder, "chunks.h5", [](Hdf5Writer& file) {
            const hsize_t chunk[] = {1, 3, 4};
            H5Pset_chunk(file.how, 3, chunk);
        })));
        {
            Hdf5Writer file(folder.path("block.h5"), 512);
            file.array("/v", {2, 3, 4}, counted<std::int16_t>(24));
        }
        CHECK(isRead(folder.path("block.h5")));
        {
            Hdf5Writer file(folder.path("twelve.h5"));
            const hid_t twelve = H5Tcopy(H5T_STD_I16LE);
            H5Tset_precision(twelve, 12);
            file.array("/v", {2, 3, 4}, counted<std::int16_t>(24), twelve);
        }
        CHECK(isRead(folder.path("twelve.h5")));
    }
    SECTION("classic NetCDF: whole arrays, and one record of several") {
        for (const bool areRecords : {false, true}) {
            {
                NetCdfWriter file(folder.path("v.nc"));
                file.dimension("time", areRecords ? NC_UNLIMITED : 3);
                gridIn(file, NC_BYTE, [&] { file.variable("w", NC_INT, {"time", "z", "y", "x"}); });
                file.values("v", {2, 3, 4}, counted<double>(24));
                file.values("w", {3, 2, 3, 4}, counted<double>(72));
            }
            VolumeSource source = at(folder.path("v.nc"));
            source.array = "w";
            source.step = 1;
            log.clear();
            CHECK(isCounted(loadVolume(source), 24));
            CHECK(log.namesPlaces());
        }
    }
    SECTION("not where values have to be marked as missing") {
        {
            NetCdfWriter file(folder.path("v.nc"));
            gridIn(file, NC_FLOAT).values("v", {2, 3, 4}, counted<double>(24));
        }
        const auto [volume, isInFile] = load(folder.path("v.nc"));
        CHECK(isCounted(volume));
        CHECK_FALSE(isInFile);
    }
}

TEST_CASE("half floats, enumerations and truth values are numbers", "[arrays]") {
    const TempFolder folder;
    {
        Hdf5Writer file(folder.path("half.h5"));
        const hid_t half = H5Tcopy(H5T_IEEE_F32LE); // as h5py makes it
        H5Tset_fields(half, 15, 10, 5, 0, 10);
        H5Tset_size(half, 2);
        H5Tset_ebias(half, 15);
        file.array("/v", {2, 3, 4}, counted<float>(24), half);
    }
    const Volume half = loadVolume(at(folder.path("half.h5")));
    CHECK(half.sampleType() == SampleType::F32);
    CHECK(isCounted(half));
    {
        Hdf5Writer file(folder.path("bool.h5"));
        const hid_t truth = H5Tenum_create(H5T_NATIVE_INT8);
        std::int8_t value = 0;
        H5Tenum_insert(truth, "FALSE", &value);
        H5Tenum_insert(truth, "TRUE", &(value = 1));
        std::vector<std::int8_t> values(24, 0);
        values[5] = 1;
        file.array("/v", {2, 3, 4}, values, truth);
    }
    const Volume truth = loadVolume(at(folder.path("bool.h5")));
    CHECK(truth.sampleType() == SampleType::U8);
    CHECK(truth.value(5) == 1);
}

TEST_CASE("HDF5 unpacks blocks", "[arrays]") {
    const TempFolder folder;
    const hsize_t chunk[] = {2, 2, 3};
    const auto load = [&](const auto& filters) {
        return loadVolume(at(hdf5(folder, "v.h5", [&](Hdf5Writer& file) {
            H5Pset_chunk(file.how, 3, chunk);
            filters(file.how);
        })));
    };
    CHECK(isCounted(load([](hid_t) {})));
    CHECK(isCounted(load([](hid_t how) { H5Pset_deflate(how, 6); })));
    CHECK(isCounted(load([](hid_t how) {
        H5Pset_shuffle(how);
        H5Pset_deflate(how, 6);
        H5Pset_fletcher32(how);
    })));
    CHECK(isCounted(load([](hid_t how) { H5Pset_szip(how, H5_SZIP_NN_OPTION_MASK, 4); })));
}

TEST_CASE("a user's block may stand before an HDF5 file, as MATLAB has it", "[arrays]") {
    const TempFolder folder;
    for (const auto& [name, block] : {std::pair{"a.mat", 512}, {"b", 512}, {"c.h5", 4096}}) {
        {
            Hdf5Writer file(folder.path(name), static_cast<hsize_t>(block));
            file.array("/v", {2, 3, 4}, counted<std::int16_t>(24));
        }
        CHECK(isCounted(loadVolume(at(folder.path(name)))));
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.write("old.mat", "MATLAB 5.0 MAT-file, Platform: GLNXA64"))),
                      Contains("from version 7.3 on") && Contains("save it in MATLAB"));
}

TEST_CASE("arrays of a file are offered by name, the largest first", "[arrays]") {
    const TempFolder folder;
    {
        Hdf5Writer file(folder.path("several.h5"));
        file.array("/entry/small", {2, 2, 2}, counted<std::int16_t>(8));
        file.array("/entry/data/large", {2, 3, 4}, counted<float>(24));
        file.array("/entry/picture", {3, 4}, counted<float>(12));
    }
    const std::string path = folder.path("several.h5");
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.array == "/entry/data/large");
    CHECK(contents.arrays == std::vector<std::string>{"/entry/data/large", "/entry/small"});
    CHECK(contents.details == std::vector<std::string>{"4 × 3 × 2, f32", "2 × 2 × 2, i16"});
    CHECK(loadVolume(at(path)).dims() == Int3(4, 3, 2));
    CHECK(hasNotice(loadVolume(at(path)), "array '/entry/data/large' of 2 is shown"));
    for (const char* name : {"/entry/small", "entry/small", "small"})
        CHECK(loadVolume(at(path, name)).dims() == Int3(2, 2, 2));
    CHECK_THROWS_AS(loadVolume(at(path, "/none")), UsageError);
    CHECK_THROWS_WITH(loadVolume(at(path, "/none")), Contains("there is no array '/none'") &&
                                                         Contains("there are '/entry/data/large', '/entry/small'"));
    CHECK_THROWS_WITH(loadVolume(at(path, "/entry/picture")), Contains("is no volume: that has three axes or more"));
}

TEST_CASE("what has no volume is told with what it has", "[arrays]") {
    const TempFolder folder;
    {
        Hdf5Writer file(folder.path("flat.h5"));
        file.array("/picture", {3, 4}, counted<float>(12));
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("flat.h5"))),
                      Contains("no array in this file has numbers along three axes or more") &&
                          Contains("'/picture' (4 × 3, f32)"));
    {
        Hdf5Writer file(folder.path("complex.h5"));
        const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
        H5Tinsert(type, "r", 0, H5T_NATIVE_DOUBLE);
        H5Tinsert(type, "i", 8, H5T_NATIVE_DOUBLE);
        file.array("/v", {2, 2, 2}, std::vector<double>{}, type);
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("complex.h5"))), Contains("'/v' (2 × 2 × 2, complex numbers)"));
    CHECK_THROWS_WITH(loadVolume(at(folder.path("complex.h5"), "/v")), Contains("has no numbers to be shown"));
    { Hdf5Writer file(folder.path("empty.h5")); }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("empty.h5"))), Contains("it has no arrays at all"));
}

TEST_CASE("a fourth axis of HDF5 is time, unless it is said to be components", "[arrays]") {
    const TempFolder folder;
    {
        Hdf5Writer file(folder.path("four.h5"));
        file.array("/v", {3, 2, 3, 4}, counted<std::int16_t>(72));
    }
    CHECK(listSeries(at(folder.path("four.h5"))).frames.size() == 3);
    CHECK(isCounted(loadVolume(at(folder.path("four.h5"), "", 2)), 48));
    CHECK_THROWS_AS(loadVolume(at(folder.path("four.h5"), "", 3)), UsageError);
    {
        Hdf5Writer file(folder.path("tags.h5"));
        file.array("/v", {2, 3, 4, 2}, counted<std::int16_t>(48));
        file.text("/v", "axistags",
                  R"({"axes":[{"key":"z","resolution":2.5},{"key":"y","resolution":1},{"key":"x","resolution":1},)"
                  R"({"key":"c","resolution":0}]})");
    }
    CHECK(contentsOf(at(folder.path("tags.h5"))).components == 2);
    VolumeSource second = at(folder.path("tags.h5"));
    second.component = 1;
    const Volume volume = loadVolume(second);
    CHECK(volume.geometry().spacing == Vec3(1, 1, 2.5));
    CHECK(volume.value(5) == 11);
    {
        Hdf5Writer file(folder.path("single.h5")); // axes of one entry are left out
        file.array("/v", {1, 2, 3, 1, 4}, counted<std::int16_t>(24));
    }
    CHECK(isCounted(loadVolume(at(folder.path("single.h5")))));
    CHECK(loadVolume(at(folder.path("single.h5"))).dims() == Int3(4, 3, 2));
}

TEST_CASE("distances beside an HDF5 array are taken, slowest axis first", "[arrays]") {
    const TempFolder folder;
    for (const char* name : {"element_size_um", "spacing", "voxel_size", "resolution"}) {
        {
            Hdf5Writer file(folder.path("v.h5"));
            file.array("/v", {2, 3, 4}, counted<std::int16_t>(24));
            file.numbers("/v", name, {3, 2, 0.5});
        }
        const Volume volume = loadVolume(at(folder.path("v.h5")));
        CHECK(volume.geometry().spacing == Vec3(0.5, 2, 3));
        const bool isInMicrons = std::string(name) == "element_size_um";
        CHECK(volume.geometry().lengthUnit == (isInMicrons ? LengthUnit::Micrometre : LengthUnit::Unknown));
    }
}

TEST_CASE("blocks that are not in an HDF5 file are told of", "[arrays]") {
    const TempFolder folder;
    {
        Hdf5Writer file(folder.path("none.h5"));
        const hsize_t chunk[] = {2, 2, 2};
        const float fill = 7;
        H5Pset_chunk(file.how, 3, chunk);
        H5Pset_fill_value(file.how, H5T_NATIVE_FLOAT, &fill);
        file.array("/v", {4, 4, 4}, std::vector<float>{});
    }
    const Volume none = loadVolume(at(folder.path("none.h5")));
    CHECK(none.value(63) == 7);
    CHECK(hasNotice(none, "8 of 8 blocks of '/v' are not in the file"));
    {
        Hdf5Writer file(folder.path("huge.h5"));
        const hsize_t chunk[] = {64, 64, 64};
        H5Pset_chunk(file.how, 3, chunk);
        file.array("/v", {1'000'000, 100'000, 100'000}, std::vector<float>{});
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("huge.h5"))), Contains("huge.h5") && Contains("would take hours"));
}

TEST_CASE("HDF5 reads no file outside of its folder", "[arrays]") {
    const TempFolder folder;
    hdf5(folder, "other.h5", [](Hdf5Writer&) {});
    const auto linked = [&](const char* to) {
        {
            Hdf5Writer file(folder.path("link.h5"));
            H5Lcreate_external(to, "/v", file.id(), "link", H5P_DEFAULT, H5P_DEFAULT);
        }
        return loadVolume(at(folder.path("link.h5")));
    };
    CHECK(isCounted(linked("other.h5")));
    CHECK_THROWS_WITH(linked("/etc/passwd"),
                      Contains("the link '/link' is not followed: it leads to '/etc/passwd', which is outside"));
    CHECK_THROWS_WITH(linked("../x.h5"), Contains("which is outside this folder"));
    CHECK_THROWS_WITH(linked("none.h5"), Contains("leads to 'none.h5', where there is nothing that can be read"));

    const auto outside = [&](const std::string& name) {
        {
            Hdf5Writer file(folder.path("raw.h5"));
            H5Pset_external(file.how, name.c_str(), 0, 48);
            file.array("/v", {2, 3, 4}, std::vector<std::int16_t>{});
        }
        return loadVolume(at(folder.path("raw.h5")));
    };
    std::string raw(48, '\0');
    const auto values = counted<std::int16_t>(24);
    std::memcpy(raw.data(), values.data(), raw.size());
    folder.write("raw.bin", raw);
    CHECK(isCounted(outside("raw.bin")));
    CHECK_THROWS_WITH(outside("/etc/passwd"), Contains("are in the file '/etc/passwd', which is outside this folder"));
    CHECK_THROWS_WITH(outside("gone.bin"), Contains("are in the file 'gone.bin', which is not there"));

    const auto virtualOf = [&](const char* name) {
        {
            Hdf5Writer file(folder.path("virtual.h5"));
            const hsize_t dims[] = {2, 3, 4};
            const hid_t space = H5Screate_simple(3, dims, nullptr);
            H5Pset_virtual(file.how, space, name, "/v", space);
            file.array("/w", {2, 3, 4}, std::vector<std::int16_t>{});
        }
        return loadVolume(at(folder.path("virtual.h5")));
    };
    CHECK(isCounted(virtualOf("other.h5")));
    {
        Hdf5Writer file(folder.path("partly.h5"));
        const hsize_t dims[] = {2, 3, 4}, wider[] = {3, 3, 4}, first[] = {0, 0, 0};
        const hid_t source = H5Screate_simple(3, dims, nullptr), space = H5Screate_simple(3, wider, nullptr);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, dims, nullptr);
        H5Pset_virtual(file.how, space, "other.h5", "/v", source);
        file.array("/w", {3, 3, 4}, std::vector<std::int16_t>{});
    }
    CHECK(hasNotice(loadVolume(at(folder.path("partly.h5"))), "12 of 36 values of '/w' are in no file"));
    CHECK_THROWS_WITH(virtualOf("/etc/passwd"), Contains("which is outside this folder"));
    CHECK_THROWS_WITH(virtualOf("none.h5"), Contains("in the file 'none.h5', which cannot be read"));
}

TEST_CASE("what is wrong with an HDF5 file is told", "[arrays]") {
    const TempFolder folder;
    const auto read = [](const std::string& path) {
        std::ifstream in(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const std::string path = hdf5(folder, "v.h5", [](Hdf5Writer& file) {
        const hsize_t chunk[] = {2, 3, 4};
        H5Pset_chunk(file.how, 3, chunk);
        H5Pset_fletcher32(file.how);
    });
    const std::string whole = read(path);
    CHECK_THROWS_WITH(loadVolume(at(folder.write("cut.h5", whole.substr(0, whole.size() / 2)))),
                      Contains("HDF5 cannot open it (truncated file") && Contains("copy it again"));
    CHECK_THROWS_WITH(loadVolume(at(folder.write("text.h5", "Dear reader"))),
                      Contains("this is neither HDF5 nor NetCDF but text"));
    CHECK_THROWS_WITH(loadVolume(at(folder.write("old.hdf", "\x0e\x03\x13\x01 and so on"))),
                      Contains("neither HDF5 nor NetCDF but an HDF4 file"));
    // A flipped bit is found by the checksum.
    const auto values = counted<std::int16_t>(24);
    const std::size_t first = whole.find(std::string(reinterpret_cast<const char*>(values.data()), 48));
    REQUIRE(first != std::string::npos);
    for (std::size_t bit = 0; bit < 48; ++bit) {
        std::string damaged = whole;
        damaged[first + bit] = static_cast<char>(damaged[first + bit] ^ (1 << bit % 8));
        CHECK_THROWS_WITH(loadVolume(at(folder.write("damaged.h5", damaged))),
                          Contains("cannot read '/v' (data error detected by Fletcher32 checksum)"));
    }
    {
        Hdf5Writer file(folder.path("filter.h5"));
        const hsize_t chunk[] = {2, 3, 4};
        H5Pset_chunk(file.how, 3, chunk);
        H5Pset_filter(file.how, 32001, H5Z_FLAG_OPTIONAL, 0, nullptr); // which this library has not, and leaves out
        file.array("/v", {2, 3, 4}, std::vector<std::int16_t>{});
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("filter.h5"))),
                      Contains("'/v' is packed by Blosc, which is not supported") && Contains("h5repack"));
}

TEST_CASE("a NetCDF file of each form is read", "[arrays]") {
    const TempFolder folder;
    for (const int format : kFormats)
        for (const auto& [type, kept] : {std::pair{NC_BYTE, SampleType::I8},
                                         {NC_SHORT, SampleType::I16},
                                         {NC_INT, SampleType::I32},
                                         {NC_FLOAT, SampleType::F32},
                                         {NC_DOUBLE, SampleType::F64}}) {
            for (const char* name : {"v.nc", "v"}) { // the name does not matter
                {
                    NetCdfWriter file(folder.path(name), format);
                    gridIn(file, type).values("v", {2, 3, 4}, counted<double>(24));
                }
                const Volume volume = loadVolume(at(folder.path(name)));
                CAPTURE(format, type, name);
                CHECK(volume.dims() == Int3(4, 3, 2));
                CHECK(volume.sampleType() == kept);
                CHECK(isCounted(volume));
                CHECK(volume.notices.empty());
            }
        }
}

TEST_CASE("records of NetCDF are time steps", "[arrays]") {
    const TempFolder folder;
    for (const int format : kFormats) {
        {
            NetCdfWriter file(folder.path("v.nc"), format);
            file.dimension("time", NC_UNLIMITED);
            file.variable("time", NC_DOUBLE, {"time"});
            file.text("time", "units", "days since 2000-01-01");
            gridIn(file, NC_SHORT, [&] {
                file.variable("u", NC_SHORT, {"time", "z", "y", "x"});
                file.variable("odd", NC_BYTE, {"time", "y"}); // three bytes a record, filled up to four
            });
            file.values("time", {3}, {0, 1.5, 4});
            file.values("odd", {3, 3}, counted<double>(9));
            file.values("u", {3, 2, 3, 4}, counted<double>(72));
        }
        const FileContents contents = contentsOf(at(folder.path("v.nc")));
        CHECK(contents.array == "/u");
        CHECK(contents.steps == 3);
        CHECK(contents.times == std::vector<double>{0, 1.5, 4});
        CHECK(contents.timeUnit == "d");
        for (int step = 0; step < 3; ++step) CHECK(isCounted(loadVolume(at(folder.path("v.nc"), "", step)), 24 * step));
    }
    {
        NetCdfWriter file(folder.path("flat.nc")); // time is the third axis where there is no other
        file.dimension("time", 5);
        file.dimension("lat", 3);
        file.dimension("lon", 4);
        file.variable("v", NC_SHORT, {"time", "lat", "lon"});
        file.values("v", {5, 3, 4}, counted<double>(60));
    }
    const Volume flat = loadVolume(at(folder.path("flat.nc")));
    CHECK(flat.dims() == Int3(4, 3, 5));
    CHECK(hasNotice(flat, "'time' is shown as an axis in space"));
}

TEST_CASE("coordinates say where voxels are", "[arrays]") {
    const TempFolder folder;
    for (const int format : kFormats) {
        {
            NetCdfWriter file(folder.path("v.nc"), format);
            gridIn(file, NC_FLOAT, [&] {
                coordinates(file, "z", "m");
                file.text("z", "positive", "down");
                coordinates(file, "y", "degrees_north");
                coordinates(file, "x", "degrees_east");
            });
            file.values("z", {2}, {10, 20});
            file.values("y", {3}, {50, 49.5, 49});
            file.values("x", {4}, {-1, -0.75, -0.5, -0.25});
            file.values("v", {2, 3, 4}, counted<double>(24));
        }
        const Volume volume = loadVolume(at(folder.path("v.nc")));
        const Geometry& g = volume.geometry();
        CHECK(g.spacing == Vec3(0.25, 0.5, 10));
        CHECK(g.worldFromVoxel(Vec3(0)) == Vec3(-1, 50, -10)); // depth grows downwards
        CHECK(g.worldFromVoxel(Vec3(3, 2, 1)) == Vec3(-0.25, 49, -20));
        CHECK(hasNotice(volume, "the axes have different units (m, degrees_north, degrees_east)"));
    }
}

TEST_CASE("axes stored in another order lie along the same axes of the world", "[arrays]") {
    const TempFolder folder;
    {
        NetCdfWriter file(folder.path("v.nc"));
        file.dimension("lon", 2);
        file.dimension("lat", 3);
        file.dimension("lev", 4);
        file.variable("v", NC_FLOAT, {"lon", "lat", "lev"});
        file.values("v", {2, 3, 4}, counted<double>(24));
    }
    const Geometry g = loadVolume(at(folder.path("v.nc"))).geometry();
    CHECK(g.worldFromVoxel(Vec3(3, 0, 0)) == Vec3(0, 0, 3));
    CHECK(g.worldFromVoxel(Vec3(0, 2, 1)) == Vec3(1, 2, 0));
}

TEST_CASE("lengths get one unit, and unequal spacing is told of", "[arrays]") {
    const TempFolder folder;
    const auto load = [&](const std::string& unitOfZ, const std::vector<double>& y) {
        {
            NetCdfWriter file(folder.path("v.nc"));
            gridIn(file, NC_FLOAT, [&] {
                coordinates(file, "z", unitOfZ);
                coordinates(file, "y", "km");
                coordinates(file, "x", "km");
            });
            file.values("z", {2}, {0, 500});
            file.values("y", {3}, y);
            file.values("x", {4}, {0, 2, 4, 6});
            file.values("v", {2, 3, 4}, counted<double>(24));
        }
        return loadVolume(at(folder.path("v.nc")));
    };
    const Volume metres = load("m", {0, 1, 2});
    CHECK(metres.geometry().spacing == Vec3(2, 1, 0.5));
    CHECK(metres.geometry().lengthUnit == LengthUnit::Kilometre);
    CHECK(hasNotice(metres, "lengths are given in m and km: shown in km"));
    const Volume unequal = load("km", {0, 1, 4});
    CHECK(unequal.geometry().spacing == Vec3(2, 2, 500));
    CHECK(hasNotice(unequal, "the spacing along 'y' is unequal: shown with the mean, 2 km"));
    const Volume disorder = load("km", {0, 2, 1});
    CHECK(disorder.geometry().spacing == Vec3(2, 1, 500));
    CHECK(hasNotice(disorder, "the coordinates along 'y' are in no order"));
}

TEST_CASE("packed values are unpacked, and those that stand for none are none", "[arrays]") {
    const TempFolder folder;
    for (const int format : kFormats) {
        const auto load = [&](nc_type type, const auto& define) {
            {
                NetCdfWriter file(folder.path("v.nc"), format);
                gridIn(file, type, [&] { define(file); });
                file.values("v", {2, 3, 4}, counted<double>(24));
            }
            return loadVolume(at(folder.path("v.nc")));
        };
        const Volume scaled = load(NC_SHORT, [](NetCdfWriter& file) {
            file.number("v", "scale_factor", NC_DOUBLE, 0.25);
            file.number("v", "add_offset", NC_DOUBLE, 10);
            file.number("v", "_FillValue", NC_SHORT, 5);
            file.number("v", "missing_value", NC_SHORT, 7);
            file.number("v", "valid_max", NC_SHORT, 20);
        });
        CHECK(scaled.sampleType() == SampleType::F32);
        CHECK(scaled.value(4) == 11);
        CHECK(scaled.missing() == 11.25);
        CHECK(scaled.invalidCount() == 5); // 5, 7, 21, 22, 23
        for (const std::size_t none : {5u, 7u, 21u, 22u, 23u}) CHECK_FALSE(scaled.isValid(none));
        const Volume exact = load(NC_INT, [](NetCdfWriter& file) { file.number("v", "scale_factor", NC_DOUBLE, 0.1); });
        CHECK(exact.sampleType() == SampleType::F64);
        CHECK(exact.value(3) == 0.1 * 3);
        const Volume floats = load(NC_FLOAT, [](NetCdfWriter& file) {
            file.number("v", "missing_value", NC_FLOAT, 3);
            file.number("v", "valid_min", NC_FLOAT, 1);
        });
        CHECK(floats.invalidCount() == 2);
        CHECK(std::isnan(floats.value(3)));
        const Volume range = load(NC_SHORT, [](NetCdfWriter& file) { file.number("v", "valid_min", NC_SHORT, 2); });
        CHECK(range.invalidCount() == 2);
        CHECK(range.dataRange() == ValueRange{2, 23});
    }
    {
        NetCdfWriter file(folder.path("bytes.nc"));
        gridIn(file, NC_BYTE, [&] {
            file.text("v", "_Unsigned", "true");
            file.number("v", "_FillValue", NC_BYTE, -1);
        });
        std::vector<double> values = counted<double>(24);
        values[0] = -1;  // 255
        values[1] = -56; // 200
        file.values("v", {2, 3, 4}, values);
    }
    const Volume bytes = loadVolume(at(folder.path("bytes.nc")));
    CHECK(bytes.sampleType() == SampleType::U8);
    CHECK(bytes.value(1) == 200);
    CHECK_FALSE(bytes.isValid(0));
}

TEST_CASE("values that were never written to a NetCDF file are none", "[arrays]") {
    const TempFolder folder;
    for (const int format : kFormats) {
        {
            NetCdfWriter file(folder.path("v.nc"), format);
            gridIn(file, NC_FLOAT);
            file.values("v", {1, 3, 4}, counted<double>(12));
        }
        const Volume volume = loadVolume(at(folder.path("v.nc")));
        CHECK(volume.invalidCount() == 12);
        CHECK(volume.dataRange() == ValueRange{0, 11});
    }
}

TEST_CASE("what is wrong with a classic NetCDF file is told", "[arrays]") {
    const TempFolder folder;
    {
        NetCdfWriter file(folder.path("v.nc"));
        gridIn(file, NC_SHORT).values("v", {2, 3, 4}, counted<double>(24));
    }
    std::ifstream in(folder.path("v.nc"), std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(in), {});
    CHECK_THROWS_WITH(loadVolume(at(folder.write("cut.nc", whole.substr(0, whole.size() - 8)))),
                      Contains("the values of '/v' do not end within the file") && Contains("copy it again"));
    for (std::size_t bytes = 4; bytes + 48 < whole.size(); ++bytes)
        CHECK_THROWS_AS(loadVolume(at(folder.write("cut.nc", whole.substr(0, bytes)))), FileError);
    std::string large = whole;
    const std::size_t x = large.find(std::string("x\0\0\0\0\0\0\4", 8));
    REQUIRE(x != std::string::npos);
    large.replace(x + 4, 4, "\x7f\xff\xff\xff");
    CHECK_THROWS_WITH(loadVolume(at(folder.write("large.nc", large))), Contains("do not end within the file"));
    // With sizes of 64 bits: 2^60 · 2 · 3 values, more than 64 bits count bytes of.
    {
        NetCdfWriter file(folder.path("wide.nc"), NC_64BIT_DATA);
        gridIn(file, NC_SHORT).values("v", {2, 3, 4}, counted<double>(24));
    }
    std::ifstream wide(folder.path("wide.nc"), std::ios::binary);
    large.assign(std::istreambuf_iterator<char>(wide), {});
    const std::size_t wideX = large.find(std::string("x\0\0\0\0\0\0\0\0\0\0\4", 12));
    REQUIRE(wideX != std::string::npos);
    large.replace(wideX + 4, 8, std::string("\x10\0\0\0\0\0\0\0", 8));
    CHECK_THROWS_WITH(loadVolume(at(folder.write("large.nc", large))), Contains("claims more than there is"));
}
