// raycast.frag: everything that one ray meets, in the volume or in one brick of it
//   MODE        0 composite, 1 largest intensity, 2 smallest, 3 mean, 4 surfaces
//   LIGHT       colours are lit or otherwise changed (include/light.glsl)
//   GRADIENT_OPACITY, OCCLUSION   with LIGHT: these parts of it
//   VOXEL_COLORS   colours are those of voxels (include/voxel_color.glsl)
//   GROUND      rays end at the ground
//   FAINT       what lies beyond some planes is thinned
//   HALVES      steps are halved once, and on where the picture hangs on them
//   BRICKS      one of several: goes on from what the bricks in front have left in the images
//   out  u_state   composite, surfaces: premultiplied sRGB and opacity; else: the intensity, for its mean the length of
//                  the way, 0, 1
// Loops are nested so that work which few rays need comes once per turn of the outer loop: devices without branches,
// among them rasterizers in software, skip code only between turns of a loop.
#include "include/opacity.glsl"
#include "include/volume.glsl"
#include "include/brick.glsl"
#include "include/picture_ray.glsl"
#include "include/leap.glsl"

layout(binding = 0, rgba32f) uniform restrict image2D u_state;

#if MODE == 0 || MODE == 4
#ifdef LIGHT
#include "include/light.glsl"
#endif
#ifdef VOXEL_COLORS
#include "include/voxel_color.glsl"
#endif
#endif

#if MODE == 0
#include "include/tf_segment.glsl"
#include "include/emission_ray.glsl"

#elif MODE == 4
// Each feature once per ray, where the intensity first enters its interval. A class is the number of borders of the
// features' intervals up to an intensity: odd inside a feature.
layout(binding = 4) uniform sampler2D u_features; // per feature (low, high as code/65535, opacity, 0), (rgb, 0)
layout(location = 18) uniform int u_featureCount;
layout(binding = 1, rgba32ui) uniform restrict uimage2D u_seen; // a bit per feature

vec4 featureTexel(int index) {
    return texelFetch(u_features, ivec2(index & 255, index >> 8), 0);
}

struct Met {
    float place, code, share;
    int kind; // its class
};

Met meet(PictureRay ray, float place) {
    vec2 code = codeInBrick(ray.point + place * ray.step);
    int kind = 0;
    for (int f = 0; f < u_featureCount; ++f) {
        vec4 feature = featureTexel(2 * f);
        kind += int(code.x >= feature.x) + int(code.x >= feature.y);
    }
    return Met(place, code.x, code.y, kind);
}

bool isUnseen(uvec4 seen, int kind) {
    int f = kind >> 1;
    return (kind & 1) == 1 && (seen[f >> 5] >> (f & 31) & 1u) == 0u;
}

