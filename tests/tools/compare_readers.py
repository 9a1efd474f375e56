#!/usr/bin/env python3
"""Compares what pellucid-cli reads of volume files with what other readers find in them: sizes, type, spacing,
directions and origin, range, number of invalid voxels, and each voxel.

    compare_readers.py PELLUCID_CLI [FOLDER…]

Files of each format are written by the libraries of the other readers; with FOLDER, all volumes below it follow. The
other readers are nibabel, pydicom, tifffile, PIL, VTK, h5py, netCDF4 and zarr, and a few lines here for what none of
them reads. Prints one line for each file. Exit status: 0 all the same, 1 something differs, 2 wrong usage. What a
missing module would read is left out, and said.
"""
import argparse
import bz2
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile
import warnings
import xml.etree.ElementTree

try:
    import numpy as np
except ImportError:
    print("SKIPPED: numpy is missing (Debian: python3-numpy)")
    sys.exit(0)

TYPES = {"u1": "u8", "i1": "i8", "u2": "u16", "i2": "i16", "u4": "u32", "i4": "i32", "f4": "f32", "f8": "f64"}
IDENTITY = np.eye(3)


class Volume:
    """What a reader found: frames of the shape (nz, ny, nx), NaN where there is no value; the rows of `directions` are
    where i, j and k point, in LPS where `is_patient`. `dtype`: that of the file; True: of the frames; False: not
    known, since values are scaled."""

    def __init__(self, frames, spacing=(1, 1, 1), origin=(0, 0, 0), directions=IDENTITY, is_patient=False, dtype=True):
        self.frames = [np.asarray(frame) for frame in frames]
        self.spacing, self.origin, self.directions, self.is_patient = spacing, origin, directions, is_patient
        self.type = dtype and TYPES[(self.frames[0].dtype if dtype is True else dtype).str[1:]]


def of_matrix(frames, steps, origin, **more):
    """The columns of `steps` are the steps along i, j, k."""
    spacing = np.linalg.norm(steps, axis=0)
    return Volume(frames, spacing, origin, (steps / spacing).T, **more)


# The other readers.

def read_nifti(path):
    import nibabel
    image = nibabel.load(path)
    values = np.asanyarray(image.dataobj).T
    affine = np.diag([-1, -1, 1, 1]) @ image.affine  # RAS
    scaled = getattr(image.dataobj, "slope", 1) != 1 or getattr(image.dataobj, "inter", 0) != 0
    return of_matrix(values if values.ndim == 4 else [values], affine[:3, :3], affine[:3, 3], is_patient=True,
                     dtype=not scaled)


