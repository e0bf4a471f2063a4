// cover.frag: a stroke's colour; blending weights it by the mask in the alpha channel and sets that back to 1.
// in   tint  sRGB colour
// out  color  the same, opaque
#version 330 core
flat in vec4 tint;
out vec4 color;

void main() {
    color = vec4(tint.rgb, 1.0);
}
