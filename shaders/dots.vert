// One dot, as a point sprite (POINTS) or an instanced quad; ROUND, or any ellipse, or ROUGH.
// With MARKS only fixed and selected
// dots; with POLARITY only those painted alike. Positions in mm from the page's middle, lengths on screen in pixels with y up.
#version 330 core
#include "lib/dot_shape.glsl"
#include "lib/deformation.glsl"
#include "lib/ink.glsl"

uniform mat2 u_page_to_px;
uniform vec2 u_center_mm;   // the page's point at u_middle_px
uniform vec2 u_middle_px;
uniform vec2 u_px_to_clip;  // 2 / size of the target
uniform float u_px_per_mm;
#ifdef POINTS
uniform float u_largest_mm; // larger ones are drawn as quads
#endif

#ifdef POLARITY
uniform int u_paint; // FLAG_IN_WHITE: only white dots; 0: only black ones
#endif

#ifdef MARKS
uniform vec3 u_fixed_color;
uniform vec3 u_selected_color;
flat out vec3 v_color;
#endif

in vec3 a_dot;    // x, y, radius; mm
in uvec3 a_shape; // see unpack_shape

#ifdef ROUND
flat out vec4 v_dot; // center, radius, opacity
#else
flat out vec4 v_dot; // center, opacity, unused
flat out vec4 v_to_unit; // columns of the matrix from pixels to the unsqueezed shape
#endif
#ifdef ROUGH
flat out vec4 v_rough0, v_rough1, v_rough2, v_rough3;
#endif

void main() {
    Shape shape = unpack_shape(a_shape);
    float radius_mm = a_dot.z;
#ifdef PREVIEW
    deform(a_dot.xy, radius_mm, shape);
#endif
    vec2 center = u_page_to_px * (a_dot.xy - u_center_mm) + u_middle_px;
    float opacity;
    float paling = shared_opacity(shape.share, radius_mm * u_px_per_mm);
#ifdef ROUND
    vec2 axes = drawn_axes(radius_mm * u_px_per_mm, 1.0, opacity);
    vec2 half_size = axes + 0.5;
    v_dot = vec4(center, axes.x, opacity * paling);
#else
    vec2 axes = drawn_axes(radius_mm * u_px_per_mm, shape.elongation, opacity);
    vec2 along = u_page_to_px * vec2(cos(shape.angle), sin(shape.angle)) / u_px_per_mm;
    vec2 across = u_page_to_px * vec2(-sin(shape.angle), cos(shape.angle)) / u_px_per_mm;
    v_dot = vec4(center, opacity * paling, 0.0);
    vec2 a = along / axes.x, b = across / axes.y;
    v_to_unit = vec4(a.x, b.x, a.y, b.y);
    float bulge = 1.0;
#ifdef ROUGH
    vec4 c[N_HARMONICS / 2];
    float seen = shape.roughness * smoothstep(ROUGH_FROM_PX, ROUGH_FULL_PX, axes.y); // finer than pixels: not drawn
    rough_coefficients(shape.seed, seen, c);
    v_rough0 = c[0];
    v_rough1 = c[1];
    v_rough2 = c[2];
    v_rough3 = c[3];
    bulge = sqrt(1.0 + seen * MAX_ROUGH);
#endif
    vec2 half_size = bulge * sqrt(along * along * axes.x * axes.x + across * across * axes.y * axes.y)
        + 0.5;
#endif
#ifdef POINTS
    gl_PointSize = 2.0 * max(half_size.x, half_size.y) + 0.0625;
    if (a_dot.z > u_largest_mm) center = vec2(-1e6);
#else
    center += (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * half_size;
#endif
#ifdef MARKS
    bool is_selected = (shape.flags & FLAG_SELECTED) != 0u;
    v_color = is_selected ? u_selected_color : u_fixed_color;
    bool is_marked = (shape.flags & (FLAG_FIXED | FLAG_SELECTED)) != 0u;
    if (!is_marked || (shape.flags & FLAG_UNSEEN) != 0u) center = vec2(-1e6);
#endif
#ifdef POLARITY
    if ((shape.flags & (FLAG_IN_WHITE | FLAG_UNSEEN)) != uint(u_paint)) center = vec2(-1e6);
#endif
    gl_Position = vec4(center * u_px_to_clip - 1.0, 0.0, 1.0);
}
