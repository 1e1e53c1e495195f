// Direct diffuse light of one light before shadowing; formulas at LightPass::draw and draw_area.
layout(binding = 0) uniform usampler2D t_ids;
layout(binding = 1) uniform usampler2D t_normals;
layout(binding = 2) uniform sampler2D t_depth;
layout(location = 5) uniform vec3 u_light_from_eye;
layout(location = 6) uniform vec3 u_light_direction;
layout(location = 7) uniform vec3 u_light_color;
layout(location = 8) uniform vec2 u_cone;   // scale and offset of the cosine
layout(location = 9) uniform float u_range; // 0: unbounded
layout(location = 10) uniform bool u_directional;
layout(location = 11) uniform int u_distance_power; // -2, 0 or 2
layout(location = 12) uniform bool u_cosine_emitter;
layout(location = 13) uniform bool u_by_irradiance; // cosines and visibility come with the irradiance
out vec4 o_light;

// A light that touches a surface is infinitely bright there; infinity times a mask of 0 would not be 0.
const float brightest = 1e30;

// Fading with distance and angle; to_light is unit.
float attenuation(vec3 to_light, float distance) {
  float cosine = -dot(u_light_direction, to_light);
  float result = clamp(cosine * u_cone.x + u_cone.y, 0.0, 1.0);
  result *= result;
  if (u_cosine_emitter) result *= max(cosine, 0.0);
  if (u_range > 0.0) {
    float near = distance / u_range;
    result *= clamp(1.0 - near * near * near * near, 0.0, 1.0);
  }
  float squared = distance * distance;
  return u_distance_power == 0 ? result : u_distance_power < 0 ? result / squared : result * squared;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  o_light = vec4(0.0);
  uint id = texelFetch(t_ids, texel, 0).r;
  if (id == no_triangle) return;

  vec3 to_light = -u_light_direction;
  float fade = 1.0;
  if (!u_directional) {
    vec3 path = u_light_from_eye - offset_from_eye(gl_FragCoord.xy, texelFetch(t_depth, texel, 0).r);
    float distance = length(path);
    if (!(distance > 0.0)) return;
    to_light = path / distance;
    fade = attenuation(to_light, distance);
  }

  vec4 record = triangle_record(id);
  vec3 color = base_color(material_of(record)) * u_light_color;
  if (u_by_irradiance) {
    o_light = vec4(min(color * fade, vec3(brightest)), 0.0);
    return;
  }
  vec3 face = record.xyz;
  if (dot(face, ray_direction(gl_FragCoord.xy)) > 0.0) face = -face;
  if (!(dot(face, to_light) > 0.0)) return;
  uint code = texelFetch(t_normals, texel, 0).r;
  vec3 normal = code == no_normal ? face : unpack_normal(code);
  if (dot(normal, face) < 0.0) normal = -normal;

  float cosine = max(dot(normal, to_light), 0.0);
  o_light = vec4(min(color * (cosine * fade), vec3(brightest)), 0.0);
}
