// The optical depth of a part of a ray, per candidate. Between two samples the intensity is linear, so that the integral
// of tau over the path is that over intensities, read from a table of running integrals: exact for any transfer function.
// Needs candidates.glsl, rays.glsl or view_rays.glsl, resident.glsl.
layout(binding = 1, std430) readonly buffer Integral { UINT_LANE i_integral[]; }; // up to an entry; unit u_integralUnit
layout(binding = 2, std430) readonly buffer Tau { LANE i_tau[]; };                // optical depth of d0 at an entry
layout(binding = 3, std430) readonly buffer Opaque { uint i_opaqueBefore[]; };    // number of cells with any tau
layout(location = 0) uniform float u_entriesPerCode;  // table index of code/65535 = 1
layout(location = 12) uniform float u_integralUnit;   // optical depths times entries
layout(location = 13) uniform int u_lastCell;         // cell i lies between entries i and i + 1

// The volume at some point: table index, and share of the valid corners.
struct Sample {
    float entry;
    float share;
};

Sample sampleAt(Ray ray, float c) {
    vec2 sampled = codeAndWeightAt(pointAt(ray, c));
    return Sample(sampled.x * u_entriesPerCode, sampled.y);
}

int cellOf(float entry) {
    return min(int(entry), u_lastCell);
}

LANE tauAt(float entry, int pack) {
    int cell = cellOf(entry);
    return mix(i_tau[cell * PACKS + pack], i_tau[(cell + 1) * PACKS + pack], entry - float(cell));
}

// Integers, since floats would lose the digits of differences.
UINT_LANE integralTo(float entry, int pack) {
    int cell = cellOf(entry);
    UINT_LANE low = i_integral[cell * PACKS + pack], high = i_integral[(cell + 1) * PACKS + pack];
    return low + UINT_LANE(LANE(high - low) * (entry - float(cell)));
}

// Adds a piece of `path` reference lengths from a to b.
void addPiece(inout LANE depth[PACKS], Sample a, Sample b, float path) {
#ifdef HAS_INVALID
    path *= 0.5 * (a.share + b.share);
    const float kNoShare = 1e-3; // rounding on a lattice point must not let in a neighbour's intensity
    if (a.share < kNoShare) a.entry = b.entry;
    if (b.share < kNoShare) b.entry = a.entry;
#endif
    float low = min(a.entry, b.entry), high = max(a.entry, b.entry);
    if (i_opaqueBefore[cellOf(low)] == i_opaqueBefore[cellOf(high) + 1]) return;
    if (high - low < 1.0) {
        for (int p = 0; p < PACKS; ++p) depth[p] += path * tauAt(0.5 * (low + high), p);
    } else {
        path *= u_integralUnit / (high - low);
        for (int p = 0; p < PACKS; ++p) depth[p] += path * LANE(integralTo(high, p) - integralTo(low, p));
    }
}

// A fraction of 6e-6 of the light is left: nothing is seen any more.
bool isDark(LANE depth[PACKS]) {
    const float kDark = 12.0;
    float least = smallest(depth[0]);
    for (int p = 1; p < PACKS; ++p) least = min(least, smallest(depth[p]));
    return least > kDark;
}

// Adds the depth of the ray between c = from and c = to, either way round, until it is dark. Samples lie on the voxel
// planes, where trilinear interpolation has its kinks, and evenly between them. `last` is the sample at `from`,
// afterwards the one at `to`.
void follow(Ray ray, float from, float to, inout Sample last, inout LANE depth[PACKS]) {
    float perC = lengthPerC(ray), away = sign(to - from);
    float onward = away * pieceSign(ray); // pieces may be counted against c
    float next = onward * floor(onward * pieceAt(ray, from) + 1e-3);
    while ((to - from) * away > 1e-5 && !isDark(depth)) {
        next += onward;
        float end = away > 0.0 ? min(endOfPiece(ray, next), to) : max(endOfPiece(ray, next), to);
        Sample now = sampleAt(ray, end);
        float path = abs(end - from) * perC;
#ifdef FAINT
        path *= thinned(from, end);
#endif
        addPiece(depth, last, now, path);
        last = now;
        from = end;
    }
}
