// visibility_march.comp: how much light every ray lets through to each voxel plane
//   in   light at plane u_planes.x - 1, where that is not the first
//   out  light at the planes u_planes.x ... u_planes.y - 1: T = exp(-optical depth), 1 where the ray has not yet entered
// One invocation per ray. Planes take turns in u_ring layers of the buffer.
#include "include/candidates.glsl"
#include "include/volume.glsl"
#include "include/passage.glsl"
#include "include/rays.glsl"
#include "include/resident.glsl"
#include "include/ray_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, std430) buffer Light { LANE io_light[]; }; // candidates fastest, then rays along a, b, then layers
layout(location = 20) uniform ivec2 u_planes; // first c, one past the last
layout(location = 21) uniform int u_ring;
layout(location = 22) uniform bool u_first; // the rays start here

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, u_rays))) return;
    Ray ray = rayAt(u_grid.xy + vec2(pixel) / u_grid.z);
    Passage passage = passageOf(ray, 2.0);
    int at = (pixel.y * u_rays.x + pixel.x) * PACKS, layerSize = u_rays.x * u_rays.y * PACKS;

    float c = passage.enter;
    LANE depth[PACKS];
    for (int p = 0; p < PACKS; ++p) depth[p] = LANE(0.0);
    if (!u_first) {
        c = max(c, float(u_planes.x - 1));
        for (int p = 0; p < PACKS; ++p)
            depth[p] = -log(max(io_light[(u_planes.x - 1) % u_ring * layerSize + at + p], LANE(1e-30)));
    }
    Sample last = sampleAt(ray, c);
    for (int plane = u_planes.x; plane < u_planes.y; ++plane) {
        float to = min(float(plane), passage.leave);
        if (to > c) {
            follow(ray, c, to, last, depth);
            c = to;
        }
        for (int p = 0; p < PACKS; ++p) io_light[plane % u_ring * layerSize + at + p] = exp(-depth[p]);
    }
}
