// What the ray of a pixel meets, over the background. Goes behind the includes that raycast.frag has for MODE 0.
//   out  o_color   sRGB, opaque
uniform vec3 u_bottom, u_top; // the background at the lower and the upper edge of the picture
out vec4 o_color;

void main() {
    PictureRay ray = rayOfFragment(gl_FragCoord.xy);
    vec4 met = ray.count > 0.0 ? traced(ray, vec4(0.0)) : vec4(0.0);
    float height = 0.5 + 0.5 * (gl_FragCoord.y * u_pictureFromFragment.y + u_pictureFromFragment.w);
    o_color = vec4(met.rgb + (1.0 - met.a) * mix(u_bottom, u_top, height), 1.0);
}
