// A volume drawn brick by brick: the texture holds a part of the box. Needs volume.glsl.
layout(location = 15) uniform vec3 u_textureFromBox; // t of the texture = t of the box * this + offset
layout(location = 16) uniform vec3 u_textureOffset;
layout(location = 17) uniform vec3 u_textureEnd; // centre of the brick's last voxel; what lies behind is another's

// t: [0,1] over the whole volume's box.
vec2 codeInBrick(vec3 t) {
    return codeAndWeight(min(t * u_textureFromBox + u_textureOffset, u_textureEnd));
}
