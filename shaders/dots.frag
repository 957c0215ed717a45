// Coverage of a pixel by a dot, from the distance to its outline in pixels; with MARKS as colour.
#version 330 core
#include "lib/dot_shape.glsl"

flat in vec4 v_dot;
#ifndef ROUND
flat in vec4 v_to_unit;
#endif
#ifdef ROUGH
flat in vec4 v_rough0, v_rough1, v_rough2, v_rough3;
#endif

#ifdef MARKS
flat in vec3 v_color;
out vec4 o_color;
#else
out float o_ink;
#endif

void main() {
    vec2 offset = gl_FragCoord.xy - v_dot.xy;
#ifdef ROUND
    float distance_px = length(offset) - v_dot.z;
    float opacity = v_dot.w;
#else
    mat2 to_unit = mat2(v_to_unit.xy, v_to_unit.zw);
    vec2 unit = to_unit * offset;
    float t = max(length(unit), 1e-6);
    vec2 direction = unit / t;
    vec2 gradient = direction;
    float edge = 1.0;
    float opacity = v_dot.z;
#ifdef ROUGH
    vec4 c[N_HARMONICS / 2] = vec4[](v_rough0, v_rough1, v_rough2, v_rough3);
    vec2 radius = rough_radius(direction, c);
    edge = radius.x;
    gradient += vec2(direction.y, -direction.x) * (radius.y / radius.x);
#endif
    float distance_px = (t - edge) / length(gradient * to_unit);
#endif
    float ink = clamp(0.5 - distance_px, 0.0, 1.0) * opacity;
#ifdef MARKS
    o_color = vec4(v_color, ink);
#else
    o_ink = ink;
#endif
}