def read_nrrd(path):
    """No library of Debian's reads NRRD for Python. Of three axes, and one data file."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\n\n") if b"\n\n" in data else len(data)
    lines = data[:end].decode("latin-1").split("\n")[1:]
    fields = dict(re.split(":=? *", line, maxsplit=1) for line in lines if line and not line.startswith("#"))
    name = fields.get("data file", fields.get("datafile"))
    data = open(os.path.join(os.path.dirname(path), name), "rb").read() if name else data[end + 2:]
    kind = {"uchar": "u1", "uint8": "u1", "unsigned char": "u1", "short": "i2", "int16": "i2",
            "float": "f4"}[fields["type"]]
    if fields["encoding"] in ("text", "txt", "ascii"):
        values = np.array(data.split(), kind)
    else:
        unpack = {"raw": bytes, "gzip": gzip.decompress, "bzip2": bz2.decompress}[fields["encoding"]]
        order = ">" if fields.get("endian") == "big" else "<"
        values = np.frombuffer(unpack(data), order + kind).astype(kind)
    values = values.reshape([int(word) for word in fields["sizes"].split()][::-1])
    if "space directions" not in fields:
        return Volume([values], np.array(fields.get("spacings", "1 1 1").split(), float))
    vectors = [np.array(text.split(","), float) for text in re.findall(r"\(([^)]*)\)", fields["space directions"])]
    origin = np.array(fields.get("space origin", "(0,0,0)").strip("() ").split(","), float)
    return of_matrix([values], np.array(vectors).T, origin,
                     is_patient=fields.get("space") in ("left-posterior-superior", "LPS"))


def read_meta_image(path):
    import vtk
    image = vtk_output(vtk.vtkMetaImageReader(), path)
    with open(path, "rb") as file:
        lines = file.read(4096).decode("latin-1").split("\n")
    fields = dict(line.split(" = ", 1) for line in lines if " = " in line)  # VTK takes no directions from them
    matrix = np.array(fields.get("TransformMatrix", "1 0 0 0 1 0 0 0 1").split(), float).reshape(3, 3)
    origin = np.array(fields.get("Offset", fields.get("Position", "0 0 0")).split(), float)
    return Volume([vtk_values(image)], image.GetSpacing(), origin, matrix,
                  is_patient=re.match("[RLAPSI]{3}", fields.get("AnatomicalOrientation", "")) is not None)


def vtk_output(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def vtk_values(image):
    from vtk.util import numpy_support
    data = image.GetPointData() if image.GetPointData().GetNumberOfArrays() > 0 else image.GetCellData()
    dims = np.array(image.GetDimensions()) - (0 if data is image.GetPointData() else 1)
    return numpy_support.vtk_to_numpy(data.GetScalars() or data.GetArray(0)).reshape(dims[::-1])


def read_vtk(path):
    import vtk
    reader = {".vti": vtk.vtkXMLImageDataReader, ".pvti": vtk.vtkXMLPImageDataReader,
              ".vtk": vtk.vtkStructuredPointsReader}[os.path.splitext(path)[1]]()
    image = vtk_output(reader, path)
    matrix = image.GetDirectionMatrix()
    directions = np.array([[matrix.GetElement(row, a) for row in range(3)] for a in range(3)])
    lowest = np.array(image.GetExtent()[::2]) + (0 if image.GetPointData().GetNumberOfArrays() > 0 else 0.5)
    origin = np.array(image.GetOrigin()) + (lowest * image.GetSpacing()) @ directions
    return Volume([vtk_values(image)], image.GetSpacing(), origin, directions)


def read_dicom(folder):
    import pydicom
    slices = [pydicom.dcmread(os.path.join(folder, name)) for name in sorted(os.listdir(folder))]
    rows, columns = np.array(slices[0].ImageOrientationPatient, float).reshape(2, 3)
    place = {id(s): np.array(s.ImagePositionPatient, float) for s in slices}
    normal = np.cross(rows, columns)
    slices.sort(key=lambda s: place[id(s)] @ normal)
    scaled = any("RescaleSlope" in s for s in slices)
    values = [s.pixel_array * float(s.get("RescaleSlope", 1)) + float(s.get("RescaleIntercept", 0)) if scaled
              else s.pixel_array for s in slices]
    first, last = place[id(slices[0])], place[id(slices[-1])]
    between, across = np.array(slices[0].PixelSpacing, float)
    steps = np.stack([rows * across, columns * between, (last - first) / (len(slices) - 1)], axis=1)
    return of_matrix([np.stack(values)], steps, first, is_patient=True, dtype=not scaled)


def read_tiff(path):
    import tifffile
    with tifffile.TiffFile(path) as file:
        values, spacing = file.asarray(), [1, 1, 1]
        if file.imagej_metadata:
            tags = file.pages[0].tags
            for a, name in enumerate(("XResolution", "YResolution")):
                if name in tags and "unit" in file.imagej_metadata:
                    spacing[a] = tags[name].value[1] / tags[name].value[0]
            spacing[2] = abs(file.imagej_metadata.get("spacing", 1))
        if file.ome_metadata:
            sizes = dict(re.findall("PhysicalSize([XYZ])=\"([^\"]*)\"", file.ome_metadata))
            spacing = [float(sizes[axis]) for axis in "XYZ"]
    return Volume([values.astype(values.dtype.newbyteorder("="))], spacing)


def read_pictures(folder):
    from PIL import Image
    names = sorted(os.listdir(folder), key=lambda name: int(re.search("[0-9]+", name).group()))
    values = np.stack([np.array(Image.open(os.path.join(folder, name))) for name in names])
    return Volume([values.astype("u2") if values.dtype == "i4" else values])  # how PIL opens 16 bits


def read_netcdf(path):
    import netCDF4
    with netCDF4.Dataset(path) as file:
        variable = max(file.variables.values(), key=lambda v: v.size)
        values = variable[...]
        if np.ma.is_masked(values):
            values = np.ma.filled(values.astype("f8"), np.nan)
        steps, origin = np.eye(3), np.zeros(3)
        for a, name in enumerate(reversed(variable.dimensions)):
            places = np.asarray(file.variables[name][:])
            steps[a, a], origin[a] = places[1] - places[0], places[0]
        dtype = False if "scale_factor" in variable.ncattrs() else variable.dtype
    return of_matrix([np.asarray(values)], steps, origin, dtype=dtype)


def read_hdf5(path):
    import h5py
    with h5py.File(path) as file:
        found = []
        file.visititems(lambda _, thing: found.append(thing) if isinstance(thing, h5py.Dataset) else None)
        data = max(found, key=lambda thing: thing.size)
        spacing = data.attrs.get("element_size_um", (1, 1, 1))[::-1]
        return Volume([data[...].astype(data.dtype.newbyteorder("="))], spacing)


def read_zarr(path):
    import zarr
    group = zarr.open_group(path, "r")
    level = group.attrs["multiscales"][0]["datasets"][0]
    placed = {one["type"]: np.array(one[one["type"]])[::-1] for one in level["coordinateTransformations"]}
    values = group[level["path"]][...]
    return of_matrix([values.astype(values.dtype.newbyteorder("="))], np.diag(placed["scale"]),
                     placed.get("translation", np.zeros(3)))


def read_dat(path):
    """A header of Voreen."""
    with open(path) as file:
        fields = dict(re.split(r":\s*", line.strip(), maxsplit=1) for line in file if re.match(r"\w+:", line))
    dims = [int(word) for word in fields["Resolution"].split()]
    dtype = {"UCHAR": "u1", "USHORT": "<u2", "SHORT": "<i2", "FLOAT": "<f4"}[fields["Format"].strip()]
    values = np.fromfile(os.path.join(os.path.dirname(path), fields["ObjectFileName"]), dtype).reshape(dims[::-1])
    return Volume([values], np.array(fields.get("SliceThickness", "1 1 1").split(), float))


def read_vvd(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    raw = root.find(".//RawData").attrib
    dtype = {"uint8": "u1", "uint16": "<u2", "int16": "<i2", "float": "<f4"}[raw["format"]]
    data = np.fromfile(os.path.join(os.path.dirname(path), raw["filename"]), dtype)
    vectors = {item.get("name"): np.array([float(item.find("value").get(axis)) for axis in "xyz"])
               for item in root.iter("MetaItem") if item.get("name") in ("Offset", "Spacing")}
    return Volume([data.reshape([int(raw[axis]) for axis in "zyx"])], vectors.get("Spacing", np.ones(3)),
                  vectors.get("Offset", np.zeros(3)))


def unpacked_dds(data):
    """Differences of few bits each; what they are to is the value before, and the slope one strip before."""
    position, kept, kept_bits = 8, 0, 0

    def read(count):
        nonlocal position, kept, kept_bits
        while kept_bits < count:
            kept = kept << 8 | (data[position] if position < len(data) else 0)
            position, kept_bits = position + 1, kept_bits + 8
        kept_bits -= count
        value, kept = kept >> kept_bits, kept & (1 << kept_bits) - 1
        return value

    planes, strip = read(2) + 1, read(16) + 1
    out, last = bytearray(), 0
    while count := read(7):
        width = read(3)
        width += width > 0
        for _ in range(count):
            last += read(width) - (1 << width >> 1) if width else 0
            if strip > 1 and len(out) > strip:
                last += out[-strip] - out[-strip - 1]
            last &= 255
            out.append(last)
    values = np.frombuffer(bytes(out), "u1")
    if planes == 1:
        return values.tobytes()
    result = np.empty_like(values)
    block = (1 << 24) * planes if data[6:7] == b"e" else len(values)
    for begin in range(0, len(values), block):
        part, at = values[begin:begin + block], 0
        for plane in range(planes):
            size = len(range(plane, len(part), planes))
            result[begin:begin + len(part)][plane::planes] = part[at:at + size]
            at += size
    return result.tobytes()


def read_pvm(path):
    with open(path, "rb") as file:
        data = file.read()
    if data.startswith(b"DDS v3"):
        data = unpacked_dds(data)
    mark, rest = data.split(b"\n", 1)
    has_spacing = mark != b"PVM"
    words = re.match(rb"(\S+)\s+" * (6 if has_spacing else 3) + rb"(\d+)\n", rest)
    numbers = [float(word) for word in words.groups()]
    dims, each = [int(n) for n in numbers[2::-1]], int(numbers[-1])
    values = np.frombuffer(rest, "u1" if each == 1 else ">u2", int(np.prod(dims)), words.end()).reshape(dims)
    return Volume([values.astype(values.dtype.newbyteorder("="))], numbers[3:6] if has_spacing else (1, 1, 1))


READERS = {".nii": read_nifti, ".nii.gz": read_nifti, ".hdr": read_nifti, ".nrrd": read_nrrd, ".nhdr": read_nrrd,
           ".mhd": read_meta_image, ".mha": read_meta_image, ".vti": read_vtk, ".pvti": read_vtk, ".vtk": read_vtk,
           ".tif": read_tiff, ".tiff": read_tiff, ".nc": read_netcdf, ".h5": read_hdf5, ".hdf5": read_hdf5,
           ".dat": read_dat, ".vvd": read_vvd, ".pvm": read_pvm}
PICTURES = (".png", ".jpg", ".bmp")


def reader_of(path):
    """Of a file by its suffix, of a folder by what is in it; None: it is no volume, or what another one names."""
    if not os.path.isdir(path):
        suffixes = [suffix for suffix in READERS if path.endswith(suffix)]
        return READERS[max(suffixes, key=len)] if suffixes else None
    names = sorted(name for name in os.listdir(path))
    if ".zgroup" in names:
        return read_zarr
    if names and all(name.endswith(".dcm") for name in names):
        return read_dicom
    return read_pictures if names and all(name.endswith(PICTURES) for name in names) else None


# Files of each format, of the same voxels, by the libraries of the formats.

SHAPE = (6, 5, 4)
VALUES = (np.arange(120).reshape(SHAPE) * 37 % 1009 - 300).astype("i2")
POSITIVE = (VALUES + 300).astype("u2")
TURN = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, -1]])  # columns; 3 : 4 : 5
SPACING = np.array([1.0, 2.0, 3.0])
ORIGIN = np.array([10.0, 20.0, -30.0])


def make_nifti(at):
    import nibabel
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = TURN * SPACING, ORIGIN
    nibabel.Nifti1Image(VALUES.T, affine).to_filename(at("one.nii.gz"))
    nibabel.Nifti1Image(VALUES.T.astype(">i2"), affine, nibabel.Nifti1Header(endianness=">")).to_filename(at("big.nii"))
    nibabel.Nifti2Image(VALUES.T.astype("f4"), affine).to_filename(at("two.nii"))
    nibabel.Nifti1Pair(VALUES.T, affine).to_filename(at("pair.hdr"))
    scaled = nibabel.Nifti1Image(VALUES.T, affine)
    scaled.header.set_slope_inter(0.5, -7)
    scaled.to_filename(at("scaled.nii"))
    nibabel.Nifti1Image(np.stack([VALUES.T, VALUES.T + 5], -1), affine).to_filename(at("steps.nii.gz"))


def make_nrrd(at):
    vectors = " ".join("(%r,%r,%r)" % tuple(column.tolist()) for column in (TURN * SPACING).T)
    head = "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 5 6\nspace: left-posterior-superior\nspace directions: " + \
        vectors + "\nspace origin: (10,20,-30)\nendian: big\nencoding: %s\n"
    data = VALUES.astype(">i2").tobytes()
    packed = {"raw": data, "gzip": gzip.compress(data), "bzip2": bz2.compress(data),
              "ascii": " ".join(str(value) for value in VALUES.ravel()).encode()}
    for encoding, stored in packed.items():
        with open(at(encoding + ".nrrd"), "wb") as file:
            file.write((head % encoding + "\n").encode() + stored)
    with open(at("detached.nhdr"), "w") as file:
        file.write(head % "gzip" + "data file: data.raw.gz\n")
    with open(at("data.raw.gz"), "wb") as file:
        file.write(packed["gzip"])


def vtk_image(values, in_cells=False):
    import vtk
    from vtk.util import numpy_support
    image = vtk.vtkImageData()
    upper = np.array(SHAPE[::-1]) + (2, 3, 4) - (0 if in_cells else 1)
    image.SetExtent(2, upper[0], 3, upper[1], 4, upper[2])
    image.SetSpacing(*SPACING)
    image.SetOrigin(*ORIGIN)
    array = numpy_support.numpy_to_vtk(values.ravel(), deep=1)
    array.SetName("v")
    (image.GetCellData() if in_cells else image.GetPointData()).SetScalars(array)
    return image


def vtk_write(writer, image, path):
    writer.SetInputData(image)
    writer.SetFileName(path)
    if writer.Write() == 0:
        raise RuntimeError("VTK cannot write " + path)


def make_vtk(at):
    import vtk
    for packer in ("None", "ZLib", "LZ4", "LZMA"):
        writer = vtk.vtkXMLImageDataWriter()
        getattr(writer, "SetCompressorTypeTo" + packer)()
        vtk_write(writer, vtk_image(VALUES), at(packer.lower() + ".vti"))
    vtk_write(vtk.vtkXMLImageDataWriter(), vtk_image(VALUES.astype("f8"), in_cells=True), at("cells.vti"))
    turned = vtk_image(POSITIVE)
    turned.SetDirectionMatrix(*TURN.ravel())
    vtk_write(vtk.vtkXMLImageDataWriter(), turned, at("turned.vti"))
    pieces = vtk.vtkXMLPImageDataWriter()
    pieces.SetNumberOfPieces(4)
    pieces.SetEndPiece(3)
    vtk_write(pieces, vtk_image(VALUES), at("pieces.pvti"))
    for kind in ("ASCII", "Binary"):
        legacy = vtk.vtkStructuredPointsWriter()
        getattr(legacy, "SetFileTypeTo" + kind)()
        points = vtk.vtkStructuredPoints()
        points.ShallowCopy(vtk_image(VALUES.astype("f4")))
        vtk_write(legacy, points, at(kind.lower() + ".vtk"))
    for name, packed in (("plain.mhd", False), ("packed.mha", True)):
        meta = vtk.vtkMetaImageWriter()
        meta.SetCompression(packed)
        image = vtk_image(VALUES)
        image.SetExtent(0, SHAPE[2] - 1, 0, SHAPE[1] - 1, 0, SHAPE[0] - 1)
        vtk_write(meta, image, at(name))


def make_dicom(at):
    import pydicom
    from pydicom.dataset import FileDataset, FileMetaDataset
    kinds = {"implicit": pydicom.uid.ImplicitVRLittleEndian, "explicit": pydicom.uid.ExplicitVRLittleEndian,
             "big": pydicom.uid.ExplicitVRBigEndian, "deflated": pydicom.uid.DeflatedExplicitVRLittleEndian,
             "rle": pydicom.uid.RLELossless, "scaled": pydicom.uid.ExplicitVRLittleEndian}
    for kind, syntax in kinds.items():
        os.mkdir(at(kind))
        for k, values in enumerate(VALUES):
            meta = FileMetaDataset()
            meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
            meta.MediaStorageSOPInstanceUID = "1.2.3.%d" % (k + 1)
            meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian if kind == "rle" else syntax
            one = FileDataset(None, {}, file_meta=meta, preamble=bytes(128))
            one.SOPClassUID, one.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
            one.Modality, one.StudyInstanceUID, one.SeriesInstanceUID = "CT", "1.2", "1.2.3"
            one.InstanceNumber = len(VALUES) - k  # not the order of their places
            one.ImagePositionPatient = [float(x) for x in ORIGIN + np.cross(TURN[:, 0], TURN[:, 1]) * 3 * k]
            one.ImageOrientationPatient = [*TURN[:, 0], *TURN[:, 1]]
            one.PixelSpacing = [2, 1]
            one.Rows, one.Columns = values.shape
            one.SamplesPerPixel, one.PhotometricInterpretation, one.PixelRepresentation = 1, "MONOCHROME2", 1
            one.BitsAllocated = one.BitsStored = 16
            one.HighBit = 15
            if kind == "scaled":
                one.RescaleSlope, one.RescaleIntercept = 0.5 + k, -k
            one.is_little_endian, one.is_implicit_VR = kind != "big", kind == "implicit"
            one.PixelData = values.astype(">i2" if kind == "big" else "<i2").tobytes()
            one["PixelData"].VR = "OW"
            if kind == "rle":
                one.compress(pydicom.uid.RLELossless)
            one.save_as(os.path.join(at(kind), "%d.dcm" % k), write_like_original=False)


def make_tiff(at):
    import tifffile
    gray = {"photometric": "minisblack"}
    tifffile.imwrite(at("plain.tif"), VALUES, **gray)
    tifffile.imwrite(at("big-endian.tif"), VALUES.astype("f4"), byteorder=">", **gray)
    tifffile.imwrite(at("deflate.tif"), VALUES, compression="zlib", predictor=True, **gray)
    tifffile.imwrite(at("bigtiff.tif"), np.tile(VALUES, (1, 8, 8)), bigtiff=True, tile=(16, 16), **gray)
    tifffile.imwrite(at("imagej.tif"), POSITIVE, imagej=True, resolution=(4, 2),
                     metadata={"spacing": 3.0, "unit": "um", "axes": "ZYX"})
    tifffile.imwrite(at("ome.ome.tif"), POSITIVE, metadata={
        "axes": "ZYX", "PhysicalSizeX": 0.25, "PhysicalSizeY": 0.5, "PhysicalSizeZ": 2.0}, **gray)


def make_pictures(at):
    from PIL import Image
    for suffix, values in (("png", POSITIVE), ("bmp", (POSITIVE % 256).astype("u1"))):
        os.mkdir(at(suffix))
        for k, picture in enumerate(values):
            Image.fromarray(picture).save(os.path.join(at(suffix), "s%d.%s" % (k + 7, suffix)))  # 7 … 12


def make_netcdf(at):
    import netCDF4
    for name, form in (("four.nc", "NETCDF4"), ("classic.nc", "NETCDF3_CLASSIC"), ("packed.nc", "NETCDF4")):
        with netCDF4.Dataset(at(name), "w", format=form) as file:
            axes = zip("zyx", SHAPE, (ORIGIN[2] + 3 * np.arange(6), 8 - 2 * np.arange(5), np.arange(4.0)))
            for axis, size, places in axes:
                file.createDimension(axis, size)
                file.createVariable(axis, "f8", (axis,))[:] = places
            variable = file.createVariable("v", "i2", ("z", "y", "x"), fill_value=-300)  # that of the first voxel
            if name == "packed.nc":
                variable.scale_factor, variable.add_offset = 0.5, 10.0
                variable.set_auto_maskandscale(False)
            variable[...] = VALUES


def make_hdf5(at):
    import h5py
    with h5py.File(at("a.h5"), "w") as file:
        file.create_dataset("small", data=np.zeros((2, 2, 2)))
        data = file.create_dataset("group/v", data=VALUES.astype(">i2"), chunks=(3, 2, 4), compression="gzip",
                                   shuffle=True)
        data.attrs["element_size_um"] = SPACING[::-1]


def make_zarr(at):
    import numcodecs
    import zarr
    packers = {"raw": None, "gzip": numcodecs.GZip(), "zstd": numcodecs.Zstd(), "blosc": numcodecs.Blosc(cname="zstd")}
    for name, packer in packers.items():
        group = zarr.open_group(at(name + ".zarr"), "w")
        group.create_dataset("0", data=VALUES.astype(">i2" if packer else "<i2"), chunks=(4, 2, 3), compressor=packer)
        group.attrs["multiscales"] = [{
            "version": "0.4", "axes": [{"name": axis, "type": "space"} for axis in "zyx"],
            "datasets": [{"path": "0", "coordinateTransformations": [
                {"type": "scale", "scale": [3, -2, 1]}, {"type": "translation", "translation": list(ORIGIN[::-1])}]}]}]


def make_others(at):
    """Formats that no library writes."""
    VALUES.tofile(at("data.raw"))
    with open(at("voreen.dat"), "w") as file:
        file.write("ObjectFileName: data.raw\nResolution: 4 5 6\nSliceThickness: 1 2 3\nFormat: SHORT\n")
    with open(at("voreen.vvd"), "w") as file:
        file.write("<VoreenData version=\"1\"><Volumes><Volume><RawData filename=\"data.raw\" format=\"int16\" x=\"4\" "
                   "y=\"5\" z=\"6\"/><MetaData><MetaItem name=\"Spacing\" type=\"Vec3MetaData\"><value x=\"1\" y=\"2\" "
                   "z=\"3\"/></MetaItem></MetaData></Volume></Volumes></VoreenData>")
    with open(at("plain.pvm"), "wb") as file:
        file.write(b"PVM2\n4 5 6\n1 2 3\n2\n" + POSITIVE.astype(">u2").tobytes())
    with gzip.open(at("packed.raw.gz"), "wb") as file:
        file.write(VALUES.tobytes())


MAKERS = (make_nifti, make_nrrd, make_vtk, make_dicom, make_tiff, make_pictures, make_netcdf, make_hdf5, make_zarr,
          make_others)


# What differs.

def differences(cli, path, expected, options):
    """In words; none: all is the same."""
    found = []

    def compare(what, ours, theirs, is_same):
        if not is_same:
            found.append("%s %s, not %s" % (what, ours, theirs))

    def run(*words):
        done = subprocess.run([cli, *words], capture_output=True, encoding="utf-8")
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        return done.stdout

    count = len(expected.frames)
    for number in sorted({0, count - 1}):
        frame = ["--frame", str(number)] if count > 1 else []
        info = json.loads(run("info", path, "--json", *options, *frame))
        values = expected.frames[number]
        with tempfile.TemporaryDirectory() as folder:
            run("convert", path, "--out", os.path.join(folder, "a.mhd"), *options, *frame)
            ours = np.fromfile(os.path.join(folder, "a.raw"), {v: k for k, v in TYPES.items()}[info["type"]])
        compare("sizes", info["dims"], list(values.shape[::-1]), info["dims"] == list(values.shape[::-1]))
        if found:
            return found
        if expected.type:
            compare("type", info["type"], expected.type, info["type"] == expected.type)
        for what, theirs in (("spacing", expected.spacing), ("origin", expected.origin),
                             ("directions", expected.directions)):
            theirs = np.asarray(theirs, float)
            compare(what, info[what], theirs.tolist(), np.allclose(info[what], theirs, rtol=1e-5, atol=1e-4))
        compare("axes of", info["frame"], ["file", "patient"][expected.is_patient],
                (info["frame"] == "patient") == expected.is_patient)
        ours, theirs = ours.astype("f8"), values.astype("f8").ravel()
        has_value = np.isfinite(theirs)
        span = [theirs[has_value].min(), theirs[has_value].max()]
        compare("range", info["data_range"], span, np.allclose(info["data_range"], span, rtol=1e-6))
        compare("invalid voxels", info["invalid"], int((~has_value).sum()), info["invalid"] == (~has_value).sum())
        # What is scaled we keep in single precision. Voxels without a value keep the one that stands for none.
        is_same = ours == theirs if expected.type else np.isclose(ours, theirs, rtol=1e-6)
        wrong = int((~is_same & has_value).sum())
        compare("voxels", "%d of %d other values" % (wrong, ours.size), "the same", wrong == 0)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cli")
    parser.add_argument("folders", nargs="*")
    options = parser.parse_args()
    if not os.access(options.cli, os.X_OK) or not all(os.path.isdir(folder) for folder in options.folders):
        parser.error("there is no such program or folder")
    warnings.simplefilter("ignore")
    left_out, differ, compared = [], 0, 0

    def compare_all(top):
        nonlocal differ, compared
        for folder, folders, names in os.walk(top):
            folders.sort()
            volumes = [folder] if folder != top and reader_of(folder) else \
                [path for path in (os.path.join(folder, name) for name in sorted(names)) if reader_of(path)]
            if volumes == [folder]:
                folders.clear()
            elif any(path.endswith(".pvti") for path in volumes):
                volumes = [path for path in volumes if not re.search(r"_\d+\.vti$", path)]  # its pieces
            if "packed.raw.gz" in names:
                volumes.append(os.path.join(folder, "packed.raw.gz"))
            for path in volumes:
                name, words = os.path.relpath(path, top), []
                try:
                    if path.endswith("packed.raw.gz"):
                        expected, words = Volume([VALUES]), ["--raw", "4,5,6,i16"]
                    else:
                        expected = reader_of(path)(path)
                    found = differences(options.cli, path, expected, words)
                except ImportError as error:
                    left_out.append("%s (%s)" % (name, error))
                    continue
                except RuntimeError as error:
                    found = [str(error)]
                compared += 1
                differ += bool(found)
                sizes = " x ".join(str(n) for n in expected.frames[0].shape[::-1])
                print("%s %s: %s" % ("DIFFERS" if found else "same   ", name, "; ".join(found) or sizes), flush=True)

    with tempfile.TemporaryDirectory() as top:
        for make in MAKERS:
            folder = os.path.join(top, make.__name__[5:])
            os.mkdir(folder)
            try:
                make(lambda name, folder=folder: os.path.join(folder, name))
            except ImportError as error:
                left_out.append("%s (%s)" % (make.__name__[5:], error))
        compare_all(top)
    for folder in options.folders:
        compare_all(folder)
    print("%d of %d differ" % (differ, compared))
    for what in left_out:
        print(("left out: " if differ else "SKIPPED: ") + what)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
