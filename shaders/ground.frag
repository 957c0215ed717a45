// How much of a pixel lies to the right of an edge and beside it, counted up or down by the edge's
// direction. Over all edges of an area these add up to how much of the pixel it covers, exactly.
#version 330 core

flat in vec4 v_edge; // pixels

out float o_ink;

// The integral of clamp(u, 0, 1).
float ramp_integral(float u) {
    float inside = clamp(u, 0.0, 1.0);
    return 0.5 * inside * inside + max(u - 1.0, 0.0);
}

void main() {
    vec2 pixel = floor(gl_FragCoord.xy);
    vec2 a = v_edge.xy, b = v_edge.zw;
    float low = clamp(min(a.y, b.y), pixel.y, pixel.y + 1.0);
    float high = clamp(max(a.y, b.y), pixel.y, pixel.y + 1.0);
    if (high <= low) discard;
    float slope = (b.x - a.x) / (b.y - a.y);
    float first = pixel.x + 1.0 - (a.x + (low - a.y) * slope);
    float last = pixel.x + 1.0 - (a.x + (high - a.y) * slope);
    float run = last - first;
    float mean = abs(run) < 1e-2 ? clamp(0.5 * (first + last), 0.0, 1.0)
                                 : (ramp_integral(last) - ramp_integral(first)) / run;
    o_ink = (high - low) * mean * (b.y > a.y ? 1.0 : -1.0);
}
