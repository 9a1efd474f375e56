// One volume in every format that is read: the same samples at the same places, whatever the file.
#include <catch2/catch.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include <hdf5.h>
#include <netcdf.h>

#include "base/round_numbers.h"
#include "base/text.h"
#include "optimize/measure.h"
#include "support/dicom_writer.h"
#include "support/temp_folder.h"
#include "support/tiff_writer.h"
#include "support/volumes.h"
#include "volume/loader.h"
#include "volume/packers.h"
#include "volume/volume_files.h"
#include "volume/volume_writer.h"
#include "volume/vtk_files.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

namespace fs = std::filesystem;

const Int3 kDims{7, 6, 5};
const Vec3 kSpacing{0.5, 1.25, 2};

/// Of 12 bits, so that DICOM has them, too.
std::vector<std::uint16_t> values() {
    std::vector<std::uint16_t> all;
    for (int z = 0; z < kDims.z; ++z)
        for (int y = 0; y < kDims.y; ++y)
            for (int x = 0; x < kDims.x; ++x) all.push_back(static_cast<std::uint16_t>(600 * z + 90 * y + 13 * x));
    return all;
}

std::string little() {
    std::vector<int> all;
    for (const std::uint16_t value : values()) all.push_back(value);
    return words(all);
}
std::string big() {
    std::string bytes = little();
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
    return bytes;
}

void writeHdf5(const std::string& path) {
    const hsize_t dims[] = {5, 6, 7};
    const double spacing[] = {2, 1.25, 0.5};
    const hsize_t three[] = {3};
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(3, dims, nullptr), ofSpacing = H5Screate_simple(1, three, nullptr);
    const hid_t data = H5Dcreate2(file, "volume", H5T_STD_U16BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_USHORT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values().data());
    const hid_t attribute = H5Acreate2(data, "element_size_um", H5T_NATIVE_DOUBLE, ofSpacing, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, spacing);
    H5Aclose(attribute);
    H5Dclose(data);
    H5Sclose(space);
    H5Sclose(ofSpacing);
    H5Fclose(file);
}

void writeNetCdf(const std::string& path, int mode, const Vec3& first = Vec3(0), const Vec3& steps = kSpacing) {
    int file = 0, dims[3], coordinates[3], data = 0;
    REQUIRE(nc_create(path.c_str(), NC_CLOBBER | mode, &file) == NC_NOERR);
    const char* const names[] = {"z", "y", "x"};
    for (int a = 0; a < 3; ++a) {
        nc_def_dim(file, names[a], static_cast<std::size_t>(kDims[2 - a]), &dims[a]);
        nc_def_var(file, names[a], NC_DOUBLE, 1, &dims[a], &coordinates[a]);
    }
    // The classic forms have no unsigned numbers of 16 bits but by a mark.
    nc_def_var(file, "volume", mode == NC_NETCDF4 ? NC_USHORT : NC_SHORT, 3, dims, &data);
    nc_enddef(file);
    for (int a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < static_cast<std::size_t>(kDims[2 - a]); ++i) {
            const double place = first[2 - a] + static_cast<double>(i) * steps[2 - a];
            nc_put_var1_double(file, coordinates[a], &i, &place);
        }
    nc_put_var_ushort(file, data, values().data());
    nc_close(file);
}

std::string writeDicom(const TempFolder& folder) {
    fs::create_directories(folder.path("dicom"));
    const std::string bytes = little();
    const std::size_t slice = static_cast<std::size_t>(kDims.x * kDims.y) * 2;
    for (int z = 0; z < kDims.z; ++z) {
        DicomSlice one;
        one.columns = kDims.x;
        one.rows = kDims.y;
        one.number = z + 1;
        one.position = "0\\0\\" + std::to_string(2 * z);
        one.spacing = "1.25\\0.5";
        one.pixels = bytes.substr(static_cast<std::size_t>(z) * slice, slice);
        folder.write("dicom/" + std::to_string(z), dicomFile(one));
    }
    return folder.path("dicom");
}

std::vector<TiffPage> tiffPages() {
    const std::string bytes = little();
    const std::size_t slice = static_cast<std::size_t>(kDims.x * kDims.y) * 2;
    std::vector<TiffPage> pages;
    for (int z = 0; z < kDims.z; ++z) {
        TiffPage page;
        page.width = kDims.x;
        page.height = kDims.y;
        page.pixels = bytes.substr(static_cast<std::size_t>(z) * slice, slice);
        pages.push_back(page);
    }
    return pages;
}

