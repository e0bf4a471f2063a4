// shape.frag: a box with round corners, a capsule, a disc; with a pen, the outline of one.
// in   place  centre, px; unit vector along its width
//      shape  half width and half height inside the corners, radius of the corners, half the pen's width or 0 to fill; px
//      more.xy  a glow: 1 / how far it reaches beyond the edge, 1/px; its share there      tint  sRGB colour, opacity
// out  color  sRGB, opacity = how much of the pixel is covered · tint's
#version 330 core
flat in vec4 place;
flat in vec4 shape;
flat in vec4 more;
flat in vec4 tint;
out vec4 color;

void main() {
    vec2 from = gl_FragCoord.xy - place.xy;
    vec2 local = vec2(dot(from, place.zw), place.z * from.y - place.w * from.x);
    vec2 beyond = abs(local) - shape.xy;
    float distance = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - shape.z;
    if (shape.w > 0.0) distance = abs(distance) - shape.w;
    float covered = clamp(0.5 - distance, 0.0, 1.0);
    float dim = clamp(1.0 - distance * more.x, 0.0, 1.0);
    covered += (1.0 - covered) * dim * dim * more.y;
    color = vec4(tint.rgb, tint.a * covered);
}
