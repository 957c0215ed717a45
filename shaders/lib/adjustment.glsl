// Darkness as a person adjusts it; the same curve as `Adjustment.apply` in drawing/adjustment.py.

// x: 1 inverts; y: what is taken away; z: factor; w: steepness of the S about the middle grey
float adjusted(float d, vec4 curve, float exponent) {
    d = mix(d, 1.0 - d, curve.x);
    d = clamp((d - curve.y) * curve.z, 0.0, 1.0);
    if (curve.w != 1.0) {
        float dark = pow(d, curve.w), light = pow(1.0 - d, curve.w);
        d = dark / (dark + light);
    }
    return exponent == 1.0 ? d : pow(d, exponent);
}
