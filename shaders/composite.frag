// composite.frag: the accumulated picture over the background
//   out  o_color   opaque with a background, else premultiplied
layout(binding = 0) uniform sampler2D u_accumulated; // premultiplied
layout(location = 0) uniform vec4 u_background;      // a = 0: transparent
layout(location = 1) uniform vec4 u_textureFromFragment; // xy scale, zw offset (negative viewport corner, scaled)
layout(location = 0) out vec4 o_color;

void main() {
    vec4 c = texture(u_accumulated, gl_FragCoord.xy * u_textureFromFragment.xy + u_textureFromFragment.zw);
    o_color = c + (1.0 - c.a) * u_background;
}
