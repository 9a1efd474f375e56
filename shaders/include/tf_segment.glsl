// The transfer function as two tables of (tau * rgb, tau), tau the optical depth of d0: first its entries, then the
// running integral over them. 256 texels per row, read without filtering: steps stay steps.
layout(binding = 1) uniform sampler2D u_tfTable;
layout(location = 0) uniform float u_entriesPerCode; // table index of code/65535 = 1
layout(location = 12) uniform int u_integralStart;   // where the running integral begins

vec4 tfTexel(int index) {
    return texelFetch(u_tfTable, ivec2(index & 255, index >> 8), 0);
}

// Where a code stands in the tables.
struct TfPlace {
    int entry;
    vec4 integral;
};

TfPlace tfPlace(float code) {
    int entry = int(code * u_entriesPerCode + 0.5);
    return TfPlace(entry, tfTexel(u_integralStart + entry));
}

// The running integral of tau up to a place in the table.
float tfIntegral(float entry) {
    return tfTexel(u_integralStart + clamp(int(entry + 0.5), 0, u_integralStart - 1)).a;
}

// Mean of (tau * rgb, tau) while the code goes linearly from one place to another.
vec4 tfMean(TfPlace a, TfPlace b) {
    int way = b.entry - a.entry;
    // The integrals of neighbours differ by less than floats can tell.
    if (abs(way) < 16) return tfTexel((a.entry + b.entry) / 2);
    return (b.integral - a.integral) * (1.0 / float(way));
}
