// image.frag: a picture stretched over a rectangle, without smoothing.
// in   local  from the centre, px      shape  half the width and half the height, px; texels a pixel across and down
// out  color  sRGB and opacity of the texel below the pixel's centre
#version 330 core
uniform sampler2D image;  // sRGB, opacity
noperspective in vec2 local;
flat in vec4 shape;
out vec4 color;

void main() {
    ivec2 texel = ivec2(floor((local + shape.xy) * shape.zw));
    color = texelFetch(image, clamp(texel, ivec2(0), textureSize(image, 0) - 1), 0);
}
