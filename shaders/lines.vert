// One segment of a line: a quad around the hull of a disc at either end.
// Positions in mm from the page's middle, lengths on screen in pixels with y up.
#version 330 core

uniform mat2 u_page_to_px;
uniform vec2 u_center_mm;  // the page's point at u_middle_px
uniform vec2 u_middle_px;
uniform vec2 u_px_to_clip; // 2 / size of the target
uniform float u_px_per_mm;
#ifdef MARKS
uniform float u_half_px;
#endif

in vec4 a_ends;   // x, y of both ends; mm
in vec2 a_half;   // half widths there; mm
in vec2 a_loose;  // 1 where the line begins or ends, 0 where it goes on

flat out vec4 v_ends; // pixels
flat out vec2 v_half;
flat out vec2 v_loose;

void main() {
    vec2 a = u_page_to_px * (a_ends.xy - u_center_mm) + u_middle_px;
    vec2 b = u_page_to_px * (a_ends.zw - u_center_mm) + u_middle_px;
    v_ends = vec4(a, b);
#ifdef MARKS
    v_half = vec2(u_half_px);
#else
    v_half = a_half * u_px_per_mm;
#endif
    v_loose = a_loose;
    vec2 along = b - a;
    float length_px = length(along);
    along = length_px > 1e-6 ? along / length_px : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    float reach = max(v_half.x, v_half.y) + 1.5;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 at = mix(a - along * reach, b + along * reach, corner.x)
            + across * reach * (2.0 * corner.y - 1.0);
    gl_Position = vec4(at * u_px_to_clip - 1.0, 0.0, 1.0);
}
