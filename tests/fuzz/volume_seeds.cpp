// fuzz_volume_seeds FOLDER: files of volumes as our own writers and the tests make them, and what readers answer.
#include <nlohmann/json.hpp>

#include "data_beside.h"
#include "seeds.h"
#include "volume/dds_packer.h"
#include "volume/flipped_bits.h"
#include "volume/process/reader_messages.h"
#include "volume/volume_writer.h"

using namespace pellucid;
using namespace pellucid::test;
using fuzz::Seeds;

namespace {

/// 3 x 4 x 2 voxels; their axes are turned, their spacings differ.
Volume smallVolume(SampleType type) {
    Geometry geometry;
    geometry.dims = {3, 4, 2};
    geometry.spacing = {0.5, 1, 2};
    geometry.origin = {-1, 2, 3};
    geometry.directions = Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
    std::vector<float> values;
    for (int i = 0; i < 24; ++i) values.push_back(static_cast<float>(i % 7));
    const TempFolder folder;
    writeVolume(Volume(geometry, SampleArray<float>(std::move(values))), folder.path("a.nrrd"), {type});
    VolumeSource source;
    source.path = folder.path("a.nrrd");
    return loadVolume(source);
}

/// As this program writes them.
void addWritten(Seeds& seeds) {
    const TempFolder folder;
    for (int type = 0; type <= static_cast<int>(SampleType::F64); ++type) {
        const Volume volume = smallVolume(static_cast<SampleType>(type));
        for (const auto& [target, suffix] : std::initializer_list<std::pair<const char*, const char*>>{
                 {"nrrd", ".nrrd"}, {"mha", ".mha"}, {"nifti", ".nii"}, {"nifti_gz", ".nii.gz"}, {"vti", ".vti"}}) {
            const std::string path = folder.path(std::string("a") + suffix);
            writeVolume(volume, path);
            seeds.add(target, fuzz::bytesIn(path));
        }
    }
}

/// As other programs pack them.
void addPacked(Seeds& seeds) {
    const std::map<std::string, std::string> targets{
        {".nrrd", "nrrd"}, {".mha", "mha"}, {".nii.gz", "nifti_gz"}, {".vti", "vti"}};
    for (const PackedFile& file : packedFiles(10))
        if (const auto target = targets.find(file.suffix); target != targets.end() && file.header.empty())
            seeds.add(target->second, file.bytes);
}

void addNrrd(Seeds& seeds) {
    const auto header = [](const std::string& fields) { return "NRRD0005\n# a remark\ntype: uchar\n" + fields; };
    const std::string cube = "dimension: 3\nsizes: 2 3 4\n";
    seeds.add("nrrd", header(cube +
                             "encoding: raw\nspace: left-posterior-superior\nspace origin: (1,2,3)\n"
                             "space directions: (1,0,0) (0,2,0) (0,0,-3)\nspace units: \"mm\" \"mm\" \"um\"\n"
                             "kinds: domain domain domain\ncenterings: cell cell cell\n\n" +
                             fuzz::kDataBeside));
    seeds.add("nrrd", header(cube + "encoding: ascii\nspacings: 1 2 3\naxis mins: 0 1 2\nlabels: \"x\" \"y\" \"z\"\n\n"
                                    "1 2 3 4 5 6 7 8 9 10 11 12\n13 14 15 16 17 18 19 20 21 22 23 24\n"));
    seeds.add("nrrd", header(cube + "encoding: hex\nbyte skip: 0\nline skip: 1\nkey:=value\n\na line\n"
                                    "0102030405060708090a0b0c 0d0e0f101112131415161718\n"));
    seeds.add("nrrd", header(cube + "encoding: bzip2\nold min: 0\nold max: 1\n\n" + bzipped(fuzz::kDataBeside)));
    seeds.add("nrrd", header("dimension: 4\nsizes: 3 2 2 2\nkinds: vector domain domain time\nbyte skip: -1\n"
                             "encoding: raw\nspace dimension: 3\nspacings: nan 1 1 0.5\n\n" +
                             fuzz::kDataBeside));
    for (const char* files :
         {"encoding: raw\ndata file: d.raw\n", "encoding: gzip\ndata file: d.gz\n",
          "encoding: bzip2\ndatafile: d.bz2\n", "encoding: text\ndata file: d.txt\n",
          "encoding: raw\ndata file: LIST\ns0.raw\ns1.raw\ns2.raw\ns3.raw\n",
          "encoding: raw\ndata file: LIST 2\ns3.raw\ns1.raw\ns2.raw\ns0.raw\n",
          "encoding: raw\ndata file: s%d.raw 0 3 1\n", "encoding: raw\ndata file: s%01d.raw 3 0 -1 2\n",
          "encoding: raw\nbyte skip: -1\ndata file: d.raw\n"})
        seeds.add("nhdr", header(cube + files));
}

void addMetaImage(Seeds& seeds) {
    const std::string header = "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\n";
    seeds.add("mha", header +
                         "BinaryData = False\nElementSpacing = 1 2 3\nElementDataFile = LOCAL\n1 2 3 4 5 6 7 8 9 10 "
                         "11 12 13 14 15 16 17 18 19 20 21 22 23 24\n");
    seeds.add("mha", header +
                         "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 1 2 3\nAnatomicalOrientation = RAI\n"
                         "BinaryDataByteOrderMSB = True\nHeaderSize = -1\nElementDataFile = LOCAL\n" +
                         fuzz::kDataBeside);
    seeds.add("mha", "NDims = 2\nDimSize = 2 2\nElementType = MET_SHORT\nElementNumberOfChannels = 3\n"
                     "ElementByteOrderMSB = True\nElementDataFile = LOCAL\n" +
                         fuzz::kDataBeside);
    for (const char* files :
         {"ElementDataFile = d.raw\n", "CompressedData = True\nCompressedDataSize = 32\nElementDataFile = d.zz\n",
          "CompressedData = True\nElementDataFile = d.gz\n", "BinaryData = False\nElementDataFile = d.txt\n",
          "HeaderSize = -1\nElementDataFile = d.raw\n", "ElementDataFile = LIST\ns0.raw\ns1.raw\ns2.raw\ns3.raw\n",
          "ElementDataFile = LIST 2D\ns0.raw\ns1.raw\ns2.raw\ns3.raw\n", "ElementDataFile = s%d.raw 0 3 1\n"})
        seeds.add("mhd", header + files);
}

void addNifti(Seeds& seeds) {
    Nifti nifti;
    nifti.qformCode = nifti.sformCode = 1;
    nifti.qform = {0, 0, 0.70710678f, 1, 2, 3};
    nifti.sform = {1, 0, 0, 5, 0, 2, 0, 6, 0, 0, 3, 7};
    nifti.slope = 2;
    nifti.intercept = -1;
    nifti.units = 10;
    for (const char* target : {"nifti", "nifti_gz"}) {
        seeds.add(target, nifti.header() + fuzz::kDataBeside);
        seeds.add(target, nifti.header2() + fuzz::kDataBeside);
        Nifti other = nifti;
        other.dim = {5, 2, 3, 1, 2, 2, 1, 1};
        other.sformCode = 0;
        seeds.add(target, other.header() + fuzz::kDataBeside);
    }
    Nifti pair = nifti;
    pair.magic = "ni1";
    pair.voxOffset = 0;
    seeds.add("nifti", pair.header());
    seeds.add("nifti", pair.header2(0, "ni2"));
}

void addVtk(Seeds& seeds) {
    const std::vector<Array> arrays{
        {"type=\"UInt8\" Name=\"a &amp; b\"", "1 2 3 4 5 6", "abcdef"},
        {"type=\"UInt8\" Name=\"v\" NumberOfComponents=\"2\"", "1 2 3 4 5 6 7 8 9 10 11 12", "abcdefghijkl"}};
    for (const Style::Place place :
         {Style::Place::Ascii, Style::Place::Inline, Style::Place::Raw, Style::Place::Base64})
        for (const bool compressed : {false, true})
            seeds.add("vti", vti({place, compressed, !compressed, compressed, 4}, arrays, " Scalars=\"v\""));
    const std::string image = "WholeExtent=\"0 1 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
    seeds.add("vti", vtiOfPieces({},
                                 {{"0 1 0 1 0 0", {{"type=\"Int16\" Name=\"v\"", "1 2 3 4", ""}}},
                                  {"0 1 1 2 0 0", {{"type=\"Int16\" Name=\"v\"", "3 4 5 6", ""}}}},
                                 "", image + " Direction=\"0 1 0 -1 0 0 0 0 1\""));
    seeds.add("pvti", pvti(image, {"type=\"UInt8\" Name=\"v\""}, {{"0 1 0 1 0 0", "a.vti"}, {"0 1 1 2 0 0", "b.vti"}}));
    const std::string frames = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"><Collection>"
                               "<DataSet timestep=\"0.5\" part=\"0\" file=\"a.vti\"/><!-- more -->"
                               "<DataSet timestep=\"1e3\" file='b.vti'/></Collection></VTKFile>\n";
    seeds.add("pvd", frames);
    seeds.add("xml_tags", frames);
    seeds.add("xml_tags", vti({}, arrays) + "<a b=\"&#x41;&lt;&#66;\" c='\"'/><![CDATA[ <x> ]]><?y ?>");
}

/// Numbers of 16 bits, the high byte first.
std::string bigEndianShorts(int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i) bytes += {static_cast<char>(i / 7 - 1), static_cast<char>(i * 37)};
    return bytes;
}

