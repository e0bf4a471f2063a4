// mask.frag: one segment of a stroke, into the alpha channel alone.
// in   local  from the middle, along and across, px
//      shape  half its length and half the stroke's width, px; opacity in the middle, 0…1, and its slope along, 1/px
// out  color.a  how transparent the stroke is here, 0…1; the smallest value stays
#version 330 core
noperspective in vec2 local;
flat in vec4 shape;
out vec4 color;

void main() {
    float along = clamp(local.x, -shape.x, shape.x);
    float distance = length(vec2(local.x - along, local.y)) - shape.y;
    float opacity = shape.z + shape.w * along;
    color = vec4(1.0 - opacity * clamp(0.5 - distance, 0.0, 1.0));
}
