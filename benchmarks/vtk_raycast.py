#!/usr/bin/python3
"""One evaluation of Pellucid against one picture of VTK's CPU ray caster, on the same volume and transfer function.

Prints how long vtkFixedPointVolumeRayCastMapper takes for a picture in the steady state, how long `pellucid-cli bench`
says an 8-candidate sweep takes, and the ratio of the two. Run it on a display, real or virtual, with the Python that
has VTK (see README.md here):

    xvfb-run -a -s "-screen 0 1024x1024x24" /usr/bin/python3 benchmarks/vtk_raycast.py \\
        --cli build/release/bin/pellucid-cli

What is the same on both sides: the voxels, the view, the transfer function, the number of threads. VTK draws without
shading, with linear interpolation, one ray per pixel, samples one d0 apart; opacities are those of a path of d0.
"""

import argparse
import colorsys
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

try:
    import numpy as np
    import vtk
except ImportError as missing:
    sys.exit(f"{missing}; install python3-vtk9 and run this with the system's Python")

FOV_DEGREES = 30.0  # as in src/render/camera.cpp, zoom 1
VTK_TYPES = {"uint8": "UnsignedChar", "int16": "Short", "uint16": "UnsignedShort", "float": "Float"}
NUMPY_TYPES = {"uint8": "u1", "int16": "<i2", "uint16": "<u2", "float": "<f4"}


def read_nrrd(path):
    """Voxels as an array [z][y][x], and the spacing. Files in one piece: raw or gzip, little endian."""
    data = Path(path).read_bytes()
    head, body = data.split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    if fields["encoding"] not in ("raw", "gzip", "gz") or fields.get("endian", "little") != "little":
        sys.exit(f"{path}: expected raw or gzip, little endian")
    nx, ny, nz = (int(n) for n in fields["sizes"].split())
    rows = [[float(v) for v in row.split(",")] for row in fields["space directions"].strip("() ").split(") (")]
    type_name = {"short": "int16", "ushort": "uint16", "uchar": "uint8"}.get(fields["type"], fields["type"])
    values = body if fields["encoding"] == "raw" else zlib.decompress(body, wbits=31)
    voxels = np.frombuffer(values, NUMPY_TYPES[type_name])
    return voxels.reshape(nz, ny, nx), [math.hypot(*row) for row in rows], type_name


def tents(count, peak, low, high):
    """MEASURES' tents:N:PEAK as VTK's opacity and colour functions, in data units."""
    opacity, color = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
    for i in range(count):
        centre = (i + 0.5) / count
        for offset, alpha in ((-0.4, 0.0), (0.0, peak), (0.4, 0.0)):
            value = low + (centre + offset / count) * (high - low)
            opacity.AddPoint(value, alpha)
            color.AddRGBPoint(value, *colorsys.hsv_to_rgb(centre, 1, 1))
    return opacity, color


