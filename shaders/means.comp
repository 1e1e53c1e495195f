// The levels of chosen pixels from their sums.
layout(std430, binding = 5) writeonly buffer Bytes { uint words[]; };
layout(std430, binding = 7) readonly buffer Sums { vec4 sums[]; };

layout(location = 20) uniform float u_share;

void main() {
  uint i = own_number();
  if (i < u_count) words[i] = levels_of(u_share * sums[i].rgb);
}