std::string writeTiff(const TempFolder& folder) {
    std::vector<TiffPage> pages = tiffPages();
    pages.front().description = "<OME><Image><Pixels DimensionOrder=\"XYZCT\" SizeX=\"7\" SizeY=\"6\" SizeZ=\"5\" "
                                "SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"1.25\" "
                                "PhysicalSizeZ=\"2\"/></Image></OME>";
    return folder.write("ome.tif", tiffFile(pages));
}

/// One page a file; pictures say nothing of spacing.
std::string writePictures(const TempFolder& folder) {
    fs::create_directories(folder.path("pictures"));
    const std::vector<TiffPage> pages = tiffPages();
    for (std::size_t z = 0; z < pages.size(); ++z)
        folder.write("pictures/" + std::to_string(z) + ".tif", tiffFile({pages[z]}));
    return folder.path("pictures");
}

/// Halves that share the layer z = 2, each in a file of its own.
std::string writePieces(const TempFolder& folder, const std::string& placed) {
    const std::string image = "WholeExtent=\"0 6 0 5 0 4\" " + placed;
    const std::string type = "type=\"UInt16\" Name=\"v\"", low = "0 6 0 5 0 2", high = "0 6 0 5 2 4";
    const std::size_t slice = static_cast<std::size_t>(kDims.x * kDims.y) * 2;
    const Style style{Style::Place::Raw};
    folder.write("low.vti", vti(style, {{type, "", little().substr(0, 3 * slice)}}, "", image, low));
    folder.write("high.vti", vti(style, {{type, "", little().substr(2 * slice)}}, "", image, high));
    return folder.write("a.pvti", pvti(image, {type}, {{low, "low.vti"}, {high, "high.vti"}}));
}

/// A header for the samples, which say nothing of axes.
Nifti niftiHeader() {
    Nifti nifti;
    nifti.dim = {3, 7, 6, 5, 1, 1, 1, 1};
    nifti.pixdim = {1, 0.5f, 1.25f, 2, 1, 1, 1, 1};
    nifti.datatype = 512; // unsigned, 16 bits
    nifti.bitpix = 16;
    return nifti;
}

/// Of three features, from a side that is along no axis: another spacing, order or place of samples makes others.
Measures measured(const std::shared_ptr<const Volume>& volume) {
    const TransferFunction tf = tents(3);
    return measure(*makeCpuEngine(volume), lookingAlong(volume->geometry(), glm::normalize(Vec3(1, 2, 3))), tf,
                   saliencyFields(*volume, tf));
}

} // namespace

