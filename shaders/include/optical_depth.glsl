// The optical depth of a piece of a ray, per candidate.
// Needs rays.glsl, volume.glsl, tf.glsl (whose table holds the optical depth of d0 per candidate), candidates.glsl.
LANES opticalDepthAt(vec2 ab, float c) {
    vec2 sampled = codeAndWeight(u_texFromQ * vec3(ab, c) + u_texOffset);
    return LANES_OF(tfEntry(sampled.x)) * sampled.y;
}
