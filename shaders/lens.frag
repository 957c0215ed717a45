// A round lens: what is seen through it as light, encoded for display; a rim that is seen on black and
// on white, and a soft shadow. The colour is not multiplied by alpha.
#version 330 core
#include "lib/srgb.glsl"

uniform sampler2D u_seen;
uniform float u_radius_px;
uniform float u_margin_px; // around the lens, for rim and shadow
uniform float u_rim_px;    // width of each of the rim's two lines

out vec4 o_color;

vec4 over(vec4 top, vec4 under) {
    float alpha = top.a + under.a * (1.0 - top.a);
    vec3 color = top.rgb * top.a + under.rgb * under.a * (1.0 - top.a);
    return vec4(color / max(alpha, 1e-6), alpha);
}

// A line along the circle, so far outside the lens.
float line(float outside_px, float at_px) {
    return clamp(0.5 * u_rim_px + 0.5 - abs(outside_px - at_px), 0.0, 1.0);
}

void main() {
    vec2 at = gl_FragCoord.xy - u_margin_px - u_radius_px;
    float outside = length(at) - u_radius_px;
    vec2 sunk = at + vec2(0.0, 0.2 * u_margin_px); // light comes from above
    float shade = 1.0 - smoothstep(0.0, 0.8 * u_margin_px, length(sunk) - u_radius_px);
    vec3 seen = encoded(texelFetch(u_seen, ivec2(gl_FragCoord.xy - u_margin_px), 0).rgb);
    vec4 color = vec4(0.0, 0.0, 0.0, 0.35 * shade * shade);
    color = over(vec4(seen, clamp(0.5 - outside, 0.0, 1.0)), color);
    color = over(vec4(vec3(1.0), line(outside, 0.5 * u_rim_px)), color);
    color = over(vec4(vec3(0.08), 0.85 * line(outside, 1.5 * u_rim_px)), color);
    o_color = color;
}
