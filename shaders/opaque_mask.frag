// opaque_mask.frag: marks, in the depth buffer, the pixels behind which nothing can be seen any more
layout(binding = 0) uniform sampler2D u_accumulated;

const float kOpaque = 0.9999; // a transmittance of 1e-4, as in the cpu renderer: a fortieth of an 8-bit level

void main() {
    if (texelFetch(u_accumulated, ivec2(gl_FragCoord.xy), 0).a < kOpaque) discard;
}
