// shape.frag: a box with round corners, a capsule, a disc; with a pen, the outline of one.
// in   local  from the centre, px      shape  half width and half height inside the corners, radius of the corners,
//      tint   sRGB colour, opacity            half the pen's width or 0 to fill; px
// out  color  sRGB, opacity = how much of the pixel is covered · tint's
#version 330 core
noperspective in vec2 local;
flat in vec4 shape;
flat in vec4 tint;
out vec4 color;

void main() {
    vec2 beyond = abs(local) - shape.xy;
    float distance = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - shape.z;
    if (shape.w > 0.0) distance = abs(distance) - shape.w;
    color = vec4(tint.rgb, tint.a * clamp(0.5 - distance, 0.0, 1.0));
}
