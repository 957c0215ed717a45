// The outline of a dot: a rough circle of area pi, squeezed into an ellipse of area pi.
//
// In polar coordinates of the unsqueezed shape, radius(phi)^2 = 1 + sum over k = 2..9 of
// x_k cos(k phi) + y_k sin(k phi), so its area is pi whatever the coefficients. They come from the
// dot's seed by integer hashing; the sum of their lengths is roughness * MAX_ROUGH < 1, so the
// outline never crosses itself. The same formula in Python: stippler/kernels/shapes/dot_shape.py.

const int N_HARMONICS = 8;
const float MAX_ROUGH = 0.9;
const float WEIGHTS[N_HARMONICS] = float[](1.0, 0.9, 0.8, 0.6, 0.5, 0.4, 0.35, 0.3);

uint hash(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

// Coefficients (x_k, y_k) for k = 2..9, two harmonics in each vec4.
void rough_coefficients(uint seed, float roughness, out vec4 c[N_HARMONICS / 2]) {
    float total = 1e-6;
    for (int i = 0; i < N_HARMONICS; i += 2) {
        uint p = hash(seed + uint(i + 1) * 0x9e3779b9u);
        uint q = hash(seed + uint(i + 2) * 0x9e3779b9u);
        vec4 h = vec4(p & 0xffffu, p >> 16u, q & 0xffffu, q >> 16u) / 32767.5 - 1.0;
        h *= vec4(vec2(WEIGHTS[i]), vec2(WEIGHTS[i + 1]));
        total += length(h.xy) + length(h.zw);
        c[i / 2] = h;
    }
    for (int i = 0; i < N_HARMONICS / 2; i++) c[i] *= roughness * MAX_ROUGH / total;
}

// Return radius(phi) and its derivative by phi, for a unit vector (cos phi, sin phi).
vec2 rough_radius(vec2 direction, vec4 c[N_HARMONICS / 2]) {
    vec2 z = direction;
    float n = 0.0, slope = 0.0;
    for (int i = 0; i < N_HARMONICS / 2; i++) {
        float k = float(2 * i + 2);
        z = vec2(z.x * direction.x - z.y * direction.y, z.x * direction.y + z.y * direction.x);
        n += dot(c[i].xy, z);
        slope += k * (c[i].y * z.x - c[i].x * z.y);
        z = vec2(z.x * direction.x - z.y * direction.y, z.x * direction.y + z.y * direction.x);
        n += dot(c[i].zw, z);
        slope += (k + 1.0) * (c[i].w * z.x - c[i].z * z.y);
    }
    float radius = sqrt(1.0 + n);
    return vec2(radius, slope / (2.0 * radius));
}
