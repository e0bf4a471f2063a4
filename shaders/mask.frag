// mask.frag: one segment of a stroke, into the alpha channel alone.
// in   place  its middle, px; unit vector along it
//      shape  half its length and half the stroke's width, px; opacity in the middle, 0…1, and its slope along, 1/px
//      more   slope of half the width along; how far a glow reaches beyond the edge in the middle, px, and its slope;
//             how far from the middle along it the segment answers for its stroke, px: the next one goes on there
// out  color.a  how transparent the stroke is here, 0…1; the smallest value stays
#version 330 core
flat in vec4 place;
flat in vec4 shape;
flat in vec4 more;
out vec4 color;

void main() {
    vec2 from = gl_FragCoord.xy - place.xy;
    vec2 local = vec2(dot(from, place.zw), place.z * from.y - place.w * from.x);
    float along = clamp(local.x, -shape.x, shape.x);
    float half_width = shape.y + more.x * along;
    float distance = length(vec2(local.x - along, local.y)) - half_width;
    float opacity = shape.z + shape.w * along;
    float covered = clamp(0.5 - distance, 0.0, 1.0);
    if (more.y > 0.0) {
        float dim = clamp(1.0 - distance / max(more.y + more.z * along, 0.01), 0.0, 1.0);
        covered += (1.0 - covered) * dim * dim / 3.0;
    }
    color = vec4(abs(local.x) > more.w ? 1.0 : 1.0 - opacity * covered);
}
