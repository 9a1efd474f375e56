// A volume drawn brick by brick: the texture holds a part of it, or all. Needs volume.glsl.
//   BRICKS   there is more than one
layout(location = 15) uniform vec3 u_textureFromVoxel; // t of the texture = voxel * this + offset
layout(location = 16) uniform vec3 u_textureOffset;
layout(location = 17) uniform vec3 u_textureEnd; // centre of the brick's last voxel; what lies behind is another's

// t of the brick's textures; voxel: coordinates in the whole volume.
vec3 inBrick(vec3 voxel) {
    vec3 t = voxel * u_textureFromVoxel + u_textureOffset;
#ifdef BRICKS
    t = min(t, u_textureEnd);
#endif
    return t;
}

vec2 codeInBrick(vec3 voxel) {
    return codeAndWeight(inBrick(voxel));
}
