#!/usr/bin/env python3
"""Damages files of the formats that libraries read, and looks at what `pellucid-cli` makes of each.

Every file has to be read, or be refused with status 1 and exactly one printable line on stderr: no signal, no more than
--cpu seconds of computing, no more memory in one process than 256 MiB and twice what the undamaged file unpacks to, and
no half file left by `convert`. A library that crashes on a file is a sentence, too: such files are counted by
themselves, and --keep keeps them. The same --seed makes the same files. Exit status: 0 all well, 1 something was found,
2 wrong usage.

    mutate_foreign.py build/release/bin/pellucid-cli --count 2000 --jobs 4 --keep found

Instead of pellucid-cli, which is started for each file, it takes open_files, which opens them all in one process and
starts a reader of foreign formats for each, and open_foreign (open_foreign_dicom and so on have to be there), which
does what a reader does, for all files in one process: for builds with sanitizers. A finding of these is something found,
in a reader, too.

Needs Debian's python3-pydicom, python3-tifffile, python3-h5py, python3-netcdf4 and python3-zarr.
"""

import argparse
import multiprocessing
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import zlib

from opener import Opener, is_opener, line_fault

SHAPE = (4, 6, 8)  # z, y, x


class Seed:
    """A sound volume: its files by their names in a folder, and the one that is opened ("": the folder)."""

    def __init__(self, files, opened=""):
        self.files, self.opened = files, opened


def read_all(folder):
    files = {}
    for where, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(where, name)
            with open(path, "rb") as file:
                files[os.path.relpath(path, folder)] = file.read()
    return files


def written(write, opened=""):
    """The seed that write(folder) leaves in a folder."""
    with tempfile.TemporaryDirectory() as folder:
        write(folder)
        return Seed(read_all(folder), opened)


def voxels(kind="u2"):
    import numpy
    return (numpy.arange(SHAPE[0] * SHAPE[1] * SHAPE[2]).reshape(SHAPE) * 37 % 251).astype(kind)


def dicom_dataset(number, syntax, **more):
    import pydicom
    from pydicom.dataset import FileDataset, FileMetaDataset
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
    meta.MediaStorageSOPInstanceUID = "1.2.3.4.%d" % number
    meta.TransferSyntaxUID = syntax
    data = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian, data.is_implicit_VR = True, syntax == pydicom.uid.ImplicitVRLittleEndian
    data.SOPClassUID, data.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID, data.StudyInstanceUID = "1.2.3.4", "1.2.3"
    data.Modality, data.SeriesDescription, data.SeriesNumber, data.InstanceNumber = "CT", "a test", 1, number
    data.Rows, data.Columns, data.SamplesPerPixel = SHAPE[1], SHAPE[2], 1
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit, data.PixelRepresentation, data.PhotometricInterpretation = 15, 0, "MONOCHROME2"
    data.PixelSpacing, data.SliceThickness = [0.5, 0.5], 2
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    data.ImagePositionPatient = [0, 0, 2 * number]
    data.RescaleSlope, data.RescaleIntercept = 1, -1024
    data.AcquisitionTime, data.WindowCenter = "101010.5", 40
    for name, value in more.items():
        setattr(data, name, value)
    return data


def rle_frame(frame):
    """16 bits as two segments of bytes, each as runs that are written out (DICOM PS3.5, annex G)."""
    segments = []
    for shift in (8, 0):
        plain = bytes((frame.astype("u2") >> shift).astype("u1").tobytes())
        packed = b"".join(bytes([len(plain[i:i + 128]) - 1]) + plain[i:i + 128] for i in range(0, len(plain), 128))
        segments.append(packed + b"\0" * (len(packed) % 2))
    head = struct.pack("<16I", 2, 64, 64 + len(segments[0]), *[0] * 13)
    return head + b"".join(segments)


