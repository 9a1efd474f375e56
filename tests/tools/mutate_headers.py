#!/usr/bin/env python3
"""Damages the headers of small volume files in many ways and looks at what `pellucid-cli info` makes of each.

Every file has to be read, or be refused with status 1 and exactly one line on stderr: no signal, no hang, no values
without sense. The same --seed makes the same files. Exit status: 0 all well, 1 something was found, 2 wrong usage.

    mutate_headers.py build/headless/bin/pellucid-cli --count 2000 --jobs 4 --keep found

Instead of pellucid-cli, which is started for each file, it takes open_files, which opens them all in one process, for
builds with sanitizers: it then also has to keep to --cpu seconds and --memory MiB of the heap.

Needs Python 3.8 and nothing beside it.
"""

import argparse
import base64
import bz2
import gzip
import json
import math
import multiprocessing
import os
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

from opener import Opener, is_opener, line_fault

VALUES = bytes(range(24))  # 2 x 3 x 4 voxels of one byte

NUMBERS = [b"0", b"-0", b"-1", b"1", b"2", b"7", b"1e30", b"-1e30", b"1e308", b"1e-308", b"1e400", b"nan", b"-nan",
           b"inf", b"-inf", b"NaN", b"0x10", b"1.5", b"255", b"256", b"32767", b"32768", b"65536", b"2147483647",
           b"2147483648", b"-2147483648", b"4294967295", b"4294967296", b"9223372036854775807", b"-9223372036854775808",
           b"9223372036854775808", b"18446744073709551615", b"18446744073709551616", b"9" * 50, b"9" * 5000,
           b"0." + b"0" * 3000 + b"1", b"1,5", b"1;", b"+1", b"--1", b""]
WORDS = [b"LOCAL", b"LIST", b"LIST 2", b"SKIPLIST", b"slice%03d.raw 1 4 1", b"%s%s%s%n", b"/dev/zero", b"/dev/null",
         b"/dev/stdin", b"/", b".", b"..", b"pipe", b"folder", b"none", b"none.raw", b"data.raw", b"data.txt",
         b"data.gz", b"data.z", b"True", b"False", b"raw", b"gzip", b"bzip2", b"zrl", b"text", b"ascii", b"hex",
         b"little", b"big", b"uint8", b"short", b"int64", b"float", b"double", b"block", b"MET_SHORT", b"MET_FLOAT",
         b"MET_DOUBLE",
         b"MET_ULONG_LONG", b"MET_STRING", b"MET_OTHER", b"domain", b"vector", b"RGB-color",
         b"3D-masked-symmetric-matrix",
         b"(1,0,0)", b"(0,0,0)", b"(nan,0,0)", b"(1,0", b"(1)", b"(" * 300, b"\xff\xfe", b"\0", b"x" * 300,
         b"x" * 70000]
NRRD_LINES = [b"line skip: 1", b"byte skip: -1", b"byte skip: 3", b"line skip: 9223372036854775807", b"data file: LIST",
              b"data file: data.raw", b"data file: LIST 2", b"data file: slab%d.raw 0 1 1", b"data file: slab%d.raw 0 9223372036854775807 1 3",
              b"endian: big", b"encoding: text", b"encoding: bzip2", b"space: RAS", b"space dimension: 0",
              b"space dimension: 9", b"space origin: (nan,0,0)", b"kinds: vector domain domain", b"axis mins: 0 nan 1",
              b"axis maxs: 1 1 1", b"centers: node cell ???", b"old min: nan", b"block size: 7", b"# \xff",
              b"measurement frame: (1,0,0) (0,1,0) (0,0,1)", b"labels: \"a\" \"b", b"units: \"",
              b"sample units: " + b"m" * 999,
              b"key:=value", b"thicknesses: nan nan nan", b"", b"\0"]
