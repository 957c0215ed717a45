// The page on the desk, with a soft shadow; colours encoded for display.
#version 330 core

uniform vec2 u_page_mm;
uniform float u_px_per_mm;
uniform vec3 u_paper_color;
uniform vec4 u_shadow; // r, g, b of the desk in shadow; width in pixels

in vec2 v_page_mm;
out vec4 o_color;

// Distance to the rectangle's border in pixels, negative inside.
float outside(vec2 at_mm) {
    vec2 d = abs(at_mm - u_page_mm * 0.5) - u_page_mm * 0.5;
    return (length(max(d, 0.0)) + min(max(d.x, d.y), 0.0)) * u_px_per_mm;
}

void main() {
    float paper = clamp(0.5 - outside(v_page_mm), 0.0, 1.0);
    float shade = 1.0 - smoothstep(-u_shadow.w, u_shadow.w, outside(v_page_mm));
    float alpha = paper + (1.0 - paper) * shade * shade;
    o_color = vec4(mix(u_shadow.rgb, u_paper_color, paper / max(alpha, 1e-6)), alpha);
}