def dicom_seeds():
    import pydicom
    from pydicom.encaps import encapsulate

    def slices(syntax, pixels):
        def write(folder):
            for z in range(SHAPE[0]):
                data = dicom_dataset(z + 1, syntax, PixelData=pixels(voxels()[z]))
                data["PixelData"].VR = "OW"
                data["PixelData"].is_undefined_length = syntax == pydicom.uid.RLELossless
                data.save_as(os.path.join(folder, "%d.dcm" % z), write_like_original=False)
        return write

    def frames(folder):
        data = dicom_dataset(1, pydicom.uid.ExplicitVRLittleEndian, NumberOfFrames=SHAPE[0],
                             PixelData=voxels("u1").tobytes(), BitsAllocated=8, BitsStored=8, HighBit=7)
        data["PixelData"].VR = "OB"
        data.save_as(os.path.join(folder, "a.dcm"), write_like_original=False)

    return [written(slices(pydicom.uid.ExplicitVRLittleEndian, lambda s: s.tobytes())),
            written(slices(pydicom.uid.ImplicitVRLittleEndian, lambda s: s.tobytes())),
            written(slices(pydicom.uid.RLELossless, lambda s: encapsulate([rle_frame(s)]))),
            written(frames, "a.dcm")]


def tiff_seeds():
    import tifffile

    def stack(**how):
        return lambda folder: tifffile.imwrite(os.path.join(folder, "a.tif"), voxels(how.pop("kind", "u2")), **how)

    def ome(folder):
        tifffile.imwrite(os.path.join(folder, "a.tif"), voxels(), ome=True,
                         metadata={"axes": "ZYX", "PhysicalSizeX": 0.5, "PhysicalSizeZ": 2})

    seeds = [written(stack(), "a.tif"), written(stack(bigtiff=True, byteorder=">"), "a.tif"),
             written(stack(compression="zlib", predictor=True), "a.tif"), written(stack(kind="f4", tile=(16, 16)), "a.tif"),
             written(stack(kind="u1", imagej=True, metadata={"spacing": 2.5, "unit": "um"}), "a.tif"),
             written(ome, "a.tif")]
    return seeds


def hdf5_seeds():
    import h5py
    import numpy

    def write(make, **how):
        def to(folder):
            with h5py.File(os.path.join(folder, "a.h5"), "w", **how) as file:
                make(file)
        return written(to, "a.h5")

    def plain(file):
        file.create_dataset("volume", data=voxels())
        file["volume"].attrs["element_size_um"] = [2.0, 0.5, 0.5]

    def packed(file):
        group = file.create_group("scans")
        group.create_dataset("density", data=voxels("f4"), chunks=(2, 3, 8), compression="gzip", shuffle=True,
                             fletcher32=True)
        group.create_dataset("mask", data=voxels() > 100, chunks=(4, 6, 8))
        group.create_dataset("names", data=numpy.array([b"a", b"b"]))
        group["again"] = h5py.SoftLink("/scans/density")
        group.attrs["title"] = "a test"

    def sparse(file):
        data = file.create_dataset("t", shape=(3,) + SHAPE, maxshape=(None,) + SHAPE, dtype="i2", chunks=(1, 2, 6, 8),
                                   fillvalue=7)
        data[1] = voxels("i2")

    return [write(plain), write(packed), write(packed, libver="latest"), write(sparse, libver="latest"), write(sparse)]


def netcdf_seeds():
    import netCDF4

    def write(form, packed):
        def to(folder):
            with netCDF4.Dataset(os.path.join(folder, "a.nc"), "w", format=form) as file:
                for name, size in zip(("time", "z", "y", "x"), (None,) + SHAPE):
                    file.createDimension(name, size)
                for name in ("time", "x"):
                    file.createVariable(name, "f8", (name,))
                file["time"].units, file["x"].units = "hours since 2000-01-01", "km"
                more = {"zlib": True, "chunksizes": (1, 2, 6, 8)} if packed else {}
                data = file.createVariable("density", "i2", ("time", "z", "y", "x"), fill_value=-1, **more)
                data.scale_factor, data.valid_range = 0.5, [0, 1000]
                for t in range(2):
                    file["time"][t] = 6 * t
                    data[t] = voxels("i2")
                file["x"][:] = range(SHAPE[2])
        return written(to, "a.nc")

    return [write("NETCDF4", True), write("NETCDF4", False), write("NETCDF4_CLASSIC", True), write("NETCDF3_CLASSIC", False),
            write("NETCDF3_64BIT_DATA", False)]


