#!/usr/bin/python3
"""Pictures of Pellucid's CPU renderer against those of VTK's vtkFixedPointVolumeRayCastMapper.

Both draw the same orbit of views of the same volumes under the same transfer functions, unlit and lit, in turn; what is
compared is the median time of a picture and how alike the pictures are (structural similarity). Run it on a display,
real or virtual, with the Python that has VTK (see README.md here):

    xvfb-run -a -s "-screen 0 1024x1024x24" /usr/bin/python3 benchmarks/vtk_render.py \\
        --cli build/release/bin/pellucid-cli sample:knee cranium_ct.nrrd sample:shells:256

What is the same on both sides: the voxels, the views, the transfer function, the light, the number of threads, linear
interpolation, one ray per pixel, samples one d0 apart. Pellucid is timed by `pellucid-cli bench --only render`, inside
one process; VTK by its mapper's GetTimeToDraw().
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import vtk_raycast
from vtk_raycast import Picture, pellucid, read_nrrd, tents

try:
    from skimage.io import imread
    from skimage.metrics import structural_similarity
except ImportError as missing:
    sys.exit(f"{missing}; install python3-skimage and run this with the system's Python")

# The light of Pellucid's --shading: from the eye.
AMBIENT, DIFFUSE, SPECULAR, SHININESS = 0.35, 0.65, 0.25, 24.0


def light(picture, on):
    properties = picture.volume.GetProperty()
    properties.SetShade(on)
    properties.SetAmbient(AMBIENT)
    properties.SetDiffuse(DIFFUSE)
    properties.SetSpecular(SPECULAR)
    properties.SetSpecularPower(SHININESS)
    from_eye = vtk_raycast.vtk.vtkLight()
    from_eye.SetLightTypeToHeadlight()
    from_eye.SetAmbientColor(1, 1, 1)  # VTK's own has none, and then ambient light does nothing
    picture.renderer.RemoveAllLights()
    picture.renderer.AddLight(from_eye)


def orbit(views, elevation):
    """As `bench --orbit`: azimuths all around."""
    return [(360.0 * i / views, elevation) for i in range(views)]


def vtk_times(picture, views):
    """Seconds per picture of the orbit, and those of all processors, after two pictures that prepare tables."""
    times, cpu = [], []
    for n, view in enumerate([views[-2], views[-1], *views]):
        picture.look(*view)
        start = time.process_time()
        picture.window.Render()
        if n >= 2:
            times.append(picture.mapper.GetTimeToDraw())
            cpu.append(time.process_time() - start)
    return times, cpu


def pellucid_times(options, file, peak, lit):
    shade = ["--shading"] if lit else []
    rows = pellucid(options.cli, "bench", file, "--tf", f"tents:3:{peak:g}", "--only", "render", "--threads",
                    str(options.threads), "--view", f"0,{options.elevation:g}", "--engine", "cpu", "--repeat", "1",
                    "--orbit", str(options.views), "--image-size", f"{options.image_size}x{options.image_size}", "--step", "1",
                    *shade)["rows"]
    return rows[0]["frames"], rows[0]["cpu_frames"]


def similarity(options, file, picture, peak, lit, view, folder):
    """Of one picture by both, as 8-bit colours; and of ours to VTK's with samples eight times as close, which has
    less of the grain that samples between two values leave under steep transfer functions."""
    label = f"{Path(file).stem}_{peak:g}{'_lit' if lit else ''}"
    ours, theirs = folder / f"pellucid_{label}.png", folder / f"vtk_{label}.png"
    fine = folder / f"vtk_fine_{label}.png"
    for file_name, distance in ((fine, picture.d0 / 8), (theirs, picture.d0)):
        picture.mapper.SetSampleDistance(distance)
        picture.write(file_name, view)
    subprocess.run([options.cli, "render", file, "--tf", f"tents:3:{peak:g}", "--view", f"{view[0]:g},{view[1]:g}",
                    "--engine", "cpu", "--size", f"{options.image_size}x{options.image_size}", "--step", "1",
                    *(["--shading"] if lit else []), "--out", str(ours)], check=True, stdout=subprocess.DEVNULL)
    return [structural_similarity(imread(ours)[..., :3], imread(other)[..., :3], channel_axis=-1)
            for other in (theirs, fine)]


def volume_file(options, name, folder):
    """A file that both read, made where a sample is named: sample:NAME[:SIZE]."""
    if not name.startswith("sample:"):
        return name
    sample, _, size = name.removeprefix("sample:").partition(":")
    file = str(folder / f"{sample}{size}.nrrd")
    subprocess.run([options.cli, "generate", sample, *(["--size", size] if size else []), "--out", file], check=True,
                   stdout=subprocess.DEVNULL)
    return file


def compare(options, file, picture, peak, lit, views, folder):
    """Both programs in turn; prints a line and returns its figures."""
    ours, theirs = ([], []), ([], [])
    for _ in range(options.rounds):
        for all_times, times in ((theirs, vtk_times(picture, views)), (ours, pellucid_times(options, file, peak, lit))):
            all_times[0].extend(times[0])
            all_times[1].extend(times[1])
    medians = {"pellucid_ms": ours[0], "vtk_ms": theirs[0], "pellucid_cpu_ms": ours[1], "vtk_cpu_ms": theirs[1]}
    figures = {"lit": lit, "peak": peak} | {key: 1e3 * statistics.median(values) for key, values in medians.items()}
    figures["ratio"] = figures["pellucid_ms"] / figures["vtk_ms"]
    figures["cpu_ratio"] = figures["pellucid_cpu_ms"] / figures["vtk_cpu_ms"]
    alike = [similarity(options, file, picture, peak, lit, views[i], folder) for i in (0, len(views) // 3)]
    figures["ssim"], figures["ssim_fine"] = (min(values) for values in zip(*alike))
    print(f"  {'on ' if lit else 'off'}   {peak:6g}   {figures['pellucid_ms']:8.1f} {figures['vtk_ms']:8.1f}   "
          f"{figures['ratio']:5.2f}   {figures['pellucid_cpu_ms']:8.1f} {figures['vtk_cpu_ms']:8.1f}   "
          f"{figures['cpu_ratio']:5.2f}   {figures['ssim']:.3f}   {figures['ssim_fine']:.3f}", flush=True)
    return figures


def parser_of(description, views):
    """The options of both comparisons of pictures; `views`: how many an orbit has by default."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("volumes", nargs="*", default=["sample:knee", "sample:shells:256"],
                        help="NRRD files, or sample:NAME[:SIZE] (default: sample:knee sample:shells:256)")
    parser.add_argument("--cli", required=True, help="the pellucid-cli to measure")
    parser.add_argument("--peaks", default="0.5,0.1,0.02", help="peaks of tents:3 (default 0.5,0.1,0.02)")
    parser.add_argument("--light", choices=["off", "on", "both"], default="both")
    parser.add_argument("--views", type=int, default=views, help=f"pictures of an orbit (default {views})")
    parser.add_argument("--elevation", type=float, default=20, help="degrees, of the orbit (default 20)")
    parser.add_argument("--rounds", type=int, default=2, help="turns of both programs (default 2)")
    parser.add_argument("--image-size", type=int, default=512)
    parser.add_argument("--pictures", help="keep pictures of both in this folder, to look at")
    parser.add_argument("--json", help="write the figures into this file too")
    return parser


