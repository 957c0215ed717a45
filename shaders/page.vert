// A rectangle of the page, with the pixel each fragment falls on.
#version 330 core

uniform mat3 u_page_to_clip;
uniform vec4 u_rect_mm; // left, top, right, bottom

out vec2 v_page_mm;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    v_page_mm = mix(u_rect_mm.xy, u_rect_mm.zw, corner);
    gl_Position = vec4((u_page_to_clip * vec3(v_page_mm, 1.0)).xy, 0.0, 1.0);
}
