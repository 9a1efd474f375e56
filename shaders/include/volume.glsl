// The volume's intensities, as 16-bit codes read as [0,1].
//   HAS_INVALID   the volume has invalid voxels: the texture holds (code * valid, valid), so that filtering gives at
//                 once the sum of the valid corners' weights and the intensity interpolated over them alone
//                 (docs/method.md, "Volume and intensity")
layout(binding = 0) uniform sampler3D u_volume;

// t: [0,1] over the volume's box. Returns (code / 65535, weight of the valid corners in [0,1]).
vec2 codeAndWeight(vec3 t) {
#ifdef HAS_INVALID
    vec2 sum = textureLod(u_volume, t, 0.0).rg;
    return sum.g > 0.0 ? vec2(sum.r / sum.g, sum.g) : vec2(0.0);
#else
    return vec2(textureLod(u_volume, t, 0.0).r, 1.0);
#endif
}
