// vision.frag: a picture as a viewer with another colour vision sees it
//   out  o_color   sRGB; alpha stays. seen = clamp(M light), as seenColor() in tf/color_vision.h has it
layout(binding = 0) uniform sampler2D u_picture; // sRGB, opaque, a texel per fragment
layout(location = 0) uniform mat3 u_vision;      // linear light as seen from linear light as it is
layout(location = 0) out vec4 o_color;

vec3 linearFromSrgb(vec3 v) {
    return mix(pow((v + 0.055) / 1.055, vec3(2.4)), v / 12.92, lessThanEqual(v, vec3(0.04045)));
}
vec3 srgbFromLinear(vec3 v) {
    return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}

void main() {
    vec4 c = texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0);
    o_color = vec4(srgbFromLinear(clamp(u_vision * linearFromSrgb(c.rgb), 0.0, 1.0)), c.a);
}
