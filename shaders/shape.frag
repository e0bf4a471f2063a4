// shape.frag: a box with round corners, a capsule, a disc; with a pen, the outline of one.
// in   frame  centre, px; unit vector along its width
//      shape  half width and half height inside the corners, radius of the corners, half the pen's width or 0 to fill; px
//      params.xy  a glow: 1 / its reach beyond the edge, 1/px; its opacity at the edge      tint  sRGB colour, opacity
// out  color  sRGB, opacity = how much of the pixel is covered · tint's
#version 330 core
flat in vec4 frame;
flat in vec4 shape;
flat in vec4 params;
flat in vec4 tint;
out vec4 color;

void main() {
    vec2 from = gl_FragCoord.xy - frame.xy;
    vec2 local = vec2(dot(from, frame.zw), frame.z * from.y - frame.w * from.x);
    vec2 beyond = abs(local) - shape.xy;
    float distance = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - shape.z;
    if (shape.w > 0.0) distance = abs(distance) - shape.w;
    float covered = clamp(0.5 - distance, 0.0, 1.0);
    float dim = clamp(1.0 - distance * params.x, 0.0, 1.0);
    covered += (1.0 - covered) * dim * dim * params.y;
    color = vec4(tint.rgb, tint.a * covered);
}
