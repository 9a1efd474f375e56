// fuzz_reader_seeds FOLDER: what readers of foreign formats parse themselves, as their programs write it.
#include <nlohmann/json.hpp>

#include "seeds.h"
#include "volume/packers.h"
#include "volume/volume_files.h"

using namespace pellucid;
using fuzz::Seeds;
using nlohmann::json;

namespace {

const std::string kChunk = "abcdefghijklmnopqrstuvwx"; // 2 x 3 x 4 bytes, or 2 x 3 x 2 numbers of 16 bits

json zarrV2(const std::string& type, const json& compressor) {
    return {{"zarr_format", 2},   {"shape", {3, 3, 4}}, {"chunks", {2, 3, type.ends_with('1') ? 4 : 2}},
            {"dtype", type},      {"order", "C"},       {"compressor", compressor},
            {"fill_value", -1.5}, {"filters", nullptr}, {"dimension_separator", "/"}};
}

json zarrV3(const std::string& type, const json& codecs, const json& chunk) {
    return {{"zarr_format", 3},
            {"node_type", "array"},
            {"shape", {3, 3, 4}},
            {"data_type", type},
            {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", chunk}}}}},
            {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
            {"fill_value", "NaN"},
            {"codecs", codecs},
            {"dimension_names", {"z", "y", "x"}},
            {"attributes", json::object()}};
}

/// An image of the array "0".
json image(bool isOld) {
    const json moved{{"type", "translation"}, {"translation", {0, 5, 6}}};
    const json scaled{{"type", "scale"}, {"scale", {2, -0.5, 0.5}}};
    json axes = json::array();
    for (const char* name : {"z", "y", "x"})
        axes.push_back({{"name", name}, {"type", "space"}, {"unit", "micrometer"}});
    const json dataset{{"path", "0"}, {"coordinateTransformations", {scaled, moved}}};
    const json multiscale{{"name", "a"}, {"axes", axes}, {"datasets", json::array({dataset})}};
    if (isOld) return {{"multiscales", json::array({multiscale})}};
    return {{"zarr_format", 3},
            {"node_type", "group"},
            {"attributes", {{"ome", {{"version", "0.5"}, {"multiscales", json::array({multiscale})}}}}}};
}

void addZarr(Seeds& seeds) {
    const auto add = [&](const json& group, const json& array, const std::string& chunk) {
        seeds.add("zarr", group.dump() + "\n%%\n" + array.dump() + "\n%%\n" + chunk);
    };
    add(image(true), zarrV2("|u1", nullptr), kChunk);
    add(image(true), zarrV2(">i2", {{"id", "zlib"}, {"level", 1}}), test::zlibbed(kChunk));
    add({{"creator", "a test"}}, zarrV2("<f2", {{"id", "gzip"}}), test::gzipped(kChunk));
    add(image(true), zarrV2("<u2", {{"id", "bz2"}}), test::bzipped(kChunk));
    for (const char* id : {"zstd", "blosc", "lz4"}) add(image(true), zarrV2("|b1", {{"id", id}}), kChunk);
    json turned = zarrV2("|i1", nullptr);
    turned["order"] = "F";
    add(image(true), turned, kChunk);
    const json bytes{{"name", "bytes"}, {"configuration", {{"endian", "big"}}}};
    const json turn{{"name", "transpose"}, {"configuration", {{"order", {2, 0, 1}}}}};
    add(image(false), zarrV3("uint8", {turn, bytes}, {2, 3, 4}), kChunk);
    add(image(false), zarrV3("int16", {bytes, {{"name", "gzip"}}}, {2, 3, 2}), test::gzipped(kChunk));
    json packed = zarrV3("int16", json::array({bytes}), {2, 3, 2}); // an array by itself, as xarray writes it
    packed["attributes"] = {{"scale_factor", 0.5}, {"add_offset", -2}, {"_FillValue", 7}, {"valid_range", {-5, 30000}}};
    add({{"creator", "a test"}}, packed, kChunk);
    const json shards{{"name", "sharding_indexed"},
                      {"configuration",
                       {{"chunk_shape", {2, 3, 2}},
                        {"codecs", json::array({bytes})},
                        {"index_codecs", json::array({bytes})},
                        {"index_location", "end"}}}};
    // Two chunks of 12 bytes, where they begin and how long they are.
    std::string table;
    for (const int number : {0, 12, 12, 12}) table += static_cast<char>(number) + std::string(7, '\0');
    add(image(false), zarrV3("uint8", json::array({shards}), {2, 3, 4}), kChunk + table);
    // As many chunks in a shard as 64 bits cannot count.
    json huge = shards;
    huge["configuration"]["chunk_shape"] = {1, 1, 1};
    add(image(false), zarrV3("uint8", json::array({huge}), {1 << 30, 1 << 30, 16}), kChunk);
}

/// Numbers as NetCDF has them.
class NetCdfBytes {
public:
    explicit NetCdfBytes(int version)
        : m_version(version), m_bytes("CDF" + std::string(1, static_cast<char>(version))) {}
    NetCdfBytes& number(std::uint64_t value, int width = 4) {
        while (width-- > 0) m_bytes += static_cast<char>(value >> (8 * width));
        return *this;
    }
    NetCdfBytes& size(std::uint64_t value) { return number(value, m_version == 5 ? 8 : 4); }
    NetCdfBytes& offset(std::uint64_t value) { return number(value, m_version == 1 ? 4 : 8); }
    NetCdfBytes& text(std::string text) {
        size(text.size());
        text.resize((text.size() + 3) / 4 * 4);
        m_bytes += text;
        return *this;
    }
    const std::string& bytes() const { return m_bytes; }

private:
    int m_version;
    std::string m_bytes;
};

/// Coordinates x and an array of 2 x 3 x 4 numbers of 16 bits, whose first axis may be that of the records. `sizeOfX`:
/// what the header says of it.
std::string netCdf(int version, bool hasRecords, std::uint64_t sizeOfX = 4) {
    enum { kShort = 3, kDouble = 6, kDimensions = 0x0a, kVariables, kAttributes };
    const auto headed = [&](std::uint64_t end) {
        NetCdfBytes file(version);
        file.size(hasRecords ? 2 : 0).number(kDimensions).size(3);
        file.text("z").size(hasRecords ? 0 : 2).text("y").size(3).text("x").size(sizeOfX);
        file.number(kAttributes).size(1).text("title").number(2).text("a test");
        file.number(kVariables).size(2);
        file.text("x").size(1).size(2).number(0).size(0).number(kDouble).size(32).offset(end);
        file.text("density").size(3).size(0).size(1).size(2).number(kAttributes).size(3);
        file.text("scale_factor").number(kDouble).size(1).number(0x3fe0000000000000, 8); // 0.5
        file.text("_FillValue").number(kShort).size(1).number(7, 2).number(0, 2);
        file.text("coordinates").number(2).text("x");
        file.number(kShort).size(48).offset(end + 32);
        return file.bytes();
    };
    NetCdfBytes values(version);
    for (int i = 0; i < 4; ++i) values.number(0x3ff0000000000000 + (static_cast<std::uint64_t>(i) << 51), 8);
    for (std::uint64_t i = 0; i < 24; ++i) values.number(i, 2);
    return headed(headed(0).size()) + values.bytes().substr(4);
}

void addNetCdf(Seeds& seeds) {
    for (const int version : {1, 2, 5})
        for (const bool hasRecords : {false, true}) seeds.add("netcdf", netCdf(version, hasRecords));
    seeds.add("netcdf", netCdf(5, false, std::uint64_t{1} << 61)); // bytes that 64 bits cannot count
}

void addPageWords(Seeds& seeds) {
    seeds.add("page_words", "ImageJ=1.53t\nimages=24\nchannels=2\nslices=4\nframes=3\nhyperstack=true\nunit=micron\n"
                            "finterval=0.5\nspacing=2.5\nloop=false\n");
    seeds.add("page_words", "ImageJ=1.11a\nimages=4\nframes=4\n");
    const auto ome = [](const std::string& pixels) {
        return "<?xml version=\"1.0\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image "
               "ID=\"Image:0\"><Pixels ID=\"Pixels:0\" " +
               pixels + "><TiffData/></Pixels></Image></OME>";
    };
    seeds.add("page_words", ome("DimensionOrder=\"XYZCT\" SizeX=\"3\" SizeY=\"2\" SizeZ=\"4\" SizeC=\"2\" SizeT=\"1\" "
                                "PhysicalSizeX=\"500\" PhysicalSizeXUnit=\"nm\" PhysicalSizeZ=\"0.002\" "
                                "PhysicalSizeZUnit=\"mm\" TimeIncrement=\"2\""));
    seeds.add("page_words", ome("DimensionOrder=\"XYCTZ\" SizeZ=\"1\" SizeC=\"1\" SizeT=\"5\" PhysicalSizeY=\"1e-3\""));
    seeds.add("page_words", "a microscope, 4 slices");
    seeds.add("page_words", "ImageJ=1.53t\nimages=6\nslices=6\nunit=micron\nyunit=mm\nzunit=\\u00B5m\nspacing=-3.0\n"
                            "finterval=20\ntunit=ms\ncf=0\nc0=-32768.0\nc1=1.0\nvunit=HU\nzeroclip=true\n");
    // Images, and pages in other files and in another order.
    seeds.add("page_words",
              "<OME UUID=\"urn:uuid:1\"><Image Name=\"one\"><Pixels DimensionOrder=\"XYCZT\" SizeZ=\"3\" SizeC=\"3\" "
              "SizeT=\"2\" TimeIncrement=\"5\" TimeIncrementUnit=\"ms\"><TiffData IFD=\"4\" FirstZ=\"0\" FirstC=\"1\" "
              "FirstT=\"0\" PlaneCount=\"2\"/><TiffData FirstT=\"1\"><UUID FileName=\"b.ome.tif\">urn:uuid:2</UUID>"
              "</TiffData></Pixels></Image><Image><Pixels/></Image></OME>");
    seeds.add("page_words", "<OME><BinaryOnly MetadataFile=\"a.companion.ome\" UUID=\"urn:uuid:1\"/></OME>");
}

/// A line of 16 bytes is a picture, the first one their stack: see dicom_stack.cpp.
void addDicomStacks(Seeds& seeds) {
    const auto picture = [](int number, int place, int time) {
        std::string bytes(16, '\0');
        const int all[]{number, 0, 2 * number, number, 0, 124, 124, place, time};
        for (std::size_t i = 0; i < std::size(all); ++i) bytes[i] = static_cast<char>(all[i]);
        return bytes;
    };
    const std::string head = std::string("\0\x7e\x80", 3) + std::string(13, '\0');
    std::string even = head, gap = head, steps = head, unplaced = head;
    for (int i = 0; i < 6; ++i) {
        even += picture(i, 130 + 2 * i, 0);
        gap += picture(i, 130 + 2 * i + (i > 3 ? 4 : 0), 0);
        steps += picture(i, 130 + 2 * (i / 2), 125 + i % 2);
        unplaced += picture(i, 0, 0);
        unplaced[unplaced.size() - 12] = '\xff';
    }
    for (const std::string& stack : {even, gap, steps, unplaced}) seeds.add("dicom_stack", stack);
}

} // namespace

int main(int argc, char** argv) {
    return fuzz::writeSeeds(argc, argv, [](Seeds& seeds) {
        addZarr(seeds);
        addNetCdf(seeds);
        addPageWords(seeds);
        addDicomStacks(seeds);
    });
}