META_LINES = [b"HeaderSize = -1", b"HeaderSize = 99999999999", b"HeaderSize = 3", b"CompressedData = True",
              b"CompressedDataSize = 7", b"CompressedDataSize = -7", b"BinaryData = False",
              b"ElementNumberOfChannels = 3",
              b"ElementNumberOfChannels = 0", b"ElementByteOrderMSB = True", b"BinaryDataByteOrderMSB = True",
              b"ObjectType = Tube", b"TransformMatrix = 1 0 0 0 1 0 0 0 nan", b"TransformMatrix = 1",
              b"Offset = 1 1 inf",
              b"Origin = 1", b"ElementSize = -1 1 1", b"ElementToIntensityFunctionSlope = nan", b"NDims = 11",
              b"ElementDataFile = LIST", b"Comment = " + b"c" * 9000, b"N" * 9000 + b" = 1", b"Modality = MET_MOD_CT",
              b"SequenceID = 1", b"CenterOfRotation = 0 0 0", b"HeaderSizePerSlice = 8", b"", b"\0"]

XML_LINES = [b"<!-- ", b"-->", b"<![CDATA[", b"]]>", b"<?x", b"<a>", b"</a>", b"<a/>", b"<", b">", b"<a b=\"", b"<a b='\"'/>",
             b"<Piece>", b"</Piece>", b"<PointData>", b"</PointData>", b"<AppendedData encoding=\"raw\">_",
             b"<AppendedData encoding=\"base64\">_AAAA", b"</VTKFile>", b"<DataArray type=\"UInt8\" format=\"ascii\">1 2",
             b"<DataArray type=\"Float32\" Name=\"TimeValue\" format=\"appended\" offset=\"9223372036854775807\"/>",
             b"<DataSet timestep=\"nan\" file=\"step.vti\"/>", b"<DataSet timestep=\"7\" file=\"../none.vti\"/>",
             b"<Piece Extent=\"0 1 0 2 0 1\" Source=\"step.vti\"/>", b"<Piece Extent=\"0 1 0 2 0 3\" Source=\"../none.vti\"/>",
             b"<Piece Source=\"pipe\"/>", b"<Piece Extent=\"0 1 0 2 3 4\">", b"<Piece Extent=\"5 -5 0 2 0 3\">",
             b"<DataSet file=\"pipe\"/>", b"<DataSet timestep=\"8\" file=\"data.raw\"/>", b"&amp;&#0;&#99999;&x", b"\0"]


class Seed:
    """A valid file; its first `header` bytes say how the rest is to be read."""

    def __init__(self, header, data=b"", pack=False):
        self.header, self.data, self.pack = header, data, pack


def short_data(order):
    return struct.pack(order + "24h", *range(-7, 17))


def float_data(order):
    return struct.pack(order + "24f", *[float("nan")] + [0.5 * i for i in range(23)])


def text_data(count):
    return b"".join(b"%d%s" % (i, b"\n" if i % 5 == 4 else b" ") for i in range(count))


def nrrd(fields, data=b"", last=b"\n"):
    text = b"NRRD0005\n# made by a test\ntype: %s\ndimension: %s\nsizes: %s\n%sencoding: %s\n" % fields
    return Seed(text + last, data)


def nrrd_seeds():
    place = b"space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (5,6,7)\n"
    vector = b"kinds: vector domain domain domain\nspacings: nan 1 2 3\n"
    return [
        nrrd((b"uint8", b"3", b"2 3 4", place + b"kinds: domain domain domain\n", b"raw"), VALUES),
        nrrd((b"short", b"3", b"2 3 4", b"endian: big\nspacings: 1 2 3\naxis mins: 0 0 0\n", b"gzip"),
             gzip.compress(short_data(">"), mtime=0)),
        nrrd((b"float", b"3", b"2 3 4", b"endian: little\n" + place, b"raw"), float_data("<")),
        nrrd((b"int", b"4", b"2 2 3 2", vector, b"ascii"), text_data(24)),
        nrrd((b"ushort", b"4", b"2 3 2 2", b"endian: little\nkinds: domain domain domain list\n", b"hex"),
             short_data("<").hex().encode()),
    ]


