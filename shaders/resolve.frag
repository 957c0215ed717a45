// Lays the ink gathered from all dots on the page, in encoded (display) colour.
#version 330 core

uniform sampler2D u_ink;
uniform int u_margin_px;   // of the gathered ink around the picture
uniform vec3 u_ink_color;
uniform vec4 u_ground;     // what lies under the ink; alpha 0: whatever the target holds

out vec4 o_color;

void main() {
    float ink = min(texelFetch(u_ink, ivec2(gl_FragCoord.xy) + u_margin_px, 0).r, 1.0);
    o_color = u_ground.a > 0.0 ? vec4(mix(u_ground.rgb, u_ink_color, ink), 1.0)
                               : vec4(u_ink_color, ink);
}
