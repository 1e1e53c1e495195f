// One light through its mask; blending adds it to the sum.
layout(binding = 0) uniform sampler2D t_light;
layout(binding = 1) uniform sampler2D t_mask;
layout(location = 0) uniform bool u_use_mask;
out vec4 o_light;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float lit = u_use_mask ? texelFetch(t_mask, texel, 0).r : 1.0;
  o_light = texelFetch(t_light, texel, 0) * lit;
}