def nhdr_seeds():
    return [
        nrrd((b"uint8", b"3", b"2 3 4", b"byte skip: 4\nspacings: 1 2 3\n", b"raw"), last=b"data file: data.raw\n"),
        nrrd((b"uint8", b"3", b"2 3 4", b"byte skip: 4\n", b"gzip"), last=b"data file: data.gz\n"),
        nrrd((b"uint8", b"3", b"2 3 4", b"line skip: 1\n", b"text"), last=b"data file: data.txt\n"),
        nrrd((b"uint8", b"3", b"2 3 4", b"byte skip: -1\n", b"raw"), last=b"data file: ./data.raw\n"),
        nrrd((b"uint8", b"3", b"2 3 4", b"byte skip: 1\n", b"raw"), last=b"data file: slab%d.raw 0 1 1 3\n"),
        nrrd((b"uint8", b"4", b"2 3 2 2", b"byte skip: 1\n", b"raw"),
             last=b"data file: LIST\nslab0.raw\nslab1.raw\n"),
        nrrd((b"uint8", b"3", b"2 3 4", b"", b"bzip2"), last=b"data file: data.bz2\n"),
    ]


def meta(kind, fields, file, data=b""):
    return Seed(b"ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 2 3 4\nElementSpacing = 1 2 3\n"
                b"Offset = 5 6 7\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n%sElementType = %s\nElementDataFile = %s\n"
                % (fields, kind, file), data)


def mha_seeds():
    packed = zlib.compress(VALUES)
    text = meta(b"MET_INT", b"ElementNumberOfChannels = 2\n", b"LOCAL", text_data(48))
    text.header = text.header.replace(b"BinaryData = True", b"BinaryData = False")
    return [
        meta(b"MET_UCHAR", b"", b"LOCAL", VALUES),
        meta(b"MET_SHORT", b"BinaryDataByteOrderMSB = True\n", b"LOCAL", short_data(">")),
        meta(b"MET_FLOAT", b"ElementByteOrderMSB = False\nHeaderSize = -1\n", b"LOCAL", float_data("<")),
        meta(b"MET_UCHAR", b"CompressedData = True\nCompressedDataSize = %d\n" % len(packed), b"LOCAL", packed),
        text,
    ]


def mhd_seeds():
    return [
        meta(b"MET_UCHAR", b"HeaderSize = 4\n", b"data.raw"),
        meta(b"MET_UCHAR", b"HeaderSize = -1\n", b"data.raw"),
        meta(b"MET_UCHAR", b"CompressedData = True\n", b"data.z"),
        meta(b"MET_CHAR_ARRAY", b"ElementNumberOfChannels = 1\n", b"data.raw"),
    ]


def nifti(order="<", dim=(3, 2, 3, 4, 1, 1, 1, 1), kind=2, bits=8, intent=0, slope=0.0, intercept=0.0, codes=(1, 1),
          data=VALUES):
    header = bytearray(352)

    def put(offset, layout, *values):
        struct.pack_into(order + layout, header, offset, *values)

    put(0, "i", 348)
    put(40, "8h", *dim)
    put(68, "hhh", intent, kind, bits)
    put(76, "8f", -1, 1, 2, 3, 1, 1, 1, 1)
    put(108, "fff", 352, slope, intercept)
    header[123] = 10
    put(252, "hh", *codes)
    put(256, "6f", 0, 0, 1, 5, 6, 7)
    put(280, "12f", -1, 0, 0, 5, 0, -2, 0, 6, 0, 0, 3, 7)
    header[344:348] = b"n+1\0"
    return Seed(bytes(header), data)


def nifti_seeds():
    return [
        nifti(),
        nifti(">", kind=4, bits=16, slope=0.5, intercept=-1.0, codes=(1, 0), data=short_data(">")),
        nifti(kind=16, bits=32, slope=1.0, codes=(0, 2), data=float_data("<")),
        nifti(dim=(3, 2, 2, 2, 1, 1, 1, 1), kind=128, bits=24, slope=2.0),
        nifti(dim=(3, 2, 2, 2, 1, 1, 1, 1), kind=32, bits=64, slope=2.0, data=bytes(64)),
        nifti(dim=(5, 2, 2, 2, 1, 3, 1, 1), intent=1007, slope=3.0),
        nifti(dim=(4, 2, 2, 2, 3, 1, 1, 1), codes=(0, 0)),
    ]


