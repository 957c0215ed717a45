// The square around a ring on the screen.
#version 330 core

uniform vec4 u_ring;      // center (pixels, y up), radius and line width in pixels
uniform vec2 u_px_to_clip;

out vec2 v_offset_px;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    v_offset_px = corner * (u_ring.z + 2.0 * u_ring.w + 1.0);
    gl_Position = vec4((u_ring.xy + v_offset_px) * u_px_to_clip - 1.0, 0.0, 1.0);
}
