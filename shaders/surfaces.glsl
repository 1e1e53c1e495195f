// Materials to surfaces: docs/materials.md explains the parameters (src/shade/resolve-inl.h is the same on the CPU).
struct Material {
  vec4 base;      // colour; alpha
  vec4 emissive;  // colour; which model: 0 phong, 1 metallic_roughness, 2 specular_glossiness, 3 unlit
  vec4 ambient;   // reflectance, x < 0: as the base; share that passes
  vec4 specular;  // reflectance; roughness
  vec4 more;      // metallic; exponent; 1: opaque whatever alpha is; share of what is no metal's reflectance
  vec4 detail;    // scale of the normal map; strength of the occlusion map
  ivec4 maps[4];  // numbers of textures, -1: none, each with its use: base, emissive, gloss, specular, passing, share, normal, occlusion
};
layout(std430, binding = 4) readonly buffer Materials { Material materials[]; };
layout(location = 8) uniform vec3 u_ambient_light;

struct Surface {
  vec3 base, ambient, emissive, specular;
  float alpha;
  float roughness;  // negative: phong
  float exponent;
  float grazing;  // reflectance at 90 degrees
};

// What textures and vertices give at a sample; 1 where there are none.
struct Pattern {
  vec4 base, emissive, gloss, specular, passing, share, occlusion;
};

Pattern pattern_of(uint number, uint id, Seen seen) {
  Pattern p = Pattern(vec4(1.0), vec4(1.0), vec4(1.0), vec4(1.0), vec4(1.0), vec4(1.0), vec4(1.0));
  if (!has_planes(id)) return p;
  ivec4 first = materials[number].maps[0], second = materials[number].maps[1], third = materials[number].maps[2];
  p.base = texture_at(first.x, first.y, id, seen.weights, seen.steps);
  p.emissive = texture_at(first.z, first.w, id, seen.weights, seen.steps);
  p.gloss = texture_at(second.x, second.y, id, seen.weights, seen.steps);
  p.specular = texture_at(second.z, second.w, id, seen.weights, seen.steps);
  p.passing = texture_at(third.x, third.y, id, seen.weights, seen.steps);
  p.share = texture_at(third.z, third.w, id, seen.weights, seen.steps);
  ivec4 last = materials[number].maps[3];
  p.occlusion = texture_at(last.z, last.w, id, seen.weights, seen.steps);
  return p;
}

Surface surface_of(uint number, Pattern p) {
  Material m = materials[number];
  int model = int(m.emissive.w);
  vec3 base = m.base.rgb * p.base.rgb;
  Surface s = Surface(base, vec3(0.0), m.emissive.rgb * p.emissive.rgb, vec3(0.0), m.more.z > 0.0 ? 1.0 : m.base.a * p.base.a, -1.0, 1.0, 1.0);
  if (model == 0) {
    s.specular = m.specular.rgb * p.specular.rgb;
    s.exponent = max(m.more.y, 0.0) * p.gloss.r;
  } else if (model == 1) {
    float metallic = m.more.x * p.gloss.b;
    float share = m.more.w * p.share.a;
    s.specular = (1.0 - metallic) * share * min(m.specular.rgb * p.specular.rgb, vec3(1.0)) + metallic * base;
    s.grazing = 1.0 - (1.0 - metallic) * (1.0 - share);
    s.base = (1.0 - metallic) * base;
    s.roughness = clamp(m.specular.w * p.gloss.g, 0.0, 1.0);
  } else if (model == 2) {
    s.specular = m.specular.rgb * p.specular.rgb;
    s.base = (1.0 - max(max(s.specular.r, s.specular.g), s.specular.b)) * base;
    s.roughness = clamp(1.0 - (1.0 - m.specular.w) * p.specular.a, 0.0, 1.0);
  } else {
    s.emissive += base;
    s.base = vec3(0.0);
    return s;
  }
  s.base *= 1.0 - clamp(m.ambient.w * p.passing.r, 0.0, 1.0);
  s.ambient = (m.ambient.x < 0.0 ? s.base : m.ambient.rgb * p.base.rgb) * u_ambient_light;
  return s;
}

// Share of the ambient light that arrives, beside openness.
float occlusion_of(uint number, Pattern p) { return 1.0 + materials[number].detail.y * (p.occlusion.r - 1.0); }
