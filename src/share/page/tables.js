// The transfer function as rays read it (src/tf/transfer_function.h, shaders/include/tf_segment.glsl).

const kTableSize = 16384;
const kMostOpacity = 1 - 1e-7; // src/tf/opacity.h

const depthOfOpacity = alpha => -Math.log1p(-Math.min(alpha, kMostOpacity));
const opacityOfDepth = depth => -Math.expm1(-depth);

// points: [x, opacity, r, g, b], sorted; opacities: the peak of each feature; shown: whether each is.
// Returns (tau * rgb, tau) per entry, then its running integral, and how many entries before each are opaque.
function tablesOf(scene, opacities, shown) {
    const { points, features, only } = scene.tf;
    const values = new Float32Array(8 * kTableSize), opaqueBefore = new Int32Array(kTableSize + 1);
    const sum = [0, 0, 0, 0], before = [0, 0, 0, 0], entry = [0, 0, 0, 0];
    let p = 0;
    for (let i = 0; i < kTableSize; ++i) {
        const s = i / (kTableSize - 1);
        while (p + 1 < points.length && points[p + 1][0] <= s) ++p;
        const a = points[p], b = points[Math.min(p + 1, points.length - 1)];
        const t = b[0] > a[0] ? (s - a[0]) / (b[0] - a[0]) : 0;
        const tau = depthOfOpacity((a[1] + t * (b[1] - a[1])) * shareAt(s));
        for (let k = 0; k < 3; ++k) entry[k] = tau * (a[2 + k] + t * (b[2 + k] - a[2 + k]));
        entry[3] = tau;
        for (let k = 0; k < 4; ++k) {
            if (i > 0) sum[k] += 0.5 * (before[k] + entry[k]);
            before[k] = entry[k];
            values[4 * i + k] = entry[k];
            values[4 * (kTableSize + i) + k] = sum[k];
        }
        opaqueBefore[i + 1] = opaqueBefore[i] + (tau > 0 ? 1 : 0);
    }
    return { values, opaqueBefore };

    // What the eyes and opacities make of the transfer function's own opacity.
    function shareAt(s) {
        const f = features.findIndex(one => s >= one.range[0] && (s < one.range[1] || one.range[1] >= 1));
        if (f < 0) return only >= 0 ? 0 : 1;
        if (!shown[f]) return 0;
        return features[f].opacity > 0 ? opacities[f] / features[f].opacity : 1;
    }
}

// Opacities of equal shares at a coverage, linear in ln tau between points (src/optimize/answer/density_curve.h).
function opacitiesAt(curve, coverage) {
    const points = curve.points;
    if (coverage <= points[0].coverage) return points[0].opacity.slice();
    for (let i = 1; i < points.length; ++i) {
        const a = points[i - 1], b = points[i];
        if (coverage > b.coverage) continue;
        const t = Math.log(coverage / a.coverage) / Math.log(b.coverage / a.coverage);
        return a.opacity.map((from, f) => {
            const to = b.opacity[f];
            if (from === to || from <= 0 || to <= 0) return t < 0.5 ? from : to;
            const x = Math.log(depthOfOpacity(from)), y = Math.log(depthOfOpacity(to));
            return opacityOfDepth(Math.exp(x + t * (y - x)));
        });
    }
    return points[points.length - 1].opacity.slice();
}