def packed_nifti_seeds():
    seeds = nifti_seeds()
    for seed in seeds:
        seed.pack = True
    return seeds


def vti(attributes, array, data=b"", tail=b"</DataArray>", appended=b"", binary=b""):
    text = (b"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" %s>\n"
            b"<ImageData WholeExtent=\"0 1 0 2 0 3\" Origin=\"5 6 7\" Spacing=\"1 2 3\" Direction=\"1 0 0 0 1 0 0 0 1\">\n"
            b"<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" format=\"ascii\">2.5</DataArray>\n</FieldData>\n"
            b"<Piece Extent=\"0 1 0 2 0 3\">\n<PointData Scalars=\"density\">\n<DataArray %s>%s%s\n</PointData>\n"
            b"<CellData>\n</CellData>\n</Piece>\n</ImageData>\n%s" % (attributes, array, data, tail, appended))
    return Seed(text, binary + b"\n</VTKFile>\n")


def vtk_blocks(data, layout):
    blocks = [data[i:i + 10] for i in range(0, len(data), 10)]
    packed = [zlib.compress(block) for block in blocks]
    head = [len(blocks), 10, len(data) % 10] + [len(block) for block in packed]
    return struct.pack("%s%d%s" % (layout[0], len(head), layout[1]), *head), b"".join(packed)


def vti_seeds():
    array = b"type=\"%s\" Name=\"density\" NumberOfComponents=\"1\" format=\"%s\"%s"
    zipped = b"compressor=\"vtkZLibDataCompressor\" header_type=\"UInt64\" byte_order=\"BigEndian\""
    head, packed = vtk_blocks(short_data(">"), ">Q")
    inline = base64.b64encode(struct.pack("<I", 96) + float_data("<"))
    return [
        vti(b"byte_order=\"LittleEndian\"", array % (b"Int32", b"ascii", b""), text_data(24)),
        vti(b"byte_order=\"LittleEndian\"", array % (b"Float32", b"binary", b""), inline),
        vti(zipped, array % (b"Int16", b"binary", b""), base64.b64encode(head) + base64.b64encode(packed)),
        vti(b"header_type=\"UInt32\"", array % (b"UInt8", b"appended", b" offset=\"0\""), tail=b"</DataArray>",
            appended=b"<AppendedData encoding=\"raw\">\n_", binary=struct.pack("<I", 24) + VALUES),
        vti(zipped, array % (b"Int16", b"appended", b" offset=\"0\""), appended=b"<AppendedData encoding=\"raw\">\n_",
            binary=head + packed),
    ]


def pvd_seeds():
    return [Seed(b"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n"
                 b"<DataSet timestep=\"0\" part=\"0\" file=\"step.vti\"/>\n<DataSet timestep=\"0.5\" file=\"step.vti\"/>\n"
                 b"</Collection>\n</VTKFile>\n")]


def pvti_seeds():
    return [Seed(b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                 b"<PImageData WholeExtent=\"0 1 0 2 0 3\" GhostLevel=\"0\" Origin=\"5 6 7\" Spacing=\"1 2 3\">\n"
                 b"<PPointData Scalars=\"density\">\n<PDataArray type=\"Int32\" Name=\"density\" NumberOfComponents=\"1\"/>\n"
                 b"</PPointData>\n<Piece Extent=\"0 1 0 2 0 1\" Source=\"step.vti\"/>\n"
                 b"<Piece Extent=\"0 1 0 2 1 3\" Source=\"step.vti\"/>\n</PImageData>\n</VTKFile>\n")]