TEST_CASE("the same content in every format is the same volume", "[same]") {
    const TempFolder folder;
    Geometry g;
    g.dims = kDims;
    g.spacing = kSpacing;
    const auto stored = std::make_shared<const Volume>(g, SampleArray<std::uint16_t>(values()));
    const Volume& volume = *stored;
    std::map<std::string, std::string> files;
    for (const char* suffix : {".nrrd", ".mha", ".mhd", ".nii", ".nii.gz", ".vti", ".tif", ".zarr"}) {
        files[suffix] = folder.path(std::string("own") + suffix);
        CHECK(writeVolume(volume, files[suffix]).empty());
    }
    const std::string
        legacy = "# vtk DataFile Version 3.0\nvolume\n",
        points = "DATASET STRUCTURED_POINTS\nDIMENSIONS 7 6 5\nSPACING 0.5 1.25 2\nORIGIN 0 0 0\nPOINT_DATA 210\n"
                 "SCALARS v unsigned_short 1\nLOOKUP_TABLE default\n";
    std::string text;
    for (const std::uint16_t value : values()) text += std::to_string(value) + "\n";
    files["legacy VTK, ASCII"] = folder.write("a.vtk", legacy + "ASCII\n" + points + text);
    files["legacy VTK, binary"] = folder.write("b.vtk", legacy + "BINARY\n" + points + big());
    files["PVM"] = folder.write("a.pvm", "PVM2\n7 6 5\n0.5 1.25 2\n2\n" + big());
    folder.write("data.raw", little());
    files["Voreen"] =
        folder.write("voreen.dat", "ObjectFileName: data.raw\nResolution: 7 6 5\nSliceThickness: 0.5 1.25 2\n"
                                   "Format: USHORT\nObjectModel: I\n");
    files["Inviwo"] =
        folder.write("inviwo.dat", "RawFile: data.raw\nResolution: 7 6 5\nFormat: UINT16\n"
                                   "BasisVector1: 3.5 0 0\nBasisVector2: 0 7.5 0\nBasisVector3: 0 0 10\n");
    files["VVD"] = folder.write(
        "a.vvd",
        "<?xml version=\"1.0\" ?><VoreenData version=\"1\"><Volumes><Volume><RawData filename=\"data.raw\" "
        "format=\"uint16\" x=\"7\" y=\"6\" z=\"5\" /><MetaData><MetaItem name=\"Spacing\" type=\"Vec3MetaData\">"
        "<value x=\"0.5\" y=\"1.25\" z=\"2\" /></MetaItem></MetaData></Volume></Volumes></VoreenData>");
    files["scene"] =
        folder.write("a.mrml", "<MRML><Volume name=\"v\" storageNodeRef=\"s\"/><VolumeArchetypeStorage id=\"s\" "
                               "fileName=\"own.nrrd\"/></MRML>");
    const std::string nrrd = "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 7 6 5\nspacings: 0.5 1.25 2\n"
                             "endian: little\nencoding: ";
    files["NRRD, bzip2"] = folder.write("bzip2.nrrd", nrrd + "bzip2\n\n" + bzipped(little()));
    files["NRRD, two files"] = folder.write("a.nhdr", nrrd + "raw\ndata file: data.raw\n");
    Nifti nifti = niftiHeader();
    files["NIfTI-2"] = folder.write("two.nii", nifti.header2() + little());
    files["NIfTI-2, gzip"] = folder.write("two.nii.gz", gzipped(nifti.header2() + little()));
    nifti.magic = "ni1";
    nifti.voxOffset = 0;
    folder.write("pair.img", little());
    files["NIfTI, two files"] = folder.write("pair.hdr", nifti.header());
    files["VTK in pieces"] = writePieces(folder, "Origin=\"0 0 0\" Spacing=\"0.5 1.25 2\"");
    files["VTK collection"] =
        folder.write("a.pvd", "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
                              "<DataSet timestep=\"0\" file=\"own.vti\"/></Collection></VTKFile>\n");
    files["raw"] = folder.path("data.raw");
    files["raw, gzip"] = folder.write("packed.raw.gz", gzipped(little()));
    files["pictures"] = writePictures(folder);
    writeHdf5(files["HDF5"] = folder.path("a.h5"));
    writeNetCdf(files["NetCDF-4"] = folder.path("a.nc"), NC_NETCDF4);
    writeNetCdf(files["NetCDF, classic"] = folder.path("b.nc"), 0);
    files["DICOM"] = writeDicom(folder);
    files["OME-TIFF"] = writeTiff(folder);
    const Measures expected = measured(stored);
    REQUIRE(expected.features.size() == 3);
    for (const FeatureMeasures& feature : expected.features) CHECK((feature.visibility > 0 && feature.vws > 0));
    for (const auto& [format, path] : files) {
        CAPTURE(format);
        VolumeSource source;
        source.path = path;
        if (format.starts_with("raw")) {
            source.raw = parseRawLayout("7,6,5,u16");
            source.spacing = GridSpacing{kSpacing};
        }
        const auto loaded = std::make_shared<const Volume>(loadVolume(source));
        const Volume& read = *loaded;
        CHECK(read.dims() == kDims);
        CHECK(read.dataRange() == volume.dataRange());
        CHECK(read.invalidCount() == 0);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < volume.size(); ++i) wrong += read.value(i) != volume.value(i) ? 1u : 0u;
        CHECK(wrong == 0);
        Geometry placed = g;
        if (format == "pictures") placed.spacing = Vec3(1);
        CHECK(glm::length(read.geometry().spacing - placed.spacing) < 1e-6);
        // Where each voxel lies to the first one. Inviwo's box begins at its corner, not at a centre.
        const Vec3 far = read.geometry().worldFromVoxel(Vec3(kDims - 1)) - read.geometry().worldFromVoxel(Vec3(0));
        CHECK(glm::length(far - Vec3(kDims - 1) * placed.spacing) < 1e-5);
        const Measures found = measured(loaded);
        const Measures& same =
            format == "pictures"
                ? measured(std::make_shared<const Volume>(placed, SampleArray<std::uint16_t>(values())))
                : expected;
        REQUIRE(found.features.size() == same.features.size());
        for (std::size_t f = 0; f < same.features.size(); ++f) {
            CHECK(found.features[f].visibility == same.features[f].visibility);
            CHECK(found.features[f].vws == same.features[f].vws);
        }
        CHECK(found.visibilityHistogram == same.visibilityHistogram);
    }
}