class Picture:
    """The volume in a window of VTK's."""

    def __init__(self, voxels, spacing, type_name, threads, size, directions=((1, 0, 0), (0, 1, 0), (0, 0, 1))):
        """`directions`: of the axes in the world, unit vectors, as `pellucid-cli info` has them."""
        self.bytes = voxels.tobytes()
        nz, ny, nx = voxels.shape
        importer = vtk.vtkImageImport()
        importer.SetImportVoidPointer(self.bytes)
        getattr(importer, "SetDataScalarTypeTo" + VTK_TYPES[type_name])()
        importer.SetNumberOfScalarComponents(1)
        importer.SetDataSpacing(*spacing)
        importer.SetDataExtent(0, nx - 1, 0, ny - 1, 0, nz - 1)
        importer.SetWholeExtent(0, nx - 1, 0, ny - 1, 0, nz - 1)
        importer.Update()

        self.mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        self.mapper.SetInputConnection(importer.GetOutputPort())
        self.mapper.SetBlendModeToComposite()
        self.mapper.AutoAdjustSampleDistancesOff()
        self.mapper.LockSampleDistanceToInputSpacingOff()
        self.mapper.SetImageSampleDistance(1)
        self.mapper.IntermixIntersectingGeometryOff()
        self.mapper.SetNumberOfThreads(threads)

        self.volume = vtk.vtkVolume()
        self.volume.SetMapper(self.mapper)
        properties = self.volume.GetProperty()
        properties.ShadeOff()
        properties.SetInterpolationTypeToLinear()
        self.d0 = min(spacing)
        properties.SetScalarOpacityUnitDistance(self.d0)

        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.AddVolume(self.volume)
        self.window = vtk.vtkRenderWindow()
        self.window.SetSize(size, size)
        self.window.SetMultiSamples(0)
        self.window.AddRenderer(self.renderer)

        # The box reaches half a voxel beyond the outer centres. It turns about the first of them.
        low = [-0.5 * s for s in spacing]
        high = [(n - 0.5) * s for n, s in zip((nx, ny, nz), spacing)]
        self.size = math.dist(low, high)
        middle = [(a + b) / 2 for a, b in zip(low, high)]
        self.center = [sum(directions[axis][row] * middle[axis] for axis in range(3)) for row in range(3)]
        world = vtk.vtkMatrix4x4()
        for row in range(3):
            for axis in range(3):
                world.SetElement(row, axis, directions[axis][row])
        self.volume.SetUserMatrix(world)

    def look(self, azimuth, elevation):
        """cameraFromView() of src/render/camera.cpp, perspective, zoom 1."""
        az, el = math.radians(azimuth), math.radians(elevation)
        to_eye = (math.sin(az) * math.cos(el), -math.cos(az) * math.cos(el), math.sin(el))
        up = (-math.sin(az) * math.sin(el), math.cos(az) * math.sin(el), math.cos(el))
        distance = 0.5 * self.size / math.sin(math.radians(FOV_DEGREES) / 2)
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*self.center)
        camera.SetPosition(*(c + distance * t for c, t in zip(self.center, to_eye)))
        camera.SetViewUp(*up)
        camera.SetViewAngle(FOV_DEGREES)
        self.renderer.ResetCameraClippingRange()

    def show(self, opacity, color):
        self.volume.GetProperty().SetScalarOpacity(opacity)
        self.volume.GetProperty().SetColor(color)

    def times(self, sample_distance, frames, view):
        """Per picture what the mapper counts (rays, and handing the picture over), the whole of Render(), and the time
        of all processors for it; lists of seconds. The camera turns by half a degree each time."""
        self.mapper.SetSampleDistance(sample_distance)
        times = {"mapper": [], "render": [], "cpu": []}
        for frame in range(frames + 2):
            self.look(view[0] + 0.5 * frame, view[1])
            start, cpu = time.perf_counter(), time.process_time()
            self.window.Render()
            if frame < 2:  # these prepare tables
                continue
            times["render"].append(time.perf_counter() - start)
            times["cpu"].append(time.process_time() - cpu)
            times["mapper"].append(self.mapper.GetTimeToDraw())
        return times

    def display_time(self, frames, view):
        """The same of a scene without the volume: what showing costs."""
        self.volume.VisibilityOff()
        whole = []
        for frame in range(frames):
            self.look(view[0] + 0.5 * frame, view[1])
            start = time.perf_counter()
            self.window.Render()
            whole.append(time.perf_counter() - start)
        self.volume.VisibilityOn()
        return statistics.median(whole)

    def write(self, path, view):
        self.look(*view)
        self.window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(str(path))
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()


