// A dot's shape as the drawing has it, and as a change of shape under way would leave it.
// The same formulas in Python: stippler/drawing/pens.py. Needs lib/dot_shape.glsl.

const uint FLAG_FIXED = 1u, FLAG_SELECTED = 2u;
const int PREVIEW_NONE = 0, PREVIEW_ALL = 1, PREVIEW_SELECTED = 2, PREVIEW_TIP = 3;
const float PI = 3.14159265359;

uniform int u_preview;
uniform vec4 u_tip;       // center and radius, mm from the page's middle; hardness
uniform vec2 u_radius;    // factor and addend, mm
uniform vec4 u_form;      // factor and addend of elongation, of roughness
uniform vec3 u_turn;      // 1 to turn towards an angle, that angle, how far dots scatter; rad

struct Shape {
    float elongation;
    float angle; // rad, from x towards y
    float roughness;
    uint seed;
    uint flags;
    float share; // of the dot's area, counted in the union of all dots
};

Shape unpack_shape(uvec3 packed_shape) {
    Shape s;
    s.elongation = 1.0 + float(packed_shape.x & 0xffffu) * (3.0 / 65535.0);
    s.angle = float(packed_shape.x >> 16u) * (2.0 * PI / 65536.0);
    s.roughness = float(packed_shape.y & 0xffffu) / 65535.0;
    s.flags = (packed_shape.y >> 16u) & 0xffu;
    s.share = float(packed_shape.y >> 24u) / 255.0;
    s.seed = packed_shape.z;
    return s;
}

float preview_weight(vec2 position_mm, uint flags) {
    if (u_preview == PREVIEW_SELECTED) return (flags & FLAG_SELECTED) != 0u ? 1.0 : 0.0;
    if (u_preview != PREVIEW_TIP) return 1.0;
    float away = distance(position_mm, u_tip.xy) / u_tip.z;
    float t = clamp((1.0 - away) / max(1.0 - u_tip.w, 1e-3), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

void deform(vec2 position_mm, inout float radius_mm, inout Shape s) {
    if (u_preview == PREVIEW_NONE) return;
    float w = preview_weight(position_mm, s.flags);
    radius_mm = mix(radius_mm, clamp(radius_mm * u_radius.x + u_radius.y, 1e-3, 1e3), w);
    s.elongation = mix(s.elongation, clamp(s.elongation * u_form.x + u_form.y, 1.0, 4.0), w);
    s.roughness = mix(s.roughness, clamp(s.roughness * u_form.z + u_form.w, 0.0, 1.0), w);
    float dice = float(hash(s.seed ^ 0x5bd1e995u) >> 8u) / 16777216.0;
    float turn = u_turn.x * (u_turn.y - s.angle) + (2.0 * dice - 1.0) * u_turn.z;
    s.angle += w * (turn - PI * floor(turn / PI + 0.5));
}
