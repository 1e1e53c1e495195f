// World positions to clip coordinates, by way of the offset from the eye: floats far from the world's origin
// differ exactly, and nothing is lost to a translation inside a matrix.
layout(location = 0) in vec3 a_position;
layout(location = 0) uniform vec3 u_eye;
layout(location = 1) uniform mat3x4 u_clip_from_offset;
layout(location = 2) uniform vec4 u_clip_offset;

void main() {
  gl_Position = u_clip_from_offset * (a_position - u_eye) + u_clip_offset;
}
