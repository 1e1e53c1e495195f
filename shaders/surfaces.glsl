// Materials to surfaces: docs/materials.md explains the parameters (src/shade/resolve-inl.h is the same on the CPU).
struct Material {
  vec4 base;      // colour; alpha
  vec4 emissive;  // colour; which model: 0 phong, 1 metallic_roughness, 2 specular_glossiness, 3 unlit
  vec4 ambient;   // reflectance, x < 0: as the base; share that passes
  vec4 specular;  // reflectance; roughness
  vec4 more;      // metallic; exponent; 1: opaque whatever alpha is
};
layout(std430, binding = 4) readonly buffer Materials { Material materials[]; };
layout(location = 8) uniform vec3 u_ambient_light;

struct Surface {
  vec3 base, ambient, emissive, specular;
  float alpha;
  float roughness;  // negative: phong
  float exponent;
};

Surface surface_of(uint number, vec4 vertex_color) {
  Material m = materials[number];
  int model = int(m.emissive.w);
  vec3 base = m.base.rgb * vertex_color.rgb;
  Surface s = Surface(base, vec3(0.0), m.emissive.rgb, vec3(0.0), m.more.z > 0.0 ? 1.0 : m.base.a * vertex_color.a, -1.0, 1.0);
  if (model == 0) {
    s.specular = m.specular.rgb;
    s.exponent = max(m.more.y, 0.0);
  } else if (model == 1) {
    float metallic = m.more.x;
    s.specular = (1.0 - metallic) * vec3(0.04) + metallic * base;
    s.base = (1.0 - metallic) * base;
    s.roughness = clamp(m.specular.w, 0.0, 1.0);
  } else if (model == 2) {
    s.specular = m.specular.rgb;
    s.base = (1.0 - max(max(s.specular.r, s.specular.g), s.specular.b)) * base;
    s.roughness = clamp(m.specular.w, 0.0, 1.0);
  } else {
    s.emissive += base;
    s.base = vec3(0.0);
    return s;
  }
  s.base *= 1.0 - clamp(m.ambient.w, 0.0, 1.0);
  s.ambient = (m.ambient.x < 0.0 ? s.base : m.ambient.rgb * vertex_color.rgb) * u_ambient_light;
  return s;
}
