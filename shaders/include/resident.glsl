// Where the voxels of a sweep lie on the device: a box of them, folded into bricks where the texture would be too long.
//   FOLDED   bricks of u_brick cells, one more voxel than cells, side by side in one texture
// Needs volume.glsl.
layout(location = 10) uniform mat3 u_voxelFromQ; // voxel of the resident box = u_voxelFromQ * q + u_voxelOffset
layout(location = 11) uniform vec3 u_voxelOffset;
layout(location = 14) uniform ivec3 u_lastVoxel; // of the resident box
layout(location = 15) uniform vec3 u_textureSize;
#ifdef FOLDED
layout(location = 16) uniform ivec3 u_brick;
layout(location = 17) uniform ivec3 u_bricks; // number along each axis
layout(location = 18) uniform ivec3 u_slots;  // of the texture, along each axis
layout(location = 19) uniform ivec3 u_tile;   // voxels from slot to slot
#endif

// What to add to a voxel's coordinates to get its texel's.
ivec3 texelShift(ivec3 voxel) {
#ifdef FOLDED
    ivec3 brick = min(voxel / u_brick, u_bricks - 1);
    int number = brick.x + u_bricks.x * (brick.y + u_bricks.y * brick.z);
    ivec3 slot = ivec3(number % u_slots.x, number / u_slots.x % u_slots.y, number / (u_slots.x * u_slots.y));
    return slot * u_tile - brick * u_brick;
#else
    return ivec3(0);
#endif
}

ivec3 voxelAt(ivec3 q) {
    return ivec3(round(u_voxelFromQ * vec3(q) + u_voxelOffset));
}

vec2 codeAndWeightAt(vec3 q) {
    vec3 voxel = clamp(u_voxelFromQ * q + u_voxelOffset, vec3(0.0), vec3(u_lastVoxel));
    return codeAndWeight((voxel + vec3(texelShift(ivec3(voxel))) + 0.5) / u_textureSize);
}
