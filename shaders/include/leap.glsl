// Empty space, by blocks of 2^BLOCK_SHIFT voxels: how many blocks off the next one is in which anything is drawn. Needs
// picture_ray.glsl.
layout(binding = 2) uniform usampler3D u_distances;
layout(location = 21) uniform vec3 u_lastVoxel;
layout(location = 11) uniform ivec3 u_lastBlock;

// How many whole steps the ray can go from u before it comes to such a block.
float stepsToLeap(PictureRay ray, float u) {
    vec3 at = ray.point + u * ray.step;
    ivec3 block = min(ivec3(clamp(at, vec3(0.0), u_lastVoxel)) >> BLOCK_SHIFT, u_lastBlock);
    int distance = int(texelFetch(u_distances, block, 0).r);
    ivec3 below = block - distance + 1, beyond = block + distance;
    vec3 low = mix(vec3(below << BLOCK_SHIFT), vec3(-1e6), lessThanEqual(below, ivec3(0)));
    vec3 high = mix(vec3(beyond << BLOCK_SHIFT), vec3(1e6), greaterThan(beyond, u_lastBlock));
    vec3 room = abs(mix(high, low, lessThan(ray.step, vec3(0.0))) - at) / max(abs(ray.step), vec3(1e-12));
    float steps = min(min(room.x, min(room.y, room.z)), 65536.0);
    return distance > 0 ? max(0.0, floor(steps - 0.01)) : 0.0; // rounding leaves it inside
}
