// image.frag: a picture stretched over a rectangle, without smoothing.
// in   frame.xy  its top left corner, px      shape.xy  texels a pixel, across and down
// out  color  sRGB and opacity of the texel below the pixel's centre
#version 330 core
uniform sampler2D image;  // sRGB, opacity
flat in vec4 frame;
flat in vec4 shape;
out vec4 color;

void main() {
    ivec2 texel = ivec2((gl_FragCoord.xy - frame.xy) * shape.xy);
    color = texelFetch(image, clamp(texel, ivec2(0), textureSize(image, 0) - 1), 0);
}
