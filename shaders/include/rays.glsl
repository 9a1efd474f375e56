// The straight lines along which visibility is swept, and the space they live in.
//   q = (a, b, c)   voxel coordinates with the sweep axis last, c growing away from the eye; the box reaches from -0.5
//                   to dims - 0.5
//   ray             fixed by the point (a, b) where it meets the reference plane c = u_reference
//   CLIPPED         planes cut the volume
//   Needs passage.glsl.
layout(location = 1) uniform vec4 u_eye;        // xyz: the eye in q (perspective); w: 1 perspective, 0 orthographic
layout(location = 2) uniform vec2 u_shear;      // orthographic: change of (a, b) per unit of c
layout(location = 3) uniform float u_reference; // c of the reference plane
layout(location = 4) uniform mat3 u_worldFromQ; // of differences, in units of d0
layout(location = 5) uniform ivec3 u_dims;      // of a, b, c
layout(location = 6) uniform vec3 u_grid;       // (a, b) of ray (0, 0); rays per voxel
layout(location = 7) uniform ivec2 u_rays;      // number of rays along a, b
layout(location = 8) uniform float u_front;     // c where the box begins, or the eye's if it lies beside the box
layout(location = 9) uniform float u_pieces;    // samples per unit of c

struct Ray {
    vec2 at;    // (a, b) on the reference plane
    vec2 slope; // change of (a, b) per unit of c
};

Ray rayAt(vec2 at) {
    return Ray(at, u_eye.w > 0.5 ? (at - u_eye.xy) / (u_reference - u_eye.z) : u_shear);
}

Ray rayOfPixel(ivec2 pixel) {
    return rayAt(u_grid.xy + vec2(pixel) / u_grid.z);
}

vec3 pointAt(Ray ray, float c) {
    return vec3(ray.at + ray.slope * (c - u_reference), c);
}

// Samples lie where pieces, so many from c = 0, end.
float pieceSign(Ray ray) {
    return 1.0;
}
float pieceAt(Ray ray, float c) {
    return c * u_pieces;
}
float endOfPiece(Ray ray, float piece) {
    return piece / u_pieces;
}

// Length of the ray per unit of c, in units of d0.
float lengthPerC(Ray ray) {
    return length(u_worldFromQ * vec3(ray.slope, 1.0));
}

#ifdef CLIPPED
layout(location = 28) uniform int u_planeCount;
layout(location = 29) uniform vec4 u_clip[kMostPlanes]; // dot(xyz, q) - w is how far q lies beyond, in d0
#endif

// Whether the centre of a voxel is kept, and not faint.
bool isKept(ivec3 q) {
#ifdef CLIPPED
    for (int i = 0; i < u_planeCount; ++i)
        if (dot(u_clip[i].xyz, vec3(q)) - u_clip[i].w > kClipTie) return false;
#endif
    return !isFaint(vec3(q));
}

// Takes of a passage what lies beyond a plane: dot(xyz, q) - w is how far q does.
void cutPassage(inout Passage p, Ray ray, vec4 plane, float margin) {
    float beyond = dot(plane.xyz, vec3(ray.at, u_reference)) - plane.w, rate = dot(plane.xyz, vec3(ray.slope, 1.0));
    // Voxels on a plane that rays run along are kept: their rays must be, too.
    if (abs(rate) < 1e-2) beyond -= kClipTie;
    float outward = margin * (abs(plane.x) + abs(plane.y));
    if (abs(rate) < 1e-7) {
        if (beyond > outward) p.leave = -1e9;
    } else if (rate < 0.0) {
        p.enter = max(p.enter, u_reference - beyond / rate);
    } else {
        p.leave = min(p.leave, u_reference - (beyond - outward) / rate);
    }
}

// How a ray passes through the box, and through what clipping leaves of it: c where it enters, c where it leaves. The
// sides by which it leaves are moved outward by `margin` voxels: just outside the box a ray goes on as the volume's
// edge, and behind a clip plane through what is clipped, so that interpolating between rays meets no jump there.
Passage passageOf(Ray ray, float margin) {
    Passage p = Passage(u_front, float(u_dims.z) - 0.5);
    for (int axis = 0; axis < 2; ++axis) {
        float lo = -0.5, hi = float(u_dims[axis]) - 0.5;
        float slope = ray.slope[axis], at = ray.at[axis];
        if (abs(slope) < 1e-9) {
            if (at < lo - margin || at > hi + margin) p.leave = -1e9;
            continue;
        }
        float enter = ((slope > 0.0 ? lo : hi) - at) / slope + u_reference;
        float leave = ((slope > 0.0 ? hi + margin : lo - margin) - at) / slope + u_reference;
        p.enter = max(p.enter, enter);
        p.leave = min(p.leave, leave);
    }
#ifdef CLIPPED
    for (int i = 0; i < u_planeCount; ++i) cutPassage(p, ray, u_clip[i], margin);
#endif
#ifdef FAINT
    g_clear = Passage(-1e9, 1e9);
    for (int i = 0; i < u_faintCount; ++i) cutPassage(g_clear, ray, u_faint[i], margin);
#endif
    return p;
}
