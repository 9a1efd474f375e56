// Light from the eye on the surface that the intensity's gradient describes; the same numbers as in
// src/render/cpu/cpu_renderer.cpp. Needs brick.glsl.
layout(location = 8) uniform vec3 u_voxel;   // one voxel, in t
layout(location = 9) uniform vec3 u_spacing; // world units
layout(location = 10) uniform vec3 u_box;    // size of the box, world units
layout(location = 11) uniform float u_intensityPerCode; // intensity of code/65535 = 1

const float kAmbient = 0.35, kDiffuse = 0.65, kSpecular = 0.25, kShininess = 24.0;

// t: where; direction: of the ray, in t.
vec3 shaded(vec3 color, vec3 t, vec3 direction) {
    vec3 gradient; // central differences, intensity per world unit
    for (int a = 0; a < 3; ++a) {
        vec3 stride = vec3(0.0);
        stride[a] = u_voxel[a];
        gradient[a] = (codeInBrick(t + stride).x - codeInBrick(t - stride).x) / u_spacing[a];
    }
    gradient *= u_intensityPerCode;
    float len = length(gradient);
    if (len < 1e-6) return color; // inside a homogeneous region there is no surface to light
    float cosine = abs(dot(gradient / len, normalize(direction * u_box)));
    return min(color * (kAmbient + kDiffuse * cosine) + vec3(kSpecular * pow(cosine, kShininess)), vec3(1.0));
}
