// Opacity for a step of any length (C++: src/tf/opacity.h; a test compares the two).
//   opticalDepth   -ln(1 - alpha) of one reference length d0, [0, 16.2]
//   steps          the step's length in reference lengths
float opacityOfDepth(float opticalDepth) {
    // 1 - exp(-x) loses its digits where x is small; three terms of the series are exact to float precision there.
    return opticalDepth < 0.01 ? opticalDepth * (1.0 - opticalDepth * (0.5 - opticalDepth * (1.0 / 6.0)))
                               : 1.0 - exp(-opticalDepth);
}

vec4 opacityOfDepth(vec4 x) {
    return vec4(opacityOfDepth(x.x), opacityOfDepth(x.y), opacityOfDepth(x.z), opacityOfDepth(x.w));
}

float opacityOfStep(float opticalDepth, float steps) {
    return opacityOfDepth(opticalDepth * steps);
}
