// visibility_gather.comp: v = T * alpha of every voxel of some planes (MEASURES 4)
//   in   u_depth          optical depth per ray and layer, as visibility_march.comp leaves it
//   out  o_visibility     per voxel and candidate, a fastest, then b, then c - u_planes.x; 0 for voxels of other sweeps
// T is taken d0/2 in front of the voxel's centre, interpolated between the four rays around the voxel's own. Where they
// disagree (edges of the box and of what is opaque) the voxel's own ray is followed instead.
#include "include/opacity.glsl"
#include "include/volume.glsl"
#include "include/tf.glsl"
#include "include/rays.glsl"
#include "include/candidates.glsl"
#include "include/optical_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 2) uniform sampler3D u_depth;
layout(binding = 0, std430) writeonly buffer Visibility { LANES o_visibility[]; };
layout(location = 12) uniform ivec2 u_planes;  // first c, one past the last
layout(location = 13) uniform ivec4 u_pyramid; // x: world axis of this sweep's pyramid, y: its sign; x = -1: all voxels
layout(location = 14) uniform vec3 u_eyeInVoxels;   // in the volume's own axes
layout(location = 15) uniform vec3 u_volumeSpacing; // the same, units of d0
layout(location = 16) uniform float u_tolerance;    // of T, between neighbouring rays

// Every voxel belongs to exactly one pyramid: that of the largest component of its direction from the eye.
bool inPyramid(vec3 voxel) {
    if (u_pyramid.x < 0) return true;
    vec3 d = (voxel - u_eyeInVoxels) * u_volumeSpacing;
    vec3 m = abs(d);
    int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
    return axis == u_pyramid.x && (d[axis] > 0.0 ? 1 : -1) == u_pyramid.y;
}

LANES depthAt(ivec2 pixel, int layer, float weight) {
    LANES near = LANES_OF(texelFetch(u_depth, ivec3(pixel, layer), 0));
    LANES far = LANES_OF(texelFetch(u_depth, ivec3(pixel, layer + 1), 0));
    return mix(near, far, weight);
}

const float kDark = 10.0; // optical depth of a transmittance of 5e-5

// The optical depth of a part of one ray.
LANES marched(Ray ray, float from, float to, float perC) {
    LANES depth = LANES(0.0);
    int count = int(ceil((to - from) / u_slabs.y));
    float width = (to - from) / float(max(count, 1));
    for (int i = 0; i < count; ++i) { // toward the eye, so that it can end where nothing shines through any more
        float middle = to - (float(i) + 0.5) * width;
        depth += opticalDepthAt(lateral(ray, middle), middle) * (width * perC);
        if (smallest(depth) > kDark) break;
    }
    return depth;
}

LANES depthInFrontOf(vec3 q) {
    vec2 slope = u_eye.w > 0.5 ? (q.xy - u_eye.xy) / (q.z - u_eye.z) : u_shear;
    Ray ray = Ray(q.xy + slope * (u_reference - q.z), slope);
    float perC = lengthPerC(ray);
    float c = q.z - 0.5 / perC;

    vec2 position = (ray.at - u_grid.xy) * u_grid.z;
    // Lattice points are hit exactly where the view is along an axis; rounding must not move off them.
    vec2 nearest = round(position);
    position = mix(position, nearest, lessThan(abs(position - nearest), vec2(1e-4)));
    ivec2 p0 = clamp(ivec2(floor(position)), ivec2(0), u_rays - 1);
    ivec2 p1 = min(p0 + 1, u_rays - 1);
    vec2 w = clamp(position - vec2(p0), 0.0, 1.0);

    float layer = (c - u_slabs.x) / u_slabs.y - float(u_layers.x);
    int l = clamp(int(floor(layer)), 0, u_layers.y - u_layers.x - 1);
    float wl = clamp(layer - float(l), 0.0, 1.0);

    LANES d00 = depthAt(p0, l, wl);
    LANES d10 = w.x > 0.0 ? depthAt(ivec2(p1.x, p0.y), l, wl) : d00;
    LANES d01 = w.y > 0.0 ? depthAt(ivec2(p0.x, p1.y), l, wl) : d00;
    LANES d11 = w.x > 0.0 && w.y > 0.0 ? depthAt(p1, l, wl) : (w.x > 0.0 ? d10 : d01);
    LANES least = min(min(d00, d10), min(d01, d11));
    LANES spread = max(max(d00, d10), max(d01, d11)) - least;
    if (largest(spread * exp(-least)) > u_tolerance) return marched(ray, passageOf(ray, 2.0).enter, c, perC);
    return mix(mix(d00, d10, w.x), mix(d01, d11, w.x), w.y);
}

void main() {
    ivec3 index = ivec3(gl_GlobalInvocationID);
    index.z += u_planes.x;
    if (any(greaterThanEqual(index.xy, u_dims.xy)) || index.z >= u_planes.y) return;
    vec3 q = vec3(index);
    vec3 t = u_texFromQ * q + u_texOffset;
    ivec3 voxel = ivec3(t * vec3(textureSize(u_volume, 0)));

    LANES visibility = LANES(0.0);
    if (inPyramid(vec3(voxel))) {
        vec2 texel = texelFetch(u_volume, voxel, 0).rg;
#ifdef HAS_INVALID
        bool valid = texel.g > 0.5;
#else
        bool valid = true;
#endif
        LANES own = LANES_OF(tfEntry(texel.r));
        if (valid && largest(own) > 0.0) {
            LANES depth = depthInFrontOf(q);
#if CANDIDATES == 4
            vec4 alpha = vec4(opacityOfDepth(own.x), opacityOfDepth(own.y),
                              opacityOfDepth(own.z), opacityOfDepth(own.w));
#else
            float alpha = opacityOfDepth(own);
#endif
            visibility = exp(-depth) * alpha;
        }
    }
    o_visibility[(index.z - u_planes.x) * u_dims.x * u_dims.y + index.y * u_dims.x + index.x] = visibility;
}
