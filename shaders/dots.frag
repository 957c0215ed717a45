// Coverage of a pixel by a dot, from the distance to its outline in pixels.
#version 330 core
#ifdef ROUGH
#include "lib/dot_shape.glsl"
#endif

in vec2 v_unit;
flat in vec2 v_per_axis;
flat in vec2 v_opacity;
#ifdef ROUGH
flat in vec4 v_rough0, v_rough1, v_rough2, v_rough3;
#endif

out vec2 o_ink;

void main() {
    float t = max(length(v_unit), 1e-6);
    vec2 direction = v_unit / t;
    vec2 gradient = direction;
    float edge = 1.0;
#ifdef ROUGH
    vec4 c[N_HARMONICS / 2] = vec4[](v_rough0, v_rough1, v_rough2, v_rough3);
    vec2 radius = rough_radius(direction, c);
    edge = radius.x;
    gradient += vec2(direction.y, -direction.x) * (radius.y / radius.x);
#endif
    float distance_px = (t - edge) / length(gradient * v_per_axis);
    o_ink = clamp(0.5 - distance_px, 0.0, 1.0) * v_opacity;
}
