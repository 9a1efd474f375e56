// slices_gather.comp: v = T * alpha of the voxels between some of the slices (docs/method.md, "Visibility"), or its
//   sums per feature
//   in   optical depth in front of every slice, as slices_depth.frag leaves it, a layer each
//   out  FIELD: v per voxel, x fastest, then y, then z - u_planes.x; 0 for all other voxels
//        else: per work group, feature and item the sum over its voxels; items are v, then v times the weight of
//        brightness, then of saturation, in the 16-bit units of the weights
// T is taken d0/2 in front of the voxel's centre.
#include "include/candidates.glsl"
#include "include/opacity.glsl"
#include "include/volume.glsl"
#include "include/passage.glsl"
#include "include/view_rays.glsl"
#include "include/resident.glsl"
#include "include/ray_depth.glsl"
#include "include/voxel_light.glsl"

const int kSide = 8, kGroup = kSide * kSide;
const int kPlanesPerGroup = 8; // C++: the same in measure_buffers.h
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 3) uniform sampler3D u_layers;
layout(location = 6) uniform mat3 u_localFromVoxel;
layout(location = 7) uniform ivec3 u_dims;    // of the volume
layout(location = 20) uniform ivec2 u_planes; // z of the first voxels, one past the last
layout(location = 21) uniform int u_ring;     // layers of u_layers: they take turns
layout(location = 22) uniform ivec2 u_slabs;  // between which slices: first slab, one past the last
layout(location = 25) uniform ivec2 u_face;   // of a cube around the eye: axis, sign; axis -1: all directions
layout(location = 26) uniform mat3 u_faceFromVoxel;
layout(location = 8) uniform vec3 u_faceOffset;

#ifdef FIELD
layout(binding = 5, std430) writeonly buffer Visibility { float o_visibility[]; };
#else
#include "include/feature_sums.glsl"
#endif

// Every voxel belongs to exactly one face: that of the largest component of its direction from the eye.
bool onFace(ivec3 voxel) {
    if (u_face.x < 0) return true;
    vec3 d = u_faceFromVoxel * vec3(voxel) + u_faceOffset;
    vec3 m = abs(d);
    int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
    return axis == u_face.x && (d[axis] > 0.0 ? 1 : -1) == u_face.y;
}

// Whether the centre of a voxel is kept, by the sides behind those of the box, and not faint.
bool isKept(ivec3 voxel) {
    for (int i = 6; i < u_sideCount; ++i)
        if (dot(u_sides[i].xyz, vec3(voxel)) - u_sides[i].w > kClipTie) return false;
    return !isFaint(vec3(voxel));
}

vec2 pixelOf(vec3 local) {
    return (local.xy / (1.0 + local.z * u_inverseDistance) - u_picture.xy) * u_picture.zw;
}

float depthAt(ivec2 pixel, int layer) {
    return texelFetch(u_layers, ivec3(pixel, layer), 0).r;
}

float interpolateLight(Ray ray, int c, LANE near[PACKS], out LANE light[PACKS]) {
    vec2 position = pixelOf(u_localFromVoxel * (pointAt(ray, float(c)) - u_origin));
    // Pixels are hit exactly where the view is along an axis; rounding must not move off them.
    vec2 nearest = round(position);
    position = mix(position, nearest, lessThan(abs(position - nearest), vec2(1e-3)));
    ivec2 last = textureSize(u_layers, 0).xy - 1;
    ivec2 p0 = clamp(ivec2(floor(position)), ivec2(0), last), p1 = min(p0 + 1, last);
    vec2 w = clamp(position - vec2(p0), 0.0, 1.0);
    if (w.x == 0.0) p1.x = p0.x;
    if (w.y == 0.0) p1.y = p0.y;
    int layer = c % u_ring;
    vec4 t = exp(-vec4(depthAt(p0, layer), depthAt(ivec2(p1.x, p0.y), layer), depthAt(ivec2(p0.x, p1.y), layer),
                       depthAt(p1, layer)));
    light[0] = near[0] * mix(mix(t.x, t.y, w.x), mix(t.z, t.w, w.x), w.y);
    return near[0] * (largest(t) - smallest(t));
}

// v of one voxel; false where it is 0.
bool visibilityOf(ivec3 voxel, out ivec3 texel, out int code, out LANE visibility[PACKS]) {
    visibility[0] = 0.0;
    if (any(greaterThanEqual(voxel.xy, u_dims.xy)) || voxel.z >= u_planes.y) return false;
    if (!isKept(voxel)) return false;
    LANE tau[PACKS], light[PACKS];
    if (!onFace(voxel) || !contentOf(voxel, texel, code, tau)) return false;
    vec3 local = u_localFromVoxel * (vec3(voxel) - u_origin);
    Ray ray = rayOfPixel(pixelOf(local));
    float c = (local.z - u_slices.x) / u_slices.y - 0.5 / lengthPerC(ray);
    int slab = clamp(int(floor(c)), 0, int(u_slices.z) - 1);
    if (slab < u_slabs.x || slab >= u_slabs.y) return false;
    lightAt(ray, c, int(ceil(c - 1e-3)), light);
    visibility[0] = light[0] * opacityOfDepth(tau[0]);
    return true;
}

void main() {
    ivec2 xy = ivec2(gl_GlobalInvocationID.xy);
    int first = u_planes.x + int(gl_WorkGroupID.z) * kPlanesPerGroup;
    ivec3 texel;
    int code;
    LANE visibility[PACKS];
#ifdef FIELD
    for (int z = first; z < min(first + kPlanesPerGroup, u_planes.y); ++z) {
        visibilityOf(ivec3(xy, z), texel, code, visibility);
        if (all(lessThan(xy, u_dims.xy)))
            o_visibility[((z - u_planes.x) * u_dims.y + xy.y) * u_dims.x + xy.x] = visibility[0];
    }
#else
    clearSums();
    for (int z = first; z < min(first + kPlanesPerGroup, u_planes.y); ++z) {
        bool seen = visibilityOf(ivec3(xy, z), texel, code, visibility);
        stage(seen, texel, code, visibility);
        addStaged();
    }
    storeSums();
#endif
}
