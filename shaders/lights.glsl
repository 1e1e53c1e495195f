// What a light sends to the eye from a surface, before shadows: src/shade/light_terms.h explains the parameters, and
// diffuse-inl.h and gloss-inl.h are the same on the CPU. tests/shade_gl holds both together.
const float brightest = 1e30;
struct Light {
  vec4 color;          // intensity and colour; range in metres, 0: unbounded
  vec4 from_eye;       // place relative to the eye; exponent of the distance
  vec4 direction;      // unit, the way it shines
  vec4 cone;           // scale and offset of the cosine
  vec4 area_from_eye;  // the polygon's centre; 0: a sun, seen in that direction from everywhere
  vec4 area_normal;    // and the radius of the disc of the same area
  vec4 axis_x, axis_y;
  vec4 corners[7];     // two each, along the axes
  ivec4 kind;          // bits: 1 directional, 2 spot, 4 shines by the cosine, 8 by irradiance; count of corners
};
layout(std140, binding = 0) uniform Lights { Light lights[LIGHT_COUNT]; };

struct Incident {
  vec3 to_light;  // unit
  float fade;     // 0: nothing arrives
};

float fade_of(int light, vec3 to_light, float distance_m) {
  int kind = lights[light].kind.x;
  float fade = 1.0;
  float cosine = -dot(lights[light].direction.xyz, to_light);
  if ((kind & 2) != 0) {
    fade = clamp(cosine * lights[light].cone.x + lights[light].cone.y, 0.0, 1.0);
    fade *= fade;
  }
  if ((kind & 4) != 0) fade *= max(cosine, 0.0);
  float range_m = lights[light].color.w, power = lights[light].from_eye.w;
  if (range_m > 0.0) {
    float near = distance_m / range_m, square = near * near;
    fade *= clamp(1.0 - square * square, 0.0, 1.0);
  }
  if (power < 0.0) fade /= distance_m * distance_m;
  if (power > 0.0) fade *= distance_m * distance_m;
  return min(fade, brightest);
}

Incident incident_at(int light, vec3 point) {
  if ((lights[light].kind.x & 1) != 0) return Incident(-lights[light].direction.xyz, 1.0);
  vec3 path = lights[light].from_eye.xyz - point;
  float distance_m = length(path);
  if (!(distance_m > 0.0)) return Incident(vec3(0.0), 0.0);
  vec3 to_light = path / distance_m;
  return Incident(to_light, fade_of(light, to_light, distance_m));
}

float received(int light, Incident incident, Seen seen) {
  if ((lights[light].kind.x & 8) != 0) {
    if (seen.normal == seen.unbent) return incident.fade;
    float unbent = dot(seen.unbent, incident.to_light), after = dot(seen.normal, incident.to_light);
    return incident.fade * max(1.0 + (after - unbent) / max(unbent, 0.25), 0.0);
  }
  bool above = dot(seen.before, incident.to_light) > 0.0;
  return above ? max(dot(seen.normal, incident.to_light), 0.0) * incident.fade : 0.0;
}

vec3 fresnel(vec3 at_0, float at_90, float cosine) {
  float x = 1.0 - cosine, x2 = x * x;
  return at_0 + x2 * x2 * x * (vec3(at_90) - at_0);
}

float ggx_lobe(vec3 normal, vec3 to_eye, float roughness, vec3 to_light, float half_cosine, float widened_by) {
  float alpha = max(roughness * roughness, 1e-3), a2 = alpha * alpha;
  float at_light = clamp(dot(normal, to_light), 1e-4, 1.0), at_eye = clamp(dot(normal, to_eye), 1e-4, 1.0);
  float spread = half_cosine * half_cosine * (a2 - 1.0) + 1.0, rest = 1.0 - a2;
  float masking = at_light * sqrt(a2 + rest * at_eye * at_eye) + at_eye * sqrt(a2 + rest * at_light * at_light);
  float wider = alpha / min(alpha + widened_by, 1.0);
  return wider * wider * a2 / (spread * spread) * (0.5 / masking);
}

