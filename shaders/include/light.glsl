// What light and depth make of colours (docs/method.md, "Light"). Needs brick.glsl and picture_ray.glsl.
layout(location = 22) uniform mat3 u_cameraFromGradient; // from differences of codes, ahead less behind, along i, j, k to
                                                         // intensity per d0 along the camera's right, up, toward viewer
layout(location = 23) uniform vec4 u_parts;              // ambient, diffuse, specular, shininess
layout(location = 24) uniform vec3 u_toLight;            // unit vector, camera's right, up, toward viewer
layout(location = 25) uniform vec4 u_strengths;          // gradient opacity, silhouettes, occlusion, depth cue
layout(location = 26) uniform vec3 u_cueColor;
layout(location = 27) uniform vec2 u_cue; // cue = t * x + y
#ifdef OCCLUSION
layout(binding = 3) uniform sampler3D u_openness;
layout(location = 28) uniform vec3 u_opennessFromVoxel; // t of that texture = voxel * this + offset
layout(location = 29) uniform vec3 u_opennessOffset;
#endif

// Intensity per d0, camera coordinates.
vec3 gradientAt(vec3 voxel) {
    vec3 difference;
    for (int a = 0; a < 3; ++a) {
        vec3 stride = vec3(0.0);
        stride[a] = 1.0;
        difference[a] = codeInBrick(voxel + stride).x - codeInBrick(voxel - stride).x;
    }
    return u_cameraFromGradient * difference;
}

// What is left of an optical depth.
float depthShare(vec3 gradient) {
    return 1.0 - u_strengths.x * (1.0 - min(1.0, length(gradient) / 0.05));
}

// The color of what lies at `voxel`, t deep, seen from `view`.
vec3 lit(vec3 color, vec3 gradient, vec3 view, vec3 voxel, float t) {
    float g = length(gradient);
    if (g >= 1e-6) { // inside a homogeneous region there is no surface to light
        vec3 normal = gradient / g;
        float facing = dot(normal, view);
        if (facing < 0.0) normal = -normal;
        float toward = dot(normal, u_toLight);
        float mirrored = clamp(2.0 * toward * abs(facing) - dot(u_toLight, view), 0.0, 1.0);
        float highlight = toward > 0.0 ? u_parts.z * pow(mirrored, u_parts.w) : 0.0;
        color = min(color * (u_parts.x + u_parts.y * max(0.0, toward)) + highlight, vec3(1.0));
        float edge = 1.0 - min(1.0, abs(facing));
        color *= 1.0 - u_strengths.y * min(1.0, g / 0.02) * (edge * edge) * (edge * edge);
    }
#ifdef OCCLUSION
    float openness = textureLod(u_openness, voxel * u_opennessFromVoxel + u_opennessOffset, 0.0).r;
    color *= 1.0 - u_strengths.z * (1.0 - openness);
#endif
    return mix(color, u_cueColor, u_strengths.w * clamp(t * u_cue.x + u_cue.y, 0.0, 1.0));
}
