// Lays the ink gathered from all dots on the page, in encoded (display) colour. With INVERSE a ground of
// ink, too, less the white dots on it.
#version 330 core

uniform sampler2D u_ink;
uniform int u_margin_px;   // of the gathered ink around the picture
uniform vec3 u_ink_color;
uniform vec4 u_ground;     // what lies under the ink; alpha 0: whatever the target holds
#ifdef INVERSE
uniform sampler2D u_black; // coverage by areas of white dots, of either sign
uniform sampler2D u_white; // their dots
#endif

out vec4 o_color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) + u_margin_px;
    float ink = texelFetch(u_ink, at, 0).r;
#ifdef INVERSE
    float black = min(abs(texelFetch(u_black, at, 0).r), 1.0);
    ink = min(ink, 1.0) + black * (1.0 - min(texelFetch(u_white, at, 0).r, 1.0));
#endif
    ink = min(ink, 1.0);
    o_color = u_ground.a > 0.0 ? vec4(mix(u_ground.rgb, u_ink_color, ink), 1.0)
                               : vec4(u_ink_color, ink);
}