// The place of the polygon nearest to where the mirrored ray meets its plane: direction, and distance.
vec4 towards_polygon(int light, vec3 mirrored, vec3 point) {
  vec3 normal = lights[light].area_normal.xyz;
  vec3 from_centre = lights[light].area_from_eye.w * point - lights[light].area_from_eye.xyz;
  float side = dot(normal, from_centre), height = abs(side);
  float sinking = max(-(side < 0.0 ? -1.0 : 1.0) * dot(normal, mirrored), 0.05);
  vec3 met = from_centre + height / sinking * mirrored;
  vec2 at = vec2(dot(lights[light].axis_x.xyz, met), dot(lights[light].axis_y.xyz, met)), near = at;
  float nearest = 3e38, inside = 1.0;
  int count = lights[light].kind.y;
  for (int k = 0; k < count; ++k) {
    int next = (k + 1) % count;
    vec4 first = lights[light].corners[k / 2], second = lights[light].corners[next / 2];
    vec2 a = k % 2 == 0 ? first.xy : first.zw, edge = (next % 2 == 0 ? second.xy : second.zw) - a, w = at - a;
    vec2 gap = w - clamp(dot(w, edge) / dot(edge, edge), 0.0, 1.0) * edge;
    inside = min(inside, edge.x * w.y - edge.y * w.x);
    if (dot(gap, gap) < nearest) {
      near = at - gap;
      nearest = dot(gap, gap);
    }
  }
  if (inside >= 0.0) near = at;
  vec3 path = near.x * lights[light].axis_x.xyz + near.y * lights[light].axis_y.xyz - from_centre;
  float distance_m = length(path);
  return vec4(path / max(distance_m, 1e-30), distance_m);
}

vec3 light_of(int light, Seen seen, Surface s, vec3 to_eye) {
  Incident incident = incident_at(light, seen.point);
  float weight = received(light, incident, seen);
  if (!(weight > 0.0)) return vec3(0.0);
  vec3 color = lights[light].color.rgb;
  if (s.roughness < 0.0 && s.specular == vec3(0.0)) return min(s.base * color * weight, vec3(brightest));
  bool by_irradiance = (lights[light].kind.x & 8) != 0;
  vec3 mirrored = 2.0 * dot(seen.normal, to_eye) * seen.normal - to_eye;
  vec4 to = vec4(incident.to_light, 1.0);
  if (by_irradiance) to = towards_polygon(light, mirrored, seen.point);
  if (s.roughness >= 0.0) {
    vec3 half_way = to.xyz + to_eye;
    half_way /= max(length(half_way), 1e-30);
    float widened = 0.5 * lights[light].area_normal.w / max(to.w, 1e-30);
    float lobe = dot(seen.normal, to.xyz) > 0.0
                     ? weight * ggx_lobe(seen.normal, to_eye, s.roughness, to.xyz,
                                         clamp(dot(seen.normal, half_way), 0.0, 1.0), widened)
                     : 0.0;
    vec3 share = fresnel(s.specular, s.grazing, clamp(dot(to_eye, half_way), 0.0, 1.0));
    return min(color * (s.base * (vec3(1.0) - share) * weight + share * lobe), vec3(brightest));
  }
  // Phong's highlight has no cosine at the surface; irradiance contains it, so it is divided by it again.
  float bare = by_irradiance ? incident.fade / max(dot(seen.unbent, incident.to_light), 0.25) : incident.fade;
  float aligned = dot(mirrored, to.xyz);
  float highlight = aligned > 0.0 ? bare * exp2(s.exponent * log2(clamp(aligned, 1e-30, 1.0))) : 0.0;
  return min(color * (s.base * weight + s.specular * highlight), vec3(brightest));
}

// Ambient light where all is open: what is diffuse, and by GGX also the surroundings' mirror image (Karis 2014).
vec3 ambient_of(Seen seen, Surface s, vec3 to_eye, vec3 around, vec3 brighter) {
  if (s.roughness < 0.0) return s.ambient;
  float r = s.roughness, at_eye = clamp(dot(seen.normal, to_eye), 0.0, 1.0);
  float x = 1.0 - r, y = 0.0425 - 0.0275 * r, z = 1.04 - 0.572 * r, w = 0.022 * r - 0.04;
  float edge = min(x * x, exp2(-9.28 * at_eye)) * x + y;
  vec3 share = s.specular * (-1.04 * edge + z) + s.grazing * max(1.04 * edge + w, 0.0);
  return (vec3(1.0) - share) * s.ambient + share * (around + (1.0 - r) * brighter);
}