namespace {

using WriteGrid = std::function<std::string(const TempFolder& folder, const Geometry& g)>; ///< returns the path

std::string numbersOf(const Vec3& v) { return exactText(v.x) + " " + exactText(v.y) + " " + exactText(v.z); }

/// The matrix whose columns are a grid's directions and its origin: the first three numbers of each row, and the
/// fourth.
std::string rowOf(const Geometry& g, int row) {
    return numbersOf(Vec3(g.directions[0][row], g.directions[1][row], g.directions[2][row])) + " " +
           exactText(g.origin[row]);
}

std::string voreenHeader(const TempFolder& folder, const Geometry& g) {
    std::string text = "ObjectFileName: data.raw\nResolution: 7 6 5\nFormat: USHORT\n";
    text += "SliceThickness: " + numbersOf(g.spacing) + "\nOffset: " + numbersOf(-0.5 * g.spacing) + "\n";
    for (int row = 0; row < 3; ++row) text += "WorldVector" + std::to_string(row + 1) + ": " + rowOf(g, row) + "\n";
    return folder.write("a.dat", text);
}

/// Edges of the whole box, whose corner is half a voxel before the first one's centre.
std::string inviwoHeader(const TempFolder& folder, const Geometry& g) {
    std::string text = "RawFile: data.raw\nResolution: 7 6 5\nFormat: UINT16\n";
    const Mat3 edges(g.directions[0] * (7 * g.spacing.x), g.directions[1] * (6 * g.spacing.y),
                     g.directions[2] * (5 * g.spacing.z));
    for (int row = 0; row < 3; ++row)
        text += "BasisVector" + std::to_string(row + 1) + ": " +
                numbersOf(Vec3(edges[0][row], edges[1][row], edges[2][row])) + "\n";
    return folder.write("a.dat", text + "Offset: " + numbersOf(g.origin - g.directions * (0.5 * g.spacing)) + "\n");
}

std::string vvdFile(const TempFolder& folder, const Geometry& g) {
    const auto attributes = [](const std::string& numbers) {
        const std::vector<std::string> words = splitWords(numbers);
        std::string text;
        for (std::size_t i = 0; i < words.size(); ++i) text += std::string(" ") + "xyzw"[i] + "=\"" + words[i] + "\"";
        return text;
    };
    std::string rows;
    for (int row = 0; row < 4; ++row)
        rows += "<value.row" + std::to_string(row) + attributes(row < 3 ? rowOf(g, row) : "0 0 0 1") + "/>";
    return folder.write("a.vvd", "<?xml version=\"1.0\" ?><VoreenData version=\"1\"><Volumes><Volume>"
                                 "<RawData filename=\"data.raw\" format=\"uint16\" x=\"7\" y=\"6\" z=\"5\"/><MetaData>"
                                 "<MetaItem name=\"Spacing\" type=\"Vec3MetaData\"><value" +
                                     attributes(numbersOf(g.spacing)) +
                                     "/></MetaItem><MetaItem name=\"Transformation\" type=\"Mat4MetaData\">" + rows +
                                     "</MetaItem></MetaData></Volume></Volumes></VoreenData>");
}

std::string piecesFile(const TempFolder& folder, const Geometry& g) {
    std::string direction;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) direction += " " + exactText(g.directions[column][row]);
    return writePieces(folder, "Origin=\"" + numbersOf(g.origin) + "\" Spacing=\"" + numbersOf(g.spacing) +
                                   "\" Direction=\"" + direction.substr(1) + "\"");
}

/// Places are first and step along each axis, which may be below 0.
double stepAlong(const Geometry& g, int axis) { return g.directions[axis][axis] * g.spacing[axis]; }

WriteGrid netCdfFile(int mode) {
    return [mode](const TempFolder& folder, const Geometry& g) {
        const Vec3 steps(stepAlong(g, 0), stepAlong(g, 1), stepAlong(g, 2));
        writeNetCdf(folder.path("a.nc"), mode, g.origin, steps);
        return folder.path("a.nc");
    };
}

