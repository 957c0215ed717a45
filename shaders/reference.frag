// The reference picture on the page: its darkness, adjusted, as grey ink of the given opacity.
#version 330 core
#include "lib/adjustment.glsl"

uniform sampler2D u_darkness;
uniform vec2 u_size_mm;
uniform float u_opacity;
uniform vec3 u_ink_color;
uniform float u_px_per_mm;
uniform vec4 u_curve; // see adjusted
uniform float u_exponent;

in vec2 v_page_mm;
out vec4 o_color;

void main() {
    vec2 inside = min(v_page_mm, u_size_mm - v_page_mm) * u_px_per_mm;
    float edge = clamp(min(inside.x, inside.y) + 0.5, 0.0, 1.0);
    float darkness = texture(u_darkness, v_page_mm / u_size_mm).r;
    darkness = adjusted(darkness, u_curve, u_exponent);
    o_color = vec4(u_ink_color, darkness * u_opacity * edge);
}
