// Several transfer functions are swept at once, one per component.
//   CANDIDATES   1 or 4
#if CANDIDATES == 4
#define LANES vec4
#define LANES_FORMAT rgba32f
#define LANES_OF(texel) (texel)
#define TEXEL_OF(lanes) (lanes)
#else
#define LANES float
#define LANES_FORMAT r32f
#define LANES_OF(texel) ((texel).r)
#define TEXEL_OF(lanes) vec4(lanes)
#endif

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
