// The rays of a picture and the slices across them (C++: src/render/gl/layered_view.h).
//   voxel coordinates; the box reaches from -0.5 to dims - 0.5
//   local              (right, up, away from the eye) in units of d0
//   c                  number of the slice: local z = front + c * step
layout(location = 1) uniform mat3 u_voxelFromLocal;
layout(location = 2) uniform vec3 u_origin;           // of local coordinates, in voxels
layout(location = 3) uniform float u_inverseDistance; // 1 / distance of the eye from there; 0: parallel rays
layout(location = 4) uniform vec4 u_picture;          // local (x, y) of pixel (0, 0) at local z = 0; pixels per d0
layout(location = 5) uniform vec3 u_slices;           // front, step, number of the last one
layout(location = 9) uniform float u_pieces; // samples per voxel plane across the axis that a ray runs along
const int kMostSides = 18;
layout(location = 28) uniform int u_sideCount;
layout(location = 29) uniform vec4 u_sides[kMostSides]; // dot(xyz, voxel) - w is how far a point lies beyond, in d0

struct Ray {
    vec3 at;      // at c = 0
    vec3 slope;   // change of the point per unit of c
    float length; // of that, in units of d0
    vec2 pieces;  // at c = 0, and change per unit of c
};

// pixel: centres at whole numbers
Ray rayOfPixel(vec2 pixel) {
    vec2 aside = u_picture.xy + pixel / u_picture.zw;
    vec3 at = vec3(aside * (1.0 + u_slices.x * u_inverseDistance), u_slices.x);
    vec3 slope = vec3(aside * u_inverseDistance, 1.0) * u_slices.y;
    Ray ray = Ray(u_voxelFromLocal * at + u_origin, u_voxelFromLocal * slope, length(slope), vec2(0.0));
    vec3 steps = abs(ray.slope);
    int axis = steps.x >= steps.y && steps.x >= steps.z ? 0 : (steps.y >= steps.z ? 1 : 2);
    ray.pieces = u_pieces * vec2(ray.at[axis], ray.slope[axis]);
    return ray;
}

// Samples lie on voxel planes, where trilinear interpolation has its kinks, and evenly between them.
float pieceSign(Ray ray) {
    return ray.pieces.y < 0.0 ? -1.0 : 1.0;
}
float pieceAt(Ray ray, float c) {
    return ray.pieces.x + ray.pieces.y * c;
}
float endOfPiece(Ray ray, float piece) {
    return (piece - ray.pieces.x) / ray.pieces.y;
}

vec3 pointAt(Ray ray, float c) {
    return ray.at + ray.slope * c;
}

// Length of the ray per unit of c, in units of d0.
float lengthPerC(Ray ray) {
    return ray.length;
}

// Takes of a passage what lies beyond a plane: dot(xyz, voxel) - w is how far a point does.
void cutPassage(inout Passage p, Ray ray, vec4 plane, float margin) {
    float beyond = dot(plane.xyz, ray.at) - plane.w, rate = dot(plane.xyz, ray.slope);
    // Voxels on a plane that rays run along are kept: their rays must be, too.
    if (abs(rate) < 1e-2) beyond -= kClipTie;
    if (abs(rate) < 1e-7) {
        if (beyond > margin) p.leave = -1e9;
    } else if (rate < 0.0) {
        p.enter = max(p.enter, -beyond / rate);
    } else {
        p.leave = min(p.leave, (margin - beyond) / rate);
    }
}

// How a ray passes through what is kept of the box: c where it enters, c where it leaves. The sides by which it leaves
// are moved outward by `margin` d0, so that interpolating between rays meets no jump there.
Passage passageOf(Ray ray, float margin) {
    Passage p = Passage(0.0, u_slices.z);
    for (int i = 0; i < u_sideCount; ++i) cutPassage(p, ray, u_sides[i], margin);
#ifdef FAINT
    g_clear = Passage(-1e9, 1e9);
    for (int i = 0; i < u_faintCount; ++i) cutPassage(g_clear, ray, u_faint[i], margin);
#endif
    return p;
}
