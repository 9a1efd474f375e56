// One volume in every format that is read: the same samples at the same places, whatever the file.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <hdf5.h>
#include <netcdf.h>

#include "support/dicom_writer.h"
#include "support/temp_folder.h"
#include "support/tiff_writer.h"
#include "volume/loader.h"
#include "volume/robust_range.h"
#include "volume/volume_writer.h"

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

void writeNetCdf(const std::string& path, int mode) {
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
            const double place = static_cast<double>(i) * kSpacing[2 - a];
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

std::string writeTiff(const TempFolder& folder) {
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
    pages.front().description = "<OME><Image><Pixels DimensionOrder=\"XYZCT\" SizeX=\"7\" SizeY=\"6\" SizeZ=\"5\" "
                                "SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"1.25\" "
                                "PhysicalSizeZ=\"2\"/></Image></OME>";
    return folder.write("ome.tif", tiffFile(pages));
}

} // namespace

TEST_CASE("the same content in every format is the same volume", "[same]") {
    const TempFolder folder;
    Geometry g;
    g.dims = kDims;
    g.spacing = kSpacing;
    const Volume volume(g, SampleArray<std::uint16_t>(values()));
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
    writeHdf5(files["HDF5"] = folder.path("a.h5"));
    writeNetCdf(files["NetCDF-4"] = folder.path("a.nc"), NC_NETCDF4);
    writeNetCdf(files["NetCDF, classic"] = folder.path("b.nc"), 0);
    files["DICOM"] = writeDicom(folder);
    files["OME-TIFF"] = writeTiff(folder);
    for (const auto& [format, path] : files) {
        CAPTURE(format);
        VolumeSource source;
        source.path = path;
        const Volume read = loadVolume(source);
        CHECK(read.dims() == kDims);
        CHECK(read.dataRange() == volume.dataRange());
        CHECK(read.invalidCount() == 0);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < volume.size(); ++i) wrong += read.value(i) != volume.value(i) ? 1u : 0u;
        CHECK(wrong == 0);
        CHECK(glm::length(read.geometry().spacing - kSpacing) < 1e-6);
        // Where each voxel lies to the first one. Inviwo's box begins at its corner, not at a centre.
        const Vec3 far = read.geometry().worldFromVoxel(Vec3(kDims - 1)) - read.geometry().worldFromVoxel(Vec3(0));
        CHECK(glm::length(far - Vec3(kDims - 1) * kSpacing) < 1e-5);
    }
}

TEST_CASE("axes that run backwards are kept by every format that has directions", "[same]") {
    const TempFolder folder;
    for (int flips = 0; flips < 8; ++flips)
        for (const char* suffix : {".nrrd", ".mha", ".mhd", ".nii", ".nii.gz", ".vti"}) {
            CAPTURE(flips, suffix);
            Geometry g;
            g.dims = kDims;
            g.spacing = kSpacing;
            g.origin = {-3, 4, 5};
            g.worldAxes = std::string(suffix) == ".vti" ? WorldAxes::File : WorldAxes::Patient;
            for (int a = 0; a < 3; ++a) g.directions[a][a] = (flips >> a & 1) != 0 ? -1 : 1;
            const std::string path = folder.path("a" + std::to_string(flips) + suffix);
            writeVolume(Volume(g, SampleArray<std::uint16_t>(values())), path);
            VolumeSource source;
            source.path = path;
            const Volume read = loadVolume(source);
            CHECK(read.geometry().worldAxes == g.worldAxes);
            for (const Vec3& voxel : {Vec3(0), Vec3(6, 0, 0), Vec3(0, 5, 0), Vec3(0, 0, 4)})
                CHECK(glm::length(read.geometry().worldFromVoxel(voxel) - g.worldFromVoxel(voxel)) < 1e-5);
            CHECK(read.value(voxelIndex(kDims, 6, 0, 0)) == 78);
        }
}
