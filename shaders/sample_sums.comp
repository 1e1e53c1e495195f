// Adds to the sums of chosen pixels what further samples show. A pixel's samples follow each other: the first adds all.
layout(std430, binding = 5) readonly buffer Inputs { uint inputs[]; };
layout(std430, binding = 6) readonly buffer Colours { vec4 colours[]; };  // of the samples
layout(std430, binding = 7) buffer Sums { vec4 sums[]; };

layout(location = 20) uniform uint u_first;   // the first of the pixels
layout(location = 21) uniform uint u_shares;  // where the lists of shares and of pixels begin
layout(location = 22) uniform uint u_pixels;

void main() {
  uint i = own_number();
  if (i >= u_count) return;
  uint pixel = inputs[u_pixels + i];
  if (i > 0 && inputs[u_pixels + i - 1] == pixel) return;
  vec3 sum = sums[u_first + pixel].rgb;
  for (; i < u_count && inputs[u_pixels + i] == pixel; ++i)
    sum += uintBitsToFloat(inputs[u_shares + i]) * shown(colours[i].rgb);
  sums[u_first + pixel].rgb = sum;
}
