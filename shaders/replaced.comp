// Gives some samples other colours.
layout(std430, binding = 5) readonly buffer Inputs { uint inputs[]; };
layout(std430, binding = 6) buffer Colours { vec4 colours[]; };

layout(location = 20) uniform uint u_colors;  // where the list of colours begins, three floats each
layout(location = 22) uniform uint u_samples;  // and that of the samples' numbers

void main() {
  uint i = own_number();
  if (i >= u_count) return;
  uint at = u_colors + 3 * i;
  vec3 color = vec3(uintBitsToFloat(inputs[at]), uintBitsToFloat(inputs[at + 1]), uintBitsToFloat(inputs[at + 2]));
  colours[inputs[u_samples + i]] = vec4(color, 1.0);
}
