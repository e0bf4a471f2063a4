// quad.vert: a rectangle for one of the fragment shaders beside it.
// in   at        a corner, px from the picture's top left
//      local_at  the same from the rectangle's centre, along its axes, px
//      shape_of  what the fragment shader needs to know
//      tint_of   sRGB colour and opacity, 0…1
// out  local, shape, tint   the same for the fragment shader
#version 330 core
uniform vec2 picture;  // its size, px
in vec2 at;
in vec2 local_at;
in vec4 shape_of;
in vec4 tint_of;
noperspective out vec2 local;
flat out vec4 shape;
flat out vec4 tint;

void main() {
    // no flip: OpenGL's lowest row is the top of the picture, so that it is read from the top down
    gl_Position = vec4(2.0 * at / picture - 1.0, 0.0, 1.0);
    local = local_at;
    shape = shape_of;
    tint = tint_of;
}
