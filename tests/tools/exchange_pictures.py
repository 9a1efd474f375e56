#!/usr/bin/python3
"""How alike VTK's and Pellucid's pictures are under a transfer function that Pellucid has written for ParaView or 3D
Slicer.

    exchange_pictures.py PELLUCID_CLI DATA_FOLDER OUT_FOLDER [NAME…]

Draws tooth, cranium_ct and walnut (or those that are named) by VTK's ray caster on the CPU, unlit and with one camera,
and by `pellucid-cli render`, and prints the structural similarity (SSIM) of each pair. The outer layer of voxels is
cleared in both: VTK's volume ends at the outer voxels' centres, Pellucid's half a voxel beyond. What is written for
Voreen is opened again and drawn by Pellucid, and measured by the published profile, which knows Voreen's 8-bit
opacities: printed is the share of visibility that lies at other intensities than before. So are files for ITK-SNAP and
ImageVis3D opened again, which these programs lay over all values of the data. Exit status 1 where an SSIM is below 0.98
or that share above 0.01. Needs python3-vtk9, python3-numpy, python3-skimage and a display (xvfb-run).
"""
import json
import math
import os
import subprocess
import sys

try:
    import numpy as np
    import vtk
    from skimage.io import imread
    from skimage.metrics import structural_similarity
    from vtk.util import numpy_support
except ImportError as missing:
    print(f"SKIPPED: {missing} (Debian: python3-vtk9 python3-numpy python3-skimage)")
    sys.exit(0)

SIZE = 384
LEAST_SSIM = 0.98
MOST_MOVED = 0.01
# With options of the transfer function: that of the cranium leaves out the densest third of the values.
VOLUMES = [("tooth/tooth.mhd", ["tents:3:0.3"]), ("cranium_ct/cranium_ct.nrrd", ["auto", "--range", "-1024,1600"]),
           ("walnut/walnut.mhd", ["auto"])]