void addLegacyVtk(Seeds& seeds) {
    const auto vtk = [](const char* kind, const std::string& grid, const std::string& body) {
        return "# vtk DataFile Version 3.0\na title\n" + std::string(kind) + "\nDATASET " + grid + body;
    };
    const std::string points = "STRUCTURED_POINTS\nDIMENSIONS 2 3 4\nSPACING 1 2 3\nORIGIN 5 6 7\n";
    const std::string numbers = "1 2 3 4 5 6 7 8 9 10 11 12\n13 14 15 16 17 18 19 20 21 22 23 24\n";
    const std::string table = "LOOKUP_TABLE default\n";
    seeds.add("vtk", vtk("ASCII", points, "POINT_DATA 24\nSCALARS density float 1\n" + table + numbers));
    seeds.add("vtk", vtk("ASCII", points,
                         "CELL_DATA 6\nSCALARS c int\n" + table + "1 2 3 4 5 6\nPOINT_DATA 24\nVECTORS v double\n" +
                             numbers + numbers + numbers));
    seeds.add("vtk", vtk("ASCII", points,
                         "POINT_DATA 24\nFIELD FieldData 2\na 1 24 int\n" + numbers + "METADATA\nINFORMATION 0\n\n" +
                             "b%20c 1 24 unsigned_char\n" + numbers));
    seeds.add("vtk", vtk("BINARY", points, "POINT_DATA 24\nSCALARS density short\n" + table + bigEndianShorts(24)));
    seeds.add("vtk", vtk("BINARY", points,
                         "POINT_DATA 24\nCOLOR_SCALARS c 2\n" + bigEndianShorts(24) + "\nNORMALS n unsigned_short\n" +
                             bigEndianShorts(72)));
    seeds.add("vtk", vtk("BINARY", points,
                         "POINT_DATA 24\nSCALARS a unsigned_char\nLOOKUP_TABLE t\n" + fuzz::kDataBeside +
                             "\nLOOKUP_TABLE t 2\n\1\2\3\4\5\6\7\10"));
    seeds.add("vtk", vtk("ASCII",
                         "RECTILINEAR_GRID\nDIMENSIONS 2 3 4\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 3 float\n"
                         "0 2 4\nZ_COORDINATES 4 double\n0 3 6 9\n",
                         "POINT_DATA 24\nSCALARS a int\n" + table + numbers));
}

