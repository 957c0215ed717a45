// How dots add up to ink, at any scale.

const float MIN_AXIS_PX = 0.53; // narrower dots are widened and paled
const float ROUGH_FROM_PX = 1.0, ROUGH_FULL_PX = 2.5; // short half axis; below, outlines are smooth

// Returns half axes that, drawn with an edge ramp one pixel wide, give opacity * axes the true area.
vec2 drawn_axes(float radius_px, float elongation, out float opacity) {
    float root = sqrt(elongation);
    vec2 true_axes = radius_px * vec2(root, 1.0 / root);
    vec2 axes = max(true_axes, MIN_AXIS_PX);
    float area = axes.x * axes.y;
    opacity = true_axes.x * true_axes.y / area;
    // Along every ray the ramp adds a 24th of its squared width in units of the radius; over the
    // whole turn that makes pi / 24 * (a / b + b / a) more than the area pi a b.
    float ratio = axes.x / axes.y;
    return axes * sqrt(1.0 - (ratio + 1.0 / ratio) / (24.0 * area));
}

// Returns the opacity that a dot gives up for lying on others, where pixels are as large as dots:
// there a pixel cannot tell ink laid twice from ink laid side by side. `share` is what the dot adds
// to the union of all; a dot of several pixels keeps its opacity, as ink beyond 1 is cut off.
float shared_opacity(float share, float radius_px) {
    if (share >= 1.0) return 1.0;
    return pow(share, 1.0 / (1.0 + radius_px * radius_px * sqrt(radius_px)));
}
