// Dots as instanced tight quads. Positions in mm from the page's middle; lengths on screen in
// pixels, y down. Writes coverage, not colour.
#version 330 core
#ifdef ROUGH
#include "lib/dot_shape.glsl"
#endif
#include "lib/deformation.glsl"

uniform mat2 u_page_to_px;   // mm to pixels, a turn, a mirror and a scale
uniform vec2 u_center_mm;    // the page's point in the middle of the screen
uniform vec2 u_px_to_clip;   // (2 / width, -2 / height)
uniform float u_px_per_mm;

in vec3 a_dot;    // x, y, radius; mm
in uvec3 a_shape; // elongation | angle << 16, roughness | flags << 16, seed

out vec2 v_unit;            // in units of the half axes
flat out vec2 v_per_axis;   // 1 / half axes, 1/px
flat out vec2 v_opacity;    // opacity, and the same times how far the dot is below a pixel
#ifdef ROUGH
flat out vec4 v_rough0, v_rough1, v_rough2, v_rough3;
#endif

const float MIN_AXIS_PX = 0.6; // narrower dots are widened and paled, so their ink stays the same

void main() {
    Shape shape = unpack_shape(a_shape);
    float radius_mm = a_dot.z;
    deform(a_dot.xy, radius_mm, shape);
    float radius = radius_mm * u_px_per_mm;
    vec2 true_axes = radius * vec2(sqrt(shape.elongation), inversesqrt(shape.elongation));
    vec2 axes = max(true_axes, MIN_AXIS_PX);
    float opacity = min(true_axes.x * true_axes.y / (axes.x * axes.y), 1.0);
    // An edge ramp of one pixel adds (a / b + b / a) / 24 to the area a b: take it off.
    float ratio = axes.x / axes.y;
    axes *= sqrt(1.0 - (ratio + 1.0 / ratio) / (24.0 * axes.x * axes.y));

    float reach = 1.0;
#ifdef ROUGH
    vec4 c[N_HARMONICS / 2];
    float seen = smoothstep(0.75, 2.0, axes.y); // finer than pixels: not drawn
    rough_coefficients(shape.seed, shape.roughness * seen, c);
    v_rough0 = c[0]; v_rough1 = c[1]; v_rough2 = c[2]; v_rough3 = c[3];
    reach = sqrt(1.0 + shape.roughness * seen * MAX_ROUGH);
#endif
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 local = corner * (axes * reach + 0.5);
    vec2 along = vec2(cos(shape.angle), sin(shape.angle));
    vec2 page = along * local.x + vec2(-along.y, along.x) * local.y;
    vec2 px = u_page_to_px * (a_dot.xy - u_center_mm + page / u_px_per_mm);
    gl_Position = vec4(px * u_px_to_clip, 0.0, 1.0);
    v_unit = local / axes;
    v_per_axis = 1.0 / axes;
    v_opacity = vec2(opacity);
}
