// One light times its mask or irradiance; blending adds it to the sum.
layout(binding = 0) uniform sampler2D t_light;
layout(binding = 1) uniform sampler2D t_factor;
layout(location = 0) uniform bool u_use_factor;
out vec4 o_light;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float factor = u_use_factor ? texelFetch(t_factor, texel, 0).r : 1.0;
  o_light = texelFetch(t_light, texel, 0) * factor;
}
