// slice.vert: the outline of one slab of the box, seen from the eye
//   in   a_position   normalized coordinates of the whole picture
//   in   a_slab       world units along the view from the middle of the box: where the slab begins, ends
layout(location = 0) in vec2 a_position;
layout(location = 1) in vec2 a_slab;
layout(location = 20) uniform vec4 u_tileFromPicture; // scale xy, offset zw, normalized coordinates

flat out vec2 v_slab;

void main() {
    v_slab = a_slab;
    gl_Position = vec4(a_position * u_tileFromPicture.xy + u_tileFromPicture.zw, 0.0, 1.0);
}
