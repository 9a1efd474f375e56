// A colour per voxel in place of those of the transfer function (docs/method.md, "Colours by voxel"): a texture that
// lies as that of the intensities does. Needs brick.glsl.
layout(binding = 5) uniform sampler3D u_voxelColors; // sRGB; with HAS_INVALID black and transparent where invalid

// voxel: coordinates in the whole volume.
vec3 colorInBrick(vec3 voxel) {
    vec4 color = textureLod(u_voxelColors, inBrick(voxel), 0.0);
#ifdef HAS_INVALID
    return color.a > 0.0 ? color.rgb / color.a : vec3(0.0);
#else
    return color.rgb;
#endif
}
