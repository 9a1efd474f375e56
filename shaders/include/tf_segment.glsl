// The transfer function as two tables of (tau * rgb, tau), tau the optical depth of d0: first its entries, then the
// running integral over them. 256 texels per row, read without filtering: steps stay steps.
layout(binding = 1) uniform sampler2D u_tfTable;
layout(location = 0) uniform float u_entriesPerCode; // table index of code/65535 = 1
layout(location = 12) uniform int u_integralStart;   // where the running integral begins

vec4 tfTexel(int index) {
    return texelFetch(u_tfTable, ivec2(index & 255, index >> 8), 0);
}

// Mean of (tau * rgb, tau) while the code goes linearly from one value to another.
vec4 tfMean(float code0, float code1) {
    int low = int(min(code0, code1) * u_entriesPerCode + 0.5);
    int high = int(max(code0, code1) * u_entriesPerCode + 0.5);
    // The integrals of neighbours differ by less than floats can tell.
    if (high - low < 16) return tfTexel((low + high) / 2);
    return (tfTexel(u_integralStart + high) - tfTexel(u_integralStart + low)) / float(high - low);
}
