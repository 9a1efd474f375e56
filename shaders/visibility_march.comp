// visibility_march.comp: the optical depth between the eye and every layer, along every ray
//   in   layer 0 of u_depth, where this is not the first chunk: the depth at layer u_layers.x
//   out  layer i of u_depth: the integral of tau from where the ray enters the box to layer u_layers.x + i, no unit
// One invocation per ray; layers are the boundaries of slabs, each slab sampled in the middle of its part in the box.
#include "include/volume.glsl"
#include "include/tf.glsl"
#include "include/rays.glsl"
#include "include/candidates.glsl"
#include "include/optical_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, LANES_FORMAT) uniform image3D u_depth;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, u_rays))) return;
    Ray ray = rayOfPixel(pixel);
    Passage passage = passageOf(ray, 2.0);
    float perC = lengthPerC(ray);

    LANES depth = LANES(0.0);
    if (u_layers.x == 0) imageStore(u_depth, ivec3(pixel, 0), vec4(0.0));
    else depth = LANES_OF(imageLoad(u_depth, ivec3(pixel, 0)));
    for (int layer = u_layers.x; layer < u_layers.y; ++layer) {
        float from = max(layerC(layer), passage.enter);
        float to = min(layerC(layer + 1), passage.leave);
        if (to > from) {
            float middle = 0.5 * (from + to);
            depth += opticalDepthAt(lateral(ray, middle), middle) * ((to - from) * perC);
        }
        imageStore(u_depth, ivec3(pixel, layer + 1 - u_layers.x), TEXEL_OF(depth));
    }
}
