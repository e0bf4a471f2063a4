// glyph.frag: a letter, pixel for pixel from the atlas.
// in   frame.xy  its top left corner, px      shape.xy  the same in the atlas, px      tint  sRGB colour, opacity
// out  color  sRGB, opacity = how much of the pixel is covered · tint's
#version 330 core
uniform sampler2D atlas;  // red = coverage, 0…1
flat in vec4 frame;
flat in vec4 shape;
flat in vec4 tint;
out vec4 color;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy - frame.xy + shape.xy);
    color = vec4(tint.rgb, tint.a * texelFetch(atlas, texel, 0).r);
}
