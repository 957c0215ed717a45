// A dot's shape as the drawing has it, and as a change of shape under way would leave it.
// The same formulas in Python: stippler/drawing/shape_change.py and stippler/brushes/tip.py.
// Needs lib/dot_shape.glsl.
//
// With PREVIEW a change is under way; with TIP it is for the dots under a brush, with EDGES it goes
// by a reference's edges. Defines and not values, as software GL takes every branch.

const uint FLAG_FIXED = 1u, FLAG_SELECTED = 2u, FLAG_IN_WHITE = 4u, FLAG_UNSEEN = 8u;
const float PI = 3.14159265359;

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

#ifdef PREVIEW
const float MIN_RADIUS_MM = 0.005, MAX_RADIUS_MM = 50.0;
uniform vec2 u_radius;      // factor and addend, mm
#ifndef ROUND
uniform vec3 u_elongation;  // factor, addend, spread
uniform vec4 u_turn;        // 1 to turn towards a direction; angle, scatter; stretch
#endif
#ifdef ROUGH
uniform vec3 u_roughness;
#endif
#ifndef TIP
uniform bool u_selected_only;
#endif

#ifdef TIP
const int TIP_SQUARE = 1, TIP_POLYGON = 2;
const int MOST_CORNERS = 32;
uniform vec3 u_tip;         // centre, mm from the page's middle; how far it reaches
uniform vec4 u_tip_to_unit; // rows of the matrix to the tip's own coordinates
uniform vec3 u_tip_effect;  // hardness, strength, a polygon's depth
uniform ivec2 u_tip_outline; // 0 or one of the above; how many corners
uniform vec2 u_corners[MOST_CORNERS];

// Distance from a polygon's border, negative outside it.
float depth_in_polygon(vec2 at) {
    float least = 1e9;
    bool inside = false;
    for (int i = 0; i < u_tip_outline.y; i++) {
        vec2 a = u_corners[i], b = u_corners[i + 1 < u_tip_outline.y ? i + 1 : 0];
        vec2 along = b - a;
        float t = clamp(dot(at - a, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
        least = min(least, distance(at, a + t * along));
        if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) * along.x / along.y)
            inside = !inside;
    }
    return inside ? least : -least;
}

float tip_weight(vec2 position_mm) {
    vec2 offset = position_mm - u_tip.xy;
    if (abs(offset.x) > u_tip.z || abs(offset.y) > u_tip.z) return 0.0;
    vec2 unit = vec2(dot(u_tip_to_unit.xy, offset), dot(u_tip_to_unit.zw, offset));
    float level = length(unit);
    if (u_tip_outline.x == TIP_SQUARE) level = max(abs(unit.x), abs(unit.y));
    if (u_tip_outline.x == TIP_POLYGON) level = 1.0 - depth_in_polygon(unit) / u_tip_effect.z;
    if (u_tip_effect.x >= 1.0) return level <= 1.0 ? u_tip_effect.y : 0.0;
    float t = clamp((1.0 - level) / (1.0 - u_tip_effect.x), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t) * u_tip_effect.y;
}

#endif

float preview_weight(vec2 position_mm, uint flags) {
#ifdef TIP
    return tip_weight(position_mm);
#else
    return !u_selected_only || (flags & FLAG_SELECTED) != 0u ? 1.0 : 0.0;
#endif
}

#ifndef ROUND
float dice(uint seed, uint salt) { return float(hash(seed ^ salt) >> 8u) / 16777216.0; }

float stepped(float old, vec3 change, float w, uint seed, uint salt) {
    float goal = old * change.x + change.y;
    if (change.z != 0.0) goal += change.z * dice(seed, salt);
    return old + w * (goal - old);
}

// The turn to the same axis, the shorter way; the cut lies where exact angles do not.
float shorter(float turn) { return turn - PI * floor(turn / PI + 0.45); }

#ifdef EDGES
uniform vec4 u_edges;       // reach and pixel of the reference, mm; its top left from the middle
uniform sampler2D u_darkness;

float darkness_at(vec2 position_mm) {
    ivec2 last = textureSize(u_darkness, 0) - 1;
    vec2 at = clamp((position_mm - u_edges.zw) / u_edges.y - 0.5, vec2(0.0), vec2(last));
    ivec2 i = ivec2(at), j = min(i + 1, last);
    vec2 t = at - vec2(i);
    float a = texelFetch(u_darkness, i, 0).r, b = texelFetch(u_darkness, ivec2(j.x, i.y), 0).r;
    float c = texelFetch(u_darkness, ivec2(i.x, j.y), 0).r, d = texelFetch(u_darkness, j, 0).r;
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

float along_edge(vec2 position_mm, float own) {
    vec2 slope = vec2(0.0);
    for (int i = 0; i < 8; i++) {
        vec2 away = vec2(cos(float(i) * PI / 4.0), sin(float(i) * PI / 4.0));
        slope += away * darkness_at(position_mm + u_edges.x * away);
    }
    return length(slope) <= 1.0 / 512.0 ? own : atan(slope.y, slope.x) + PI / 2.0;
}
#endif

float goal_angle(vec2 position_mm, Shape s) {
#ifdef EDGES
    float goal = along_edge(position_mm, s.angle);
#else
    float goal = u_turn.x > 0.0 ? u_turn.y : s.angle;
#endif
    return goal + (2.0 * dice(s.seed, 0x5bd1e995u) - 1.0) * u_turn.z;
}

void turn(vec2 position_mm, float w, inout Shape s) {
    if (u_turn.x == 0.0 && u_turn.z == 0.0 && u_turn.w == 0.0) return;
    float goal = goal_angle(position_mm, s);
    if (u_turn.w == 0.0) {
        s.angle += w * shorter(goal - s.angle);
        return;
    }
    vec2 v = (s.elongation - 1.0) * vec2(cos(2.0 * s.angle), sin(2.0 * s.angle))
        + u_turn.w * w * vec2(cos(2.0 * goal), sin(2.0 * goal));
    float size = length(v);
    if (size > 1e-6) s.angle += shorter(0.5 * atan(v.y, v.x) - s.angle);
    s.elongation = clamp(1.0 + size, 1.0, 4.0);
}
#endif

void deform(vec2 position_mm, inout float radius_mm, inout Shape s) {
    float w = preview_weight(position_mm, s.flags);
    if (w == 0.0) return;
    float goal = max(radius_mm * u_radius.x + u_radius.y, MIN_RADIUS_MM);
    radius_mm = clamp(radius_mm * pow(goal / radius_mm, w), MIN_RADIUS_MM, MAX_RADIUS_MM);
#ifndef ROUND
    s.elongation = clamp(stepped(s.elongation, u_elongation, w, s.seed, 0x27d4eb2fu), 1.0, 4.0);
#ifdef ROUGH
    s.roughness = clamp(stepped(s.roughness, u_roughness, w, s.seed, 0x165667b1u), 0.0, 1.0);
#endif
    turn(position_mm, w, s);
#endif
}
#endif
