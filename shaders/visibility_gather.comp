// visibility_gather.comp: v = T * alpha of every voxel of some planes (docs/method.md, "Visibility"), or its sums per
//   feature
//   in   light per ray and plane, as visibility_march.comp leaves it
//   out  FIELD: v per voxel, a fastest, then b, then c - u_planes.x; 0 for voxels of other sweeps, and clipped ones
//        else: per work group, feature and item the sum over its voxels; items are v of each candidate, then v times
//        the weight of brightness, then of saturation, in the 16-bit units of the weights
// T is taken d0/2 in front of the voxel's centre.
#include "include/candidates.glsl"
#include "include/opacity.glsl"
#include "include/volume.glsl"
#include "include/passage.glsl"
#include "include/rays.glsl"
#include "include/resident.glsl"
#include "include/ray_depth.glsl"
#include "include/voxel_light.glsl"

const int kSide = 8, kGroup = kSide * kSide;
const int kPlanesPerGroup = 8; // C++: the same in measure_buffers.h
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, std430) readonly buffer Light { LANE i_light[]; };
layout(location = 20) uniform ivec2 u_planes;  // first c, one past the last
layout(location = 21) uniform int u_ring;      // layers of i_light
layout(location = 25) uniform ivec4 u_pyramid; // x: volume's axis of this sweep's pyramid, y: its sign; x = -1: all voxels
layout(location = 26) uniform vec3 u_eyeInBox; // in voxels of the resident box

#ifdef FIELD
layout(binding = 5, std430) writeonly buffer Visibility { float o_visibility[]; };
#else
#include "include/feature_sums.glsl"
#endif

// Every voxel belongs to exactly one pyramid: that of the largest component of its direction from the eye.
bool inPyramid(ivec3 voxel) {
    if (u_pyramid.x < 0) return true;
    vec3 d = vec3(voxel) - u_eyeInBox;
    vec3 m = abs(d);
    int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
    return axis == u_pyramid.x && (d[axis] > 0.0 ? 1 : -1) == u_pyramid.y;
}

float interpolateLight(Ray ray, int c, LANE near[PACKS], out LANE light[PACKS]) {
    vec2 position = (ray.at - u_grid.xy) * u_grid.z;
    // Lattice points are hit exactly where the view is along an axis; rounding must not move off them.
    vec2 nearest = round(position);
    position = mix(position, nearest, lessThan(abs(position - nearest), vec2(1e-4)));
    ivec2 p0 = clamp(ivec2(floor(position)), ivec2(0), u_rays - 1);
    ivec2 p1 = min(p0 + 1, u_rays - 1);
    vec2 w = clamp(position - vec2(p0), 0.0, 1.0);
    if (w.x == 0.0) p1.x = p0.x;
    if (w.y == 0.0) p1.y = p0.y;

    int layer = c % u_ring * u_rays.y;
    ivec4 at = PACKS * (u_rays.x * (layer + ivec4(p0.y, p0.y, p1.y, p1.y)) + ivec4(p0.x, p1.x, p0.x, p1.x));
    float disagreement = 0.0;
    for (int p = 0; p < PACKS; ++p) {
        LANE t00 = i_light[at.x + p], t10 = i_light[at.y + p], t01 = i_light[at.z + p], t11 = i_light[at.w + p];
        LANE spread = max(max(t00, t10), max(t01, t11)) - min(min(t00, t10), min(t01, t11));
        disagreement = max(disagreement, largest(spread * near[p]));
        light[p] = near[p] * mix(mix(t00, t10, w.x), mix(t01, t11, w.x), w.y);
    }
    return disagreement;
}

// v of one voxel; false where it is 0.
bool visibilityOf(ivec3 q, out ivec3 texel, out int code, out LANE visibility[PACKS]) {
    for (int p = 0; p < PACKS; ++p) visibility[p] = LANE(0.0);
    if (any(greaterThanEqual(q.xy, u_dims.xy)) || q.z >= u_planes.y) return false;
    if (!isKept(q)) return false;
    ivec3 voxel = voxelAt(q);
    if (!inPyramid(voxel)) return false;
    LANE tau[PACKS], light[PACKS];
    if (!contentOf(voxel, texel, code, tau)) return false;
    vec2 slope = u_eye.w > 0.5 ? (vec2(q.xy) - u_eye.xy) / (float(q.z) - u_eye.z) : u_shear;
    Ray ray = Ray(vec2(q.xy) + slope * (u_reference - float(q.z)), slope);
    lightAt(ray, float(q.z) - 0.5 / lengthPerC(ray), q.z, light);
    for (int p = 0; p < PACKS; ++p) visibility[p] = light[p] * opacityOfDepth(tau[p]);
    return true;
}

void main() {
    ivec2 ab = ivec2(gl_GlobalInvocationID.xy);
    int first = u_planes.x + int(gl_WorkGroupID.z) * kPlanesPerGroup;
    ivec3 texel;
    int code;
    LANE visibility[PACKS];
#ifdef FIELD
    for (int c = first; c < min(first + kPlanesPerGroup, u_planes.y); ++c) {
        visibilityOf(ivec3(ab, c), texel, code, visibility);
        if (all(lessThan(ab, u_dims.xy)))
            o_visibility[((c - u_planes.x) * u_dims.y + ab.y) * u_dims.x + ab.x] = visibility[0];
    }
#else
    clearSums();
    for (int c = first; c < min(first + kPlanesPerGroup, u_planes.y); ++c) {
        bool seen = visibilityOf(ivec3(ab, c), texel, code, visibility);
        stage(seen, texel, code, visibility);
        addStaged();
    }
    storeSums();
#endif
}
