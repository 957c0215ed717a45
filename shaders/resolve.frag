// Lays the ink gathered from all dots on the page, in encoded (display) colour.
#version 330 core

uniform sampler2D u_ink;
uniform vec3 u_ink_color;

out vec4 o_color;

void main() {
    vec2 ink = texelFetch(u_ink, ivec2(gl_FragCoord.xy), 0).rg;
    o_color = vec4(u_ink_color, min(ink.r, 1.0));
}
