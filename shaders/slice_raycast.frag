// slice_raycast.frag: what one slab adds to one pixel, front to back
//   in   v_slab    depth range of the slab
//   out  o_color   premultiplied sRGB and opacity of the part of the ray in slab and box; blended under what is there
#include "include/opacity.glsl"
#include "include/volume.glsl"
#include "include/brick.glsl"
#include "include/tf_segment.glsl"

layout(location = 1) uniform vec4 u_pictureFromFragment; // normalized picture coordinates: xy scale, zw offset
// The ray of a pixel: t(depth) = origin + depth * direction, t in [0,1] over the volume's box.
layout(location = 2) uniform mat3 u_rayOrigin;    // times (x, y, 1), normalized picture coordinates
layout(location = 3) uniform mat3 u_rayDirection; // the same; t per world unit of depth
layout(location = 4) uniform vec2 u_tangents;     // perspective: tangents of the half angles; orthographic: 0
layout(location = 5) uniform float u_perD0;       // 1 / d0
layout(location = 6) uniform vec3 u_clipLo;       // part of the box that is drawn, t
layout(location = 7) uniform vec3 u_clipHi;
layout(location = 13) uniform vec3 u_brickLo; // part of the box that the texture stands for: segments belong to the
layout(location = 14) uniform vec3 u_brickHi; // brick that holds their middle

#ifdef SHADING
#include "include/shading.glsl"
#endif

flat in vec2 v_slab;
layout(location = 0) out vec4 o_color;

void main() {
    vec3 picture = vec3(gl_FragCoord.xy * u_pictureFromFragment.xy + u_pictureFromFragment.zw, 1.0);
    vec3 origin = u_rayOrigin * picture;
    vec3 direction = u_rayDirection * picture;

    // Where the ray is inside the box; a component of 0 gives infinities of the right sign.
    vec3 ta = (u_clipLo - origin) / direction;
    vec3 tb = (u_clipHi - origin) / direction;
    vec3 enter = min(ta, tb), leave = max(ta, tb);
    float from = max(max(enter.x, enter.y), max(enter.z, v_slab.x));
    float to = min(min(leave.x, leave.y), min(leave.z, v_slab.y));
    if (!(to > from)) discard;
    vec3 middle = origin + 0.5 * (from + to) * direction;
    if (any(lessThan(middle, u_brickLo)) || any(greaterThanEqual(middle, u_brickHi))) discard;

    // The intensity goes linearly from one end to the other: then what the slab absorbs and emits is exact, and thin
    // tents leave no bands.
    vec2 front = codeInBrick(origin + from * direction), back = codeInBrick(origin + to * direction);
    float share = 0.5 * (front.y + back.y);
    if (front.y == 0.0) front.x = back.x;
    if (back.y == 0.0) back.x = front.x;
    vec4 mean = tfMean(front.x, back.x);
    if (!(mean.a * share > 0.0)) discard;
    float steps = (to - from) * u_perD0 * length(vec3(1.0, u_tangents * picture.xy));
    float alpha = opacityOfStep(mean.a * share, steps);
    vec3 color = mean.rgb / mean.a;
#ifdef SHADING
    color = shaded(color, middle, direction);
#endif
    o_color = vec4(color * alpha, alpha);
}
