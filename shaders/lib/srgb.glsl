// Light to the numbers a display takes.

vec3 encoded(vec3 light) {
    vec3 low = light * 12.92;
    vec3 high = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(light, vec3(0.0031308)));
}