void addPvm(Seeds& seeds) {
    const std::string one = "PVM\n2 3 4\n1\n" + fuzz::kDataBeside;
    const std::string two = "PVM2\n# a remark\n2 3 2\n1 1.5 2\n2\n" + fuzz::kDataBeside;
    const std::string three = "PVM3\n2 2 2\n1 1 1.4\n3\n" + fuzz::kDataBeside + "a\nb\nc\nd\n";
    for (const std::string& plain : {one, two, three}) {
        seeds.add("pvm", plain);
        seeds.add("pvm", dds(plain));
        seeds.add("pvm", dds(plain, 2, 3));
        seeds.add("pvm", dds(plain, 3, 2, true));
    }
}

void addVoreenAndInviwo(Seeds& seeds) {
    const std::string voreen = "ObjectFileName: d.raw\nTaggedFileName: ---\nResolution: 2 3 4\n";
    seeds.add("dat", voreen + "SliceThickness: 1 1.5 2 # mm\nFormat: UCHAR\nObjectModel: I\nGridType: EQUIDISTANT\n");
    seeds.add("dat", "# a remark\nObjectFileName: d.raw\nResolution: 2 2 2\nFormat: UCHAR\nObjectModel: RGB\n");
    seeds.add("dat", "RawFile: d.raw\nResolution: 2 3 2\nFormat: UINT16\nBasisVector1: 2 0 0\nBasisVector2: 0 3 0\n"
                     "BasisVector3: 0 0 4\nOffset: 1 2 3\nWorldVector1: 1 0 0 0\nWorldVector2: 0 1 0 0\n"
                     "WorldVector3: 0 0 1 5\nWorldVector4: 0 0 0 1\nDataRange: 0 4095\nValueRange: -1 1\n"
                     "ByteOrder: BigEndian\n");
    seeds.add("dat", "RawFile: d.raw\nDimensions: 2 2 2\nFormat: Vec3UINT8\nSpacing: 1 1 2\nSequences: 1\n"
                     "ByteOffset: 0\n");
    seeds.add("dat", voreen + "Format: UCHAR\nTransformMatrix: row0 0 1 0 0\nTransformMatrix: row1 -1 0 0 0\n");
    seeds.add("dat", "ObjectFileName: d.raw\nResolution: 2 3 2\nNumFrames: 2\nFormat: CHAR\n");
    const auto vvd = [](const std::string& volumes) {
        return "<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n<Volumes>\n" + volumes +
               "</Volumes>\n</VoreenData>\n";
    };
    const auto volume = [](const std::string& raw, const std::string& items) {
        return "<Volume>\n<RawData filename=\"" + raw + "\" x=\"2\" y=\"3\" z=\"2\" />\n<MetaData>\n" + items +
               "</MetaData>\n</Volume>\n";
    };
    const std::string place = "<MetaItem name=\"Spacing\" type=\"Vec3MetaData\">\n<value x=\"1\" y=\"2\" z=\"3\" />\n"
                              "</MetaItem>\n<MetaItem name=\"Offset\" type=\"Vec3MetaData\">\n"
                              "<value x=\"-1\" y=\"0\" z=\"0.5\" />\n</MetaItem>\n";
    const std::string matrix =
        "<MetaItem name=\"Transformation\" type=\"Mat4MetaData\">\n<value>\n"
        "<row0 x=\"0\" y=\"1\" z=\"0\" w=\"0\" />\n<row1 x=\"-1\" y=\"0\" z=\"0\" w=\"0\" />\n"
        "<row2 x=\"0\" y=\"0\" z=\"1\" w=\"0\" />\n<row3 x=\"0\" y=\"0\" z=\"0\" w=\"1\" />\n</value>\n</MetaItem>\n";
    const std::string mapping = "<MetaItem name=\"RealWorldMapping\" type=\"RealWorldMappingMetaData\">\n"
                                "<value scale=\"65535\" offset=\"-1024\" unit=\"HU\" />\n</MetaItem>\n";
    const std::string time = "<MetaItem name=\"Timestep\" type=\"FloatMetaData\" value=\"2.5\" />\n";
    seeds.add("vvd", vvd(volume("d.raw\" format=\"uint16", place + mapping)));
    seeds.add("vvd", vvd(volume("d.raw\" format=\"int8", matrix + time)));
    seeds.add("vvd", vvd(volume("d.raw\" format=\"Vector2(uint8)", "") + volume("s0.raw\" format=\"uint8", place)));
}

