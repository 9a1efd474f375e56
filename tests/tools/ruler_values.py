#!/usr/bin/env python3
"""Measures spheres and boxes anew, with numpy and from docs/method.md alone, and compares with `pellucid-cli rulers`.

    ruler_values.py PELLUCID_CLI

writes volumes of random values in turned, sheared and mirrored grids, some with NaN and a missing value. Prints the
largest relative deviation of mean and sigma; exit status 1 where a count differs, or one deviates by more than 1e-9.
Nothing here is shared with the program.
"""
import json
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("SKIPPED: numpy is missing (Debian: python3-numpy)")
    sys.exit(0)

BOUND = 1e-9
MISSING = -32768.0


def write_nrrd(path, values, matrix, origin, dtype):
    """`values` has the shape (nz, ny, nx); the columns of `matrix` are the steps along i, j, k."""
    def vector(v):
        return "(" + ",".join(repr(float(x)) for x in v) + ")"
    head = ["NRRD0004", "type: " + dtype, "dimension: 3", "space: left-posterior-superior",
            "sizes: " + " ".join(str(n) for n in reversed(values.shape)),
            "space directions: " + " ".join(vector(matrix[:, a]) for a in range(3)),
            "space origin: " + vector(origin), "endian: little", "encoding: raw", "", ""]
    with open(path, "wb") as out:
        out.write("\n".join(head).encode())
        out.write(values.tobytes())


def expected(values, inside):
    """Of the voxels that are marked: valid ones, invalid ones, mean, sigma of the population, range."""
    chosen = values[inside].astype(np.float64)
    valid = np.isfinite(chosen) & (chosen != MISSING)
    kept = chosen[valid]
    if kept.size == 0:
        return 0, int((~valid).sum()), None
    return int(kept.size), int((~valid).sum()), (kept.mean(), kept.std(), kept.min(), kept.max())


def main():
    program = sys.argv[1]
    random = np.random.default_rng(20)
    worst, checked = 0.0, 0
    with tempfile.TemporaryDirectory() as folder:
        for case in range(6):
            shape = tuple(random.integers(5, 24, 3))
            if case % 2:
                values, dtype = random.integers(-1000, 3000, shape).astype("<i2"), "int16"
            else:
                values, dtype = (1e4 * random.standard_normal(shape)).astype("<f4"), "float"
                values[random.random(shape) < 0.1] = np.nan
            values[random.random(shape) < 0.1] = MISSING
            q, _ = np.linalg.qr(random.standard_normal((3, 3)))
            matrix = q * random.uniform(0.4, 2.5, 3) + 0.05 * random.standard_normal((3, 3))
            origin = 300 * random.standard_normal(3)
            path = os.path.join(folder, f"case{case}.nrrd")
            write_nrrd(path, values, matrix, origin, dtype)
            k, j, i = np.meshgrid(*(np.arange(n) for n in shape), indexing="ij")
            world = np.stack([i, j, k], -1) @ matrix.T + origin
            middle, reach = world.reshape(-1, 3).mean(0), 0.5 * np.ptp(world.reshape(-1, 3), axis=0)
            options, answers = [], []
            for _ in range(5):
                center, radius = middle + reach * random.uniform(-1, 1, 3), random.uniform(0.5, 8)
                options += ["--sphere", ",".join(repr(float(x)) for x in (*center, radius))]
                answers.append(expected(values, ((world - center) ** 2).sum(-1) <= radius ** 2))
            for _ in range(5):
                corners = middle + reach * random.uniform(-1.2, 1.2, (2, 3))
                options += ["--box", ":".join(",".join(repr(float(x)) for x in c) for c in corners)]
                lo, hi = corners.min(0), corners.max(0)
                answers.append(expected(values, ((world >= lo) & (world <= hi)).all(-1)))
            out = subprocess.run([program, "rulers", path, "--missing", repr(MISSING), "--json", *options],
                                 check=True, capture_output=True, text=True).stdout
            rulers = json.loads(out)["rulers"]
            if len(rulers) != len(answers):
                print(f"case {case}: {len(rulers)} measures of {len(answers)}")
                return 1
            for told, (count, invalid, figures) in zip(rulers, answers):
                if (told["voxels"], told["invalid"]) != (count, invalid):
                    print(f"case {case}, {told['name']}: {told['voxels']} voxels and {told['invalid']} invalid ones, "
                          f"by numpy {count} and {invalid}")
                    return 1
                checked += 1
                if figures is None:
                    continue
                scale = max(1.0, float(np.nanmax(np.abs(values))))
                for a, b in zip((told["mean"], told["sigma"], *told["range"]), figures):
                    worst = max(worst, abs(a - b) / scale)
    print(f"{checked} spheres and boxes, largest deviation {worst:.1e} of the largest value")
    return 0 if worst <= BOUND else 1


if __name__ == "__main__":
    sys.exit(main())
