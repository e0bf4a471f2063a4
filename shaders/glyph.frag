// glyph.frag: a letter, pixel for pixel from the atlas.
// in   local  from the centre, px      shape.xy  the centre in the atlas, px      tint  sRGB colour, opacity
// out  color  sRGB, opacity = how much of the pixel is covered · tint's
#version 330 core
uniform sampler2D atlas;  // red = coverage, 0…1
noperspective in vec2 local;
flat in vec4 shape;
flat in vec4 tint;
out vec4 color;

void main() {
    color = vec4(tint.rgb, tint.a * texelFetch(atlas, ivec2(shape.xy + local), 0).r);
}