void addScenes(Seeds& seeds) {
    const std::string files = "<VolumeArchetypeStorage id=\"s1\" fileName=\"a.nrrd\"></VolumeArchetypeStorage>\n"
                              "<VolumeArchetypeStorage id=\"s2\" fileName=\"%62.mha\"></VolumeArchetypeStorage>\n"
                              "<VolumeArchetypeStorage id=\"s3\" fileName=\"c.vti\"></VolumeArchetypeStorage>\n";
    const auto scene = [&](const std::string& volumes) {
        return "<MRML version=\"Slicer 5.2.2\">\n" + volumes + files + "</MRML>\n";
    };
    seeds.add("mrml",
              scene("<Volume id=\"v1\" name=\"CT &amp; chest\" references=\"display:d1;storage:s1;\"></Volume>\n"
                    "<Volume id=\"v2\" name=\"MR\" storageNodeRef=\"s2\"></Volume>\n"));
    seeds.add("mrml", scene("<Volume name=\"MR\" storageNodeRef=\"s2\"/><Volume name=\"MR\" storageNodeRef=\"s1\"/>"));
    seeds.add("mrml", scene("<Volume name=\"itself\" storageNodeRef=\"s3\"/>"));
}

void addRaw(Seeds& seeds) {
    seeds.add("raw", "2,3,4,u8\n" + fuzz::kDataBeside);
    seeds.add("raw", "2,3,1,i16,big 12\n" + fuzz::kDataBeside);
    seeds.add("raw", "2,1,1,f64 8\n" + fuzz::kDataBeside);
    seeds.add("raw", "2,3,2,u8\n" + gzipped(fuzz::kDataBeside));
}