def vtk(binary, body):
    grid = b"DATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 4\nSPACING 1 2 3\nORIGIN 5 6 7\n"
    return b"# vtk DataFile Version 3.0\nt\n%s\n%sPOINT_DATA 24\n%s" % (b"BINARY" if binary else b"ASCII", grid, body)


def vtk_seeds():
    scalars = b"SCALARS density %s 1\nLOOKUP_TABLE default\n"
    field = b"FIELD FieldData 2\na 1 24 int\n%s\nb 1 24 float\n%s\n" % (text_data(24), text_data(24))
    return [Seed(vtk(False, scalars % b"int"), text_data(24)), Seed(vtk(True, scalars % b"short"), short_data(">")),
            Seed(vtk(True, b"VECTORS v float\n"), float_data(">") * 3), Seed(vtk(False, field)),
            Seed(vtk(True, b"COLOR_SCALARS c 1\n"), VALUES)]


def pvm_seeds():
    return [Seed(b"PVM\n2 3 4\n1\n", VALUES), Seed(b"PVM2\n2 3 4\n1 2 3\n2\n", short_data(">")),
            Seed(b"PVM3\n2 3 4\n1 2 3\n1\n", VALUES + b"a\0b\0c\0d\0")]


def dat_seeds():
    return [Seed(b"ObjectFileName: data.raw\nTaggedFileName: ---\nResolution: 2 3 4\nSliceThickness: 1 2 3\n"
                 b"Format: UCHAR\nObjectModel: I\n"),
            Seed(b"RawFile: data.raw\nResolution: 2 3 4\nFormat: UINT8\nBasisVector1: 2 0 0\nBasisVector2: 0 3 0\n"
                 b"BasisVector3: 0 0 4\nOffset: 1 2 3\nWorldVector1: 1 0 0 0\nDataRange: 0 255\nValueRange: 0 1\n")]


def vvd_seeds():
    return [Seed(b"<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n<Volumes>\n<Volume>\n"
                 b"<RawData filename=\"data.raw\" format=\"uint8\" x=\"2\" y=\"3\" z=\"4\" />\n<MetaData>\n"
                 b"<MetaItem name=\"Spacing\" type=\"Vec3MetaData\">\n<value x=\"1\" y=\"2\" z=\"3\" />\n</MetaItem>\n"
                 b"<MetaItem name=\"RealWorldMapping\">\n<value scale=\"2\" offset=\"1\" unit=\"\" />\n</MetaItem>\n"
                 b"</MetaData>\n</Volume>\n</Volumes>\n</VoreenData>\n")]


# suffix: seeds, lines to insert (None: a binary header)
FORMATS = {
    "nrrd": (".nrrd", nrrd_seeds, NRRD_LINES),
    "nhdr": (".nhdr", nhdr_seeds, NRRD_LINES),
    "mha": (".mha", mha_seeds, META_LINES),
    "mhd": (".mhd", mhd_seeds, META_LINES),
    "nii": (".nii", nifti_seeds, None),
    "nii.gz": (".nii.gz", packed_nifti_seeds, None),
    "vti": (".vti", vti_seeds, XML_LINES),
    "pvti": (".pvti", pvti_seeds, XML_LINES),
    "pvd": (".pvd", pvd_seeds, XML_LINES),
    "vtk": (".vtk", vtk_seeds, [b"METADATA", b"LOOKUP_TABLE t 3", b"EXTENT 0 1 0 2 0 3", b"CELL_DATA 6", b"POINT_DATA 24",
                                b"FIELD f 99999999", b"SCALARS a bit", b"TENSORS t double"]),
    "pvm": (".pvm", pvm_seeds, [b"# comment", b"2 3 4", b"1", b"1e30 1 1"]),
    "dat": (".dat", dat_seeds, [b"ByteOffset: 9", b"Sequences: 2", b"ObjectModel: RGBA", b"ByteOrder: BigEndian",
                                b"RawFile: pipe", b"TransformMatrix: row0 1 2 3 4", b"Spacing: 1 1 1e-40"]),
    "vvd": (".vvd", vvd_seeds, XML_LINES),
}


