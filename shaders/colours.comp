// Linear colours of samples: ambient light times openness, emission, and light times what reaches the sample of it.
layout(std430, binding = 5) readonly buffer Inputs { uint inputs[]; };  // lists one after another, ids first
layout(std430, binding = 6) writeonly buffer Colours { vec4 colours[]; };  // and alpha
layout(std430, binding = 7) readonly buffer VertexColours { vec4 vertex_colours[]; };

layout(location = 9) uniform vec3 u_background;
layout(location = 10) uniform vec3 u_around;  // of what gloss mirrors: where all is rough, and what smoothness adds
layout(location = 11) uniform vec3 u_brighter;
layout(location = 12) uniform uint u_vertex_colours;  // how many vertices have one
layout(location = 13) uniform uint u_material_count;
layout(location = 14) uniform uint u_width;   // samples are the centres of a picture's pixels; 0: they have places
layout(location = 15) uniform uint u_places;  // where the list begins
layout(location = 16) uniform uint u_openness;  // likewise; none: 0
layout(location = 17) uniform int u_light_count;
// Kind: 0 all, 1 bytes, 2 floats; where the list begins; where that of tints begins, none: 0.
layout(location = 50) uniform uvec3 u_factors[LIGHT_COUNT];

float float_at(uint i) { return uintBitsToFloat(inputs[i]); }

float factor_of(int light, uint sample_number) {
  uvec3 list = u_factors[light];
  if (list.x == 2) return float_at(list.y + sample_number);
  if (list.x == 1) return float(inputs[list.y + sample_number / 4] >> 8 * (sample_number % 4) & 255u) / 255.0;
  return 1.0;
}

vec3 tint_of(int light, uint sample_number) {
  uint at = u_factors[light].z;
  if (at == 0) return vec3(1.0);
  at += 3 * sample_number;
  return vec3(float_at(at), float_at(at + 1), float_at(at + 2));
}

vec4 vertex_color_of(uint id, vec3 weights) {
  if (u_rules > 0 && !has_planes(id)) return vec4(1.0);
  uvec3 t = uvec3(triangles[3 * id], triangles[3 * id + 1], triangles[3 * id + 2]);
  if (max(max(t.x, t.y), t.z) >= u_vertex_colours) return vec4(1.0);
  return weights.x * vertex_colours[t.x] + weights.y * vertex_colours[t.y] + weights.z * vertex_colours[t.z];
}

void main() {
  uint i = own_number();
  if (i >= u_count) return;
  uint id = inputs[i];
  if (id >= u_triangle_count) {
    colours[i] = vec4(u_background, 1.0);
    return;
  }
  vec2 place = u_width > 0 ? vec2(float(i % u_width) + 0.5, float(i / u_width) + 0.5)
                           : vec2(float_at(u_places + 2 * i), float_at(u_places + 2 * i + 1));
  Seen seen = seen_at(id, place);
  vec3 to_eye = u_orthographic ? -normalize(u_d0) : -seen.point / max(length(seen.point), 1e-30);
  uint number = min(material_numbers[id], u_material_count - 1);
  seen.normal = bent_normal(number, id, seen);
  Pattern p = pattern_of(number, id, seen);
  p.base *= vertex_color_of(id, seen.weights);
  Surface s = surface_of(number, p);
  float open = u_openness > 0 ? float_at(u_openness + i) : 1.0;
  vec3 sum = open * occlusion_of(number, p) * ambient_of(seen, s, to_eye, u_around, u_brighter) + s.emissive;
  for (int light = 0; light < u_light_count; ++light) {
    float factor = factor_of(light, i);
    if (factor > 0.0) sum += factor * tint_of(light, i) * light_of(light, seen, s, to_eye);
  }
  colours[i] = vec4(sum, s.alpha);
}