void addStreams(Seeds& seeds) {
    const std::string zeros(1'500'000, '\0'), some = wavesAndNoise(8, 1);
    seeds.add("inflate", gzipped(fuzz::kDataBeside));
    seeds.add("inflate", gzipped(some) + gzipped("") + gzipped(some) + std::string(20, '\0'));
    seeds.add("inflate", zlibbed(some));
    seeds.add("inflate", gzipped(zeros));
    seeds.add("bzip2", bzipped(fuzz::kDataBeside));
    seeds.add("bzip2", bzipped(some, 1) + bzipped(some));
    seeds.add("bzip2", bzipped(zeros) + std::string(20, '\0'));
}

void addMessages(Seeds& seeds) {
    ReaderLayout answer;
    answer.layout.axes = {{3, true, false}, {4, false, false}, {5, false, false}, {6, false, false}, {2, false, true}};
    answer.layout.notices = {"a remark"};
    answer.missing = -1;
    answer.inFile = {8, 4096};
    answer.levels = {{{2, 3, 3}, {2, 2, 2}, {2, 2, 2}, {0.5, 0.5, 0.5}}};
    FileContents contents;
    contents.dims = {4, 5, 6};
    contents.times = {0, 1};
    contents.arrays = contents.details = {"a", "b"};
    ReaderRequest request;
    request.path = "a.tif";
    for (const nlohmann::json& message :
         {jsonOf(answer), jsonOf(ReaderDescription{contents, {"a.tif", "b.tif"}}), jsonOf(request),
          jsonOf(ReaderBox{1, {Int3(0), Int3(2)}, 0}), jsonOf(FileError("it is damaged", "a.tif", "copy it again"))})
        seeds.add("reader_messages", message.dump());
}

} // namespace

int main(int argc, char** argv) {
    return fuzz::writeSeeds(argc, argv, [](Seeds& seeds) {
        addWritten(seeds);
        addPacked(seeds);
        addNrrd(seeds);
        addMetaImage(seeds);
        addNifti(seeds);
        addVtk(seeds);
        addLegacyVtk(seeds);
        addPvm(seeds);
        addVoreenAndInviwo(seeds);
        addScenes(seeds);
        addRaw(seeds);
        addStreams(seeds);
        addMessages(seeds);
    });
}
