#!/usr/bin/python3
"""Pictures of Pellucid's gl renderer against those of VTK's vtkGPUVolumeRayCastMapper.

Both draw the same orbit of views of the same volumes under the same transfer functions, unlit and lit, in turn, on the
same OpenGL: what is compared is the median time of a picture and how alike the pictures are (structural similarity). Run
it on a display, real or virtual, with the Python that has VTK (see README.md here):

    xvfb-run -a -s "-screen 0 1024x1024x24" /usr/bin/python3 benchmarks/vtk_gpu_render.py \\
        --cli build/release/bin/pellucid-cli sample:knee sample:shells:256

What is the same on both sides: the voxels, the views, the transfer function, the light, linear interpolation, one ray
per pixel, samples one d0 apart. Pellucid is timed by `pellucid-cli bench --only render --engine gl`, inside one process
and with the picture read back; VTK by the time from Render() to glFinish (vtkRenderWindow.WaitForCompletion).
"""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
    import vtk
    from skimage.io import imread
    from skimage.metrics import structural_similarity
except ImportError as missing:
    sys.exit(f"{missing}; install python3-vtk9 and python3-skimage and run this with the system's Python")

from vtk_raycast import Picture, pellucid, read_nrrd, tents
from vtk_render import parser_of, volume_file

# The light of Pellucid's --shading: from the camera.
AMBIENT, DIFFUSE, SPECULAR, SHININESS = 0.35, 0.65, 0.25, 24.0


class GpuPicture(Picture):
    """The volume in a window of VTK's, drawn by OpenGL."""

    def __init__(self, voxels, spacing, type_name, size, directions):
        super().__init__(voxels, spacing, type_name, 1, size, directions)
        source = self.mapper.GetInputConnection(0, 0)
        self.mapper = vtk.vtkGPUVolumeRayCastMapper()
        self.mapper.SetInputConnection(source)
        self.mapper.SetBlendModeToComposite()
        self.mapper.AutoAdjustSampleDistancesOff()
        self.mapper.LockSampleDistanceToInputSpacingOff()
        self.mapper.SetImageSampleDistance(1)
        self.mapper.SetSampleDistance(self.d0)
        self.mapper.UseJitteringOff()
        self.volume.SetMapper(self.mapper)

    def light(self, on):
        properties = self.volume.GetProperty()
        properties.SetShade(on)
        properties.SetAmbient(AMBIENT)
        properties.SetDiffuse(DIFFUSE)
        properties.SetSpecular(SPECULAR)
        properties.SetSpecularPower(SHININESS)

    def orbit_times(self, views):
        """Seconds per picture, after two that prepare tables and shaders."""
        times = []
        for n, view in enumerate([views[-2], views[-1], *views]):
            self.look(*view)
            start = time.perf_counter()
            self.window.Render()
            self.window.WaitForCompletion()
            if n >= 2:
                times.append(time.perf_counter() - start)
        return times


def pellucid_times(options, file, peak, lit):
    rows = pellucid(options.cli, "bench", file, "--tf", f"tents:3:{peak:g}", "--only", "render", "--view",
                    f"0,{options.elevation:g}", "--engine", "gl", "--repeat", "1", "--orbit", str(options.views),
                    "--image-size", f"{options.image_size}x{options.image_size}", "--step", "1",
                    *(["--shading"] if lit else []))["rows"]
    return rows[0]["frames"]


def similarity(options, file, picture, peak, lit, view, folder):
    """Of one picture by both, as 8-bit colours."""
    label = f"{Path(file).stem}_{peak:g}{'_lit' if lit else ''}_{view[0]:g}"
    ours, theirs = folder / f"pellucid_{label}.png", folder / f"vtk_{label}.png"
    picture.write(theirs, view)
    subprocess.run([options.cli, "render", file, "--tf", f"tents:3:{peak:g}", "--view", f"{view[0]:g},{view[1]:g}",
                    "--engine", "gl", "--size", f"{options.image_size}x{options.image_size}", "--step", "1",
                    *(["--shading"] if lit else []), "--out", str(ours)], check=True, stdout=subprocess.DEVNULL)
    return structural_similarity(imread(ours)[..., :3], imread(theirs)[..., :3], channel_axis=-1)


def main():
    options = parser_of(__doc__, 8).parse_args()
    views = [(360.0 * i / options.views, options.elevation) for i in range(options.views)]
    figures = []

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(options.pictures or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name in options.volumes:
            file = volume_file(options, name, Path(temporary))
            voxels, spacing, type_name = read_nrrd(file)
            info = pellucid(options.cli, "info", file)
            picture = GpuPicture(voxels, spacing, type_name, options.image_size, info["directions"])
            nz, ny, nx = voxels.shape
            print(f"VTK {vtk.vtkVersion.GetVTKVersion()}, {Path(file).name} {nx} x {ny} x {nz}, {options.image_size}² "
                  f"pixels, medians of {options.rounds} orbits of {options.views}\n"
                  f"  light   peak   Pellucid [ms]   VTK [ms]   ratio   SSIM")
            for lit in {"off": [False], "on": [True], "both": [False, True]}[options.light]:
                picture.light(lit)
                for peak in (float(p) for p in options.peaks.split(",")):
                    picture.show(*tents(3, peak, *info["range"]))
                    ours, theirs = [], []
                    for _ in range(options.rounds):
                        theirs += picture.orbit_times(views)
                        ours += pellucid_times(options, file, peak, lit)
                    ours, theirs = 1e3 * statistics.median(ours), 1e3 * statistics.median(theirs)
                    alike = min(similarity(options, file, picture, peak, lit, views[i], folder)
                                for i in (0, len(views) // 3))
                    print(f"  {'on ' if lit else 'off'}   {peak:6g}   {ours:13.1f}   {theirs:8.1f}   "
                          f"{ours / theirs:5.2f}   {alike:.3f}", flush=True)
                    figures.append({"volume": name, "lit": lit, "peak": peak, "pellucid_ms": ours, "vtk_ms": theirs,
                                    "ratio": ours / theirs, "ssim": alike})
    if options.json:
        Path(options.json).write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
