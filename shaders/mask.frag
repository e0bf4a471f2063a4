// mask.frag: one piece of a stroke, along a parabola, into the alpha channel alone.
// in   frame     its middle, px; unit vector x along it, y across
//      shape     half its length and half the stroke's width, px; opacity in the middle, 0…1, and its slope in x, 1/px
//      params    slope of half the width in x; reach of the glow beyond the edge in the middle, px, and its slope in x;
//                the piece draws |x| up to this, px: the next one goes on there
//      parabola  the line's y at x = 0, px, and c in y = y(0) - c x², 1/px
// out  color.a   1 - opacity of the stroke here, 0…1; blending keeps the smallest
#version 330 core
flat in vec4 frame;
flat in vec4 shape;
flat in vec4 params;
flat in vec2 parabola;
out vec4 color;

void main() {
    vec2 from = gl_FragCoord.xy - frame.xy;
    vec2 local = vec2(dot(from, frame.zw), frame.z * from.y - frame.w * from.x);
    float along = clamp(local.x, -shape.x, shape.x);
    float slope = 2.0 * parabola.y * along, square = slope * slope;
    // to the line's tangent, or to its end; cos(atan(slope)), to 1e-4 where it is no steeper than 1/4
    float cosine = 1.0 - square * (0.5 - 0.375 * square);
    vec2 beside = vec2(local.x - along, (local.y - parabola.x + parabola.y * along * along) * cosine);
    float distance = length(beside) - (shape.y + params.x * along);
    float opacity = shape.z + shape.w * along;
    float covered = clamp(0.5 - distance, 0.0, 1.0);
    if (params.y > 0.0) {
        float dim = clamp(1.0 - distance / max(params.y + params.z * along, 0.01), 0.0, 1.0);
        covered += (1.0 - covered) * dim * dim * (1.0 / 3.0);
    }
    color = vec4(abs(local.x) > params.w ? 1.0 : 1.0 - opacity * covered);
}
