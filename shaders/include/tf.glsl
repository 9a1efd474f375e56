// A table of the transfer function, 256 entries per row, read without filtering: steps stay steps.
layout(binding = 1) uniform sampler2D u_tfTable;
layout(location = 0) uniform float u_entriesPerCode; // table index of code/65535 = 1

vec4 tfEntry(float code) {
    int index = int(code * u_entriesPerCode + 0.5);
    return texelFetch(u_tfTable, ivec2(index & 255, index >> 8), 0);
}
