// quad.vert: a polygon for one of the fragment shaders beside it. Their colours depend on the pixel's position alone, not
// on the polygon: cut in pieces it gives the same pixels.
// in   vertex_position  a corner, px from the picture's top left
//      vertex_frame     the primitive's own axes: origin, px; unit vector along the first
//      vertex_shape, vertex_params, vertex_parabola  see the fragment shaders
//      vertex_tint      sRGB colour and opacity, 0…1
// out  frame, shape, params, parabola, tint  the same for the fragment shader
#version 330 core
uniform vec2 picture;  // its size, px
in vec2 vertex_position;
in vec4 vertex_frame;
in vec4 vertex_shape;
in vec4 vertex_params;
in vec2 vertex_parabola;
in vec4 vertex_tint;
flat out vec4 frame;
flat out vec4 shape;
flat out vec4 params;
flat out vec2 parabola;
flat out vec4 tint;

void main() {
    // no flip: OpenGL's lowest row is the top of the picture, so that it is read from the top down
    gl_Position = vec4(2.0 * vertex_position / picture - 1.0, 0.0, 1.0);
    frame = vertex_frame;
    shape = vertex_shape;
    params = vertex_params;
    parabola = vertex_parabola;
    tint = vertex_tint;
}