def main():
    parser = parser_of(__doc__, 24)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    views = orbit(options.views, options.elevation)
    lights = {"off": [False], "on": [True], "both": [False, True]}[options.light]
    figures = []

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(options.pictures or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name in options.volumes:
            file = volume_file(options, name, Path(temporary))
            voxels, spacing, type_name = read_nrrd(file)
            info = pellucid(options.cli, "info", file)
            picture = Picture(voxels, spacing, type_name, options.threads, options.image_size, info["directions"])
            picture.mapper.SetSampleDistance(picture.d0)
            nz, ny, nx = voxels.shape
            print(f"VTK {vtk_raycast.vtk.vtkVersion.GetVTKVersion()}, {Path(file).name} {nx} x {ny} x {nz}, "
                  f"{options.image_size}² pixels, {picture.mapper.GetNumberOfThreads()} threads, medians of "
                  f"{options.rounds} orbits of {options.views}\n"
                  "  light   peak   Pellucid      VTK   ratio   Pellucid      VTK   ratio   SSIM   to VTK at d0/8\n"
                  "                 time [ms]                   CPU time [ms]")
            for lit in lights:
                light(picture, lit)
                for peak in (float(p) for p in options.peaks.split(",")):
                    picture.show(*tents(3, peak, *info["range"]))
                    figures.append(compare(options, file, picture, peak, lit, views, folder) | {"volume": name})
    if options.json:
        Path(options.json).write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