def flip_bits(rng, header):
    changed = bytearray(header)
    for _ in range(rng.randint(1, 8)):
        changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def replace_bytes(rng, header):
    changed = bytearray(header)
    for _ in range(rng.randint(1, 6)):
        changed[rng.randrange(len(changed))] = rng.choice([0, 0xff, 0x7f, 0x80, 10, 32, rng.randrange(256)])
    return bytes(changed)


def truncate(rng, header):
    return header[:rng.randrange(len(header))]


def insert_junk(rng, header):
    at = rng.randrange(len(header) + 1)
    noise = bytes(rng.randrange(256) for _ in range(rng.randint(1, 40)))
    junk = rng.choice([noise, b"\n", b"\n\n", b"\0" * 8, b"\r\n", b":", b"="])
    return header[:at] + junk + header[at:]


def change_lines(rng, header):
    lines = header.split(b"\n")
    one, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(3)
    if kind == 0:
        del lines[one]
    elif kind == 1:
        lines.insert(other, lines[one])
    else:
        lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def replaced(rng, header, pattern, choices):
    places = [m.span() for m in re.finditer(pattern, header)]
    if not places:
        return header
    begin, end = rng.choice(places)
    return header[:begin] + rng.choice(choices) + header[end:]


def change_number(rng, header):
    return replaced(rng, header, rb"-?[0-9]+", NUMBERS)


def change_word(rng, header):
    return replaced(rng, header, rb"[A-Za-z_.0-9-]+", WORDS)


def lengthen(rng, header):
    lines = header.split(b"\n")
    one = rng.randrange(len(lines))
    size = rng.choice([255, 256, 300, 1023, 1024, 1025, 4096, 33000, 70000, 1100000])
    at = rng.choice([0, len(lines[one]), rng.randrange(len(lines[one]) + 1)])
    lines[one] = lines[one][:at] + rng.choice([b"x", b"1 ", b"(", b" ", b"9"]) * size + lines[one][at:]
    return b"\n".join(lines)


# Fields of NIfTI-1: offset and layout of the numbers there.
NIFTI_FIELDS = ([(0, "i"), (68, "h"), (70, "h"), (72, "h"), (108, "f"), (112, "f"), (116, "f"),
                 (252, "h"), (254, "h")] +
                [(40 + 2 * i, "h") for i in range(8)] + [(76 + 4 * i, "f") for i in range(8)] +
                [(256 + 4 * i, "f") for i in range(6)] + [(280 + 4 * i, "f") for i in range(12)])
NIFTI_NUMBERS = {
    "i": [0, 1, -1, 347, 540, 2**31 - 1, -2**31, 348 << 16],
    "h": [0, 1, -1, 2, 3, 4, 5, 7, 8, 16, 32, 64, 128, 256, 512, 768, 1005, 1007, 1024, 1280, 1536, 1792, 2304,
          32767, -32768],
    "f": [0.0, -0.0, 1.0, -1.0, 1e30, -1e30, 1e38, 1e-38, 1e-45, 352.0, 351.5, 348.0, 376.0, 1e9, 2e9, float("nan"),
          float("inf"), float("-inf")],
}


def change_field(rng, header):
    changed = bytearray(header)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        offset, layout = rng.choice(NIFTI_FIELDS)
        if offset + 4 <= len(changed):
            struct.pack_into(rng.choice("<<<>") + layout, changed, offset, rng.choice(NIFTI_NUMBERS[layout]))
    return bytes(changed)


def swap_order(rng, header):
    changed = bytearray(header)
    for offset, layout in NIFTI_FIELDS:
        size = struct.calcsize(layout)
        if rng.random() < 0.9 and offset + size <= len(changed):
            changed[offset:offset + size] = changed[offset:offset + size][::-1]
    return bytes(changed)


