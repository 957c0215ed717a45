// A frame around the middle of the page, or all of it where the hole has no size: ten corners,
// outer and inner by turns.
#version 330 core

uniform mat3 u_page_to_clip;
uniform vec4 u_outer_mm; // left, top, right, bottom
uniform vec4 u_inner_mm;

out vec2 v_page_mm;

void main() {
    int turn = (gl_VertexID >> 1) & 3;
    vec2 corner = vec2(turn == 1 || turn == 2, turn >= 2);
    vec4 edges = (gl_VertexID & 1) == 0 ? u_outer_mm : u_inner_mm;
    v_page_mm = mix(edges.xy, edges.zw, corner);
    gl_Position = vec4((u_page_to_clip * vec3(v_page_mm, 1.0)).xy, 0.0, 1.0);
}
