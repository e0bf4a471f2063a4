// quad.vert: a rectangle of whole pixels for one of the fragment shaders beside it. What it shows depends on the pixel's
// place alone, not on the rectangle: cut in pieces it gives the same pixels.
// in   at        a corner, px from the picture's top left
//      place_of  origin of the thing's own axes, px; unit vector along the first of them
//      shape_of, more_of, bow_of  what the fragment shader needs to know
//      tint_of   sRGB colour and opacity, 0…1
// out  place, shape, more, bow, tint   the same for the fragment shader
#version 330 core
uniform vec2 picture;  // its size, px
in vec2 at;
in vec4 place_of;
in vec4 shape_of;
in vec4 more_of;
in vec2 bow_of;
in vec4 tint_of;
flat out vec4 place;
flat out vec4 shape;
flat out vec4 more;
flat out vec2 bow;
flat out vec4 tint;

void main() {
    // no flip: OpenGL's lowest row is the top of the picture, so that it is read from the top down
    gl_Position = vec4(2.0 * at / picture - 1.0, 0.0, 1.0);
    place = place_of;
    shape = shape_of;
    more = more_of;
    bow = bow_of;
    tint = tint_of;
}