def mutated(rng, format_name):
    """The bytes of one damaged file."""
    _, seeds, lines = FORMATS[format_name]
    seed = rng.choice(seeds())

    def insert_line(rng, header):
        all_lines = header.split(b"\n")
        all_lines.insert(rng.randrange(1, len(all_lines) + 1), rng.choice(lines))
        return b"\n".join(all_lines)

    def swap_text_order(rng, header):
        for one, other in ((b"big", b"little"), (b"little", b"big"), (b"MSB = True", b"MSB = False"),
                           (b"MSB = False", b"MSB = True")):
            if one in header:
                return header.replace(one, other)
        return change_number(rng, header)

    kinds = [flip_bits, replace_bytes, truncate, insert_junk]
    if lines is None:
        kinds += [change_field] * 5 + [swap_order]
    else:
        kinds += [change_lines, change_number, change_number, change_number, change_word, change_word, lengthen,
                  insert_line, insert_line, swap_text_order]
    header, data = seed.header, seed.data
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        if header:
            header = rng.choice(kinds)(rng, header)
    if data and rng.random() < 0.15:
        data = rng.choice([flip_bits, truncate, insert_junk])(rng, data)
    whole = header + data
    if seed.pack:
        whole = gzip.compress(whole, mtime=0)
        if rng.random() < 0.15:
            whole = rng.choice([flip_bits, truncate, insert_junk])(rng, whole)
    return whole


def fault_of_answer(answer):
    """Why the answer of a successful `info --json` makes no sense; empty where it does."""
    dims = answer.get("dims")
    if not isinstance(dims, list) or len(dims) != 3 or any(d < 1 for d in dims):
        return "dims %s" % dims
    voxels = dims[0] * dims[1] * dims[2]
    numbers = answer["spacing"] + answer["origin"] + answer["data_range"]
    if not all(isinstance(n, (int, float)) and math.isfinite(n) for n in numbers):
        return "numbers that are not finite"
    if not all(s > 0 for s in answer["spacing"]) or answer["data_range"][0] > answer["data_range"][1]:
        return "spacing or range"
    if not 0 <= answer["invalid"] <= voxels or answer["memory_bytes"] < voxels:
        return "counts"
    return ""


g_opener = None


def fault_of_opening(options, path):
    """The same of open_files."""
    global g_opener
    if g_opener is None:
        g_opener = Opener([options.program, "--memory", "1"], options.timeout)
    answer = g_opener.open(path)
    if answer.status < 0:
        return False, "the program ended (%d): %s" % (answer.status, answer.said)
    if answer.cpu > options.cpu:
        return False, "%.1f s of computing" % answer.cpu
    if answer.mib > options.memory + 2 * os.path.getsize(path) / 2**20:
        return False, "%.0f MiB of the heap" % answer.mib
    if answer.status == 0:
        return True, fault_of_answer(answer.read)
    return False, line_fault(answer.said)


def fault_of_run(options, path):
    """(was read, what is wrong with the run)."""
    if is_opener(options.program):
        return fault_of_opening(options, path)
    try:
        run = subprocess.run([options.program, "info", "--json", "--memory", "1", path], stdin=subprocess.DEVNULL,
                             capture_output=True, timeout=options.timeout)
    except subprocess.TimeoutExpired:
        return False, "still runs after %d s" % options.timeout
    said = run.stderr.decode("utf-8", "replace")
    if run.returncode < 0:
        return False, "signal %d" % -run.returncode
    if run.returncode == 0:
        try:
            wrong = fault_of_answer(json.loads(run.stdout))
        except ValueError:
            wrong = "no JSON"
        if not wrong and said:
            wrong = "words on stderr: " + said[:200]
        return True, wrong
    if run.returncode != 1:
        return False, "exit status %d: %s" % (run.returncode, said[:2000])
    if said.count("\n") != 1 or not said.endswith("\n") or len(said) < 10:
        return False, "not one line on stderr: " + repr(said[:300])
    return False, "" if not run.stdout else "words on stdout"


g_options = None


def prepare(options):
    global g_options, g_opener
    g_options = options
    g_opener = None  # each process needs one of its own
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if options.address_space > 0 and not is_opener(options.program):
        bytes_ = int(options.address_space * 2**30)
        resource.setrlimit(resource.RLIMIT_AS, (bytes_, bytes_))


