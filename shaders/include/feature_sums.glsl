// Sums per feature over the voxels of a work group, without atomics: each accumulator belongs to one invocation, which
// goes through the group's voxels in order, so that every run gives the same bits.
//   SLOTS      at least the number of features + 1, the last for "in none"
//   SEGMENTS   invocations that share the voxels of one item; SEGMENTS * 3 * CANDIDATES <= 64
layout(binding = 4, std430) readonly buffer Features { uint i_featureOfCode[]; }; // two codes per word, the low one first
layout(binding = 5, std430) writeonly buffer Sums { float o_sums[]; };            // [group][slot][item]
layout(binding = 2) uniform usampler3D u_weights; // low 16 bits brightness, high ones saturation; texels as in u_volume
layout(location = 27) uniform bool u_hasWeights;

const int kItems = 3 * CANDIDATES;
const uint kNothing = 0xffffffffu;
shared uint s_slot[kGroup];
shared float s_visibility[kGroup * CANDIDATES];
shared float s_weights[kGroup * 3]; // 1, brightness, saturation
shared float s_sums[SLOTS * SEGMENTS * kItems];
shared uint s_someSeen;

void clearSums() {
    for (int i = int(gl_LocalInvocationIndex); i < SLOTS * SEGMENTS * kItems; i += kGroup) s_sums[i] = 0.0;
    if (gl_LocalInvocationIndex == 0u) s_someSeen = 0u;
    barrier();
}

void stage(bool seen, ivec3 texel, int code, LANE visibility[PACKS]) {
    int i = int(gl_LocalInvocationIndex);
    s_slot[i] = kNothing;
    if (seen) {
        s_slot[i] = (i_featureOfCode[code >> 1] >> (16 * (code & 1))) & 0xffffu;
        uint weights = u_hasWeights ? texelFetch(u_weights, texel, 0).r : 0u;
        s_weights[3 * i] = 1.0;
        s_weights[3 * i + 1] = float(weights & 0xffffu);
        s_weights[3 * i + 2] = float(weights >> 16);
#if CANDIDATES == 1
        s_visibility[i] = visibility[0];
#else
        for (int n = 0; n < CANDIDATES; ++n) s_visibility[i * CANDIDATES + n] = visibility[n / 4][n % 4];
#endif
        atomicOr(s_someSeen, 1u);
    }
    barrier();
}

void addStaged() {
    int item = int(gl_LocalInvocationIndex) % kItems, segment = int(gl_LocalInvocationIndex) / kItems;
    if (s_someSeen != 0u && segment < SEGMENTS)
        for (int i = segment; i < kGroup; i += SEGMENTS)
            if (s_slot[i] != kNothing)
                s_sums[(int(s_slot[i]) * SEGMENTS + segment) * kItems + item] +=
                    s_visibility[i * CANDIDATES + item % CANDIDATES] * s_weights[3 * i + item / CANDIDATES];
    barrier();
    if (gl_LocalInvocationIndex == 0u) s_someSeen = 0u;
    barrier();
}

void storeSums() {
    int group = int((gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    for (int i = int(gl_LocalInvocationIndex); i < SLOTS * kItems; i += kGroup) {
        float sum = 0.0;
        for (int segment = 0; segment < SEGMENTS; ++segment)
            sum += s_sums[(i / kItems * SEGMENTS + segment) * kItems + i % kItems];
        o_sums[group * SLOTS * kItems + i] = sum;
    }
}
