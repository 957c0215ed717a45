// Coverage of a pixel by a segment of a line; with MARKS as colour. Segments are joined by the
// largest of their coverages, so a pixel under several of one line is inked once.
#version 330 core

flat in vec4 v_ends; // pixels
flat in vec2 v_half;
flat in vec2 v_loose;

#ifdef MARKS
uniform vec3 u_color;
out vec4 o_color;
#else
out float o_ink;
#endif

// Distance to the hull of discs of radii r.x and r.y whose middles are h apart along x.
float hull_distance(vec2 p, vec2 r, float h) {
    if (h <= abs(r.x - r.y)) {
        return min(length(p) - r.x, length(p - vec2(h, 0.0)) - r.y);
    }
    float slope = (r.x - r.y) / h;
    float flat_part = sqrt(1.0 - slope * slope);
    float k = p.x * flat_part - p.y * slope;
    if (k < 0.0) return length(p) - r.x;
    if (k > flat_part * h) return length(p - vec2(h, 0.0)) - r.y;
    return dot(p, vec2(slope, flat_part)) - r.x;
}

// How much of a pixel lies in a strip narrower than it, or how much is left of a wider one's edge.
float strip(float distance_px, float half_px) {
    return clamp(0.5 - distance_px, 0.0, min(2.0 * half_px, 1.0));
}

void main() {
    vec2 along = v_ends.zw - v_ends.xy;
    float h = length(along);
    along = h > 1e-6 ? along / h : vec2(1.0, 0.0);
    vec2 d = gl_FragCoord.xy - v_ends.xy;
    vec2 p = vec2(dot(d, along), abs(d.y * along.x - d.x * along.y));
    float half_px = mix(v_half.x, v_half.y, clamp(p.x / max(h, 1e-6), 0.0, 1.0));
    float ink = strip(hull_distance(p, v_half, h), half_px);
    // where a fine line ends, its round cap is finer than pixels: its area counts, not its shape
    float out_px = max(-p.x + (v_loose.x - 1.0) * 1e6, p.x - h + (v_loose.y - 1.0) * 1e6);
    float square = strip(p.y - half_px, half_px) * clamp(0.5 + 0.7854 * half_px - out_px, 0.0, 1.0);
    ink = mix(square, ink, max(smoothstep(0.5, 1.5, half_px), float(out_px < -2.0)));
#ifdef MARKS
    o_color = vec4(u_color, ink);
#else
    o_ink = ink;
#endif
}