vec4 traced(PictureRay ray, vec4 sum, inout uvec4 seen) {
    float n = ray.first;
    bool known = false;
    Met last = Met(0.0, 0.0, 0.0, 0);
    do {
        float leap;
        do {
            leap = stepsToLeap(ray, placeOf(ray, n));
            n += leap;
            if (leap > 0.0) known = false;
        } while (leap > 0.0 && n < ray.end);

        Met from = last, to = last;
        bool maybe = false;
        int run = 0;
        do {
            if (!maybe) { // some rasterizers in software let rays go on that have left a loop others are in
                if (known) n += 1.0;
                to = meet(ray, placeOf(ray, n));
                from = known ? last : to;
                last = to;
                maybe = (known || n == 0.0) && isOwn(ray, from.place, to.place);
                known = true;
#ifdef HAS_INVALID
                maybe = maybe && from.share + to.share > 0.0;
                if (from.share == 0.0) from = Met(from.place, to.code, to.share, to.kind);
                if (to.share == 0.0) to = Met(to.place, from.code, from.share, from.kind);
#endif
                maybe = maybe && (from.kind != to.kind || isUnseen(seen, from.kind));
            }
            ++run;
        } while (!maybe && n < ray.end && run < kRun);

        // Through the classes on the way.
        int kind = from.kind, way = to.kind < kind ? -1 : 1;
        bool more;
        do {
            if (maybe && isUnseen(seen, kind)) {
                int f = kind >> 1;
                seen[f >> 5] |= 1u << (f & 31);
                vec4 feature = featureTexel(2 * f);
                vec3 color = featureTexel(2 * f + 1).rgb;
                float border = way > 0 ? feature.x : feature.y;
                float part = kind == from.kind ? 0.0 : clamp((border - from.code) / (to.code - from.code), 0.0, 1.0);
                float alpha = feature.z;
                float place = mix(from.place, to.place, part);
                vec3 voxel = ray.point + place * ray.step;
#ifdef VOXEL_COLORS
                color = colorInBrick(voxel);
#endif
#ifdef LIGHT
                vec3 gradient = gradientAt(voxel);
#ifdef GRADIENT_OPACITY
                alpha = 1.0 - pow(1.0 - alpha, depthShare(gradient));
#endif
                color = lit(color, gradient, ray.view, voxel, ray.depth.x + place * ray.depth.y);
#endif
                sum += vec4(color, 1.0) * (alpha * (1.0 - sum.a));
            }
            more = maybe && kind != to.kind && sum.a < kOpaque;
            kind += way;
        } while (more);
    } while (n < ray.end && sum.a < kOpaque);
    return sum;
}

#else
layout(location = 18) uniform vec2 u_shown;           // codes that count: [x, y)
layout(location = 19) uniform float u_intensityPerCode; // intensity of code/65535 = 1

// sum: the intensity and 1; for the mean the sum along the way, and the way
void add(vec2 code, float way, inout vec2 sum) {
    if (!(code.y > 0.0 && code.x >= u_shown.x && code.x < u_shown.y)) return;
    float intensity = code.x * u_intensityPerCode;
#if MODE == 1
    sum = vec2(max(sum.x, intensity), 1.0);
#elif MODE == 2
    sum = vec2(sum.y > 0.0 ? min(sum.x, intensity) : intensity, 1.0);
#else
    sum += vec2(intensity, 1.0) * way;
#endif
}

vec4 traced(PictureRay ray, vec4 before) {
#if MODE == 3
    vec2 sum = vec2(before.x * before.y, before.y);
#else
    vec2 sum = before.xw;
#endif
    float n = ray.first, last = placeOf(ray, n);
    vec2 code = codeInBrick(ray.point + last * ray.step);
    do {
        n += 1.0;
        float next = placeOf(ray, n);
        vec2 former = code;
        code = codeInBrick(ray.point + next * ray.step);
        if (isOwn(ray, last, next)) {
            float weight = 0.5 * (next - last);
            add(former, weight, sum);
            add(code, weight, sum);
        }
        last = next;
    } while (n < ray.end);
    if (sum.y == 0.0) return vec4(0.0);
#if MODE == 3
    return vec4(sum.x / sum.y, sum.y, 0.0, 1.0);
#else
    return vec4(sum.x, 0.0, 0.0, 1.0);
#endif
}
#endif

void main() {
    PictureRay ray = rayOfFragment(gl_FragCoord.xy);
    if (!(ray.count > 0.0)) return;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 state = vec4(0.0);
#ifdef BRICKS
    state = imageLoad(u_state, pixel);
#endif
#if MODE == 4
    uvec4 seen = uvec4(0u);
#ifdef BRICKS
    seen = imageLoad(u_seen, pixel);
    if (state.a >= kOpaque) return;
#endif
    state = traced(ray, state, seen);
#ifdef BRICKS
    imageStore(u_seen, pixel, seen);
#endif
#else
#if MODE == 0
    if (state.a >= kOpaque) return;
#endif
    state = traced(ray, state);
#endif
    imageStore(u_state, pixel, state);
}
