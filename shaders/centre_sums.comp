// Adds to the sums of chosen pixels what their centres show.
layout(std430, binding = 0) readonly buffer Pixels { uint pixels[]; };  // of the picture
layout(std430, binding = 5) readonly buffer Inputs { uint inputs[]; };
layout(std430, binding = 6) readonly buffer Colours { vec4 colours[]; };  // of all centres
layout(std430, binding = 7) buffer Sums { vec4 sums[]; };

layout(location = 20) uniform uint u_first;   // the first of the pixels
layout(location = 21) uniform uint u_shares;  // where the list of shares begins; 0: all are 1

void main() {
  uint i = own_number();
  if (i >= u_count) return;
  float share = u_shares > 0 ? uintBitsToFloat(inputs[u_shares + i]) : 1.0;
  if (share != 0.0) sums[u_first + i].rgb += share * shown(colours[pixels[u_first + i]].rgb);
}
