// Several transfer functions are swept at once: PACKS vectors LANE per ray or voxel, one component per candidate.
//   CANDIDATES   1, 4 or 8
#if CANDIDATES == 1
#define LANE float
#define UINT_LANE uint
#else
#define LANE vec4
#define UINT_LANE uvec4
#endif
#define PACKS ((CANDIDATES + 3) / 4)

float largest(float x) {
    return x;
}
float largest(vec4 x) {
    return max(max(x.x, x.y), max(x.z, x.w));
}

float smallest(float x) {
    return x;
}
float smallest(vec4 x) {
    return min(min(x.x, x.y), min(x.z, x.w));
}
