// The volume's intensities as the page has them, in the place of shaders/include/volume.glsl. Codes of 16 bits are two
// channels of 8, since browsers filter no others everywhere; filtering is linear, so that their sum is filtered, too.
//   WIDE          (high byte, low byte) of codes, else (code)
//   HAS_INVALID   the next channel is 1 where a voxel is valid; codes of others are 0
uniform sampler3D u_volume;

// t: [0,1] over the volume's box. Returns (code / largest of its bits, weight of the valid corners in [0,1]).
vec2 codeAndWeight(vec3 t) {
    vec4 texel = textureLod(u_volume, t, 0.0);
#ifdef WIDE
    vec2 sum = vec2((texel.r * 256.0 + texel.g) / 257.0, texel.b);
#else
    vec2 sum = texel.rg;
#endif
#ifdef HAS_INVALID
    return sum.g > 0.0 ? vec2(sum.r / sum.g, sum.g) : vec2(0.0);
#else
    return vec2(sum.r, 1.0);
#endif
}
