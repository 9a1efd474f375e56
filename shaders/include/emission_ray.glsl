// Emission and absorption along a ray, from front to back (docs/method.md, "The picture"). Needs brick.glsl,
// picture_ray.glsl, leap.glsl, tf_segment.glsl; with LIGHT light.glsl, with VOXEL_COLORS voxel_color.glsl.
//   LIGHT, GRADIENT_OPACITY, VOXEL_COLORS, FAINT, HALVES   as raycast.frag has them

// What has been gathered up to this opacity is lit as one, in its middle.
#ifdef HALVES
const float kLitAtOnce = 1.0 / 512.0;
#else
const float kLitAtOnce = 1.0 / 64.0;
#endif

struct Met {
    float place, share, code;
    TfPlace tf;
};

Met meet(PictureRay ray, float place) {
    vec2 code = codeInBrick(ray.point + place * ray.step);
    return Met(place, code.y, code.x, tfPlace(code.x));
}

// The intensity goes linearly from one sample to the next: then what the segment absorbs and emits is exact, and thin
// tents leave no bands. Returns the mean of (tau * rgb, tau).
vec4 segment(Met a, Met b) {
#ifdef HAS_INVALID
    if (a.share == 0.0) a.tf = b.tf;
    if (b.share == 0.0) b.tf = a.tf;
    return tfMean(a.tf, b.tf) * (0.5 * (a.share + b.share));
#else
    return tfMean(a.tf, b.tf);
#endif
}

float depthOf(PictureRay ray, vec4 mean, Met a, Met b) {
    float path = b.place - a.place;
#ifdef FAINT
    float within = min(b.place, ray.clear.y) - max(a.place, ray.clear.x);
    path *= mix(u_faintDensity, 1.0, clamp(within / max(path, 1e-6), 0.0, 1.0));
#endif
    return mean.a * path * u_step.y;
}

// What one ray has gathered since it was lit.
struct Pending {
    vec4 color;   // premultiplied by what is still seen of it
    float places; // where it is, weighted by alpha
    vec3 gradient;
};

void absorb(PictureRay ray, vec4 mean, Met a, Met b, inout float alphaBefore, inout Pending pending) {
    float depth = depthOf(ray, mean, a, b);
    if (!(depth > 0.0)) return;
    float place = 0.5 * (a.place + b.place);
#ifdef GRADIENT_OPACITY
    pending.gradient = gradientAt(ray.point + place * ray.step);
    depth *= depthShare(pending.gradient);
#endif
    float alpha = opacityOfDepth(depth) * (1.0 - alphaBefore);
#ifdef VOXEL_COLORS
    pending.color += vec4(colorInBrick(ray.point + place * ray.step), 1.0) * alpha;
#else
    pending.color += vec4(mean.rgb * (alpha / mean.a), alpha);
#endif
    pending.places += place * alpha;
    alphaBefore += alpha;
}

#ifdef HALVES
layout(location = 36) uniform vec3 u_halves; // smallest part of a step; how much one may change; change of lit colours
                                             // per d0

// What the intensity may meet beyond those of three samples, as far as they are off a straight line.
float hiddenDepth(Met a, Met m, Met b) {
    vec3 entries = vec3(a.code, m.code, b.code) * u_entriesPerCode;
    float off = abs(entries.y - 0.5 * (entries.x + entries.z));
    float low = min(entries.y, min(entries.x, entries.z)), high = max(entries.y, max(entries.x, entries.z));
    float above = tfIntegral(high + off + 1.0) - tfIntegral(high), below = tfIntegral(low) - tfIntegral(low - off - 1.0);
    return max(above, below) / (off + 1.0) * (b.place - a.place) * u_step.y;
}

// Whether two halves of a segment look otherwise than the whole does.
bool isCoarse(PictureRay ray, Met a, Met m, Met b, vec4 first, vec4 second, float clear) {
    vec4 whole = segment(a, b);
    float all = opacityOfDepth(depthOf(ray, whole, a, b)), one = opacityOfDepth(depthOf(ray, first, a, m)),
          two = (1.0 - one) * opacityOfDepth(depthOf(ray, second, m, b));
    vec3 away = all / max(whole.a, 1e-20) * whole.rgb - one / max(first.a, 1e-20) * first.rgb -
                two / max(second.a, 1e-20) * second.rgb;
    float error = max(max(abs(away.r), abs(away.g)), abs(away.b)) + abs(all - one - two) + min(1.0, hiddenDepth(a, m, b));
#if defined(LIGHT) || defined(VOXEL_COLORS)
    error += u_halves.z * 0.25 * abs(one - two) * (b.place - a.place) * u_step.y;
#endif
    return error * clear > u_halves.y;
}
#endif

vec4 traced(PictureRay ray, vec4 sum) {
    float n = ray.first;
    bool known = false; // the sample n, or the one to which the step from there has been done
    Met last = Met(0.0, 0.0, 0.0, TfPlace(0, vec4(0.0)));
#ifdef HALVES
    float done = 0.0, size = 1.0; // of the step from the sample n on: how much of it; what is to be done next
#endif
    do {
        float leap;
        do {
            leap = stepsToLeap(ray, placeOf(ray, n));
#ifdef HALVES
            if (done > 0.0) leap = 0.0;
#endif
            n += leap;
            if (leap > 0.0) known = false;
        } while (leap > 0.0 && n < ray.end);

        Pending pending = Pending(vec4(0.0), 0.0, vec3(0.0));
        int run = 0;
        do {
#ifdef HALVES
            float from = placeOf(ray, n), to = placeOf(ray, n + 1.0);
            if (!known) last = meet(ray, from);
            known = true;
            Met middle = meet(ray, mix(from, to, done + 0.5 * size)), next = meet(ray, mix(from, to, done + size));
            vec4 first = segment(last, middle), second = segment(middle, next);
            bool own = isOwn(ray, from, to);
            if (own && size > u_halves.x && isCoarse(ray, last, middle, next, first, second, 1.0 - sum.a)) {
                size *= 0.5;
            } else {
                if (own) {
                    absorb(ray, first, last, middle, sum.a, pending);
                    absorb(ray, second, middle, next, sum.a, pending);
                }
                last = next;
                done += size;
                while (size < 1.0 && fract(0.5 * done / size) == 0.0) size *= 2.0; // the largest part that begins there
                if (done == 1.0) {
                    n += 1.0;
                    done = 0.0;
                }
            }
#else
            if (known) n += 1.0;
            Met next = meet(ray, placeOf(ray, n));
            if (!known) last = next;
            known = true;
            if (isOwn(ray, last.place, next.place)) absorb(ray, segment(last, next), last, next, sum.a, pending);
            last = next;
#endif
            ++run;
#ifdef LIGHT
        } while (n < ray.end && run < kRun && sum.a < kOpaque && pending.color.a <= kLitAtOnce);
        if (pending.color.a > 0.0) {
            float place = pending.places / pending.color.a;
            vec3 voxel = ray.point + place * ray.step;
#ifndef GRADIENT_OPACITY
            pending.gradient = gradientAt(voxel);
#endif
            float t = ray.depth.x + place * ray.depth.y;
            pending.color.rgb =
                lit(pending.color.rgb / pending.color.a, pending.gradient, ray.view, voxel, t) * pending.color.a;
        }
#else
        } while (n < ray.end && run < kRun && sum.a < kOpaque);
#endif
        sum.rgb += pending.color.rgb;
    } while (n < ray.end && sum.a < kOpaque);
    return sum;
}