std::string zarrFolder(const TempFolder& folder, const Geometry& g) {
    const auto list = [](const Vec3& v) { // slowest first
        return "[" + exactText(v.z) + "," + exactText(v.y) + "," + exactText(v.x) + "]";
    };
    fs::create_directories(folder.path("a.zarr/0"));
    folder.write("a.zarr/.zgroup", "{\"zarr_format\":2}");
    folder.write("a.zarr/.zattrs",
                 "{\"multiscales\":[{\"version\":\"0.4\",\"axes\":[{\"name\":\"z\",\"type\":\"space\"},{\"name\":\"y\","
                 "\"type\":\"space\"},{\"name\":\"x\",\"type\":\"space\"}],\"datasets\":[{\"path\":\"0\","
                 "\"coordinateTransformations\":[{\"type\":\"scale\",\"scale\":" +
                     list({stepAlong(g, 0), stepAlong(g, 1), stepAlong(g, 2)}) +
                     "},{\"type\":\"translation\",\"translation\":" + list(g.origin) + "}]}]}]}");
    folder.write("a.zarr/0/.zarray",
                 "{\"zarr_format\":2,\"shape\":[5,6,7],\"chunks\":[5,6,7],\"dtype\":\"<u2\",\"compressor\":null,"
                 "\"fill_value\":0,\"order\":\"C\",\"filters\":null,\"dimension_separator\":\".\"}");
    folder.write("a.zarr/0/0.0.0", little());
    return folder.path("a.zarr");
}

WriteGrid ownWriter(const std::string& suffix) {
    return [suffix](const TempFolder& folder, const Geometry& g) {
        writeVolume(Volume(g, SampleArray<std::uint16_t>(values())), folder.path("a" + suffix));
        return folder.path("a" + suffix);
    };
}

} // namespace

// DICOM is in dicom_test.cpp. These have no directions, only spacing: TIFF and pictures, PVM, HDF5, legacy VTK, raw
// data. A .mrml and a .pvd have those of the file that they name.
TEST_CASE("axes that run backwards or aslant are kept by every format that has directions", "[same]") {
    struct Format {
        std::string name;
        WriteGrid write;
        bool isOfPatient = false;
        bool isAlongAxes = false; ///< has no directions but those of the world's axes and against them
    };
    std::vector<Format> formats{{"Voreen", voreenHeader},
                                {"Inviwo", inviwoHeader},
                                {"VVD", vvdFile},
                                {"VTK in pieces", piecesFile},
                                {"NetCDF-4", netCdfFile(NC_NETCDF4), false, true},
                                {"NetCDF, classic", netCdfFile(0), false, true},
                                {"OME-Zarr", zarrFolder, false, true},
                                {".vti", ownWriter(".vti")}};
    for (const char* suffix : {".nrrd", ".mha", ".mhd", ".nii", ".nii.gz"})
        formats.push_back({suffix, ownWriter(suffix), true});
    std::vector<Mat3> orientations;
    for (int flips = 0; flips < 8; ++flips) {
        Mat3 directions(1);
        for (int a = 0; a < 3; ++a) directions[a][a] = (flips >> a & 1) != 0 ? -1 : 1;
        orientations.push_back(directions);
    }
    orientations.push_back(Mat3(Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, 1, 0))); // i down, j along x, k along y
    // Turned by the angle of 3 : 4 : 5 about z, then i and k against it.
    orientations.push_back(Mat3(Vec3(-0.8, -0.6, 0), Vec3(-0.6, 0.8, 0), Vec3(0, 0, -1)));
    for (std::size_t o = 0; o < orientations.size(); ++o)
        for (const Format& format : formats) {
            if (format.isAlongAxes && o >= 8) continue;
            CAPTURE(o, format.name);
            const TempFolder folder;
            folder.write("data.raw", little());
            Geometry g;
            g.dims = kDims;
            g.spacing = kSpacing;
            g.origin = {-3, 4, 5};
            g.worldAxes = format.isOfPatient ? WorldAxes::Patient : WorldAxes::File;
            g.directions = orientations[o];
            VolumeSource source;
            source.path = format.write(folder, g);
            const Volume read = loadVolume(source);
            CHECK(read.geometry().worldAxes == g.worldAxes);
            for (const Vec3& voxel : {Vec3(0), Vec3(6, 0, 0), Vec3(0, 5, 0), Vec3(0, 0, 4)})
                CHECK(glm::length(read.geometry().worldFromVoxel(voxel) - g.worldFromVoxel(voxel)) < 1e-5);
            CHECK(read.value(voxelIndex(kDims, 6, 0, 0)) == 78);
        }
}
