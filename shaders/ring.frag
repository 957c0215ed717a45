// A brush's outline: the true radius lies where a dark line meets a light one, so that it is seen
// on black and on white.
#version 330 core

uniform vec4 u_ring;

in vec2 v_offset_px;
out vec4 o_color;

void main() {
    float away = length(v_offset_px) - u_ring.z;
    float width = u_ring.w;
    float alpha = clamp(width + 0.5 - abs(away), 0.0, 1.0);
    float light = clamp(away + 0.5, 0.0, 1.0);
    o_color = vec4(vec3(mix(0.08, 1.0, light)), alpha * 0.9);
}
