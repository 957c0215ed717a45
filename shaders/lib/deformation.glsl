// A dot's shape as the drawing has it, and as a brush that hovers over it would leave it.

struct Shape {
    float elongation;
    float angle; // rad, from x towards y
    float roughness;
    uint seed;
    uint flags; // 1 fixed, 2 selected
};

Shape unpack_shape(uvec3 packed_shape) {
    Shape s;
    s.elongation = 1.0 + float(packed_shape.x & 0xffffu) * (3.0 / 65535.0);
    s.angle = float(packed_shape.x >> 16u) * (6.28318530718 / 65536.0);
    s.roughness = float(packed_shape.y & 0xffffu) / 65535.0;
    s.flags = packed_shape.y >> 16u;
    s.seed = packed_shape.z;
    return s;
}

void deform(vec2 position_mm, inout float radius_mm, inout Shape s) {
}
