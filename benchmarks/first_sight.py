#!/usr/bin/python3
"""The automatic start against `tents:3`: what a volume shows when it is opened.

    /usr/bin/python3 benchmarks/first_sight.py --cli build/release/bin/pellucid-cli --data ../shared/data/real \\
        --sheet docs/images/first_sight.png

Opens the built-in samples, volumes that are made up here (an outlier of 1e6, NaN, labels, ...) and the files under
--data, from the view that each opens on, and prints of each:

    translucent   part of the pixels inside the projected object whose alpha lies in (0.05, 0.95); wanted 2 to 98 %.
                  The object: pixels whose alpha exceeds one half where every feature is solid.
    entropy       Shannon entropy in bits of the grey values (8 bits, Rec. 709), and its ratio to that of tents:3, of the
                  unlit picture over black, 256 by 256 pixels, inside the projected object; wanted 1.3. Unlit, since light
                  puts the same greys on whatever it falls on; inside, since of a picture that is 85 % black no
                  object's entropy shows. Next to it the ratio for the lit picture inside the object ("lit"), and for
                  the whole picture, unlit ("whole").
    fill          the longer side of what is drawn (alpha above 0.02), as part of the picture; wanted 80 to 95 %.
    visibility    of the two features that show most, as `measure` has it; wanted 10 % each where there are two.

Ends with status 1 where something is not as wanted, unless --report is given.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    from PIL import Image, ImageDraw
except ImportError as missing:
    sys.exit(f"{missing}; install python3-numpy and python3-pil and run this with the system's Python")

PIXELS = 256
LEAST, MOST, RATIO, VISIBLE = 0.02, 0.98, 1.3, 0.10
FILL = 0.8, 0.95


def write_nrrd(path, values):
    """values[z, y, x]"""
    kinds = {"uint8": "uint8", "int16": "int16", "uint16": "uint16", "float32": "float", "float64": "double"}
    header = (f"NRRD0004\ntype: {kinds[values.dtype.name]}\ndimension: 3\n"
              f"sizes: {values.shape[2]} {values.shape[1]} {values.shape[0]}\nencoding: raw\nendian: little\n\n")
    path.write_bytes(header.encode() + values.astype(values.dtype.newbyteorder("<")).tobytes())


def made_up(folder):
    """Volumes that starts go wrong on: name, path."""
    random = np.random.default_rng(1)
    n = 64
    z, y, x = (np.mgrid[0:n, 0:n, 0:n] + 0.5) / n * 2 - 1
    r = np.sqrt(x * x + y * y + z * z)
    ball = np.clip(1.1 - r, 0, 1)
    nested = np.select([r < 0.35, r < 0.6, r < 0.85], [200.0, 120.0, 60.0], 5.0) + random.normal(0, 3, r.shape)
    outlier = nested.astype("float32")
    outlier[3, 4, 5] = 1e6
    holes = nested.astype("float32")
    holes[(x > 0) & (y < 0) & (z > 0)] = np.nan
    blobs = np.zeros(r.shape, "uint8")
    for label in range(1, 7):
        c = 0.5 * np.array([math.cos(label), math.sin(label), math.cos(2.3 * label)])
        blobs[(x - c[0]) ** 2 + (y - c[1]) ** 2 + (z - c[2]) ** 2 < 0.09] = label
    ct = np.select([r < 0.25, r < 0.45, r < 0.8], [900.0, 400.0, 40.0], -1024.0) + random.normal(0, 12, r.shape)
    ct[(r >= 0.74) & (r < 0.8)] -= 130
    ct[(np.abs(x + 0.1) < 0.05) & (np.abs(y) < 0.05) & (np.abs(z) < 0.1)] = 3071
    ct = np.clip(ct, -1024, 3071).astype("int16")
    signed = (6 * np.exp(-((x - 0.3) ** 2 + y * y + z * z) * 12) - 5 * np.exp(-((x + 0.4) ** 2 + y * y + z * z) * 14) +
              random.normal(0, 0.4, r.shape)).astype("float32")
    # A wave that runs out from the middle, as of merging stars; directions of fibres in a head; t-values of a few spots.
    wave = (np.sin(22 * r - 2 * np.arctan2(y, x)) * (1 - z * z) / (0.3 + r)).astype("float32")
    head = (x / 0.7) ** 2 + (y / 0.85) ** 2 + (z / 0.75) ** 2 < 1
    directions = np.where(head, np.sin(9 * x + 2 * y) * np.cos(7 * y * z) + random.normal(0, 0.3, r.shape), 0)
    spots = sum(t * np.exp(-((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) * 90)
                for t, a, b, c in ((7, 0.3, 0.2, 0.1), (6, -0.3, 0.25, 0.1), (-5, 0, -0.4, 0.3)))
    spots = np.where(head, spots + random.normal(0, 0.8, r.shape), 0)
    # A knee of magnetic resonance: marrow and fat are bright, compact bone and air dark, and the coil is near the skin.
    tube = np.sqrt(x * x + y * y)
    knee = np.select([tube > 0.8, tube > 0.7, (tube < 0.3) & (np.abs(z) > 0.04), tube < 0.36], [3, 900, 700, 40], 260)
    knee = np.clip(knee * (0.6 + 0.6 * tube) + random.normal(0, 15, r.shape), 0, None)
    waves = (np.sin(5 * x) * np.cos(4 * y) * np.sin(6 * z + 1) + r).astype("float32")
    all_of_them = {"outlier of 1e6": outlier, "NaN in an octant": holes, "binary ball": (r < 0.7).astype("uint8"),
                   "six labels": blobs, "range of 1e-9": (1e-9 * ball + 5e-9).astype("float64"),
                   "CT with metal": ct, "two nested balls": np.select([r < 0.4, r < 0.8], [200, 90], 0).astype("uint8"),
                   "signed map": signed, "waves": waves, "running wave": wave, "directions": directions.astype("float32"),
                   "spots of t": spots.astype("float32"), "MR knee": knee.astype("int16"), "constant": np.full((32, 32, 32), 7, "uint8"),
                   "all NaN": np.full((16, 16, 16), np.nan, "float32")}
    result = []
    for name, values in all_of_them.items():
        path = folder / (name.replace(" ", "_") + ".nrrd")
        write_nrrd(path, values)
        result.append((name, [str(path)]))
    return result


def real(folder, scratch):
    if not folder.is_dir():
        return []
    found = []
    for name, path in (("nucleon", "nucleon/nucleon.mhd"), ("tooth", "tooth/tooth.mhd"), ("vortex", "vortex/vorts1.mhd"),
                       ("walnut", "walnut/walnut.mhd"), ("viscous fingers", "viscous_fingers/density_045.mhd"),
                       ("cranium CT", "cranium_ct/cranium_ct.nrrd"), ("MR head, ch2", "nifti/ch2.nii.gz"),
                       ("MR perfusion", "nifti/mpld_asl_4d.nii.gz"), ("MR FLAIR", "nrrd/FLAIR.nrrd"),
                       ("MR EPI", "mha/epi_short.mha")):
        if (folder / path).exists():
            found.append((name, [str(folder / path)]))
    if (folder / "hydrogenatom/hydrogenatom.raw").exists():
        found.append(("hydrogen atom", [str(folder / "hydrogenatom/hydrogenatom.raw"), "--raw", "128,128,128,u8"]))
    slices = sorted((folder / "dicom_mr_head").glob("*.dcm"))
    if slices:  # uncompressed, the samples last
        path = scratch / "dicom_mr_head.raw"
        path.write_bytes(b"".join(p.read_bytes()[-2 * 512 * 512:] for p in slices))
        found.append(("MR head, DICOM", [str(path), "--raw", f"512,512,{len(slices)},u16",
                                         "--spacing", "0.41015625,0.41015625,1.5"]))
    stack = folder / "tiff/mini-t1-head.tif"
    if stack.exists():
        pages = Image.open(stack)
        voxels = []
        for page in range(pages.n_frames):
            pages.seek(page)
            voxels.append(np.array(pages, dtype="uint16"))
        path = scratch / "mini_t1_head.nrrd"
        write_nrrd(path, np.stack(voxels))
        found.append(("MR head, ImageJ", [str(path)]))
    return found


def run(cli, *words):
    done = subprocess.run([cli, *words], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(words)}: {done.stderr}")
    return json.loads(done.stdout)


def picture(cli, volume, scratch, *words):
    path = scratch / "picture.png"
    run(cli, "render", *volume, "--engine", "cpu", "--size", f"{PIXELS}x{PIXELS}", "--out", str(path), "--json", *words)
    return np.asarray(Image.open(path).convert("RGBA"))


def entropy(values):
    if values.size == 0:
        return 0.0
    counts = np.unique(values, return_counts=True)[1]
    p = counts / counts.sum()
    return float(-(p * np.log2(p)).sum())


def grey_entropy(rgba):
    return entropy(np.rint(rgba[..., :3] @ [0.2126, 0.7152, 0.0722]).astype(int))


def look(cli, name, volume, scratch):
    tf = scratch / "auto.tf.json"
    kind = run(cli, "propose", *volume, "--out-tf", str(tf), "--json")
    camera = scratch / "opening.camera.json"
    camera.write_text(json.dumps(kind["camera"]))
    volume = [*volume, "--camera", str(camera)]  # tents:3, too: its own view would be that of the box
    # What the object lies on is drawn faintly, and is no part of the object.
    bare = [word for clip in kind.get("holder", {}).get("clip", []) for word in ("--clip", clip)]
    auto = ("--tf", str(tf), *bare)
    lit = picture(cli, volume, scratch, "--shading")
    alpha = picture(cli, volume, scratch, "--background", "transparent", *auto)[..., 3] / 255
    solid = json.loads(tf.read_text())
    for point in solid["points"]:
        point["opacity"] = 1.0 if point["opacity"] > 0 else 0.0
    (scratch / "solid.tf.json").write_text(json.dumps(solid))
    inside = picture(cli, volume, scratch, "--background", "transparent", "--tf", str(scratch / "solid.tf.json"), *bare)[..., 3] > 127
    unlit = picture(cli, volume, scratch, *auto)
    tents = picture(cli, volume, scratch, "--tf", "tents:3", *bare)
    lit_tents = picture(cli, volume, scratch, "--shading", "--tf", "tents:3", *bare)
    seen = run(cli, "measure", *volume, "--engine", "cpu", "--json")["features"]
    visible = sorted((f["visibility"] for f in seen), reverse=True)
    result = {"name": name, "kind": kind["kind"], "features": len(seen), "picture": lit, "visibility": visible[:2],
              "entropy": grey_entropy(unlit[inside]), "entropy of tents": grey_entropy(tents[inside]),
              "lit": grey_entropy(picture(cli, volume, scratch, "--shading", *auto)[inside]), "lit of tents": grey_entropy(lit_tents[inside]),
              "whole": grey_entropy(unlit), "whole of tents": grey_entropy(tents), "fails": []}
    rows, columns = np.nonzero(alpha > 0.02)
    result["fill"] = (max(np.ptp(rows), np.ptp(columns)) + 1) / PIXELS if rows.size else None
    within = alpha[inside]
    result["translucent"] = float(((within > 0.05) & (within < 0.95)).mean()) if within.size else None
    if within.size:
        if not LEAST <= result["translucent"] <= MOST:
            result["fails"].append("translucent")
        if not FILL[0] <= result["fill"] <= FILL[1]:
            result["fails"].append("fill")
        if result["entropy"] < RATIO * result["entropy of tents"]:
            result["fails"].append("entropy")
        if len(visible) > 1 and visible[1] < VISIBLE:
            result["fails"].append("visibility")
    return result


def sheet(results, path):
    width, label, columns = 192, 18, 7
    rows = -(-len(results) // columns)
    image = Image.new("RGB", (columns * width, rows * (width + label)), (24, 24, 24))
    draw = ImageDraw.Draw(image)
    for i, result in enumerate(results):
        x, y = i % columns * width, i // columns * (width + label)
        image.paste(Image.fromarray(result["picture"][..., :3]).resize((width - 4, width - 4), Image.LANCZOS), (x + 2, y + 2))
        draw.text((x + 6, y + width), result["name"], fill=(230, 230, 230))
    image.quantize(255, method=Image.Quantize.MEDIANCUT).save(path, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cli", default="build/release/bin/pellucid-cli", help="the program to measure")
    parser.add_argument("--data", type=Path, default=Path("../shared/data/real"), help="where real volumes lie")
    parser.add_argument("--sheet", type=Path, help="where to write all pictures in one, PNG")
    parser.add_argument("--only", help="those whose name contains this")
    parser.add_argument("--report", action="store_true", help="print, and judge nothing")
    options = parser.parse_args()
    results = []
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        volumes = real(options.data, scratch) + [(f"sample {n}", [f"sample:{n}"]) for n in ("disks", "shells", "knee", "vortex", "smoke", "hurricane")]
        volumes += made_up(scratch)
        print(f"{'volume':18}{'kind':12}{'fill':>6}{'translucent':>12}{'entropy':>9}{'tents:3':>9}{'ratio':>7}{'lit':>7}{'whole':>7}"
              f"{'visible':>14}  not as wanted")
        for name, volume in volumes:
            if options.only and options.only not in name:
                continue
            r = look(options.cli, name, volume, scratch)
            results.append(r)

            def ratio(of):
                return f"{r[of] / r[of + ' of tents']:7.2f}" if r[of + " of tents"] > 0 else "      –"

            fill = "–" if r["fill"] is None else f"{100 * r['fill']:.0f} %"
            translucent = "–" if r["translucent"] is None else f"{100 * r['translucent']:.1f} %"
            visible = " ".join(f"{100 * v:.0f} %" for v in r["visibility"])
            print(f"{name:18}{r['kind']:12}{fill:>6}{translucent:>12}{r['entropy']:9.2f}{r['entropy of tents']:9.2f}"
                  f"{ratio('entropy')}{ratio('lit')}{ratio('whole')}{visible:>14}  {', '.join(r['fails'])}", flush=True)
    if options.sheet:
        sheet(results, options.sheet)
    if not options.report and any(r["fails"] for r in results):
        sys.exit(1)


if __name__ == "__main__":
    main()