def pellucid(cli, *arguments):
    answer = subprocess.run([cli, *arguments, "--json"], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return json.loads(answer.stdout)


def compare(options, file, picture, peak, view):
    """Both programs in turn, so that a machine that changes its speed changes that of both."""
    drawn = {"d0": {}, "1 world unit": {}}
    swept = {1: {}, 8: {}}
    for _ in range(options.rounds):
        for label, distance in (("d0", picture.d0), ("1 world unit", 1.0)):
            for key, values in picture.times(distance, options.frames, view).items():
                drawn[label].setdefault(key, []).extend(values)
        for row in pellucid(options.cli, "bench", file, "--tf", f"tents:3:{peak:g}", "--only", "sweep", "--threads",
                            str(options.threads), "--view", options.view, "--engine", "cpu", "--repeat", "3")["rows"]:
            for key in ("seconds", "cpu_seconds"):
                swept[row["candidates"]].setdefault(key, []).append(row[key])
    median = statistics.median
    print(f"\ntents:3:{peak:g}                          time    CPU time  [ms]")
    for label, times in drawn.items():
        mapper, render, cpu = (1e3 * median(times[key]) for key in ("mapper", "render", "cpu"))
        print(f"  VTK, samples every {label:12}  {mapper:9.1f}   {cpu:9.1f}   (whole Render(): {render:.1f})")
    print(f"  VTK, no volume                   {1e3 * picture.display_time(options.frames, view):9.1f}")
    for candidates, times in swept.items():
        print(f"  Pellucid, sweep of {candidates}             {1e3 * median(times['seconds']):9.1f}   "
              f"{1e3 * median(times['cpu_seconds']):9.1f}")
    print(f"  sweep of 8 / picture (d0)        {median(swept[8]['seconds']) / median(drawn['d0']['mapper']):9.2f}   "
          f"{median(swept[8]['cpu_seconds']) / median(drawn['d0']['cpu']):9.2f}")


def write_pictures(options, file, picture, peak, view):
    target = Path(options.pictures)
    target.mkdir(parents=True, exist_ok=True)
    picture.mapper.SetSampleDistance(picture.d0)
    picture.write(target / f"vtk_{peak:g}.png", view)
    subprocess.run([options.cli, "render", file, "--tf", f"tents:3:{peak:g}", "--view", options.view, "--engine", "cpu",
                    "--size", f"{options.image_size}x{options.image_size}", "--out",
                    str(target / f"pellucid_{peak:g}.png")], check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cli", required=True, help="the pellucid-cli to measure")
    parser.add_argument("--sample", default="knee", help="built-in volume (default knee)")
    parser.add_argument("--size", type=int, default=0, help="voxels along its longest axis (default: its own)")
    parser.add_argument("--peaks", default="0.5,0.1,0.02", help="peaks of tents:3 (default 0.5,0.1,0.02)")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--frames", type=int, default=9, help="pictures in a row (default 9)")
    parser.add_argument("--rounds", type=int, default=3, help="turns of both programs (default 3)")
    parser.add_argument("--image-size", type=int, default=512)
    parser.add_argument("--view", default="30,20", help="AZIMUTH,ELEVATION in degrees (default 30,20)")
    parser.add_argument("--pictures", help="write pictures of both into this folder, to look at")
    options = parser.parse_args()
    view = [float(v) for v in options.view.split(",")]
    size = ["--size", str(options.size)] if options.size else []

    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "volume.nrrd")
        subprocess.run([options.cli, "generate", options.sample, *size, "--out", file], check=True,
                       stdout=subprocess.DEVNULL)
        voxels, spacing, type_name = read_nrrd(file)
        info = pellucid(options.cli, "info", file)
        picture = Picture(voxels, spacing, type_name, options.threads, options.image_size, info["directions"])
        nz, ny, nx = voxels.shape
        print(f"VTK {vtk.vtkVersion.GetVTKVersion()}, {options.sample} {nx} x {ny} x {nz}, {options.image_size}² "
              f"pixels, {picture.mapper.GetNumberOfThreads()} threads, medians of {options.rounds} x {options.frames} "
              f"pictures; d0 = {picture.d0:g}")
        for peak in (float(p) for p in options.peaks.split(",")):
            picture.show(*tents(3, peak, *info["range"]))
            compare(options, file, picture, peak, view)
            if options.pictures:
                write_pictures(options, file, picture, peak, view)


if __name__ == "__main__":
    main()
