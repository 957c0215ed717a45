// Lays the ink gathered from all dots on the page, in encoded (display) colour.
#version 330 core

uniform sampler2D u_ink;
uniform int u_margin_px; // of the gathered ink around the picture
uniform vec3 u_ink_color;

out vec4 o_color;

void main() {
    float ink = texelFetch(u_ink, ivec2(gl_FragCoord.xy) + u_margin_px, 0).r;
    o_color = vec4(u_ink_color, min(ink, 1.0));
}
