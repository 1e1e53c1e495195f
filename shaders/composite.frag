// The picture of a frame: ambient, emitted and direct light, exposed, clamped, as sRGB.
layout(binding = 0) uniform usampler2D t_ids;
layout(binding = 1) uniform sampler2D t_light;
layout(binding = 2) uniform sampler2D t_openness;
layout(location = 0) uniform vec3 u_ambient_light;
layout(location = 1) uniform vec3 u_background;
layout(location = 2) uniform float u_exposure;
layout(location = 3) uniform bool u_use_openness;
out vec4 o_color;

// x^(1/2.4) = y with y^12 = x^5. pow() may be coarse; one step of Newton's method
// from it is good to a few ulp.
vec3 root_2_4(vec3 x) {
  vec3 y = pow(x, vec3(1.0 / 2.4));
  vec3 x2 = x * x, y2 = y * y, y4 = y2 * y2;
  return y - (y - x2 * x2 * x / (y4 * y4 * y2 * y)) / 12.0;
}

vec3 srgb(vec3 x) {
  vec3 curve = 1.055 * root_2_4(max(x, vec3(0.0031308))) - 0.055;
  return mix(curve, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint id = texelFetch(t_ids, texel, 0).r;
  vec3 color = u_background;
  if (id != no_triangle) {
    int material = material_of(triangle_record(id));
    vec3 ambient = ambient_color(material) * u_ambient_light;
    if (u_use_openness) ambient *= texelFetch(t_openness, texel, 0).r;
    color = ambient + emissive_color(material) + texelFetch(t_light, texel, 0).rgb;
  }
  vec3 encoded = srgb(clamp(color * u_exposure, 0.0, 1.0));
  o_color = vec4(floor(encoded * 255.0 + 0.5) / 255.0, 1.0);
}
