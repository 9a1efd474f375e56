#!/usr/bin/env python3
"""Evaluates 2D feature saliency anew, with numpy and from docs/method.md alone, and compares.

    image_saliency.py SALIENCY_PICTURES [--keep DIR]

runs the program of that name, which writes pictures and what Pellucid makes of them. Prints the largest deviations
of S and FS; exit status 1 where one is above 0.005 or 0.01. Nothing here is shared with the program.
"""
import argparse
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("SKIPPED: numpy is missing (Debian: python3-numpy)")
    sys.exit(0)

S_BOUND, FS_BOUND = 0.005, 0.01


def mirror(indices, n):
    """Indices beyond the ends come back, the ends themselves once."""
    if n == 1:
        return np.zeros_like(indices)
    return (n - 1) - np.abs(np.mod(indices, 2 * (n - 1)) - (n - 1))


def filtered(plane, kernel):
    """Correlation with a kernel of odd size; mirrored outside."""
    ky, kx = kernel.shape
    rows, columns = np.arange(plane.shape[0]), np.arange(plane.shape[1])
    total = np.zeros(plane.shape)
    for j in range(ky):
        lines = plane[mirror(rows + j - ky // 2, plane.shape[0])]
        for i in range(kx):
            total += kernel[j, i] * lines[:, mirror(columns + i - kx // 2, plane.shape[1])]
    return total


BINOMIAL = np.array([1.0, 4, 6, 4, 1]) / 16


def half(plane):
    smooth = filtered(filtered(plane, BINOMIAL[None, :]), BINOMIAL[:, None])
    return smooth[::2, ::2]


def pyramid(plane):
    levels = [plane]
    for _ in range(8):
        levels.append(half(levels[-1]))
    return levels


def resized(plane, shape):
    """Bilinear, centres of pixels aligned."""
    for axis, n in enumerate(shape):
        m = plane.shape[axis]
        at = np.clip((np.arange(n) + 0.5) * (m / n) - 0.5, 0, m - 1)
        low = np.floor(at).astype(int)
        part = (at - low).reshape((-1, 1) if axis == 0 else (1, -1))
        high = np.minimum(low + 1, m - 1)
        plane = np.take(plane, low, axis) * (1 - part) + np.take(plane, high, axis) * part
    return plane


def promoted(plane):
    """N: a map of one peak stays, one of many equal peaks goes."""
    largest = plane.max()
    if largest <= 1e-9:
        return np.zeros(plane.shape)
    plane = plane / largest
    around = np.pad(plane, 1, constant_values=np.nan)
    h, w = plane.shape
    shifts = [around[1 + dy:1 + dy + h, 1 + dx:1 + dx + w]
              for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dy, dx) != (0, 0)]
    beaten = np.any([s > plane for s in shifts], axis=0)
    beats = np.any([s < plane for s in shifts], axis=0)
    peaks = np.sort(plane[(plane >= 0.1) & ~beaten & beats])
    mean = peaks[:-1].mean() if len(peaks) > 1 else 0.0
    return plane * (1 - mean) ** 2


def across_scales(levels):
    total = 0
    for c in (2, 3, 4):
        for step in (3, 4):
            contrast = promoted(np.abs(levels[c] - resized(levels[c + step], levels[c].shape)))
            for _ in range(4 - c):
                contrast = half(contrast)
            total = total + contrast
    return total


def gabor(theta, wave):
    y, x = np.mgrid[-4:5, -4:5]
    u = x * np.cos(theta) + y * np.sin(theta)
    kernel = np.exp(-(x ** 2 + y ** 2) / (2 * (7 / 3) ** 2)) * wave(2 * np.pi * u / 7)
    kernel = kernel - kernel.mean()
    return kernel / np.abs(kernel).sum()


def saliency_map(rgb):
    intensity = rgb.mean(axis=2)
    bright = intensity > intensity.max() / 10
    hue = np.where(bright[:, :, None], rgb / np.where(bright, intensity, 1)[:, :, None], 0)
    r, g, b = hue[:, :, 0], hue[:, :, 1], hue[:, :, 2]
    red = np.maximum(r - (g + b) / 2, 0)
    green = np.maximum(g - (r + b) / 2, 0)
    blue = np.maximum(b - (r + g) / 2, 0)
    yellow = np.maximum((r + g) / 2 - np.abs(r - g) / 2 - b, 0)
    levels = pyramid(intensity)
    colour = across_scales(pyramid(red - green)) + across_scales(pyramid(blue - yellow))
    turned = 0
    for theta in np.deg2rad([0, 45, 90, 135]):
        even, odd = gabor(theta, np.cos), gabor(theta, np.sin)
        turned = turned + promoted(across_scales([np.hypot(filtered(l, even), filtered(l, odd)) for l in levels]))
    total = promoted(across_scales(levels)) + promoted(colour) + promoted(turned)
    return resized(total / 3, intensity.shape)


def lab(rgb):
    """CIELAB of sRGB, white point D65."""
    light = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array([[0.4124564, 0.3575761, 0.1804375],
                       [0.2126729, 0.7151522, 0.0721750],
                       [0.0193339, 0.1191920, 0.9503041]])
    t = light @ (to_xyz / to_xyz.sum(axis=1, keepdims=True)).T
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def gaussian(plane, sigma):
    """Without what lies beyond the picture; not normalised."""
    reach = int(4 * sigma)
    weights = np.exp(-np.arange(-reach, reach + 1) ** 2 / (2 * sigma ** 2))
    for axis in (0, 1):
        n = plane.shape[axis]
        matrix = np.zeros((n, n))
        for d, w in zip(range(-reach, reach + 1), weights):
            matrix += w * np.eye(n, k=d)
        plane = matrix @ plane if axis == 0 else plane @ matrix.T
    return plane


def feature_saliency(rgb, alone, s):
    whole = lab(rgb)
    drawn = np.array([a[:, :, 3] > 0 for a in alone])
    distance = np.array([np.sqrt(((whole - lab(a[:, :, :3])) ** 2).sum(axis=2)) for a in alone])
    equal = drawn & (distance == 0)
    weight = np.where(drawn, 1 / np.where(distance == 0, 1, distance), 0)
    weight = np.where(equal.any(axis=0), equal.astype(float), weight)
    total = weight.sum(axis=0)
    shared = weight / np.where(total > 0, total, 1) * s
    rest = s - shared.sum(axis=0)
    near = np.array([gaussian(plane, rgb.shape[1] / 16) for plane in shared])
    total = near.sum(axis=0)
    all_of = shared + near / np.where(total > 0, total, 1) * rest
    sums = all_of.sum(axis=(1, 2))
    return sums / sums.sum() if sums.sum() > 0 else np.zeros(len(alone))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--keep", metavar="DIR", help="write the pictures there, and leave them")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or scratch
        subprocess.run([options.program, folder], check=True)
        worst_s = worst_fs = 0.0
        with open(os.path.join(folder, "cases.txt")) as listing:
            cases = [line.split() for line in listing]
        for name, *numbers in cases:
            width, height, features = map(int, numbers[:3])
            shares = np.array([float(n) for n in numbers[3:]])
            data = np.fromfile(os.path.join(folder, name + ".f32"), dtype="<f4").astype(float)
            pixels = width * height
            rgb, alone, theirs = np.split(data, [3 * pixels, (3 + 4 * features) * pixels])
            rgb = rgb.reshape(height, width, 3)
            s = saliency_map(rgb)
            fs = feature_saliency(rgb, alone.reshape(features, height, width, 4), s)
            of_s = np.abs(s - theirs.reshape(height, width)).max()
            of_fs = np.abs(fs - shares).max()
            print(f"{name}: {width} x {height}, {features} features, S {of_s:.2e}, FS {of_fs:.2e}")
            worst_s, worst_fs = max(worst_s, of_s), max(worst_fs, of_fs)
        print(f"{len(cases)} pictures, largest deviation of S {worst_s:.2e} (bound {S_BOUND}), "
              f"of FS {worst_fs:.2e} (bound {FS_BOUND})")
        return 0 if cases and worst_s < S_BOUND and worst_fs < FS_BOUND else 1


if __name__ == "__main__":
    sys.exit(main())
