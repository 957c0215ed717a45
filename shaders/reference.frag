// The reference picture on the page: its darkness as grey ink of the given opacity.
#version 330 core

uniform sampler2D u_darkness;
uniform vec2 u_size_mm;
uniform float u_opacity;
uniform vec3 u_ink_color;

in vec2 v_page_mm;
out vec4 o_color;

void main() {
    o_color = vec4(u_ink_color, texture(u_darkness, v_page_mm / u_size_mm).r * u_opacity);
}
