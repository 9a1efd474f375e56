// slices_depth.frag: what one slab of the volume, between two slices, adds to the optical depth of each pixel
//   out  optical depth of the ray's part in the slab, added by blending
// The vertex shader is composite.vert; the rectangle that the slab may be seen in is the scissor's.
#include "include/candidates.glsl"
#include "include/volume.glsl"
#include "include/passage.glsl"
#include "include/view_rays.glsl"
#include "include/resident.glsl"
#include "include/ray_depth.glsl"

layout(location = 20) uniform int u_slab;
out vec4 o_depth;

void main() {
    Ray ray = rayOfPixel(gl_FragCoord.xy - 0.5);
    Passage passage = passageOf(ray, 2.0);
    float from = max(float(u_slab), passage.enter), to = min(float(u_slab + 1), passage.leave);
    if (from >= to) discard;
    Sample last = sampleAt(ray, from);
    LANE depth[PACKS];
    depth[0] = 0.0;
    follow(ray, from, to, last, depth);
    o_depth = vec4(depth[0]);
}
