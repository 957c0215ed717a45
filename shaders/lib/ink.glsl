// How a dot is drawn at a scale: its half axes in pixels and its opacity, so that its ink is kept.

const float MIN_AXIS_PX = 0.6; // narrower dots are widened and paled
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
