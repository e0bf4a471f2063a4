// mask.frag: one piece of a stroke, along a parabola, into the alpha channel alone.
// in   place  its middle, px; unit vector along it
//      shape  half its length and half the stroke's width, px; opacity in the middle, 0…1, and its slope along, 1/px
//      more   slope of half the width along; how far a glow reaches beyond the edge in the middle, px, and its slope;
//             how far from the middle along it the piece answers for its stroke, px: the next one goes on there
//      bow    how far beside the middle its line lies there, px, and what it loses with the square of the way, 1/px
// out  color.a  how transparent the stroke is here, 0…1; the smallest value stays
#version 330 core
flat in vec4 place;
flat in vec4 shape;
flat in vec4 more;
flat in vec2 bow;
out vec4 color;

void main() {
    vec2 from = gl_FragCoord.xy - place.xy;
    vec2 local = vec2(dot(from, place.zw), place.z * from.y - place.w * from.x);
    float along = clamp(local.x, -shape.x, shape.x);
    float slope = 2.0 * bow.y * along, square = slope * slope;
    // to the line's tangent, or to its end; cos(atan(slope)), to 1e-4 where it is no steeper than 1/4
    float cosine = 1.0 - square * (0.5 - 0.375 * square);
    vec2 beside = vec2(local.x - along, (local.y - bow.x + bow.y * along * along) * cosine);
    float distance = length(beside) - (shape.y + more.x * along);
    float opacity = shape.z + shape.w * along;
    float covered = clamp(0.5 - distance, 0.0, 1.0);
    if (more.y > 0.0) {
        float dim = clamp(1.0 - distance / max(more.y + more.z * along, 0.01), 0.0, 1.0);
        covered += (1.0 - covered) * dim * dim * (1.0 / 3.0);
    }
    color = vec4(abs(local.x) > more.w ? 1.0 : 1.0 - opacity * covered);
}
