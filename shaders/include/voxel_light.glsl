// The light that comes to a voxel: the last of it along the voxel's own line, the rest as rays bring it.
// Needs candidates.glsl, rays.glsl or view_rays.glsl, resident.glsl, ray_depth.glsl.
layout(location = 23) uniform ivec2 u_own;       // planes that are followed along the voxel's own line: least, most
layout(location = 24) uniform float u_tolerance; // of T, between neighbouring rays

// The shader's own: what arrives along `ray` at c, dimmed by `near` on its way on; returns how far the rays around
// disagree about it.
float interpolateLight(Ray ray, int c, LANE near[PACKS], out LANE light[PACKS]);

// The light that comes through to c on a ray; rays bring it to whole numbers, `next` the first of them not before c.
// Where those around disagree (edges of what is opaque) the line is followed further, twice as far each time.
void lightAt(Ray ray, float c, int next, out LANE light[PACKS]) {
    float enter = passageOf(ray, 2.0).enter;
    LANE depth[PACKS], near[PACKS], interpolated[PACKS];
    for (int p = 0; p < PACKS; ++p) {
        depth[p] = LANE(0.0);
        light[p] = LANE(c > enter ? 0.0 : 1.0);
    }
    if (c <= enter) return;
    Sample last = sampleAt(ray, c);
    // Share of the answer that is left to what lies further on: it falls steadily with the disagreement, so that results
    // do not hang on the last bits.
    float left = 1.0;
    for (int planes = u_own.x; left > 0.0; planes = min(2 * planes, u_own.y)) {
        int plane = next - planes;
        float to = max(enter, float(plane));
        follow(ray, c, to, last, depth);
        c = to;
        for (int p = 0; p < PACKS; ++p) interpolated[p] = near[p] = exp(-depth[p]);
        float share = left;
        left = 0.0;
        if (enter < float(plane) && !isDark(depth)) {
            float disagreement = interpolateLight(ray, plane, near, interpolated);
            if (planes < u_own.y) left = share * smoothstep(0.5 * u_tolerance, u_tolerance, disagreement);
        }
        for (int p = 0; p < PACKS; ++p) light[p] += (share - left) * interpolated[p];
    }
}

// Intensity code and optical depth of a voxel of the resident box; false where it is invalid or transparent.
bool contentOf(ivec3 voxel, out ivec3 texel, out int code, out LANE tau[PACKS]) {
    texel = voxel + texelShift(voxel);
    vec2 content = texelFetch(u_volume, texel, 0).rg;
#ifdef HAS_INVALID
    if (content.g < 0.5) return false;
#endif
    code = int(content.r * 65535.0 + 0.5);
    float entry = content.r * u_entriesPerCode;
    if (i_opaqueBefore[cellOf(entry)] == i_opaqueBefore[cellOf(entry) + 1]) return false;
    float most = 0.0;
    for (int p = 0; p < PACKS; ++p) {
        tau[p] = tauAt(entry, p);
        most = max(most, largest(tau[p]));
    }
    return most > 0.0;
}