def zarr_seeds():
    import zarr
    from numcodecs import BZ2, LZ4, Blosc, Zlib, Zstd

    def write(codec, kind="u2"):
        def to(folder):
            group = zarr.open_group(folder, mode="w")
            for level, step in enumerate((1, 2)):
                group.create_dataset(str(level), data=voxels(kind)[::step, ::step, ::step], chunks=(2, 6, 8),
                                     compressor=codec)
            axes = [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
            sets = [{"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": [level + 1.0] * 3}]}
                    for level in range(2)]
            group.attrs["multiscales"] = [{"version": "0.4", "axes": axes, "datasets": sets}]
        return written(to)

    return [write(codec) for codec in (None, Zlib(), Zstd(), LZ4(), BZ2(), Blosc(cname="lz4"), Blosc(cname="zstd"))] + \
        [write(Blosc(shuffle=2), "f4")]


def png(pixels, bits, interlaced=False):
    """A grey picture (PNG specification, sections 5 and 11)."""
    rows = b"".join(b"\0" + row.astype(">u%d" % (bits // 8)).tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"pHYs", struct.pack(">IIB", 2000, 2000, 1)) + \
        chunk(b"tEXt", b"Title\0a test") + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def png_seeds():
    return [Seed({"s%d.png" % z: png(voxels("u%d" % (bits // 8))[z], bits) for z in range(SHAPE[0])}) for bits in (8, 16)]


FORMATS = {"dicom": dicom_seeds, "tiff": tiff_seeds, "hdf5": hdf5_seeds, "netcdf": netcdf_seeds, "zarr": zarr_seeds,
           "png": png_seeds}
NUMBERS = [0, 1, 2, 3, 7, 8, 16, 64, 127, 128, 255, 256, 4096, 32767, 32768, 65535, 65536, 2**24, 2**31 - 1, 2**31, 2**32 - 1,
           2**32, 2**63 - 1, 2**63, 2**64 - 1]
WORDS = [b"-1", b"0", b"1e999", b"nan", b"2147483648", b"18446744073709551616", b"\"\"", b"null", b"[]", b"{}", b"true",
         b"\"../..\"", b"[[[[[[[[[[", b"\\u0000", b"\x1b[31m"]


def place(rng, data):
    """Headers are at the beginning, mostly."""
    return rng.randrange(min(len(data), rng.choice([64, 512, 4096, len(data)])))


def flip_bits(rng, data, _):
    changed = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8, 40])):
        changed[place(rng, data)] ^= 1 << rng.randrange(8)
    return bytes(changed)


def run_of_bytes(rng, data, _):
    begin, count = place(rng, data), rng.choice([1, 2, 4, 16, 100])
    one = rng.choice([0, 0xff, 0x7f, 0x80, rng.randrange(256)])
    run = bytes([one]) * count if rng.random() < 0.6 else rng.randbytes(count)
    return data[:begin] + run + data[begin + count:]


def change_number(rng, data, _):
    begin, width = place(rng, data), rng.choice([1, 2, 4, 8])
    number = (rng.choice(NUMBERS) % 2**(8 * width)).to_bytes(width, rng.choice(["little", "big"]))
    return data[:begin] + number + data[begin + width:]


def change_word(rng, data, _):
    found = [m.span() for m in re.finditer(rb"-?[0-9]+(\.[0-9]+)?|\"[A-Za-z_0-9./|<>]*\"", data[:4096])]
    if not found:
        return change_number(rng, data, None)
    begin, end = rng.choice(found)
    return data[:begin] + rng.choice(WORDS) + data[end:]


def truncate(rng, data, _):
    return data[:rng.randrange(len(data))]


def insert(rng, data, other):
    begin, count = place(rng, data), rng.choice([1, 2, 8, 64, 1000])
    source = rng.choice([data, other])
    start = rng.randrange(len(source))
    return data[:begin] + (source[start:start + count] or b"\0") + data[begin:]


def remove(rng, data, _):
    begin = place(rng, data)
    return data[:begin] + data[begin + rng.choice([1, 2, 8, 64, 1000]):]


def swap(rng, data, other):
    """A piece of the file, or of another one, over another piece."""
    source = rng.choice([data, other])
    begin, start, count = place(rng, data), rng.randrange(len(source)), rng.choice([4, 16, 128, 1024])
    return data[:begin] + source[start:start + count] + data[begin + count:]


KINDS = [flip_bits, flip_bits, run_of_bytes, change_number, change_number, change_word, truncate, insert, remove, swap]


def mutated(rng, seeds):
    """A seed with one of its files damaged, or missing."""
    seed, other = rng.choice(seeds), rng.choice(seeds)
    files = dict(seed.files)
    names = sorted(name for name, data in files.items() if data)
    metadata = [name for name in names if os.path.basename(name).startswith(".z")]
    name = rng.choice(metadata if metadata and rng.random() < 0.6 else names)
    if len(files) > 1 and rng.random() < 0.02:
        del files[name]
        return Seed(files, seed.opened)
    others = [data for data in other.files.values() if data]
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        if files[name]:
            files[name] = rng.choice(KINDS)(rng, files[name], rng.choice(others))
    return Seed(files, seed.opened)


def write_files(folder, seed):
    for name, data in seed.files.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(data)
    return os.path.join(folder, seed.opened) if seed.opened else folder


class Run:
    """One run of the program: how it ended, what it said, seconds of computing and MiB of its largest process."""

    def __init__(self, command, folder, timeout):
        with open(os.path.join(folder, "out"), "w+b") as out, open(os.path.join(folder, "err"), "w+b") as err:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
            signal.signal(signal.SIGALRM, lambda *_: process.kill())
            signal.alarm(timeout)
            _, status, used = os.wait4(process.pid, 0)
            signal.alarm(0)
            process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            err.seek(0)
            self.status, self.out, self.err = process.returncode, out.read(), err.read().decode("utf-8", "replace")
        self.cpu, self.mib = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def fault_of(run, options, result):
    if run.status < 0:
        return "signal %d" % -run.status
    if run.cpu > options.cpu:
        return "%.1f s of computing: %s" % (run.cpu, run.err[:200])
    if run.mib > options.memory:
        return "%.0f MiB: %s" % (run.mib, run.err[:200])
    if run.status not in (0, 1):
        return "exit status %d: %s" % (run.status, run.err[:2000])
    if run.status == 0:
        return "words on stderr: " + repr(run.err[:300]) if "error" in run.err else ""
    said = run.err
    if said.count("\n") != 1 or not said.endswith("\n") or len(said) < 10 or not said[:-1].isprintable():
        return "not one printable line on stderr: " + repr(said[:2000])
    if run.out:
        return "words on stdout"
    return "a file is left" if result and os.path.exists(result) else ""


g_options = None
g_seeds = {}


def prepare(options):
    global g_options
    g_options = options
    g_openers.clear()  # each process needs its own
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


READERS = {"dicom": "dicom", "tiff": "tiff", "png": "images", "hdf5": "arrays", "netcdf": "arrays", "zarr": "arrays"}
g_openers = {}


def is_alone():
    """Without the limit on memory that a reader has: what a library takes in all is not looked at."""
    return os.path.basename(g_options.program) == "open_foreign"


def opener_for(name):
    """open_files, or the open_foreign of this format; begun once."""
    key = READERS[name] if is_alone() else ""
    if key not in g_openers:
        words = [g_options.program + "_" + key] if is_alone() else [g_options.program, "--memory", "1"]
        g_openers[key] = Opener(words, g_options.timeout)
    return g_openers[key]


def is_from_sanitizer(said):
    return any(mark in said for mark in ("SUMMARY: AddressSanitizer", "runtime error:", "(status 99)"))


def opened(name, path):
    """run_on() by these. A library may end open_foreign as it may end a reader."""
    answer = opener_for(name).open(path)
    has_ended = "crashed on it" in answer.said or (answer.status < 0 and not is_from_sanitizer(answer.said) and is_alone())
    ended = "crashed" if has_ended else "read" if answer.status == 0 else "refused"
    if is_from_sanitizer(answer.said):
        wrong = "a sanitizer: " + answer.said
    elif answer.status < 0 and (not has_ended or "still runs" in answer.said):
        wrong = "the program ended (%d): %s" % (answer.status, answer.said)
    elif answer.cpu > g_options.cpu:
        wrong = "%.1f s of computing" % answer.cpu
    elif answer.mib > g_options.memory and not is_alone():
        wrong = "%.0f MiB of the heap" % answer.mib
    else:
        wrong = line_fault(answer.said) if answer.status == 1 else ""
    return ended, wrong, answer.said[-400:].replace("\n", " ")


def run_on(name, seed, number):
    """(how it ended, what is wrong): "read", "refused" or "crashed"."""
    with tempfile.TemporaryDirectory(dir=g_options.folder) as folder:
        path = write_files(os.path.join(folder, "in"), seed)
        if is_opener(g_options.program):
            return opened(name, path)
        result = os.path.join(folder, "out.nrrd") if number % 4 == 3 else None
        command = ["convert", path, "--out", result] if result else ["info", "--json", path]
        run = Run([g_options.program] + command + ["--memory", "1"], folder, g_options.timeout)
        wrong = fault_of(run, g_options, result)
    ended = "read" if run.status == 0 else "crashed" if "crashed on it" in run.err else "refused"
    return ended, wrong, run.err.strip()[-400:]


def try_one(case):
    name, number = case
    rng = random.Random("%s/%s/%d" % (g_options.seed, name, number))
    seed = mutated(rng, g_seeds[name])
    ended, wrong, said = run_on(name, seed, number)
    if (wrong or ended == "crashed") and g_options.keep:
        write_files(os.path.join(g_options.keep, "%s-%d" % (name, number)), seed)
    return name, number, ended, wrong, said


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="pellucid-cli, open_files or open_foreign")
    parser.add_argument("--count", type=int, default=2000, help="damaged files per format (default 2000)")
    parser.add_argument("--first", type=int, default=0, help="number of the first one, to go on later (default 0)")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time (default 1)")
    parser.add_argument("--seed", default="1", help="another one makes other files (default 1)")
    parser.add_argument("--formats", default=",".join(FORMATS), help="some of " + ",".join(FORMATS))
    parser.add_argument("--timeout", type=int, default=60, help="seconds after which a run hangs (default 60)")
    parser.add_argument("--cpu", type=float, default=5, help="seconds of computing that a run may take (default 5)")
    parser.add_argument("--memory", type=float, default=257,
                        help="MiB that a process may take; sanitizers need more (default 257)")
    parser.add_argument("--keep", help="a folder for the files that were found to go wrong, or that crash a library")
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    alone = os.path.basename(options.program) == "open_foreign"
    if not os.access(options.program + ("_dicom" if alone else ""), os.X_OK):
        parser.error("no program: " + options.program)
    names = options.formats.split(",")
    if options.count < 1 or options.jobs < 1 or any(name not in FORMATS for name in names):
        parser.error("wrong --count, --jobs or --formats")
    try:
        for name in names:
            g_seeds[name] = FORMATS[name]()
    except ImportError as error:
        print("SKIPPED: %s" % error)
        return 0

    failed, crashed = [], []
    counts = {name: {"read": 0, "refused": 0, "crashed": 0, "wrong": 0} for name in names}
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        options.folder = folder
        prepare(options)
        for name in names:
            for number, seed in enumerate(g_seeds[name]):
                ended, wrong, said = run_on(name, seed, 0)
                if wrong or ended != "read":
                    failed.append("%s, seed %d: %s" % (name, number, wrong or said))
        cases = [(name, options.first + number) for number in range(options.count) for name in names]
        with multiprocessing.Pool(options.jobs, prepare, (options,)) as pool:
            for name, number, ended, wrong, said in pool.imap_unordered(try_one, cases, chunksize=8):
                counts[name]["wrong" if wrong else ended] += 1
                if wrong:
                    failed.append("%s, case %d: %s" % (name, number, wrong))
                elif ended == "crashed":
                    crashed.append("%s, case %d: %s" % (name, number, said))
    print("%-8s %8s %8s %8s %8s" % ("format", "read", "refused", "crashed", "wrong"))
    for name in names:
        print("%-8s %8d %8d %8d %8d" % (name, *counts[name].values()))
    for line in sorted(failed) + sorted(crashed):
        print(line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
