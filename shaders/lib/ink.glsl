// How dots add up to ink, at any scale.

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

// Returns the share of a pixel that dots cover which have `sum` pixels of area in it.
// Dots do not overlap until they must, so that is the sum; in the dark, relaxed dots overlap as
// the curve says, which was fitted to drawings (docs/rendering.md). Where pixels are smaller than
// dots (crowding 0), cutting off at 1 is the union.
float covered(float sum, float crowding) {
    float over = max(sum - 0.57, 0.0);
    float overlapping = sum < 1.17 ? min(sum - 0.7 * over * over * over, 1.0) : 1.0;
    return mix(min(sum, 1.0), overlapping, crowding);
}