def try_one(case):
    format_name, number = case
    rng = random.Random("%s/%s/%d" % (g_options.seed, format_name, number))
    path = os.path.join(g_options.folder, "case-%s-%d%s" % (format_name, number, FORMATS[format_name][0]))
    with open(path, "wb") as file:
        file.write(mutated(rng, format_name))
    was_read, wrong = fault_of_run(g_options, path)
    if wrong and g_options.keep:
        shutil.copy(path, g_options.keep)
    os.remove(path)
    return format_name, number, was_read, wrong


def write_companions(folder):
    """What the detached headers name, and what they come to name."""
    for name, content in (("data.raw", b"head" + VALUES), ("data.gz", gzip.compress(b"head" + VALUES, mtime=0)),
                          ("data.z", zlib.compress(VALUES)), ("data.txt", b"a line\n" + text_data(24)),
                          ("slab0.raw", b"-" + VALUES[:12]), ("slab1.raw", b"-" + VALUES[12:]),
                          ("data.bz2", bz2.compress(VALUES)),
                          ("step.vti", vti_seeds()[0].header + vti_seeds()[0].data)):
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
    os.mkdir(os.path.join(folder, "folder"))
    os.mkfifo(os.path.join(folder, "pipe"))


def check_seeds(options):
    """The undamaged files have to be read."""
    failed = []
    for format_name, (suffix, seeds, _) in FORMATS.items():
        for number, seed in enumerate(seeds()):
            path = os.path.join(options.folder, "seed-%d%s" % (number, suffix))
            whole = seed.header + seed.data
            with open(path, "wb") as file:
                file.write(gzip.compress(whole, mtime=0) if seed.pack else whole)
            was_read, wrong = fault_of_run(options, path)
            if wrong or not was_read:
                failed.append("%s, seed %d: %s" % (format_name, number, wrong or "is refused"))
            os.remove(path)
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="pellucid-cli, or open_files")
    parser.add_argument("--count", type=int, default=2000, help="damaged files per format (default 2000)")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time (default 1)")
    parser.add_argument("--seed", default="1", help="another one makes other files (default 1)")
    parser.add_argument("--formats", default=",".join(FORMATS), help="some of " + ",".join(FORMATS))
    parser.add_argument("--timeout", type=int, default=5, help="seconds after which a run hangs (default 5)")
    parser.add_argument("--cpu", type=float, default=5, help="seconds of computing for open_files (default 5)")
    parser.add_argument("--memory", type=float, default=256,
                        help="MiB for open_files, besides twice the file (default 256)")
    parser.add_argument("--first", type=int, default=0, help="number of the first one, to go on later (default 0)")
    parser.add_argument("--keep", help="an existing folder for the files that were found to go wrong")
    parser.add_argument("--address-space", type=float, default=4,
                        help="limit of the program's address space in GiB; 0: none, as sanitizers need (default 4)")
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    if not os.access(options.program, os.X_OK):
        parser.error("no program: " + options.program)
    names = options.formats.split(",")
    if options.count < 1 or options.jobs < 1 or any(name not in FORMATS for name in names):
        parser.error("wrong --count, --jobs or --formats")

    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        options.folder = folder
        write_companions(folder)
        failed = check_seeds(options)
        counts = {name: [0, 0, 0] for name in names}  # read, refused, wrong
        cases = [(name, number) for name in names for number in range(options.first, options.first + options.count)]
        with multiprocessing.Pool(options.jobs, prepare, (options,)) as pool:
            for name, number, was_read, wrong in pool.imap_unordered(try_one, cases, chunksize=8):
                counts[name][2 if wrong else 0 if was_read else 1] += 1
                if wrong:
                    failed.append("%s, case %d: %s" % (name, number, wrong))
    print("%-8s %8s %8s %8s" % ("format", "read", "refused", "wrong"))
    for name in names:
        print("%-8s %8d %8d %8d" % (name, *counts[name]))
    for line in sorted(failed):
        print(line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
