// The straight lines along which visibility is swept, and the space they live in.
//   q = (a, b, c)   voxel coordinates with the sweep axis last, c growing away from the eye; the box reaches from -0.5
//                   to dims - 0.5
//   ray             fixed by the point (a, b) where it meets the reference plane c = u_reference
layout(location = 1) uniform vec4 u_eye;        // xyz: the eye in q (perspective); w: 1 perspective, 0 orthographic
layout(location = 2) uniform vec2 u_shear;      // orthographic: change of (a, b) per unit of c
layout(location = 3) uniform float u_reference; // c of the reference plane
layout(location = 4) uniform vec3 u_spacing;    // of a, b, c in units of d0
layout(location = 5) uniform ivec3 u_dims;      // of a, b, c
layout(location = 6) uniform vec3 u_grid;       // (a, b) of ray (0, 0); rays per voxel
layout(location = 7) uniform ivec2 u_rays;      // number of rays along a, b
layout(location = 8) uniform vec2 u_slabs;      // c of layer 0; c per layer
layout(location = 9) uniform ivec2 u_layers;    // first and last layer in the depth texture
layout(location = 10) uniform mat3 u_texFromQ;  // t = u_texFromQ * q + u_texOffset, [0,1] over the box
layout(location = 11) uniform vec3 u_texOffset;

struct Ray {
    vec2 at;    // (a, b) on the reference plane
    vec2 slope; // change of (a, b) per unit of c
};

Ray rayAt(vec2 at) {
    return Ray(at, u_eye.w > 0.5 ? (at - u_eye.xy) / (u_reference - u_eye.z) : u_shear);
}

Ray rayOfPixel(ivec2 pixel) {
    return rayAt(u_grid.xy + vec2(pixel) / u_grid.z);
}

vec2 lateral(Ray ray, float c) {
    return ray.at + ray.slope * (c - u_reference);
}

// Length of the ray per unit of c, in units of d0.
float lengthPerC(Ray ray) {
    return length(vec3(ray.slope, 1.0) * u_spacing);
}

float layerC(int layer) {
    return u_slabs.x + float(layer) * u_slabs.y;
}

// How a ray passes through the box: c where it enters, c where it leaves, and the face it enters by (0 the front,
// 1 a side in a, 2 a side in b). The sides by which it leaves are moved outward by `margin` voxels: just outside the
// box a ray goes on as the volume's edge, so that interpolating between rays meets no jump there.
struct Passage {
    float enter, leave;
    int face;
};

Passage passageOf(Ray ray, float margin) {
    Passage p = Passage(u_slabs.x, float(u_dims.z) - 0.5, 0);
    for (int axis = 0; axis < 2; ++axis) {
        float lo = -0.5, hi = float(u_dims[axis]) - 0.5;
        float slope = ray.slope[axis], at = ray.at[axis];
        if (abs(slope) < 1e-9) {
            if (at < lo - margin || at > hi + margin) p.leave = -1e9;
            continue;
        }
        float enter = ((slope > 0.0 ? lo : hi) - at) / slope + u_reference;
        float leave = ((slope > 0.0 ? hi + margin : lo - margin) - at) / slope + u_reference;
        if (enter > p.enter) {
            p.enter = enter;
            p.face = axis + 1;
        }
        p.leave = min(p.leave, leave);
    }
    return p;
}