def run(cli, *words):
    done = subprocess.run([cli, *words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}: {done.stderr}")
    return done.stdout


def cleared_copy(cli, path, to):
    """The volume as NRRD, its outer layer at the smallest value."""
    info = json.loads(run(cli, "info", path, "--json"))
    whole = to + ".whole.vti"
    run(cli, "convert", path, "--out", whole)
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(whole)
    reader.Update()
    image = reader.GetOutput()
    nx, ny, nz = image.GetDimensions()
    values = numpy_support.vtk_to_numpy(image.GetPointData().GetScalars()).reshape(nz, ny, nx).copy()
    low = values.min()
    for face in (values[0], values[-1], values[:, 0], values[:, -1], values[:, :, 0], values[:, :, -1]):
        face[...] = low
    spacing = info["spacing"]
    kinds = {"uint8": "uchar", "uint16": "ushort", "int16": "short", "float32": "float", "int8": "signed char"}
    head = ("NRRD0004\ntype: %s\ndimension: 3\nsizes: %d %d %d\nspacings: %r %r %r\nendian: little\nencoding: raw\n\n"
            % (kinds[str(values.dtype)], nx, ny, nz, *spacing))
    with open(to, "wb") as out:
        out.write(head.encode())
        out.write(values.tobytes())
    copy = vtk.vtkImageData()
    copy.SetDimensions(nx, ny, nz)
    copy.SetSpacing(*spacing)
    copy.GetPointData().SetScalars(numpy_support.numpy_to_vtk(values.ravel(), deep=True))
    os.remove(whole)
    return copy


def from_paraview(path, image):
    """Functions and unit distance as ParaView takes them from its preset: the latter is its own default."""
    preset = json.load(open(path))[0]
    colors, opacities = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    rgb, alpha = preset["RGBPoints"], preset["Points"]
    for i in range(0, len(rgb), 4):
        colors.AddRGBPoint(*rgb[i:i + 4])
    for i in range(0, len(alpha), 4):
        opacities.AddPoint(*alpha[i:i + 4])
    edges = [(n - 1) * s for n, s in zip(image.GetDimensions(), image.GetSpacing())]
    cells = math.prod(n - 1 for n in image.GetDimensions())
    return colors, opacities, math.sqrt(sum(e * e for e in edges)) / cells ** (1 / 3)


def from_slicer(path, _image):
    component = json.load(open(path))["volumeProperties"][0]["components"][0]
    colors, opacities = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for p in component["rgbTransferFunction"]["points"]:
        colors.AddRGBPoint(p["x"], *p["color"], p["midpoint"], p["sharpness"])
    for p in component["scalarOpacity"]["points"]:
        opacities.AddPoint(p["x"], p["y"], p["midpoint"], p["sharpness"])
    return colors, opacities, component["scalarOpacityUnitDistance"]


def from_slicer_vp(path, _image):
    lines = open(path).read().splitlines()
    numbers = [[float(w) for w in line.split()[1:]] for line in (lines[6], lines[8])]
    colors, opacities = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for i in range(0, len(numbers[0]), 2):
        opacities.AddPoint(*numbers[0][i:i + 2])
    for i in range(0, len(numbers[1]), 4):
        colors.AddRGBPoint(*numbers[1][i:i + 4])
    return colors, opacities, 1.0


def vtk_picture(image, functions, camera):
    colors, opacities, unit = functions
    look = vtk.vtkVolumeProperty()
    look.SetInterpolationTypeToLinear()
    look.ShadeOff()
    look.SetColor(colors)
    look.SetScalarOpacity(opacities)
    look.SetScalarOpacityUnitDistance(unit)
    mapper = vtk.vtkFixedPointVolumeRayCastMapper()
    mapper.SetInputData(image)
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetInteractiveSampleDistance(min(image.GetSpacing()) / 4)
    mapper.SetSampleDistance(min(image.GetSpacing()) / 4)
    mapper.SetImageSampleDistance(1)
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.AddVolume(volume)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    eye = renderer.GetActiveCamera()
    eye.SetFocalPoint(*camera["center"])
    eye.SetPosition(*camera["eye"])
    eye.SetViewUp(*camera["up"])
    eye.ParallelProjectionOn()
    eye.SetParallelScale(camera["height"] / 2)
    renderer.ResetCameraClippingRange()
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = numpy_support.vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(SIZE, SIZE, -1)[::-1, :, :3]


def camera_for(image):
    dims, spacing = np.array(image.GetDimensions()), np.array(image.GetSpacing())
    edges = dims * spacing
    center = (dims - 1) * spacing / 2
    toward = np.array([0.5, -0.8, 0.33])
    toward /= np.linalg.norm(toward)
    radius = np.linalg.norm(edges) / 2
    return {"projection": "orthographic", "eye": list(center + 3 * radius * toward), "center": list(center),
            "up": [0, 0, 1], "height": 1.6 * radius}


def published(cli, volume, tf):
    """How visible each intensity is by the published profile, of 1 in all."""
    words = ["measure", volume, "--tf", tf, "--profile", "published", "--holder", "1", "--json"]
    return np.array(json.loads(run(cli, *words))["visibility_histogram"])


def main():
    cli, data, out = sys.argv[1:4]
    chosen = [v for v in VOLUMES if not sys.argv[4:] or os.path.basename(v[0]).split(".")[0] in sys.argv[4:]]
    missing = [v[0] for v in chosen if not os.path.exists(os.path.join(data, v[0]))]
    if missing or not os.environ.get("DISPLAY"):
        print("SKIPPED: " + (f"{data} lacks {', '.join(missing)}" if missing else "no display; run it under xvfb-run"))
        return 0
    os.makedirs(out, exist_ok=True)
    worst, most_moved = 1.0, 0.0
    for path, tf in chosen:
        name = os.path.basename(path).split(".")[0]
        at = lambda suffix: os.path.join(out, name + suffix)
        volume = at(".nrrd")
        image = cleared_copy(cli, os.path.join(data, path), volume)
        camera = camera_for(image)
        json.dump(camera, open(at(".camera.json"), "w"))
        run(cli, "convert", *tf, "--to", "pellucid", "--volume", volume, "--out", at(".tf.json"))
        def draw(tf_path, picture):
            run(cli, "render", volume, "--tf", tf_path, "--camera", at(".camera.json"), "--size", f"{SIZE}x{SIZE}",
                "--background", "0,0,0", "--quality", "high", "--holder", "1", "--out", picture)
            return imread(picture)[:, :, :3]

        ours = draw(at(".tf.json"), at(".png"))
        for kind, suffix in [("voreen", ".tfi"), ("itksnap", ".itksnap.xml"), ("imagevis3d", ".1dt")]:
            run(cli, "convert", at(".tf.json"), "--to", kind, "--volume", volume, "--out", at(suffix))
            again = draw(at(suffix), at("." + kind + ".png"))
            ssim = structural_similarity(ours, again, channel_axis=2, data_range=255)
            worst = min(worst, ssim)
            print(f"{name:10} {kind:10} SSIM {ssim:.4f}")
        moved = np.abs(published(cli, volume, at(".tf.json")) - published(cli, volume, at(".tfi"))).sum() / 2
        most_moved = max(most_moved, moved)
        print(f"{name:10} voreen     visibility at other intensities, published profile: {moved:.4f}")
        for kind, suffix, read in [("paraview", ".paraview.json", from_paraview), ("slicer", ".vp.json", from_slicer),
                                   ("slicer-vp", ".vp", from_slicer_vp)]:
            run(cli, "convert", at(".tf.json"), "--to", kind, "--volume", volume, "--out", at(suffix))
            theirs = vtk_picture(image, read(at(suffix), image), camera)
            ssim = structural_similarity(ours, theirs, channel_axis=2, data_range=255)
            worst = min(worst, ssim)
            difference = np.abs(ours.astype(int) - theirs.astype(int))
            print(f"{name:10} {kind:10} SSIM {ssim:.4f}  mean difference {difference.mean():.2f} of 255")
            writer = vtk.vtkPNGWriter()
            flat = vtk.vtkImageData()
            flat.SetDimensions(SIZE, SIZE, 1)
            flat.GetPointData().SetScalars(
                numpy_support.numpy_to_vtk(np.ascontiguousarray(theirs[::-1]).reshape(-1, 3), deep=True))
            writer.SetFileName(at("." + kind + ".png"))
            writer.SetInputData(flat)
            writer.Write()
    print(f"least similarity: {worst:.4f}; most visibility at other intensities: {most_moved:.4f}")
    return 0 if worst >= LEAST_SSIM and most_moved <= MOST_MOVED else 1


if __name__ == "__main__":
    sys.exit(main())
