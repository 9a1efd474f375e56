// composite.frag: the accumulated picture over the background
//   out  o_color   opaque with a background, else premultiplied
layout(binding = 0) uniform sampler2D u_accumulated; // premultiplied, see raycast.frag
layout(location = 0) uniform vec4 u_background;      // at the bottom of the picture; a = 0: transparent
layout(location = 1) uniform vec4 u_textureFromFragment; // xy scale, zw offset (negative viewport corner, scaled)
layout(location = 2) uniform bool u_isGrey; // an intensity in red
layout(location = 3) uniform vec3 u_backgroundTop;
layout(location = 4) uniform vec2 u_heightFromFragment; // height in the picture, [0,1] = y of the fragment * x + y
layout(binding = 1) uniform sampler2D u_ground; // opaque where there is ground, else transparent black
layout(location = 5) uniform bool u_hasGround;
layout(location = 6) uniform vec4 u_groundFromFragment; // as u_textureFromFragment
layout(location = 0) out vec4 o_color;

void main() {
    vec4 c = texture(u_accumulated, gl_FragCoord.xy * u_textureFromFragment.xy + u_textureFromFragment.zw);
    if (u_isGrey) c.rgb = c.rrr;
    float height = gl_FragCoord.y * u_heightFromFragment.x + u_heightFromFragment.y;
    vec4 behind = vec4(mix(u_background.rgb, u_backgroundTop, height), u_background.a);
    if (u_hasGround) {
        vec4 ground = texture(u_ground, gl_FragCoord.xy * u_groundFromFragment.xy + u_groundFromFragment.zw);
        behind = ground + (1.0 - ground.a) * behind;
    }
    o_color = c + (1.0 - c.a) * behind;
}
