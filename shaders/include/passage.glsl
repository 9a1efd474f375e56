// How a ray passes through something convex, and what is faint on its way (docs/method.md, "Clipping").
//   FAINT   what lies beyond some planes is thinned
struct Passage {
    float enter, leave; // c
};

const int kMostPlanes = 12;
const float kClipTie = 1e-3; // C++: src/render/clipping.h

#ifdef FAINT
layout(location = 47) uniform float u_faintDensity; // what lies beyond the planes keeps of its optical depth
layout(location = 48) uniform int u_faintCount;
layout(location = 49) uniform vec4 u_faint[kMostPlanes]; // dot(xyz, voxel) - w is how far a point lies beyond, in d0
Passage g_clear; // of the ray that passageOf() was asked about last: where nothing is faint

// What of its own the part of that ray between two c, either way round, keeps.
float thinned(float from, float to) {
    float within = min(max(from, to), g_clear.leave) - max(min(from, to), g_clear.enter);
    return mix(u_faintDensity, 1.0, clamp(within / max(abs(to - from), 1e-9), 0.0, 1.0));
}
#endif

// Whether the centre of a voxel is faint.
bool isFaint(vec3 voxel) {
#ifdef FAINT
    for (int i = 0; i < u_faintCount; ++i)
        if (dot(u_faint[i].xyz, voxel) - u_faint[i].w > kClipTie) return true;
#endif
    return false;
}
