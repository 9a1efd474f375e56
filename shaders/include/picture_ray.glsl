// The ray of a pixel, in voxel coordinates, and its samples. t is the depth along the view in world units, 0 in the
// plane through the middle of the box.
const float kOpaque = 1.0 - 1.0 / 1024.0; // what lies behind would change a pixel by less than a quarter of a level
const int kRun = 8;                       // samples between two looks at the blocks

layout(location = 1) uniform vec4 u_pictureFromFragment; // picture coordinates [-1,1]^2, y up: xy scale, zw offset
layout(location = 2) uniform mat3 u_rayOrigin;    // times (x, y, 1): the point at t = 0
layout(location = 3) uniform mat3 u_rayDirection; // the same: voxels per unit of t
layout(location = 4) uniform vec2 u_tangents;     // perspective: tangents of the half angles; orthographic: 0
layout(location = 5) uniform vec2 u_step;         // between samples: world units, reference lengths d0
layout(location = 6) uniform vec3 u_boxLo;        // part of the box that is drawn, voxels
layout(location = 7) uniform vec3 u_boxHi;
layout(location = 8) uniform float u_nearest;    // t of the eye; far in front where rays are parallel
layout(location = 9) uniform int u_planeCount;   // clip planes: dot(xyz, voxel) <= w is kept
layout(location = 54) uniform vec4 u_planes[18];
layout(location = 10) uniform vec2 u_jitter;     // size of the picture in pixels; x = 0: samples are not shifted
layout(location = 13) uniform vec3 u_brickLo; // voxels that the texture stands for: segments belong to the brick that
layout(location = 14) uniform vec3 u_brickHi; // holds their middle

#ifdef FAINT
layout(location = 40) uniform int u_faintCount; // planes beyond which optical depths are thinned
layout(location = 41) uniform vec4 u_faint[12];
layout(location = 53) uniform float u_faintDensity; // to this part of their own
#endif

#ifdef GROUND
layout(binding = 6) uniform sampler2D u_groundDepth; // t where rays end; infinite: nowhere
layout(location = 20) uniform ivec2 u_groundOrigin;  // texel of the fragment (0, 0); its rows go down
#endif

// Sample n lies at point + u * step, u = n + shift held in [0, count].
struct PictureRay {
    vec3 point, step; // voxels
    float count;      // of steps, not whole; 0 or less: the ray meets nothing
    float shift;      // (-1, 0]
    float first, end; // numbers of samples that this brick has to look at
    vec3 view;        // unit vector toward the viewer, in the camera's right, up, toward the viewer
    vec2 depth;       // t at u = 0, and what a step adds
    vec2 clear;       // FAINT: u between which nothing is faint
};

// In [0, 1), by pixel (C++: src/render/cpu has the same).
float hashOf(uvec2 pixel) {
    uint h = pixel.x * 0x9E3779B1u + pixel.y * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    return float(h >> 8) / 16777216.0;
}

PictureRay rayOfFragment(vec2 fragment) {
    vec3 picture = vec3(fragment * u_pictureFromFragment.xy + u_pictureFromFragment.zw, 1.0);
    vec3 origin = u_rayOrigin * picture;
    vec3 direction = u_rayDirection * picture;

    // A component of 0 gives infinities of the right sign.
    vec3 ta = (u_boxLo - origin) / direction, tb = (u_boxHi - origin) / direction;
    vec3 enters = min(ta, tb), leaves = max(ta, tb);
    float enter = max(max(enters.x, enters.y), max(enters.z, u_nearest));
    float leave = min(min(leaves.x, leaves.y), leaves.z);
    for (int i = 0; i < u_planeCount; ++i) {
        float room = u_planes[i].w - dot(u_planes[i].xyz, origin), rate = dot(u_planes[i].xyz, direction);
        if (rate < 0.0) enter = max(enter, room / rate);
        if (rate > 0.0) leave = min(leave, room / rate);
        if (rate == 0.0 && room < 0.0) leave = enter;
    }

#ifdef GROUND
    leave = min(leave, texelFetch(u_groundDepth, u_groundOrigin + ivec2(fragment) * ivec2(1, -1), 0).r);
#endif

    PictureRay ray;
    vec3 ahead = vec3(-u_tangents * picture.xy, 1.0);
    ray.view = normalize(ahead);
    float perStep = u_step.x / length(ahead);
    ray.depth = vec2(enter, perStep);
    ray.point = origin + enter * direction;
    ray.step = direction * perStep;
    ray.count = leave > enter ? (leave - enter) / perStep : 0.0;
    ray.clear = vec2(-1e30, 1e30);
#ifdef FAINT
    for (int i = 0; i < u_faintCount; ++i) {
        float room = u_faint[i].w - dot(u_faint[i].xyz, ray.point), rate = dot(u_faint[i].xyz, ray.step);
        if (rate < 0.0) ray.clear.x = max(ray.clear.x, room / rate);
        if (rate > 0.0) ray.clear.y = min(ray.clear.y, room / rate);
        if (rate == 0.0 && room < 0.0) ray.clear.y = -1e30;
    }
#endif
    ray.shift = 0.0;
    if (u_jitter.x > 0.0)
        ray.shift = hashOf(uvec2((vec2(0.5) + vec2(0.5, -0.5) * picture.xy) * u_jitter)) - 1.0;
    ray.first = 0.0;
    ray.end = ceil(ray.count - ray.shift);
#ifdef BRICKS
    // A step more on both sides: the segments themselves tell whose they are.
    ta = (u_brickLo - ray.point) / ray.step;
    tb = (u_brickHi - ray.point) / ray.step;
    enters = min(ta, tb);
    leaves = max(ta, tb);
    float from = max(max(enters.x, enters.y), enters.z), to = min(min(leaves.x, leaves.y), leaves.z);
    if (from > to) ray.count = 0.0;
    ray.first = max(0.0, floor(from - ray.shift) - 1.0);
    ray.end = min(ray.end, ceil(to - ray.shift) + 1.0);
#endif
    return ray;
}

float placeOf(PictureRay ray, float n) {
    return clamp(n + ray.shift, 0.0, ray.count);
}

// Whether this brick has to draw the segment between two places.
bool isOwn(PictureRay ray, float from, float to) {
#ifdef BRICKS
    vec3 middle = ray.point + 0.5 * (from + to) * ray.step;
    return all(greaterThanEqual(middle, u_brickLo)) && all(lessThan(middle, u_brickHi));
#else
    return true;
#endif
}
