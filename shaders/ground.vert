// What an edge of an area adds to the area's coverage: a quad from the edge to the area's right end.
// Positions in mm from the page's middle, lengths on screen in pixels with y up.
#version 330 core

uniform mat2 u_page_to_px;
uniform vec2 u_center_mm;  // the page's point at u_middle_px
uniform vec2 u_middle_px;
uniform vec2 u_px_to_clip; // 2 / size of the target

in vec4 a_edge; // x, y of both ends; mm
in vec4 a_box;  // left, top, right, bottom of the area; mm

flat out vec4 v_edge; // pixels

vec2 to_px(vec2 at_mm) {
    return u_page_to_px * (at_mm - u_center_mm) + u_middle_px;
}

void main() {
    vec2 a = to_px(a_edge.xy), b = to_px(a_edge.zw);
    v_edge = vec4(a, b);
    float right = max(max(to_px(a_box.xy).x, to_px(a_box.zw).x), max(to_px(a_box.xw).x, to_px(a_box.zy).x));
    vec2 low = floor(min(a, b)), high = vec2(ceil(right), ceil(max(a.y, b.y)));
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(mix(low, high, corner) * u_px_to_clip - 1.0, 0.0, 1.0);
}
